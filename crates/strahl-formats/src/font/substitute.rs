/// Replacement families for a font, best first, as file names without folder.
///
/// The first ones have the same letter widths as the font they replace, so that texts keep their length.
const FAMILIES: &[(&[&str], Styles)] = &[
    (
        &[
            "arial",
            "helvetica",
            "verdana",
            "tahoma",
            "sans",
            "cyrvetic",
            "calibri",
            "segoe",
        ],
        SANS,
    ),
    (&["cour", "mono", "consol", "fixed", "lucon"], MONO),
    (
        &[
            "times", "timrom", "georgia", "palatino", "garamond", "serif", "roman",
        ],
        SERIF,
    ),
];

/// The files of a family: regular, bold, italic, bold and italic.
type Styles = [&'static [&'static str]; 4];

const SANS: Styles = [
    &[
        "LiberationSans-Regular.ttf",
        "Arial.ttf",
        "arial.ttf",
        "DejaVuSans.ttf",
    ],
    &[
        "LiberationSans-Bold.ttf",
        "Arial Bold.ttf",
        "arialbd.ttf",
        "DejaVuSans-Bold.ttf",
    ],
    &[
        "LiberationSans-Italic.ttf",
        "Arial Italic.ttf",
        "ariali.ttf",
        "DejaVuSans-Oblique.ttf",
    ],
    &[
        "LiberationSans-BoldItalic.ttf",
        "Arial Bold Italic.ttf",
        "arialbi.ttf",
        "DejaVuSans-BoldOblique.ttf",
    ],
];
const SERIF: Styles = [
    &[
        "LiberationSerif-Regular.ttf",
        "Times New Roman.ttf",
        "times.ttf",
        "DejaVuSerif.ttf",
    ],
    &[
        "LiberationSerif-Bold.ttf",
        "Times New Roman Bold.ttf",
        "timesbd.ttf",
        "DejaVuSerif-Bold.ttf",
    ],
    &[
        "LiberationSerif-Italic.ttf",
        "Times New Roman Italic.ttf",
        "timesi.ttf",
        "DejaVuSerif-Italic.ttf",
    ],
    &[
        "LiberationSerif-BoldItalic.ttf",
        "Times New Roman Bold Italic.ttf",
        "timesbi.ttf",
        "DejaVuSerif-BoldItalic.ttf",
    ],
];
const MONO: Styles = [
    &[
        "LiberationMono-Regular.ttf",
        "Courier New.ttf",
        "cour.ttf",
        "DejaVuSansMono.ttf",
    ],
    &[
        "LiberationMono-Bold.ttf",
        "Courier New Bold.ttf",
        "courbd.ttf",
        "DejaVuSansMono-Bold.ttf",
    ],
    &[
        "LiberationMono-Italic.ttf",
        "Courier New Italic.ttf",
        "couri.ttf",
        "DejaVuSansMono-Oblique.ttf",
    ],
    &[
        "LiberationMono-BoldItalic.ttf",
        "Courier New Bold Italic.ttf",
        "courbi.ttf",
        "DejaVuSansMono-BoldOblique.ttf",
    ],
];

/// Files of other fonts that can replace a missing one, best first: of the same kind (sans serif, serif, monospaced) and style
/// as its name says; serif if it says nothing.
pub fn substitutes(file: &str) -> impl Iterator<Item = &'static str> {
    let name = file.rsplit(['/', '\\']).next().unwrap_or(file);
    let name = name.to_ascii_lowercase();
    let stem = name.split('.').next().unwrap_or_default();
    let known = FAMILIES
        .iter()
        .find(|(words, _)| words.iter().any(|word| stem.contains(word)));
    let styles = known.map_or(SERIF, |(_, styles)| *styles);
    // Windows' files end in `b`, `bd`, `bi`, `z` or `i`: timesbi.ttf, ariali.ttf.
    let bold = stem.contains("bold") || ["bd", "bi", "z"].iter().any(|end| stem.ends_with(end));
    let italic = ["italic", "oblique"].iter().any(|word| stem.contains(word))
        || ["bi", "z"].iter().any(|end| stem.ends_with(end))
        || known.is_some() && stem.ends_with('i') && !stem.ends_with("bi");
    let [regular, heavy, slanted, both] = styles;
    let (first, then) = match (bold, italic) {
        (false, false) => (regular, regular),
        (true, false) => (heavy, regular),
        (false, true) => (slanted, regular),
        (true, true) => (both, regular),
    };
    let then = then.iter().filter(move |file| !first.contains(file));
    first.iter().chain(then).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn first(name: &str) -> &'static str {
        substitutes(name).next().unwrap()
    }

    #[test]
    fn fonts_of_the_same_kind_and_style_come_first() {
        assert_eq!(first("arial.ttf"), "LiberationSans-Regular.ttf");
        assert_eq!(
            first("C:\\Windows\\Fonts\\arialbd.ttf"),
            "LiberationSans-Bold.ttf"
        );
        assert_eq!(first("timesi.ttf"), "LiberationSerif-Italic.ttf");
        assert_eq!(first("fonts/TimesBI.TTF"), "LiberationSerif-BoldItalic.ttf");
        assert_eq!(first("cour.ttf"), "LiberationMono-Regular.ttf");
        assert_eq!(first("anything.ttf"), "LiberationSerif-Regular.ttf");
        assert_eq!(first(""), "LiberationSerif-Regular.ttf");
        let all: Vec<_> = substitutes("arialbd.ttf").collect();
        assert!(all.contains(&"DejaVuSans-Bold.ttf") && all.contains(&"DejaVuSans.ttf"));
        assert!((1..all.len()).all(|i| !all[..i].contains(&all[i])));
    }
}
