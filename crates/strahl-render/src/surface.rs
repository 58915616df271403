//! The properties of a hit that shading needs, and how the surface divides light.

use crate::branch::Branch;
use crate::hit::{Hit, Origin};
use crate::light_sets::Lit;
use crate::media::{Body, Crossing, MediaArena, MediaStack, Medium};
use crate::observer::{HitReport, Shading};
use crate::outcome::FirstHit;
use crate::resolve::{Resolved, Uv};
use crate::scene::RenderScene;
use std::borrow::Cow;
use strahl_math::{DVec3, Ray, error};
use strahl_shade::pov_finish::LightsShown;
use strahl_shade::{
    Color, Finish, MaterialId, MaterialPoint, Quality, Refracted, ShadingModel, SpectralPart,
    fresnel_dielectric, reflect, refract,
};

/// A material, and whether it is seen from outside.
pub(crate) type Side = (MaterialId, bool);

/// The index of refraction of a medium for a part of the spectrum; `None` is air.
#[inline]
fn index_of(scene: &RenderScene, medium: Option<MaterialId>, part: SpectralPart) -> f64 {
    let Some(id) = medium else {
        return 1.0;
    };
    let material = &scene.materials[id.0 as usize];
    match &material.interior {
        Some(interior) if !part.is_white() => interior.ior_of(part),
        _ => material.eta,
    }
}

/// How a surface divides light between reflection and transparency.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Split {
    pub(crate) kr: Color,
    pub(crate) kt: Color,
    /// The attenuation, besides kt, of the light that passes the surface.
    pub(crate) fade: Color,
    /// Unit direction of the reflection ray, if the surface reflects. If it transmits there is one too, with kr = 0 unless
    /// Fresnel or total reflection increase it; the cutoff decides.
    pub(crate) reflected: Option<DVec3>,
    pub(crate) refracted: Option<DVec3>,
    pub(crate) cos_2: Option<f64>,
    pub(crate) fresnel: Option<f64>,
    pub(crate) total_reflection: bool,
}

impl Split {
    pub(crate) const NONE: Self = Self {
        kr: Color::BLACK,
        kt: Color::BLACK,
        fade: Color::WHITE,
        reflected: None,
        refracted: None,
        cos_2: None,
        fresnel: None,
        total_reflection: false,
    };
}

/// The properties of a hit that shading needs, turned to the side of the ray.
#[derive(Debug)]
pub(crate) struct Surface<'s> {
    pub(crate) resolved: Resolved,
    pub(crate) material: MaterialPoint<'s>,
    /// The side of a material of one colour whose layers are still here, and in the point's `paint`, from an earlier ray: if the
    /// next ray meets it too, as most do, only the normals change.
    pub(crate) painted: Option<Side>,
    /// Unit vector towards the viewer.
    pub(crate) v: DVec3,
    pub(crate) n_geom: DVec3,
    pub(crate) n_shade: DVec3,
    /// The unit normal that refracts, and mirrors on total internal reflection: the shading normal, or that of a texture's transparent stack.
    pub(crate) n_refract: DVec3,
    /// Under a POV-Ray texture: the interpolated normal before `normal` bends it, turned to the viewer. POV-Ray decides by it on
    /// which side of the surface a direction is; everything else decides by `n_geom`.
    pub(crate) n_smooth: Option<DVec3>,
    /// Whether the ray meets the front (or outside).
    pub(crate) entering: bool,
    /// Whether the material is a thin sheet without an inside.
    pub(crate) thin: bool,
    /// Which lights shine on it.
    pub(crate) lit: Lit,
    /// Which light sources can show on it. Where none can, it needs no shadow rays: most sky spheres are such.
    pub(crate) shown: LightsShown,
    /// Whether a layer of its texture has `crand`.
    pub(crate) has_grain: bool,
    /// Whether no light goes on from here: [`Surface::split`] is [`Split::NONE`]. Painting finds it out.
    pub(crate) is_dull: bool,
    pub(crate) eta_1: f64,
    pub(crate) eta_2: f64,
    /// Both indices for white light.
    white_etas: (f64, f64),
    /// Whether the ray is in what is on the other side of the surface, and gets out of it there.
    inside: bool,
    /// What is inside of the object.
    own: Medium,
    /// Of a ray of white light in no medium, whether it is inside: the indices are those of such a ray and this element.
    side_in_air: Option<bool>,
    /// What the ray comes from and what is behind the surface; `None` is air.
    medium_1: Option<MaterialId>,
    medium_2: Option<MaterialId>,
    /// Where rays towards the side of the viewer start, which most do.
    front: (DVec3, Origin),
}

impl<'s> Surface<'s> {
    /// A place for a surface, which [`Surface::find`], [`Surface::find_sides`] and [`Surface::find_start`] fill.
    pub(crate) fn unknown() -> Self {
        Self {
            resolved: Resolved::UNKNOWN,
            material: MaterialPoint {
                finish: Cow::Owned(Finish::BLACK),
                fresnel_reflection: Color::BLACK,
                fresnel: false,
                opacity: 1.0,
            },
            painted: None,
            v: DVec3::ZERO,
            n_geom: DVec3::ZERO,
            n_shade: DVec3::ZERO,
            n_refract: DVec3::ZERO,
            n_smooth: None,
            entering: true,
            thin: false,
            lit: Lit::DEFAULT,
            shown: LightsShown::All,
            has_grain: false,
            is_dull: false,
            eta_1: 1.0,
            eta_2: 1.0,
            white_etas: (1.0, 1.0),
            inside: false,
            own: Medium {
                body: Body::material(MaterialId(0)),
                material: MaterialId(0),
                hollow: false,
            },
            side_in_air: None,
            medium_1: None,
            medium_2: None,
            front: (DVec3::ZERO, Origin::NOWHERE),
        }
    }

    /// Finds the point of a hit.
    // In place: a surface has some 700 bytes, and copies of it took 5 % of the time.
    #[inline(always)]
    pub(crate) fn find(&mut self, scene: &RenderScene, branch: &Branch, hit: &Hit, uv: Uv) {
        let from = branch.origin.as_ref();
        scene.resolve(&branch.ray, from, hit, uv, &mut self.resolved);
    }

    /// Finds which side of the surface the ray meets, what is on both sides, and the material; `per_speed` is the reciprocal of the
    /// length of the ray's direction.
    #[inline(always)]
    pub(crate) fn find_sides(
        &mut self,
        scene: &'s RenderScene,
        branch: &Branch,
        per_speed: f64,
        hit: &Hit,
        media: &MediaArena,
    ) {
        let Resolved {
            point,
            appearance,
            space,
            ..
        } = &self.resolved;
        let material = &scene.materials[appearance.material.0 as usize];
        self.v = -(branch.ray.direction * per_speed);
        self.entering = point.n_geom.dot(self.v) >= 0.0;
        let side = if self.entering { 1.0 } else { -1.0 };
        let n_shade = match &material.pbr {
            None => point.n_shade,
            Some(pbr) => pbr.shading_normal(point.uv, point.n_shade, point.dpdu, point.dpdv),
        };
        let n_shade = n_shade * side;
        (self.n_geom, self.n_shade, self.n_refract) = (point.n_geom * side, n_shade, n_shade);
        self.n_smooth = None;
        let is_same_element = self.resolved.is_same_element;
        if !is_same_element {
            self.own = appearance.medium(material, *space);
            self.thin = material.thin;
            self.lit = scene.lit(hit.id, appearance.object);
        }
        // A thin sheet has the same medium on both sides and is met from outside.
        self.inside = !self.thin
            && match Crossing::of(material) {
                Crossing::BySide => !self.entering,
                Crossing::ByTurns => media.is_inside(branch.media, self.own.body),
            };
        // Most rays travel through air and meet what the ray before in this place met.
        let in_air = branch.media == MediaStack::VACUUM && branch.part.is_white();
        let side_in_air = in_air.then_some(self.inside);
        if !is_same_element || !in_air || self.side_in_air != side_in_air {
            self.find_indices(scene, branch, media);
            self.side_in_air = side_in_air;
        }
        let appearance = &self.resolved.appearance;
        if self.painted != Some((appearance.material, self.entering)) {
            self.painted = None;
            material.store_at(self.resolved.point.uv, &mut self.material);
        }
        (self.shown, self.has_grain) = (LightsShown::All, false);
    }

    /// Finds the media on both sides and their indices of refraction.
    fn find_indices(&mut self, scene: &RenderScene, branch: &Branch, media: &MediaArena) {
        let around = media.top(branch.media);
        (self.medium_1, self.medium_2) = if self.inside {
            // Without a known medium the ray must be inside of the material whose back it sees.
            (
                around.or(Some(self.own.material)),
                media.top_without(branch.media, self.own.body),
            )
        } else {
            (around, Some(self.own.material))
        };
        let index = |id| index_of(scene, id, branch.part);
        (self.eta_1, self.eta_2) = (index(self.medium_1), index(self.medium_2));
        self.white_etas = match branch.part.is_white() {
            true => (self.eta_1, self.eta_2),
            false => {
                let index = |id| index_of(scene, id, SpectralPart::WHITE);
                (index(self.medium_1), index(self.medium_2))
            }
        };
    }

    /// Finds where rays towards the side of the viewer start.
    #[inline(always)]
    pub(crate) fn find_start(&mut self, hit: &Hit) {
        store_start(&self.resolved, hit, self.entering, &mut self.front);
    }

    /// The same, if the place outside of all instances is known.
    #[inline(always)]
    pub(crate) fn put_start(&mut self, hit: &Hit, place: DVec3) {
        put_start(&self.resolved, hit, self.entering, place, &mut self.front);
    }

    /// Whether light passes without refraction, at any angle.
    pub(crate) fn is_straight(&self) -> bool {
        self.thin || self.eta_1 == self.eta_2
    }

    /// The index of refraction behind the surface divided by that before it, for reflections that follow Fresnel's equations.
    ///
    /// As in POV-Ray (measured) it is that of white light also for a part of the spectrum. And it is 1, so that these equations reflect nothing, where a ray leaves an object that lies in another one:
    /// glass under a sky sphere, too.
    pub(crate) fn fresnel_eta(&self) -> f64 {
        let (before, behind) = self.white_etas;
        if self.inside && self.medium_2.is_some() {
            1.0
        } else if before == 1.0 {
            // The same bits without the division, for most surfaces.
            behind
        } else {
            behind / before
        }
    }

    /// The media a ray is in after passing the surface.
    pub(crate) fn media_behind(&self, before: MediaStack, arena: &mut MediaArena) -> MediaStack {
        if self.thin {
            before
        } else if self.inside {
            arena.left(before, self.own.body)
        } else {
            arena.entered(before, self.own)
        }
    }

    /// The material whose `interior` attenuates the light that passes the surface. As in POV-Ray (measured) it does so where a ray
    /// leaves an object: neither what lies in the object fades nor what the surface itself reflects and sends.
    pub(crate) fn fading(&self) -> Option<MaterialId> {
        (self.inside && self.own.body.is_object()).then_some(self.own.material)
    }

    /// Where a ray in this direction starts: certainly on the right side of the surface.
    #[inline]
    pub(crate) fn start(&self, hit: &Hit, direction: DVec3) -> (DVec3, Origin) {
        if self.n_geom.dot(direction) >= 0.0 {
            self.front
        } else {
            start(&self.resolved, hit, !self.entering)
        }
    }

    /// Where a ray in this direction starts, if it is on the side of the viewer.
    #[inline]
    pub(crate) fn start_in_front(&self, direction: DVec3) -> Option<(DVec3, &Origin)> {
        let (point, origin) = &self.front;
        (self.n_geom.dot(direction) >= 0.0).then_some((*point, origin))
    }

    /// The reflected light if light arrives from the unit direction `l`: the diffuse part and the highlight.
    #[inline(always)]
    pub(crate) fn reflected(
        &self,
        model: ShadingModel,
        arriving: Color,
        l: DVec3,
        n_dot_l: f64,
    ) -> (Color, Color) {
        let finish = &self.material.finish;
        // Light comes from behind only if it shows on both sides.
        let diffuse = finish.diffuse * arriving * n_dot_l.abs();
        if finish.specular.is_black() {
            return (diffuse, Color::BLACK);
        }
        let highlight = model.highlight(self.n_shade, l, self.v, finish.shininess);
        (diffuse, finish.specular * arriving * highlight)
    }

    /// Leaves out what pictures of this quality don't show of a material without a texture. At the lowest, surfaces show the sum of the
    /// coefficients of all light that they would send on.
    #[cold]
    pub(crate) fn reduce(&mut self, quality: Quality) {
        let point = &mut self.material;
        let finish = point.finish.to_mut();
        if quality.is_unlit() {
            let sum = finish.diffuse + finish.reflection + finish.transmission;
            let sum = (sum + point.fresnel_reflection).map(|x| x.min(1.0));
            *finish = Finish {
                emission: if sum.is_black() { finish.emission } else { sum },
                ..Finish::BLACK
            };
            self.shown = LightsShown::Nothing;
        }
        if !quality.has_reflection() {
            // Without Fresnel's equations, light that is reflected totally is light that would have passed.
            (finish.reflection, point.fresnel) = (Color::BLACK, false);
            point.fresnel_reflection = Color::BLACK;
        }
        if !quality.has_transparency() {
            finish.transmission = Color::BLACK;
        }
    }

    /// Finds out whether light goes on from here, once the coefficients of the material are known.
    #[inline]
    pub(crate) fn find_dull(&mut self) {
        let finish = &self.material.finish;
        let dielectric = self.material.fresnel && !self.material.fresnel_reflection.is_black();
        self.is_dull =
            finish.transmission.is_black() && !dielectric && finish.reflection.is_black();
    }

    /// Divides the light into reflection and transparency, by Snell's law and, if the material asks for it, Fresnel's
    /// equations. On total reflection kt is added to kr.
    pub(crate) fn split(&self, ray: &Ray) -> Split {
        if self.is_dull {
            return Split::NONE;
        }
        let finish = &self.material.finish;
        let transmits = !finish.transmission.is_black();
        let dielectric = self.material.fresnel && !self.material.fresnel_reflection.is_black();
        let mut split = Split {
            kr: finish.reflection,
            ..Split::NONE
        };
        let refracted = if transmits || dielectric {
            self.refract(self.n_refract, self.eta_1 / self.eta_2)
        } else {
            None
        };
        split.cos_2 = refracted.map(|r| r.cos_2);
        if self.material.fresnel {
            let f = refracted.map_or(1.0, |r| {
                fresnel_dielectric(self.eta_1, r.cos_1, self.eta_2, r.cos_2)
            });
            split.fresnel = Some(f);
            split.kr += self.material.fresnel_reflection * f;
            split.kt = finish.transmission * (1.0 - f);
        } else {
            split.kt = finish.transmission;
        }
        if transmits {
            match refracted {
                Some(r) => split.refracted = self.behind(ray, r, self.eta_1 / self.eta_2),
                None => {
                    split.total_reflection = true;
                    if !self.material.fresnel {
                        split.kr += split.kt;
                    }
                    split.kt = Color::BLACK;
                }
            }
        }
        let normal = if split.total_reflection {
            self.n_refract
        } else {
            self.n_shade
        };
        split.reflected = Some(self.mirrored(normal));
        split
    }

    /// The direction of a reflection ray at this normal. A direction that would point into the surface is replaced by the one
    /// mirrored at the geometric normal.
    ///
    /// Under a POV-Ray texture it is done as POV-Ray 3.7 does (measured): a direction that points below the interpolated normal's
    /// tangent plane is mirrored at that plane, and a normal that faces away from the viewer is replaced by the interpolated one.
    pub(crate) fn mirrored(&self, normal: DVec3) -> DVec3 {
        let Some(smooth) = self.n_smooth else {
            let r = reflect(normal, self.v);
            return if r.dot(self.n_geom) <= 0.0 {
                reflect(self.n_geom, self.v)
            } else {
                r
            };
        };
        let faces = normal.dot(self.v) > 0.0;
        let r = reflect(if faces { normal } else { smooth }, self.v);
        let height = r.dot(smooth);
        if height < 0.0 {
            r - smooth * (2.0 * height)
        } else {
            r
        }
    }

    /// Snell's law at a normal for light that comes from index `eta` times the index behind the surface.
    fn refract(&self, normal: DVec3, eta: f64) -> Option<Refracted> {
        // POV-Ray turns a normal that faces away to the viewer.
        let turned = self.n_smooth.is_some() && normal.dot(self.v) < 0.0;
        refract(if turned { -normal } else { normal }, self.v, eta)
    }

    /// The direction of the transparency ray at a normal; `None` on total internal reflection.
    pub(crate) fn behind_at(&self, ray: &Ray, normal: DVec3) -> Option<DVec3> {
        let eta = self.eta_1 / self.eta_2;
        self.behind(ray, self.refract(normal, eta)?, eta)
    }

    fn behind(&self, ray: &Ray, refracted: Refracted, eta: f64) -> Option<DVec3> {
        // Without refraction the direction is unchanged to the last bit.
        if self.is_straight() {
            Some(ray.direction)
        } else {
            self.bent(refracted.direction, eta)
        }
    }

    /// The direction of a transparency ray. Where the shading normal turns it to the wrong side, the geometric normal is used,
    /// but not under a POV-Ray texture.
    fn bent(&self, direction: DVec3, eta: f64) -> Option<DVec3> {
        if self.n_smooth.is_none() && direction.dot(self.n_geom) >= 0.0 {
            refract(self.n_geom, self.v, eta).map(|r| r.direction)
        } else {
            Some(direction)
        }
    }

    /// The number of spectral parts into which the surface splits white light; 0 if it does not.
    pub(crate) fn spectral_parts(&self, scene: &RenderScene) -> u16 {
        let parts = |id: Option<MaterialId>| {
            let interior = scene.materials[id?.0 as usize].interior.as_ref()?;
            interior.disperses().then_some(interior.dispersion_samples)
        };
        if self.thin {
            return 0;
        }
        parts(self.medium_1).max(parts(self.medium_2)).unwrap_or(0)
    }

    /// The direction in which a part of the spectrum is refracted at a normal; `None` on total reflection.
    pub(crate) fn bent_part(
        &self,
        scene: &RenderScene,
        normal: DVec3,
        part: SpectralPart,
    ) -> Option<DVec3> {
        let index = |id| index_of(scene, id, part);
        let eta = index(self.medium_1) / index(self.medium_2);
        self.bent(self.refract(normal, eta)?.direction, eta)
    }

    /// Whether light that the surface would let through finds no way behind it.
    #[cold]
    pub(crate) fn reflects_totally(&self, scene: &RenderScene) -> bool {
        let eta = self.eta_1 / self.eta_2;
        !self.thin
            && eta > 1.0
            && scene.transmits(self.resolved.appearance)
            && self.refract(self.n_refract, eta).is_none()
    }

    /// All that ray trees tell of the hit.
    #[cold]
    pub(crate) fn report(
        &self,
        scene: &RenderScene,
        hit: &Hit,
        split: Split,
        shading: Shading,
    ) -> HitReport {
        let finish = &self.material.finish;
        HitReport {
            hit: *hit,
            object: self.resolved.appearance.object,
            material: self.resolved.appearance.material,
            line: scene.face_line(hit.id),
            shading,
            position: self.resolved.point.position,
            n_geom: self.n_geom,
            n_shade: self.n_shade,
            eta_1: self.eta_1,
            eta_2: self.eta_2,
            cos_1: self.n_shade.dot(self.v),
            cos_2: split.cos_2,
            total_reflection: self.reflects_totally(scene),
            fresnel: split.fresnel,
            ka: finish.ambient,
            ambient_light: scene.ambient,
            ambient: finish.ambient * scene.ambient,
            emission: finish.emission,
            diffuse: finish.diffuse,
            specular: finish.specular,
            shininess: finish.shininess,
            reflection: split.kr,
            transmission: split.kt * split.fade,
        }
    }

    /// The colour that a diagnostic shading model shows.
    pub(crate) fn diagnose(
        &self,
        scene: &RenderScene,
        model: ShadingModel,
        first: &FirstHit,
    ) -> Color {
        match model {
            ShadingModel::Normals => {
                let n = self.n_shade * 0.5 + DVec3::splat(0.5);
                Color::new(n.x, n.y, n.z)
            }
            ShadingModel::Depth => {
                let diagonal = scene.diagonal();
                Color::gray(first.distance / (first.distance + diagonal))
            }
            ShadingModel::ObjectId => id_color(first.object),
            _ => {
                let uv = self.resolved.point.uv;
                Color::new(uv.x - uv.x.floor(), uv.y - uv.y.floor(), 0.0)
            }
        }
    }
}

/// Where a ray that leaves a hit starts, on the side of the surface's own normal or on the opposite side.
fn start(r: &Resolved, hit: &Hit, along_normal: bool) -> (DVec3, Origin) {
    let mut out = (DVec3::ZERO, Origin::NOWHERE);
    store_start(r, hit, along_normal, &mut out);
    out
}

/// [`start`] in place: a copy of the result would wait until all of its parts are stored.
#[inline(always)]
fn store_start(r: &Resolved, hit: &Hit, along_normal: bool, out: &mut (DVec3, Origin)) {
    let p = &r.point;
    let place = error::offset_origin(p.position, p.position_error, toward(p.n_geom, along_normal));
    put_start(r, hit, along_normal, place, out);
}

/// A normal, or its opposite.
#[inline(always)]
fn toward(n: DVec3, along_normal: bool) -> DVec3 {
    if along_normal { n } else { -n }
}

#[inline(always)]
fn put_start(r: &Resolved, hit: &Hit, along_normal: bool, place: DVec3, out: &mut (DVec3, Origin)) {
    let (point, origin) = out;
    // Both normals point to the same side of the surface in their spaces.
    let local = match &r.local {
        None => place,
        Some(l) => error::offset_origin(l.position, l.error, toward(l.normal, along_normal)),
    };
    *point = place;
    (origin.id, origin.facet, origin.local) = (hit.id, hit.facet, local);
}

/// A distinct colour for every number: hues by the golden ratio, three levels of brightness.
fn id_color(id: u32) -> Color {
    let hue = (f64::from(id) * 0.618_033_988_749_895).fract() * 6.0;
    let ramp = |shift: f64| {
        let h = (hue + shift) % 6.0;
        let distance = (h - 3.0).abs() - 1.0;
        distance.clamp(0.0, 1.0)
    };
    let level = 0.35 + 0.25 * f64::from(id % 3);
    Color::new(ramp(0.0), ramp(4.0), ramp(2.0)) * level + Color::gray(0.05)
}
