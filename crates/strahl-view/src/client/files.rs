//! The files of a scene: read for the page, written if that is allowed, opened in the author's editor.

use super::Client;
use crate::protocol::LONGEST_TEXT;
use crate::texts::{Text, is_sdl};
use serde_json::{Value, json};
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

impl Client {
    /// The path of a file of the scene; no other file is read or written.
    fn file(&self, name: &str) -> Result<PathBuf, String> {
        let compiled = self
            .slots
            .values()
            .filter_map(|shown| shown.compiled.as_ref());
        let mut files = compiled.flat_map(|compiled| &compiled.files);
        let known = files.find(|file| file.name == name);
        known
            .map(|file| file.path.clone())
            .ok_or_else(|| format!("the scene has no file `{name}`"))
    }

    pub(super) fn source(&self, name: &str) -> Result<Value, String> {
        let path = self.file(name)?;
        let text = match &self.text {
            Some(text) if path == crate::scenes::absolute(&self.path) => {
                Text::new(text.to_string(), is_sdl(&path))
            }
            _ => Text::read(&path)?,
        };
        serde_json::to_value(text).map_err(|e| e.to_string())
    }

    pub(super) fn save(&mut self, name: &str, text: &str) -> Result<Value, String> {
        if !self.hub.edit {
            return Err("files are written only with `strahl view --edit`".into());
        }
        if text.len() > LONGEST_TEXT {
            return Err("the text is too long".into());
        }
        let path = self.file(name)?;
        let folder = path.parent().unwrap_or(Path::new("."));
        // Never half a file; and the file's permissions stay.
        let write = || -> std::io::Result<()> {
            let mut file = tempfile::NamedTempFile::new_in(folder)?;
            file.write_all(text.as_bytes())?;
            if let Ok(known) = std::fs::metadata(&path) {
                std::fs::set_permissions(file.path(), known.permissions())?;
            }
            file.persist(&path)?;
            Ok(())
        };
        write().map_err(|e| e.to_string())?;
        if path == crate::scenes::absolute(&self.path) {
            self.text = None;
        }
        Ok(json!({}))
    }

    pub(super) fn edit(&self, name: &str, line: u32) -> Result<Value, String> {
        let editor = self.hub.editor.as_ref();
        let editor = editor.ok_or("start with `strahl view --editor COMMAND`")?;
        let (path, line) = (self.file(name)?.display().to_string(), line.to_string());
        let mut words: Vec<String> = editor
            .split_whitespace()
            .map(|word| word.replace("{file}", &path).replace("{line}", &line))
            .collect();
        if !editor.contains("{file}") {
            words.extend([format!("+{line}"), path]);
        }
        let (program, rest) = words
            .split_first()
            .ok_or("the command of --editor is empty")?;
        let mut child = Command::new(program)
            .args(rest)
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .spawn()
            .map_err(|e| format!("{program}: {e}"))?;
        // Waits for its end, so that no zombie is left.
        std::thread::spawn(move || child.wait());
        Ok(json!({}))
    }
}
