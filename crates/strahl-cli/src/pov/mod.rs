//! POV-Ray's command line: its switches (`+W640`), its `.ini` files and its `Key=Value` words are translated to strahl's own
//! options before clap parses the command line. (Meanings: reference manual of POV-Ray 3.7, section 3.2, and experiments with the
//! program.)

mod begin;
mod ini;
mod keys;
mod settings;
mod switches;

use clap::Command;
use keys::is_key;
use settings::{Own, Settings};
use std::ffi::OsString;
use std::path::Path;

/// A command line in strahl's own options.
#[derive(Debug)]
pub(crate) struct Translated {
    pub(crate) words: Vec<OsString>,
    /// Notes on settings that will have no effect.
    pub(crate) notes: Vec<String>,
}

/// Translates a whole command line, with the program's name. Only `render`, and `submit` for a cluster, accept POV-Ray's words; the word `render` may be left
/// out before a scene, an .ini file, a switch or an option of `render`. `command` describes strahl's own command line.
pub(crate) fn translate(words: Vec<OsString>, command: &Command) -> Result<Translated, String> {
    let Some(words) = begin::with_command(words, command) else {
        return Ok(Translated {
            words: begin::QUESTION.map(OsString::from).to_vec(),
            notes: vec![],
        });
    };
    let Some((render, with_value)) = begin::rendering(&words, command) else {
        return Ok(Translated {
            words,
            notes: vec![],
        });
    };
    let mut settings = Settings::default();
    // Strahl's own options come last, because the last occurrence of an option counts.
    let mut own: Vec<OsString> = vec![];
    let mut scene: Option<OsString> = None;
    let mut foreign = false;
    let mut rest = words[render + 1..].iter();
    while let Some(word) = rest.next() {
        let text = word.to_str().unwrap_or_default();
        if with_value.contains(text) {
            own.push(word.clone());
            own.extend(rest.next().cloned());
        } else if is_switch(text) {
            foreign = true;
            switches::apply(text, &mut settings)?;
        } else if let Some((key, value)) = assignment(text) {
            foreign = true;
            settings.set(key, ini::unquoted(value))?;
        } else if let Some((file, section)) = ini::named(text).or_else(|| ini::without_ending(text))
        {
            foreign = true;
            ini::apply(&file, section.as_deref(), &mut settings)?;
        } else if text.starts_with('-') && text != "-" {
            own.push(word.clone());
        } else {
            // The last scene overrides one that an .ini file names; clap refuses two on the command line.
            own.extend(scene.replace(word.clone()));
            settings.input = settings.complete(text);
            settings.is_pov = false;
        }
    }
    let complete = OsString::from(&settings.input);
    if !foreign {
        let replaced = |w: OsString| match Some(&w) == scene.as_ref() && !settings.input.is_empty()
        {
            true => complete.clone(),
            false => w,
        };
        return Ok(Translated {
            words: words.into_iter().map(replaced).collect(),
            notes: vec![],
        });
    }
    if scene.is_none() && settings.input.is_empty() && !own.iter().any(asks_for_text) {
        return Err(NO_SCENE.to_owned());
    }
    let mut all = words[..=render].to_vec();
    let translated = settings.words(&Own::of(&own))?;
    all.extend(translated.into_iter().map(OsString::from));
    all.extend(own);
    if settings.input.is_empty() {
        // The name is not UTF-8.
        all.extend(scene);
    } else {
        all.push(complete);
    }
    Ok(Translated {
        words: all,
        notes: settings.notes,
    })
}

/// The error if words of POV-Ray name no scene. In strahl's own options this means the demo scene.
const NO_SCENE: &str = "no scene is named: add it to the command, as in `strahl +Iscene.pov +W640 +H480`, \
                        or to the .ini file, as `Input_File_Name=scene.pov`";

/// Whether an option asks for the help or the version instead of a picture.
fn asks_for_text(option: &OsString) -> bool {
    ["-h", "--help", "-V", "--version"]
        .iter()
        .any(|text| option == text)
}

/// Whether a word is a switch of POV-Ray and not an option of strahl: `-L` means the same in both, `-h` and `-q` are POV-Ray's before a number.
fn is_switch(word: &str) -> bool {
    let mut letters = word.chars();
    match (letters.next(), letters.next()) {
        (Some('+'), Some(_)) => true,
        (Some('-'), Some('h' | 'q')) => letters.next().is_some_and(|c| c.is_ascii_digit()),
        (Some('-'), Some(c)) => c.is_ascii_alphabetic() && !matches!(c, 'o' | 'L'),
        _ => false,
    }
}

/// Splits `Key=Value` if the key is one of POV-Ray's, or looks like a misspelled one.
fn assignment(word: &str) -> Option<(&str, &str)> {
    let (key, value) = word.split_once('=')?;
    let plain = !key.is_empty() && key.chars().all(|c| c.is_ascii_alphabetic() || c == '_');
    (is_key(key) || (plain && !Path::new(word).exists())).then_some((key, value))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::args::Cli;
    use clap::CommandFactory;

    fn whole(line: &str) -> Result<String, String> {
        let words = line.split_whitespace().map(OsString::from).collect();
        let translated = translate(words, &Cli::command())?;
        let words: Vec<_> = translated
            .words
            .iter()
            .map(|w| w.to_string_lossy())
            .collect();
        Ok(words.join(" "))
    }

    fn translated(line: &str) -> Result<String, String> {
        let words = whole(&format!("strahl render {line}"))?;
        let begin = "strahl render ".len().min(words.len());
        Ok(words[begin..].to_owned())
    }

    #[test]
    fn render_may_be_left_out() {
        for line in [
            "scene.pov",
            "scene.pov -o a.png",
            "-o a.png scene.pov",
            "--size 8x8 scene.pov",
            "- --format pov",
        ] {
            assert_eq!(
                whole(&format!("strahl {line}")),
                Ok(format!("strahl render {line}"))
            );
        }
        let is = |line: &str, expected: &str| assert_eq!(whole(line), Ok(expected.to_owned()));
        is(
            "strahl +Ia.pov +W64 +H48",
            "strahl render --size 64x48 --sampling center a.pov",
        );
        is(
            "strahl -W8 a.pov",
            "strahl render --size 8x600 --sampling center a.pov",
        );
        is(
            "strahl Width=8 Input_File_Name=a.pov",
            "strahl render --size 8x600 --sampling center a.pov",
        );
        is(
            "strahl --max-memory 1G --strict +Ia.pov",
            "strahl --max-memory 1G --strict render --sampling center a.pov",
        );
        for line in ["strahl -?", "strahl +H", "strahl -help"] {
            is(line, "strahl --help");
        }
        for line in ["strahl -version", "strahl --V", "strahl render -V"] {
            is(line, "strahl --version");
        }
    }

    #[test]
    fn strahls_own_options_win_over_povs() {
        is(
            "a.pov --size 32x24 +W640 +H480 -o x.png +Oy.png --sampling center +A0.3",
            "--size 32x24 --sampling adaptive:0.3,3 --output y.png --size 32x24 -o x.png --sampling center a.pov",
        );
        // The region is a part of the final size.
        is(
            "a.pov --size=80x60 +SR0.5",
            "--size 80x60 --region 0,30,80x30 --full-size --size=80x60 a.pov",
        );
        is(
            "a.pov +W80 +H60 +SR0.5 --region 1,2,3x4",
            "--size 80x60 --region 1,2,3x4 a.pov",
        );
        is("- --format nff +W8", "--size 8x600 --format nff -");
    }

    #[track_caller]
    /// Without `--sampling center` where the line asks for no sampling.
    fn without_center(line: &str) -> Result<String, String> {
        let words = translated(line)?;
        Ok(match line.contains("+A") {
            true => words,
            false => words.replacen("--sampling center ", "", 1),
        })
    }

    fn is(line: &str, expected: &str) {
        assert_eq!(without_center(line), Ok(expected.to_owned()), "{line}");
    }

    #[test]
    fn povrays_words_ask_for_no_antialiasing() {
        for (line, expected) in [
            ("a.pov +W9 +H9", "--size 9x9 --sampling center a.pov"),
            ("a.pov +R3 +AM2", "--sampling center a.pov"),
            ("a.pov Antialias=off", "--sampling center a.pov"),
            (
                "a.pov +P --sampling 2x2",
                "--sampling center --sampling 2x2 a.pov",
            ),
            ("a.pov --seed 3", "a.pov --seed 3"),
        ] {
            assert_eq!(translated(line), Ok(expected.to_owned()), "{line}");
        }
    }

    #[test]
    fn a_profile_without_a_file_leaves_the_next_word_alone() {
        is(
            "a.pov --profile +A0.3",
            "--sampling adaptive:0.3,3 --profile a.pov",
        );
        is(
            "--profile -L inc a.pov +W8",
            "--size 8x600 --profile -L inc a.pov",
        );
        is("+W8 --profile a.pov", "--size 8x600 --profile a.pov");
        is("a.pov --profile -A", "--profile a.pov");
        is(
            "a.pov --profile=p.json +W8",
            "--size 8x600 --profile=p.json a.pov",
        );
    }

    #[test]
    fn strahls_own_words_stay_as_they_are() {
        for line in [
            "scene.pov -o out.png --size 64x48 -L inc -q",
            "--clock -0.5 scene.pov",
            "--strict scene.pov --max-memory 1G",
            "-o +strange.png scene.pov",
            "- --format pov",
            "",
        ] {
            is(line, line);
        }
        for line in [
            "strahl info +W3",
            "strahl",
            "strahl --help",
            "strahl -h",
            "strahl render -h",
            "strahl -V",
            "strahl rendr scene.pov",
            "strahl --strict check render",
            "strahl help render",
        ] {
            assert_eq!(whole(line), Ok(line.to_owned()));
        }
    }

    #[test]
    fn switches_become_options() {
        is(
            "+Ia.pov +Ob.png +W640 +H480",
            "--size 640x480 --output b.png a.pov",
        );
        is("+ia.pov +w64", "--size 64x600 a.pov");
        is("-Ia.pov -W64 -H48", "--size 64x48 a.pov");
        is("-ia.pov -w64 -h48 -q", "--size 64x48 -q a.pov");
        is("a.pov -q9 -q3", "--quality 3 a.pov");
        is("a.pov +A", "--sampling adaptive:0.3,3 a.pov");
        is("a.pov +A0.3 +AM2 +R3", "--sampling recursive:0.3,3 a.pov");
        is("a.pov +A0.2 +AG1.8", "--sampling adaptive:0.2,3,1.8 a.pov");
        is("a.pov +A0.0 +R5", "--sampling adaptive:0,5 a.pov");
        is("a.pov +A3.0", "--sampling center a.pov");
        is("a.pov +A0.1 -A", "--sampling center a.pov");
        is(
            "a.pov +Linc -Lmore --seed 3",
            "--library-path inc -Lmore --seed 3 a.pov",
        );
        is(
            r#"+I"a.pov" Library_Path="lib" +L'more' +O"b.png""#,
            "--library-path lib --library-path more --output b.png a.pov",
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
        is("a.pov +UA", "--alpha a.pov");
        is("a.pov +UA +FJ", "--output a.jpg a.pov");
        is("a.pov +UA +FT", "--output a.tga --alpha a.pov");
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
    fn help_needs_no_scene() {
        let help = translated("+W8 --help").unwrap();
        assert!(help.ends_with("--help"), "{help}");
    }

    #[test]
    fn output_names_end_as_the_picture_is_written() {
        is("a.pov +Ob", "--output b.png a.pov");
        is("a.pov +Ob.exr", "--output b.exr a.pov");
        is("a.pov +Ob.exr +FN", "--output b.exr.png a.pov");
        is("a.pov +Ob.c +FH", "--output b.c.hdr a.pov");
        is("dir/a.pov +Oout/", "--output out/a.png dir/a.pov");
        is("a.pov +Ob.tga +FT", "--output b.tga a.pov");
        is("+Iscenes/a.pov", "--output scenes/ scenes/a.pov");
        is("/tmp/a.pov +W8 +H6", "--size 8x6 --output /tmp/ /tmp/a.pov");
        is("+Iscenes/a.pov +FP", "--output scenes/a.ppm scenes/a.pov");
        is("+Iscenes/a.pov +Ob", "--output b.png scenes/a.pov");
        is("scenes/a.pov", "scenes/a.pov");
        is("a.pov +FB", "--output a.bmp a.pov");
        is(
            "a.pov +FJ Compression=90",
            "--jpeg-quality 90 --output a.jpg a.pov",
        );
        is("a.pov +FJ90", "--jpeg-quality 90 --output a.jpg a.pov");
        is(
            "a.pov +FNG",
            "--bit-depth 16 --output a.png --grayscale a.pov",
        );
        is(
            "a.pov +FpG",
            "--bit-depth 16 --output a.ppm --grayscale a.pov",
        );
        is(
            "a.pov Grayscale_Output=on +O-",
            "--bit-depth 16 --output - --grayscale a.pov",
        );
        is("a.pov Grayscale_Output=off", "a.pov");
        is("a.pov +Ob.jpeg +FJ Compression=1", "--output b.jpeg a.pov");
        is("a.pov +O-", "--output - a.pov");
        is("a.pov +O- +FP", "--output - --picture-format ppm a.pov");
        is("a.pov +Q4", "--quality 4 a.pov");
        is("a.pov +Q11", "a.pov");
        is("a.pov Quality=12", "a.pov");
        is("a.pov Quality=0x9", "--quality 0 a.pov");
        is("a.pov +A0.3.4 +R12", "--sampling adaptive:0.3,9 a.pov");
        is("a.pov Clock=1/2 +K1e-1", "--clock 1e-1 a.pov");
        is("a.pov +W16/2 +H12abc", "--size 16x12 a.pov");
        is("a.pov Version=350", "--language-version 3.7 a.pov");
        is("a.pov Declare=X=2/3", "--declare X=2 a.pov");
        is(
            "a.pov Declare=X=2 Declare=Y=3 Declare=X=5",
            "--declare X=2 --declare Y=3 a.pov",
        );
        is("a.pov +K-.5", "--clock -.5 a.pov");
        is("a.pov Declare=X=red", "--declare X=red a.pov");
        is("a.pov Output_File_Type=N16", "--output a.png a.pov");
        is("a.pov Output_File_Type=PNG", "--output a.ppm a.pov");
        is("a.pov +Ostdout", "--output - a.pov");
        is("a.pov +HIx.inc", "--include x.inc a.pov");
    }

    #[test]
    fn parts_of_the_picture_are_regions() {
        let region = |line: &str| without_center(&format!("a.pov +W80 +H60 {line}"));
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
        is(
            "a.pov +KFI1 +KFF1 +K0.3 +KI.2 +SF3 +KC",
            "--clock 0.3 a.pov",
        );
        is("a.pov +KFF1", "--final-frame 1 a.pov");
    }

    #[test]
    fn what_is_unknown_or_impossible_is_an_error() {
        for (line, part) in [
            ("a.pov +Z9", "+Z9"),
            ("a.pov +Wx", "`x`"),
            ("a.pov +W0", "`0`"),
            ("a.pov Antialas=on", "Antialias"),
            ("a.pov +AM7", "`7`"),
            ("a.pov +FZ", "`Z`"),
            ("a.pov +FTG", "`G`"),
            ("a.pov Declare=X", "`X`"),
            ("missing.ini", "missing.ini"),
            (
                "Include_Ini=missing.ini",
                "Include_Ini: cannot read `missing.ini`",
            ),
            ("+W8 +H6", "Input_File_Name=scene.pov"),
            ("Width=8 --size 8x6", "no scene"),
        ] {
            let error = translated(line).expect_err(line);
            assert!(error.contains(part), "{line}: {error}");
        }
    }
}
