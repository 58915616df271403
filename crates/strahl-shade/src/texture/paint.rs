//! A texture evaluated at a point: its layers, in stacks.

use crate::pov_finish::{FilmPoint, IridSettings, PovFinish};
use crate::{Color, ColorFt, Quality};
use arrayvec::ArrayVec;
use std::sync::LazyLock;
use strahl_math::DVec3;

/// The finish of layers that show their colour as it is.
static UNLIT: LazyLock<PovFinish> = LazyLock::new(|| PovFinish {
    ambient: Color::BLACK,
    emission: Color::WHITE,
    diffuse: 0.0,
    ..PovFinish::default()
});

/// The most layers of a texture whose colours may be known before the layers are evaluated.
pub const LAYERS: usize = 4;

/// One layer of a texture at a point, with all properties that only depend on the surface.
///
/// What a viewer sees, with `E` the ambient light, a light of colour `L` (shadows included) in direction `l`, and `R` the light
/// from the mirror direction, is the sum over all layers of
///
/// ```text
/// share · above · [ color.rgb · opacity · (finish.ambient · E + finish.emission + finish.diffuse_factor(n·l) · L)
///                   + finish.highlight(n, l, v, color.rgb) · L ]
/// + share · finish.reflection.reflected(reflectance, R)
/// ```
///
/// With a film (`irid`) the light L is multiplied by [`FilmPoint::factor`]; `reflectance` contains the factor already;
///
/// plus [`TexturePaint::transmission`] times the light from behind. Layers above weaken all but the reflection; the
/// opacity `1 - filter - transmit` weakens all but highlights and reflection (all this as measured).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LayerPoint<'a> {
    /// The pigment's colour.
    pub color: ColorFt,
    /// The tilted unit normal, in the space of the texture point handed in.
    pub normal: DVec3,
    /// The finish.
    pub finish: &'a PovFinish,
    /// The share of this layer's stack where textures are blended; the shares of all stacks sum to 1.
    pub share: f64,
    /// The transmittance of the layers above.
    pub above: Color,
    /// The colour times opacity, share and the transmittance of the layers above: what diffuse and ambient light are multiplied by.
    pub body: Color,
    /// The thin film on the layer (`irid`).
    pub film: Option<FilmPoint>,
    /// The factor of the radiance from the mirror direction.
    pub reflectance: Color,
    /// The weight of the ray in the mirror direction, as POV-Ray has it:
    /// [`PovReflection::weight`](crate::pov_finish::PovReflection::weight) times the grey value of `above`, whatever the share
    /// (measured).
    pub reflection_weight: f64,
    /// The number of its stack in [`TexturePaint::stacks`].
    pub stack: u32,
}

/// A stack of layers at a point: a texture, or one of several that are blended there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StackPoint {
    /// The unit normal of the uppermost layer, which refracts.
    pub normal: DVec3,
    /// The share of the surface, 0 to 1.
    pub share: f64,
    /// The transmittance of all layers together, without the share.
    pub transmittance: Color,
    /// The factor of the weight of the ray behind: the largest component of the transmittance without its sign, whatever the share (measured),
    /// times the `refraction` of the finish.
    pub weight: f64,
}

/// A texture evaluated at a point. Reused from point to point, it stops allocating.
#[derive(Clone, Debug, Default)]
pub struct TexturePaint<'a> {
    /// The layers: stack by stack, from the top to the bottom.
    pub layers: Vec<LayerPoint<'a>>,
    /// The transmittance of all layers for light from behind: the sum over the stacks of share times the product of `rgb ·
    /// filter + transmit`, with `conserve_energy` also times `1 - reflectance`; and all that times the `refraction` of the
    /// uppermost layer.
    pub transmission: Color,
    /// The stacks: one, or those of all textures that are blended here.
    pub stacks: Vec<StackPoint>,
    /// Selects the opacity of layers: [`ColorFt::opacity_by_color`] instead of [`ColorFt::opacity`]. Set by the owner.
    pub filter_by_color: bool,
    /// What the scene says about films. Set by the owner.
    pub irid: IridSettings,
    /// Nothing passes layers whose transmittance together has a grey value, without its sign, below this: what is behind, lower layers too, stays unseen
    /// (measured). Set by the owner.
    pub bailout: f64,
    /// The colours of the layers at the next point, from the lowest to the uppermost, if they are
    /// [known](crate::texture::Texture::store_colors) already. Set by the owner before each point.
    pub colors: ArrayVec<ColorFt, LAYERS>,
}

impl TexturePaint<'_> {
    /// Leaves out what pictures of this quality don't show. The layers have been evaluated with a texture [of that
    /// quality](crate::texture::Texture::of_quality).
    pub fn reduce(&mut self, quality: Quality) {
        if quality.is_unlit() {
            self.show_colors();
        }
        if !quality.has_reflection() {
            for layer in &mut self.layers {
                (layer.reflectance, layer.reflection_weight) = (Color::BLACK, 0.0);
            }
        }
        if !quality.has_transparency() {
            self.transmission = Color::BLACK;
            for stack in &mut self.stacks {
                (stack.transmittance, stack.weight) = (Color::BLACK, 0.0);
            }
        }
    }

    /// Shows colours as they are: of each stack that of the lowest layer which is not covered, as in POV-Ray (measured).
    fn show_colors(&mut self) {
        let mut shown = None;
        self.layers.reverse();
        self.layers.retain_mut(|layer| {
            if layer.above.is_black() || shown == Some(layer.stack) {
                return false;
            }
            shown = Some(layer.stack);
            layer.body = layer.color.rgb * layer.share;
            (layer.above, layer.film, layer.finish) = (Color::WHITE, None, &UNLIT);
            true
        });
        self.layers.reverse();
    }

    /// Makes the layers from number `first` on a stack.
    pub(super) fn end_stack(&mut self, first: usize, stack: &Stack) {
        let number = self.stacks.len() as u32;
        let layers = &mut self.layers[first..];
        let Some(normal) = layers.first().map(|top| top.normal) else {
            return;
        };
        for layer in layers {
            layer.stack = number;
        }
        self.stacks.push(StackPoint {
            normal,
            share: stack.share,
            transmittance: stack.above,
            weight: stack.above.map(f64::abs).max_component(),
        });
    }

    /// Begins with a point: no layers yet.
    pub(super) fn begin(&mut self, n_shade: DVec3) -> Stack {
        self.layers.clear();
        self.stacks.clear();
        Stack {
            share: 1.0,
            // From 1 on nothing is seen (measured).
            above: if self.bailout < 1.0 {
                Color::WHITE
            } else {
                Color::BLACK
            },
            seen: n_shade,
        }
    }

    /// Ends with all layers. `refraction` is the factor of the light from behind.
    pub(super) fn end(&mut self, stack: &Stack, refraction: f64) {
        self.transmission = Color::BLACK + stack.above * stack.share;
        if refraction != 1.0 {
            self.transmission = self.transmission * refraction;
        }
        for stack in &mut self.stacks {
            stack.weight *= refraction;
        }
    }
}

/// A stack of layers under construction.
pub(super) struct Stack {
    pub(super) share: f64,
    pub(super) above: Color,
    /// The normal that the patterns `slope` and `aoi` see: that of the texture evaluated last, in its own space, as in POV-Ray (measured).
    pub(super) seen: DVec3,
}
