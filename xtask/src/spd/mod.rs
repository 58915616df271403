//! Scenes in the spirit of the Standard Procedural Databases, for those that are not at hand.
//!
//! They follow the published descriptions: E. Haines, "A Proposal for Standard Graphics Environments", IEEE Computer Graphics and
//! Applications 7(11), 1987, and the notes that come with SPD 3.x. The kinds and numbers of objects and lights of `rings` and `tree` are
//! published; views, places, radii and colours are ours. So the counts of rays are not those of SPD.

mod lattice;
mod rings;
mod tree;

use crate::arguments::Arguments;
use anyhow::{Context, Result, bail};
use flate2::Compression;
use flate2::write::GzEncoder;
use std::io::Write;
use std::path::{Path, PathBuf};
use strahl::formats::image::write_file;

/// A scene of any size.
pub(crate) struct Kind {
    pub(crate) name: &'static str,
    /// What the size counts.
    counts: &'static str,
    least: u32,
    /// Four million objects.
    most: u32,
    /// The size near SPD's, which has some 8,000 objects.
    usual: u32,
    scene: fn(u32) -> String,
}

/// All scenes.
pub(crate) const KINDS: [Kind; 3] = [
    Kind {
        name: "rings",
        counts: "objects of six rings along an edge of the pyramid",
        least: 1,
        most: 58,
        usual: 7,
        scene: rings::scene,
    },
    Kind {
        name: "tree",
        counts: "times that every branch divides",
        least: 0,
        most: 20,
        usual: 11,
        scene: tree::scene,
    },
    Kind {
        name: "lattice",
        counts: "cells along an edge of the cube",
        least: 1,
        most: 99,
        usual: 12,
        scene: lattice::scene,
    },
];

/// Writes a scene, as the arguments `NAME SIZE -o FILE` say.
pub(crate) fn run(args: &[&str]) -> Result<()> {
    let (mut operands, mut output) = (vec![], None);
    let mut args = Arguments::new(args);
    while let Some(option) = args.option() {
        match option {
            "-o" => output = Some(Path::new(args.value()?)),
            other if other.starts_with('-') => bail!("unknown option {other}; there is -o FILE"),
            operand => operands.push(operand),
        }
    }
    let [name, size] = operands[..] else {
        bail!(
            "expected a scene and its size: cargo xtask spd {} SIZE -o FILE.nff[.gz]",
            names()
        );
    };
    let output = output.context("-o FILE.nff or -o FILE.nff.gz is missing")?;
    let kind = KINDS.iter().find(|kind| kind.name == name);
    let kind = kind.with_context(|| format!("unknown scene `{name}`; there are {}", names()))?;
    let Ok(size) = size.parse() else {
        bail!("the size of {name} is a whole number, found `{size}`");
    };
    kind.write(size, output)
}

/// The names, as the usage shows them.
fn names() -> String {
    KINDS.map(|kind| kind.name).join("|")
}

impl Kind {
    /// The scene's text.
    fn text(&self, size: u32) -> Result<String> {
        let Self {
            name, least, most, ..
        } = self;
        if !(*least..=*most).contains(&size) {
            bail!(
                "the size of {name}, the number of {}, must be from {least} to {most}, found {size}",
                self.counts
            );
        }
        Ok((self.scene)(size))
    }

    /// Writes the scene; the file takes its place only when it is complete.
    fn write(&self, size: u32, output: &Path) -> Result<()> {
        let shown = output.to_string_lossy();
        let compressed = shown.ends_with(".nff.gz");
        if !compressed && !shown.ends_with(".nff") {
            bail!("expected a file name that ends with .nff or .nff.gz, found `{shown}`");
        }
        let text = self.text(size)?;
        write_file(output, |out| {
            if !compressed {
                return out.write_all(text.as_bytes());
            }
            let mut encoder = GzEncoder::new(out, Compression::default());
            encoder.write_all(text.as_bytes())?;
            encoder.finish().map(drop)
        })?;
        Ok(())
    }

    /// Writes the scene of the usual size into a folder; returns its path.
    pub(crate) fn write_usual(&self, folder: &Path) -> Result<PathBuf> {
        let path = folder.join(format!("{}.nff.gz", self.name));
        self.write(self.usual, &path)?;
        Ok(path)
    }
}

#[cfg(test)]
mod tests;
