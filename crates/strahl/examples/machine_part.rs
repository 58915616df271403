//! A machine part by constructive solid geometry: a flange with bolt holes, a bore and a rounded edge.
//!
//! ```sh
//! cargo run --release -p strahl --example machine_part -- part.png
//! ```

use std::error::Error;
use std::f64::consts::TAU;
use std::path::PathBuf;
use strahl::prelude::*;

fn main() -> Result<(), Box<dyn Error>> {
    let output = PathBuf::from(
        std::env::args_os()
            .nth(1)
            .unwrap_or("machine_part.png".into()),
    );
    let session = Session::new(Threads::All)?;
    let (scene, _warnings) = session.compile(&scene(), &CompileOptions::default())?;
    let view = scene.view(960, 720).with_sampling(Sampling::ADAPTIVE);
    let picture = session.picture(&view, &Output::default())?;
    strahl::save(&output, &picture.film, &WriteOptions::default())?;
    Ok(())
}

fn scene() -> Scene {
    let steel =
        Material::shiny(Color::new(0.42, 0.44, 0.47), 0.6, 60.0).with_reflection(Color::gray(0.28));
    let floor = Material::matte(Color::new(0.62, 0.58, 0.52)).with_reflection(Color::gray(0.06));
    Scene::new()
        .add(
            Plane::new(DVec3::ZERO, DVec3::Y)
                .material(floor)
                .named("table"),
        )
        .add(flange().material(steel).named("flange"))
        .light(Light::spot(
            DVec3::new(6.0, 11.0, 7.0),
            DVec3::ZERO,
            0.3,
            0.6,
            Color::new(0.85, 0.82, 0.76),
        ))
        .light(Light::point(
            DVec3::new(-8.0, 6.0, 5.0),
            Color::new(0.22, 0.26, 0.33),
        ))
        .background(Background::Gradient {
            up: DVec3::Y,
            bottom: Color::gray(0.1),
            top: Color::new(0.5, 0.6, 0.75),
        })
        .camera(Camera::perspective(
            DVec3::new(3.5, 5.2, 7.6),
            DVec3::new(0.0, 0.7, 0.0),
            DVec3::Y,
            0.62,
        ))
}

/// A disc with a collar, one bore through both, six bolt holes with countersinks and a key slot.
fn flange() -> Object {
    let up = DVec3::Y;
    let solid = |bottom: f64, top: f64, radius: f64| -> Object {
        Cylinder::new(up * bottom, up * top, radius).into()
    };
    let edge = Torus::new(up * 0.6, up, 2.3, 0.15).into();
    let body = Object::csg(
        CsgOp::Merge,
        vec![
            solid(0.0, 0.6, 2.45),
            solid(0.0, 0.75, 2.3),
            edge,
            solid(0.5, 2.0, 1.2),
        ],
    );
    let mut parts = vec![body, solid(-0.1, 2.1, 0.75)];
    for i in 0..6 {
        let a = TAU * f64::from(i) / 6.0;
        let place = DVec3::new(a.cos(), 0.0, a.sin()) * 1.8;
        parts.push(Cylinder::new(place - up, place + up, 0.2).into());
        parts.push(Cone::new(place + up * 0.55, 0.2, place + up * 0.76, 0.33).into());
    }
    parts.push(Cuboid::new(DVec3::new(-0.17, -0.1, 0.5), DVec3::new(0.17, 2.1, 1.0)).into());
    Object::csg(CsgOp::Difference, parts)
}
