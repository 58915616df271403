//! Scenes of one pixel with the values that POV-Ray 3.7 gives it.

use super::parse_with;
use strahl_render::{CompileOptions, RenderOptions, compile, render};
use strahl_sdl::MemoryHost;

/// Colours that encode directions change by this much if a direction changes by a thousandth.
const TOLERANCE: f64 = 1e-3;

fn shown(scene: &str) -> [f64; 3] {
    let parsed = parse_with(&mut MemoryHost::new(), scene);
    let scene = parsed
        .scene
        .unwrap_or_else(|| panic!("{:?}", parsed.diagnostics));
    let scene = compile(&scene, &CompileOptions::default()).expect("a valid scene");
    let mut options = RenderOptions::new(&scene, 1, 1);
    options.threads = 1;
    let film = render(&scene, &options).expect("a picture").film;
    film.pixels[0].map(|c| f64::from(c).clamp(0.0, 1.0))
}

/// Renders the scenes of a group and compares. `cases` is a table with tabs and a header: group, case, the values of POV-Ray
/// 3.7.0.10 (linear red, green and blue), and the scene.
pub(crate) fn agree(cases: &str, group: &str) {
    let mut wrong = vec![];
    let mut count = 0;
    for row in cases.lines().skip(1) {
        let fields: Vec<&str> = row.split('\t').collect();
        let [of, case, red, green, blue, scene] = fields[..] else {
            panic!("six fields: {row}");
        };
        if of != group {
            continue;
        }
        count += 1;
        let theirs = [red, green, blue].map(|c| c.parse::<f64>().expect("a number"));
        let ours = shown(scene);
        if ours
            .iter()
            .zip(theirs)
            .any(|(a, b)| (a - b).abs() > TOLERANCE)
        {
            wrong.push(format!("{case}: {ours:.4?} is not {theirs:.4?}: {scene}"));
        }
    }
    assert!(count > 0, "no case of {group}");
    assert!(
        wrong.is_empty(),
        "{} of {count}:\n{}",
        wrong.len(),
        wrong.join("\n")
    );
}

/// Fails if a table has a group that is not among those named.
pub(crate) fn all_named(cases: &str, groups: &[&str]) {
    let of = |row: &str| row.split('\t').next().map(str::to_owned);
    for group in cases.lines().skip(1).filter_map(of) {
        assert!(groups.contains(&&*group), "{group} has no test");
    }
}

/// Makes a test of each group of a table ([`agree`]).
#[macro_export]
macro_rules! groups {
    ($cases:expr; $($group:ident,)+) => {
        $(#[test]
        fn $group() {
            $crate::common::pixel::agree($cases, stringify!($group));
        })+

        #[test]
        fn every_group_has_a_test() {
            $crate::common::pixel::all_named($cases, &[$(stringify!($group)),+]);
        }
    };
}
