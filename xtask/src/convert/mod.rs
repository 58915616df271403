//! Scenes of other formats as the programs compared with take them.

mod dat;
mod pov;

use anyhow::{Context, Result, bail};
use std::path::Path;
use strahl::formats::scene::load_path;
use strahl::scene::Scene;

/// Writes a scene file as POV-Ray takes it.
pub(crate) fn to_pov(scene: &Path, output: &Path) -> Result<()> {
    write(output, pov::to_pov(&read(scene)?)?)
}

/// Writes a scene file as Tachyon takes it.
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
