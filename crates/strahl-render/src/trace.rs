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

mod aim;
mod area_light;
#[cfg(test)]
mod batch_tests;
mod colors;
mod detail;
mod eye;
mod gather;
mod lights;
mod medium;
mod memory;
mod miss;
mod path;
mod point;
mod settings;
mod slots;
mod spawn;
mod stages;
mod starts;

use eye::Eye;
pub(crate) use eye::Filled;
pub(crate) use lights::{Aim, Arriving};
pub(crate) use memory::bytes;
pub(crate) use point::Point;
use slots::Slots;

pub use crate::outcome::{FirstHit, RayCounts, SampleResult};
pub use memory::BatchMemory;
pub use settings::TraceSettings;

use crate::activity::Phase;
use crate::area::AreaMemory;
use crate::branch::{Branch, Node};
use crate::coverage::Coverage;
use crate::hit::Hit;
use crate::layers::{KnownPaints, Mirror, Passage};
use crate::media::{MediaArena, MediaStack};
use crate::observer::{RayKind, TraceObserver};
use crate::query::Intersector;
use crate::resolve::Uv;
use crate::sampling::Sample;
use crate::scene::RenderScene;
use crate::surface::Surface;
use crate::transport::Transport;
use arrayvec::ArrayVec;
use strahl_accel::PACKET;
use strahl_math::{DVec3, Ray};
use strahl_shade::texture::TexturePaint;
use strahl_shade::{Color, ShadingModel};

/// Grows ray trees; owns the working memory of one thread.
#[derive(Debug)]
pub struct TreeTracer<'s> {
    /// The queries.
    pub intersector: Intersector<'s>,
    /// Rays traced so far.
    pub counts: RayCounts,
    pub(crate) settings: TraceSettings,
    /// What is asked besides the scene.
    transport: Transport,
    /// For the alpha channel.
    coverage: Option<Coverage>,
    /// What primary rays see that hit nothing, if it is the same for all.
    beyond: Option<Sample>,
    uv: Uv,
    pub(crate) media: MediaArena,
    /// What the eye is in.
    eye: Eye,
    /// The rays that are still to be traced.
    waiting: Slots<Branch>,
    /// The rays that were traced; parents come before their children.
    nodes: Slots<Node>,
    /// The light that is gathered at their hits; only as long as needed.
    gathered: Vec<Color>,
    /// The rays that go through the stages at the moment.
    points: Vec<Point<'s>>,
    /// A texture without layers, with the settings of the scene.
    blank: TexturePaint<'s>,
    /// The layers of textures of one colour.
    paints: KnownPaints<'s>,
    /// What primary rays see, by their numbers in the packet.
    roots: [Sample; PACKET],
    /// Whether somebody wants to know what a primary ray meets.
    keeps_first: bool,
    /// What the last primary ray met.
    first: Option<FirstHit>,
    /// The deepest level of the trees.
    deepest: u32,
    /// The points that a light may shine on.
    arriving: Vec<Arriving>,
    /// What a shadow ray meets that transmits light, ...
    pub(crate) shadow_hits: Vec<Hit>,
    /// ... and what each of a packet does.
    packet_hits: Box<[Vec<Hit>; PACKET]>,
    pub(crate) area_memory: AreaMemory,
    /// The reflection rays of the current hit.
    mirrors: Vec<Mirror>,
    /// The passages of the current hit, if textures are blended there.
    passages: Vec<Passage>,
    /// The place of the last surface of a path outside of all trees, and whether the path has met one.
    met: Option<Box<Point<'s>>>,
    has_met: bool,
}

impl<'s> TreeTracer<'s> {
    /// For one scene and one thread.
    pub fn new(scene: &'s RenderScene, settings: TraceSettings) -> Self {
        let shown = |model: Option<ShadingModel>| model == Some(ShadingModel::Uv);
        let uv_shown = shown(settings.force_shading)
            || shown(Some(settings.shading))
            || scene.materials.iter().any(|m| shown(m.model));
        let mut intersector = Intersector::new(scene);
        intersector.remembers = settings.shadow_cache;
        Self {
            intersector,
            coverage: None,
            beyond: miss::uniform_background(scene).map(Sample::from),
            uv: if uv_shown { Uv::Always } else { Uv::IfTextured },
            counts: RayCounts::default(),
            settings: TraceSettings {
                batch: settings.batch.clamp(1, PACKET),
                ..settings
            },
            transport: Transport::default(),
            media: MediaArena::default(),
            eye: Eye::default(),
            waiting: Slots::default(),
            nodes: Slots::default(),
            gathered: Vec::new(),
            points: Vec::new(),
            blank: TexturePaint {
                filter_by_color: scene.settings.filter_by_color,
                irid: scene.settings.irid,
                bailout: settings.adc_bailout,
                ..TexturePaint::default()
            },
            paints: KnownPaints::new(scene),
            roots: [Sample::BLACK; PACKET],
            keeps_first: false,
            first: None,
            deepest: 0,
            arriving: Vec::new(),
            shadow_hits: Vec::new(),
            packet_hits: Box::default(),
            area_memory: AreaMemory::default(),
            mirrors: Vec::new(),
            passages: Vec::new(),
            met: None,
            has_met: false,
        }
    }

    /// Traces a primary ray with its whole tree.
    pub fn trace<O: TraceObserver>(&mut self, primary: &Ray, observer: &mut O) -> SampleResult {
        let shadow_before = self.counts.shadow;
        let eye = self.eye_media(primary.origin);
        self.begin();
        self.keeps_first = true;
        self.put(0, primary, 0, eye);
        self.grow(1, 1, observer);
        self.intersector.slot.ray(RayKind::Primary);
        self.intersector.slot.enter(Phase::Sampling);
        self.combine(observer);
        let nodes = (self.nodes.len() as u64).max(1);
        SampleResult {
            color: self.roots[0].color,
            clear: self.roots[0].clear,
            first: self.first,
            depth: self.deepest,
            rays: (nodes + self.counts.shadow - shadow_before) as u32,
        }
    }

    /// Traces primary rays, at most [`PACKET`], with their trees, and returns what they see; where there is no ray it is black. It pays
    /// if the rays are close to each other.
    pub(crate) fn trace_packet(&mut self, rays: &[Option<Ray>]) -> &[Sample] {
        let mut traced = rays.iter().flatten();
        let Some(first) = traced.next().filter(|_| self.have_one_eye(rays)) else {
            return self.trace_each(rays);
        };
        if self.settings.batch < rays.len() {
            return self.trace_parts(rays);
        }
        let (counts, stats) = (self.counts, self.intersector.stats);
        let eye = self.eye_media(first.origin);
        self.begin();
        let mut count = 0;
        for (number, ray) in rays.iter().enumerate() {
            if let Some(ray) = ray {
                self.put(count, ray, number as u32, eye);
                count += 1;
            }
        }
        if !self.grow(count, self.settings.batch, &mut ()) {
            (self.counts, self.intersector.stats) = (counts, stats);
            return self.trace_each(rays);
        }
        self.intersector.slot.ray(RayKind::Primary);
        self.intersector.slot.enter(Phase::Sampling);
        self.combine(&mut ());
        &self.roots[..rays.len()]
    }

    /// Traces primary rays one after the other.
    fn trace_each(&mut self, rays: &[Option<Ray>]) -> &[Sample] {
        let mut trace = |ray: &Ray| self.trace(ray, &mut ()).sample();
        let samples: ArrayVec<Sample, PACKET> = rays
            .iter()
            .map(|ray| ray.as_ref().map_or(Sample::BLACK, &mut trace))
            .collect();
        let roots = &mut self.roots[..samples.len()];
        roots.copy_from_slice(&samples);
        roots
    }

    /// Traces primary rays in smaller packets.
    #[cold]
    fn trace_parts(&mut self, rays: &[Option<Ray>]) -> &[Sample] {
        let mut samples = ArrayVec::<Sample, PACKET>::new();
        for part in rays.chunks(self.settings.batch) {
            samples.extend(self.trace_packet(part).iter().copied());
        }
        let roots = &mut self.roots[..samples.len()];
        roots.copy_from_slice(&samples);
        roots
    }

    /// Whether all rays start in the same media.
    fn have_one_eye(&mut self, rays: &[Option<Ray>]) -> bool {
        let mut origins = rays.iter().flatten().map(|ray| ray.origin);
        let first = origins.clone().next();
        !self.intersector.scene.fills
            || origins.clone().all(|origin| Some(origin) == first)
            || origins.all(|origin| self.eye_media(origin) == MediaStack::VACUUM)
    }

    /// The media of a tree from this place: all other stacks are forgotten.
    #[inline]
    pub(super) fn eye_media(&mut self, place: DVec3) -> MediaStack {
        let scene = self.intersector.scene;
        if scene.fills
            && let Some(media) = self.eye.moved_to(scene, place)
        {
            self.media.begin(media.iter().copied());
        }
        self.media.clear();
        self.media.eye()
    }

    /// Puts a primary ray to those that go through the stages first.
    fn put(&mut self, index: usize, ray: &Ray, number: u32, eye: MediaStack) {
        if index == self.points.len() {
            self.points.push(Point::unknown(&self.blank));
        }
        self.points[index].branch.begin(ray, number, eye);
    }

    /// Forgets the last trees.
    fn begin(&mut self) {
        self.waiting.clear();
        self.nodes.clear();
        self.gathered.clear();
        (self.keeps_first, self.first, self.deepest) = (false, None, 0);
        self.roots = [Sample::BLACK; PACKET];
        if let Some(coverage) = &mut self.coverage {
            coverage.restart();
        }
    }

    /// Sums the trees from their leaves, into the radiances of primary rays: every ray has the hit's own light, plus kr times the radiance along its reflection ray,
    /// plus kt times the radiance along its transparency ray.
    fn combine<O: TraceObserver>(&mut self, observer: &mut O) {
        let fogged = self.adds_light_on_the_way();
        if self.transport.gather.is_some() {
            self.gathered.resize(self.nodes.len(), Color::BLACK);
        }
        for index in (0..self.nodes.len()).rev() {
            let node = &self.nodes[index];
            let mut sum = node.local + node.reflected + node.transmitted;
            if let Some(gathered) = self.gathered.get(index) {
                sum += *gathered;
            }
            let mut total = sum * node.attenuation;
            if fogged {
                total += node.fog;
            }
            if O::ACTIVE {
                observer.combined(index as u32, node.local, total);
            }
            let (kind, parent) = (node.kind, node.parent as usize);
            if let Some(coverage) = &mut self.coverage {
                let sample = coverage.combine(index, node, total);
                if kind == RayKind::Primary {
                    self.roots[parent % PACKET] = sample;
                }
            } else if kind == RayKind::Primary {
                // Field by field: a sample would be copied as a whole, before the stores of its parts have ended.
                let root = &mut self.roots[parent % PACKET];
                (root.color, root.clear) = (total, 0.0);
            }
            if kind == RayKind::Primary {
                continue;
            }
            let taken = node.share.of(total);
            let node = &mut self.nodes[parent];
            match kind {
                RayKind::Primary => {}
                // There may be several of each kind: layers reflect separately, and parts of the spectrum are refracted
                // separately.
                RayKind::Reflection => node.reflected += taken,
                RayKind::Refraction => node.transmitted += taken,
                RayKind::Gather => self.gathered[parent] += taken,
            }
        }
    }

    /// Whether what lies in front of hits may add light.
    fn adds_light_on_the_way(&self) -> bool {
        self.intersector.scene.has_air() || self.transport.medium.is_some()
    }

    /// The attenuation by what lies in front of a hit, and the light that it adds.
    #[inline(always)]
    fn in_front(&mut self, branch: &Branch, length: f64) -> (Color, Color) {
        let scene = self.intersector.scene;
        let mut attenuation = scene.absorbed(self.media.top(branch.media), length);
        let mut fog = Color::BLACK;
        if scene.has_air() && self.media.in_air(branch.media) {
            let (keeps, adds) = scene.air_along(&branch.ray, length);
            (attenuation, fog) = (attenuation * keeps, adds);
        }
        if self.transport.medium.is_some() {
            (attenuation, fog) = self.medium_along(branch, length, (attenuation, fog));
        }
        if branch.divided {
            let share = branch.part.share();
            attenuation *= share;
            fog *= share;
        }
        (attenuation, fog)
    }

    fn model_of(&self, surface: &Surface<'_>) -> ShadingModel {
        let material =
            &self.intersector.scene.materials[surface.resolved.appearance.material.0 as usize];
        self.settings
            .force_shading
            .or(material.model)
            .unwrap_or(self.settings.shading)
    }
}
