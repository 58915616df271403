//! Chores of the repository, run as `cargo xtask COMMAND`.
#![allow(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "programs may print"
)]

mod arguments;
mod bench;
mod bench_csg;
mod bench_load;
mod bench_objects;
mod bench_parse;
mod bench_scenes;
#[cfg(test)]
mod books;
mod compare_pov;
mod convert;
mod differ;
mod facets;
mod gallery;
mod lab;
mod looks;
mod nff;
mod parallel;
mod peers;
#[path = "../../crates/strahl-sdl/tests/common/plates.rs"]
mod plates;
mod profiled;
mod record;
mod spd;

use anyhow::{Result, bail};
use std::path::Path;
use std::process::ExitCode;

const USAGE: &str = "usage: cargo xtask COMMAND
  bench spd [FOLDER] [--runs N] [--threads N] [--only NAME,...]
                                  trace times of the SPD scenes (*.nff.gz) in FOLDER against POV-Ray and Tachyon;
                                  rings, tree and lattice are generated if FOLDER lacks them
  bench csg [--runs N] [--threads N] [--only PART]
                                  trace times of generated CSG scenes against POV-Ray
  bench objects [--plain | --program STRAHL] [--runs N] [--size 640x480] [--only PART]
                                  processor time of each kind of object against POV-Ray; time and memory of
                                  free-form surfaces against triangles of the size of a pixel
  bench parse [--runs N] [--megabytes N]
                                  time to parse a million spheres made by loops, and an exported scene, against POV-Ray
  bench load [--runs N] [--side N]
                                  time to read files of 10 million triangles, and to build the accelerator
  bench scenes [FOLDER] [--aa] [--errors] [--plain | --program STRAHL] [--runs N] [--size 320x240] [--only PART] [--most SECONDS] [--out DIR]
                                  processor time of POV-Ray and strahl, built as scripts/install does, on real scenes;
                                  --plain without the recorded profile, --program an
                                  installed one, --aa with +A0.3, --errors against
                                  converged pictures
  bench peers [--rounds N] [--side PIXELS] [--only PART,...] [--brief]
                                  rays per second on meshes and spheres against Embree, one thread
  compare-pov [FOLDER] [--size 160x120] [--limit N] [--only PART] [--jobs 2] [--out DIR]
                                  renders POV-Ray's example scenes with both programs and compares the pictures
  differ [--seed N] [--count M] [--first N] [--jobs 8] [--out DIR] [--strahl BINARY] [--print]
                                  renders random scenes with both programs; those that differ are reduced
  facets                          renders the pictures of patches in the manual with both programs
  gallery [--only PART] [--check]
                                  writes the manual's pages and pictures of scenes/{gallery,lecture,showcase};
                                  --check only lists missing or outdated pages
  generate sphereflake|tetra LEVELS OUTPUT.nff
  generate crystal SIDE OUTPUT.nff
  generate stadium OUTPUT.nff     writes a scene: crystal suits grids, stadium does not
  growth OUTPUT.csv [--size WxH]  measures the cost of a ray for every accelerator, with growing scenes
  plot-growth TABLE.csv FOLDER    draws that table as double-logarithmic plots
  looks [--only PART] [--out DIR] [--cell 48x36] [--program STRAHL] [--library DIR] [--table FILE] [--means FILE]
                                  compares the looks of the include library; --library tries other includes
  nff2pov SCENE OUTPUT.pov        converts a scene for POV-Ray, such that both programs do the same work
  nff2dat SCENE OUTPUT.dat        converts a scene for Tachyon, which does not refract
  record [--out FILE]             renders scenes of ours with a build that counts, and writes the profile that
                                  scripts/install compiles the program with
  spd rings|tree|lattice SIZE -o FILE.nff[.gz]
                                  writes a scene in the spirit of SPD; bench spd takes rings 7, tree 11 and lattice 12";

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}

fn run() -> Result<()> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = args.iter().map(String::as_str).collect();
    match words.as_slice() {
        ["bench", "spd", rest @ ..] => bench::spd(rest),
        ["bench", "csg", rest @ ..] => bench_csg::run(rest),
        ["bench", "objects", rest @ ..] => bench_objects::run(rest),
        ["bench", "load", rest @ ..] => bench_load::run(rest),
        ["bench", "parse", rest @ ..] => bench_parse::parse(rest),
        ["bench", "scenes", rest @ ..] => bench_scenes::run(rest),
        ["bench", "peers", rest @ ..] => peers::run(rest),
        ["compare-pov", rest @ ..] => compare_pov::run(rest),
        ["differ", rest @ ..] => differ::run(rest),
        ["facets"] => facets::run(),
        ["gallery", rest @ ..] => gallery::run(rest),
        ["generate", what, size, output] => {
            Ok(std::fs::write(output, lab::generate(what, Some(size))?)?)
        }
        ["generate", what, output] => Ok(std::fs::write(output, lab::generate(what, None)?)?),
        ["growth", output] => lab::measure(Path::new(output), "256x256"),
        ["growth", output, "--size", size] => lab::measure(Path::new(output), size),
        ["looks", rest @ ..] => looks::run(rest),
        ["plot-growth", table, folder] => lab::plot_growth(Path::new(table), Path::new(folder)),
        ["nff2pov", scene, output] => convert::to_pov(Path::new(scene), Path::new(output)),
        ["nff2dat", scene, output] => convert::to_dat(Path::new(scene), Path::new(output)),
        ["record", rest @ ..] => record::run(rest),
        ["spd", rest @ ..] => spd::run(rest),
        _ => bail!("{USAGE}"),
    }
}
