//! The include files that are built in: our own library, compatible by name with POV-Ray's.
//!
//! Files of the user with the same name win; see [`Host`](crate::Host).

macro_rules! built_in {
    ($($name:literal)*) => {
        /// Name and text of each built-in file.
        pub(crate) const FILES: &[(&str, &str)] =
            &[$(($name, include_str!(concat!("../../include/", $name)))),*];
    };
}

built_in! {
    "arrays.inc"
    "colors.inc"
    "consts.inc"
    "debug.inc"
    "functions.inc"
    "math.inc"
    "rad_def.inc"
    "rand.inc"
    "strings.inc"
    "transforms.inc"
}

/// The text of a built-in file; capital and small letters count the same, as scenes come from Windows too.
pub(crate) fn find(name: &str) -> Option<(&'static str, &'static str)> {
    let known = FILES
        .iter()
        .find(|(file, _)| file.eq_ignore_ascii_case(name));
    known.copied()
}
