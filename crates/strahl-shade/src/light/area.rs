use strahl_math::DVec3;

/// The extent of an area light: a rectangle or an ellipse with a grid of points that shine.
///
/// The points lie in rows from edge to edge. Their mean is taken as in POV-Ray: the grid is halved again and again, and each
/// cell counts as the mean of its corners, so that points inside count more than points on the edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AreaLight {
    /// One edge of the rectangle.
    pub axis_1: DVec3,
    /// The other edge.
    pub axis_2: DVec3,
    /// Points along `axis_1`; at least 1.
    pub size_1: u32,
    /// Points along `axis_2`; at least 1.
    pub size_2: u32,
    /// How often the grid is halved in any case; after that only cells are halved whose corners differ. `None` takes all
    /// points.
    pub adaptive: Option<u32>,
    /// Whether the points are moved at random within their cells, differently for each lit point.
    pub jitter: bool,
    /// Whether the rectangle is shrunk to the ellipse inside.
    pub circular: bool,
    /// Whether the light turns towards each lit point, as a square with the length of `axis_1`.
    pub orient: bool,
    /// Whether each point of the grid is shaded by its own direction; otherwise the grid is used for shadows only, and the
    /// centre for shading.
    pub illumination: bool,
    /// For parallel light the distance at which the points of the grid are as far apart as the axes say: each point shines
    /// along its own line to the place pointed at. Not used otherwise.
    pub reach: f64,
}

impl AreaLight {
    /// Most points along an edge.
    pub const MAX_SIZE: u32 = 1024;

    /// A rectangle with a grid of points, without any option.
    pub const fn new(axis_1: DVec3, axis_2: DVec3, size_1: u32, size_2: u32) -> Self {
        Self {
            axis_1,
            axis_2,
            size_1,
            size_2,
            adaptive: None,
            jitter: false,
            circular: false,
            orient: false,
            illumination: false,
            reach: 1.0,
        }
    }

    /// The grid as it is for the point `lit`, which sees the centre in the unit direction `l`.
    pub fn grid(&self, lit: DVec3, l: DVec3) -> AreaGrid<'_> {
        AreaGrid {
            area: self,
            axes: if self.orient {
                self.turned(l)
            } else {
                (self.axis_1, self.axis_2)
            },
            state: if self.jitter { random_state(lit) } else { 0 },
        }
    }

    /// Axes perpendicular to `l`. As in POV-Ray (measured) both are as long as the first one, and their roll around `l` follows from `l`
    /// alone.
    fn turned(&self, l: DVec3) -> (DVec3, DVec3) {
        let across = l.cross(DVec3::Z);
        let across = if across == DVec3::ZERO {
            DVec3::X
        } else {
            across.normalize()
        };
        let length = self.axis_1.length();
        (across * length, l.cross(across) * length)
    }
}

/// The points of an area light for one lit point.
#[derive(Clone, Copy, Debug)]
pub struct AreaGrid<'a> {
    area: &'a AreaLight,
    axes: (DVec3, DVec3),
    /// Of the random numbers for jitter.
    state: u64,
}

impl AreaGrid<'_> {
    /// The vector from the centre of the light to point `(i, j)`.
    pub fn offset(&self, i: u32, j: u32) -> DVec3 {
        let area = self.area;
        let (jitter_1, jitter_2) = if area.jitter {
            random_pair(self.state, i, j)
        } else {
            (0.5, 0.5)
        };
        let mut u = place(i, area.size_1, jitter_1);
        let mut v = place(j, area.size_2, jitter_2);
        if area.circular {
            // Squares around the centre become circles: each point keeps its direction, its larger coordinate becomes
            // its distance.
            let length = (u * u + v * v).sqrt();
            if length > 0.0 {
                let larger = if u.abs() > v.abs() { u.abs() } else { v.abs() };
                u *= larger / length;
                v *= larger / length;
            }
        }
        self.axes.0 * u + self.axes.1 * v
    }
}

/// Place of a point in a row from -1/2 to 1/2.
fn place(index: u32, size: u32, jitter: f64) -> f64 {
    if size > 1 {
        (f64::from(index) + jitter - 0.5) / f64::from(size - 1) - 0.5
    } else {
        0.0
    }
}

/// The state of [`random_pair`] at a place.
fn random_state(at: DVec3) -> u64 {
    at.to_array().iter().fold(0, |s, x| mix(s, x.to_bits()))
}

/// Two numbers in `0..1` that depend on a place and two indices only.
fn random_pair(state: u64, i: u32, j: u32) -> (f64, f64) {
    let first = mix(state, u64::from(i) << 32 | u64::from(j));
    let unit = |bits: u64| (bits >> 40) as f64 / (1u64 << 24) as f64;
    (unit(first), unit(first << 24))
}

/// A step of SplitMix64 (Steele, Lea, Flood 2014).
fn mix(state: u64, input: u64) -> u64 {
    let mut z = (state ^ input).wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIT: DVec3 = DVec3::new(0.3, -5.0, 0.1);

    #[test]
    fn the_grid_reaches_from_edge_to_edge() {
        let area = AreaLight::new(DVec3::X * 4.0, DVec3::Z * 2.0, 5, 1);
        let x: Vec<f64> = (0..5)
            .map(|i| area.grid(LIT, DVec3::Y).offset(i, 0).x)
            .collect();
        assert_eq!(x, [-2.0, -1.0, 0.0, 1.0, 2.0]);
        assert_eq!(area.grid(LIT, DVec3::Y).offset(2, 0).z, 0.0);
    }

    #[test]
    fn a_circular_light_has_no_corners() {
        let mut area = AreaLight::new(DVec3::X * 2.0, DVec3::Z * 2.0, 5, 5);
        area.circular = true;
        let length = |i, j| area.grid(LIT, DVec3::Y).offset(i, j).length();
        assert!((length(0, 0) - 1.0).abs() < 1e-15 && (length(4, 1) - 1.0).abs() < 1e-15);
        assert!((length(1, 1) - 0.5).abs() < 1e-15 && length(2, 2) == 0.0);
    }

    #[test]
    fn an_oriented_light_faces_what_it_lights() {
        let mut area = AreaLight::new(DVec3::X * 2.0, DVec3::Y * 5.0, 3, 3);
        (area.circular, area.orient) = (true, true);
        let l = DVec3::new(0.6, 0.8, 0.0);
        for (i, j) in [(0, 0), (2, 1), (1, 2)] {
            let offset = area.grid(LIT, l).offset(i, j);
            assert!(offset.dot(l).abs() < 1e-15 && (offset.length() - 1.0).abs() < 1e-15);
        }
    }

    #[test]
    fn jitter_stays_in_its_cell_and_differs_from_place_to_place() {
        let mut area = AreaLight::new(DVec3::X * 4.0, DVec3::Z * 4.0, 5, 5);
        area.jitter = true;
        let a = area.grid(LIT, DVec3::Y).offset(1, 3);
        assert!((a.x + 1.0).abs() <= 0.5 && (a.z - 1.0).abs() <= 0.5);
        assert_eq!(a, area.grid(LIT, DVec3::Y).offset(1, 3));
        assert_ne!(a, area.grid(LIT * 2.0, DVec3::Y).offset(1, 3));
    }
}
