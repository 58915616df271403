//! The scenes, each with one kind of object. Both programs read the same text where POV-Ray has the object.

use anyhow::{Context, Result};
use std::path::Path;

/// A scene of the benchmark.
pub(super) struct Scene {
    pub(super) name: &'static str,
    pub(super) strahl: String,
    /// The text for POV-Ray; `None` if it does not have the object.
    pub(super) povray: Option<String>,
}

impl Scene {
    fn same(name: &'static str, text: String) -> Self {
        Self {
            name,
            strahl: text.clone(),
            povray: Some(text),
        }
    }

    /// A row of equal objects in both programs.
    fn many(name: &'static str, object: &str) -> Self {
        Self::same(name, framed(&grid(object)))
    }
}

/// The name of the scene with nothing but a floor.
pub(super) const EMPTY: &str = "empty";

/// All scenes; the first is empty, so that the others can be compared with it.
pub(super) fn all() -> Result<Vec<Scene>> {
    let mut all = vec![Scene::same(EMPTY, framed(""))];
    all.extend(teapots()?);
    all.push(Scene::same(
        "bicubic_patch, 10000 small ones",
        framed(&quilt(100)),
    ));
    all.extend(SWEEPS.map(|(name, spline)| Scene::many(name, &sweep(spline))));
    all.extend(PRISMS.map(|(name, words)| Scene::many(name, &format!("prism {{ {words} }}"))));
    all.extend(LATHES.map(|(name, words)| Scene::many(name, &format!("lathe {{ {words} }}"))));
    all.extend(OTHERS.map(|(name, object)| Scene::many(name, object)));
    all.extend(ALONE.map(|(name, object)| Scene {
        povray: None,
        ..Scene::many(name, object)
    }));
    all.push(Scene::same("height_field", framed(HEIGHTS)));
    all.push(terrain());
    Ok(all)
}

/// How finely POV-Ray divides the teapot's patches: until hardly a pixel of 640x480 differs from the smooth surface. Each step takes four
/// times the memory of the one before; the last takes half a gigabyte.
const STEPS: [(&str, &str); 4] = [
    ("bicubic_patch, one light, u_steps 5", FINE),
    (
        "bicubic_patch, one light, u_steps 6",
        "u_steps 6 v_steps 6 flatness 0",
    ),
    (
        "bicubic_patch, one light, u_steps 7",
        "u_steps 7 v_steps 7 flatness 0",
    ),
    ("bicubic_patch, one light, u_steps 8", FINEST),
];

/// The teapot of the showcase: as it is; from so near that a few patches fill the picture; and with one light and no mirrors, divided ever
/// more finely.
fn teapots() -> Result<Vec<Scene>> {
    let mut all = vec![
        Scene::same("bicubic_patch, the showcase's teapot", teapot(FINEST)?),
        Scene::same(
            "bicubic_patch, a few close up",
            plain_teapot(FINEST)?.replace("angle 40", "angle 9"),
        ),
    ];
    for (name, steps) in STEPS {
        all.push(Scene::same(name, plain_teapot(steps)?));
    }
    Ok(all)
}

/// The teapot with one light and without mirrors.
fn plain_teapot(steps: &str) -> Result<String> {
    Ok(teapot(steps)?
        .lines()
        .filter(|line| !line.trim_start().starts_with("area_light"))
        .map(|line| match line.split_once("reflection") {
            Some((before, _)) => format!("{before}}}\n"),
            None => format!("{line}\n"),
        })
        .collect())
}

/// A division of patches that shows facets at silhouettes.
pub(crate) const FINE: &str = "u_steps 5 v_steps 5 flatness 0";

/// As finely as POV-Ray can divide 32 patches in less than a gigabyte.
const FINEST: &str = "u_steps 8 v_steps 8 flatness 0";

/// The teapot of the showcase with other words for how finely it is divided.
pub(crate) fn teapot(steps: &str) -> Result<String> {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes/showcase/teapot.pov");
    let text = std::fs::read_to_string(&file)
        .with_context(|| format!("cannot read {}", file.display()))?;
    Ok(text.replace("u_steps 4 v_steps 4", steps))
}

/// Camera, light, background and floor.
fn framed(objects: &str) -> String {
    format!(
        "#version 3.7;\n\
         global_settings {{ assumed_gamma 1 max_trace_level 3 }}\n\
         camera {{ location <0, 7, -9> right x * image_width / image_height look_at 0 angle 60 }}\n\
         light_source {{ <-20, 30, -25> rgb 1 }}\n\
         background {{ rgb <0.3, 0.4, 0.6> }}\n\
         plane {{ y, -1 pigment {{ rgb 0.7 }} }}\n\
         #default {{ pigment {{ rgb <0.8, 0.5, 0.2> }} finish {{ phong 0.4 }} }}\n\
         {objects}"
    )
}

/// Thirty-five equal objects in five rows, each turned another way.
fn grid(object: &str) -> String {
    format!(
        "#declare Object = {object}\n#declare I = 0;\n#while (I < 35)\n\
         object {{ Object rotate <11 * I, 37 * I, 0> translate <(mod(I, 7) - 3) * 2.2, 0, (int(I / 7) - 2) * 2.2> }}\n\
         #declare I = I + 1;\n#end\n"
    )
}

/// A wavy sheet of `side` by `side` patches, each of them a few pixels wide.
fn quilt(side: u32) -> String {
    format!(
        "#declare Side = {side};\n#declare P = array[16]\n\
         #macro Point(I, J) <I / Side * 10 - 5, 0.4 * sin(I * 0.21) * cos(J * 0.17), J / Side * 10 - 5> #end\n\
         #declare A = 0;\n#while (A < Side)\n#declare B = 0;\n#while (B < Side)\n\
         bicubic_patch {{ type 1 {FINE}\n\
         #declare K = 0;\n#while (K < 16) Point(A + mod(K, 4) / 3, B + int(K / 4) / 3) #declare K = K + 1; #end }}\n\
         #declare B = B + 1;\n#end\n#declare A = A + 1;\n#end\n"
    )
}

const SWEEPS: [(&str, &str); 3] = [
    ("sphere_sweep, linear", "linear_spline"),
    ("sphere_sweep, b_spline", "b_spline"),
    ("sphere_sweep, cubic", "cubic_spline"),
];

fn sweep(spline: &str) -> String {
    format!(
        "sphere_sweep {{ {spline} 6,\n\
         <-0.9, 0, -0.7>, 0.2, <-0.6, 0.2, 0.6>, 0.3, <0, -0.3, -0.5>, 0.15, <0.2, 0.6, 0.1>, 0.25, <0.7, -0.1, 0.5>, 0.2, <0.9, 0.3, -0.6>, 0.1 }}"
    )
}

const PRISMS: [(&str, &str); 5] = [
    (
        "prism, linear",
        "linear_spline 0, 0.7, 11, <0, 1>, <0.25, 0.35>, <0.95, 0.3>, <0.4, -0.12>, <0.6, -0.8>, <0, -0.4>, <-0.6, -0.8>, <-0.4, -0.12>, <-0.95, 0.3>, <-0.25, 0.35>, <0, 1>",
    ),
    (
        "prism, quadratic",
        "quadratic_spline 0, 0.7, 12, <-0.25, 0.35>, <0, 1>, <0.25, 0.35>, <0.95, 0.3>, <0.4, -0.12>, <0.6, -0.8>, <0, -0.4>, <-0.6, -0.8>, <-0.4, -0.12>, <-0.95, 0.3>, <-0.25, 0.35>, <0, 1>",
    ),
    (
        "prism, cubic",
        "cubic_spline 0, 0.7, 13, <-0.25, 0.35>, <0, 1>, <0.25, 0.35>, <0.95, 0.3>, <0.4, -0.12>, <0.6, -0.8>, <0, -0.4>, <-0.6, -0.8>, <-0.4, -0.12>, <-0.95, 0.3>, <-0.25, 0.35>, <0, 1>, <0.25, 0.35>",
    ),
    (
        "prism, bezier",
        "bezier_spline 0, 0.7, 8, <0, 1>, <0.2, 0.3>, <0.9, 0.1>, <0, -0.9>, <0, -0.9>, <-0.9, 0.1>, <-0.2, 0.3>, <0, 1>",
    ),
    (
        "prism, conic",
        "linear_spline conic_sweep 0.2, 1, 11, <0, 1>, <0.25, 0.35>, <0.95, 0.3>, <0.4, -0.12>, <0.6, -0.8>, <0, -0.4>, <-0.6, -0.8>, <-0.4, -0.12>, <-0.95, 0.3>, <-0.25, 0.35>, <0, 1>",
    ),
];

const LATHES: [(&str, &str); 4] = [
    (
        "lathe, linear",
        "linear_spline 6, <0, -0.8>, <0.7, -0.6>, <0.3, -0.1>, <0.8, 0.2>, <0.2, 0.5>, <0, 0.9>",
    ),
    (
        "lathe, quadratic",
        "quadratic_spline 7, <0, -1>, <0, -0.8>, <0.7, -0.6>, <0.3, -0.1>, <0.8, 0.2>, <0.2, 0.5>, <0, 0.9>",
    ),
    (
        "lathe, cubic",
        "cubic_spline 8, <0, -1>, <0, -0.8>, <0.7, -0.6>, <0.3, -0.1>, <0.8, 0.2>, <0.2, 0.5>, <0, 0.9>, <0, 1>",
    ),
    (
        "lathe, bezier",
        "bezier_spline 8, <0, -0.8>, <0.9, -0.8>, <0.8, -0.3>, <0.4, 0>, <0.4, 0>, <0, 0.3>, <0.9, 0.8>, <0, 0.9>",
    ),
];

const OTHERS: [(&str, &str); 10] = [
    (
        "sor",
        "sor { 6, <0.2, -1>, <0.6, -0.8>, <0.4, -0.1>, <0.8, 0.3>, <0.3, 0.8>, <0.1, 1> }",
    ),
    ("ovus", "ovus { 0.75, 0.42 translate -0.2 * y }"),
    ("superellipsoid", "superellipsoid { <0.4, 0.25> }"),
    (
        "julia_fractal, quaternion",
        "julia_fractal { <-0.083, 0, -0.83, -0.025> quaternion sqr max_iteration 8 precision 20 }",
    ),
    (
        "julia_fractal, cubes",
        "julia_fractal { <-0.1, 0.4, 0.5, 0.2> quaternion cube max_iteration 8 precision 20 }",
    ),
    (
        "julia_fractal, hypercomplex",
        "julia_fractal { <-0.2, 0.4, 0.3, 0.1> hypercomplex sqr max_iteration 8 precision 20 }",
    ),
    ("torus", "torus { 0.7, 0.3 }"),
    (
        "blob",
        "blob { threshold 0.5 sphere { <0.3, 0.2, 0>, 0.8, 1 } sphere { <-0.4, 0, 0.2>, 0.7, 1 } cylinder { <-0.5, -0.3, 0>, <0.5, 0.4, 0.4>, 0.4, 1 } }",
    ),
    // The lemniscate of Gerono, turned about its axis.
    (
        "quartic",
        "quartic { <1,0,0,0,0,0,0,0,0,-1,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,1,0,0,0,0,0,0,1,0,0> }",
    ),
    (
        "isosurface",
        "isosurface { function { x*x + y*y + z*z - 0.6 + 0.1 * sin(7*x) * sin(7*y) * sin(7*z) } max_gradient 4 contained_by { box { -1, 1 } } }",
    ),
];

/// What POV-Ray 3.7 does not have: `lemon` came with version 3.8, the others are extensions.
const ALONE: [(&str, &str); 3] = [
    ("lemon", "lemon { <0, -0.9, 0>, 0, <0, 0.9, 0>, 0.2, 1.1 }"),
    ("mandelbulb", "mandelbulb { 8 scale 0.8 }"),
    ("menger", "menger { -0.8, 0.8, 6 }"),
];

/// A height field of a function of both programs.
const HEIGHTS: &str = "height_field { function 256, 256 { 0.5 + 0.2 * sin(31 * x) * cos(27 * y) + 0.15 * sin(83 * x + 3 * cos(40 * y)) }\n\
     translate <-0.5, 0, -0.5> scale <12, 2, 12> translate -0.5 * y }\n";

/// A ridged terrain of eight octaves, which is an isosurface in POV-Ray. It has no prover, and its greatest gradient says that a larger
/// one was needed.
fn terrain() -> Scene {
    let head = "#version 3.7;\n#include \"functions.inc\"\nglobal_settings { assumed_gamma 1 noise_generator 2 }\n\
        camera { location <0, 3.2, -6> right x * image_width / image_height look_at <0, 1, 3> angle 60 }\n\
        light_source { <-30, 25, -20> rgb 1 }\n";
    let strahl = "terrain { ridged h 0.9 lacunarity 2.1 octaves 8 offset 1 gain 2 noise_generator 2 extent <-8, -8>, <8, 8> pigment { rgb <0.6, 0.5, 0.4> } }\n";
    let povray = "isosurface { function { y - f_ridged_mf(x, 0, z, 0.9, 2.1, 8, 1, 2, 2) } max_gradient 15 contained_by { box { <-8, -0.1, -8>, <8, 3, 8> } } pigment { rgb <0.6, 0.5, 0.4> } }\n";
    Scene {
        name: "terrain (isosurface in POV-Ray)",
        strahl: format!("{head}{strahl}"),
        povray: Some(format!("{head}{povray}")),
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn scenes_have_names_of_their_own() {
        let all = super::all().expect("the teapot is there");
        let names: std::collections::BTreeSet<_> = all.iter().map(|s| s.name).collect();
        assert_eq!(names.len(), all.len());
    }
}
