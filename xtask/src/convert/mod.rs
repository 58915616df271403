//! Converts scenes of other formats for the programs that strahl is compared with.

mod dat;
mod pov;

use anyhow::{Context, Result, bail};
use std::path::Path;
use strahl::formats::scene::load_path;
use strahl::scene::Scene;

/// Converts a scene file for POV-Ray.
pub(crate) fn to_pov(scene: &Path, output: &Path) -> Result<()> {
    write(output, pov::to_pov(&read(scene)?)?)
}

/// Converts a scene file for Tachyon.
pub(crate) fn to_dat(scene: &Path, output: &Path) -> Result<()> {
    write(output, dat::to_dat(&read(scene)?)?)
}

fn read(path: &Path) -> Result<Scene> {
    let loaded = load_path(path, None);
    let Some(scene) = loaded.scene else {
        for diagnostic in loaded.diagnostics {
            eprintln!("{diagnostic}");
        }
        bail!("cannot read {}", path.display());
    };
    Ok(scene)
}

fn write(path: &Path, text: String) -> Result<()> {
    std::fs::write(path, text).with_context(|| format!("cannot write {}", path.display()))
}
