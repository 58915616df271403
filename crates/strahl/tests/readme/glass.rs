use std::ops::ControlFlow;
use strahl::prelude::*;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let description = Scene::new()
        .add(Plane::new(DVec3::ZERO, DVec3::Y).material(Material::matte(Color::gray(0.7))))
        .add(Sphere::new(DVec3::Y, 1.0).material(Material::glass(1.5)))
        .light(Light::point(DVec3::new(4.0, 8.0, 6.0), Color::WHITE))
        .camera(Camera::perspective(
            DVec3::new(0.0, 2.0, 7.0),
            DVec3::Y,
            DVec3::Y,
            0.7,
        ));
    let session = Session::new(Threads::All)?;
    let (scene, _warnings) = session.compile(&description, &CompileOptions::default())?;
    let view = scene.view(640, 480).with_sampling(Sampling::ADAPTIVE);
    let mut progress = |tile: &Tile<'_>| {
        eprint!(
            "\rpass {} of {}: part {} of {}  ",
            tile.pass.number + 1,
            tile.pass.of,
            tile.done,
            tile.of
        );
        ControlFlow::Continue(())
    };
    let outcome = session.render(&view, &Output::default(), &mut progress)?;
    Ok(strahl::save(
        "glass.png".as_ref(),
        outcome.film(),
        &WriteOptions::default(),
    )?)
}
