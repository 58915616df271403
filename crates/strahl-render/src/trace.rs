//! The trace loop, the only one of the program.
//!
//! ```text
//! for every primary ray
//!   1. find the nearest hit
//!   2. for every light the surface faces: trace a shadow ray; the light that arrives adds kd (n·l) + ks (h·n)^p
//!   3. if the surface reflects:    trace the reflection ray, which adds kr·Xr
//!   4. if the surface transmits:   trace the transparency ray, which adds kt·Xt
//! ```
//!
//! All rays but shadow rays are treated alike: what happens at a hit does not depend on whether the ray is primary or
//! secondary. The tree is traversed with an explicit stack, so its depth is not limited by the machine's stack. It is combined
//! bottom-up in the order reflection, transparency, so the sum does not depend on the order of tracing. Layers of a texture
//! with different reflections send a reflection ray each.

mod branch;
mod detail;
mod eye;
mod lights;
mod nothing;
mod outcome;
mod settings;
mod together;

pub(crate) use branch::Branch;
use branch::{Node, Offshoot};
use eye::Eye;
pub(crate) use eye::Filled;
use together::{Ahead, KnownLights, Samples};

pub use outcome::{FirstHit, RayCounts, SampleResult};
pub use settings::TraceSettings;

use crate::activity::Phase;
use crate::hit::{Hit, RayClass};
use crate::layers::{self, Mirror, Passage};
use crate::media::MediaArena;
use crate::observer::{BranchEnd, RayKind, RayReport, Shading, Share, TraceObserver};
use crate::query::Tracer;
use crate::resolve::Uv;
use crate::scene::RenderScene;
use crate::surface::{Split, Surface};
use strahl_math::{Interval, Ray};
use strahl_shade::texture::TexturePaint;
use strahl_shade::{Color, ShadingModel, SpectralPart};

/// Grows ray trees; owns the working memory of one thread.
#[derive(Debug)]
pub struct TreeTracer<'s> {
    /// The queries.
    pub tracer: Tracer<'s>,
    /// Rays traced so far.
    pub counts: RayCounts,
    settings: TraceSettings,
    /// The radiance along primary rays that hit nothing, if it is the same for all.
    beyond: Option<Color>,
    uv: Uv,
    pub(crate) media: MediaArena,
    /// What the eye is in.
    eye: Eye,
    waiting: Vec<Branch>,
    nodes: Vec<Node>,
    pub(crate) shadow_hits: Vec<Hit>,
    /// The visibilities of the points of an area light that are known, for one lit point at a time.
    pub(crate) area_points: Vec<Option<Color>>,
    /// Whether some material has no texture: the surfaces of a packet are found together for their shadow rays only.
    has_plain: bool,
    /// The layers at the current hit; empty without a texture.
    pub(crate) paint: TexturePaint<'s>,
    /// The reflection rays of the current hit.
    mirrors: Vec<Mirror>,
    /// The passages of the current hit, if textures are blended there.
    passages: Vec<Passage>,
    /// The light samples of the current packet.
    samples: Samples,
    /// The hits of the current packet.
    ahead: Vec<Ahead<'s>>,
    /// The surface at the current hit.
    place: Option<Box<Surface<'s>>>,
}

impl<'s> TreeTracer<'s> {
    /// For one scene and one thread.
    pub fn new(scene: &'s RenderScene, settings: TraceSettings) -> Self {
        let shown = |model: Option<ShadingModel>| model == Some(ShadingModel::Uv);
        let uv_shown = shown(settings.force_shading)
            || shown(Some(settings.shading))
            || scene.materials.iter().any(|m| shown(m.model));
        let mut tracer = Tracer::new(scene);
        tracer.remembers = settings.shadow_cache;
        Self {
            tracer,
            beyond: nothing::common(scene, &settings),
            uv: if uv_shown { Uv::Always } else { Uv::IfTextured },
            counts: RayCounts::default(),
            settings,
            media: MediaArena::default(),
            eye: Eye::default(),
            waiting: Vec::new(),
            nodes: Vec::new(),
            shadow_hits: Vec::new(),
            paint: TexturePaint {
                filter_by_color: scene.settings.filter_by_color,
                irid: scene.settings.irid,
                bailout: settings.adc_bailout,
                ..TexturePaint::default()
            },
            area_points: Vec::new(),
            has_plain: scene.materials.iter().any(|m| m.texture.is_none()),
            mirrors: Vec::new(),
            passages: Vec::new(),
            samples: Samples::default(),
            ahead: Vec::new(),
            place: None,
        }
    }

    /// Traces a primary ray with its whole tree.
    pub fn trace<O: TraceObserver>(&mut self, primary: &Ray, observer: &mut O) -> SampleResult {
        let hit = self
            .tracer
            .closest_hit(primary, Interval::FORWARD, None, RayClass::Camera);
        self.grow(primary, hit, None, observer)
    }

    /// Grows the tree of a primary ray from its hit; `ahead` has what a packet has already found out about the hit.
    fn grow<O: TraceObserver>(
        &mut self,
        primary: &Ray,
        mut hit: Option<Hit>,
        mut ahead: Option<&mut Ahead<'s>>,
        observer: &mut O,
    ) -> SampleResult {
        let eye = self.eye_media(primary.origin);
        if hit.is_none() && !O::ACTIVE {
            return self.nothing(primary);
        }
        let shadow_before = self.counts.shadow;
        self.tracer.slot.ray(RayKind::Primary);
        self.nodes.clear();
        self.waiting.clear();
        let mut branch = Branch::primary(primary, eye);
        // Most trees have one ray, which needs no stack.
        let (mut first, mut deepest) = (None, 1);
        let mut place = self
            .place
            .take()
            .unwrap_or_else(|| Box::new(Surface::unknown()));
        loop {
            let seen = self.follow(&branch, hit.as_ref(), ahead.take(), &mut place, observer);
            if branch.kind == RayKind::Primary {
                first = seen;
            }
            let Some(next) = self.waiting.pop() else {
                break;
            };
            branch = next;
            self.tracer.slot.ray(branch.kind);
            hit = self.tracer.closest_hit(
                &branch.ray,
                Interval::FORWARD,
                branch.origin.as_ref(),
                branch.class,
            );
            if branch.depth > deepest {
                deepest = branch.depth;
            }
        }
        self.place = Some(place);
        self.tracer.slot.ray(RayKind::Primary);
        self.tracer.slot.enter(Phase::Sampling);
        let color = self.combine(observer);
        let color = self.settings.decoded(color);
        let rays = self.nodes.len() as u64 + self.counts.shadow - shadow_before;
        SampleResult {
            color,
            first,
            depth: deepest,
            rays: rays as u32,
        }
    }

    /// Sums the tree from its leaves: every ray has the hit's own light, plus kr times the radiance along its reflection ray,
    /// plus kt times the radiance along its transparency ray.
    fn combine<O: TraceObserver>(&mut self, observer: &mut O) -> Color {
        let fogged = self.tracer.scene.has_air();
        for index in (0..self.nodes.len()).rev() {
            let node = &self.nodes[index];
            let sum = node.local + node.reflected + node.transmitted;
            let mut total = sum * node.attenuation;
            if fogged {
                total += node.fog;
            }
            if O::ACTIVE {
                observer.combined(index as u32, node.local, total);
            }
            let kind = node.kind;
            if kind == RayKind::Primary {
                return total;
            }
            let taken = node.share.of(total);
            let parent = node.parent as usize;
            let parent = &mut self.nodes[parent];
            match kind {
                RayKind::Primary => {}
                // There may be several of each kind: layers reflect separately, and parts of the spectrum are refracted
                // separately.
                RayKind::Reflection => parent.reflected += taken,
                RayKind::Refraction => parent.transmitted += taken,
            }
        }
        Color::BLACK
    }

    /// Shades the hit of a ray and queues its branches; `found` is a place for its surface.
    #[inline(always)]
    fn follow<O: TraceObserver>(
        &mut self,
        branch: &Branch,
        hit: Option<&Hit>,
        ahead: Option<&mut Ahead<'s>>,
        found: &mut Surface<'s>,
        observer: &mut O,
    ) -> Option<FirstHit> {
        let scene = self.tracer.scene;
        self.counts.count(branch.kind, hit.is_some());

        if let Some(hit) = hit {
            self.tracer.slot.enter_for(Phase::Surface, hit.id);
        }
        let index = self.nodes.len() as u32;
        let speed = branch.ray.direction.length();
        let length = hit.map_or(f64::INFINITY, |h| h.t * speed);
        let known = ahead.as_ref().map_or(KnownLights::default(), |a| a.lights);
        let mut surface = match (hit, ahead) {
            (None, _) => None,
            (Some(_), Some(ahead)) => Some(&mut ahead.surface),
            (Some(hit), None) => {
                found.find(scene, branch, speed, hit, &self.media, self.uv);
                Some(found)
            }
        };
        let (attenuation, fog) = self.in_front(branch, length);
        let mut node = Node {
            parent: branch.parent,
            kind: branch.kind,
            local: Color::BLACK,
            share: branch.share,
            reflected: Color::BLACK,
            transmitted: Color::BLACK,
            attenuation,
            fog,
        };
        let medium = self.media.top(branch.media);
        let report = |hit, background| RayReport {
            node: index,
            parent: branch.parent,
            kind: branch.kind,
            depth: branch.depth,
            weight: branch.weight,
            share: branch.share,
            ray: branch.ray,
            hit,
            background,
            medium,
            attenuation,
            fog,
            part: branch.part,
        };
        let (Some(hit), Some(surface)) = (hit, surface.take()) else {
            node.local = scene.background.along(branch.ray.direction);
            if O::ACTIVE {
                observer.ray(report(None, Some(node.local)));
            }
            self.nodes.push(node);
            return None;
        };

        self.tracer.slot.enter_for(Phase::Texture, hit.id);
        layers::paint(scene, surface, hit, &mut self.paint);
        self.tracer.slot.enter_for(Phase::Shading, hit.id);
        let surface = &*surface;
        let first = FirstHit {
            distance: length,
            position: surface.resolved.point.position,
            normal: surface.n_shade,
            object: surface.resolved.look.object,
            material: surface.resolved.look.material,
        };
        let model = self.model_of(surface);
        if model.is_diagnostic() {
            node.local = surface.diagnose(scene, model, &first);
            if O::ACTIVE {
                let shading = Shading::Model(model);
                let seen = O::DETAILED.then(|| surface.report(scene, hit, Split::NONE, shading));
                observer.ray(report(seen, None));
            }
            self.nodes.push(node);
            return Some(first);
        }

        if O::ACTIVE {
            let split = self.split(branch, surface, length);
            let seen = O::DETAILED.then(|| self.hit_report(surface, hit, split, model));
            let total = seen.as_ref().is_some_and(|seen| seen.total_reflection);
            observer.ray(report(seen, None));
            if total {
                observer.ended(index, RayKind::Refraction, 0.0, BranchEnd::TotalReflection);
            }
        }
        let finish = &surface.material.finish;
        node.local = finish.ambient * scene.ambient + finish.emission;
        // The lights of a light group shine on the objects of the group only.
        let shining = scene.lights_in(surface.lit.set);
        for number in 0..shining.map_or(scene.lights.len(), <[u32]>::len) {
            let light = shining.map_or(number, |list| list[number] as usize);
            let term = self.light(surface, hit, model, light, known, branch, index, observer);
            node.local += term.diffuse + term.specular;
            if O::DETAILED {
                let detail = self.light_detail(surface, hit, model, branch, &term);
                observer.light(index, term, detail);
            }
        }
        node.local = layers::grained(&self.paint, node.local);
        self.nodes.push(node);
        if O::DETAILED || !surface.is_dull() {
            let split = self.split(branch, surface, length);
            self.queue_branches(branch, index, surface, hit, &split, observer);
        }
        Some(first)
    }

    /// Divides the light at the current surface, which is `length` away from the origin of its ray.
    #[inline]
    fn split(&mut self, branch: &Branch, surface: &Surface<'_>, length: f64) -> Split {
        let mut split = surface.split(&branch.ray);
        if let Some(inside) = surface.fading() {
            split.fade = self.tracer.scene.faded(inside, length);
        }
        if self.paint.stacks.len() > 1 && !surface.material.finish.transmission.is_black() {
            layers::passages(
                &self.paint,
                surface,
                &branch.ray,
                split.fade,
                &mut self.passages,
            );
            (split.kr, split.kt) = layers::sums_of_passages(&self.paint, &self.passages);
        } else if split.total_reflection && !self.paint.layers.is_empty() {
            // As in POV-Ray (measured): total reflection ignores colour and finish, and fades like light that passes.
            split.kr = split.fade;
        }
        split
    }

    /// The attenuation by what lies in front of a hit, and the light that it adds.
    #[inline(always)]
    fn in_front(&self, branch: &Branch, length: f64) -> (Color, Color) {
        let scene = self.tracer.scene;
        let mut attenuation = scene.absorbed(self.media.top(branch.media), length);
        let mut fog = Color::BLACK;
        if scene.has_air() && self.media.in_air(branch.media) {
            let (keeps, adds) = scene.air_along(&branch.ray, length);
            (attenuation, fog) = (attenuation * keeps, adds);
        }
        if branch.divided {
            let share = branch.part.share();
            attenuation *= share;
            fog *= share;
        }
        (attenuation, fog)
    }

    fn model_of(&self, surface: &Surface<'_>) -> ShadingModel {
        let material = &self.tracer.scene.materials[surface.resolved.look.material.0 as usize];
        self.settings
            .force_shading
            .or(material.model)
            .unwrap_or(self.settings.shading)
    }

    /// Queues the reflected and transmitted rays of a surface; the reflection ray is traced first.
    fn queue_branches<O: TraceObserver>(
        &mut self,
        branch: &Branch,
        index: u32,
        surface: &Surface<'_>,
        hit: &Hit,
        split: &Split,
        observer: &mut O,
    ) {
        let mut mirrors = std::mem::take(&mut self.mirrors);
        if self.paint.stacks.len() > 1 && !surface.material.finish.transmission.is_black() {
            let passages = std::mem::take(&mut self.passages);
            for passage in passages.iter().rev() {
                self.queue_passage(branch, index, surface, hit, passage, observer);
            }
            if passages.iter().all(|passage| passage.direction.is_some()) {
                layers::mirrors(&self.paint, surface, split, &mut mirrors);
            } else {
                layers::mirrors_of_passages(&self.paint, surface, &passages, &mut mirrors);
            }
            self.passages = passages;
        } else {
            let only = Passage {
                normal: surface.n_refract,
                direction: split.refracted,
                kt: split.kt,
                fade: split.fade,
                share: 1.0,
                weight: match self.paint.stacks.first() {
                    None => split.kt.max_component(),
                    Some(stack) => stack.weight,
                },
            };
            self.queue_passage(branch, index, surface, hit, &only, observer);
            layers::mirrors(&self.paint, surface, split, &mut mirrors);
        }
        for mirror in mirrors.iter().rev() {
            let Mirror {
                share,
                direction,
                weight,
            } = *mirror;
            let mirrored = Offshoot {
                coefficient: weight,
                ..Offshoot::new(RayKind::Reflection, share, direction, branch.part)
            };
            self.queue(branch, index, surface, hit, &mirrored, observer);
        }
        self.mirrors = mirrors;
    }

    /// Queues the transparency ray of a passage, or the rays of the parts of its spectrum.
    #[inline(always)]
    fn queue_passage<O: TraceObserver>(
        &mut self,
        branch: &Branch,
        index: u32,
        surface: &Surface<'_>,
        hit: &Hit,
        passage: &Passage,
        observer: &mut O,
    ) {
        let Some(direction) = passage.direction else {
            return;
        };
        let through = Share {
            factor: passage.kt * passage.fade,
            power: 1.0,
        };
        let parts = self.parts_behind(branch, surface);
        if parts == 0 {
            // As in POV-Ray (measured) fading does not count for the weight.
            let whole = Offshoot {
                coefficient: passage.weight,
                ..Offshoot::new(RayKind::Refraction, through, direction, branch.part)
            };
            self.queue(branch, index, surface, hit, &whole, observer);
        }
        for part in SpectralPart::all(parts) {
            let bent = surface.bent_part(self.tracer.scene, passage.normal, part);
            let direction = bent.unwrap_or_else(|| surface.mirrored(passage.normal));
            let offshoot = Offshoot {
                divided: true,
                returned: bent.is_none(),
                coefficient: passage.weight * part.share().max_component(),
                ..Offshoot::new(RayKind::Refraction, through, direction, part)
            };
            self.queue(branch, index, surface, hit, &offshoot, observer);
        }
    }

    /// The number of spectral parts into which a branch is split behind a surface; 0 if it is not.
    #[inline]
    fn parts_behind(&self, branch: &Branch, surface: &Surface<'_>) -> u16 {
        if self.tracer.scene.disperses && branch.part.is_white() {
            surface.spectral_parts(self.tracer.scene)
        } else {
            0
        }
    }

    /// Queues a branch, unless a limit is reached.
    #[inline(always)]
    fn queue<O: TraceObserver>(
        &mut self,
        branch: &Branch,
        index: u32,
        surface: &Surface<'_>,
        hit: &Hit,
        offshoot: &Offshoot,
        observer: &mut O,
    ) {
        let Offshoot {
            kind, direction, ..
        } = *offshoot;
        let weight = branch.weight * offshoot.coefficient;
        let end = if branch.depth >= self.settings.max_depth {
            Some(BranchEnd::DepthLimit)
        } else if weight < self.settings.adc_bailout {
            Some(BranchEnd::WeightCutoff)
        } else if self.nodes.len() + self.waiting.len() >= self.settings.max_tree_rays as usize {
            Some(BranchEnd::TreeLimit)
        } else {
            None
        };
        if let Some(end) = end {
            self.counts.cut_trees += u64::from(end == BranchEnd::TreeLimit);
            if O::DETAILED {
                observer.ended(index, kind, weight, end);
            }
            return;
        }
        let media = match kind {
            RayKind::Refraction if !offshoot.returned => {
                surface.media_behind(branch.media, &mut self.media)
            }
            _ => branch.media,
        };
        let straight = kind == RayKind::Refraction && surface.is_straight();
        let (point, origin) = surface.start(hit, direction);
        self.waiting.push(Branch {
            ray: Ray::new(point, direction),
            origin: Some(origin),
            kind,
            class: match kind {
                RayKind::Refraction if !offshoot.returned => branch.class,
                _ => RayClass::Secondary,
            },
            parent: index,
            depth: branch.depth + u32::from(self.settings.straight_counts || !straight),
            part: offshoot.part,
            share: offshoot.share,
            divided: offshoot.divided,
            weight,
            media,
        });
    }
}
