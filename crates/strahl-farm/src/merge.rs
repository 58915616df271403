//! Puts tiles together and says what is wrong with them.

use crate::tile::{Settings, TileFile, TileInfo};
use std::collections::BTreeMap;
use std::fmt;
use std::path::{Path, PathBuf};
use strahl::tracing::{Film, MergeError};

/// A picture made of tiles.
#[derive(Clone, Debug, PartialEq)]
pub struct Merged {
    /// The picture.
    pub film: Film,
    /// The number of tiles.
    pub tiles: u32,
    /// The metadata that all tiles have.
    pub notes: Vec<(String, String)>,
    /// Rays traced for all tiles, by kind.
    pub rays: BTreeMap<String, u64>,
}

/// Everything that is wrong with the tiles of a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct TilesError(pub Vec<String>);

impl fmt::Display for TilesError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0.join("\n"))
    }
}

impl std::error::Error for TilesError {}

/// Puts the tiles in these files together.
///
/// # Errors
/// [`TilesError`] has a line for each file that can't be read, is of another scene, settings, program or division than most, or stands for the same tile as
/// another one, and one line that lists the missing tiles.
pub fn merge(files: &[PathBuf]) -> Result<Merged, TilesError> {
    let (mut tiles, mut problems) = (vec![], vec![]);
    for path in files {
        match TileFile::read(path) {
            Ok(tile) => tiles.push((path.as_path(), tile)),
            Err(error) => problems.push(error.to_string()),
        }
    }
    assemble(tiles, problems)
}

/// Puts tiles together that were read from these files; the problems so far are part of the error.
pub(crate) fn assemble(
    tiles: Vec<(&Path, TileFile)>,
    mut problems: Vec<String>,
) -> Result<Merged, TilesError> {
    let Some(model) = most_common(&tiles) else {
        if problems.is_empty() {
            problems.push("there are no tiles to merge: name their files".into());
        }
        return Err(TilesError(problems));
    };
    let (good, foreign): (Vec<_>, Vec<_>) = tiles
        .iter()
        .partition(|(_, tile)| difference(tile, &tiles[model].1).is_none());
    for (path, tile) in foreign {
        if let Some(how) = difference(tile, &tiles[model].1) {
            problems.push(format!("{}: {how}", path.display()));
        }
    }
    let mut of_number: BTreeMap<u32, &Path> = BTreeMap::new();
    for (path, tile) in &good {
        let (number, count) = (tile.info.number, tile.info.count);
        match of_number.get(&number) {
            Some(other) => problems.push(format!(
                "{} and {} are both tile {number} of {count}: name one of them",
                other.display(),
                path.display()
            )),
            None => {
                of_number.insert(number, path);
            }
        }
    }
    let count = tiles[model].1.info.count;
    let missing: Vec<u32> = (1..=count)
        .filter(|number| !of_number.contains_key(number))
        .collect();
    if !missing.is_empty() {
        let s = if missing.len() == 1 { " is" } else { "s are" };
        problems.push(format!("tile{s} missing: {} of {count}", ranges(&missing)));
    }
    if !problems.is_empty() {
        return Err(TilesError(problems));
    }
    let notes = tiles[model].1.info.notes.clone();
    let mut rays = BTreeMap::new();
    for (_, tile) in &tiles {
        for (kind, number) in &tile.info.rays {
            *rays.entry(kind.clone()).or_insert(0) += number;
        }
    }
    let (paths, films): (Vec<&Path>, Vec<Film>) = tiles
        .into_iter()
        .map(|(path, tile)| (path, tile.film))
        .unzip();
    let film = Film::merge(&films).map_err(|error| {
        let path = |part: usize| paths[part].display();
        let text = match &error {
            MergeError::OtherChannels { part } | MergeError::Malformed { part } => {
                format!("{}: {error}", path(*part))
            }
            MergeError::Overlap {
                first,
                second,
                region,
            } => format!(
                "{} and {} both have the pixels {region}: they come from different divisions of the picture",
                path(*first),
                path(*second)
            ),
            _ => error.to_string(),
        };
        TilesError(vec![text])
    })?;
    Ok(Merged {
        film,
        tiles: count,
        notes,
        rays,
    })
}

/// The index of a tile of the largest group of tiles that belong together.
fn most_common(tiles: &[(&Path, TileFile)]) -> Option<usize> {
    let mut groups: Vec<(usize, usize)> = vec![];
    for (index, (_, tile)) in tiles.iter().enumerate() {
        let group = groups
            .iter_mut()
            .find(|(first, _)| difference(tile, &tiles[*first].1).is_none());
        match group {
            Some((_, size)) => *size += 1,
            None => groups.push((index, 1)),
        }
    }
    // Of groups of the same size the first one.
    let largest = groups.iter().rev().max_by_key(|(_, size)| *size)?;
    Some(largest.0)
}

/// How a tile differs from the tiles of a picture, in words; `None` if it is one of them.
fn difference(tile: &TileFile, model: &TileFile) -> Option<String> {
    let size = |film: &Film| (film.width, film.height);
    let channels = |film: &Film| (film.alpha.is_some(), film.info.is_some());
    if let Some(text) = info_difference(&tile.info, &model.info) {
        return Some(text);
    }
    if size(&tile.film) != size(&model.film) {
        let ((w, h), (width, height)) = (size(&tile.film), size(&model.film));
        return Some(format!(
            "is of a picture of {w}x{h} pixels, the others of one of {width}x{height}"
        ));
    }
    if channels(&tile.film) != channels(&model.film) {
        return Some("has other channels than the others".into());
    }
    None
}

/// How the metadata of a tile differ from those of the tiles of a picture, in words; `None` if it is one of them.
fn info_difference(info: &TileInfo, model: &TileInfo) -> Option<String> {
    if info.version != model.version {
        return Some(format!(
            "was rendered by {}, the others by {}",
            info.version, model.version
        ));
    }
    if info.scene != model.scene {
        let short = |hash: &str| hash.chars().take(12).collect::<String>();
        return Some(format!(
            "is of another scene, or of another state of it ({}... instead of {}...)",
            short(&info.scene),
            short(&model.scene)
        ));
    }
    if info.settings != model.settings {
        return Some(format!(
            "was rendered with other settings: {}",
            settings_difference(&info.settings, &model.settings)
        ));
    }
    if info.count != model.count {
        return Some(format!(
            "is one of {} tiles, the others of {}",
            info.count, model.count
        ));
    }
    None
}

fn settings_difference(found: &Settings, expected: &Settings) -> String {
    let names: std::collections::BTreeSet<&String> = found.keys().chain(expected.keys()).collect();
    let shown = |settings: &Settings, name: &String| {
        let value = settings.get(name);
        value.map_or("none", String::as_str).to_owned()
    };
    let parts: Vec<String> = names
        .into_iter()
        .filter(|name| found.get(*name) != expected.get(*name))
        .map(|name| {
            let (found, expected) = (shown(found, name), shown(expected, name));
            format!("{name} {found} instead of {expected}")
        })
        .collect();
    parts.join(", ")
}

/// Numbers in rising order as text: `1, 4-7`.
pub fn ranges(numbers: &[u32]) -> String {
    let mut parts: Vec<(u32, u32)> = vec![];
    for &n in numbers {
        match parts.last_mut() {
            Some((_, end)) if *end + 1 == n => *end = n,
            _ => parts.push((n, n)),
        }
    }
    let parts: Vec<String> = parts
        .into_iter()
        .map(|(a, b)| match a == b {
            true => a.to_string(),
            false => format!("{a}-{b}"),
        })
        .collect();
    parts.join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use strahl::tracing::Region;

    fn tile(number: u32, count: u32) -> TileFile {
        let region = Region {
            x: 10 * (number - 1),
            y: 0,
            width: 10,
            height: 4,
        };
        let film = Film::try_new(10 * count, 4, Some(region), false).unwrap();
        TileFile {
            film,
            info: TileInfo {
                number,
                count,
                scene: "abcdef".repeat(4),
                settings: Settings::from([("sampling".into(), "center".into())]),
                version: "strahl 0.1.0".into(),
                notes: vec![("scene".into(), "a.pov".into())],
                rays: BTreeMap::from([("primary".into(), 40)]),
            },
        }
    }

    fn merged(change: impl Fn(&mut Vec<TileFile>)) -> Result<Merged, TilesError> {
        let folder = tempfile::tempdir().unwrap();
        let mut tiles: Vec<TileFile> = (1..=4).map(|n| tile(n, 4)).collect();
        change(&mut tiles);
        let paths: Vec<PathBuf> = (0..tiles.len())
            .map(|i| folder.path().join(format!("t{i}.exr")))
            .collect();
        for (tile, path) in tiles.iter().zip(&paths) {
            tile.write(path).unwrap();
        }
        merge(&paths)
    }

    fn problem(change: impl Fn(&mut Vec<TileFile>)) -> String {
        merged(change).unwrap_err().to_string()
    }

    #[test]
    fn tiles_make_the_picture() {
        let picture = merged(|tiles| tiles.reverse()).unwrap();
        assert_eq!((picture.film.width, picture.film.region.width), (40, 40));
        assert_eq!((picture.tiles, picture.rays["primary"]), (4, 160));
    }

    #[test]
    fn every_problem_is_named_with_its_file() {
        let other = |change: fn(&mut TileFile)| problem(|tiles| change(&mut tiles[2]));
        let scene = other(|t| t.info.scene = "0".repeat(24));
        assert!(scene.contains("t2.exr: is of another scene") && scene.contains("missing: 3 of 4"));
        let settings = other(|t| {
            t.info.settings.insert("sampling".into(), "2x2".into());
        });
        assert!(
            settings.contains("sampling 2x2 instead of center"),
            "{settings}"
        );
        let version = other(|t| t.info.version = "strahl 0.0.9".into());
        assert!(version.contains("strahl 0.0.9"), "{version}");
        // Two builds of one version.
        let build = other(|t| t.info.version += "+6f1c");
        assert!(
            build.contains("rendered by strahl 0.1.0+6f1c, the others by strahl 0.1.0"),
            "{build}"
        );
        let count = other(|t| t.info.count = 5);
        assert!(count.contains("one of 5 tiles"), "{count}");
        let missing = problem(|tiles| drop(tiles.drain(1..3)));
        assert_eq!(missing, "tiles are missing: 2-3 of 4");
        let twice = problem(|tiles| tiles.push(tiles[0].clone()));
        assert!(twice.contains("t0.exr and ") && twice.contains("both tile 1 of 4"));
        let overlap = problem(|tiles| tiles[1].film.region.x = 5);
        assert!(
            overlap.contains("both have the pixels 5,0,5x4"),
            "{overlap}"
        );
        assert!(problem(Vec::clear).contains("no tiles"));
    }

    #[test]
    fn a_changed_value_is_noticed() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("t.exr");
        let mut one = tile(1, 1);
        one.write(&path).unwrap();
        assert_eq!(TileFile::read(&path).unwrap(), one);
        // The checksum of another film in the same metadata.
        let film = one.film.clone();
        one.film.pixels[3] = [1.0, 2.0, 3.0];
        let mut metadata = strahl::metadata();
        metadata.push(("tile".into(), serde_json::to_string(&one.info).unwrap()));
        let sums = strahl::formats::image::read_exr(&path)
            .unwrap()
            .header
            .metadata;
        metadata.push(("tile sha256".into(), sums["tile sha256"].clone()));
        let picture = strahl::picture(&one.film, &[], metadata);
        let options = strahl::formats::image::WriteOptions::default();
        strahl::formats::image::write_picture(&path, &picture, &options).unwrap();
        let error = TileFile::read(&path).unwrap_err().to_string();
        assert!(error.contains("damaged"), "{error}");
        strahl::save(&path, &film, &options).unwrap();
        let error = TileFile::read(&path).unwrap_err().to_string();
        assert!(error.contains("not a tile"), "{error}");
    }
}
