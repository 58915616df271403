//! `bench peers`: ray throughput on the same meshes and rays, in one process, the programs taking turns.

mod embree;
mod meshes;
mod rays;

use crate::bench::{median, strahl_binary};
use anyhow::{Context, Result, bail};
use embree::{Device, Embree, EmbreeScene, Options, Quality};
use meshes::{Mesh, View};
use rays::{Batch, Kind, make};
use std::time::Instant;
use strahl::geometry::{MeshData, Sphere, TriangleMesh};
use strahl::prelude::*;
use strahl::tracing::{Hit, PACKET, Prepared, RayClass, Tracer};

/// How the benchmark is run.
struct Plan<'a> {
    rounds: usize,
    side: u32,
    /// Parts of names; of the scenes those that contain one of them. None: all.
    only: Vec<&'a str>,
    /// Without Embree's slower settings and packets.
    brief: bool,
}

/// Makes a mesh, given its name.
type Maker = fn(&'static str) -> Mesh;

/// Builds of the same scene whose times are compared.
const BUILDS: usize = 3;

/// Mesh by mesh and kind by kind: millions of rays a second of strahl and of Embree, one thread.
pub(crate) fn run(args: &[&str]) -> Result<()> {
    let mut plan = Plan {
        rounds: 7,
        side: 768,
        only: vec![],
        brief: false,
    };
    let mut rest = args.iter();
    while let Some(arg) = rest.next() {
        let mut value = || rest.next().with_context(|| format!("{arg} needs a value"));
        match *arg {
            "--rounds" => plan.rounds = value()?.parse()?,
            "--side" => plan.side = value()?.parse()?,
            "--only" => plan.only = value()?.split(',').collect(),
            "--brief" => plan.brief = true,
            other => bail!(
                "unknown option {other}; there are --rounds N, --side PIXELS (a multiple of 4), --only PART,PART..., --brief"
            ),
        }
    }
    if plan.rounds == 0 || plan.side == 0 || !plan.side.is_multiple_of(4) {
        bail!("--rounds must be at least 1, --side a positive multiple of 4");
    }
    let embree = Embree::load()?;
    let device = embree.device(1)?;
    let mut table = Table::default();
    table.line(format!(
        "Mrays/s, one thread, medians of {} rounds in turns; {1}x{1} primary rays\n",
        plan.rounds, plan.side
    ));
    table.line(
        "| scene | rays | strahl | Embree | ratio | nodes | tests | Embree high | robust | strahl x16 | Embree x16 | ratio | differ |\n\
         |---|---|---|---|---|---|---|---|---|---|---|---|---|"
            .into(),
    );
    let mut ratios: Vec<Ratios> = vec![];
    let meshes: [(&'static str, Maker); 5] = [
        ("flake 66 k", |name| meshes::tessellated_flake(name, 3, 1)),
        ("terrain 524 k", |name| meshes::terrain(name, 512)),
        ("flake 945 k", |name| meshes::tessellated_flake(name, 4, 2)),
        ("soup 200 k", |name| meshes::soup(name, 200_000)),
        ("flake 1.9 M", |name| meshes::tessellated_flake(name, 5, 1)),
    ];
    for (name, mesh) in meshes {
        if plan.wants(name) {
            ratios.extend(one_mesh(&device, &mesh(name), &plan, &mut table)?);
        }
    }
    table.means("meshes", &ratios);
    ratios.clear();
    for (name, levels) in [
        ("spheres 7 k", 4),
        ("spheres 66 k", 5),
        ("spheres 598 k", 6),
    ] {
        if plan.wants(name) {
            ratios.extend(one_flake(&device, name, levels, &plan, &mut table)?);
        }
    }
    table.means("spheres", &ratios);
    table.save()
}

impl Plan<'_> {
    fn wants(&self, name: &str) -> bool {
        self.only.is_empty() || self.only.iter().any(|part| name.contains(part))
    }
}

/// The table, printed as it grows.
#[derive(Default)]
struct Table(String);

impl Table {
    fn line(&mut self, line: String) {
        println!("{line}");
        self.0.push_str(&line);
        self.0.push('\n');
    }

    /// Geometric means of the ratios of each kind.
    fn means(&mut self, of: &str, ratios: &[Ratios]) {
        for kind in Kind::ALL {
            let of_kind = || ratios.iter().filter(|r| r.kind == kind);
            let Some(single) = mean(of_kind().map(|r| r.single)) else {
                continue;
            };
            let packets = mean(of_kind().filter_map(|r| r.packets));
            let packets = packets.map_or(String::new(), |r| format!("{r:.2}"));
            self.line(format!(
                "| geometric mean of {of} | {} | | | {single:.2} | | | | | | | {packets} | |",
                kind.name()
            ));
        }
    }

    /// Keeps it beside the programs: in `target/bench-peers`.
    fn save(&self) -> Result<()> {
        let program = strahl_binary()?;
        let target = program.ancestors().nth(2);
        let folder = target
            .context("this program lies in a folder of target/")?
            .join("bench-peers");
        std::fs::create_dir_all(&folder)?;
        let path = folder.join("table.md");
        std::fs::write(&path, &self.0)?;
        println!("saved as {}", path.display());
        Ok(())
    }
}

/// The geometric mean; `None` of nothing.
fn mean(of: impl Iterator<Item = f64> + Clone) -> Option<f64> {
    let count = of.clone().count();
    (count > 0).then(|| of.product::<f64>().powf(1.0 / count as f64))
}

fn one_mesh(
    device: &Device<'_>,
    mesh: &Mesh,
    plan: &Plan<'_>,
    table: &mut Table,
) -> Result<Vec<Ratios>> {
    let data = MeshData {
        positions: mesh.positions.clone(),
        indices: mesh.indices.clone(),
        ..MeshData::default()
    };
    let scene = Scene::new().add(TriangleMesh::try_new(data)?);
    let build = |options| device.triangles(&mesh.positions, &mesh.indices, options);
    let count = mesh.indices.len();
    one_scene(mesh.name, &scene, count, &build, mesh.view, plan, table)
}

fn one_flake(
    device: &Device<'_>,
    name: &str,
    levels: u32,
    plan: &Plan<'_>,
    table: &mut Table,
) -> Result<Vec<Ratios>> {
    let spheres = meshes::sphereflake(levels);
    let mut scene = Scene::new();
    let mut theirs = vec![];
    for (center, radius) in &spheres {
        let (center, radius) = (center.as_vec3(), *radius as f32);
        scene = scene.add(Sphere::new(center.as_dvec3(), f64::from(radius)));
        theirs.push([center.x, center.y, center.z, radius]);
    }
    let build = |options| device.spheres(&theirs, options);
    let view = meshes::FLAKE_VIEW;
    one_scene(name, &scene, spheres.len(), &build, view, plan, table)
}

/// Builds a scene with both programs and lets its rays be traced; `count` is the number of its primitives.
fn one_scene<'e>(
    name: &str,
    scene: &Scene,
    count: usize,
    build: &dyn Fn(Options) -> Result<EmbreeScene<'e>>,
    view: View,
    plan: &Plan<'_>,
    table: &mut Table,
) -> Result<Vec<Ratios>> {
    let options = |quality, robust| Options { quality, robust };
    let medium = options(Quality::Medium, false);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    let prepared = Prepared::new(scene).map_err(strahl::Problems)?;
    let (mut our_times, mut their_times) = (vec![], vec![]);
    let mut built = None;
    for _ in 0..BUILDS {
        // One pair at a time is in memory.
        drop(built.take());
        let prepared = prepared.clone();
        let start = Instant::now();
        let ours = pool.install(|| prepared.build(AcceleratorKind::default()));
        our_times.push(start.elapsed().as_secs_f64());
        let start = Instant::now();
        let theirs = build(medium)?;
        their_times.push(start.elapsed().as_secs_f64());
        built = Some((ours, theirs));
    }
    drop(prepared);
    let (ours, theirs) = built.context("BUILDS is not 0")?;
    let (our_time, their_time) = (median(&mut our_times), median(&mut their_times));
    let stats = ours.stats();
    table.line(format!(
        "| {name} | build, s | {our_time:.3} | {their_time:.3} | {:.2} | {:.1} + {:.1} bytes each | | | | | | | |",
        their_time / our_time,
        stats.accelerator_bytes as f64 / count as f64,
        stats.geometry_bytes as f64 / count as f64,
    ));
    let mut theirs = vec![theirs];
    if !plan.brief {
        theirs.push(build(options(Quality::High, false))?);
        theirs.push(build(options(Quality::Medium, true))?);
    }
    let batches = make(&ours, view, plan.side);
    let compared = batches
        .iter()
        .map(|batch| compare(name, &ours, &theirs, batch, plan, table));
    Ok(compared.collect())
}

/// Lets the programs take turns on a batch; returns how many times faster strahl was than Embree.
fn compare(
    name: &str,
    ours: &RenderScene,
    theirs: &[EmbreeScene<'_>],
    batch: &Batch,
    plan: &Plan<'_>,
    table: &mut Table,
) -> Ratios {
    let any = batch.kind.any();
    let mut tracer = Tracer::new(ours);
    let mut programs = vec![Program::Ours];
    programs.extend((0..theirs.len()).map(Program::Embree));
    if !plan.brief || batch.kind.in_tiles() {
        programs.extend([Program::OurPackets, Program::EmbreePackets]);
    }
    let mut times = vec![vec![]; programs.len()];
    let (mut found, mut together, mut expected) = (vec![], vec![], vec![]);
    let (mut hits, mut hits_together, mut their_hits) = (0, 0, 0);
    for round in 0..plan.rounds {
        for turn in 0..programs.len() {
            // Everyone comes after everyone else.
            let number = (round + turn) % programs.len();
            let start = Instant::now();
            match programs[number] {
                Program::Ours if any => {
                    hits = batch
                        .rays()
                        .filter(|(ray, from)| tracer.any_opaque(ray, batch.range, *from))
                        .count();
                }
                Program::Ours => {
                    found.clear();
                    found.extend(batch.rays().map(|(ray, from)| {
                        let class = RayClass::Secondary;
                        distance(tracer.closest_hit(ray, batch.range, from, class))
                    }));
                }
                Program::OurPackets => {
                    hits_together = packets(&mut tracer, batch, &mut together);
                }
                Program::Embree(setting) if any => {
                    their_hits = theirs[setting].occluded(&batch.segments);
                }
                Program::Embree(setting) => {
                    theirs[setting].closest(&batch.segments, &mut expected);
                }
                Program::EmbreePackets => {
                    std::hint::black_box(theirs[0].packets(&batch.segments, any));
                }
            }
            times[number].push(start.elapsed().as_secs_f64());
        }
    }
    if programs.contains(&Program::OurPackets) {
        assert!(
            hits == hits_together && found == together,
            "packets find what single rays find"
        );
    }
    let single = tracer.stats;
    let differ = if any {
        hits.abs_diff(their_hits)
    } else {
        let close = |a: f32, b: f32| a == b || (a - b).abs() <= 1e-4 * a.abs();
        let pairs = found.iter().zip(&expected);
        pairs.filter(|(a, b)| !close(**a, **b)).count()
    };
    let time_of = |program| {
        let number = programs.iter().position(|p| *p == program)?;
        Some(&times[number])
    };
    let faster = |program, peer| {
        let pairs = time_of(program)?.iter().zip(time_of(peer)?);
        Some(median(&mut pairs.map(|(a, b)| b / a).collect::<Vec<f64>>()))
    };
    let rays = batch.segments.len();
    let speed = |program| {
        let median = time_of(program).map(|t| median(&mut t.clone()));
        median.map_or(String::new(), |m| format!("{:.1}", rays as f64 / 1e6 / m))
    };
    let ratio = faster(Program::Ours, Program::Embree(0)).unwrap_or(f64::NAN);
    let of_packets = faster(Program::OurPackets, Program::EmbreePackets);
    let others = [
        speed(Program::Embree(1)),
        speed(Program::Embree(2)),
        speed(Program::OurPackets),
        speed(Program::EmbreePackets),
        of_packets.map_or(String::new(), |r| format!("{r:.2}")),
    ]
    .join(" | ");
    let per_ray = |n: u64| n as f64 / (rays * plan.rounds) as f64;
    table.line(format!(
        "| {name} | {} | {} | {} | {ratio:.2} | {:.1} | {:.1} | {others} | {differ} of {rays} |",
        batch.kind.name(),
        speed(Program::Ours),
        speed(Program::Embree(0)),
        per_ray(single.node_visits),
        per_ray(single.primitive_tests),
    ));
    Ratios {
        kind: batch.kind,
        single: ratio,
        packets: of_packets,
    }
}

/// Who traces rays.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Program {
    Ours,
    /// Sixteen rays at once.
    OurPackets,
    /// In one of its settings.
    Embree(usize),
    /// Sixteen rays at once, in its first setting.
    EmbreePackets,
}

/// How many times faster strahl was than Embree.
struct Ratios {
    kind: Kind,
    single: f64,
    packets: Option<f64>,
}

/// How far away a hit is, in the numbers of Embree.
fn distance(hit: Option<Hit>) -> f32 {
    hit.map_or(f32::INFINITY, |h| h.t as f32)
}

/// Follows sixteen rays at once: the distances of their hits, or, of rays that any hit will do for, the number of those that have one.
fn packets(tracer: &mut Tracer<'_>, batch: &Batch, found: &mut Vec<f32>) -> usize {
    found.clear();
    let mut hits = 0;
    for (number, rays) in batch.rays.chunks(PACKET).enumerate() {
        let first = number * PACKET;
        let from = std::array::from_fn(|lane| batch.starts.get(first + lane));
        if batch.kind.any() {
            hits += tracer.any_opaques(rays, batch.range, &from).count_ones() as usize;
        } else {
            let class = RayClass::Secondary;
            let mut closest = [None; PACKET];
            tracer.closest_hits(rays, batch.range, &from, class, &mut closest);
            found.extend(closest.into_iter().take(rays.len()).map(distance));
        }
    }
    hits
}
