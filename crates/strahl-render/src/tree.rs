use crate::camera::PrimaryRays;
use crate::observer::{BranchEnd, LightTerm, RayKind, RayReport, TraceObserver};
use crate::render::{RenderError, RenderOptions, passes_of_pixel};
use crate::sampling::Sampling;
use crate::scene::RenderScene;
use crate::trace::TreeTracer;
use strahl_shade::Color;

/// A ray of a recorded tree.
#[derive(Clone, Debug)]
pub struct RayNode {
    /// The ray and what it hit.
    pub report: RayReport,
    /// The contributions of the lights that shine on the object, in the order of the scene.
    pub lights: Vec<LightTerm>,
    /// Branches that were not traced: kind, weight and reason.
    pub ended: Vec<(RayKind, f64, BranchEnd)>,
    /// Numbers of the rays it sent.
    pub children: Vec<u32>,
    /// The hit's own contribution: ka·Ia, emission and the lights' terms (or the background).
    pub local: Color,
    /// The radiance along the ray: `(local + reflected + transmitted) · attenuation + fog`, with each child's [`crate::Share`]
    /// of its total.
    pub total: Color,
}

/// The ray tree of one sample.
#[derive(Clone, Debug, Default)]
pub struct RayTree {
    /// The rays in the order of tracing; the first is the primary ray.
    pub nodes: Vec<RayNode>,
}

/// Everything that was traced for a pixel.
#[derive(Clone, Debug)]
pub struct PixelTree {
    /// The trees of its samples with the samples' positions in the picture, in pixels.
    pub samples: Vec<((f64, f64), RayTree)>,
    /// The pixel's linear colour before rounding: the mean of the samples.
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
            ended,
            children,
            local,
            total,
        });
    }

    fn light(&mut self, node: u32, term: LightTerm) {
        self.nodes[node as usize].lights.push(term);
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
    let region = Some(crate::Region {
        x,
        y,
        width: 1,
        height: 1,
    });
    crate::Film::try_new(options.width, options.height, region, false)?;
    // Samples are summed pass by pass, as for the film: floating-point sums depend on the grouping.
    let mut passes = Vec::new();
    if options.sampling == Sampling::Corners {
        passes.push(vec![(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)]);
    } else {
        passes.push(options.sampling.places(0, x, y, options.seed).collect());
        for pass in passes_of_pixel(scene, options, x, y)? {
            let places = options.sampling.places(pass, x, y, options.seed);
            passes.push(places.collect());
        }
    }
    let rays = PrimaryRays::new(scene.camera(), options.width, options.height);
    let mut tracer = TreeTracer::new(scene, options.trace);
    let mut samples = Vec::new();
    let mut count = 0u32;
    let mut sum: Option<Color> = None;
    for places in passes {
        let mut pass_sum: Option<Color> = None;
        for (dx, dy) in places {
            let place = (f64::from(x) + dx, f64::from(y) + dy);
            let color = rays.color(place.0, place.1, |ray| {
                let mut tree = RayTree::default();
                let color = tracer.trace(ray, &mut tree).color;
                samples.push((place, tree));
                color
            });
            count += 1;
            pass_sum = Some(pass_sum.map_or(color, |s| s + color));
        }
        sum = match (sum, pass_sum) {
            (Some(a), Some(b)) => Some(a + b),
            (a, b) => a.or(b),
        };
    }
    let sum = sum.unwrap_or_default();
    let color = if count == 1 {
        sum
    } else {
        sum / f64::from(count)
    };
    Ok(PixelTree {
        samples,
        color,
        film: color.to_f32(),
    })
}
