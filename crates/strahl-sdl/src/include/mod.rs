//! The built-in include files: our own library, with the names of POV-Ray's.
//!
//! A user's file with the same name takes precedence; see [`Host`](crate::Host).

use crate::keywords::Word;
use crate::suggest::Candidate;
use std::sync::LazyLock;

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

/// The text of a built-in file; case is ignored, because scenes come from Windows too.
pub(crate) fn find(name: &str) -> Option<(&'static str, &'static str)> {
    let known = FILES
        .iter()
        .find(|(file, _)| file.eq_ignore_ascii_case(name));
    known.copied()
}

/// The text of a built-in include file, as it is read where no file of the user's has the name; case is ignored.
///
/// ```
/// assert!(strahl_sdl::built_in("colors.inc").is_some_and(|text| text.contains("Red")));
/// assert!(strahl_sdl::built_in("ball.inc").is_none());
/// ```
pub fn built_in(name: &str) -> Option<&'static str> {
    find(name).map(|(_, text)| text)
}

/// The name that our `functions.inc` gives to the internal function with this number.
pub(crate) fn internal_function(number: u32) -> Option<&'static str> {
    let (_, text) = find("functions.inc")?;
    let body = format!("function {{ internal({number}) }}");
    let line = text.lines().find(|line| line.ends_with(&body))?;
    line.strip_prefix("#declare ")?.split(' ').next()
}

/// All names that the built-in files declare, sorted, with the first file that does.
static DECLARED: LazyLock<Vec<(&str, &str)>> = LazyLock::new(|| {
    let files = FILES.iter().enumerate();
    let mut names: Vec<(&str, usize, &str)> = files
        .flat_map(|(order, (file, text))| declared_in(text).map(move |name| (name, order, *file)))
        .collect();
    names.sort_unstable();
    names.dedup_by_key(|(name, ..)| *name);
    names
        .into_iter()
        .map(|(name, _, file)| (name, file))
        .collect()
});

/// A candidate for a misspelt name, with the built-in file that declares it.
type Known<'a> = (Candidate<'a>, Option<&'static str>);

/// All keywords.
static WORDS: LazyLock<Vec<Known<'static>>> = LazyLock::new(|| {
    let words = Word::ALL.iter();
    words
        .map(|(_, text, _)| (Candidate::new(text), None))
        .collect()
});

/// All names that the built-in files declare, each with the first file that does.
static NAMES: LazyLock<Vec<Known<'static>>> = LazyLock::new(|| {
    let names = DECLARED.iter();
    names
        .map(|(name, file)| (Candidate::new(name), Some(*file)))
        .collect()
});

/// The keywords, as candidates for a misspelt name.
pub(crate) fn known_words<'a>() -> impl Iterator<Item = Known<'a>> {
    WORDS.iter().map(|&(known, file)| (known, file))
}

/// The names in built-in files, as candidates for a misspelt name.
pub(crate) fn known_names<'a>() -> impl Iterator<Item = Known<'a>> {
    NAMES.iter().map(|&(known, file)| (known, file))
}

/// The first built-in file that declares a name.
pub(crate) fn declaring(name: &str) -> Option<&'static str> {
    let found = DECLARED.binary_search_by_key(&name, |(known, _)| known);
    let entry = found.ok().and_then(|index| DECLARED.get(index));
    entry.map(|(_, file)| *file)
}

/// The names that a text declares.
fn declared_in(text: &str) -> impl Iterator<Item = &str> {
    text.split('#').skip(1).filter_map(|piece| {
        let mut words = piece.split(|c: char| !c.is_ascii_alphanumeric() && c != '_');
        let directive = words.next()?;
        matches!(directive, "declare" | "macro")
            .then(|| words.find(|w| !w.is_empty()))
            .flatten()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn declarations_are_found_in_a_text() {
        let text = "// x\n#declare Red = rgb x;\n#macro Ball (R) #local N = 1; #end";
        assert_eq!(declared_in(text).collect::<Vec<_>>(), ["Red", "Ball"]);
        assert_eq!(declaring("Red"), Some("colors.inc"));
        assert_eq!(declaring("Readd"), None);
    }

    #[test]
    fn internal_functions_have_their_names() {
        assert_eq!(internal_function(61), Some("f_sphere"));
        assert_eq!(internal_function(1000), None);
    }
}
