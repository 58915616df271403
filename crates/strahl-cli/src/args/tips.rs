//! Errors of the command line in words that help: tips for options that other programs have and this one calls otherwise, and reasons why a value is no number.

use clap::Command;
use clap::builder::StyledStr;
use clap::error::{ContextKind, ContextValue, ErrorKind};
use std::error::Error;
use std::ffi::OsString;
use std::num::{IntErrorKind, ParseFloatError, ParseIntError};

/// Options of other programs, and what to write instead.
const ELSEWHERE: &[(&[&str], &str)] = &[
    (
        &["--width", "--height", "--resolution", "--res"],
        "write the size as `--size 640x480`, or as `+W640 +H480`",
    ),
    (
        &[
            "--samples",
            "--spp",
            "--antialias",
            "--antialiasing",
            "--aa",
        ],
        "write `--sampling 4x4` for 16 rays in each pixel, or `+A0.3` as in POV-Ray",
    ),
    (
        &["--jobs", "--cores", "--workers"],
        "write the number of threads as `--threads 4`",
    ),
    (
        &["--out", "--output-file"],
        "write the picture's name as `-o picture.png`",
    ),
];

/// The error of a command line in this program's words: with a tip if its unknown option has another name here, and with the option's name if
/// its value is what is wrong.
pub(crate) fn explained(error: clap::Error, command: &Command, words: &[OsString]) -> clap::Error {
    match error.kind() {
        ErrorKind::UnknownArgument => match negative(&error, command, words) {
            Some(negative) => negative,
            None => with_tip(error),
        },
        ErrorKind::ValueValidation => match no_number(&error) {
            Some(reason) => in_words(&error, reason),
            None => error,
        },
        _ => error,
    }
}

fn with_tip(mut error: clap::Error) -> clap::Error {
    let Some(ContextValue::String(option)) = error.get(ContextKind::InvalidArg) else {
        return error;
    };
    let is_short = !option.starts_with("--");
    let known = ELSEWHERE
        .iter()
        .find(|(names, _)| names.contains(&option.as_str()));
    if let Some((_, tip)) = known {
        let tips = ContextValue::StyledStrs(vec![StyledStr::from(*tip)]);
        error.remove(ContextKind::SuggestedArg);
        error.insert(ContextKind::Suggested, tips);
    } else if is_short {
        // That it could be the name of a scene, behind `--`.
        error.remove(ContextKind::Suggested);
    }
    error
}

/// The error for a negative number that an option does not take. clap looks for options named `-1`.
fn negative(error: &clap::Error, command: &Command, words: &[OsString]) -> Option<clap::Error> {
    let Some(ContextValue::String(unknown)) = error.get(ContextKind::InvalidArg) else {
        return None;
    };
    let is_number = |word: &str| word.starts_with(|c: char| c.is_ascii_digit() || c == '.');
    if !unknown.strip_prefix('-').is_some_and(is_number) {
        return None;
    }
    let words: Vec<String> = words
        .iter()
        .map(|word| word.to_string_lossy().into_owned())
        .collect();
    let mut command = command;
    for word in &words[1..] {
        command = command.find_subcommand(word).unwrap_or(command);
    }
    let pairs = words.windows(2).filter(|pair| pair[1].starts_with(unknown));
    pairs.into_iter().find_map(|pair| {
        let name = pair[0].strip_prefix("--")?;
        let mut options = command.get_arguments();
        let option = options.find(|option| {
            let aliases = option.get_all_aliases().unwrap_or_default();
            option.get_long() == Some(name) || aliases.contains(&name)
        })?;
        option.get_action().takes_values().then(|| {
            let value = &pair[1];
            of_value(value, &option.to_string(), "it can't be negative")
        })
    })
}

/// Why a text is no number, if Rust says so.
fn no_number(error: &clap::Error) -> Option<&'static str> {
    let source = error.source()?;
    if source.is::<ParseFloatError>() {
        return Some("expected a number, such as 0.5");
    }
    let error = source.downcast_ref::<ParseIntError>()?;
    Some(match error.kind() {
        IntErrorKind::PosOverflow => "the number is too large",
        IntErrorKind::InvalidDigit | IntErrorKind::NegOverflow => {
            "expected a whole number that is not negative"
        }
        _ => "expected a whole number",
    })
}

/// The error with a reason of ours.
fn in_words(error: &clap::Error, reason: &str) -> clap::Error {
    let text = |kind| match error.get(kind) {
        Some(ContextValue::String(text)) => text.as_str(),
        _ => "",
    };
    of_value(
        text(ContextKind::InvalidValue),
        text(ContextKind::InvalidArg),
        reason,
    )
}

fn of_value(value: &str, option: &str, reason: &str) -> clap::Error {
    let text = format!(
        "invalid value '{value}' for '{option}': {reason}\n\nFor more information, try '--help'.\n"
    );
    clap::Error::raw(ErrorKind::ValueValidation, text)
}
