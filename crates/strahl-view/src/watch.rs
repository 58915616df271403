//! Tells when files of the scenes change.

use crate::scenes::Scenes;
use notify::{Event, EventKind, RecommendedWatcher, RecursiveMode, Watcher};
use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::{Arc, mpsc};
use std::time::Duration;

/// Editors write a file in several steps; this long after the last one it is read.
const SETTLED: Duration = Duration::from_millis(60);

/// Watches the folders of all files of the scenes, in a thread of its own, for as long as the scenes live: editors replace files, and a
/// missing file may appear.
///
/// # Errors
/// [`notify::Error`]: the system can't watch files.
pub(crate) fn watch(scenes: &Arc<Scenes>) -> Result<(), notify::Error> {
    let (sender, events) = mpsc::channel::<Message>();
    let changed = sender.clone();
    let mut watcher = notify::recommended_watcher(move |event: notify::Result<Event>| {
        if let Ok(event) = event
            && !matches!(event.kind, EventKind::Access(_))
        {
            // Without a receiver the viewer is ending.
            let _ = changed.send(Message::Changed(event.paths));
        }
    })?;
    let weak = Arc::downgrade(scenes);
    // New scenes bring new folders.
    let mut changes = scenes.changes();
    std::thread::Builder::new()
        .name("strahl folders".into())
        .spawn(move || {
            let Ok(runtime) = tokio::runtime::Builder::new_current_thread().build() else {
                return;
            };
            while runtime.block_on(changes.changed()).is_ok()
                && sender.send(Message::Folders).is_ok()
            {}
        })?;
    std::thread::Builder::new()
        .name("strahl watch".into())
        .spawn(move || {
            let mut folders = BTreeSet::new();
            while let Ok(message) = events.recv() {
                let Some(scenes) = weak.upgrade() else {
                    return;
                };
                let mut paths = vec![];
                let mut next = Some(message);
                while let Some(message) = next {
                    match message {
                        Message::Changed(more) => paths.extend(more),
                        Message::Folders => follow(&mut watcher, &mut folders, &scenes),
                    }
                    next = match paths.is_empty() {
                        true => events.try_recv().ok(),
                        false => events.recv_timeout(SETTLED).ok(),
                    };
                }
                if !paths.is_empty() {
                    scenes.files_changed(&paths);
                }
            }
        })?;
    Ok(())
}

enum Message {
    Changed(Vec<PathBuf>),
    Folders,
}

/// Watches the folders that the scenes' files are in, and no others.
fn follow(watcher: &mut RecommendedWatcher, folders: &mut BTreeSet<PathBuf>, scenes: &Scenes) {
    let files = scenes.files();
    let parents = files.iter().filter_map(|file| file.parent());
    let wanted: BTreeSet<PathBuf> = parents.map(|p| p.to_path_buf()).collect();
    for old in folders.difference(&wanted) {
        // It may have been removed.
        let _ = watcher.unwatch(old);
    }
    folders.retain(|folder| wanted.contains(folder));
    for new in wanted {
        if !folders.contains(&new) && watcher.watch(&new, RecursiveMode::NonRecursive).is_ok() {
            folders.insert(new);
        }
    }
}
