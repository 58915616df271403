//! Fractals as colours: those of several surfaces are computed together.

use super::point::{Lanes, Point};
use crate::layers::KnownPaints;
use crate::scene::RenderScene;
use arrayvec::ArrayVec;
use strahl_accel::PACKET;
use strahl_math::DVec2;
use strahl_shade::ColorFt;
use strahl_shade::patterns::TexturePoint;
use strahl_shade::pigment::FractalPigment;
use strahl_shade::texture::Texture;

/// A surface whose colour comes from a fractal.
struct Place<'s> {
    lane: usize,
    fractal: FractalPigment<'s>,
    at: DVec2,
}

/// Computes the colours of surfaces whose pigments are fractals, for [`paint`](crate::layers::paint).
#[inline]
pub(super) fn follow_fractals<'s>(
    scene: &'s RenderScene,
    points: &mut [Point<'s>],
    lanes: &Lanes,
    paints: &KnownPaints<'s>,
) {
    if paints.has_fractals && lanes.len() > 1 {
        follow(scene, points, lanes);
    }
}

#[cold]
fn follow<'s>(scene: &'s RenderScene, points: &mut [Point<'s>], lanes: &Lanes) {
    for lane in lanes {
        points[*lane].paint.pigment = None;
    }
    let places = lanes.iter().filter_map(|lane| place(scene, points, *lane));
    let mut places: ArrayVec<Place<'s>, PACKET> = places.collect();
    while let Some(first) = places.last().map(|place| place.fractal) {
        let mut at = ArrayVec::<DVec2, PACKET>::new();
        let mut same = ArrayVec::<usize, PACKET>::new();
        places.retain(|place| {
            let is_same = place.fractal.is(&first);
            if is_same {
                at.push(place.at);
                same.push(place.lane);
            }
            !is_same
        });
        let mut colors = [ColorFt::default(); PACKET];
        first.store_colors(&at, &mut colors[..at.len()]);
        for (lane, color) in same.into_iter().zip(colors) {
            points[lane].paint.pigment = Some(color);
        }
    }
}

/// The fractal of a surface, if it has one, and the place there.
fn place<'s>(scene: &'s RenderScene, points: &[Point<'s>], lane: usize) -> Option<Place<'s>> {
    let Point { surface, hit, .. } = &points[lane];
    let look = &surface.resolved.look;
    let material = &scene.materials[look.material.0 as usize];
    let texture: &'s Texture = &material.texture_seen(surface.entering)?.0;
    let fractal = texture.fractal()?;
    let mut place = TexturePoint {
        uv: surface.resolved.point.uv,
        ..TexturePoint::in_space(surface.resolved.point.position)
    };
    let mut made = None;
    let position = match scene.texture_place(&mut place, hit, look, &mut made) {
        None => place.position,
        Some(space) => space.point_to_object(place.position),
    };
    Some(Place {
        lane,
        fractal,
        at: fractal.place(position),
    })
}
