//! Textures: their syntax, their descriptions, the messages about errors, and pigments compared with POV-Ray's.

mod bitmaps;
mod messages;
mod povray;
mod statements;

use crate::common::parse_with;
use std::sync::Arc;
use strahl_math::DVec3;
use strahl_scene::Scene;
use strahl_sdl::MemoryHost;
use strahl_shade::ColorFt;
use strahl_shade::patterns::TexturePoint;
use strahl_shade::texture::{PlainTexture, Texture};

/// A picture of 2 x 2 texels: red, green above blue, white.
const PICTURE: &[u8] = b"P6\n2 2\n255\n\xff\0\0\0\xff\0\0\0\xff\xff\xff\xff";

fn parse(text: &str) -> (Option<Scene>, Vec<String>) {
    let mut host = MemoryHost::new().with_file("p.ppm", PICTURE);
    let parsed = parse_with(&mut host, text);
    let messages = parsed.diagnostics.iter().map(ToString::to_string);
    (parsed.scene, messages.collect())
}

fn scene(text: &str) -> (Scene, Vec<String>) {
    let (scene, messages) = parse(text);
    let Some(scene) = scene else {
        panic!("{text}\n{}", messages.join("\n"));
    };
    (scene, messages)
}

/// The textures of the objects of a text without messages.
fn textures(text: &str) -> Vec<Arc<Texture>> {
    let (scene, messages) = scene(text);
    assert!(messages.is_empty(), "{text}\n{}", messages.join("\n"));
    let objects = scene.objects.0.iter();
    let materials = objects.map(|o| o.material.as_ref().expect("a material"));
    materials
        .map(|m| Arc::clone(&m.texture.as_ref().expect("a texture").0))
        .collect()
}

fn texture(items: &str) -> Arc<Texture> {
    textures(&format!("sphere {{ 0, 1 {items} }}")).remove(0)
}

fn plain(items: &str) -> PlainTexture {
    match &*texture(items) {
        Texture::Plain(plain) => PlainTexture::clone(plain),
        other => panic!("{items}: {other:?}"),
    }
}

fn color_at(texture: &Texture, p: DVec3) -> ColorFt {
    match texture {
        Texture::Plain(plain) => plain.pigment.color_at(&TexturePoint::in_space(p)),
        other => panic!("{other:?}"),
    }
}
