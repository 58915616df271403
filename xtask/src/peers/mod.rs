//! `bench peers`: ray throughput on the same meshes and rays, in one process, the programs taking turns.

mod embree;
mod meshes;
mod rays;

use crate::bench::median;
use anyhow::{Context, Result, bail};
use embree::{Embree, EmbreeScene, Options, Quality};
use meshes::Mesh;
use rays::{Batch, Kind, make};
use std::time::Instant;
use strahl::geometry::{MeshData, Sphere, TriangleMesh};
use strahl::prelude::*;
use strahl::tracing::{RayClass, Tracer};

/// Mesh by mesh and kind by kind: millions of rays a second of strahl and of Embree, one thread.
pub(crate) fn run(args: &[&str]) -> Result<()> {
    let (mut rounds, mut side, mut only) = (7usize, 768u32, "");
    let mut rest = args.iter();
    while let Some(arg) = rest.next() {
        let mut value = || rest.next().with_context(|| format!("{arg} needs a value"));
        match *arg {
            "--rounds" => rounds = value()?.parse()?,
            "--side" => side = value()?.parse()?,
            "--only" => only = value()?,
            other => bail!(
                "unknown option {other}; there are --rounds N, --side PIXELS (a multiple of 4), --only PART"
            ),
        }
    }
    if rounds == 0 || side == 0 || !side.is_multiple_of(4) {
        bail!("--rounds must be at least 1, --side a positive multiple of 4");
    }
    let embree = Embree::load()?;
    println!(
        "Mrays/s, one thread, medians of {rounds} rounds in turns; {side}x{side} primary rays\n"
    );
    println!(
        "| scene | rays | strahl | Embree | ratio | Embree high | Embree robust | Embree x16 | differ |"
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    let mut ratios: Vec<(Kind, f64)> = vec![];
    let meshes: [fn() -> Mesh; 5] = [
        || meshes::tessellated_flake("flake 66 k", 3, 1),
        || meshes::terrain("terrain 524 k", 512),
        || meshes::tessellated_flake("flake 945 k", 4, 2),
        || meshes::soup("soup 200 k", 200_000),
        || meshes::tessellated_flake("flake 1.9 M", 5, 1),
    ];
    for mesh in meshes {
        let mesh = mesh();
        if mesh.name.contains(only) {
            ratios.extend(one_mesh(&embree, &mesh, rounds, side)?);
        }
    }
    for (name, levels) in [
        ("spheres 7 k", 4),
        ("spheres 66 k", 5),
        ("spheres 598 k", 6),
    ] {
        if name.contains(only) {
            one_flake(&embree, name, levels, rounds, side)?;
        }
    }
    for kind in Kind::ALL {
        let of: Vec<f64> = ratios
            .iter()
            .filter(|(k, _)| *k == kind)
            .map(|(_, r)| *r)
            .collect();
        if !of.is_empty() {
            let mean = of.iter().product::<f64>().powf(1.0 / of.len() as f64);
            println!(
                "| geometric mean of meshes | {} | | | {mean:.2} | | | | |",
                kind.name()
            );
        }
    }
    Ok(())
}

fn one_mesh(embree: &Embree, mesh: &Mesh, rounds: usize, side: u32) -> Result<Vec<(Kind, f64)>> {
    let data = MeshData {
        positions: mesh.positions.clone(),
        indices: mesh.indices.clone(),
        ..MeshData::default()
    };
    let object = TriangleMesh::try_new(data)?;
    let scene = Scene::new().add(object);
    let (ours, our_time) = compiled(&scene)?;
    let build = |quality, robust| {
        let options = Options {
            quality,
            robust,
            threads: 1,
        };
        let start = Instant::now();
        let scene = embree.triangles(&mesh.positions, &mesh.indices, options)?;
        anyhow::Ok((scene, start.elapsed().as_secs_f64()))
    };
    let (medium, medium_time) = build(Quality::Medium, false)?;
    let (high, _) = build(Quality::High, false)?;
    let (robust, _) = build(Quality::Medium, true)?;
    let triangles = mesh.indices.len();
    let stats = ours.stats();
    println!(
        "| {} | build, s | {our_time:.3} | {medium_time:.3} | {:.2} | {:.0} + {:.0} B/triangle | | | |",
        mesh.name,
        medium_time / our_time,
        stats.accelerator_bytes as f64 / triangles as f64,
        stats.geometry_bytes as f64 / triangles as f64,
    );
    let batches = make(&ours, mesh.eye, mesh.target, mesh.light, side);
    Ok(compare(
        mesh.name,
        &ours,
        &[&medium, &high, &robust],
        &batches,
        rounds,
    ))
}

fn one_flake(
    embree: &Embree,
    name: &'static str,
    levels: u32,
    rounds: usize,
    side: u32,
) -> Result<()> {
    let spheres = meshes::sphereflake(levels);
    let mut scene = Scene::new();
    let mut theirs = vec![];
    for (center, radius) in &spheres {
        let (center, radius) = (center.as_vec3(), *radius as f32);
        scene = scene.add(Sphere::new(center.as_dvec3(), f64::from(radius)));
        theirs.push([center.x, center.y, center.z, radius]);
    }
    let (ours, _) = compiled(&scene)?;
    let options = Options {
        quality: Quality::Medium,
        robust: false,
        threads: 1,
    };
    let medium = embree.spheres(&theirs, options)?;
    let view = (
        DVec3::new(2.1, 1.3, 1.7),
        DVec3::new(0.0, 0.0, 0.1),
        DVec3::new(4.0, 3.0, 2.0),
    );
    let batches = make(&ours, view.0, view.1, view.2, side);
    compare(name, &ours, &[&medium], &batches, rounds);
    Ok(())
}

/// The compiled scene and how long building its accelerator took.
fn compiled(scene: &Scene) -> Result<(RenderScene, f64)> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    let prepared = strahl::tracing::Prepared::new(scene).map_err(strahl::Problems)?;
    let start = Instant::now();
    let scene = pool.install(|| prepared.build(AcceleratorKind::default()));
    Ok((scene, start.elapsed().as_secs_f64()))
}

fn compare(
    name: &str,
    ours: &RenderScene,
    theirs: &[&EmbreeScene<'_>],
    batches: &[Batch],
    rounds: usize,
) -> Vec<(Kind, f64)> {
    let mut ratios = vec![];
    for batch in batches {
        let any = batch.kind.any();
        let count = batch.segments.len() as f64 / 1e6;
        let mut tracer = Tracer::new(ours);
        let (mut t_ours, mut t_theirs) = (vec![], vec![vec![]; theirs.len() + 1]);
        let (mut found, mut expected) = (vec![], vec![]);
        let (mut hits, mut their_hits) = (0, 0);
        for _ in 0..rounds {
            let start = Instant::now();
            if any {
                hits = batch
                    .rays
                    .iter()
                    .filter(|(ray, range, from)| tracer.any_opaque(ray, *range, from.as_ref()))
                    .count();
            } else {
                found.clear();
                for (ray, range, from) in &batch.rays {
                    let hit = tracer.closest_hit(ray, *range, from.as_ref(), RayClass::Secondary);
                    found.push(hit.map_or(f32::INFINITY, |h| h.t as f32));
                }
            }
            t_ours.push(start.elapsed().as_secs_f64());
            for (scene, times) in theirs.iter().zip(&mut t_theirs) {
                let start = Instant::now();
                if any {
                    their_hits = scene.occluded(&batch.segments);
                } else {
                    scene.closest(&batch.segments, &mut expected);
                }
                times.push(start.elapsed().as_secs_f64());
            }
            let start = Instant::now();
            std::hint::black_box(theirs[0].packets(&batch.segments, any));
            t_theirs[theirs.len()].push(start.elapsed().as_secs_f64());
        }
        let differ = if any {
            hits.abs_diff(their_hits)
        } else {
            let close = |a: f32, b: f32| a == b || (a - b).abs() <= 1e-4 * a.abs();
            found
                .iter()
                .zip(&expected)
                .filter(|(a, b)| !close(**a, **b))
                .count()
        };
        let mut pairs: Vec<f64> = t_ours
            .iter()
            .zip(&t_theirs[0])
            .map(|(a, b)| b / a)
            .collect();
        let ratio = median(&mut pairs);
        let speed = |times: &mut Vec<f64>| count / median(times);
        let packets = speed(&mut t_theirs[theirs.len()]);
        let others: Vec<String> = (1..3)
            .map(|i| {
                if i < theirs.len() {
                    format!("{:.1}", speed(&mut t_theirs[i]))
                } else {
                    String::new()
                }
            })
            .collect();
        println!(
            "| {name} | {} | {:.1} | {:.1} | {ratio:.2} | {} | {} | {packets:.1} | {differ} of {} |",
            batch.kind.name(),
            speed(&mut t_ours),
            speed(&mut t_theirs[0]),
            others[0],
            others[1],
            batch.segments.len(),
        );
        ratios.push((batch.kind, ratio));
    }
    ratios
}
