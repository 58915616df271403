//! Layers of textures. Up to version 3.1 `filter` in an upper layer acts as `transmit`: the layers below are not tinted (measured
//! with POV-Ray 3.7).

use crate::parser::Parser;
use std::sync::Arc;
use strahl_shade::ColorFt;
use strahl_shade::pigment::Pigment;
use strahl_shade::texture::Texture as Surface;

/// Versions from this one on tint: 3.1 and a little above don't, 3.11 does.
const LAYERS_TINT_SINCE: f64 = 3.105;

/// The layers of `upper` over those of `lower`.
pub(super) fn layered(lower: Surface, upper: Surface) -> Surface {
    let layers = |texture| match texture {
        Surface::Layered(layers) => layers,
        single => vec![single].into(),
    };
    Surface::Layered([&*layers(lower), &*layers(upper)].concat().into())
}

fn straight_color(color: &mut ColorFt) {
    color.transmit += color.filter;
    color.filter = 0.0;
}

fn straight_pigment(pigment: &mut Pigment) {
    match pigment {
        Pigment::Solid(color, _) => straight_color(color),
        Pigment::ColorMap(_, map) => map
            .entries
            .make_mut()
            .iter_mut()
            .for_each(|(_, c)| straight_color(c)),
        Pigment::PigmentMap(_, map) => map
            .entries
            .make_mut()
            .iter_mut()
            .for_each(|(_, p)| straight_pigment(p)),
        Pigment::Blocks(_, list) => list.make_mut().iter_mut().for_each(straight_pigment),
        Pigment::Image(image, _) => {
            let image = Arc::make_mut(image);
            image.transmit_all += image.filter_all;
            image.filter_all = 0.0;
            if let Some(palette) = &mut image.palette {
                for [filter, transmit] in &mut Arc::make_mut(palette).entries {
                    *transmit += *filter;
                    *filter = 0.0;
                }
            }
        }
        Pigment::Average(members, _) => members
            .make_mut()
            .iter_mut()
            .for_each(|(_, p)| straight_pigment(p)),
        Pigment::UvMapped(inner) => straight_pigment(inner),
        Pigment::Quick(color, inner) => {
            straight_color(color);
            straight_pigment(inner);
        }
    }
}

fn straight(texture: &mut Surface) {
    match texture {
        Surface::Plain(plain) => straight_pigment(&mut plain.pigment),
        Surface::Layered(list)
        | Surface::Blocks(_, list)
        | Surface::MaterialMap(_, _, list)
        | Surface::Shared(_, list) => list.make_mut().iter_mut().for_each(straight),
        Surface::Map(_, map) => map
            .entries
            .make_mut()
            .iter_mut()
            .for_each(|(_, t)| straight(t)),
        Surface::Average(members, _) => {
            members.make_mut().iter_mut().for_each(|(_, t)| straight(t))
        }
        Surface::Transformed(_, inner) | Surface::UvMapped(inner) => straight(inner),
    }
}

impl Parser<'_> {
    /// A texture as the version has it, whose layers are those above the first.
    pub(super) fn layers_of_version(&self, texture: &mut Arc<Surface>) {
        if self.version >= LAYERS_TINT_SINCE || !matches!(**texture, Surface::Layered(_)) {
            return;
        }
        if let Surface::Layered(layers) = Arc::make_mut(texture) {
            layers.make_mut().iter_mut().skip(1).for_each(straight);
        }
    }
}
