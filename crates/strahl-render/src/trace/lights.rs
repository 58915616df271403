//! The stage of lights, light by light: which points it may shine on, its shadow rays, the light that surfaces reflect.

use super::TreeTracer;
use super::aim::{Directions, Places};
use super::point::{Lanes, Point};
use crate::activity::Phase;
use crate::hit::Origin;
use crate::layers;
use crate::observer::{LightTerm, ShadowReport, TraceObserver};
use crate::query::PACKET_MIN;
use crate::shadow::{Shadow, ShadowRay};
use arrayvec::ArrayVec;
use strahl_accel::{PACKET, lanes_of};
use strahl_math::{DVec3, Interval, Ray};
use strahl_shade::pov_finish::LightsShown;
use strahl_shade::{Color, Light, LightSample};

/// A light at a point that may face it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Arriving {
    /// The lane of the point.
    pub(crate) lane: usize,
    pub(crate) sample: LightSample,
    /// The cosine between the shading normal and the direction to the light.
    n_dot_l: f64,
    /// The visibility of the light: 0 in full shadow, 1 if nothing is in between; the mean over an area light.
    pub(crate) visible: Color,
    /// How many shadow rays were traced.
    pub(crate) shadow_rays: u32,
    /// The diffuse part and the highlight, if they are known before the light is shaded.
    pub(crate) reflected: Option<(Color, Color)>,
}

/// A shadow ray to be traced.
#[derive(Clone, Copy)]
pub(crate) struct Aim<'p> {
    pub(crate) point: &'p Point<'p>,
    pub(crate) direction: DVec3,
    /// Where occluders are looked for.
    pub(crate) range: Interval,
}

impl Aim<'_> {
    /// The ray, and where it starts.
    #[inline]
    fn start(&self) -> (Ray, Origin) {
        let (start, from) = self.point.surface.start(&self.point.hit, self.direction);
        (Ray::new(start, self.direction), from)
    }

    #[inline(always)]
    fn shadow_ray<'r>(&self, light: usize, ray: &'r Ray, from: &'r Origin) -> ShadowRay<'r> {
        ShadowRay {
            ray,
            range: self.range,
            from,
            light,
            media: self.point.branch.media,
        }
    }
}

impl<'s> TreeTracer<'s> {
    /// Adds the light that surfaces reflect from light sources.
    pub(super) fn light<O: TraceObserver>(
        &mut self,
        points: &mut [Point<'s>],
        lanes: &Lanes,
        observer: &mut O,
    ) {
        let scene = self.intersector.scene;
        if !scene.has_light_groups() {
            let mut found;
            let mut places = None;
            if lanes.len() >= PACKET_MIN && !scene.lights.is_empty() {
                found = Places::NONE;
                found.find(points, lanes);
                places = Some(&found);
            }
            for light in 0..scene.lights.len() {
                self.one_light(points, lanes, places, light, observer);
            }
            return;
        }
        // The lights of a light group shine on the objects of the group only.
        for lane in lanes {
            let set = points[*lane].surface.lit.set;
            let alone = Lanes::from_iter([*lane]);
            for light in scene.lights_in(set).unwrap_or_default() {
                self.one_light(points, &alone, None, *light as usize, observer);
            }
        }
    }

    /// Adds the light of one light source; `places` has the points of these lanes, if they are not too few.
    fn one_light<O: TraceObserver>(
        &mut self,
        points: &mut [Point<'s>],
        lanes: &Lanes,
        places: Option<&Places>,
        number: usize,
        observer: &mut O,
    ) {
        let light = &self.intersector.scene.lights[number].light;
        let mut arriving = std::mem::take(&mut self.arriving);
        arriving.clear();
        let mut found;
        let mut directions = None;
        if let (Some(places), Some(position)) = (places, light.plain_position()) {
            found = Directions::NONE;
            found.find(position, light.clearance, places);
            directions = Some(&found);
        }
        for (index, lane) in lanes.iter().enumerate() {
            let point = &points[*lane];
            let seen = match directions {
                Some(directions) => directions.sample(light, index),
                None => seen_from(light, point),
            };
            self.aim(point, seen, *lane, number, &mut arriving, observer);
        }
        let blockable = light.casts_shadows || self.intersector.scene.mask(number).is_some();
        if blockable && !arriving.is_empty() {
            self.shadows(points, number, &mut arriving, observer);
        }
        for one in &mut arriving {
            let point = &mut points[one.lane];
            self.back_to_shading(point);
            self.shade(point, light, number, one, observer);
        }
        self.arriving = arriving;
    }

    /// Finds out whether a light may shine on a point, which sees it as [`seen_from`] says.
    #[inline(always)]
    fn aim<O: TraceObserver>(
        &mut self,
        point: &Point<'s>,
        seen: Option<(LightSample, f64)>,
        lane: usize,
        number: usize,
        arriving: &mut Vec<Arriving>,
        observer: &mut O,
    ) {
        let light = &self.intersector.scene.lights[number].light;
        let Some((sample, n_dot_l)) = seen else {
            if O::DETAILED {
                self.report_light(point, LightTerm::none(number), observer);
            }
            return;
        };
        // Points of an area light with `area_illumination` may be above the horizon where its centre is not.
        let may_face = self.faces(point, sample.l, n_dot_l)
            || light.area.is_some_and(|area| area.illumination);
        if may_face && self.may_show(point, light, &sample) {
            arriving.push(Arriving {
                lane,
                sample,
                n_dot_l,
                visible: Color::WHITE,
                shadow_rays: 0,
                reflected: None,
            });
        } else if O::DETAILED {
            let term = LightTerm {
                n_dot_l,
                color: sample.color,
                ..LightTerm::none(number)
            };
            self.report_light(point, term, observer);
        }
    }

    /// Traces the shadow rays of points to one light.
    fn shadows<O: TraceObserver>(
        &mut self,
        points: &[Point<'s>],
        number: usize,
        arriving: &mut [Arriving],
        observer: &mut O,
    ) {
        let scene = self.intersector.scene;
        let light = &scene.lights[number].light;
        self.intersector.slot.shadow(number);
        if let Some(area) = &light.area {
            self.area_light(area, number, points, arriving, observer);
            return;
        }
        if scene.mask(number).is_none() && arriving.len() >= PACKET_MIN {
            self.shadows_together(points, number, arriving);
            return;
        }
        for one in arriving {
            if one.sample.range.is_empty() {
                continue;
            }
            let aim = Aim {
                point: &points[one.lane],
                direction: one.sample.shadow_direction,
                range: one.sample.range,
            };
            let shadow = self.shadow_of(&aim, number);
            self.count_shadow(one, &shadow);
        }
    }

    /// Traces shadow rays in packets.
    fn shadows_together(&mut self, points: &[Point<'s>], number: usize, arriving: &mut [Arriving]) {
        let mut shadows = [Shadow::NONE; PACKET];
        let aim = |index: usize| {
            let one = &arriving[index];
            Aim {
                point: &points[one.lane],
                direction: one.sample.shadow_direction,
                range: one.sample.range,
            }
        };
        self.shadows_of(arriving.len(), aim, number, &mut shadows);
        for (one, shadow) in arriving.iter_mut().zip(&shadows) {
            if !one.sample.range.is_empty() {
                self.count_shadow(one, shadow);
            }
        }
    }

    /// What arrives of a light along `count` shadow rays, at most [`PACKET`], which are traced together; `aim` makes them. Those that start on the
    /// far side of their surface, or have another range, go by themselves; where a range is empty nothing is looked for.
    #[inline(always)]
    pub(crate) fn shadows_of<'p>(
        &mut self,
        count: usize,
        aim: impl Fn(usize) -> Aim<'p>,
        light: usize,
        shadows: &mut [Shadow; PACKET],
    ) {
        let count = count.min(PACKET);
        if count == 0 {
            return;
        }
        let mut rays = ArrayVec::<Ray, PACKET>::new();
        let (mut from, mut t_max) = ([None; PACKET], [f64::NEG_INFINITY; PACKET]);
        let (mut places, mut alone) = ([0; PACKET], 0u32);
        let min = aim(0).range.min;
        for index in 0..count {
            let aim = aim(index);
            if aim.range.is_empty() {
                continue;
            }
            let start = aim.point.surface.start_in_front(aim.direction);
            let Some((start, origin)) = start.filter(|_| aim.range.min == min) else {
                alone |= 1 << index;
                continue;
            };
            let lane = rays.len();
            rays.push(Ray::new(start, aim.direction));
            (from[lane], t_max[lane], places[lane]) = (Some(origin), aim.range.max, index);
        }
        let stopped = self
            .intersector
            .all_occluded(&rays, min, t_max, &from, light);
        let open = !stopped & ((1 << rays.len()) - 1);
        let transmits = self.intersector.scene.transmits;
        let mut lists = std::mem::take(&mut self.packet_hits);
        if transmits && open != 0 {
            for (lane, hits) in lists.iter_mut().enumerate() {
                hits.clear();
                if open >> lane & 1 == 0 {
                    t_max[lane] = f64::NEG_INFINITY;
                }
            }
            self.intersector
                .all_transmitting_hits(&rays, min, t_max, &from, &mut lists);
        }
        for (lane, index) in places[..rays.len()].iter().enumerate() {
            shadows[index % PACKET] = if stopped >> lane & 1 == 1 {
                Shadow::STOPPED
            } else if transmits {
                let from = from[lane].unwrap_or(&Origin::NOWHERE);
                let aim = aim(*index);
                let shadow_ray = aim.shadow_ray(light, &rays[lane], from);
                let hits = &mut lists[lane];
                self.intersector
                    .filtered(&shadow_ray, &mut self.media, hits)
            } else {
                Shadow::NONE
            };
        }
        self.packet_hits = lists;
        for index in lanes_of(alone) {
            shadows[index % PACKET] = self.shadow_of(&aim(index), light);
        }
    }

    /// What arrives of a light along a shadow ray that goes by itself.
    pub(crate) fn shadow_of(&mut self, aim: &Aim<'_>, light: usize) -> Shadow {
        let (ray, from) = aim.start();
        let shadow_ray = aim.shadow_ray(light, &ray, &from);
        let (media, hits) = (&mut self.media, &mut self.shadow_hits);
        self.intersector.shadow(&shadow_ray, media, hits)
    }

    /// What is in the way of a shadow ray.
    #[cold]
    pub(crate) fn shadow_report(&mut self, aim: &Aim<'_>, light: usize) -> ShadowReport {
        let (ray, from) = aim.start();
        let shadow_ray = aim.shadow_ray(light, &ray, &from);
        let (media, hits) = (&mut self.media, &mut self.shadow_hits);
        self.intersector.shadow_report(&shadow_ray, media, hits)
    }

    /// Adds the light of a light source that a surface reflects.
    #[inline(always)]
    fn shade<O: TraceObserver>(
        &mut self,
        point: &mut Point<'s>,
        light: &Light,
        number: usize,
        arriving: &Arriving,
        observer: &mut O,
    ) {
        let Arriving {
            sample, n_dot_l, ..
        } = arriving;
        let mut visible = arriving.visible;
        let (diffuse, specular) = match arriving.reflected {
            // The mean over an area light with `area_illumination`, which fog leaves as it is.
            Some(known) if self.transport.medium.is_none() => known,
            Some((diffuse, specular)) => {
                let keeps = self.medium_before(sample, point);
                (diffuse * keeps, specular * keeps)
            }
            None => {
                if let Some(air) = self.air_before(light, sample, point) {
                    visible *= air;
                }
                if visible.is_black() {
                    (Color::BLACK, Color::BLACK)
                } else {
                    let color = sample.color * visible;
                    self.reflected(point, light, color, sample.l, *n_dot_l)
                }
            }
        };
        point.local += diffuse + specular;
        if O::DETAILED {
            let direction = sample.shadow_direction;
            let start = point.surface.start(&point.hit, direction).0;
            let term = LightTerm {
                light: number as u32,
                n_dot_l: *n_dot_l,
                shadow_ray: (arriving.shadow_rays > 0).then(|| Ray::new(start, direction)),
                shadow_rays: arriving.shadow_rays,
                visible,
                color: sample.color,
                diffuse,
                specular,
            };
            self.report_light(point, term, observer);
        }
    }

    #[cold]
    fn report_light<O: TraceObserver>(
        &mut self,
        point: &Point<'s>,
        term: LightTerm,
        observer: &mut O,
    ) {
        let detail = self.light_detail(point, &term);
        observer.light(point.node, term, detail);
    }

    /// What fog and a medium leave of a light that they weaken on its way to a hit.
    #[inline(always)]
    pub(super) fn air_before(
        &mut self,
        light: &Light,
        sample: &LightSample,
        point: &Point<'s>,
    ) -> Option<Color> {
        if self.intersector.scene.fogs.is_empty() && self.transport.medium.is_none() {
            return None;
        }
        self.weakened_before(light, sample, point)
    }

    #[cold]
    fn weakened_before(
        &mut self,
        light: &Light,
        sample: &LightSample,
        point: &Point<'s>,
    ) -> Option<Color> {
        let fog = self.fog_before(light, sample, point);
        if self.transport.medium.is_none() {
            return fog;
        }
        let keeps = self.medium_before(sample, point);
        Some(fog.map_or(keeps, |fog| fog * keeps))
    }

    /// What fog leaves of it.
    fn fog_before(&self, light: &Light, sample: &LightSample, point: &Point<'s>) -> Option<Color> {
        let scene = self.intersector.scene;
        if !light.fogged || !self.media.in_air(point.branch.media) {
            return None;
        }
        let ray = Ray::new(point.surface.resolved.point.position, sample.l);
        let length = if sample.range.max.is_infinite() {
            f64::INFINITY
        } else {
            sample.shadow_direction.length()
        };
        Some(scene.fog_along(&ray, length).0)
    }

    /// Shadow rays are traced; work for a point follows.
    #[inline(always)]
    fn back_to_shading(&self, point: &Point<'s>) {
        self.intersector.slot.ray(point.branch.kind);
        self.intersector
            .slot
            .enter_for(Phase::Shading, point.hit.id);
    }

    /// Takes what a shadow ray brought.
    #[inline]
    fn count_shadow(&mut self, arriving: &mut Arriving, shadow: &Shadow) {
        self.counts.shadow += 1;
        self.counts.shadow_hit += u64::from(shadow.hit);
        arriving.shadow_rays = 1;
        arriving.visible = shadow.visible;
    }

    /// Whether light from the unit direction `l` reaches the front of a surface.
    #[inline]
    pub(crate) fn faces(&self, point: &Point<'_>, l: DVec3, n_dot_l: f64) -> bool {
        if point.surface.lit.both_sides {
            true
        } else if point.paint.layers.is_empty() {
            n_dot_l > 0.0
        } else {
            layers::faces(&point.paint, l)
        }
    }

    /// Whether a light may show on a surface; `false` is certain.
    #[inline(always)]
    fn may_show(&self, point: &Point<'_>, light: &Light, sample: &LightSample) -> bool {
        match point.surface.shown {
            LightsShown::Nothing => false,
            LightsShown::All => true,
            LightsShown::Highlights => {
                let several_directions = light.area.is_some_and(|area| area.illumination);
                several_directions
                    || self.settings.force_shading.is_some()
                    || layers::shows_light_from(&point.paint, point.surface.v, sample.l)
            }
        }
    }

    /// The light that a surface reflects if light arrives from the unit direction `l`: the diffuse part and the highlight.
    // Inline: colours that are passed in memory would be loaded before their stores have ended.
    #[inline(always)]
    pub(crate) fn reflected(
        &self,
        point: &Point<'_>,
        light: &Light,
        arriving: Color,
        l: DVec3,
        n_dot_l: f64,
    ) -> (Color, Color) {
        let Point {
            surface,
            paint,
            model,
            ..
        } = point;
        let (diffuse, highlight) = if paint.layers.is_empty() {
            surface.reflected(*model, arriving, l, n_dot_l)
        } else {
            layers::lit(paint, surface, l, arriving, self.settings.force_shading)
        };
        let highlight = if light.highlights {
            highlight
        } else {
            Color::BLACK
        };
        (diffuse, highlight)
    }
}

/// A light as a point sees it, and the cosine between the shading normal and the direction to the light.
#[inline(always)]
fn seen_from(light: &Light, point: &Point<'_>) -> Option<(LightSample, f64)> {
    let position = point.surface.resolved.point.position;
    let sample = light.illuminate(position).or_else(|| light.aim(position))?;
    Some((sample, point.surface.n_shade.dot(sample.l)))
}
