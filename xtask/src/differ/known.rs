/// Differences that are intended or that are POV-Ray's: the words that the smallest scene contains, and the reason.
///
/// docs/src/differ.md explains them.
pub(super) const KNOWN: [(&[&str], &str); 3] = [
    (&["crystal.ttf"], "the fonts of POV-Ray's names are our own"),
    (
        &["cyrvetic.ttf"],
        "the fonts of POV-Ray's names are our own",
    ),
    (
        &["sky_sphere", "onion"],
        "an onion's shells jump exactly on the sky's unit sphere",
    ),
];

/// The known reason for the difference of a smallest scene, if there is one.
pub(super) fn reason(text: &str) -> Option<&'static str> {
    find(&KNOWN, text)
}

fn find(known: &[(&'static [&'static str], &'static str)], text: &str) -> Option<&'static str> {
    let has = |word: &&str| {
        text.split(|c: char| !c.is_alphanumeric() && c != '_' && c != '#' && c != '.')
            .any(|w| w == *word)
    };
    known
        .iter()
        .find(|(words, _)| words.iter().all(has))
        .map(|(_, reason)| *reason)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_words_must_be_there() {
        let known: [(&[&str], &str); 1] = [(&["crand", "finish"], "noise")];
        assert_eq!(
            find(&known, "sphere { finish { crand 0.1 } }"),
            Some("noise")
        );
        assert_eq!(find(&known, "sphere { finish { crandy 0.1 } }"), None);
    }
}
