//! Finds the command at the beginning of a command line.

use super::{assignment, ini, is_switch};
use clap::Command;
use std::collections::BTreeSet;
use std::ffi::OsString;
use std::path::Path;

/// The replacement for a command line that only asks for help.
pub(super) const QUESTION: [&str; 2] = ["strahl", "--help"];

/// The words with `render` inserted if the command is missing; `None` if they ask for help in POV-Ray's way.
pub(super) fn with_command(mut words: Vec<OsString>, command: &Command) -> Option<Vec<OsString>> {
    let texts: Vec<&str> = words
        .iter()
        .map(|w| w.to_str().unwrap_or_default())
        .collect();
    match texts[1.min(texts.len())..] {
        ["-?" | "+?" | "--?" | "-help" | "+h" | "+H" | "-H"] => return None,
        ["-version" | "--V"] | ["render", "-V" | "--version" | "-version"] => {
            return Some(vec!["strahl".into(), "--version".into()]);
        }
        _ => {}
    }
    let at = behind_global_options(&words, command);
    let Some(word) = words.get(at) else {
        return Some(words);
    };
    if !is_command(word, command) && begins_render(word, command) {
        words.insert(at, "render".into());
    }
    Some(words)
}

/// The command that renders, now or on a cluster: the index of its last word, and its options that are followed by a value.
pub(super) fn rendering(
    words: &[OsString],
    command: &Command,
) -> Option<(usize, BTreeSet<String>)> {
    let at = behind_global_options(words, command);
    let name = words.get(at)?.to_str()?;
    match (name, words.get(at + 1).and_then(|word| word.to_str())) {
        ("render", _) => {
            let render = command.find_subcommand(name)?;
            Some((at, options_with_value(command, render)))
        }
        ("submit", Some(engine @ ("slurm" | "openjd"))) => {
            // Its arguments are described now.
            let mut all = command.clone();
            all.build();
            let submit = all.find_subcommand(name)?.find_subcommand(engine)?;
            Some((at + 1, options_with_value(command, submit)))
        }
        _ => None,
    }
}

/// The index of the command: after the options common to all commands.
fn behind_global_options(words: &[OsString], command: &Command) -> usize {
    let valued = valued(command.get_arguments());
    let plain = names(
        command
            .get_arguments()
            .filter(|a| !a.get_action().takes_values()),
    );
    let mut at = 1;
    while let Some(text) = words.get(at).and_then(|w| w.to_str()) {
        let name = text.split_once('=').map_or(text, |(name, _)| name);
        if valued.contains(text) {
            at += 2;
        } else if plain.contains(text) || (name != text && valued.contains(name)) {
            at += 1;
        } else {
            break;
        }
    }
    at
}

fn is_command(word: &OsString, command: &Command) -> bool {
    let mut names = command.get_subcommands().map(Command::get_name);
    word == "help" || names.any(|name| word == name)
}

/// Whether a word can only be the beginning of the arguments of `render`.
fn begins_render(word: &OsString, command: &Command) -> bool {
    let Some(text) = word.to_str() else {
        return true;
    };
    if matches!(text, "-h" | "--help" | "-V" | "--version") {
        return false;
    }
    if text.starts_with("--") {
        let name = text.split_once('=').map_or(text, |(name, _)| name);
        let render = command.find_subcommand("render");
        let options = render.into_iter().flat_map(Command::get_arguments);
        return names(options).contains(name);
    }
    let file = text == "-" || Path::new(text).extension().is_some() || Path::new(text).is_file();
    file || text.starts_with(['+', '-'])
        || is_switch(text)
        || ini::named(text).is_some()
        || ini::without_ending(text).is_some()
        || Path::new(&format!("{text}.pov")).is_file()
        || assignment(text).is_some()
}

/// The options of a command and those common to all commands that are followed by a value as a separate word.
fn options_with_value(command: &Command, of: &Command) -> BTreeSet<String> {
    valued(of.get_arguments().chain(command.get_arguments()))
}

/// An option whose value must be joined to it by `=` (`--profile=FILE`) says nothing about the word that follows.
fn valued<'a>(options: impl Iterator<Item = &'a clap::Arg>) -> BTreeSet<String> {
    names(options.filter(|a| a.get_action().takes_values() && !a.is_require_equals_set()))
}

/// `--name` and `-n` of the options.
fn names<'a>(options: impl Iterator<Item = &'a clap::Arg>) -> BTreeSet<String> {
    options
        .flat_map(|a| {
            let long = a.get_long().into_iter();
            let long = long.chain(a.get_all_aliases().unwrap_or_default());
            let long = long.map(|l| format!("--{l}"));
            let short = a.get_short().map(|s| format!("-{s}"));
            long.chain(short).collect::<Vec<_>>()
        })
        .collect()
}
