//! Surfaces with POV-Ray's textures: several layers, each with a colour, a normal and a finish of its own.

use crate::hit::Hit;
use crate::scene::RenderScene;
use crate::surface::Surface;
use strahl_math::DVec3;
use strahl_shade::patterns::TexturePoint;
use strahl_shade::texture::{LayerPoint, TexturePaint};
use strahl_shade::{Color, Finish};

/// Evaluates the texture at a surface, if its material has one: the layers into `paint`, what they amount to into the
/// surface's coefficients (`specular` is left black: highlights are the layers' own). `paint` is left without layers
/// otherwise.
pub(crate) fn paint<'s>(
    scene: &'s RenderScene,
    surface: &mut Surface,
    hit: &Hit,
    paint: &mut TexturePaint<'s>,
) {
    let look = &surface.resolved.look;
    let material = &scene.materials[look.material.0 as usize];
    let Some(texture) = material.texture_seen(surface.entering) else {
        paint.layers.clear();
        return;
    };
    let point = &surface.resolved.point;
    let place = TexturePoint {
        position: point.position,
        surface: point.position,
        n_geom: surface.n_geom,
        n_shade: surface.n_shade,
        uv: point.uv,
        direction: -surface.v,
    };
    let space = scene.texture_space(hit, look);
    let eta = surface.eta_2 / surface.eta_1;
    texture.0.layers_in(space.as_ref(), &place, eta, paint);

    let mut sum = Finish {
        transmission: paint.transmission,
        ..Finish::BLACK
    };
    let mut strongest = 0.0;
    if let Some(top) = paint.layers.first() {
        surface.n_shade = top.normal;
    }
    for layer in &paint.layers {
        let body = body(layer);
        sum.ambient += body * layer.finish.ambient;
        sum.emission += body * layer.finish.emission;
        sum.diffuse += body * layer.finish.diffuse;
        let reflection = layer.reflectance * layer.share;
        sum.reflection += reflection;
        // One reflection ray for all layers: where the one that reflects most sends it.
        if reflection.max_component() > strongest {
            strongest = reflection.max_component();
            surface.n_shade = layer.normal;
        }
    }
    surface.material.finish = sum;
    surface.material.fresnel = false;
    surface.material.fresnel_reflection = Color::BLACK;
}

/// What the layers make of light of this colour from the direction `l`: the diffuse part and the highlights.
pub(crate) fn lit(
    paint: &TexturePaint<'_>,
    surface: &Surface,
    l: DVec3,
    light: Color,
) -> (Color, Color) {
    let (mut diffuse, mut highlights) = (Color::BLACK, Color::BLACK);
    for layer in &paint.layers {
        let cos = layer.normal.dot(l);
        let both_sides = surface.lit.both_sides;
        let factor = layer
            .finish
            .diffuse_factor(if both_sides { cos.abs() } else { cos });
        diffuse += body(layer) * light * factor;
        if !(cos > 0.0 || both_sides) {
            continue;
        }
        let highlight = layer
            .finish
            .highlight(layer.normal, l, surface.v, layer.color.rgb);
        highlights += layer.above * highlight * light * layer.share;
    }
    (diffuse, highlights)
}

/// Whether light from the direction `l` shows on any layer.
pub(crate) fn faces(paint: &TexturePaint<'_>, l: DVec3) -> bool {
    paint
        .layers
        .iter()
        .any(|layer| layer.normal.dot(l) > 0.0 || layer.finish.diffuse_back != 0.0)
}

/// What `crand` takes from the surface's own light.
pub(crate) fn grained(paint: &TexturePaint<'_>, place: DVec3, light: Color) -> Color {
    let loss: f64 = paint
        .layers
        .iter()
        .map(|layer| layer.finish.grain(place) * layer.share)
        .sum();
    if loss == 0.0 {
        return light;
    }
    light.map(|x| if x > loss { x - loss } else { 0.0 })
}

/// The layer's colour as far as it is opaque and not hidden.
fn body(layer: &LayerPoint<'_>) -> Color {
    layer.color.rgb * layer.above * (layer.share * layer.color.opacity())
}
