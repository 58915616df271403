//! A ball cut from a solid within trimmed NURBS surfaces looks as one that is cut from the exact solid, in clay and in glass.

use std::f64::consts::FRAC_1_SQRT_2;
use std::sync::Arc;
use strahl_accel::AcceleratorKind;
use strahl_geometry::{Cylinder, Nurbs, NurbsBrep, NurbsCurve, NurbsData, Shape, Sphere, TrimLoop};
use strahl_math::{DVec2, DVec3};
use strahl_render::{CompileOptions, RenderOptions, Rendered, compile, render};
use strahl_scene::{Background, Camera, CsgOp, Object, ObjectExt, Scene};
use strahl_shade::{Color, Light, Material};

const QUARTERS: [f64; 12] = [0.0, 0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 3.0, 3.0, 4.0, 4.0, 4.0];

/// A full circle of four quarters: places and weights.
fn circle() -> Vec<(DVec2, f64)> {
    let corners = [
        (1, 0),
        (1, 1),
        (0, 1),
        (-1, 1),
        (-1, 0),
        (-1, -1),
        (0, -1),
        (1, -1),
        (1, 0),
    ];
    let weighted = corners.map(|(x, y)| {
        let weight = if x * y == 0 { 1.0 } else { FRAC_1_SQRT_2 };
        (DVec2::new(f64::from(x), f64::from(y)), weight)
    });
    weighted.to_vec()
}

/// A cylinder about y of radius 1 and height 2; its lids are larger by `gap`.
fn can(gap: f64) -> Shape {
    let side = NurbsData {
        degree: [2, 1],
        knots: [QUARTERS.to_vec(), vec![0.0, 0.0, 1.0, 1.0]],
        points: [-1.0, 1.0]
            .into_iter()
            .flat_map(|y| {
                circle()
                    .into_iter()
                    .map(move |(p, _)| DVec3::new(p.x, y, p.y))
            })
            .collect(),
        weights: (0..2).flat_map(|_| circle()).map(|(_, w)| w).collect(),
    };
    let lid = |y: f64| {
        let corner = |k: i32| DVec3::new(f64::from(k % 2 * 4 - 2), y, f64::from(k / 2 * 4 - 2));
        let data = NurbsData {
            knots: [(); 2].map(|()| vec![-2.0, -2.0, 2.0, 2.0]),
            ..NurbsData::new([1, 1], 2, (0..4).map(corner).collect())
        };
        let border = NurbsCurve {
            degree: 2,
            knots: QUARTERS.to_vec(),
            points: circle().into_iter().map(|(p, _)| p * (1.0 + gap)).collect(),
            weights: circle().into_iter().map(|(_, w)| w).collect(),
        };
        let border = TrimLoop {
            curves: vec![border],
            is_hole: false,
        };
        Nurbs::try_trimmed(&data, &[border])
    };
    let faces = [Nurbs::try_new(&side), lid(-1.0), lid(1.0)];
    let faces = faces.map(|face| Arc::new(face.expect("a surface")));
    NurbsBrep::try_new(&faces).expect("closed").into()
}

fn scene(solid: Shape, material: Material) -> Scene {
    let ball = Sphere::new(DVec3::new(0.7, 0.8, 0.6), 0.8);
    let cut = Object::csg(CsgOp::Difference, vec![solid.into(), ball.into()]);
    Scene::new()
        .add(cut.material(material))
        .light(Light::point(DVec3::new(3.0, 5.0, 9.0), Color::gray(0.8)))
        .background(Background::Gradient {
            up: DVec3::Y,
            bottom: Color::gray(0.1),
            top: Color::new(0.3, 0.5, 0.9),
        })
        .camera(Camera::perspective(
            DVec3::new(2.0, 2.5, 5.0),
            DVec3::ZERO,
            DVec3::Y,
            0.6,
        ))
}

fn picture(scene: &Scene, accelerator: AcceleratorKind) -> Rendered {
    let scene = compile(scene, &CompileOptions { accelerator }).expect("valid");
    render(&scene, &RenderOptions::new(&scene, 80, 60)).expect("a picture")
}

#[test]
fn a_ball_is_cut_from_trimmed_surfaces_as_from_the_exact_solid() {
    let exact = || Shape::from(Cylinder::new(-DVec3::Y, DVec3::Y, 1.0));
    let clay = || Material::matte(Color::new(0.8, 0.4, 0.2));
    for (gap, material) in [
        (0.0, clay()),
        (1e-5, clay()),
        (-1e-5, clay()),
        (0.0, Material::glass(1.5)),
        (-1e-6, Material::glass(1.5)),
    ] {
        let ours = scene(can(gap), material.clone());
        let found = picture(&ours, CompileOptions::default().accelerator);
        for accelerator in AcceleratorKind::ALL.iter().copied() {
            let other = picture(&ours, accelerator);
            assert_eq!(found.film.sha256(), other.film.sha256(), "{accelerator}");
        }
        let expected = picture(
            &scene(exact(), material),
            CompileOptions::default().accelerator,
        );
        let pairs = found.film.pixels.iter().zip(&expected.film.pixels);
        let differs = |(a, b): &(&[f32; 3], &[f32; 3])| {
            a.iter().zip(b.iter()).any(|(a, b)| (a - b).abs() > 0.01)
        };
        let count = pairs.filter(differs).count();
        // Of 4800: those at an edge, which glass shows many times.
        assert!(count <= 12, "{gap}: {count} pixels differ");
    }
}
