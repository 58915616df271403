use crate::args::{HeatmapArgs, Metric};
use crate::heat::{LEGEND_ROWS, color, legend};
use crate::input::{Input, render_options, threads};
use crate::interrupt;
use crate::report::{Failure, Reporter};
use crate::target::{Target, check_folder, spare};
use std::time::Instant;
use strahl::formats::image::{ImageFormat, Layer, LayerData, Picture, WriteOptions};
use strahl::tracing::{PixelCost, Progress, RenderError, RenderScene, Sampling};

/// `strahl heatmap`: draws the cost of each pixel.
pub(crate) fn run(args: &HeatmapArgs) -> Result<(), Failure> {
    let format = ImageFormat::from_path(&args.output).map_err(Failure::new)?;
    let (input, reporter) = (Input::of(&args.scene)?, Reporter::new(false));
    let input = input.at_quality(args.picture.quality);
    spare(&input, &args.output)?;
    check_folder(&args.output)?;
    let (scene, _) = input.compiled(input.still(), &args.accelerator, &reporter)?;
    let mut options = render_options(&scene, &args.picture);
    // One ray per pixel shows its cost; antialiasing would blur it.
    options.sampling = args.picture.sampling.unwrap_or(Sampling::Center);
    options.threads = threads(args.threads, &reporter);
    options.costs = true;
    let clock = Clock(Instant::now());
    let rendered =
        strahl::render_watched(&scene, &options, &clock).map_err(|error| match error {
            RenderError::Cancelled => Failure::Interrupted,
            other => Failure::new(other),
        })?;
    let costs = rendered.costs.unwrap_or_default();
    let values: Vec<f32> = costs.iter().map(|c| args.metric.of(c)).collect();
    let max = args.scale.unwrap_or_else(|| usual_most(&values));
    let mut rgb: Vec<[f32; 3]> = values.iter().map(|v| color(f64::from(*v) / max)).collect();

    let title = format!(
        "{} per pixel: {}",
        args.metric.unit(),
        scene.accelerator_name()
    );
    let mut rows = options.height;
    let layers = if format.info().layers {
        // Viewers that read layers show the values and need no legend.
        vec![Layer {
            name: "cost".into(),
            channels: vec!["value".into()],
            data: LayerData::F32(values.clone()),
        }]
    } else {
        rgb.extend(legend(options.width, max, &title));
        rows += LEGEND_ROWS;
        vec![]
    };
    let picture = Picture {
        layers: &layers,
        metadata: metadata(args, &scene, &title, max),
        ..Picture::new(options.width, rows, &rgb)
    };
    interrupt::would_lose("no picture was written");
    Target::File(args.output.clone(), format).write(&picture, &WriteOptions::default())?;
    let sum: f64 = values.iter().map(|v| f64::from(*v)).sum();
    let most = values.iter().fold(0.0f32, |a, b| a.max(*b));
    reporter.say(&format!(
        "{}: {title}, mean {:.2}, largest {most}, colours from 0 to {max}",
        args.output.display(),
        sum / values.len().max(1) as f64,
    ));
    Ok(())
}

fn metadata(
    args: &HeatmapArgs,
    scene: &RenderScene,
    title: &str,
    max: f64,
) -> Vec<(String, String)> {
    vec![
        (
            "Software".into(),
            concat!("strahl ", env!("CARGO_PKG_VERSION")).into(),
        ),
        ("scene".into(), args.scene.scene.display().to_string()),
        ("accelerator".into(), scene.accelerator_name().into()),
        ("heatmap".into(), title.into()),
        ("scale".into(), max.to_string()),
    ]
}

impl Metric {
    fn of(self, cost: &PixelCost) -> f32 {
        match self {
            Self::Tests => cost.tests as f32,
            Self::Steps => cost.steps as f32,
            Self::Time => cost.nanoseconds as f32 / 1000.0,
            Self::Depth => cost.depth as f32,
            Self::Rays => cost.rays as f32,
        }
    }

    fn unit(self) -> &'static str {
        match self {
            Self::Tests => "tests",
            Self::Steps => "steps",
            Self::Time => "microseconds",
            Self::Depth => "levels",
            Self::Rays => "rays",
        }
    }
}

/// The largest value of all but a thousandth of the pixels, so that a few extreme pixels don't darken all others; above 0.
fn usual_most(values: &[f32]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f32::total_cmp);
    let index = (sorted.len() * 999 / 1000).min(sorted.len().saturating_sub(1));
    let most = f64::from(sorted.get(index).copied().unwrap_or(0.0));
    if most > 0.0 { most } else { 1.0 }
}

/// The clock for the renderer.
struct Clock(Instant);

impl Progress for Clock {
    fn now(&self) -> u64 {
        self.0.elapsed().as_nanos() as u64
    }

    fn cancelled(&self) -> bool {
        interrupt::pressed()
    }
}
