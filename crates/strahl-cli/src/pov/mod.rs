//! POV-Ray's habits: its switches (`+W640`), its `.ini` files and its `Key=Value` words become strahl's own options, before
//! clap sees the command line. (Meanings: reference manual of POV-Ray 3.7, section 3.2, and experiments with the program.)

mod ini;
mod settings;
mod switches;

use crate::args::Cli;
use clap::CommandFactory;
use settings::{Settings, is_key};
use std::collections::BTreeSet;
use std::ffi::OsString;
use std::path::Path;

/// A command line in strahl's own words.
#[derive(Debug)]
pub(crate) struct Translated {
    pub(crate) words: Vec<OsString>,
    /// What was asked for and will not be done.
    pub(crate) notes: Vec<String>,
}

/// Translates a whole command line, the program's name included. Only `render` has a past in POV-Ray.
pub(crate) fn translate(words: Vec<OsString>) -> Result<Translated, String> {
    let unchanged = |words| Translated {
        words,
        notes: vec![],
    };
    if words.get(1).is_none_or(|w| w != "render") {
        return Ok(unchanged(words));
    }
    let with_value = options_with_value();
    let mut settings = Settings::default();
    // Strahl's own words keep their order; what is translated follows them.
    let mut own: Vec<OsString> = words[..2].to_vec();
    let mut scene: Option<OsString> = None;
    let mut foreign = false;
    let mut rest = words[2..].iter();
    while let Some(word) = rest.next() {
        let text = word.to_str().unwrap_or_default();
        if with_value.contains(text) {
            own.push(word.clone());
            own.extend(rest.next().cloned());
        } else if is_switch(text) {
            foreign = true;
            switches::apply(text, &mut settings)?;
        } else if let Some((file, section)) = ini::named(text) {
            foreign = true;
            ini::apply(&file, section.as_deref(), &mut settings)?;
        } else if let Some((key, value)) = assignment(text) {
            foreign = true;
            settings.set(key, value)?;
        } else if text.starts_with('-') && text != "-" {
            own.push(word.clone());
        } else {
            // The last scene wins over one that an .ini file names; two on the command line are clap's to refuse.
            own.extend(scene.replace(word.clone()));
            settings.input = text.to_owned();
        }
    }
    if !foreign {
        return Ok(unchanged(words));
    }
    let formatted = own.iter().any(|w| w == "--format");
    own.extend(settings.words(formatted)?.into_iter().map(OsString::from));
    if settings.input.is_empty() {
        // A name that is no UTF-8.
        own.extend(scene);
    }
    Ok(Translated {
        words: own,
        notes: settings.notes,
    })
}

/// Strahl's options that are followed by a value as a word of its own.
fn options_with_value() -> BTreeSet<String> {
    let command = Cli::command();
    let render = command.find_subcommand("render");
    let options = render.into_iter().flat_map(clap::Command::get_arguments);
    let valued = options.filter(|a| a.get_action().takes_values());
    valued
        .flat_map(|a| {
            let long = a.get_long_and_visible_aliases().unwrap_or_default();
            let long = long.into_iter().map(|l| format!("--{l}"));
            let short = a.get_short().map(|s| format!("-{s}"));
            long.chain(short).collect::<Vec<_>>()
        })
        .collect()
}

/// Whether a word is a switch of POV-Ray and no option of strahl: `-L` means the same to both.
fn is_switch(word: &str) -> bool {
    let mut letters = word.chars();
    match (letters.next(), letters.next()) {
        (Some('+'), Some(_)) => true,
        (Some('-'), Some(c)) => c.is_ascii_alphabetic() && !matches!(c, 'o' | 'q' | 'h' | 'L'),
        _ => false,
    }
}

/// `Key=Value` with a key of POV-Ray's, or with something that was meant to be one.
fn assignment(word: &str) -> Option<(&str, &str)> {
    let (key, value) = word.split_once('=')?;
    let plain = !key.is_empty() && key.chars().all(|c| c.is_ascii_alphabetic() || c == '_');
    (is_key(key) || (plain && !Path::new(word).exists())).then_some((key, value))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn translated(line: &str) -> Result<String, String> {
        let words = format!("strahl render {line}");
        let translated = translate(words.split_whitespace().map(OsString::from).collect())?;
        let words: Vec<_> = translated.words[2..]
            .iter()
            .map(|w| w.to_string_lossy())
            .collect();
        Ok(words.join(" "))
    }

    #[track_caller]
    fn is(line: &str, expected: &str) {
        assert_eq!(translated(line), Ok(expected.to_owned()), "{line}");
    }

    #[test]
    fn strahls_own_words_stay_as_they_are() {
        for line in [
            "scene.pov -o out.png --size 64x48 -L inc -q",
            "--clock -0.5 scene.pov",
            "-o +strange.png scene.pov",
            "- --format pov",
            "",
        ] {
            is(line, line);
        }
        let other = translate(["strahl", "info", "+W3"].map(OsString::from).to_vec());
        assert_eq!(other.map(|t| t.words.len()), Ok(3));
    }

    #[test]
    fn switches_become_options() {
        is(
            "+Ia.pov +Ob.png +W640 +H480",
            "--size 640x480 --output b.png a.pov",
        );
        is("+ia.pov +w64", "--size 64x600 a.pov");
        is("-Ia.pov -W64 -H48", "--size 64x48 a.pov");
        is("a.pov +A", "--sampling adaptive:0.1,2 a.pov");
        is("a.pov +A0.3 +AM2 +R3", "--sampling adaptive:0.1,3 a.pov");
        is("a.pov +A0.0 +R5", "--sampling adaptive:0,3 a.pov");
        is("a.pov +A3.0", "--sampling center a.pov");
        is("a.pov +A0.1 -A", "--sampling center a.pov");
        is(
            "a.pov +Linc -Lmore --seed 3",
            "-Lmore --seed 3 --library-path inc a.pov",
        );
        is("+I- +Ox.png", "--output x.png --format pov -");
        is(
            "a.pov -D +Q9 +WT2 -P +V -GA +GSfile +MB3 +UV -UL +J1.0 +SP32 +EP4 +BM2 +RP1 +HR +WL5 -Dx",
            "--threads 2 a.pov",
        );
        is(
            "a.pov +FN16 -C +C",
            "--bit-depth 16 --output a.png --resume a.pov",
        );
        is("a.pov +FP", "--output a.ppm a.pov");
        is("a.pov -F", "--no-output a.pov");
        is(
            "a.pov +MV3.5 +K0.25",
            "--language-version 3.5 --clock 0.25 a.pov",
        );
        is(
            "a.pov Declare=RAD=0 Width=9 height=8",
            "--size 9x8 --declare RAD=0 a.pov",
        );
    }

    #[test]
    fn output_names_end_as_the_picture_is_written() {
        is("a.pov +Ob", "--output b.png a.pov");
        is("a.pov +Ob.exr", "--output b.exr a.pov");
        is("a.pov +Ob.exr +FN", "--output b.exr.png a.pov");
        is("a.pov +Ob.c +FH", "--output b.c.hdr a.pov");
        is("dir/a.pov +Oout/", "--output out/a.png dir/a.pov");
        is("a.pov +Ob.tga +FT", "--output b.png a.pov");
    }

    #[test]
    fn parts_of_the_picture_are_regions() {
        let region = |line: &str| translated(&format!("a.pov +W80 +H60 {line}"));
        let is = |line: &str, expected: &str| {
            let all = format!("--size 80x60 {expected}a.pov");
            assert_eq!(region(line), Ok(all), "{line}");
        };
        is("+SC0.25 +EC0.75", "--region 20,0,40x60 --full-size ");
        is("+SC3 +EC6 +SR2 +ER3", "--region 2,1,4x2 --full-size ");
        is("+SR0.5", "--region 0,30,80x30 --full-size ");
        is("+SC1 +EC1 +SR1 +ER60", "");
        for empty in ["+SC6 +EC3", "+EC81", "+SC0.301 +EC0.302", "+SC-2", "+SC2.5"] {
            assert!(region(empty).is_err(), "{empty}");
        }
    }

    #[test]
    fn animations_keep_their_words() {
        is(
            "a.pov +KFI1 +KFF30 +KI0 +KF2.5 +KC +SF3 +EF0.5 +STP2",
            "--initial-frame 1 --final-frame 30 --initial-clock 0 --final-clock 2.5 \
             --subset-start-frame 3 --subset-end-frame 0.5 --frame-step 2 --cyclic a.pov",
        );
        is("a.pov Final_Frame=-1", "a.pov");
    }

    #[test]
    fn what_is_unknown_or_impossible_is_an_error() {
        for (line, part) in [
            ("a.pov +Z9", "+Z9"),
            ("a.pov +Wx", "`x`"),
            ("a.pov +W0", "`0`"),
            ("a.pov +A0.3.4", "0.3.4"),
            ("a.pov Antialas=on", "Antialias"),
            ("a.pov +AM7", "`7`"),
            ("a.pov +FZ", "`Z`"),
            ("a.pov +O-", "standard output"),
            ("a.pov +HIx.inc", "x.inc"),
            ("a.pov Declare=X", "`X`"),
            ("missing.ini", "missing.ini"),
        ] {
            let error = translated(line).expect_err(line);
            assert!(error.contains(part), "{line}: {error}");
        }
    }
}
