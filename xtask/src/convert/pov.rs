//! Writes scenes for POV-Ray such that both programs do the same work.

use anyhow::{Context, Result, bail};
use std::fmt::Write;
use strahl::geometry::mesh::triangulate;
use strahl::geometry::{Shape, TriangleMesh};
use strahl::math::DVec3;
use strahl::scene::{Background, Camera, Object, ObjectKind, Scene};
use strahl::shade::{Color, LightKind, Material};

pub(super) fn to_pov(scene: &Scene) -> Result<String> {
    let mut out = String::new();
    // The Standard Procedural Databases' depth 5. POV-Ray counts the rays of the next level as well, but does not trace them.
    writeln!(
        out,
        "#version 3.7;\nglobal_settings {{ assumed_gamma 1 max_trace_level 5 adc_bailout 0 ambient_light 1 }}"
    )?;
    let camera = scene.camera.as_ref().context("the scene has no camera")?;
    write_camera(&mut out, camera)?;
    if let Some(Background::Solid(color)) = scene.background {
        writeln!(out, "background {{ color {} }}", rgb(color))?;
    }
    for light in &scene.lights {
        let LightKind::Point { position } = light.light.kind else {
            bail!("only point lights can be converted")
        };
        writeln!(
            out,
            "light_source {{ {} color {} }}",
            v(position),
            rgb(light.light.color)
        )?;
    }
    let ambient = scene.ambient.unwrap_or(Color::BLACK);
    for object in &scene.objects.0 {
        write_object(&mut out, object, ambient)?;
    }
    Ok(out)
}

fn write_camera(out: &mut String, c: &Camera) -> Result<()> {
    // In POV-Ray right and up are full extents, in strahl half extents.
    let (right, up) = (c.right * 2.0, c.up * 2.0);
    writeln!(
        out,
        "camera {{ perspective location {} right {} up {} direction {} }}",
        v(c.eye),
        v(right),
        v(up),
        v(c.direction)
    )?;
    Ok(())
}

fn write_object(out: &mut String, object: &Object, ambient: Color) -> Result<()> {
    let ObjectKind::Shape(shape) = &object.kind else {
        bail!("only plain shapes can be converted")
    };
    let material = object
        .material
        .as_deref()
        .context("an object has no material")?;
    let look = texture(material, ambient);
    match shape {
        Shape::Sphere(s) => writeln!(
            out,
            "sphere {{ {} {} {look} }}",
            v(s.center()),
            s.radius().abs()
        )?,
        // POV-Ray tests every edge of a polygon; many edges are faster as triangles in POV-Ray's own hierarchy.
        Shape::Polygon(p) if p.corners().len() > 8 => {
            writeln!(out, "mesh {{")?;
            let corner = |i: u32| v(p.corners()[i as usize]);
            for [a, b, c] in triangulate(p) {
                writeln!(
                    out,
                    "triangle {{ {} {} {} }}",
                    corner(a),
                    corner(b),
                    corner(c)
                )?;
            }
            writeln!(out, "{look} }}")?;
        }
        Shape::Polygon(p) => {
            let ring = p.corners();
            write!(out, "polygon {{ {}", ring.len() + 1)?;
            for corner in ring.iter().chain(ring.first()) {
                write!(out, " {}", v(*corner))?;
            }
            writeln!(out, " {look} }}")?;
        }
        Shape::TriangleMesh(mesh) => write_mesh(out, mesh, &look)?,
        Shape::Cylinder(c) => writeln!(
            out,
            "cylinder {{ {} {} {} {} {look} }}",
            v(c.base()),
            v(c.apex()),
            c.radius(),
            open(c.is_capped())
        )?,
        Shape::Cone(c) => writeln!(
            out,
            "cone {{ {} {} {} {} {} {look} }}",
            v(c.base()),
            c.base_radius(),
            v(c.apex()),
            c.apex_radius(),
            open(c.is_capped())
        )?,
        other => bail!("cannot convert {other:?}"),
    }
    Ok(())
}

fn open(capped: bool) -> &'static str {
    if capped { "" } else { "open" }
}

fn write_mesh(out: &mut String, mesh: &TriangleMesh, look: &str) -> Result<()> {
    writeln!(out, "mesh {{")?;
    for triangle in 0..mesh.triangle_count() {
        let [a, b, c] = mesh.corners(triangle);
        match mesh.corner_normals(triangle) {
            Some([na, nb, nc]) => {
                writeln!(
                    out,
                    "smooth_triangle {{ {} {} {} {} {} {} }}",
                    v(a),
                    v(na),
                    v(b),
                    v(nb),
                    v(c),
                    v(nc)
                )?;
            }
            None => writeln!(out, "triangle {{ {} {} {} }}", v(a), v(b), v(c))?,
        }
    }
    writeln!(out, "{look} }}")?;
    Ok(())
}

/// kd is divided by 1 - transmit, because POV-Ray shows that part of the pigment.
fn texture(material: &Material, ambient: Color) -> String {
    let f = &material.finish;
    let transmit = f.transmission.max_component();
    let opaque = if transmit < 1.0 { 1.0 - transmit } else { 1.0 };
    let pigment = f.diffuse / opaque;
    let interior = if transmit > 0.0 {
        format!(" interior {{ ior {} }}", material.eta)
    } else {
        String::new()
    };
    let highlight = match f.specular.max_component() {
        ks if ks > 0.0 => format!(" phong {ks} phong_size {}", f.shininess),
        _ => String::new(),
    };
    let reflects = f.reflection.max_component();
    // POV-Ray sends no reflection ray for a coefficient of 0; the SPD rules require one for transmitting objects.
    let reflection = if reflects > 0.0 || transmit > 0.0 {
        format!(
            " reflection {{ {} }}",
            if reflects > 0.0 { reflects } else { 1e-9 }
        )
    } else {
        String::new()
    };
    let ambient = if f.diffuse.max_component() > 0.0 {
        ambient.max_component()
    } else {
        0.0
    };
    format!(
        "pigment {{ color rgb {} transmit {transmit} }} finish {{ ambient {ambient} diffuse 1{highlight}{reflection} }}{interior}",
        v(DVec3::new(pigment.r, pigment.g, pigment.b))
    )
}

fn rgb(c: Color) -> String {
    format!("rgb <{},{},{}>", c.r, c.g, c.b)
}

fn v(p: DVec3) -> String {
    format!("<{},{},{}>", p.x, p.y, p.z)
}
