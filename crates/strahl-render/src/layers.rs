//! Surfaces with POV-Ray's textures: several layers, each with a colour, a normal and a finish of its own.

mod known;

pub(crate) use known::KnownPaints;

use crate::hit::Hit;
use crate::observer::{LayerReport, Share, SurfaceTerm};
use crate::scene::RenderScene;
use crate::surface::{Split, Surface};
use known::Known;
use std::borrow::Cow;
use strahl_math::{DVec3, Ray};
use strahl_shade::patterns::TexturePoint;
use strahl_shade::pov_finish::LightsShown;
use strahl_shade::pov_finish::PovFinish;
use strahl_shade::texture::{LayerPoint, Texture, TexturePaint};
use strahl_shade::{Color, Finish, ShadingModel};

/// Evaluates the texture at a surface, if its material has one: the layers into `paint`, their sums into the surface's
/// coefficients (`specular` stays black, because each layer has its own highlight). Otherwise `paint` has no layers.
#[inline(always)]
pub(crate) fn paint<'s>(
    scene: &'s RenderScene,
    surface: &mut Surface<'_>,
    hit: &Hit,
    paint: &mut TexturePaint<'s>,
    paints: &mut KnownPaints<'s>,
) {
    let appearance = &surface.resolved.appearance;
    let material = &scene.materials[appearance.material.0 as usize];
    let Some(texture) = material.texture_seen(surface.entering) else {
        paint.layers.clear();
        paint.stacks.clear();
        if !scene.settings.quality.is_full() {
            surface.reduce(scene.settings.quality);
        }
        surface.find_dull();
        return;
    };
    // An interpolated normal that faces away from the viewer is turned round, as in POV-Ray.
    if surface.n_shade.dot(surface.v) < 0.0 {
        surface.n_shade = -surface.n_shade;
    }
    surface.n_smooth = Some(surface.n_shade);
    let side = (appearance.material, surface.entering);
    match paints.of(side) {
        Some(Known::Same(known)) => known.put(side, surface, paint),
        known => evaluate(scene, &texture.0, surface, hit, paint, known),
    }
}

/// Evaluates a texture that is not known to have the same layers everywhere.
#[inline(never)]
fn evaluate<'s>(
    scene: &'s RenderScene,
    texture: &'s Texture,
    surface: &mut Surface<'_>,
    hit: &Hit,
    paint: &mut TexturePaint<'s>,
    known: Option<&mut Known<'s>>,
) {
    let position = surface.resolved.point.position;
    let (normal, eta) = (surface.n_shade, surface.fresnel_eta());
    if !texture.solid_layer(position, normal, -surface.v, eta, paint) {
        let mut place = TexturePoint {
            position,
            is_member: false,
            in_object: None,
            surface: position,
            n_geom: surface.n_geom,
            n_shade: normal,
            uv: surface.resolved.point.uv,
            direction: -surface.v,
        };
        let mut made = None;
        let space = scene.texture_place(&mut place, hit, &surface.resolved, &mut made);
        texture.layers_in(space, &place, eta, paint);
    }
    if !scene.settings.quality.is_full() {
        paint.reduce(scene.settings.quality);
    }

    surface.material.fresnel = false;
    surface.material.fresnel_reflection = Color::BLACK;
    let mut sum = Finish {
        transmission: paint.transmission,
        ..Finish::BLACK
    };
    let mut strongest = 0.0;
    surface.shown = LightsShown::Nothing;
    if let Some(top) = paint.layers.first() {
        surface.n_shade = top.normal;
    }
    for layer in &paint.layers {
        let body = layer.body;
        sum.ambient += body * layer.finish.ambient;
        sum.emission += body * layer.finish.emission;
        sum.diffuse += body * layer.finish.diffuse;
        surface.shown = surface.shown.max(layer.finish.lights_shown(body));
        surface.has_grain |= layer.finish.crand != 0.0;
        let reflection = layer.reflectance * layer.share;
        sum.reflection += reflection;
        // The reflected direction reported for the surface is that of the layer which reflects most.
        if reflection.max_component() > strongest {
            strongest = reflection.max_component();
            surface.n_shade = layer.normal;
        }
    }
    surface.material.finish = Cow::Owned(sum);
    surface.find_dull();
    surface.n_refract = paint
        .stacks
        .iter()
        .find(|stack| !stack.transmittance.is_black())
        .map_or(surface.n_shade, |stack| stack.normal);
    if let Some(known @ Known::Unknown) = known {
        *known = Known::of(texture, paint, surface, sum);
    }
}

/// A reflection ray to be sent.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mirror {
    pub(crate) share: Share,
    pub(crate) direction: DVec3,
    /// The factor of the ray's weight.
    pub(crate) weight: f64,
}

/// The light behind a surface that transparent textures with one normal let through.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Passage {
    pub(crate) normal: DVec3,
    /// The direction of the transparency ray; `None` on total internal reflection.
    pub(crate) direction: Option<DVec3>,
    /// The transmittance times the share of the surface, summed over the textures.
    pub(crate) kt: Color,
    /// The attenuation besides, of light that passes and of light that is reflected totally.
    pub(crate) fade: Color,
    /// The share of the surface that these textures have.
    pub(crate) share: f64,
    /// The factor of the ray's weight.
    pub(crate) weight: f64,
}

/// The passages of blended textures: one for each normal of a texture that lets light through, as in POV-Ray (measured).
#[cold]
pub(crate) fn passages(
    paint: &TexturePaint<'_>,
    surface: &Surface<'_>,
    ray: &Ray,
    fade: Color,
    out: &mut Vec<Passage>,
) {
    out.clear();
    for stack in paint.stacks.iter().filter(|s| !s.transmittance.is_black()) {
        let kt = stack.transmittance * stack.share;
        match out.iter_mut().find(|p| p.normal == stack.normal) {
            Some(passage) => {
                passage.kt += kt;
                passage.share += stack.share;
                passage.weight = passage.weight.max(stack.weight);
            }
            None => out.push(Passage {
                normal: stack.normal,
                direction: surface.behind_at(ray, stack.normal),
                kt,
                fade,
                share: stack.share,
                weight: stack.weight,
            }),
        }
    }
    if let [only] = &mut out[..] {
        only.kt = paint.transmission;
    }
}

/// The reflection rays of blended textures of which some reflect totally. Those do not reflect otherwise.
#[cold]
pub(crate) fn mirrors_of_passages(
    paint: &TexturePaint<'_>,
    surface: &Surface<'_>,
    passages: &[Passage],
    out: &mut Vec<Mirror>,
) {
    mirrors_of_layers(
        paint,
        surface,
        |layer| !totally(paint, passages, layer),
        out,
    );
    for passage in passages.iter().filter(|p| p.direction.is_none()) {
        out.push(Mirror {
            share: Share {
                factor: passage.fade * passage.share,
                power: 1.0,
            },
            direction: surface.mirrored(passage.normal),
            weight: passage.weight,
        });
    }
}

/// Whether the texture of a layer reflects totally.
fn totally(paint: &TexturePaint<'_>, passages: &[Passage], layer: &LayerPoint<'_>) -> bool {
    let stack = &paint.stacks[layer.stack as usize];
    let mut same = passages.iter().filter(|p| p.normal == stack.normal);
    !stack.transmittance.is_black() && same.any(|p| p.direction.is_none())
}

/// The coefficients of reflection and transmission of all passages together.
#[cold]
pub(crate) fn sums_of_passages(paint: &TexturePaint<'_>, passages: &[Passage]) -> (Color, Color) {
    let (mut kr, mut kt) = (Color::BLACK, Color::BLACK);
    for layer in paint
        .layers
        .iter()
        .filter(|layer| !totally(paint, passages, layer))
    {
        kr += layer.reflectance * layer.share;
    }
    for passage in passages {
        match passage.direction {
            Some(_) => kt += passage.kt,
            None => kr += passage.fade * passage.share,
        }
    }
    (kr, kt)
}

/// The reflection rays of a surface: one for all layers with the same normal and `exponent`; a single one on total reflection.
#[inline]
pub(crate) fn mirrors(
    paint: &TexturePaint<'_>,
    surface: &Surface<'_>,
    split: &Split,
    out: &mut Vec<Mirror>,
) {
    out.clear();
    let Some(direction) = split.reflected else {
        return;
    };
    let (factor, power) = (split.kr, 1.0);
    let weight = if paint.layers.is_empty() || factor.is_black() {
        factor.max_component()
    } else if split.total_reflection {
        // As in POV-Ray (measured): the weight of light that passes, although all of it is reflected.
        paint.stacks.first().map_or(0.0, |stack| stack.weight)
    } else {
        weight_of(&paint.layers)
    };
    out.push(Mirror {
        share: Share { factor, power },
        direction,
        weight,
    });
    let mut reflecting = paint
        .layers
        .iter()
        .filter(|layer| !(layer.reflectance * layer.share).is_black());
    if !split.total_reflection
        && let Some(first) = reflecting.next()
        && (first.finish.reflection.exponent != 1.0
            || reflecting.any(|layer| !mirrors_alike(first, layer)))
    {
        mirrors_of_layers(paint, surface, |_| true, out);
    }
}

/// The greatest weight of these layers' reflection rays.
fn weight_of(layers: &[LayerPoint<'_>]) -> f64 {
    layers
        .iter()
        .map(|layer| layer.reflection_weight)
        .fold(0.0, f64::max)
}

/// Whether one ray serves both layers. Their weights decide when the rays that follow end.
fn mirrors_alike(a: &LayerPoint<'_>, b: &LayerPoint<'_>) -> bool {
    a.normal == b.normal
        && a.finish.reflection.exponent == b.finish.reflection.exponent
        && a.reflection_weight == b.reflection_weight
}

/// The rays of the layers that `counts` selects, which may differ in normal, `exponent` or weight.
#[cold]
fn mirrors_of_layers(
    paint: &TexturePaint<'_>,
    surface: &Surface<'_>,
    counts: impl Fn(&LayerPoint<'_>) -> bool,
    out: &mut Vec<Mirror>,
) {
    out.clear();
    for (number, layer) in paint.layers.iter().enumerate() {
        let alike = |other: &&LayerPoint<'_>| counts(other) && mirrors_alike(layer, other);
        let exponent = layer.finish.reflection.exponent;
        // Light to the power of infinity: black.
        if exponent == 0.0 || !counts(layer) || paint.layers[..number].iter().any(|o| alike(&o)) {
            continue;
        }
        let alike = paint.layers[number..].iter().filter(alike);
        let mut factor = Color::BLACK;
        for other in alike {
            factor += other.reflectance * other.share;
        }
        if !factor.is_black() {
            let power = 1.0 / exponent;
            out.push(Mirror {
                share: Share { factor, power },
                direction: surface.mirrored(layer.normal),
                weight: layer.reflection_weight,
            });
        }
    }
}

/// The light that the layers reflect if light of this colour arrives from the direction `l`: the diffuse part and the
/// highlights. `model` replaces the finishes' own highlights and `brilliance`.
// Inline: directions and colours that are passed in memory would be loaded before their stores have ended.
#[inline(always)]
pub(crate) fn lit(
    paint: &TexturePaint<'_>,
    surface: &Surface<'_>,
    l: DVec3,
    light: Color,
    model: Option<ShadingModel>,
) -> (Color, Color) {
    // One function for each: a term that comes from either would be stored with all its factors.
    match model {
        None => sum_of_terms(
            paint,
            #[inline(always)]
            |layer| layer_term(layer, surface, l, light),
        ),
        // Number by number: what is passed in memory would be stored on the other way, too, and loaded before its stores have ended.
        Some(model) => {
            let (DVec3 { x, y, z }, Color { r, g, b }) = (l, light);
            lit_by(paint, model, surface, x, y, z, r, g, b)
        }
    }
}

/// The same, with a shading model in place of the finishes' own highlights and of their `brilliance`.
#[cold]
#[expect(clippy::too_many_arguments, reason = "in registers: see its caller")]
fn lit_by(
    paint: &TexturePaint<'_>,
    model: ShadingModel,
    surface: &Surface<'_>,
    x: f64,
    y: f64,
    z: f64,
    r: f64,
    g: f64,
    b: f64,
) -> (Color, Color) {
    let (l, light) = (DVec3::new(x, y, z), Color::new(r, g, b));
    sum_of_terms(paint, |layer| {
        layer_term_by(model, layer, surface, l, light)
    })
}

/// The diffuse light and the highlights of all layers.
#[inline(always)]
fn sum_of_terms<'p>(
    paint: &TexturePaint<'p>,
    term: impl Fn(&LayerPoint<'p>) -> SurfaceTerm,
) -> (Color, Color) {
    let (mut diffuse, mut highlights) = (Color::BLACK, Color::BLACK);
    for layer in &paint.layers {
        let term = term(layer);
        diffuse += term.diffuse;
        highlights += term.highlight;
    }
    (diffuse, highlights)
}

/// The light that a layer reflects from the direction `l`, with all its factors.
#[inline(always)]
pub(crate) fn layer_term(
    layer: &LayerPoint<'_>,
    surface: &Surface<'_>,
    l: DVec3,
    light: Color,
) -> SurfaceTerm {
    term(layer, layer.finish, None, surface, l, light)
}

/// The same, with a shading model in place of the finish's own highlights and of its `brilliance`.
#[cold]
pub(crate) fn layer_term_by(
    model: ShadingModel,
    layer: &LayerPoint<'_>,
    surface: &Surface<'_>,
    l: DVec3,
    light: Color,
) -> SurfaceTerm {
    let finish = PovFinish {
        brilliance: 1.0,
        ..*layer.finish
    };
    term(layer, &finish, Some(model), surface, l, light)
}

#[inline(always)]
fn term(
    layer: &LayerPoint<'_>,
    finish: &PovFinish,
    model: Option<ShadingModel>,
    surface: &Surface<'_>,
    l: DVec3,
    light: Color,
) -> SurfaceTerm {
    let cos = layer.normal.dot(l);
    let film = layer
        .film
        .map(|film| film.factor(cos, layer.normal.dot(surface.v)));
    let light = film.map_or(light, |factor| light * factor);
    let both_sides = surface.lit.both_sides;
    let diffuse_factor = finish.diffuse_factor(if both_sides { cos.abs() } else { cos });
    let mut diffuse = layer.body * light * diffuse_factor;
    let mut grain = 0.0;
    if finish.crand != 0.0 && diffuse_factor != 0.0 {
        // As in POV-Ray (measured): the pigment's colour counts in full, also where the layer is transparent.
        grain = finish.grain(surface.resolved.point.position);
        diffuse = diffuse - layer.above * layer.color.rgb * light * grain;
    }
    let mut term = SurfaceTerm {
        n_dot_l: cos,
        diffuse_factor,
        grain,
        diffuse,
        tint: Color::WHITE,
        film,
        ..SurfaceTerm::default()
    };
    if !(cos > 0.0 || both_sides) || (finish.phong == 0.0 && finish.specular == 0.0) {
        return term;
    }
    let parts = finish.highlights(layer.normal, l, surface.v, model);
    term.tint = finish.tint(cos, layer.color.rgb);
    (term.phong, term.specular) = (parts.phong, parts.specular);
    let cosine = |strength: f64, cos| (strength != 0.0).then_some(cos);
    term.r_dot_v = cosine(finish.phong, parts.phong_cos);
    term.h_dot_n = cosine(finish.specular, parts.specular_cos);
    term.highlight = layer.above * (term.tint * parts.strength()) * light * layer.share;
    term
}

/// Whether light from the direction `l` reaches the front of any layer.
pub(crate) fn faces(paint: &TexturePaint<'_>, l: DVec3) -> bool {
    paint
        .layers
        .iter()
        .any(|layer| layer.normal.dot(l) > 0.0 || layer.finish.diffuse_back != 0.0)
}

/// Whether light from the direction `l` may show on any layer, by the finishes' own highlights; `false` is certain.
#[inline]
pub(crate) fn shows_light_from(paint: &TexturePaint<'_>, v: DVec3, l: DVec3) -> bool {
    paint.layers.iter().any(|layer| {
        layer
            .finish
            .shows_light_from(layer.body, layer.normal, l, v)
    })
}

/// The light of a surface itself, which is not below zero although `crand` may subtract more than there is.
#[inline]
pub(crate) fn grained(surface: &Surface<'_>, light: Color) -> Color {
    if surface.has_grain {
        light.map(|x| if x > 0.0 { x } else { 0.0 })
    } else {
        light
    }
}

/// The layers at a hit, for ray trees; `eta` is that of [`paint`].
pub(crate) fn report(paint: &TexturePaint<'_>, v: DVec3, eta: f64) -> Vec<LayerReport> {
    let report = |layer: &LayerPoint<'_>| {
        let reflection = &layer.finish.reflection;
        let cos_view = layer.normal.dot(v);
        LayerReport {
            color: layer.color,
            normal: layer.normal,
            finish: *layer.finish,
            share: layer.share,
            above: layer.above,
            body: layer.body,
            rise: (!reflection.is_none()).then(|| reflection.rise(cos_view, eta)),
            film: layer.film.map(|film| film.factor(cos_view, cos_view)),
            reflectance: layer.reflectance,
        }
    };
    paint.layers.iter().map(report).collect()
}
