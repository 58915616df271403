//! Colours of textures: those of surfaces that have the same texture are computed together.

use super::point::{Lanes, Point};
use crate::layers::KnownPaints;
use crate::scene::RenderScene;
use arrayvec::ArrayVec;
use strahl_accel::PACKET;
use strahl_shade::patterns::TexturePoint;
use strahl_shade::texture::Texture;

/// A surface, and its texture and where that is evaluated.
struct Place<'s> {
    lane: usize,
    texture: &'s Texture,
    point: TexturePoint,
}

/// Computes the colours of surfaces with textures of which several points take less time together, for
/// [`paint`](crate::layers::paint).
#[inline]
pub(super) fn find_colors<'s>(
    scene: &'s RenderScene,
    points: &mut [Point<'s>],
    lanes: &Lanes,
    paints: &KnownPaints<'s>,
) {
    if paints.some_gain && lanes.len() > 1 {
        find(scene, points, lanes, paints);
    }
}

#[inline(never)]
fn find<'s>(
    scene: &'s RenderScene,
    points: &mut [Point<'s>],
    lanes: &Lanes,
    paints: &KnownPaints<'s>,
) {
    let mut places = ArrayVec::<Place<'s>, PACKET>::new();
    for lane in lanes {
        points[*lane].paint.colors.clear();
        places.extend(place(scene, points, *lane, paints));
    }
    while let Some(texture) = places.last().map(|place| place.texture) {
        let mut at = ArrayVec::<TexturePoint, PACKET>::new();
        let mut same = Lanes::new();
        places.retain(|place| {
            let is_same = std::ptr::eq(place.texture, texture);
            if is_same {
                at.push(place.point);
                same.push(place.lane);
            }
            !is_same
        });
        // One alone is evaluated where it is painted.
        if at.len() > 1 {
            texture.store_colors(&at, |colors| {
                for (lane, color) in same.iter().zip(colors) {
                    points[*lane].paint.colors.push(*color);
                }
            });
        }
    }
}

/// The texture of a surface and its place there, if its colours take less time together with others.
fn place<'s>(
    scene: &'s RenderScene,
    points: &[Point<'s>],
    lane: usize,
    paints: &KnownPaints<'s>,
) -> Option<Place<'s>> {
    let Point { surface, hit, .. } = &points[lane];
    let appearance = &surface.resolved.appearance;
    if !paints.gains_together((appearance.material, surface.entering)) {
        return None;
    }
    let material = &scene.materials[appearance.material.0 as usize];
    let texture: &'s Texture = &material.texture_seen(surface.entering)?.0;
    let mut point = TexturePoint {
        uv: surface.resolved.point.uv,
        ..TexturePoint::in_space(surface.resolved.point.position)
    };
    let mut made = None;
    if let Some(space) = scene.texture_place(&mut point, hit, &surface.resolved, &mut made) {
        point.position = space.point_to_object(point.position);
    }
    Some(Place {
        lane,
        texture,
        point,
    })
}
