//! The files of a scene: read for the page, written if that is allowed, opened in the author's editor.

use super::{Client, MOST_TEXT};
use crate::protocol::{LONGEST_TEXT, Slot};
use crate::scenes::SceneFile;
use crate::texts::{Text, is_sdl};
use serde_json::{Value, json};
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use strahl::sdl::Texts;

impl Client {
    /// A file of the scene; no other file is read or written.
    fn file(&self, name: &str) -> Result<&SceneFile, String> {
        let compiled = self
            .slots
            .values()
            .filter_map(|shown| shown.compiled.as_ref());
        let mut files = compiled.flat_map(|compiled| &compiled.files);
        files
            .find(|file| file.name == name)
            .ok_or_else(|| format!("the scene has no file `{name}`"))
    }

    /// The path of a file of the scene that can be changed.
    fn path_of(&self, name: &str) -> Result<PathBuf, String> {
        let file = self.file(name)?;
        match file.built_in {
            None => Ok(file.path.clone()),
            Some(_) => Err(format!("`{name}` is a part of strahl")),
        }
    }

    pub(super) fn source(&self, name: &str) -> Result<Value, String> {
        let text = text_of(self.file(name)?, &self.texts)?;
        serde_json::to_value(text).map_err(|e| e.to_string())
    }

    /// The texts of a picture's scene, as far as they are shown and not built in.
    pub(super) fn scene_texts(&self, slot: Slot) -> Vec<(String, Text)> {
        let shown = self.slots.get(&slot);
        let compiled = shown.and_then(|shown| shown.compiled.as_ref());
        let files = compiled.iter().flat_map(|compiled| &compiled.files);
        files
            .filter(|file| file.is_text() && file.built_in.is_none())
            .filter_map(|file| Some((file.name.clone(), text_of(file, &self.texts).ok()?)))
            .collect()
    }

    /// Tries a text instead of a file, the scene's own if there is no name; without a text, tries none any more: instead of this file, or of
    /// any file.
    pub(super) fn try_text(
        &mut self,
        name: Option<&str>,
        text: Option<String>,
    ) -> Result<(), String> {
        let path = match name {
            None => self.path.clone(),
            Some(name) => {
                self.path_of(name)?;
                PathBuf::from(name)
            }
        };
        let Some(text) = text else {
            match name {
                None => self.texts.clear(),
                Some(_) => drop(self.texts.remove(&path)),
            }
            return Ok(());
        };
        let others = self.texts.iter().filter(|(other, _)| **other != path);
        let length: usize = others.map(|(_, text)| text.len()).sum();
        if text.len() > LONGEST_TEXT || length + text.len() > MOST_TEXT {
            return Err("the text is too long".into());
        }
        self.texts.insert(path, text.into());
        Ok(())
    }

    pub(super) fn save(&mut self, name: &str, text: &str) -> Result<Value, String> {
        if !self.hub.edit {
            return Err("files are written only with `strahl view --edit`".into());
        }
        if text.len() > LONGEST_TEXT {
            return Err("the text is too long".into());
        }
        let path = self.path_of(name)?;
        // A link stays one: what it leads to is written.
        let path = path.canonicalize().unwrap_or(path);
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
        self.texts.remove(Path::new(name));
        Ok(json!({}))
    }

    pub(super) fn edit(&self, name: &str, line: u32) -> Result<Value, String> {
        let editor = self.hub.editor.as_ref();
        let editor = editor.ok_or("start with `strahl view --editor COMMAND`")?;
        let (path, line) = (self.path_of(name)?.display().to_string(), line.to_string());
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

/// The text of a file: what is tried instead of it, what is built in, or what is on the disk.
fn text_of(file: &SceneFile, tried: &Texts) -> Result<Text, String> {
    match (tried.get(Path::new(&file.name)), file.built_in) {
        (Some(text), _) => Ok(Text::new(text.to_string(), is_sdl(&file.path))),
        (None, Some(text)) => Ok(Text::new(text.to_owned(), true)),
        (None, None) => Text::read(&file.path),
    }
}
