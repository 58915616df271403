//! Tips for options that other programs have and this one calls otherwise.

use clap::builder::StyledStr;
use clap::error::{ContextKind, ContextValue, ErrorKind};

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

/// The error, with a tip if its unknown option has another name here.
pub(crate) fn with_tip(mut error: clap::Error) -> clap::Error {
    let Some(ContextValue::String(option)) = error.get(ContextKind::InvalidArg) else {
        return error;
    };
    let known = ELSEWHERE
        .iter()
        .find(|(names, _)| names.contains(&option.as_str()));
    if let (ErrorKind::UnknownArgument, Some((_, tip))) = (error.kind(), known) {
        let tips = ContextValue::StyledStrs(vec![StyledStr::from(*tip)]);
        error.remove(ContextKind::SuggestedArg);
        error.insert(ContextKind::Suggested, tips);
    }
    error
}
