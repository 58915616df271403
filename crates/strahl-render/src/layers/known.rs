//! Textures of one colour: their layers are evaluated once.

use crate::scene::RenderScene;
use crate::surface::{Side, Surface};
use std::borrow::Cow;
use strahl_math::DVec3;
use strahl_shade::pov_finish::LightsShown;
use strahl_shade::texture::{LayerPoint, StackPoint, Texture, TexturePaint};
use strahl_shade::{Color, Finish};

/// The layers of materials that are the same everywhere, by material and side, as one thread has met them.
#[derive(Debug)]
pub(crate) struct KnownPaints<'s> {
    known: Vec<Known<'s>>,
    /// Those whose colours at several points take less time together, by material and side.
    gains: Vec<bool>,
    /// Whether there are any.
    pub(crate) some_gain: bool,
}

/// What is known of the layers of a material.
#[derive(Debug)]
pub(super) enum Known<'s> {
    Unknown,
    /// They differ from point to point, or there are several.
    Varies,
    Same(Box<KnownPaint<'s>>),
}

/// The layer of a material that has one, the same everywhere but for its normal.
#[derive(Debug)]
pub(super) struct KnownPaint<'s> {
    layer: LayerPoint<'s>,
    stack: StackPoint,
    transmission: Color,
    /// The coefficients of the surface.
    sum: Finish,
    shown: LightsShown,
    has_grain: bool,
}

impl<'s> Known<'s> {
    /// What a texture with these layers at a surface, and this sum of coefficients, tells of all surfaces.
    pub(super) fn of(
        texture: &Texture,
        paint: &TexturePaint<'s>,
        surface: &Surface<'_>,
        sum: Finish,
    ) -> Self {
        match (&paint.layers[..], &paint.stacks[..]) {
            ([layer], [stack]) if texture.is_same_everywhere() => {
                Self::Same(Box::new(KnownPaint {
                    layer: *layer,
                    stack: *stack,
                    transmission: paint.transmission,
                    sum,
                    shown: surface.shown,
                    has_grain: surface.has_grain,
                }))
            }
            _ => Self::Varies,
        }
    }
}

impl<'s> KnownPaints<'s> {
    /// With more materials nothing is remembered: each may have a colour of its own.
    const MOST: usize = 4096;

    /// Nothing is known yet.
    pub(crate) fn new(scene: &RenderScene) -> Self {
        let materials = scene.materials.len();
        let count = if materials > Self::MOST {
            0
        } else {
            2 * materials
        };
        let mut known = Vec::new();
        known.resize_with(count, || Known::Unknown);
        let textures = scene.materials[..count / 2]
            .iter()
            .flat_map(|material| [material.texture_seen(false), material.texture_seen(true)]);
        let gains: Vec<bool> = textures
            .map(|texture| texture.is_some_and(|t| t.0.gains_together()))
            .collect();
        Self {
            some_gain: gains.contains(&true),
            gains,
            known,
        }
    }

    /// Whether the colours of this side of a material at several points take less time together.
    pub(crate) fn gains_together(&self, side: Side) -> bool {
        self.gains
            .get(Self::number(side))
            .is_some_and(|gains| *gains)
    }

    fn number((material, outside): Side) -> usize {
        2 * material.0 as usize + usize::from(outside)
    }

    #[inline]
    pub(super) fn of(&mut self, side: Side) -> Option<&mut Known<'s>> {
        self.known.get_mut(Self::number(side))
    }
}

impl<'s> KnownPaint<'s> {
    /// Evaluates the texture at a surface of this side of its material: what [`paint`](super::paint) does, with the same bits.
    #[inline(always)]
    pub(super) fn put(&self, side: Side, surface: &mut Surface<'_>, paint: &mut TexturePaint<'s>) {
        let normal = surface.n_shade;
        surface.n_refract = normal;
        (surface.shown, surface.has_grain) = (self.shown, self.has_grain);
        if surface.painted == Some(side)
            && let (Some(layer), Some(stack)) = (paint.layers.first_mut(), paint.stacks.first_mut())
        {
            (layer.normal, stack.normal) = (normal, normal);
        } else {
            surface.painted = Some(side);
            self.put_all(normal, surface, paint);
        }
    }

    /// Stores everything that the layer has.
    #[inline(never)]
    fn put_all(&self, normal: DVec3, surface: &mut Surface<'_>, paint: &mut TexturePaint<'s>) {
        paint.layers.clear();
        paint.layers.push(LayerPoint {
            normal,
            ..self.layer
        });
        paint.stacks.clear();
        paint.stacks.push(StackPoint {
            normal,
            ..self.stack
        });
        paint.transmission = self.transmission;
        surface.material.fresnel = false;
        surface.material.fresnel_reflection = Color::BLACK;
        surface.material.finish = Cow::Owned(self.sum);
        surface.find_dull();
    }
}
