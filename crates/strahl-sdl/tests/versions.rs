//! The effects of language versions: the rows of `data/versions.tsv`, which docs/src/versions.md explains.

use crate::common::parse_with;
use std::collections::BTreeSet;
use std::path::Path;
use strahl_render::{CompileOptions, RenderOptions, Sampling, compile, render};
use strahl_sdl::{MemoryHost, Parsed, Stream};
use strahl_shade::srgb;

/// The row of the page, the version (`none`: the scene has no `#version` in front), what POV-Ray 3.7.0.10 does with the scene (`shows` a picture,
/// `says` a text, `refused`, or `refused, taken here`), the text or the codes of a picture of 4x3 pixels, and the scene.
const CASES: &str = include_str!("data/versions.tsv");

struct Case<'t> {
    row: &'t str,
    version: &'t str,
    povray: &'t str,
    expected: &'t str,
    scene: &'t str,
}

fn cases() -> impl Iterator<Item = Case<'static>> {
    CASES.lines().skip(1).map(|line| {
        let fields: Vec<&str> = line.split('\t').collect();
        let [row, version, povray, expected, scene] = fields[..] else {
            panic!("five fields: {line}");
        };
        Case {
            row,
            version,
            povray,
            expected,
            scene,
        }
    })
}

/// The codes of the picture, with `alpha` that of the alpha channel behind those of each colour.
fn shown(parsed: &Parsed, alpha: bool) -> Vec<Vec<u8>> {
    let scene = parsed.scene.as_ref().expect("no error");
    let scene = compile(scene, &CompileOptions::default()).expect("a valid scene");
    let mut options = RenderOptions::new(&scene, 4, 3);
    options.sampling = Sampling::Center;
    options.threads = 1;
    options.alpha = alpha;
    let film = render(&scene, &options).expect("a picture").film;
    let code = |c: f32| srgb::encode_u8(c.clamp(0.0, 1.0));
    let colors = film.pixels.iter().enumerate();
    colors
        .map(|(at, color)| match &film.alpha {
            None => color.map(code).to_vec(),
            Some(alpha) => {
                // Files have colours that are not multiplied by alpha.
                let share = if alpha[at] > 0.0 { alpha[at] } else { 1.0 };
                let mut codes = color.map(|c| code(c / share)).to_vec();
                codes.push((alpha[at] * 255.0).round() as u8);
                codes
            }
        })
        .collect()
}

fn codes(text: &str) -> Vec<Vec<u8>> {
    let code = |pair: &[u8]| {
        let pair = str::from_utf8(pair).expect("digits");
        u8::from_str_radix(pair, 16).expect("a code")
    };
    text.split(' ')
        .map(|pixel| pixel.as_bytes().chunks(2).map(code).collect())
        .collect()
}

/// The problem of a case.
fn problem(case: &Case<'_>) -> Option<String> {
    let text = match case.version {
        "none" => case.scene.to_owned(),
        version => format!("#version {version}; {}", case.scene),
    };
    let mut host = MemoryHost::new();
    let parsed = parse_with(&mut host, &text);
    if case.povray == "refused" {
        return parsed.scene.is_some().then(|| "no error".to_owned());
    }
    if parsed.scene.is_none() {
        return Some(format!("{:?}", parsed.diagnostics));
    }
    if case.scene.contains("#debug") {
        let said = host.text(Stream::Debug);
        let words = said.split("@@").map(str::trim);
        let said: Vec<&str> = words.filter(|word| !word.is_empty()).collect();
        let said = said.join(" ");
        return (said != case.expected).then(|| format!("says {said}"));
    }
    let ours = shown(&parsed, case.row == "alpha channel");
    let expected = codes(case.expected);
    let near = |a: &Vec<u8>, b: &Vec<u8>| {
        a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.abs_diff(*b) <= 1)
    };
    let agree = ours.len() == expected.len() && ours.iter().zip(&expected).all(|(a, b)| near(a, b));
    (!agree).then(|| format!("shows {ours:02x?}, not {expected:02x?}"))
}

#[test]
fn versions_mean_what_they_mean_to_pov_ray() {
    let mut wrong = vec![];
    for case in cases() {
        if let Some(problem) = problem(&case) {
            wrong.push(format!(
                "{}, version {}: {problem}\n    {}",
                case.row, case.version, case.scene
            ));
        }
    }
    assert!(wrong.is_empty(), "{}:\n{}", wrong.len(), wrong.join("\n"));
}

#[test]
fn each_row_of_the_page_has_cases() {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/src/versions.md");
    let text = std::fs::read_to_string(&page).expect("the page");
    let rows = text.lines().filter_map(|line| {
        let name = line.strip_prefix("| ")?.split(" | ").next()?;
        let begins = name != "construct" && !name.starts_with('|');
        begins.then(|| name.to_owned())
    });
    let (rows, tested): (BTreeSet<String>, BTreeSet<String>) =
        (rows.collect(), cases().map(|c| c.row.to_owned()).collect());
    assert_eq!(rows, tested, "rows of docs/src/versions.md and of the data");
    // A row that names a limit has cases on both sides of it.
    for row in &rows {
        let versions: BTreeSet<&str> = cases()
            .filter(|c| c.row == row)
            .map(|c| c.version)
            .collect();
        let alone = matches!(row.as_str(), "no `#version`");
        assert!(alone || versions.len() > 1, "one version of {row} only");
    }
}
