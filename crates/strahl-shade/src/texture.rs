//! Textures: pigment, normal and finish together, in layers and by patterns.

mod paint;
mod spaces;

pub use paint::{LAYERS, LayerPoint, StackPoint, TexturePaint};

use std::sync::Arc;

use arrayvec::ArrayVec;
use strahl_math::{DVec3, Transform};

use crate::image_map::ImageMap;
use crate::interior::Interior;
use crate::normal::PovNormal;
use crate::patterns::{BATCH, Modifiers, PatternField, TexturePoint};
use crate::pigment::{Blend, BlendMap, Pigment};
use crate::pov_finish::PovFinish;
use crate::{Color, ColorFt, SharedList};
use paint::Stack;
use spaces::{Chain, Identity, NormalSpace, Ways};

/// One texture statement: pigment, normal and finish.
#[derive(Clone, Debug, Default)]
pub struct PlainTexture {
    /// The colour.
    pub pigment: Pigment,
    /// The perturbation of the normal; none by default.
    pub normal: Option<Box<PovNormal>>,
    /// The finish, which several textures may share.
    pub finish: Arc<PovFinish>,
}

/// The look of a surface. Small, because a scene may have one for each of a million objects.
#[derive(Clone, Debug)]
pub enum Texture {
    /// One pigment, normal and finish.
    Plain(PlainTexture),
    /// Textures laid over each other, the lowest first, as they are written.
    Layered(SharedList<Texture>),
    /// Two textures blended by the value of a pattern (`texture_map`).
    Map(Box<PatternField>, BlendMap<Texture>),
    /// The texture of the block a point lies in. Blocks beyond the list take its last.
    Blocks(Box<PatternField>, SharedList<Texture>),
    /// The weighted mean of textures (`average`), at the point moved by these modifiers.
    Average(SharedList<(f64, Texture)>, Box<Modifiers>),
    /// The texture whose number a picture's texel holds (`material_map`): red · 255, or the code of a grey picture, modulo the
    /// number of textures.
    MaterialMap(Arc<ImageMap>, Box<Modifiers>, SharedList<Texture>),
    /// Textures mixed by shares that vary from point to point, as those of a blob's components.
    Shared(Arc<dyn Shares>, SharedList<Texture>),
    /// A texture in a space of its own.
    Transformed(Box<Transform>, Box<Texture>),
    /// A texture with everything but its normals at the surface's own coordinates: (u, v, 0) takes the place of the point. It is
    /// POV-Ray's `texture { uv_mapping ... }`; under `uv_mapping` of an object normals are there too ([`TexturePoint::on_surface`]).
    UvMapped(Box<Texture>),
}

/// The shares of several textures at a point.
pub trait Shares: std::fmt::Debug + Send + Sync {
    /// Calls `visit` with the number of each texture that counts at a point and its share; the shares sum to 1.
    fn shares_at(&self, point: DVec3, visit: &mut dyn FnMut(usize, f64));
}

impl Default for Texture {
    fn default() -> Self {
        Self::from(PlainTexture::default())
    }
}

impl From<PlainTexture> for Texture {
    fn from(texture: PlainTexture) -> Self {
        Self::Plain(texture)
    }
}

/// A texture that several materials may share; equal to itself only.
#[derive(Clone, Debug)]
pub struct SharedTexture(pub Arc<Texture>);

impl PartialEq for SharedTexture {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

impl From<Texture> for SharedTexture {
    fn from(texture: Texture) -> Self {
        Self(Arc::new(texture))
    }
}

impl Texture {
    /// Evaluates the texture at a point; `eta` is the index of refraction behind the surface divided by the one before it,
    /// for reflections with `fresnel`.
    pub fn layers_at<'a>(&'a self, point: &TexturePoint, eta: f64, out: &mut TexturePaint<'a>) {
        self.layers_in(None, point, eta, out);
    }

    /// The same for a texture in a space of its own, as [`Texture::Transformed`] has it; `None` is the point's space.
    pub fn layers_in<'a>(
        &'a self,
        space: Option<&Transform>,
        point: &TexturePoint,
        eta: f64,
        out: &mut TexturePaint<'a>,
    ) {
        let mut stack = out.begin(point.n_shade);
        match space {
            None => {
                let ways = Ways::of(&Identity);
                self.paint(point, point.n_shade, ways, eta, &mut stack, out);
            }
            Some(space) => {
                let inner = point.at(space.point_to_object(point.position));
                let n = NormalSpace::enter(space, point.n_shade);
                self.paint(&inner, n, Ways::of(space), eta, &mut stack, out);
            }
        }
        out.end(&stack, self.refraction());
    }

    /// The same for a texture of one colour and without a normal of its own, at a point with this normal on the surface, seen along a
    /// direction; no space changes it. Returns whether it is such a texture.
    #[inline]
    pub fn solid_layer<'a>(
        &'a self,
        surface: DVec3,
        normal: DVec3,
        direction: DVec3,
        eta: f64,
        out: &mut TexturePaint<'a>,
    ) -> bool {
        let Self::Plain(texture) = self else {
            return false;
        };
        let (Pigment::Solid(color, _), None) = (&texture.pigment, &texture.normal) else {
            return false;
        };
        let mut stack = out.begin(normal);
        let cos_view = -normal.dot(direction);
        texture.add_layer(*color, normal, cos_view, surface, eta, &mut stack, out);
        out.end_stack(0, &stack);
        out.end(&stack, texture.finish.refraction);
        true
    }

    /// Whether the colours of its layers at several points take less time together ([`Texture::store_colors`]).
    pub fn gains_together(&self) -> bool {
        let Some(layers) = self.plain_layers() else {
            return false;
        };
        // A layer's normal is known when the layer is painted.
        let mut gains = false;
        for layer in layers {
            if layer.pigment.sees_normals() {
                return false;
            }
            gains |= layer.pigment.gains_together();
        }
        gains
    }

    /// Calls `store` with the colours of each layer, from the lowest to the uppermost, at several points, [`BATCH`] at most: the points of
    /// [`Texture::layers_in`]. Who puts a point's colours into [`TexturePaint::colors`] in this order spares their evaluation. Only for textures that
    /// [gain](Texture::gains_together) by it.
    pub fn store_colors(&self, points: &[TexturePoint], mut store: impl FnMut(&[ColorFt])) {
        let mut colors = [ColorFt::default(); BATCH];
        let colors = &mut colors[..points.len()];
        for layer in self.plain_layers().into_iter().flatten() {
            layer.pigment.store_colors(points, colors);
            store(colors);
        }
    }

    /// The layers of a texture that consists of nothing else, from the lowest to the uppermost, if there are not too many.
    fn plain_layers(&self) -> Option<ArrayVec<&PlainTexture, LAYERS>> {
        let mut plain = ArrayVec::new();
        match self {
            Self::Plain(texture) => plain.push(texture),
            Self::Layered(layers) if layers.len() <= LAYERS => {
                for layer in layers {
                    match layer {
                        Self::Plain(texture) => plain.push(texture),
                        _ => return None,
                    }
                }
            }
            _ => return None,
        }
        Some(plain)
    }

    /// Whether the layers at all points are the same but for the normals, which are those of the surface: one colour, no normal of its own, no
    /// film, and the same reflection at all angles.
    pub fn is_same_everywhere(&self) -> bool {
        let Self::Plain(texture) = self else {
            return false;
        };
        let finish = &texture.finish;
        matches!(texture.pigment, Pigment::Solid(..))
            && texture.normal.is_none()
            && finish.reflection.is_constant()
            && finish.irid.is_none()
    }

    /// The factor of the light from behind (`refraction` in a finish): as measured, that of the uppermost layer counts, and for
    /// blended textures there is none.
    fn refraction(&self) -> f64 {
        let mut texture = self;
        loop {
            texture = match texture {
                Self::Plain(plain) => return plain.finish.refraction,
                Self::Layered(layers) => match layers.last() {
                    Some(top) => top,
                    None => return 1.0,
                },
                Self::Transformed(_, inner) | Self::UvMapped(inner) => inner,
                _ => return 1.0,
            };
        }
    }

    /// Whether it may be transparent somewhere: `false` is certain, `true` is not.
    pub fn may_transmit(&self) -> bool {
        match self {
            Self::Plain(texture) => texture.pigment.may_transmit(),
            // Light blocked by one layer does not pass.
            Self::Layered(layers) => layers.iter().all(Self::may_transmit),
            Self::Map(_, map) => map.entries.iter().any(|(_, t)| t.may_transmit()),
            Self::Blocks(_, textures)
            | Self::MaterialMap(_, _, textures)
            | Self::Shared(_, textures) => textures.iter().any(Self::may_transmit),
            Self::Average(members, _) => members.iter().any(|(_, t)| t.may_transmit()),
            Self::Transformed(_, texture) | Self::UvMapped(texture) => texture.may_transmit(),
        }
    }

    /// The transmittance for light from a light source: as [`TexturePaint::transmission`], but ignoring `conserve_energy`.
    pub fn shadow_attenuation(&self, point: &TexturePoint) -> Color {
        match self {
            Self::Plain(texture) => texture.pigment.color_at(point).attenuation(),
            Self::Layered(layers) => layers.iter().fold(Color::WHITE, |passed, layer| {
                if passed.is_black() {
                    passed
                } else {
                    passed * layer.shadow_attenuation(point)
                }
            }),
            _ => {
                let mut sum = Color::BLACK;
                self.for_members(point, |texture, point, _, share| {
                    sum += texture.shadow_attenuation(point) * share;
                });
                sum
            }
        }
    }

    /// [`Texture::shadow_attenuation`] of a texture that has the same everywhere, if that is easy to see.
    #[inline]
    pub fn same_shadow_attenuation(&self) -> Option<Color> {
        match self {
            Self::Plain(PlainTexture {
                pigment: Pigment::Solid(color, _),
                ..
            }) => Some(color.attenuation()),
            _ => None,
        }
    }

    /// The same for a solid whose interior concentrates light ([`Interior::gathered`]), which every layer does with its own
    /// normal; the space is that of [`Texture::layers_in`].
    pub fn gathered_attenuation(
        &self,
        space: Option<&Transform>,
        point: &TexturePoint,
        caustics: f64,
    ) -> Color {
        match space {
            None => self.gather(point, point.n_shade, &Identity, caustics),
            Some(space) => {
                let inner = point.at(space.point_to_object(point.position));
                let n = NormalSpace::enter(space, point.n_shade);
                self.gather(&inner, n, space, caustics)
            }
        }
    }

    fn gather(
        &self,
        point: &TexturePoint,
        n: DVec3,
        space: &dyn NormalSpace,
        caustics: f64,
    ) -> Color {
        match self {
            Self::Plain(texture) => {
                let tilted = texture.tilt(point, n, Ways::of(space));
                let normal = tilted.map_or(point.n_shade, |(outer, _)| outer);
                let cos = normal.dot(point.direction);
                texture.pigment.color_at(point).attenuation() * Interior::gathered(caustics, cos)
            }
            Self::Layered(layers) => layers.iter().fold(Color::WHITE, |passed, layer| {
                passed * layer.gather(point, n, space, caustics)
            }),
            _ => {
                let mut sum = Color::BLACK;
                self.for_members(point, |texture, inner, member_space, share| {
                    let chain = Chain {
                        outer: space,
                        inner: member_space,
                    };
                    let n_inner = member_space.enter(n);
                    sum += texture.gather(inner, n_inner, &chain, caustics) * share;
                });
                sum
            }
        }
    }

    /// Calls `visit` with each texture that makes up this one at a point, the point it is to be evaluated at, the way normals
    /// take to and from its space, and its share.
    fn for_members<'a>(
        &'a self,
        point: &TexturePoint,
        mut visit: impl FnMut(&'a Texture, &TexturePoint, &dyn NormalSpace, f64),
    ) {
        match self {
            Self::Plain(_) | Self::Layered(_) => visit(self, point, &Identity, 1.0),
            Self::Map(field, map) => {
                let warps = &field.modifiers.warps;
                let (value, place) = field.value_and_place(point);
                let inner = point.moved_to(place, |p| field.moved(p)).of_member();
                match map.lookup(value) {
                    None => {}
                    Some(Blend::One(texture)) => visit(texture, &inner, warps, 1.0),
                    Some(Blend::Two(low, high, t)) => {
                        // POV-Ray's order, which `slope` and `aoi` show (measured).
                        visit(high, &inner, warps, t);
                        visit(low, &inner, warps, 1.0 - t);
                    }
                }
            }
            Self::Blocks(field, textures) => {
                let warps = &field.modifiers.warps;
                let place = field.moved(point.position);
                let inner = point.moved_to(place, |p| field.moved(p)).of_member();
                if let Some(texture) = textures.get(field.block_moved(place)).or(textures.last()) {
                    visit(texture, &inner, warps, 1.0);
                }
            }
            Self::Average(members, modifiers) => {
                let inner = point.moved(|p| modifiers.moved(p)).of_member();
                let total: f64 = members.iter().map(|(weight, _)| weight).sum();
                for (weight, texture) in members.iter().filter(|_| total != 0.0) {
                    visit(texture, &inner, &modifiers.warps, weight / total);
                }
            }
            Self::MaterialMap(image, modifiers, textures) => {
                let inner = point.moved(|p| modifiers.moved(p)).of_member();
                let index = match image.color(inner.position) {
                    None => 0,
                    // Truncated, as in POV-Ray (measured): numbers between those of texels are of interpolated pictures.
                    Some(color) => (color.rgb.r * 255.0 + 1e-4) as usize,
                };
                if let Some(texture) = textures.get(texture_of(index, textures.len())) {
                    visit(texture, &inner, &modifiers.warps, 1.0);
                }
            }
            Self::Shared(shares, textures) => {
                let place = point.in_object.unwrap_or(point.position);
                shares.shares_at(place, &mut |index, share| {
                    if let Some(texture) = textures.get(index) {
                        visit(texture, point, &Identity, share);
                    }
                });
            }
            Self::Transformed(transform, texture) => {
                let inner = point.moved(|p| transform.point_to_object(p));
                visit(texture, &inner, transform.as_ref(), 1.0);
            }
            Self::UvMapped(texture) => {
                let inner = point.at_coordinates().of_member();
                visit(texture, &inner, &Identity, 1.0);
            }
        }
    }

    fn paint<'a>(
        &'a self,
        point: &TexturePoint,
        n: DVec3,
        ways: Ways<'_>,
        eta: f64,
        stack: &mut Stack,
        out: &mut TexturePaint<'a>,
    ) {
        match self {
            Self::Plain(texture) => {
                let first = out.layers.len();
                texture.paint(point, n, ways, eta, stack, out);
                out.end_stack(first, stack);
            }
            Self::Layered(layers) => {
                let (first, number) = (out.layers.len(), out.stacks.len());
                for layer in layers.iter().rev() {
                    layer.paint(point, n, ways, eta, stack, out);
                }
                // All layers together are one stack.
                out.stacks.truncate(number);
                out.end_stack(first, stack);
            }
            _ => {
                // Each member starts with the transmittance of the layers above; the transmittances of all members are mixed
                // again.
                let (share, above) = (stack.share, stack.above);
                let mut passed = Color::BLACK;
                let is_map = !matches!(self, Self::Transformed(..) | Self::UvMapped(_));
                // Of the textures of a mesh's vertices and of a blob's components those with less are left out (measured).
                let least = match self {
                    Self::Shared(..) => out.bailout,
                    _ => 0.0,
                };
                self.for_members(point, |texture, inner, member_space, part| {
                    if part < least {
                        return;
                    }
                    let mut member = Stack {
                        share: share * part,
                        above,
                        seen: stack.seen,
                    };
                    let chain = |outer| Chain {
                        outer,
                        inner: member_space,
                    };
                    let (out_of, to_map) = (chain(ways.out), chain(ways.to_map));
                    let ways = Ways {
                        out: &out_of,
                        to_map: if is_map { &Identity } else { &to_map },
                    };
                    let n_inner = member_space.enter(n);
                    texture.paint(inner, n_inner, ways, eta, &mut member, out);
                    passed += member.above * part;
                    stack.seen = member.seen;
                });
                stack.above = passed;
            }
        }
    }
}

impl PlainTexture {
    /// The tilted normals in the space around, of unit length, and in that of the innermost map, where it is of unit length unless
    /// bumps keep their size; `n` is the normal in the texture's space. `None` without a normal of its own.
    fn tilt(&self, point: &TexturePoint, n: DVec3, ways: Ways<'_>) -> Option<(DVec3, DVec3)> {
        let normal = self.normal.as_ref()?;
        let mapped = normal.uv_mapped.then(|| point.at_coordinates());
        let (outer, in_map) = match &mapped {
            Some(mapped) if !point.is_member => {
                let tilted = normal.tilt(mapped, point.n_shade);
                (tilted, tilted)
            }
            mapped => {
                let tilted = normal.tilt(mapped.as_ref().unwrap_or(point), n);
                (ways.out.leave(tilted), ways.to_map.leave(tilted))
            }
        };
        let in_map = if normal.no_bump_scale {
            in_map
        } else {
            in_map.normalize_or(point.n_shade)
        };
        Some((outer.normalize_or(point.n_shade), in_map))
    }

    fn paint<'a>(
        &'a self,
        point: &TexturePoint,
        n: DVec3,
        ways: Ways<'_>,
        eta: f64,
        stack: &mut Stack,
        out: &mut TexturePaint<'a>,
    ) {
        // A layer without a normal of its own leaves the surface's untouched, to the last bit.
        let mut normal = point.n_shade;
        if let Some((outer, in_map)) = self.tilt(point, n, ways) {
            (normal, stack.seen) = (outer, in_map);
        }
        let color = if let Some(color) = out.colors.pop() {
            color
        } else if stack.seen == point.n_shade {
            self.pigment.color_at(point)
        } else {
            self.pigment.color_at(&TexturePoint {
                n_shade: stack.seen,
                ..*point
            })
        };
        let cos_view = -normal.dot(point.direction);
        self.add_layer(color, normal, cos_view, point.surface, eta, stack, out);
    }

    /// Adds a layer of this colour and normal below those of a stack.
    #[inline]
    #[expect(
        clippy::too_many_arguments,
        reason = "what is known of the point, the stack and the layers are different things"
    )]
    fn add_layer<'a>(
        &'a self,
        color: ColorFt,
        normal: DVec3,
        cos_view: f64,
        surface: DVec3,
        eta: f64,
        stack: &mut Stack,
        out: &mut TexturePaint<'a>,
    ) {
        // A layer below an opaque layer does not reflect; otherwise the layers above do not weaken its reflection (measured).
        let reflection = &self.finish.reflection;
        let (reflectance, reflection_weight) = if stack.above.is_black() || reflection.is_none() {
            (Color::BLACK, 0.0)
        } else {
            let weight = reflection.weight(cos_view, eta);
            (
                reflection.reflectance(cos_view, color.rgb, eta),
                weight * stack.above.gray_value(),
            )
        };
        let film = self.finish.irid.map(|irid| irid.at(surface, &out.irid));
        let seen = match &film {
            None => reflectance,
            Some(film) => reflectance * reflection.of_film(film, cos_view),
        };
        let opacity = if out.filter_by_color {
            color.opacity_by_color()
        } else {
            color.opacity()
        };
        out.layers.push(LayerPoint {
            color,
            body: color.rgb * stack.above * (stack.share * opacity),
            normal,
            finish: &self.finish,
            share: stack.share,
            above: stack.above,
            film,
            reflectance: seen,
            reflection_weight,
            stack: 0,
        });
        let mut passes = color.attenuation();
        if self.finish.conserve_energy {
            passes *= Color::WHITE - reflectance;
        }
        stack.above *= passes;
        // Light may be taken away, too, by negative numbers.
        if stack.above.gray_value().abs() < out.bailout {
            stack.above = Color::BLACK;
        }
    }
}

/// The texture that a value of a material map selects among `count`. As in POV-Ray (measured) larger values begin again, but `count` itself
/// is the last one.
fn texture_of(value: usize, count: usize) -> usize {
    match value {
        value if value > count => value % count.max(1),
        value if value == count => count.saturating_sub(1),
        value => value,
    }
}

#[cfg(test)]
mod tests;
