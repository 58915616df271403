//! The file of a tile: an OpenEXR picture of a part, whose metadata tell what it is a part of.

use crate::hex;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::fmt;
use std::path::{Path, PathBuf};
use std::str::FromStr;
use strahl::formats::image::{
    ExrFile, ExrHeader, ImageError, LayerData, Picture, WriteOptions, read_exr, read_exr_header,
    write_picture,
};
use strahl::tracing::{Film, PixelInfo, Region};

/// Everything that decides the values of the pixels of a picture besides the scene, by name.
pub type Settings = BTreeMap<String, String>;

/// A tile's number, from 1, the number of tiles, and its pixels if they are known: `3/8` or `3/8@64,0,96x128`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TilePlace {
    /// The tile's number, from 1.
    pub number: u32,
    /// The number of tiles of the picture.
    pub count: u32,
    /// The tile's pixels; `None` if they are yet to be found by a look at the scene.
    pub region: Option<Region>,
}

/// The text names no tile.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("expected K/N, the number of the tile from 1 and the number of tiles, such as 3/8")]
pub struct UnknownTile;

impl FromStr for TilePlace {
    type Err = UnknownTile;

    fn from_str(s: &str) -> Result<Self, Self::Err> {
        let (place, region) = match s.split_once('@') {
            Some((place, region)) => (place, Some(parse_region(region).ok_or(UnknownTile)?)),
            None => (s, None),
        };
        let (number, count) = place.split_once('/').ok_or(UnknownTile)?;
        let parse = |s: &str| s.trim().parse::<u32>().map_err(|_| UnknownTile);
        let (number, count) = (parse(number)?, parse(count)?);
        match (1..=count).contains(&number) {
            true => Ok(Self {
                number,
                count,
                region,
            }),
            false => Err(UnknownTile),
        }
    }
}

fn parse_region(s: &str) -> Option<Region> {
    let (place, size) = s.rsplit_once(',')?;
    let ((x, y), (width, height)) = (place.split_once(',')?, size.split_once('x')?);
    Some(Region {
        x: x.parse().ok()?,
        y: y.parse().ok()?,
        width: width.parse().ok()?,
        height: height.parse().ok()?,
    })
}

impl fmt::Display for TilePlace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.number, self.count)?;
        match self.region {
            Some(region) => write!(f, "@{region}"),
            None => Ok(()),
        }
    }
}

/// What a tile is a tile of, and how it was made.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct TileInfo {
    /// The tile's number, from 1.
    pub number: u32,
    /// The number of tiles of the picture.
    pub count: u32,
    /// SHA-256 of everything the scene consists of.
    pub scene: String,
    /// Everything else that decides the values of the pixels.
    pub settings: Settings,
    /// The program that rendered it: its version and build.
    pub version: String,
    /// Metadata for the picture that is made of the tiles.
    pub notes: Vec<(String, String)>,
    /// Rays traced, by kind; those of the margin for antialiasing are counted in both tiles.
    pub rays: BTreeMap<String, u64>,
}

/// A tile and what it is a tile of.
#[derive(Clone, Debug, PartialEq)]
pub struct TileFile {
    /// The pixels.
    pub film: Film,
    /// What they are.
    pub info: TileInfo,
}

/// What the header of a tile's file says.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TileHead {
    /// The tile's pixels.
    pub region: Region,
    /// What they are.
    pub info: TileInfo,
}

/// Why a file is no tile.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum TileError {
    /// The file can't be read or written.
    #[error(transparent)]
    Image(#[from] ImageError),
    /// There is no such file.
    #[error("there is no file `{}`", path.display())]
    Missing {
        /// The file.
        path: PathBuf,
    },
    /// An OpenEXR picture of something else.
    #[error("`{}` is a picture, but not a tile: `strahl render --tile K/N` writes tiles", path.display())]
    NoTile {
        /// The file.
        path: PathBuf,
    },
    /// The values are not those that were written.
    #[error("`{}` is damaged: {reason}; render this tile again", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        reason: String,
    },
}

/// Metadata keys of tiles.
const TILE: &str = "tile";
const CHECKSUM: &str = "tile sha256";

impl TileFile {
    /// Writes the tile under a temporary name, which is replaced by the file's when it is complete.
    ///
    /// # Errors
    /// [`TileError::Image`]: it can't be written; nothing is left behind.
    pub fn write(&self, path: &Path) -> Result<(), TileError> {
        let layers = strahl::layers(&self.film);
        let mut metadata = strahl::metadata();
        metadata.extend(self.info.notes.iter().cloned());
        let info = serde_json::to_string(&self.info).map_err(|error| TileError::Damaged {
            path: path.to_owned(),
            reason: error.to_string(),
        })?;
        metadata.push((TILE.into(), info));
        metadata.push((CHECKSUM.into(), checksum(&self.film)));
        let picture: Picture<'_> = strahl::picture(&self.film, &layers, metadata);
        Ok(write_picture(path, &picture, &WriteOptions::default())?)
    }

    /// Reads a tile, and checks that its values are those that were written.
    ///
    /// # Errors
    /// [`TileError`]: no such file, a damaged or cut off file, or another kind of picture.
    pub fn read(path: &Path) -> Result<Self, TileError> {
        present(path)?;
        let mut file = read_exr(path)?;
        let metadata = std::mem::take(&mut file.header.metadata);
        let (info, expected) = info(path, &metadata)?;
        let film =
            film(file).ok_or_else(|| damaged(path, "its channels are not those of a tile"))?;
        if checksum(&film) != expected {
            return Err(damaged(path, "its values are not those that were written"));
        }
        Ok(Self { film, info })
    }

    /// What the tile is.
    pub fn to_head(&self) -> TileHead {
        TileHead {
            region: self.film.region,
            info: self.info.clone(),
        }
    }

    /// Reads what a tile is, without its values. A file that was cut off is noticed, one whose values were changed is not.
    ///
    /// # Errors
    /// [`TileError`]: no such file, a cut off file, or another kind of picture.
    pub fn head(path: &Path) -> Result<TileHead, TileError> {
        present(path)?;
        let header = read_exr_header(path)?;
        let (info, _) = info(path, &header.metadata)?;
        Ok(TileHead {
            region: region(&header),
            info,
        })
    }
}

fn present(path: &Path) -> Result<(), TileError> {
    match path.exists() {
        true => Ok(()),
        false => Err(TileError::Missing {
            path: path.to_owned(),
        }),
    }
}

fn damaged(path: &Path, reason: &str) -> TileError {
    TileError::Damaged {
        path: path.to_owned(),
        reason: reason.to_owned(),
    }
}

/// What a tile is, and the checksum of its values.
fn info<'m>(
    path: &Path,
    metadata: &'m BTreeMap<String, String>,
) -> Result<(TileInfo, &'m str), TileError> {
    let (Some(info), Some(checksum)) = (metadata.get(TILE), metadata.get(CHECKSUM)) else {
        return Err(TileError::NoTile {
            path: path.to_owned(),
        });
    };
    let info = serde_json::from_str(info).map_err(|error| damaged(path, &error.to_string()))?;
    Ok((info, checksum))
}

fn region(header: &ExrHeader) -> Region {
    let window = header.window;
    Region {
        x: window.x,
        y: window.y,
        width: window.width,
        height: window.height,
    }
}

/// SHA-256 of all values of a film, in hexadecimal digits: colours, alpha and further data.
fn checksum(film: &Film) -> String {
    let mut hasher = Sha256::new();
    let r = film.region;
    for number in [film.width, film.height, r.x, r.y, r.width, r.height] {
        hasher.update(number.to_le_bytes());
    }
    let mut bytes = vec![];
    let mut part = |values: &mut dyn Iterator<Item = [u8; 4]>| {
        bytes.clear();
        bytes.extend(values.flatten());
        hasher.update(&bytes);
    };
    part(&mut film.pixels.iter().flatten().map(|v| v.to_le_bytes()));
    if let Some(alpha) = &film.alpha {
        part(&mut alpha.iter().map(|v| v.to_le_bytes()));
    }
    for info in film.info.iter().flatten() {
        let [a, b, c] = info.normal;
        let [x, y, z] = info.position;
        let floats = [info.depth, a, b, c, x, y, z].map(f32::to_le_bytes);
        let numbers = [info.object, info.material, info.tree_depth, info.tests];
        part(&mut floats.into_iter().chain(numbers.map(u32::to_le_bytes)));
    }
    hex(&hasher.finalize())
}

/// The film that was written to a file.
fn film(mut file: ExrFile) -> Option<Film> {
    let region = region(&file.header);
    let pixels = region.width as usize * region.height as usize;
    let mut floats = |name: &str| match file.channels.remove(name) {
        Some(LayerData::F32(values)) if values.len() == pixels => Some(values),
        _ => None,
    };
    let [r, g, b] = [floats("R")?, floats("G")?, floats("B")?];
    let rgb = r.iter().zip(&g).zip(&b);
    let rgb = rgb.map(|((r, g), b)| [*r, *g, *b]).collect();
    let alpha = floats("A");
    let info = match floats("depth.Z") {
        None => None,
        Some(depth) => {
            let normal = ["X", "Y", "Z"].map(|axis| floats(&format!("normal.{axis}")));
            let position = ["X", "Y", "Z"].map(|axis| floats(&format!("position.{axis}")));
            let ([Some(a), Some(b), Some(c)], [Some(x), Some(y), Some(z)]) = (normal, position)
            else {
                return None;
            };
            let mut numbers = |name: &str| match file.channels.remove(name) {
                Some(LayerData::U32(values)) if values.len() == pixels => Some(values),
                _ => None,
            };
            let (object, material) = (numbers("object.id")?, numbers("material.id")?);
            let (depths, tests) = (numbers("tree.depth")?, numbers("tests.count")?);
            let info = (0..pixels).map(|i| PixelInfo {
                depth: depth[i],
                normal: [a[i], b[i], c[i]],
                position: [x[i], y[i], z[i]],
                object: object[i],
                material: material[i],
                tree_depth: depths[i],
                tests: tests[i],
            });
            Some(info.collect())
        }
    };
    Some(Film {
        width: file.header.width,
        height: file.header.height,
        region,
        pixels: rgb,
        alpha,
        info,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_go_there_and_back() {
        for text in ["1/1", "3/8", "3/8@64,0,96x128"] {
            assert_eq!(text.parse::<TilePlace>().unwrap().to_string(), text);
        }
        for text in [
            "",
            "3",
            "0/8",
            "9/8",
            "-1/8",
            "3/8@",
            "3/8@1,2,3",
            "3/0",
            "a/b",
        ] {
            assert!(text.parse::<TilePlace>().is_err(), "{text}");
        }
    }
}
