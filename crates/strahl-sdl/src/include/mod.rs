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
    "chars.inc"
    "colors.inc"
    "consts.inc"
    "debug.inc"
    "finish.inc"
    "functions.inc"
    "glass.inc"
    "glass_old.inc"
    "golds.inc"
    "math.inc"
    "metals.inc"
    "rad_def.inc"
    "rand.inc"
    "screen.inc"
    "shapes.inc"
    "shapes2.inc"
    "shapes_old.inc"
    "shapesq.inc"
    "skies.inc"
    "stage1.inc"
    "stars.inc"
    "stdcam.inc"
    "stdinc.inc"
    "stoneold.inc"
    "stones.inc"
    "stones1.inc"
    "stones2.inc"
    "strings.inc"
    "sunpos.inc"
    "textures.inc"
    "transforms.inc"
    "woodmaps.inc"
    "woods.inc"
}

/// The text of a built-in file; capital and small letters count the same, as scenes come from Windows too.
pub(crate) fn find(name: &str) -> Option<(&'static str, &'static str)> {
    let known = FILES
        .iter()
        .find(|(file, _)| file.eq_ignore_ascii_case(name));
    known.copied()
}

/// The name that our `functions.inc` gives to an internal function by its number.
pub(crate) fn internal_function(number: u32) -> Option<&'static str> {
    let (_, text) = find("functions.inc")?;
    let body = format!("function {{ internal({number}) }}");
    let line = text.lines().find(|line| line.ends_with(&body))?;
    line.strip_prefix("#declare ")?.split(' ').next()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn internal_functions_have_their_names() {
        assert_eq!(internal_function(61), Some("f_sphere"));
        assert_eq!(internal_function(1000), None);
    }
}
