//! The font folders of the system.

use std::env;
use std::path::PathBuf;

/// The font folders, the user's own first.
pub(crate) fn font_folders() -> Vec<PathBuf> {
    let mut folders = vec![];
    if let Some(home) = env::var_os("HOME").map(PathBuf::from) {
        let own: &[&str] = if cfg!(target_os = "macos") {
            &["Library/Fonts"]
        } else {
            &[".local/share/fonts", ".fonts"]
        };
        folders.extend(own.iter().map(|folder| home.join(folder)));
    }
    let common: &[&str] = if cfg!(target_os = "macos") {
        &["/Library/Fonts", "/System/Library/Fonts"]
    } else {
        &["/usr/local/share/fonts", "/usr/share/fonts"]
    };
    if cfg!(windows) {
        let windows = env::var_os("WINDIR").map(PathBuf::from);
        folders.extend(windows.map(|folder| folder.join("Fonts")));
    } else {
        folders.extend(common.iter().map(PathBuf::from));
    }
    folders
}
