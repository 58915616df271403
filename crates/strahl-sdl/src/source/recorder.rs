use super::{Host, HostError, Source, Stream};
use sha2::{Digest, Sha256};
use std::fmt;
use std::io::{self, Read as _, Write};
use std::path::PathBuf;

/// How a file was asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Lookup {
    /// By [`Host::load`].
    File,
    /// By [`Host::load_font`].
    Font,
    /// By [`Host::load_installed`].
    Installed,
}

/// A file that a scene has read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Read {
    /// How it was asked for.
    pub lookup: Lookup,
    /// The name in the scene.
    pub name: String,
    /// The name of the file with the name in it; empty for fonts and installed files.
    pub from: String,
    /// The name that the host gave the file: for [`super::FolderHost`] its path.
    pub found: String,
    /// SHA-256 of its bytes.
    pub sha256: [u8; 32],
}

/// What a scene did with the world outside of it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Record {
    /// The files it has read, in order of the first time, each name once.
    pub reads: Vec<Read>,
    /// The names of the files it has written.
    pub writes: Vec<String>,
    /// Whether it has read the time.
    pub time: bool,
}

/// A host that writes down what a scene reads, for scenes that are sent elsewhere.
pub struct Recorder<'h> {
    host: &'h mut dyn Host,
    record: Record,
}

impl fmt::Debug for Recorder<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Recorder")
            .field("record", &self.record)
            .finish_non_exhaustive()
    }
}

impl<'h> Recorder<'h> {
    /// Passes everything on to this host.
    pub fn new(host: &'h mut dyn Host) -> Self {
        Self {
            host,
            record: Record::default(),
        }
    }

    /// What has been written down.
    pub fn into_record(self) -> Record {
        self.record
    }

    fn keep(
        &mut self,
        lookup: Lookup,
        name: &str,
        from: &str,
        source: Source,
    ) -> Result<Source, HostError> {
        let sha256 = digest(&source).map_err(|error| HostError::Io {
            name: source.name.clone(),
            message: error.to_string(),
        })?;
        let read = Read {
            lookup,
            name: name.to_owned(),
            from: from.to_owned(),
            found: source.name.clone(),
            sha256,
        };
        // What the scene has written itself need not be sent with it.
        let own = self.record.writes.iter().any(|written| written == name);
        if !own && !self.record.reads.contains(&read) {
            self.record.reads.push(read);
        }
        Ok(source)
    }
}

/// SHA-256 of all bytes of a source.
pub(super) fn digest(source: &Source) -> io::Result<[u8; 32]> {
    let mut hasher = Sha256::new();
    match source.in_memory() {
        Some(bytes) => hasher.update(bytes),
        None => {
            let mut file = std::fs::File::open(PathBuf::from(&source.name))?;
            let mut part = vec![0; 1 << 20];
            loop {
                match file.read(&mut part)? {
                    0 => break,
                    count => hasher.update(&part[..count]),
                }
            }
        }
    }
    Ok(hasher.finalize().into())
}

impl Host for Recorder<'_> {
    fn load(&mut self, name: &str, from: &str) -> Result<Source, HostError> {
        let source = self.host.load(name, from)?;
        self.keep(Lookup::File, name, from, source)
    }

    fn load_font(&mut self, file: &str) -> Result<Option<Source>, HostError> {
        match self.host.load_font(file)? {
            Some(source) => self.keep(Lookup::Font, file, "", source).map(Some),
            None => Ok(None),
        }
    }

    fn load_installed(&mut self, name: &str) -> Result<Source, HostError> {
        let source = self.host.load_installed(name)?;
        self.keep(Lookup::Installed, name, "", source)
    }

    fn create(&mut self, name: &str, append: bool) -> Result<Box<dyn Write + Send>, HostError> {
        let file = self.host.create(name, append)?;
        if !self.record.writes.iter().any(|known| known == name) {
            self.record.writes.push(name.to_owned());
        }
        Ok(file)
    }

    fn message(&mut self, stream: Stream, text: &str) {
        self.host.message(stream, text);
    }

    fn stops(&self) -> bool {
        self.host.stops()
    }

    fn now(&mut self) -> f64 {
        self.record.time = true;
        self.host.now()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::MemoryHost;

    #[test]
    fn what_a_scene_reads_is_written_down_once() {
        let mut files = MemoryHost::new().with_file("a.inc", "abc");
        let mut host = Recorder::new(&mut files);
        for _ in 0..2 {
            assert!(host.load("a.inc", "scene.pov").is_ok());
        }
        assert!(host.load("b.inc", "scene.pov").is_err());
        assert!(host.create("c.txt", false).is_ok());
        host.now();
        let record = host.into_record();
        let [read] = &record.reads[..] else {
            panic!("{record:?}");
        };
        assert_eq!((&*read.name, &*read.from), ("a.inc", "scene.pov"));
        let hex: String = read.sha256.iter().map(|b| format!("{b:02x}")).collect();
        assert!(hex.starts_with("ba7816bf8f01cfea"), "{hex}");
        assert!(record.time && record.writes == ["c.txt"]);
    }
}
