use super::{Host, HostError, Source, Stream};
use std::collections::BTreeMap;
use std::io::Write;
use std::sync::{Arc, Mutex, PoisonError};

/// Files in memory, for tests and for programs that generate scenes.
#[derive(Debug, Default)]
pub struct MemoryHost {
    files: BTreeMap<String, Vec<u8>>,
    written: Arc<Mutex<BTreeMap<String, Vec<u8>>>>,
    messages: Vec<(Stream, String)>,
}

impl MemoryHost {
    /// A host without files.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a file that scenes can include or read.
    #[must_use]
    pub fn with_file(mut self, name: &str, text: impl Into<Vec<u8>>) -> Self {
        self.files.insert(name.to_owned(), text.into());
        self
    }

    /// The bytes that scenes have written to a file.
    pub fn written(&self, name: &str) -> Option<Vec<u8>> {
        let files = self.written.lock().unwrap_or_else(PoisonError::into_inner);
        files.get(name).cloned()
    }

    /// The messages of scenes, in order.
    pub fn messages(&self) -> &[(Stream, String)] {
        &self.messages
    }

    /// All text sent to one stream.
    pub fn text(&self, stream: Stream) -> String {
        let of_stream = self.messages.iter().filter(|(s, _)| *s == stream);
        of_stream.map(|(_, text)| text.as_str()).collect()
    }
}

impl Host for MemoryHost {
    fn load(&mut self, name: &str, _from: &str) -> Result<Source, HostError> {
        if let Some(bytes) = self.files.get(name) {
            return Ok(Source::new(name, bytes.clone()));
        }
        self.written(name)
            .map(|bytes| Source::new(name, bytes))
            .ok_or_else(|| HostError::NotFound {
                name: name.to_owned(),
                searched: vec!["memory".to_owned()],
            })
    }

    fn create(&mut self, name: &str, append: bool) -> Result<Box<dyn Write + Send>, HostError> {
        let mut files = self.written.lock().unwrap_or_else(PoisonError::into_inner);
        let file = files.entry(name.to_owned()).or_default();
        if !append {
            file.clear();
        }
        Ok(Box::new(MemoryFile {
            name: name.to_owned(),
            files: Arc::clone(&self.written),
        }))
    }

    fn message(&mut self, stream: Stream, text: &str) {
        self.messages.push((stream, text.to_owned()));
    }

    fn now(&mut self) -> f64 {
        0.0
    }
}

struct MemoryFile {
    name: String,
    files: Arc<Mutex<BTreeMap<String, Vec<u8>>>>,
}

impl Write for MemoryFile {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        let mut files = self.files.lock().unwrap_or_else(PoisonError::into_inner);
        files
            .entry(self.name.clone())
            .or_default()
            .extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}
