//! The same objects, rendered by POV-Ray 3.7 and by strahl: more than 99 % of the pixels must be equal.
//!
//! `STRAHL_SILHOUETTE="box" cargo test -p strahl-sdl --test suite silhouettes` runs one of them and shows the pixels that differ.

mod scenes;

use self::scenes::{SCENES, SETUP};
use crate::common::pictures::{Pixels, SIZE, pair};
use crate::common::{each, tool};
use std::path::Path;
use strahl_shade::srgb;

/// The pixels that look different in two pictures.
fn differences(a: &Pixels, b: &Pixels) -> Vec<bool> {
    let encoded = |p: &[f64; 3]| p.map(srgb::encode);
    let pairs = a.iter().map(encoded).zip(b.iter().map(encoded));
    let differ =
        |(a, b): ([f64; 3], [f64; 3])| a.iter().zip(b).any(|(a, b)| (a - b).abs() > 2.0 / 255.0);
    pairs.map(differ).collect()
}

/// The problem of a scene, if there is one.
fn look(povray: &Path, name: &str, body: &str, show: bool) -> Option<String> {
    let (theirs, ours) = match pair(povray, &format!("{SETUP}\n{body}\n")) {
        Ok(pair) => pair,
        Err(why) => return Some(format!("{name}: {why}")),
    };
    let seen = theirs.iter().filter(|p| **p != theirs[0]).count();
    if seen <= theirs.len() / 50 {
        return Some(format!("{name}: there is hardly anything to see"));
    }
    let differ = differences(&ours, &theirs);
    let count = differ.iter().filter(|d| **d).count();
    if show {
        let rows = differ.chunks(SIZE.0 as usize);
        let row = |r: &[bool]| {
            r.iter()
                .map(|d| if *d { '#' } else { '.' })
                .collect::<String>()
        };
        let rows: Vec<String> = rows.map(row).collect();
        return Some(format!(
            "{name}: {count} pixels differ\n{}",
            rows.join("\n")
        ));
    }
    let of = differ.len();
    (count * 100 >= of).then(|| format!("{name}: {count} of {of} pixels differ"))
}

#[test]
fn objects_look_as_in_povray() {
    let Some(povray) = tool("povray") else {
        return;
    };
    let only = std::env::var("STRAHL_SILHOUETTE").ok();
    let wanted = |name: &str| only.as_deref().is_none_or(|only| only == name);
    let scenes: Vec<_> = SCENES.iter().filter(|(name, _)| wanted(name)).collect();
    assert!(!scenes.is_empty(), "there is no scene of this name");
    let wrong: Vec<String> = each(&scenes, |(name, body)| {
        look(&povray, name, body, only.is_some())
    })
    .into_iter()
    .flatten()
    .collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
