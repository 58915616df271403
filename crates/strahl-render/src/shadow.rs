mod report;

use crate::activity::Phase;
use crate::hit::{Hit, Origin};
use crate::media::{Crossing, MediaArena, MediaStack};
use crate::query::Intersector;
use crate::resolve::{Resolved, Uv};
use crate::uses::InstanceUse;
use strahl_math::{Interval, Ray};
use strahl_shade::Color;

/// The last part of the way to a mask, which is ignored: a stencil that is also visible lies in its mask except for rounding
/// errors, and must not shade the light that it lets through.
const MASK_SKIN: f64 = 1e-6;

/// The visibility of a light from a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Shadow {
    /// The share of the light that arrives, per channel.
    pub(crate) visible: Color,
    /// Whether anything was in between.
    pub(crate) hit: bool,
}

impl Shadow {
    /// The light is blocked.
    pub(crate) const STOPPED: Self = Self {
        visible: Color::BLACK,
        hit: true,
    };

    /// The light is not obstructed.
    pub(crate) const NONE: Self = Self {
        visible: Color::WHITE,
        hit: false,
    };
}

/// What a shadow ray keeps of the light up to a surface that lets some through, or behind the last one.
struct Transmittance<'h> {
    /// The hit and the number of its object.
    surface: Option<(&'h Hit, u32)>,
    /// What the surface lets through.
    filter: Color,
    /// What the medium in front of it keeps.
    absorbed: Color,
}

/// A ray towards a light.
#[derive(Clone, Copy)]
pub(crate) struct ShadowRay<'r> {
    pub(crate) ray: &'r Ray,
    /// Where occluders are looked for.
    pub(crate) range: Interval,
    pub(crate) from: &'r Origin,
    /// Number of the light.
    pub(crate) light: usize,
    /// The media that the ray starts in.
    pub(crate) media: MediaStack,
}

impl Intersector<'_> {
    /// Traces a shadow ray: without any hit all light arrives, behind an opaque surface none; transparent surfaces filter it by
    /// their kt and their insides by Beer-Lambert. Light that is projected through a mask starts at the mask.
    ///
    /// The filters are multiplied in the order of the hits along the ray, so the order in which the accelerator found them
    /// does not matter.
    pub(crate) fn shadow(
        &mut self,
        shadow_ray: &ShadowRay<'_>,
        arena: &mut MediaArena,
        hits: &mut Vec<Hit>,
    ) -> Shadow {
        let light = shadow_ray.light;
        let mut range = shadow_ray.range;
        if let Some(mask) = self.scene.mask(light) {
            let Some(masked) = self.before_mask(mask, shadow_ray.ray, range) else {
                return Shadow {
                    visible: Color::BLACK,
                    hit: false,
                };
            };
            range = masked;
            if !self.scene.lights[light].light.casts_shadows {
                return Shadow::NONE;
            }
        }
        if self.occluded(shadow_ray.ray, range, shadow_ray.from, light) {
            return Shadow::STOPPED;
        }
        let shadow_ray = ShadowRay {
            range,
            ..*shadow_ray
        };
        self.filtered_by(&shadow_ray, arena, hits, |_| {})
    }

    /// The part of the way in front of what the light has to cross; `None` where it does not. Objects within the mask or
    /// beyond it cast no shadows.
    #[inline]
    fn before_mask(&mut self, mask: &InstanceUse, ray: &Ray, range: Interval) -> Option<Interval> {
        let crossing = self.crossing(mask, ray, range)?;
        Some(range.with_max(crossing * (1.0 - MASK_SKIN)))
    }

    /// The share of the light that arrives if nothing opaque is in between, telling what each hit lets through.
    #[inline]
    fn filtered_by(
        &mut self,
        shadow_ray: &ShadowRay<'_>,
        arena: &mut MediaArena,
        hits: &mut Vec<Hit>,
        tell: impl FnMut(Transmittance<'_>),
    ) -> Shadow {
        if !self.scene.transmits {
            return Shadow::NONE;
        }
        hits.clear();
        let ShadowRay {
            ray, range, from, ..
        } = shadow_ray;
        self.transmitting_hits(ray, *range, Some(from), hits);
        self.weakened_by(shadow_ray, arena, hits, tell)
    }

    /// The share of the light that arrives if these surfaces, which may transmit light, are all that is in between.
    pub(crate) fn filtered(
        &mut self,
        shadow_ray: &ShadowRay<'_>,
        arena: &mut MediaArena,
        hits: &mut Vec<Hit>,
    ) -> Shadow {
        self.weakened_by(shadow_ray, arena, hits, |_| {})
    }

    /// The same, telling what each of them lets through.
    #[inline]
    fn weakened_by(
        &mut self,
        shadow_ray: &ShadowRay<'_>,
        arena: &mut MediaArena,
        hits: &mut Vec<Hit>,
        mut tell: impl FnMut(Transmittance<'_>),
    ) -> Shadow {
        if hits.is_empty() {
            // Compiled by itself, without a place for surfaces.
            return self.weakened(shadow_ray, arena, &[], &mut tell);
        }
        hits.sort_unstable_by(|a, b| a.t.total_cmp(&b.t).then(a.id.cmp(&b.id)));
        // A grid may report a primitive more than once; an element has one hit at one t.
        hits.dedup_by(|a, b| a.t == b.t && a.id == b.id);
        self.weakened(shadow_ray, arena, hits, &mut tell)
    }

    /// What these surfaces, one behind the other, and what is between them leave of the light.
    #[inline(always)]
    fn weakened(
        &mut self,
        shadow_ray: &ShadowRay<'_>,
        arena: &mut MediaArena,
        hits: &[Hit],
        tell: &mut impl FnMut(Transmittance<'_>),
    ) -> Shadow {
        let ShadowRay {
            ray,
            range,
            from,
            media,
            ..
        } = shadow_ray;
        let mut visible = Color::WHITE;
        let (mut inside, mut entered_at) = (*media, 0.0);
        let mut resolved = Resolved::UNKNOWN;
        for hit in hits.iter() {
            self.slot.enter_for(Phase::Texture, hit.id);
            let scene = self.scene;
            scene.resolve(ray, Some(from), hit, Uv::IfTextured, &mut resolved);
            let id = resolved.appearance.material;
            let material = &self.scene.materials[id.0 as usize];
            let entering = resolved.point.n_geom.dot(ray.direction) < 0.0;
            let filter = match material.texture_seen(entering) {
                None => material.at(resolved.point.uv).finish.transmission,
                Some(texture) => {
                    let caustics = material.interior.as_ref().map_or(0.0, |i| i.caustics);
                    self.scene
                        .attenuated(&texture.0, &resolved, ray.direction, hit, caustics)
                }
            };
            visible *= filter;
            let own = resolved.appearance.medium(material, resolved.space);
            let stretch = (hit.t - entered_at) * ray.direction.length();
            let leaves = match Crossing::of(material) {
                Crossing::BySide => !entering,
                Crossing::ByTurns => arena.is_inside(inside, own.body),
            };
            let absorbed = if leaves && own.body.is_object() {
                self.scene.faded_shadow(id, stretch)
            } else {
                self.scene.absorbed(arena.top(inside), stretch)
            };
            visible *= absorbed;
            tell(Transmittance {
                surface: Some((hit, resolved.appearance.object)),
                filter,
                absorbed,
            });
            if visible.is_black() {
                return Shadow { visible, hit: true };
            }
            entered_at = hit.t;
            inside = if leaves {
                arena.left(inside, own.body)
            } else {
                arena.entered(inside, own)
            };
        }
        if range.max.is_finite() {
            let stretch = (range.max - entered_at) * ray.direction.length();
            let absorbed = self.scene.absorbed(arena.top(inside), stretch);
            visible *= absorbed;
            tell(Transmittance {
                surface: None,
                filter: Color::WHITE,
                absorbed,
            });
        }
        Shadow {
            visible,
            hit: !hits.is_empty(),
        }
    }
}
