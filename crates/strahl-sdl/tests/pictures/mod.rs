//! Small pictures, rendered by POV-Ray 3.7 and by strahl: lights, cameras, fog, global settings, bounds and what random scenes have shown.
//!
//! Both write linear values. Only single pixels at the edges of objects and shadows differ.

mod bounds;
mod cameras;
mod found;
mod lights;
mod reading;
mod world;

/// Objects for the lights and cameras.
const THINGS: &str = "
plane { y, -1 pigment { rgb <0.8, 0.7, 0.6> } finish { ambient 0.05 diffuse 0.8 } }
sphere { <-0.9, 0, 0.5>, 1 pigment { rgb <0.9, 0.2, 0.1> } finish { ambient 0.1 diffuse 0.7 phong 0.6 phong_size 20 } }
sphere { <1.1, -0.4, -0.5>, 0.6 pigment { rgb <0.2, 0.4, 0.9> } finish { diffuse 0.6 reflection 0.3 } }
sphere { <0.4, 0.7, 1.5>, 0.5 pigment { rgbf <0.5, 1, 0.6, 0.7> } finish { ambient 0 diffuse 0.5 } }
";
const CAMERA: &str = "camera { location <1, 2, -6> look_at <0, 0, 0> angle 50 }\n";
const LIGHT: &str = "light_source { <4, 6, -5>, rgb 1 }\n";
const SETTINGS: &str = "#version 3.7; global_settings { assumed_gamma 1 }\n";

fn lit(light: &str) -> String {
    format!("{SETTINGS}{CAMERA}{light}{THINGS}")
}
