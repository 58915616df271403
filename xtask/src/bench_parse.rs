//! Speed of parsing against POV-Ray: both programs take turns on the same generated files.

use crate::arguments::Arguments;
use crate::bench::median;
use anyhow::{Context, Result, bail};
use std::fmt::Write as _;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::process::Command;

/// The cost of parsing a scene once.
#[derive(Clone, Copy)]
struct Cost {
    /// Seconds of processor time.
    seconds: f64,
    /// Peak memory of the process, in bytes.
    memory: f64,
}

/// A generated scene.
struct Case {
    name: &'static str,
    path: PathBuf,
    bytes: f64,
    /// The number of objects in the scene.
    objects: f64,
}

/// Processor time for parsing a scene of a million spheres made by loops and macros, and an exported scene of `--megabytes`.
pub(crate) fn parse(args: &[&str]) -> Result<()> {
    let (mut runs, mut megabytes) = (5, 300);
    let mut args = Arguments::new(args);
    while let Some(option) = args.option() {
        match option {
            "--runs" => runs = args.number()?,
            "--megabytes" => megabytes = args.number()?,
            other => bail!("unknown option {other}"),
        }
    }
    if runs == 0 {
        bail!("--runs must be at least 1");
    }
    let program = build()?;
    let folder = program
        .ancestors()
        .nth(3)
        .context("time_parse is not in target/release/examples")?
        .join("bench-parse");
    std::fs::create_dir_all(&folder)?;
    let cases = [loops(&folder)?, exported(&folder, megabytes << 20)?];
    let mut table = String::from(
        "| scene | | parse s (CPU) | MB/s | objects/s | peak memory | bytes/object | faster by |\n\
         |---|---|---|---|---|---|---|---|\n",
    );
    for case in &cases {
        let (mut ours, mut theirs) = (vec![], vec![]);
        for _ in 0..runs {
            ours.push(strahl(&program, case)?);
            theirs.push(povray(case)?);
        }
        let mut ratios: Vec<f64> = ours
            .iter()
            .zip(&theirs)
            .map(|(a, b)| b.seconds / a.seconds)
            .collect();
        row(&mut table, case, "strahl", &ours, Some(median(&mut ratios)))?;
        row(&mut table, case, "POV-Ray", &theirs, None)?;
    }
    println!("{table}");
    let report = folder.join("table.md");
    std::fs::write(&report, table)?;
    println!("saved as {}", report.display());
    Ok(())
}

fn row(
    table: &mut String,
    case: &Case,
    program: &str,
    costs: &[Cost],
    ratio: Option<f64>,
) -> Result<()> {
    let mut seconds: Vec<f64> = costs.iter().map(|c| c.seconds).collect();
    let mut memory: Vec<f64> = costs.iter().map(|c| c.memory).collect();
    let (seconds, memory) = (median(&mut seconds), median(&mut memory));
    let per_object = memory / case.objects;
    writeln!(
        table,
        "| {} | {program} | {seconds:.3} | {:.1} | {:.2} million | {:.0} MB | {per_object:.0} | {} |",
        case.name,
        case.bytes / seconds / 1e6,
        case.objects / seconds / 1e6,
        memory / 1e6,
        ratio.map_or(String::new(), |r| format!("{r:.2}")),
    )?;
    Ok(())
}

/// Builds the program that parses a scene and prints what that cost.
fn build() -> Result<PathBuf> {
    let status = Command::new("cargo")
        .args(["build", "--release", "--quiet", "-p", "strahl-sdl"])
        .args(["--example", "time_parse"])
        .status()?;
    if !status.success() {
        bail!("the example time_parse of strahl-sdl does not build");
    }
    let binary = crate::bench::strahl_binary()?;
    let folder = binary
        .parent()
        .and_then(Path::parent)
        .context("this program is not in a folder of target/")?;
    Ok(folder.join("release/examples/time_parse"))
}

fn strahl(program: &Path, case: &Case) -> Result<Cost> {
    let output = Command::new(program).arg(&case.path).output()?;
    let text = String::from_utf8_lossy(&output.stdout);
    let number = |name: &str| -> Result<f64> {
        let mut words = text.split_whitespace();
        words
            .find(|word| *word == name)
            .and_then(|_| words.next()?.parse().ok())
            .with_context(|| format!("time_parse has printed no {name}:\n{text}"))
    };
    if number("objects")? != case.objects {
        bail!("{} has {} objects:\n{text}", case.name, case.objects);
    }
    Ok(Cost {
        seconds: number("cpu")?,
        memory: number("peak")?,
    })
}

/// POV-Ray prints the processor time of its parser. A picture of one pixel without bounding boxes adds little memory.
fn povray(case: &Case) -> Result<Cost> {
    let picture = tempfile::tempdir()?;
    let output = Command::new("time")
        .args(["-f", "peak %M", "povray"])
        .arg(format!("+I{}", case.path.display()))
        .arg(format!("+O{}", picture.path().join("pov.png").display()))
        .args(["+W1", "+H1", "+WT1", "-A", "-D", "-MB"])
        .output()
        .context("cannot run povray under time (Debian packages povray, time)")?;
    let log = String::from_utf8_lossy(&output.stderr);
    // "Parse Time: ... (0.605 seconds)", and in the next line "using 1 thread(s) with 0.593 CPU-seconds total"
    let mut lines = log
        .lines()
        .skip_while(|l| !l.trim_start().starts_with("Parse Time"));
    let seconds = lines
        .nth(1)
        .and_then(|l| l.split_once("with "))
        .and_then(|(_, s)| s.split(' ').next()?.parse().ok())
        .with_context(|| format!("povray has printed no time of its parser:\n{log}"))?;
    let kilobytes: f64 = log
        .lines()
        .rev()
        .find_map(|l| l.strip_prefix("peak ")?.parse().ok())
        .with_context(|| format!("time has printed no memory:\n{log}"))?;
    Ok(Cost {
        seconds,
        memory: kilobytes * 1024.0,
    })
}

fn case(name: &'static str, path: PathBuf, objects: u32) -> Result<Case> {
    let bytes = std::fs::metadata(&path)?.len() as f64;
    Ok(Case {
        name,
        path,
        bytes,
        objects: f64::from(objects),
    })
}

const VIEW: &str = "\
global_settings { assumed_gamma 1 }
camera { location <50, 50, -200> look_at <50, 50, 50> }
light_source { <100, 200, -300> rgb 1 }
";

/// A million spheres, each with its own colour, from nested loops of both kinds and macros that call macros.
fn loops(folder: &Path) -> Result<Case> {
    let path = folder.join("loops.pov");
    let text = format!(
        "#version 3.7;\n{VIEW}
#declare Side = 100;
#macro Ball(Center, Radius, Tint)
  sphere {{ Center, Radius pigment {{ rgb Tint }} }}
#end
#macro Row(Y, Z)
  #local X = 0;
  #while (X < Side)
    #local Here = <X, Y, Z>;
    Ball(Here, 0.2 + 0.2 * sin(X * Y + Z), Here / Side)
    #local X = X + 1;
  #end
#end
#for (Z, 0, Side - 1)
  #for (Y, 0, Side - 1)
    Row(Y, Z)
  #end
#end
"
    );
    std::fs::write(&path, text)?;
    case("a million spheres by loops and macros", path, 1_000_000)
}

/// Pseudorandom numbers, the same in every run.
struct Numbers(u64);

impl Numbers {
    fn below(&mut self, bound: f64) -> f64 {
        // The multiplier of Knuth's MMIX generator.
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64 * bound
    }

    fn point(&mut self) -> String {
        let [x, y, z] = [0; 3].map(|_| self.below(100.0));
        format!("<{x:.6},{y:.6},{z:.6}>")
    }

    fn color(&mut self) -> [f64; 3] {
        [0; 3].map(|_| self.below(1.0))
    }
}

/// A file as exporters of molecules and meshes write it: every object has its own numbers and texture, and most colours are those
/// of a dozen elements.
fn exported(folder: &Path, size: u64) -> Result<Case> {
    let path = folder.join("exported.pov");
    let mut file = BufWriter::new(std::fs::File::create(&path)?);
    let default = "#default { texture { finish { ambient 0.2 diffuse 0.65 specular 0.5 } } }";
    let head = format!("#version 3.6;\n{VIEW}{default}\n");
    file.write_all(head.as_bytes())?;
    let mut written = head.len() as u64;
    let mut numbers = Numbers(1);
    let palette: Vec<[f64; 3]> = (0..12).map(|_| numbers.color()).collect();
    let mut objects = 0;
    while written < size {
        let element = numbers.below(palette.len() as f64) as usize;
        let [r, g, b] = match palette.get(element) {
            Some(color) if objects % 4 != 0 => *color,
            _ => numbers.color(),
        };
        let radius = 0.1 + numbers.below(0.9);
        let [p, q, s] = [0; 3].map(|_| numbers.point());
        let color = format!("{r:.4},{g:.4},{b:.4}");
        let text = match objects % 8 {
            0..3 => format!(
                "sphere {{{p}, {radius:.6}\n texture {{ pigment {{ color rgb <{color}> }} \
                 finish {{ phong 0.9 phong_size 120 }} }} }}\n"
            ),
            3..6 => format!(
                "cylinder {{{p}, {q}, {radius:.6}\n pigment {{ rgbt <{color},0.000> }} }}\n"
            ),
            6 => format!(
                "triangle {{{p}, {q}, {s} texture {{ pigment {{ color rgb <{color}> }} }} }}\n"
            ),
            _ => format!(
                "mesh2 {{ vertex_vectors {{ 3, {p}, {q}, {s} }} \
                 normal_vectors {{ 3, <0,0,1>,<0,1,0>,<1,0,0> }} \
                 face_indices {{ 1, <0,1,2> }} pigment {{ color rgb <{color}> }} no_shadow }}\n"
            ),
        };
        file.write_all(text.as_bytes())?;
        written += text.len() as u64;
        objects += 1;
    }
    file.flush()?;
    case("an exported scene", path, objects)
}
