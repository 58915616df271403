//! Checks the table of features in the manual (docs/src/pov-ray.md) against the parser: each word in `data/features.tsv` has a
//! few tokens that use it, and counts as done if they are read without a message.
//!
//! `STRAHL_UPDATE=1 cargo test -p strahl-sdl --test suite features` writes the table.

use crate::common::parse_with;
use std::collections::BTreeSet;
use std::fmt::Write;
use std::path::Path;
use strahl_sdl::{MemoryHost, Word, WordKind, object_words, pattern_words};

const FEATURES: &str = include_str!("data/features.tsv");
const BEGIN: &str = "<!-- features: written by crates/strahl-sdl/tests/features.rs -->\n";
const END: &str = "<!-- end of features -->\n";

struct Feature {
    group: &'static str,
    word: &'static str,
    scene: String,
}

fn features() -> Vec<Feature> {
    let rows = FEATURES.lines().skip(1).map(|line| {
        let mut columns = line.split('\t');
        let mut next = || columns.next().expect("three columns");
        let (group, word, text) = (next(), next(), next());
        let scene = match group {
            "object modifiers" | "pigments and textures" => format!("sphere {{ 0, 1 {text} }}"),
            "patterns" => format!("sphere {{ 0, 1 pigment {{ {text} }} }}"),
            "normals" => format!("sphere {{ 0, 1 normal {{ {text} }} }}"),
            "finish" => format!("sphere {{ 0, 1 finish {{ {text} }} interior {{ ior 1.5 }} }}"),
            "interior" => format!("sphere {{ 0, 1 interior {{ {text} }} }}"),
            "lights" => format!("light_source {{ 9, 1 {text} }}"),
            "cameras" => format!("camera {{ {text} }}"),
            "global settings" => format!("global_settings {{ {text} }}"),
            "objects" | "the scene" | "language" => text.to_owned(),
            other => panic!("unknown group {other}"),
        };
        Feature { group, word, scene }
    });
    rows.collect()
}

/// Whether a scene is read completely.
fn is_done(scene: &str) -> bool {
    let mut host = MemoryHost::new().with_file("grid.df3", [0, 1, 0, 1, 0, 1, 200]);
    let parsed = parse_with(&mut host, scene);
    let lacks = ["not supported", "left out", "not shown", "not done"];
    let mut said = parsed.diagnostics.iter().map(ToString::to_string);
    // The host has no fonts.
    let only_a_font = scene.starts_with("text {") && said.clone().all(|m| m.contains("the font `"));
    (parsed.scene.is_some() || only_a_font)
        && !said.any(|text| lacks.iter().any(|lack| text.contains(lack)))
}

fn table() -> String {
    let mut groups: Vec<(&str, Vec<&str>, Vec<&str>)> = vec![];
    for feature in features() {
        if groups
            .last()
            .is_none_or(|(name, ..)| *name != feature.group)
        {
            groups.push((feature.group, vec![], vec![]));
        }
        let Some((_, done, open)) = groups.last_mut() else {
            continue;
        };
        let list = if is_done(&feature.scene) { done } else { open };
        list.push(feature.word);
    }
    let words = |list: &[&str]| {
        let shown: Vec<String> = list.iter().map(|word| format!("`{word}`")).collect();
        shown.join(" ")
    };
    let mut out = String::from("| | done | open |\n|---|---|---|\n");
    for (name, done, open) in groups {
        let _ = writeln!(out, "| {name} | {} | {} |", words(&done), words(&open));
    }
    out
}

#[test]
fn the_manual_says_what_is_done() {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/src/pov-ray.md");
    let text = std::fs::read_to_string(&page).expect("the manual");
    let (before, rest) = text.split_once(BEGIN).expect("where the table begins");
    let (_, after) = rest.split_once(END).expect("where the table ends");
    let now = format!("{before}{BEGIN}{}{END}{after}", table());
    if std::env::var_os("STRAHL_UPDATE").is_some() {
        std::fs::write(&page, now).expect("writable");
    } else {
        assert!(
            text == now,
            "docs/src/pov-ray.md is not up to date; run: STRAHL_UPDATE=1 cargo test -p strahl-sdl --test suite features"
        );
    }
}

#[test]
fn the_table_has_all_objects_statements_and_patterns() {
    let all = features();
    let of = |group: &str| -> BTreeSet<&str> {
        let rows = all.iter().filter(|f| f.group == group);
        rows.map(|f| f.word).collect()
    };
    let (objects, patterns) = (of("objects"), of("patterns"));
    let words = Word::ALL
        .iter()
        .filter(|(_, _, kind)| *kind == WordKind::Object);
    for (word, text, _) in words {
        assert!(objects.contains(text), "no row for the object {word:?}");
    }
    for word in object_words() {
        assert!(objects.contains(word.text()), "no row for {word:?}");
    }
    for word in pattern_words() {
        assert!(patterns.contains(word.text()), "no row for {word:?}");
    }
}
