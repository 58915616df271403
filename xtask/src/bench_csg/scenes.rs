//! Benchmark scenes in the language both programs read. Each stresses one part of CSG.

/// A scene of the benchmark.
pub(super) struct Scene {
    pub(super) name: &'static str,
    pub(super) text: String,
}

/// All scenes, the simplest first.
pub(super) fn all() -> Vec<Scene> {
    let scene = |name, eye: [f64; 3], objects: String| Scene {
        name,
        text: framed(eye, &objects),
    };
    vec![
        scene("10 holes", [0.0, 9.0, -9.0], plate(5, 2)),
        scene("100 holes", [0.0, 9.0, -9.0], plate(10, 10)),
        scene("1000 holes", [0.0, 9.0, -9.0], plate(40, 25)),
        scene("200 holes, grazing", [0.0, 1.3, -11.0], plate(20, 10)),
        scene("500 bubbles", [7.0, 8.0, -9.0], bubbles()),
        scene("150 merged", [0.0, 7.0, -10.0], merged()),
        scene("nested 8 deep", [0.0, 8.0, -9.0], nested()),
        scene("2500 lenses", [0.0, 9.0, -9.0], lenses()),
        scene("dice", [0.0, 9.0, -9.0], dice()),
        scene("torus groove", [3.0, 7.0, -8.0], grooves()),
        scene("blob hollow", [0.0, 7.0, -10.0], hollows()),
    ]
}

/// Camera, two lights and a floor.
fn framed([x, y, z]: [f64; 3], objects: &str) -> String {
    format!(
        "#version 3.7;\n\
         global_settings {{ assumed_gamma 1 max_trace_level 6 adc_bailout 1/255 }}\n\
         camera {{ location <{x}, {y}, {z}> right x up y angle 55 look_at 0 }}\n\
         light_source {{ <-20, 30, -25> rgb 0.8 }}\n\
         light_source {{ <25, 20, -5> rgb 0.4 }}\n\
         background {{ rgb <0.3, 0.4, 0.6> }}\n\
         plane {{ y, -3 pigment {{ rgb 0.7 }} }}\n\
         {objects}"
    )
}

/// A plate with a grid of holes.
fn plate(columns: u32, rows: u32) -> String {
    format!(
        "#declare NX = {columns}; #declare NZ = {rows};\n\
         difference {{\n  box {{ <-6, -0.5, -6>, <6, 0.5, 6> }}\n\
         #declare I = 0;\n#while (I < NX)\n  #declare K = 0;\n  #while (K < NZ)\n\
         cylinder {{ <(I + 0.5) / NX * 12 - 6, -1, (K + 0.5) / NZ * 12 - 6>, \
         <(I + 0.5) / NX * 12 - 6, 1, (K + 0.5) / NZ * 12 - 6>, 4 / max(NX, NZ) }}\n\
         #declare K = K + 1;\n  #end\n  #declare I = I + 1;\n#end\n\
         pigment {{ rgb <0.9, 0.6, 0.2> }} finish {{ phong 0.5 reflection 0.1 }} }}\n"
    )
}

/// A block minus many spheres: rays pass through many of them before they hit something.
fn bubbles() -> String {
    "#declare R = seed(5);\n\
     difference {\n  box { -4, 4 }\n#declare I = 0;\n#while (I < 500)\n\
     sphere { <rand(R), rand(R), rand(R)> * 8.4 - 4.2, 0.4 + 0.5 * rand(R) }\n\
     #declare I = I + 1;\n#end\n  pigment { rgb <0.8, 0.8, 0.5> } }\n"
        .to_owned()
}

/// Glass drops that are merged.
fn merged() -> String {
    "#declare R = seed(8);\n\
     merge {\n#declare I = 0;\n#while (I < 150)\n\
     sphere { <rand(R) * 10 - 5, rand(R) * 2 - 1, rand(R) * 10 - 5>, 0.45 + 0.45 * rand(R) }\n\
     #declare I = I + 1;\n#end\n\
     pigment { rgbf <0.8, 0.95, 0.9, 0.8> } finish { phong 0.5 } interior { ior 1.3 } }\n"
        .to_owned()
}

/// Deep nesting: every level subtracts from or adds to the level below.
fn nested() -> String {
    "#declare Body = sphere { 0, 1 }\n\
     #declare I = 1;\n#while (I <= 8)\n  #declare A = I * 137;\n\
     #if (mod(I, 2))\n\
     #declare Body = difference { object { Body } cylinder { -2 * y, 2 * y, 0.17 rotate <70, A, 0> \
     translate <0.2, 0, 0.1> } }\n\
     #else\n\
     #declare Body = intersection { merge { object { Body } sphere { <0.8, 0, 0>, 0.35 rotate A * y } } \
     box { <-1.3, -0.95 + 0.03 * I, -1.3>, <1.3, 1, 1.3> rotate 3 * I * z } }\n\
     #end\n  #declare I = I + 1;\n#end\n\
     #declare I = 0;\n#while (I < 25)\n\
     object { Body rotate I * 31 * y translate <mod(I, 5) * 2.6 - 5.2, 0, floor(I / 5) * 2.6 - 5.2> \
     pigment { rgb <0.3, 0.7, 0.9> } finish { phong 0.4 } }\n\
     #declare I = I + 1;\n#end\n"
        .to_owned()
}

/// Small lenses of glass.
fn lenses() -> String {
    "#declare I = 0;\n#while (I < 50)\n  #declare K = 0;\n  #while (K < 50)\n\
     intersection { sphere { -0.12 * y, 0.17 } sphere { 0.12 * y, 0.17 }\n\
     rotate <K * 7, 0, I * 11> translate <I * 0.26 - 6.4, 0, K * 0.26 - 6.4>\n\
     pigment { rgbf <0.95, 0.98, 1, 0.9> } finish { phong 0.3 } interior { ior 1.5 } }\n\
     #declare K = K + 1;\n  #end\n  #declare I = I + 1;\n#end\n"
        .to_owned()
}

/// Boxes rounded by a sphere, with a hole: small trees, as most scenes have.
fn dice() -> String {
    "#declare I = 0;\n#while (I < 20)\n  #declare K = 0;\n  #while (K < 20)\n\
     difference { intersection { box { -0.24, 0.24 } sphere { 0, 0.33 } } cylinder { -y, y, 0.1 }\n\
     rotate <K * 7, I * 13, I * 11> translate <I * 0.62 - 5.9, 0, K * 0.62 - 5.9>\n\
     pigment { rgb <0.9, 0.3, 0.25> } finish { phong 0.4 reflection 0.1 } }\n\
     #declare K = K + 1;\n  #end\n  #declare I = I + 1;\n#end\n"
        .to_owned()
}

/// Expensive shapes among cheap ones: for most rays the cheap ones decide, and no torus needs to be tested.
fn grooves() -> String {
    "difference {\n  box { <-5, -1, -5>, <5, 0, 5> }\n\
     #declare I = 0;\n#while (I < 9)\n\
     torus { 1.2, 0.3 translate <mod(I, 3) * 3.2 - 3.2, 0, floor(I / 3) * 3.2 - 3.2> }\n\
     #declare I = I + 1;\n#end\n  pigment { rgb <0.5, 0.8, 0.4> } finish { phong 0.5 } }\n"
        .to_owned()
}

/// The same with blobs, as minuend and as subtrahend.
fn hollows() -> String {
    "#declare Drop = blob { threshold 0.5\n\
     #declare I = 0;\n#while (I < 8)\n\
     sphere { <cos(I * 0.785), 0.2 * sin(I * 3), sin(I * 0.785)> * 0.8, 0.9, 1 }\n\
     #declare I = I + 1;\n#end\n}\n\
     difference { box { <-5.5, -1, -2.5>, <0, 0.2, 2.5> }\n\
     object { Drop translate <-4, 0.2, -1> } object { Drop translate <-1.6, 0.2, 1> }\n\
     pigment { rgb <0.8, 0.5, 0.7> } finish { phong 0.5 } }\n\
     intersection { object { Drop scale 2 translate <3, 0, 0> } box { <0, -2, -3>, <6, 0.3, 3> }\n\
     sphere { <3, 0, 0>, 2.3 } pigment { rgb <0.9, 0.8, 0.3> } }\n"
        .to_owned()
}

#[cfg(test)]
mod tests {
    #[test]
    fn scenes_have_names_of_their_own() {
        let names: std::collections::BTreeSet<_> = super::all().iter().map(|s| s.name).collect();
        assert_eq!(names.len(), super::all().len());
    }
}
