use crate::args::CompareArgs;
use crate::input::{Input, render_options, threads};
use crate::output::say;
use crate::report::{Failure, Reporter};
use serde::Serialize;
use std::time::Instant;
use strahl::accel::AcceleratorKind;
use strahl::tracing::{Film, Prepared, Region, RenderOptions, RenderScene, Rendered, SceneStats};

/// A row of the table: one accelerator.
#[derive(Debug, Serialize)]
struct Row {
    accelerator: String,
    build_s: f64,
    bytes: usize,
    /// Nodes or cells.
    nodes: usize,
    references: usize,
    rays: u64,
    /// The number of rays that hit something.
    hits: u64,
    /// Nodes or cells visited, and primitives tested, per ray.
    steps_per_ray: f64,
    tests_per_ray: f64,
    trace_s: f64,
    rays_per_s: f64,
    /// How many times as many rays per second as with the list.
    faster_than_list: Option<f64>,
    /// The fraction of the picture that was rendered, if not all of it.
    sampled: Option<f64>,
    /// The hash of the film; if only a sample was rendered, of those pixels.
    sha256: String,
    /// Whether the picture is that of the first row.
    equal: bool,
}

/// `strahl compare`: measures the cost of every accelerator and checks that the pictures are the same.
pub(crate) fn run(args: &CompareArgs) -> Result<(), Failure> {
    let (input, reporter) = (Input::of(&args.scene)?, Reporter::new(false));
    let input = input.at_quality(args.picture.quality);
    let (prepared, _) = input.prepared(input.still(), &reporter)?;
    let kinds = kinds(args)?;
    let threads = threads(args.threads, &reporter);
    let rows = Comparison::new(args, threads, prepared).run(&kinds)?;
    if args.json {
        let text = serde_json::to_string_pretty(&rows).map_err(Failure::new)?;
        say!("{text}");
    } else if args.csv {
        csv(&rows);
    } else {
        table(&rows);
    }
    match rows.iter().find(|row| !row.equal) {
        None => Ok(()),
        Some(row) => Err(Failure::new(format!(
            "the picture of {} differs from the others: this is a bug in strahl; please report it with the scene",
            row.accelerator
        ))),
    }
}

/// The chosen accelerators, the list last: it may render a sample only, which is compared with the pictures of the others.
fn kinds(args: &CompareArgs) -> Result<Vec<AcceleratorKind>, Failure> {
    if !args.with.is_empty() {
        return Ok(args.with.clone());
    }
    let traversals = ["exit-face", "trial-plane", "neighbours"];
    let mut kinds = AcceleratorKind::ALL.to_vec();
    for traversal in traversals {
        let kind = format!("octree:traversal={traversal}");
        kinds.push(kind.parse().map_err(Failure::new)?);
    }
    kinds.push(
        "spheres:build=agglomerative"
            .parse()
            .map_err(Failure::new)?,
    );
    Ok(kinds)
}

/// If the list needs more tests than this, it renders a sample only.
const MOST_TESTS: f64 = 3e9;

/// Edge of the squares of pixels in a sample.
const SQUARE: u32 = 8;

struct Comparison<'a> {
    args: &'a CompareArgs,
    threads: usize,
    prepared: Prepared,
}

/// An accelerator and its results so far.
struct Contender {
    kind: AcceleratorKind,
    scene: RenderScene,
    build: f64,
    times: Vec<f64>,
    rendered: Option<Rendered>,
}

impl<'a> Comparison<'a> {
    fn new(args: &'a CompareArgs, threads: usize, prepared: Prepared) -> Self {
        Self {
            args,
            threads,
            prepared,
        }
    }

    fn run(&self, kinds: &[AcceleratorKind]) -> Result<Vec<Row>, Failure> {
        let is_list = |k: &AcceleratorKind| k.name() == "list";
        let mut contenders: Vec<Contender> = kinds
            .iter()
            .filter(|kind| !is_list(kind))
            .map(|kind| self.build(*kind))
            .collect();
        for _ in 0..self.args.runs {
            for contender in &mut contenders {
                let options = self.options(&contender.scene);
                let start = Instant::now();
                let rendered = strahl::render(&contender.scene, &options).map_err(Failure::new)?;
                contender.times.push(start.elapsed().as_secs_f64());
                contender.rendered = Some(rendered);
            }
        }
        let mut rows: Vec<Row> = contenders.iter_mut().filter_map(Contender::row).collect();
        let reference = contenders.into_iter().find_map(|c| c.rendered);
        if kinds.iter().any(is_list) {
            rows.insert(0, self.list(reference.as_ref())?);
        }
        finish(&mut rows);
        Ok(rows)
    }

    fn build(&self, kind: AcceleratorKind) -> Contender {
        let prepared = self.prepared.clone();
        let start = Instant::now();
        let scene = prepared.build(kind);
        Contender {
            kind,
            scene,
            build: start.elapsed().as_secs_f64(),
            times: vec![],
            rendered: None,
        }
    }

    fn options(&self, scene: &RenderScene) -> RenderOptions {
        let mut options = render_options(scene, &self.args.picture);
        options.threads = self.threads;
        options.trace.shadow_cache = !self.args.no_shadow_cache;
        // Beam culling is off, because structures are compared by the cost of single rays.
        options.trace.beams = false;
        options.trace.packets = false;
        options
    }

    /// Measures the list, on the whole picture or on a sample if that takes too long.
    fn list(&self, reference: Option<&Rendered>) -> Result<Row, Failure> {
        let kind: AcceleratorKind = "list".parse().map_err(Failure::new)?;
        let mut list = self.build(kind);
        let options = self.options(&list.scene);
        let primitives = list.scene.stats().primitives as f64;
        let pixels = f64::from(options.width) * f64::from(options.height);
        let rays = reference.map_or(pixels * 4.0, |r| r.rays.total() as f64);
        let part = MOST_TESTS / (primitives * rays).max(1.0);
        let Some(reference) = reference.filter(|_| part < 1.0) else {
            let start = Instant::now();
            list.rendered = Some(strahl::render(&list.scene, &options).map_err(Failure::new)?);
            list.times.push(start.elapsed().as_secs_f64());
            return list
                .row()
                .ok_or_else(|| Failure::new("the list rendered nothing"));
        };
        let squares = squares(&options, part);
        let mut sum: Option<Rendered> = None;
        let (mut time, mut ours, mut theirs) = (0.0, vec![], vec![]);
        for square in &squares {
            let options = RenderOptions {
                region: Some(*square),
                ..options.clone()
            };
            let start = Instant::now();
            let rendered = strahl::render(&list.scene, &options).map_err(Failure::new)?;
            time += start.elapsed().as_secs_f64();
            for y in square.y..square.y + square.height {
                for x in square.x..square.x + square.width {
                    ours.push(rendered.film.pixel(x, y));
                    theirs.push(reference.film.pixel(x, y));
                }
            }
            sum = Some(match sum {
                None => rendered,
                Some(mut all) => {
                    all.rays += rendered.rays;
                    all.traversal += rendered.traversal;
                    all
                }
            });
        }
        list.times.push(time);
        list.rendered = sum;
        let mut row = list
            .row()
            .ok_or_else(|| Failure::new("the list rendered nothing"))?;
        row.sampled = Some(ours.len() as f64 / pixels);
        row.sha256 = if ours == theirs {
            reference.film.sha256()
        } else {
            "different".to_owned()
        };
        Ok(row)
    }
}

impl Contender {
    fn row(&mut self) -> Option<Row> {
        let rendered = self.rendered.as_ref()?;
        let SceneStats {
            accelerator_bytes,
            nodes,
            references,
            ..
        } = self.scene.stats();
        let (counts, cost) = (rendered.rays, rendered.traversal);
        let rays = counts.total();
        self.times.sort_by(f64::total_cmp);
        let trace = self.times[self.times.len() / 2];
        let per_ray = |n: u64| n as f64 / rays.max(1) as f64;
        Some(Row {
            accelerator: self.kind.to_string(),
            build_s: self.build,
            bytes: accelerator_bytes,
            nodes,
            references,
            rays,
            hits: counts.hits(),
            steps_per_ray: per_ray(cost.node_visits),
            tests_per_ray: per_ray(cost.primitive_tests),
            trace_s: trace,
            rays_per_s: rays as f64 / trace.max(1e-9),
            faster_than_list: None,
            sampled: None,
            sha256: hash(&rendered.film),
            equal: true,
        })
    }
}

fn hash(film: &Film) -> String {
    film.sha256()
}

/// Fills in the columns that depend on all rows.
fn finish(rows: &mut [Row]) {
    let list = rows.iter().find(|r| r.accelerator == "list");
    let list = list.map(|r| r.rays_per_s);
    let first = rows.first().map(|r| r.sha256.clone()).unwrap_or_default();
    for row in rows {
        row.faster_than_list = list.map(|list| row.rays_per_s / list);
        row.equal = row.sha256 == first;
    }
}

/// Squares of pixels, spread evenly over the picture, that cover about this fraction of it; at least one.
fn squares(options: &RenderOptions, part: f64) -> Vec<Region> {
    let (width, height) = (options.width, options.height);
    let pixels = f64::from(width) * f64::from(height) * part;
    let wanted = (pixels / f64::from(SQUARE * SQUARE)).max(1.0);
    let columns = (wanted * f64::from(width) / f64::from(height))
        .sqrt()
        .ceil() as u32;
    let rows = (wanted / f64::from(columns)).ceil() as u32;
    let (columns, rows) = (
        columns.clamp(1, width.div_ceil(SQUARE)),
        rows.clamp(1, height.div_ceil(SQUARE)),
    );
    let place = |index: u32, of: u32, length: u32| {
        let size = SQUARE.min(length);
        let start = f64::from(length - size) * (f64::from(index) + 0.5) / f64::from(of);
        (start as u32, size)
    };
    let mut squares = Vec::new();
    for row in 0..rows {
        for column in 0..columns {
            let ((x, width), (y, height)) =
                (place(column, columns, width), place(row, rows, height));
            squares.push(Region {
                x,
                y,
                width,
                height,
            });
        }
    }
    squares
}

fn table(rows: &[Row]) {
    say!(
        "{:34} {:>9} {:>11} {:>10} {:>11} {:>8} {:>9} {:>9} {:>9} {:>8}  sha256",
        "accelerator",
        "build s",
        "bytes",
        "nodes",
        "references",
        "steps",
        "tests",
        "trace s",
        "Mrays/s",
        "x list"
    );
    for r in rows {
        let faster = r.faster_than_list.map_or("-".into(), |f| format!("{f:.1}"));
        say!(
            "{:34} {:9.4} {:11} {:10} {:11} {:8.2} {:9.2} {:9.3} {:9.3} {:>8}  {}",
            r.accelerator,
            r.build_s,
            r.bytes,
            r.nodes,
            r.references,
            r.steps_per_ray,
            r.tests_per_ray,
            r.trace_s,
            r.rays_per_s / 1e6,
            faster,
            &r.sha256[..r.sha256.len().min(12)],
        );
    }
    for r in rows {
        if let Some(part) = r.sampled {
            say!(
                "{}: measured on {:.3} % of the pixels, which are equal to those of the other pictures",
                r.accelerator,
                part * 100.0
            );
        }
    }
    say!(
        "steps (nodes or cells visited) and tests of primitives are per ray, shadow rays included"
    );
}

fn csv(rows: &[Row]) {
    say!(
        "accelerator,build_s,bytes,nodes,references,rays,hits,steps_per_ray,tests_per_ray,trace_s,rays_per_s,faster_than_list,sampled,sha256,equal"
    );
    let number = |x: Option<f64>| x.map_or(String::new(), |x| x.to_string());
    for r in rows {
        say!(
            "\"{}\",{},{},{},{},{},{},{},{},{},{},{},{},{},{}",
            r.accelerator,
            r.build_s,
            r.bytes,
            r.nodes,
            r.references,
            r.rays,
            r.hits,
            r.steps_per_ray,
            r.tests_per_ray,
            r.trace_s,
            r.rays_per_s,
            number(r.faster_than_list),
            number(r.sampled),
            r.sha256,
            r.equal
        );
    }
}
