//! Scenes in the Neutral File Format, written line by line.

use std::fmt::Write;
use strahl::math::DVec3;

/// The text of a scene, as far as it is written.
#[derive(Default)]
pub(crate) struct Scene(String);

impl Scene {
    /// The background and the view, which has z upwards and its angle in degrees.
    pub(crate) fn view(&mut self, background: &str, from: [f64; 3], at: [f64; 3], angle: f64) {
        self.line(&format!("b {background}\nv"));
        self.point("from ", DVec3::from(from));
        self.point("at ", DVec3::from(at));
        self.line("up 0 0 1");
        self.line(&format!("angle {angle}\nhither 0.01\nresolution 512 512"));
    }

    /// White lights, which share the light of a scene.
    pub(crate) fn lights(&mut self, places: &[[f64; 3]]) {
        for place in places {
            self.point("l ", DVec3::from(*place));
        }
    }

    /// The material of what follows: red, green, blue, Kd, Ks, Shine, T, index of refraction.
    pub(crate) fn fill(&mut self, numbers: &str) {
        self.line(&format!("f {numbers}"));
    }

    /// Whether there has been a fill.
    pub(crate) fn has_fill(&self) -> bool {
        self.0.contains("\nf ")
    }

    pub(crate) fn sphere(&mut self, center: DVec3, radius: f64) {
        self.point_and("s ", center, radius);
    }

    /// A cone without caps, or a cylinder if both radii are equal; each end is a centre and a radius.
    pub(crate) fn cone(&mut self, base: (DVec3, f64), apex: (DVec3, f64)) {
        let ((b, base_radius), (a, apex_radius)) = (base, apex);
        self.line(&format!(
            "c {} {} {} {base_radius} {} {} {} {apex_radius}",
            b.x, b.y, b.z, a.x, a.y, a.z
        ));
    }

    /// A polygon, counter-clockwise as seen from its front.
    pub(crate) fn polygon(&mut self, corners: &[DVec3]) {
        self.line(&format!("p {}", corners.len()));
        for corner in corners {
            self.point("", *corner);
        }
    }

    /// A square at a height, seen from above.
    pub(crate) fn square(&mut self, half: f64, z: f64) {
        let corners = [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)];
        self.polygon(&corners.map(|(x, y)| DVec3::new(x * half, y * half, z)));
    }

    pub(crate) fn into_text(self) -> String {
        self.0
    }

    fn point(&mut self, word: &str, p: DVec3) {
        self.line(&format!("{word}{} {} {}", p.x, p.y, p.z));
    }

    fn point_and(&mut self, word: &str, p: DVec3, number: f64) {
        self.line(&format!("{word}{} {} {} {number}", p.x, p.y, p.z));
    }

    fn line(&mut self, text: &str) {
        // Writing to a string never fails.
        let _ = writeln!(self.0, "{text}");
    }
}
