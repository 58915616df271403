//! A homage to the picture of Whitted's 1980 paper: a glass sphere in front of a mirror sphere over a checkered floor.
//!
//! ```sh
//! cargo run --release -p strahl --example whitted -- whitted.png
//! ```

use std::error::Error;
use std::path::PathBuf;
use std::sync::Arc;
use strahl::prelude::*;

fn main() -> Result<(), Box<dyn Error>> {
    let output = PathBuf::from(std::env::args_os().nth(1).unwrap_or("whitted.png".into()));
    let session = Session::new(Threads::All)?;
    let (scene, _warnings) = session.compile(&scene(), &CompileOptions::default())?;
    let view = scene.view(960, 720).with_sampling(Sampling::Grid(3));
    let picture = session.picture(&view, &Output::default())?;
    strahl::save(&output, &picture.film, &WriteOptions::default())?;
    Ok(())
}

fn scene() -> Scene {
    let glass = Material {
        absorption: Color::new(0.05, 0.02, 0.03),
        ..Material::glass(1.5)
    };
    let chrome = Material::mirror(Color::gray(0.75));
    let sky = Background::Gradient {
        up: DVec3::Y,
        bottom: Color::new(0.75, 0.83, 0.95),
        top: Color::new(0.12, 0.28, 0.65),
    };
    let scene = Scene::new()
        .add(
            Sphere::new(DVec3::new(-0.25, 1.45, 1.4), 0.85)
                .material(glass)
                .named("glass sphere"),
        )
        .add(
            Sphere::new(DVec3::new(1.05, 1.0, -0.9), 1.0)
                .material(chrome)
                .named("mirror sphere"),
        )
        .light(Light::point(DVec3::new(5.0, 9.0, 6.0), Color::gray(0.9)))
        .light(Light::directional(
            DVec3::new(1.0, -1.5, -1.0),
            Color::new(0.12, 0.13, 0.16),
        ))
        .background(sky)
        .camera(Camera::perspective(
            DVec3::new(0.3, 2.3, 7.0),
            DVec3::new(0.3, 1.0, 0.0),
            DVec3::Y,
            0.6,
        ));
    checkered(scene)
}

/// Red and yellow tiles.
fn checkered(mut scene: Scene) -> Scene {
    let colors = [Color::new(0.85, 0.12, 0.06), Color::new(0.95, 0.80, 0.15)];
    let materials = colors.map(|c| Arc::new(Material::matte(c)));
    for z in -24..6 {
        for x in -20..20i32 {
            let (x0, z0) = (f64::from(x) * 0.8, f64::from(z) * 0.8);
            let tile = Cuboid::new(
                DVec3::new(x0, -0.1, z0),
                DVec3::new(x0 + 0.8, 0.0, z0 + 0.8),
            );
            let color = (x + z).rem_euclid(2) as usize;
            scene = scene.add(tile.material(Arc::clone(&materials[color])));
        }
    }
    scene
}
