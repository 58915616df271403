//! The pictures of the manual that show patches: facets in POV-Ray, the surface itself in strahl.

use crate::bench_objects::{FINE, teapot};
use crate::bench_scenes::measure::{Program, Timed, render};
use anyhow::{Result, bail};
use std::path::Path;

/// A view of the showcase's teapot: a name, how finely POV-Ray divides the patches, where the camera looks, and its angle in degrees.
const VIEWS: [(&str, &str, &str, &str); 2] = [
    // The spout.
    ("default", "", "<2.2, 1.85, 0>", "12"),
    // The tip of its lip, which turns within a few thousandths.
    ("fine", FINE, "<3.144, 2.467, 1.4>", "0.1"),
];
const SIZE: (u32, u32) = (160, 120);
/// Seconds for a picture.
const MOST: f64 = 60.0;

/// `cargo xtask facets`: writes both programs' pictures of each view.
pub(crate) fn run() -> Result<()> {
    crate::bench::build_strahl()?;
    let images = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/src/images");
    let folder = tempfile::tempdir()?;
    for (name, steps, look_at, angle) in VIEWS {
        let text = teapot(steps)?
            .replace("<0.15, 1.25, 0>", look_at)
            .replace("angle 40", &format!("angle {angle}"));
        let scene = folder.path().join(format!("{name}.pov"));
        std::fs::write(&scene, text)?;
        for program in [Program::PovRay, Program::Strahl] {
            let picture = images.join(format!("patch-{name}-{}", program.picture()));
            let sampling = program.antialiased();
            if let Timed::Failed(why) = render(program, &scene, &picture, SIZE, sampling, MOST)? {
                bail!("{name}: {}: {why}", program.name());
            }
            println!("{}", picture.display());
        }
    }
    Ok(())
}
