//! Compares the looks of the include library: renders every name that has a look with POV-Ray and its includes and with strahl
//! and its own, and compares the pictures.

mod measure;
mod report;

use crate::arguments::Arguments;
use crate::compare_pov::picture::{self, Shown};
use crate::compare_pov::programs::{Outcome, Programs};
use crate::plates::{self, Name, Sheet};
use anyhow::{Context, Result, bail};
use measure::{Distance, Plate, distance};
use std::path::PathBuf;

/// A name with its two plates.
struct Look {
    name: Name,
    theirs: Plate,
    ours: Plate,
    distance: Distance,
}

struct Options {
    only: Option<String>,
    out: PathBuf,
    cell: (u32, u32),
    program: Option<PathBuf>,
    library: Option<PathBuf>,
    table: Option<PathBuf>,
    means: Option<PathBuf>,
}

impl Options {
    fn new(args: &[&str]) -> Result<Self> {
        let mut options = Self {
            only: None,
            out: PathBuf::from("target/looks"),
            cell: (48, 36),
            program: None,
            library: None,
            table: None,
            means: None,
        };
        let mut args = Arguments::new(args);
        while let Some(option) = args.option() {
            let path = |text: &str| Ok::<_, anyhow::Error>(Some(std::path::absolute(text)?));
            match option {
                "--only" => options.only = Some(args.value()?.to_owned()),
                "--out" => options.out = PathBuf::from(args.value()?),
                "--cell" => options.cell = crate::compare_pov::size(args.value()?)?,
                "--program" => options.program = path(args.value()?)?,
                "--library" => options.library = path(args.value()?)?,
                "--table" => options.table = path(args.value()?)?,
                "--means" => options.means = path(args.value()?)?,
                other => bail!("unknown option {other}"),
            }
        }
        // The programs run in other folders.
        options.out = std::path::absolute(&options.out)?;
        Ok(options)
    }
}

/// `cargo xtask looks`
pub(crate) fn run(args: &[&str]) -> Result<()> {
    let options = Options::new(args)?;
    let mut names = plates::names();
    if let Some(only) = &options.only {
        names.retain(|n| format!("{}/{}", n.file, n.name).contains(only.as_str()));
    }
    if names.is_empty() {
        bail!("no name with a look contains the part given by --only");
    }
    for folder in ["images", "scenes"] {
        let folder = options.out.join(folder);
        std::fs::create_dir_all(&folder)
            .with_context(|| format!("cannot create {}", folder.display()))?;
    }
    let mut programs = Programs::new(options.cell, options.program.as_deref())?;
    programs.library.clone_from(&options.library);
    let mut looks = vec![];
    let sheets = plates::sheets(&names);
    for (index, sheet) in sheets.iter().enumerate() {
        let first = sheet.names.first().map_or("", |n| n.name);
        eprintln!("{}/{} from {first}", index + 1, sheets.len());
        looks.extend(compare(&options, sheet, &programs)?);
    }
    for look in &looks {
        for (plate, who) in [(&look.theirs, "povray"), (&look.ours, "strahl")] {
            let file = report::image(&look.name, who);
            let (width, height) = (u32::try_from(plate.width)?, u32::try_from(plate.height)?);
            let shown = Shown::new(width, height, plate.rgb.as_flattened().to_vec());
            picture::write(&shown, &options.out.join(file))?;
        }
    }
    report::write_html(&looks, &options.out.join("index.html"))?;
    print!("{}", report::lines(&looks));
    print!("{}", report::summary(&looks));
    println!("report: {}", options.out.join("index.html").display());
    if let Some(file) = &options.table {
        report::write_table(&looks, file)?;
    }
    if let Some(file) = &options.means {
        report::write_means(&looks, options.cell, file)?;
    }
    Ok(())
}

/// Renders a sheet with both programs and cuts it into plates.
fn compare(options: &Options, sheet: &Sheet, programs: &Programs) -> Result<Vec<Look>> {
    let Some(first) = sheet.names.first() else {
        return Ok(vec![]);
    };
    let title = format!("{}-{}", first.file.trim_end_matches(".inc"), first.name);
    let scene = options.out.join("scenes").join(format!("{title}.pov"));
    std::fs::write(&scene, &sheet.text)?;
    let (w, h) = options.cell;
    let programs = programs.sized((w * sheet.columns as u32, h * sheet.rows as u32));
    let file = |who: &str| options.out.join(format!("images/{title}-sheet-{who}.png"));
    let (theirs, ours) = (file("povray"), file("strahl"));
    let rendered = |outcome: Outcome, who: &str| match outcome.rendered {
        true => Ok(()),
        false => bail!("{who} and {}: {}", scene.display(), outcome.reason),
    };
    rendered(
        programs.povray(&scene, sheet.text.as_bytes(), &theirs)?,
        "POV-Ray",
    )?;
    rendered(programs.strahl(&scene, &ours)?, "strahl")?;
    let (theirs, ours) = (picture::read(&theirs)?, picture::read(&ours)?);
    let looks = sheet.names.iter().enumerate().map(|(i, name)| {
        let place = (i % sheet.columns, i / sheet.columns);
        let (theirs, ours) = (
            cut(&theirs, options.cell, place),
            cut(&ours, options.cell, place),
        );
        let distance = distance(&theirs, &ours);
        Look {
            name: *name,
            theirs,
            ours,
            distance,
        }
    });
    Ok(looks.collect())
}

/// The plate in a column and row of a sheet.
fn cut(sheet: &Shown, cell: (u32, u32), (column, row): (usize, usize)) -> Plate {
    let (width, height) = (cell.0 as usize, cell.1 as usize);
    let pixels = sheet.pixels();
    let across = sheet.size().0 as usize;
    let rgb = (0..height)
        .flat_map(|y| {
            let start = (row * height + y) * across + column * width;
            pixels.get(start..start + width).unwrap_or_default()
        })
        .copied()
        .collect();
    Plate { width, height, rgb }
}
