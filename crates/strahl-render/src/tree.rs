use crate::camera::PrimaryRays;
use crate::observer::{
    BranchEnd, GatherTerm, LightDetail, LightTerm, RayKind, RayReport, ShadowReport, TraceObserver,
};
use crate::render::{RenderError, RenderOptions, mean_of_corners, refined_quadrants};
use crate::sampling::{Division, Quadrants, Refinement, Sample, Sampling, shares};
use crate::scene::RenderScene;
use crate::trace::TreeTracer;
use strahl_scene::Camera;
use strahl_shade::Color;

/// One light at the hit of a ray.
#[derive(Clone, Debug)]
pub struct LightReport {
    /// What it adds.
    pub term: LightTerm,
    /// What that is made of.
    pub detail: LightDetail,
}

/// A ray of a recorded tree.
#[derive(Clone, Debug)]
pub struct RayNode {
    /// The ray and what it hit.
    pub report: RayReport,
    /// The lights looked at from the hit, in the order of the scene: those that shine on the object at all.
    pub lights: Vec<LightReport>,
    /// The light that a method of light transport found at the hit.
    pub gathered: Option<GatherTerm>,
    /// Branches that were not followed: which, with what weight, why.
    pub ended: Vec<(RayKind, f64, BranchEnd)>,
    /// Numbers of the rays it sent.
    pub children: Vec<u32>,
    /// The hit's own contribution: ka·Ia, emission and the lights' terms (or the background).
    pub local: Color,
    /// The radiance along the ray: `(local + reflected + transmitted + gathered) · attenuation + fog`, with each child's
    /// [`crate::Share`] of its total.
    pub total: Color,
}

/// The ray tree of one sample.
#[derive(Clone, Debug, Default)]
pub struct RayTree {
    /// The rays in the order of tracing; the first is the primary ray.
    pub nodes: Vec<RayNode>,
    /// Shadow rays of the light with an extent that is being looked at.
    shadows: Vec<ShadowReport>,
}

/// One primary ray of a pixel and all that came of it.
#[derive(Clone, Debug)]
pub struct PixelSample {
    /// The place in the picture, in pixels.
    pub place: (f64, f64),
    /// The pass of the sampling that asked for it.
    pub pass: u32,
    /// The number of the ray, where a place has several: rays through a lens, or of a camera made of meshes.
    pub ray: Option<u32>,
    /// How often its place counts in the mean. The centre of a pixel that was refined towards some neighbours only stands for the places that were left out,
    /// too.
    pub times: u32,
    /// The share of its place in the mean of the pixel; those of all places add up to 1. With [`Sampling::Recursive`] it is a quarter of the area of every
    /// undivided square at whose corner the place lies. (A place with several rays shows their mean.)
    pub share: f64,
    /// The radiance that it brings, in linear light. (The tree's total, of which the pixel's mean is made, is a colour of the scene's working space.)
    pub color: Color,
    /// Its tree.
    pub tree: RayTree,
}

/// Everything that was traced for a pixel.
#[derive(Clone, Debug)]
pub struct PixelTree {
    /// Its samples.
    pub samples: Vec<PixelSample>,
    /// How many places of the picture they belong to; the camera may see nothing through some.
    pub places: u32,
    /// The pixel's linear colour before rounding: the mean over the places (each with its [`PixelSample::share`]) of colours of the scene's working space.
    pub color: Color,
    /// The colour as it is in the film.
    pub film: [f32; 3],
}

impl TraceObserver for RayTree {
    fn ray(&mut self, report: RayReport) {
        if report.node != report.parent {
            self.nodes[report.parent as usize]
                .children
                .push(report.node);
        }
        let (lights, ended, children) = (vec![], vec![], vec![]);
        let (local, total) = (Color::BLACK, Color::BLACK);
        self.nodes.push(RayNode {
            report,
            lights,
            gathered: None,
            ended,
            children,
            local,
            total,
        });
    }

    fn light(&mut self, node: u32, term: LightTerm, mut detail: LightDetail) {
        detail.shadows.append(&mut self.shadows);
        let report = LightReport { term, detail };
        self.nodes[node as usize].lights.push(report);
    }

    fn gathered(&mut self, node: u32, term: GatherTerm) {
        self.nodes[node as usize].gathered = Some(term);
    }

    fn area_shadow(&mut self, _node: u32, _light: u32, shadow: ShadowReport) {
        self.shadows.push(shadow);
    }

    fn ended(&mut self, node: u32, kind: RayKind, weight: f64, end: BranchEnd) {
        self.nodes[node as usize].ended.push((kind, weight, end));
    }

    fn combined(&mut self, node: u32, local: Color, total: Color) {
        let node = &mut self.nodes[node as usize];
        node.local = local;
        node.total = total;
    }
}

/// Records the ray trees of pixel `(x, y)`: those of exactly the samples that a render with the same options takes.
///
/// # Errors
/// [`RenderError`] if there is no such pixel.
pub fn explain(
    scene: &RenderScene,
    options: &RenderOptions,
    x: u32,
    y: u32,
) -> Result<PixelTree, RenderError> {
    explain_from(scene, scene.camera(), options, x, y)
}

/// The same from any camera.
pub(crate) fn explain_from(
    scene: &RenderScene,
    camera: &Camera,
    options: &RenderOptions,
    x: u32,
    y: u32,
) -> Result<PixelTree, RenderError> {
    let region = Some(crate::Region {
        x,
        y,
        width: 1,
        height: 1,
    });
    crate::Film::try_new(options.width, options.height, region, false)?;
    let rays = PrimaryRays::new(camera, options.width, options.height);
    let mut recorder = Recorder {
        options,
        rays: &rays,
        tracer: TreeTracer::new(scene, options.trace).with_transport(&options.transport),
        pixel: (x, y),
        samples: vec![],
        places: 0,
    };
    let color = match &options.sampling {
        Sampling::Corners => {
            let corners = recorder.corners();
            recorder.share(|_| 0.25);
            mean_of_corners(corners).color
        }
        Sampling::Recursive(refinement) => recorder.divided(refinement),
        _ => recorder.passes(refined_quadrants(scene, &rays, options, x, y)?),
    };
    let color = options.trace.space().decode(color);
    Ok(PixelTree {
        samples: recorder.samples,
        places: recorder.places,
        color,
        film: color.to_f32(),
    })
}

/// Traces the samples of a pixel and records their trees.
struct Recorder<'s> {
    options: &'s RenderOptions,
    rays: &'s PrimaryRays,
    tracer: TreeTracer<'s>,
    pixel: (u32, u32),
    samples: Vec<PixelSample>,
    /// How many places have been looked at.
    places: u32,
}

impl Recorder<'_> {
    /// The colour of a place, given from the pixel's top left corner.
    fn place(&mut self, pass: u32, (dx, dy): (f64, f64)) -> Color {
        let Self {
            options,
            rays,
            tracer,
            samples,
            ..
        } = self;
        let place = (f64::from(self.pixel.0) + dx, f64::from(self.pixel.1) + dy);
        let mut number = 0;
        self.places += 1;
        rays.color(place.0, place.1, |ray| {
            let mut tree = RayTree::default();
            let color = tracer.trace(ray, &mut tree).color;
            let linear = options.trace.space().decode(color);
            samples.push(PixelSample {
                place,
                pass,
                ray: (!rays.is_sharp()).then_some(number),
                times: 1,
                share: 0.0,
                color: linear,
                tree,
            });
            number += 1;
            color
        })
    }

    /// Gives each sample the share of its place.
    fn share(&mut self, of: impl Fn(&PixelSample) -> f64) {
        for sample in &mut self.samples {
            sample.share = of(sample);
        }
    }

    /// What is seen through the corners of the pixel.
    fn corners(&mut self) -> [Sample; 4] {
        let corners = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)];
        corners.map(|at| Sample::from(self.place(0, at)))
    }

    /// The colour of the pixel, divided where its corners differ.
    fn divided(&mut self, refinement: &Refinement) -> Color {
        let corners = self.corners();
        let mut division = Division::new(refinement, self.options.trace.space());
        division.add((0, 0), corners);
        let mut places = vec![];
        let mut inner = |at: &(f64, f64)| {
            places.push(*at);
            Sample::from(self.place(1, *at))
        };
        let means = division.means(|places| Some(places.iter().map(&mut inner).collect()));
        let shares = shares(&places, refinement);
        let (x, y) = (f64::from(self.pixel.0), f64::from(self.pixel.1));
        self.share(|sample| shares(sample.place.0 - x, sample.place.1 - y));
        means.map_or(Color::BLACK, |means| means[0].color)
    }

    /// The colour of the pixel from the places of its first pass, and those of the second in these quadrants. The first place stands for
    /// those of the other quadrants.
    // Samples are summed pass by pass, as for the film: floating-point sums depend on the grouping.
    fn passes(&mut self, quadrants: Quadrants) -> Color {
        let (options, (x, y)) = (self.options, self.pixel);
        let places = |pass| options.sampling.places(pass, x, y, options.seed);
        let mut sum = Color::BLACK;
        for at in places(0) {
            sum += self.place(0, at);
        }
        let mut all = places(0).len() as u32;
        if !quadrants.is_none() {
            let first = self.samples.len();
            let (mut more, mut traced) = (Color::BLACK, 0);
            for quadrant in (0..Quadrants::COUNT).filter(|n| quadrants.has(*n)) {
                let mut part = Color::BLACK;
                for at in places(1).filter(|at| Quadrants::of(*at) == quadrant) {
                    part += self.place(1, at);
                    traced += 1;
                }
                more += part;
            }
            let center_stands_for = places(1).len() as u32 - traced;
            for sample in &mut self.samples[..first] {
                sample.times += center_stands_for;
            }
            sum = more + sum * f64::from(1 + center_stands_for);
            all += places(1).len() as u32;
        }
        self.share(|sample| f64::from(sample.times) / f64::from(all));
        if all == 1 { sum } else { sum / f64::from(all) }
    }
}
