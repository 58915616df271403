//! The manifest of a job: a picture in tiles, or a film in frames.

use crate::hex;
use crate::merge::{Merged, TilesError, assemble, ranges};
use crate::tile::{TileFile, TileHead, TilePlace};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::path::{Path, PathBuf};
use strahl::formats::image::write_bytes;
use strahl::tracing::Region;

/// The layout of manifests; others are refused.
const LAYOUT: u32 = 1;

/// A frame of a job.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct JobFrame {
    /// Its number; `None` for a still.
    pub number: Option<u32>,
    /// The identity of its scene (`strahl::Inputs::identity`).
    pub scene: String,
}

/// A film file that is made of the pictures.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Movie {
    /// The file.
    pub file: PathBuf,
    /// Frames per second.
    pub rate: f64,
}

/// What a job renders, and in which parts.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Job {
    /// The layout of this manifest.
    pub layout: u32,
    /// The program that wrote it, with its version and build: its tasks must be run by the same one.
    pub version: String,
    /// The arguments of `strahl render`, without scene and picture.
    pub words: Vec<String>,
    /// The options of `strahl merge` for the pictures.
    pub picture_words: Vec<String>,
    /// The scene: in the job folder if it is bundled, or else from the root.
    pub scene: PathBuf,
    /// Whether the scene and everything it reads are in the job folder.
    pub bundled: bool,
    /// The folder where the job was submitted, from which scenes that are not bundled are read.
    pub folder: PathBuf,
    /// The picture, or the picture that the names of frames are made of.
    pub output: PathBuf,
    /// The frames; one for a still.
    pub frames: Vec<JobFrame>,
    /// Digits of the numbers of frames.
    pub digits: usize,
    /// Width and height of the picture.
    pub size: (u32, u32),
    /// The tiles of every frame, as `X,Y,WxH`.
    pub tiles: Vec<String>,
    /// Parts that are rendered by one task.
    pub chunk: u32,
    /// The value of `now` in the scene, in days since the beginning of 2000, if it reads the time.
    pub now: Option<f64>,
    /// The film file.
    pub movie: Option<Movie>,
}

/// A job can't be read or written.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
pub struct JobError(pub String);

/// How much of a tile's file is read to find out whether it is the right one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Care {
    /// The header and the end: enough to see how far a job is.
    Header,
    /// All values, whose checksum must be the one that was written.
    Whole,
}

/// A part of a job: a tile of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Unit {
    /// Index of the frame.
    pub frame: usize,
    /// Index of the tile.
    pub tile: usize,
}

impl Job {
    /// A job without frames and tiles, in the present layout.
    pub fn new(version: &str) -> Self {
        Self {
            layout: LAYOUT,
            version: version.to_owned(),
            words: vec![],
            picture_words: vec![],
            scene: PathBuf::new(),
            bundled: false,
            folder: PathBuf::new(),
            output: PathBuf::new(),
            frames: vec![],
            digits: 1,
            size: (0, 0),
            tiles: vec![],
            chunk: 1,
            now: None,
            movie: None,
        }
    }

    /// The manifest in a job folder.
    pub fn file(folder: &Path) -> PathBuf {
        folder.join("job.json")
    }

    /// Writes the manifest into a job folder.
    ///
    /// # Errors
    /// It can't be written.
    pub fn write(&self, folder: &Path) -> Result<(), JobError> {
        let mut json = serde_json::to_vec_pretty(self).map_err(|e| JobError(e.to_string()))?;
        json.push(b'\n');
        write_bytes(Self::file(folder), &json).map_err(|e| JobError(e.to_string()))
    }

    /// Reads the manifest of a job folder.
    ///
    /// # Errors
    /// No job folder, or one of another version.
    pub fn read(folder: &Path) -> Result<Self, JobError> {
        let file = Self::file(folder);
        let shown = file.display();
        let bytes = std::fs::read(&file).map_err(|error| {
            let why = match error.kind() {
                std::io::ErrorKind::NotFound => "there is no such file".to_owned(),
                _ => error.to_string(),
            };
            JobError(format!(
                "{} is not a job folder: {shown} cannot be read ({why}); `strahl submit slurm` and `strahl submit openjd` make job folders",
                folder.display()
            ))
        })?;
        let job: Self = serde_json::from_slice(&bytes).map_err(|error| {
            JobError(format!("{shown} is damaged: {error}; submit the job again"))
        })?;
        let sound = !job.frames.is_empty() && !job.tiles.is_empty() && job.chunk > 0;
        if job.layout != LAYOUT || !sound || (0..job.tiles.len()).any(|t| job.place(t).is_none()) {
            return Err(JobError(format!(
                "{shown} was written by {}, and this program can't read it: submit the job again",
                job.version
            )));
        }
        Ok(job)
    }

    /// Fails unless the job was submitted by this program, whose tiles are merged with those of no other one.
    ///
    /// # Errors
    /// It was submitted by another version, or another build of the version.
    pub fn check_program(&self, version: &str) -> Result<(), JobError> {
        match self.version == version {
            true => Ok(()),
            false => Err(JobError(format!(
                "the job was submitted by {}, but this is {version}: run it with the program that submitted it (`strahl --version`), or submit it again",
                self.version
            ))),
        }
    }

    /// A hash of everything that decides the pixels of the job's tiles. It is in their settings, so the tiles of an earlier job in the same
    /// folder are recognised.
    pub fn id(&self) -> String {
        let mut hasher = Sha256::new();
        let mut add = |text: &str| {
            hasher.update((text.len() as u64).to_le_bytes());
            hasher.update(text);
        };
        add(&self.version);
        for text in self.words.iter().chain(&self.tiles) {
            add(text);
        }
        for frame in &self.frames {
            add(&format!("{:?} {}", frame.number, frame.scene));
        }
        add(&format!("{:?}", self.now));
        hex(&hasher.finalize()[..8])
    }

    /// Number of parts.
    pub fn units(&self) -> usize {
        self.frames.len() * self.tiles.len()
    }

    /// All parts, frame by frame.
    pub fn all(&self) -> impl Iterator<Item = Unit> {
        (0..self.units()).map(|index| self.unit(index))
    }

    fn unit(&self, index: usize) -> Unit {
        Unit {
            frame: index / self.tiles.len(),
            tile: index % self.tiles.len(),
        }
    }

    /// Number of tasks.
    pub fn tasks(&self) -> usize {
        self.units().div_ceil(self.chunk as usize)
    }

    /// The parts of a task, whose number counts from 1; empty if there is no such task.
    pub fn of_task(&self, number: usize) -> Vec<Unit> {
        let chunk = self.chunk as usize;
        let begin = number.saturating_sub(1).saturating_mul(chunk);
        let end = begin.saturating_add(chunk).min(self.units());
        match number {
            0 => vec![],
            _ => (begin..end).map(|index| self.unit(index)).collect(),
        }
    }

    /// The number of the task of a part, from 1.
    pub fn task_of(&self, unit: Unit) -> usize {
        (unit.frame * self.tiles.len() + unit.tile) / self.chunk as usize + 1
    }

    /// A tile's place in the picture, by its index.
    pub fn place(&self, tile: usize) -> Option<TilePlace> {
        let region = self.tiles.get(tile)?;
        format!("{}/{}@{region}", tile + 1, self.tiles.len())
            .parse()
            .ok()
    }

    /// The name of a part: `f0007-t03`, `f0007` or `t03`.
    pub fn name(&self, unit: Unit) -> String {
        let frame = self.frames.get(unit.frame).and_then(|frame| frame.number);
        let frame = frame.map(|number| format!("f{number:0width$}", width = self.digits));
        let width = self.tiles.len().to_string().len();
        let tile = format!("t{:0width$}", unit.tile + 1);
        match (frame, self.tiles.len()) {
            (Some(frame), 1) => frame,
            (Some(frame), _) => format!("{frame}-{tile}"),
            (None, _) => tile,
        }
    }

    /// The file of a part's tile in a job folder.
    pub fn tile_file(&self, folder: &Path, unit: Unit) -> PathBuf {
        folder
            .join("tiles")
            .join(format!("{}.exr", self.name(unit)))
    }

    /// The picture of a frame: its number stands before the extension.
    pub fn picture(&self, frame: usize) -> PathBuf {
        let number = self.frames.get(frame).and_then(|frame| frame.number);
        let Some(number) = number else {
            return self.output.clone();
        };
        let stem = self
            .output
            .file_stem()
            .unwrap_or_default()
            .to_string_lossy();
        let ending = self
            .output
            .extension()
            .unwrap_or_default()
            .to_string_lossy();
        let dot = if ending.is_empty() { "" } else { "." };
        let name = format!("{stem}{number:0width$}{dot}{ending}", width = self.digits);
        self.output.with_file_name(name)
    }

    /// Whether a part's tile is there, complete, and of this job. Otherwise the reason why not; `None` if there is no file.
    ///
    /// # Errors
    /// See above.
    pub fn check_tile(&self, folder: &Path, unit: Unit, care: Care) -> Result<(), Option<String>> {
        let file = self.tile_file(folder, unit);
        if !file.is_file() {
            return Err(None);
        }
        let head = match care {
            Care::Header => TileFile::head(&file),
            Care::Whole => TileFile::read(&file).map(|tile| tile.to_head()),
        };
        let head = head.map_err(|error| Some(error.to_string()))?;
        match self.foreign(&head, unit) {
            None => Ok(()),
            Some(how) => Err(Some(format!("{}: {how}", file.display()))),
        }
    }

    /// The picture of a frame, from the tiles in a job folder.
    ///
    /// # Errors
    /// [`TilesError`]: tiles are missing, damaged or of another job.
    pub fn merge(&self, folder: &Path, frame: usize) -> Result<Merged, TilesError> {
        let (mut files, mut missing, mut problems) = (vec![], vec![], vec![]);
        for (tile, number) in (0..self.tiles.len()).zip(1..) {
            let unit = Unit { frame, tile };
            let file = self.tile_file(folder, unit);
            if !file.is_file() {
                missing.push(number);
                continue;
            }
            match TileFile::read(&file) {
                Err(error) => problems.push(error.to_string()),
                Ok(tile) => match self.foreign(&tile.to_head(), unit) {
                    Some(how) => problems.push(format!("{}: {how}", file.display())),
                    None => files.push((file, tile)),
                },
            }
        }
        if !missing.is_empty() {
            let number = self.frames.get(frame).and_then(|frame| frame.number);
            let of = number.map_or(String::new(), |number| format!("frame {number}: "));
            let all = self.tiles.len();
            problems.push(match missing.len() {
                _ if all == 1 && number.is_some() => format!("{of}it is missing"),
                1 => format!("{of}tile {} of {all} is missing", missing[0]),
                _ => format!("{of}tiles {} of {all} are missing", ranges(&missing)),
            });
        }
        if !problems.is_empty() {
            return Err(TilesError(problems));
        }
        let (paths, tiles): (Vec<PathBuf>, Vec<TileFile>) = files.into_iter().unzip();
        let tiles = paths.iter().map(PathBuf::as_path).zip(tiles);
        assemble(tiles.collect(), vec![])
    }

    /// How a tile differs from the one of a part; `None` if it is the one.
    fn foreign(&self, tile: &TileHead, unit: Unit) -> Option<String> {
        let info = &tile.info;
        let place = self.place(unit.tile)?;
        let frame = self.frames.get(unit.frame)?;
        let region: Option<Region> = place.region;
        if info.version != self.version {
            return Some(format!(
                "was rendered by {}, not by {}",
                info.version, self.version
            ));
        }
        if info.settings.get("job") != Some(&self.id()) {
            return Some("is a tile of another job, or of an earlier state of this one".into());
        }
        let number = frame.number.map(|number| number.to_string());
        if info.scene != frame.scene
            || (number.is_some() && info.settings.get("frame") != number.as_ref())
        {
            return Some("is of another scene or frame".into());
        }
        let is_place = (info.number, info.count) == (place.number, place.count);
        (!is_place || Some(tile.region) != region).then(|| "is another tile".to_owned())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn film() -> Job {
        let frame = |number| JobFrame {
            number: Some(number),
            scene: format!("{number:064}"),
        };
        Job {
            frames: (8..13).map(frame).collect(),
            digits: 2,
            tiles: vec!["0,0,32x64".into(), "32,0,32x64".into()],
            chunk: 3,
            output: "out/film.png".into(),
            ..Job::new("strahl 0.1.0")
        }
    }

    #[test]
    fn tasks_have_all_parts_once() {
        let job = film();
        assert_eq!((job.units(), job.tasks()), (10, 4));
        let all: Vec<Unit> = (1..=4).flat_map(|task| job.of_task(task)).collect();
        assert_eq!(all, job.all().collect::<Vec<_>>());
        for task in 1..=4 {
            assert!(
                job.of_task(task)
                    .iter()
                    .all(|unit| job.task_of(*unit) == task)
            );
        }
        assert!(job.of_task(0).is_empty() && job.of_task(5).is_empty());
    }

    #[test]
    fn names_tell_frame_and_tile() {
        let job = film();
        let last = Unit { frame: 4, tile: 1 };
        assert_eq!(
            (job.name(last), job.picture(0)),
            ("f12-t2".into(), "out/film08.png".into())
        );
        assert_eq!(job.place(1).unwrap().to_string(), "2/2@32,0,32x64");
    }

    #[test]
    fn manifests_go_there_and_back() {
        let folder = tempfile::tempdir().unwrap();
        let job = film();
        job.write(folder.path()).unwrap();
        assert_eq!(Job::read(folder.path()).unwrap(), job);
        let mut other = job.clone();
        other.words.push("--seed=1".into());
        assert_ne!(job.id(), other.id());
        other.layout = 2;
        other.write(folder.path()).unwrap();
        let error = Job::read(folder.path()).unwrap_err().to_string();
        assert!(error.contains("submit the job again"), "{error}");
        std::fs::write(folder.path().join("job.json"), "{").unwrap();
        assert!(Job::read(folder.path()).is_err());
        job.check_program("strahl 0.1.0").unwrap();
        let error = job.check_program("strahl 0.1.0+7f").unwrap_err();
        assert!(error.to_string().contains("this is strahl 0.1.0+7f"));
        let error = Job::read(&folder.path().join("none"))
            .unwrap_err()
            .to_string();
        assert!(error.contains("not a job folder"), "{error}");
    }
}
