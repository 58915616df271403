//! The error of antialiased pictures against converged ones.

use super::Options;
use super::measure::{self, Program, Timed};
use crate::compare_pov::picture;
use anyhow::Result;
use std::path::{Path, PathBuf};

/// Root mean square errors of both programs' pictures in 8-bit codes, each against the program's own converged picture. `None` if
/// a converged picture takes too long.
pub(super) fn errors(
    scene: &Path,
    pictures: &[PathBuf; 2],
    options: &Options,
) -> Result<Option<(f64, f64)>> {
    let folder = tempfile::tempdir()?;
    let mut errors = vec![];
    for (program, antialiased) in [Program::PovRay, Program::Strahl].into_iter().zip(pictures) {
        let converged = folder.path().join(program.picture());
        let sampling = program.converged();
        match measure::render(
            program,
            scene,
            &converged,
            options.size,
            sampling,
            options.most,
        )? {
            Timed::Failed(_) => return Ok(None),
            Timed::Seconds(_) => {}
        }
        let (a, b) = (picture::read(antialiased)?, picture::read(&converged)?);
        errors.extend(picture::compare(&a, &b).map(|(_, rms)| rms));
    }
    Ok(match errors[..] {
        [povray, strahl] => Some((povray, strahl)),
        _ => None,
    })
}
