//! Writes scenes in Tachyon's own format.
//!
//! Tachyon's space is left-handed: everything is mirrored in x, which leaves the picture as it is. Tachyon doesn't refract.

use anyhow::{Context, Result, bail};
use std::collections::HashMap;
use std::fmt::Write;
use strahl::geometry::Shape;
use strahl::geometry::mesh::triangulate;
use strahl::math::DVec3;
use strahl::scene::{Background, Camera, ObjectKind, Scene};
use strahl::shade::{Color, LightKind, Material};

pub(super) fn to_dat(scene: &Scene) -> Result<String> {
    let mut out =
        String::from("Begin_Scene\nResolution 512 512\nShader_Mode Full\nEnd_Shader_Mode\n");
    let camera = scene.camera.as_ref().context("the scene has no camera")?;
    write_camera(&mut out, camera)?;
    if let Some(Background::Solid(color)) = scene.background {
        writeln!(out, "Background {}", rgb(color))?;
    }
    for light in &scene.lights {
        let LightKind::Point { position } = light.light.kind else {
            bail!("only point lights can be converted")
        };
        let color = rgb(light.light.color);
        writeln!(out, "Light Center {} Rad 0.0001 Color {color}", v(position))?;
    }
    let ambient = scene.ambient.unwrap_or(Color::BLACK);
    let mut looks = HashMap::new();
    for object in &scene.objects.0 {
        let ObjectKind::Shape(shape) = &object.kind else {
            bail!("only plain shapes can be converted")
        };
        let material = object.material.as_deref();
        let material = material.context("an object has no material")?;
        let look = look(material, ambient);
        let count = looks.len();
        let name = match looks.get(&look) {
            Some(name) => String::clone(name),
            None => {
                let name = format!("t{count}");
                writeln!(out, "TexDef {name} {look}")?;
                looks.insert(look, name.clone());
                name
            }
        };
        write_shape(&mut out, shape, &name)?;
    }
    out.push_str("End_Scene\n");
    Ok(out)
}

fn write_camera(out: &mut String, c: &Camera) -> Result<()> {
    // Measured: at zoom 1 the picture is one unit high at a distance of one.
    let zoom = 0.5 * c.direction.length() / c.up.length();
    writeln!(
        out,
        "Camera\nProjection Perspective\nZoom {zoom}\nAspectRatio 1\nAntialiasing 0\nRayDepth 5\nCenter {}\nViewDir {}\nUpDir {}\nEnd_Camera",
        v(c.eye),
        v(c.direction.normalize()),
        v(c.up.normalize()),
    )?;
    Ok(())
}

fn write_shape(out: &mut String, shape: &Shape, look: &str) -> Result<()> {
    match shape {
        Shape::Sphere(s) => {
            let (center, radius) = (v(s.center()), s.radius().abs());
            writeln!(out, "Sphere Center {center} Rad {radius} {look}")?;
        }
        Shape::Polygon(p) => {
            for triangle in triangulate(p) {
                let [a, b, c] = triangle.map(|i| v(p.corners()[i as usize]));
                writeln!(out, "Tri V0 {a} V1 {b} V2 {c} {look}")?;
            }
        }
        Shape::TriangleMesh(mesh) => {
            for triangle in 0..mesh.triangle_count() {
                let [a, b, c] = mesh.corners(triangle).map(v);
                match mesh.corner_normals(triangle) {
                    Some(normals) => {
                        let [na, nb, nc] = normals.map(v);
                        writeln!(
                            out,
                            "STri V0 {a} V1 {b} V2 {c} N0 {na} N1 {nb} N2 {nc} {look}"
                        )?;
                    }
                    None => writeln!(out, "Tri V0 {a} V1 {b} V2 {c} {look}")?,
                }
            }
        }
        Shape::Cylinder(c) if !c.is_capped() => {
            let (base, apex, radius) = (v(c.base()), v(c.apex()), c.radius());
            writeln!(out, "FCylinder Base {base} Apex {apex} Rad {radius} {look}")?;
        }
        other => bail!("Tachyon has no shape like {other:?}"),
    }
    Ok(())
}

/// The properties of a material, without its name.
fn look(material: &Material, ambient: Color) -> String {
    let f = &material.finish;
    let opacity = 1.0 - f.transmission.max_component();
    format!(
        "Ambient {} Diffuse 1 Specular {} Opacity {opacity} Phong Plastic {} Phong_size {} Color {} TexFunc 0",
        ambient.max_component(),
        f.reflection.max_component(),
        f.specular.max_component(),
        f.shininess,
        rgb(f.diffuse),
    )
}

fn rgb(c: Color) -> String {
    format!("{} {} {}", c.r, c.g, c.b)
}

fn v(p: DVec3) -> String {
    format!("{} {} {}", -p.x, p.y, p.z)
}
