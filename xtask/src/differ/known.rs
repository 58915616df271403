/// Differences that are intended or that are POV-Ray's: the words that the smallest scene contains, and the reason.
///
/// docs/src/differ.md explains them.
pub(super) const KNOWN: [(&[&str], &str); 62] = [
    (&["crystal.ttf"], FONTS),
    (&["cyrvetic.ttf"], FONTS),
    (&["timrom.ttf"], FONTS),
    (&["polygon", "triangular"], CELLS),
    (&["polygon", "square"], CELLS),
    (&["bicubic_patch"], "POV-Ray shows triangles"),
    (&["prism", "interior_texture"], INSIDES),
    (&["lathe", "interior_texture"], INSIDES),
    (&["sor", "interior_texture"], INSIDES),
    (&["text", "interior_texture"], INSIDES),
    (&["triangle", "interior_texture"], INSIDES),
    (&["mesh", "interior_texture", "inverse"], TURNED),
    (&["mesh2", "interior_texture", "inverse"], TURNED),
    (&["quadric", "interior_texture", "inverse"], NOT_TURNED),
    (&["quadric", "interior_texture", "difference"], NOT_TURNED),
    (&["quadric", "interior_texture", "merge"], NOT_TURNED),
    (
        &["cylindrical", "phase"],
        "the pattern jumps at radius 1, which surfaces of radius 1 touch",
    ),
    (&["smooth_triangle", "interior_texture"], INTERPOLATED),
    (&["normal_vectors", "interior_texture"], INTERPOLATED),
    (&["union", "inverse", "intersection"], BOXES),
    (&["union", "inverse", "difference"], BOXES),
    (&["merge", "inverse", "intersection"], BOXES),
    (&["merge", "inverse", "difference"], BOXES),
    (&["merge", "inverse", "fog"], BOXES),
    (&["merge", "inverse", "rainbow"], BOXES),
    (&["merge", "inverse", "ior"], BOXES),
    (&["union", "height_field", "intersection"], UNIONS),
    (&["union", "height_field", "difference"], UNIONS),
    (&["number_of_waves", "waves", "function"], WAVES),
    (&["number_of_waves", "ripples", "function"], WAVES),
    (&["disc", "intersection"], DISCS),
    (&["disc", "difference"], DISCS),
    (&["clipped_by", "inverse", "intersection"], BOXES),
    (&["clipped_by", "inverse", "difference"], BOXES),
    (&["isosurface", "intersection"], CAPS),
    (&["isosurface", "difference"], CAPS),
    (&["isosurface", "merge"], CAPS),
    (&["isosurface", "clipped_by"], CAPS),
    (
        &["split_union", "no_image"],
        "POV-Ray's camera rays see parts with no_image of such a union until they pass something",
    ),
    (
        &["image_map", "once", "conserve_energy"],
        "POV-Ray's reflection takes no light from what passes beside an image",
    ),
    (&["smooth_triangle", "matrix"], SIDES),
    (&["smooth_triangle", "scale"], SIDES),
    (&["mesh", "intersection"], OPEN_MESHES),
    (&["mesh", "difference"], OPEN_MESHES),
    (&["mesh", "merge"], OPEN_MESHES),
    (&["mesh2", "intersection"], OPEN_MESHES),
    (&["mesh2", "difference"], OPEN_MESHES),
    (&["mesh2", "merge"], OPEN_MESHES),
    (
        &["parametric", "accuracy", "clipped_by"],
        "POV-Ray's parametric surfaces lie beside themselves by their accuracy",
    ),
    (&["parametric", "rgbt"], MISSED),
    (&["parametric", "rgbf"], MISSED),
    (&["parametric", "rgbft"], MISSED),
    (&["parametric", "transmit"], MISSED),
    (&["parametric", "filter"], MISSED),
    (&["sor", "light_source"], SPECKLES),
    (&["sphere_sweep", "rgbt"], JOINTS),
    (&["sphere_sweep", "rgbf"], JOINTS),
    (&["sphere_sweep", "transmit"], JOINTS),
    (&["sphere_sweep", "filter"], JOINTS),
    (
        &["bump_map", "no_bump_scale"],
        "POV-Ray turns the normal of a scaled bump map with no_bump_scale away from the viewer",
    ),
    (
        &["sky_sphere", "onion"],
        "an onion's shells jump exactly on the sky's unit sphere",
    ),
    (
        &["sky_sphere", "spherical"],
        "the pattern is 0 exactly on the sky's unit sphere",
    ),
];

const MISSED: &str = "POV-Ray misses parts of a parametric surface behind others of it";
const SPECKLES: &str = "a surface of revolution shadows itself here and there in POV-Ray";
const JOINTS: &str = "POV-Ray shows discs within a curved sphere_sweep";
const FONTS: &str = "the fonts of POV-Ray's names are others";
const CELLS: &str = "a polygon lies exactly between two layers of cells";
const SIDES: &str =
    "POV-Ray looks again after transformations whether the normals stand on one side";
const INSIDES: &str = "POV-Ray's inside of the surface depends on the order of the points";
const INTERPOLATED: &str = "POV-Ray decides by the interpolated normal which side is seen";
const TURNED: &str = "POV-Ray turns the sides of an inverse mesh without an inside";
const NOT_TURNED: &str = "POV-Ray does not turn the sides of an inverse quadric";
const BOXES: &str = "POV-Ray's inverse solids end with their boxes in CSG";
const DISCS: &str =
    "in CSG a disc is a half-space: POV-Ray hides what a ray sees of it beyond the disc's box";
const UNIONS: &str = "in POV-Ray a height field in a union in CSG ends with its box";
const WAVES: &str =
    "POV-Ray takes 10 waves while it reads a scene, and the last number for all of it";
const CAPS: &str = "POV-Ray does not close an isosurface at the far side of its container";
const OPEN_MESHES: &str = "POV-Ray misses faces of meshes behind other faces in CSG";

/// The known reason for the difference of a smallest scene, if there is one.
pub(super) fn reason(text: &str) -> Option<&'static str> {
    if let Some(reason) = find(&KNOWN, text) {
        return Some(reason);
    }
    if repeats_an_operand(text) {
        return Some("two operands have the same surface: rounding decides");
    }
    if averages_nothing(text) {
        return Some("the weights of an average are 0: POV-Ray divides 0 by 0");
    }
    divides_constants(text)
        .then_some("POV-Ray divides constants in brackets by the product of what follows")
}

/// Whether a function divides a bracket without variables by a number, and multiplies or divides the result.
fn divides_constants(text: &str) -> bool {
    text.match_indices(")/").any(|(close, _)| {
        let behind = text[close + 2..].trim_start_matches(|c: char| c.is_ascii_digit() || c == '.');
        let goes_on = behind.trim_start().starts_with(['*', '/']);
        let mut depth = 0;
        let open = text[..=close].rfind(|c| {
            depth += i32::from(c == ')') - i32::from(c == '(');
            depth == 0
        });
        goes_on && open.is_some_and(|open| !text[open..close].contains(char::is_alphabetic))
    })
}

/// Whether all weights of an average are 0.
fn averages_nothing(text: &str) -> bool {
    text.match_indices("average").any(|(at, _)| {
        let Some(map) = text[at..].find("_map {").map(|map| &text[at + map + 6..]) else {
            return false;
        };
        let mut rest = map.trim_start();
        while let Some(entry) = rest.strip_prefix('[') {
            let weight = entry.split_whitespace().next();
            let mut depth = 1;
            let end = entry.find(|c| {
                depth += i32::from(c == '[') - i32::from(c == ']');
                depth == 0
            });
            match (weight.and_then(|w| w.parse::<f64>().ok()), end) {
                (Some(0.0), Some(end)) => rest = entry[end + 1..].trim_start(),
                _ => return false,
            }
        }
        rest.len() < map.trim_start().len()
    })
}

/// Whether an operation has an operand twice: the same word with the same numbers, written on one line.
fn repeats_an_operand(text: &str) -> bool {
    let combines = ["intersection", "difference", "merge"]
        .iter()
        .any(|operation| text.contains(operation));
    let operands: Vec<&str> = SOLIDS
        .iter()
        .flat_map(|solid| {
            text.match_indices(solid).filter_map(|(at, _)| {
                let rest = &text[at..];
                let start = rest.find('{')? + 1;
                let numbers = rest[start..].find(|c: char| c.is_alphabetic() || c == '}')?;
                Some(rest[..start + numbers].trim_end())
            })
        })
        .collect();
    combines
        && operands
            .iter()
            .enumerate()
            .any(|(i, operand)| operands[..i].contains(operand))
}

/// The solids with few parameters, of which random scenes repeat one by chance.
const SOLIDS: [&str; 6] = [
    "sphere {",
    "box {",
    "plane {",
    "cylinder {",
    "cone {",
    "torus {",
];

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

    #[test]
    fn averages_without_weight_are_seen() {
        for text in [
            "pigment { average pigment_map { [ 0 rgb 1 ] } }",
            "average normal_map { [0 dents] [ 0.0 gradient x slope_map { [ 1 <0, 1> ] } ] }",
        ] {
            assert!(averages_nothing(text), "{text}");
        }
        for text in [
            "pigment { average pigment_map { [ 0 rgb 1 ] [ 0.1 rgb 1 ] } }",
            "gradient x pigment_map { [ 0 rgb 1 ] }",
            "average pigment_map { }",
        ] {
            assert!(!averages_nothing(text), "{text}");
        }
    }

    #[test]
    fn divided_constants_are_seen() {
        for text in [
            "sin( floor( ( 1 ) *3)/3 *3)",
            "(1)/4/.5",
            "max(1, .5)/4 * 2",
        ] {
            assert!(divides_constants(text), "{text}");
        }
        for text in [
            "floor( ( x ) *3)/3 *3",
            "floor(1)/4 + 1",
            "(1)*4/8",
            "1)/3*3",
        ] {
            assert!(!divides_constants(text), "{text}");
        }
    }

    #[test]
    fn operands_that_repeat_are_seen() {
        let twice = "intersection { sphere { 0, 1 } sphere { 0, 1 pigment { rgb 1 } } }";
        assert!(repeats_an_operand(twice));
        assert!(!repeats_an_operand(
            "intersection { sphere { 0, 1 } sphere { 0, 2 } }"
        ));
        assert!(!repeats_an_operand(
            "union { sphere { 0, 1 } sphere { 0, 1 } }"
        ));
    }
}
