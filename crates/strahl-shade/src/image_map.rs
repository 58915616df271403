//! Images mapped onto objects: `image_map`, `image_pattern`, `bump_map` and `material_map`.

use std::sync::Arc;

use strahl_math::{DVec2, DVec3, det};

use crate::image_texture::TextureImage;
use crate::{Color, ColorFt};

/// How the unit square of an image is mapped to space (`map_type`).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MapType {
    /// On the x-y plane, between the corners (0, 0) and (1, 1).
    #[default]
    Planar,
    /// Around the y axis, from pole to pole of any sphere around the origin.
    Spherical,
    /// Around the y axis, between the heights 0 and 1.
    Cylindrical,
    /// Around the circle of radius 1 around the y axis.
    Toroidal,
}

impl MapType {
    /// The map type with POV-Ray's number 0, 1, 2 or 5.
    pub const fn from_number(number: u32) -> Option<Self> {
        match number {
            0 => Some(Self::Planar),
            1 => Some(Self::Spherical),
            2 => Some(Self::Cylindrical),
            5 => Some(Self::Toroidal),
            _ => None,
        }
    }

    /// The image coordinates of a point, u to the right and v upwards.
    fn place(self, p: DVec3) -> DVec2 {
        use std::f64::consts::{PI, TAU};
        if self == Self::Planar {
            return DVec2::new(p.x, p.y);
        }
        let turn = det::atan2(p.z, p.x) / TAU;
        let u = if turn < 0.0 { turn + 1.0 } else { turn };
        let around = (p.x * p.x + p.z * p.z).sqrt();
        match self {
            Self::Planar => DVec2::new(p.x, p.y),
            Self::Spherical => DVec2::new(u, 0.5 + det::atan2(p.y, around) / PI),
            Self::Cylindrical => DVec2::new(u, p.y),
            Self::Toroidal => DVec2::new(u, 0.5 + det::atan2(p.y, around - 1.0) / TAU),
        }
    }
}

/// How texels are combined (`interpolate`).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Interpolation {
    /// The texel the point lies in (no interpolation).
    #[default]
    Nearest,
    /// The four texels around, weighted linearly (`interpolate 2`).
    Bilinear,
    /// The sixteen texels around, by the cubic of Catmull and Rom (1974) in both directions, limited to the values 0 to 1
    /// (`interpolate 3`, measured).
    Bicubic,
    /// The four texels around, weighted by the inverse square of their distance (`interpolate 4`).
    NormalizedDistance,
}

/// The transparency of single entries of an image's palette (`filter N, V` and `transmit N, V`).
#[derive(Clone, Debug, PartialEq)]
pub struct PaletteTransparency {
    /// The entry of each texel, row by row from the top.
    pub indices: Arc<[u8]>,
    /// `filter` and `transmit` of each entry; they replace the image's alpha channel.
    pub entries: Vec<[f64; 2]>,
}

/// An image and its mapping.
#[derive(Clone, Debug, PartialEq)]
pub struct ImageMap {
    /// The picture.
    pub image: Arc<TextureImage>,
    /// The mapping.
    pub map_type: MapType,
    /// How texels are combined.
    pub interpolation: Interpolation,
    /// Whether there is only one copy (planar and cylindrical maps).
    pub once: bool,
    /// `filter all`: added to every texel.
    pub filter_all: f64,
    /// `transmit all`: added to every texel.
    pub transmit_all: f64,
    /// The transparency of single entries of the palette.
    pub palette: Option<Arc<PaletteTransparency>>,
    /// Whether the alpha channel is the value of [`ImageMap::gray`] (`use_alpha`).
    pub use_alpha: bool,
}

impl ImageMap {
    /// The picture on the x-y plane, repeated, not interpolated.
    pub fn new(image: Arc<TextureImage>) -> Self {
        Self {
            image,
            map_type: MapType::Planar,
            interpolation: Interpolation::Nearest,
            once: false,
            filter_all: 0.0,
            transmit_all: 0.0,
            palette: None,
            use_alpha: false,
        }
    }

    /// Whether it may be transparent somewhere: `false` is certain, `true` is not.
    pub fn may_transmit(&self) -> bool {
        let ends = self.once && matches!(self.map_type, MapType::Planar | MapType::Cylindrical);
        if ends || self.filter_all != 0.0 || self.transmit_all != 0.0 {
            return true;
        }
        let Some(palette) = &self.palette else {
            return !self.image.is_opaque();
        };
        let passes = |entry: &[f64; 2]| *entry != [0.0; 2];
        let is_used = |index: &u8| palette.entries.get(usize::from(*index)).is_some_and(passes);
        // A texel without an entry has the alpha of the image.
        !self.image.is_opaque()
            || palette.entries.iter().any(passes) && palette.indices.iter().any(is_used)
    }

    /// The colour at a point; `None` outside of an image with `once`.
    pub fn color(&self, p: DVec3) -> Option<ColorFt> {
        let [r, g, b, a, filter] = self.sample(p)?;
        Some(ColorFt {
            rgb: Color::new(r, g, b),
            filter: self.filter_all + filter,
            transmit: self.transmit_all + (1.0 - a),
        })
    }

    /// The grey value (or alpha) at a point, 0 outside of an image with `once`.
    pub fn gray(&self, p: DVec3) -> f64 {
        match self.sample(p) {
            None => 0.0,
            Some([_, _, _, a, _]) if self.use_alpha => a,
            // A transparent texel counts as lying on black.
            Some([r, g, b, a, _]) => Color::new(r, g, b).gray_value() * a,
        }
    }

    /// The perturbation of the normal `n` per unit of `bump_size` if the image is taken as a relief; zero outside of an image with
    /// `once`.
    ///
    /// The relief is the plane through the grey values at the place and one texel below it to the left and to the right, at
    /// a distance of one per texel. For all kinds of maps the image's x axis is horizontal on the surface, and its y axis points
    /// up; on a surface that faces straight up or down the x axis is x (all this as measured).
    pub fn tilt(&self, p: DVec3, n: DVec3) -> DVec3 {
        let place = self.map_type.place(p);
        let texel = DVec2::new(
            1.0 / f64::from(self.image.width()),
            1.0 / f64::from(self.image.height()),
        );
        let gray = |dx: f64, dy: f64| {
            let [r, g, b, a, _] = self.sample_around(place + DVec2::new(dx, dy) * texel);
            Color::new(r, g, b).gray_value() * a
        };
        if self.is_beside(place) {
            return DVec3::ZERO;
        }
        let (center, left, right) = (gray(0.0, 0.0), gray(-1.0, -1.0), gray(1.0, -1.0));
        let (across, up) = (0.5 * (left - right), 0.5 * (left + right) - center);
        let right = DVec3::new(-n.z, 0.0, n.x).normalize_or(DVec3::X);
        let above = right.cross(n).normalize_or_zero();
        right * across + above * up
    }

    /// Red, green, blue, alpha and the filter of the palette.
    fn sample(&self, p: DVec3) -> Option<[f64; 5]> {
        let place = self.map_type.place(p);
        let within = |channel: f64| channel.clamp(0.0, 1.0);
        (!self.is_beside(place)).then(|| self.sample_around(place).map(within))
    }

    /// The texel with the transparency of its entry in the palette; row 0 is the top.
    fn texel(&self, column: u32, row: u32) -> [f64; 5] {
        let [r, g, b, a] = self.image.fetch(column, row).map(f64::from);
        let Some(palette) = &self.palette else {
            return [r, g, b, a, 0.0];
        };
        let place = row as usize * self.image.width() as usize + column as usize;
        let index = palette.indices.get(place);
        match index.and_then(|&index| palette.entries.get(usize::from(index))) {
            Some([filter, transmit]) => [r, g, b, 1.0 - transmit, *filter],
            None => [r, g, b, a, 0.0],
        }
    }

    /// The number of a texel in a row or column of `count`: a single image goes on as it ends (measured), others are repeated.
    fn within(&self, number: f64, count: u32) -> u32 {
        let whole = number as i64;
        if (0..i64::from(count)).contains(&whole) {
            return whole as u32;
        }
        if self.once {
            number.clamp(0.0, f64::from(count - 1)) as u32
        } else {
            whole.rem_euclid(i64::from(count)) as u32
        }
    }

    /// Whether a place is outside of a single image.
    fn is_beside(&self, place: DVec2) -> bool {
        let inside = |x: f64| (0.0..=1.0).contains(&x);
        let beside = match self.map_type {
            MapType::Planar => !inside(place.x) || !inside(place.y),
            MapType::Cylindrical => !inside(place.y),
            MapType::Spherical | MapType::Toroidal => false,
        };
        self.once && beside
    }

    /// The same for an image that is repeated. Bicubic interpolation goes beyond the values of the texels, which bumps show (measured) and
    /// colours do not.
    fn sample_around(&self, place: DVec2) -> [f64; 5] {
        let (width, height) = (self.image.width(), self.image.height());
        let fraction = place - place.floor();
        let x = fraction.x * f64::from(width);
        let y = fraction.y * f64::from(height);
        // Row 0 of the picture is its top, v points up.
        let texel = |column: f64, row: f64| {
            let column = self.within(column, width);
            let row = self.within(row, height);
            self.texel(column, height - 1 - row)
        };
        if self.interpolation == Interpolation::Nearest {
            return texel(x.floor(), y.floor());
        }
        let (x, y) = (x - 0.5, y - 0.5);
        let (left, low) = (x.floor(), y.floor());
        let (s, t) = (x - left, y - low);
        let mut sum = [0.0; 5];
        if self.interpolation == Interpolation::Bicubic {
            for (j, across) in catmull_rom(t).iter().enumerate() {
                for (i, along) in catmull_rom(s).iter().enumerate() {
                    let texel = texel(left + i as f64 - 1.0, low + j as f64 - 1.0);
                    for (sum, channel) in sum.iter_mut().zip(texel) {
                        *sum += along * across * channel;
                    }
                }
            }
            return sum;
        }
        let mut total = 0.0;
        for (i, j) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)] {
            let texel = texel(left + i, low + j);
            let (ds, dt) = (s - i, t - j);
            let weight = if self.interpolation == Interpolation::Bilinear {
                (1.0 - ds.abs()) * (1.0 - dt.abs())
            } else {
                let squared = ds * ds + dt * dt;
                if squared == 0.0 {
                    return texel;
                }
                1.0 / squared
            };
            total += weight;
            for (sum, channel) in sum.iter_mut().zip(texel) {
                *sum += weight * channel;
            }
        }
        sum.map(|channel| channel / total)
    }
}

/// The weights of four values for a place at `t` from the second to the third.
fn catmull_rom(t: f64) -> [f64; 4] {
    let (t2, t3) = (t * t, t * t * t);
    [
        0.5 * (2.0 * t2 - t - t3),
        0.5 * (2.0 - 5.0 * t2 + 3.0 * t3),
        0.5 * (t + 4.0 * t2 - 3.0 * t3),
        0.5 * (t3 - t2),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image_texture::{ColorSpace, TexelChannels, TexelData};

    fn picture() -> Arc<TextureImage> {
        let samples = vec![
            10, 200, 30, 250, 40, 60, 70, 80, 90, 100, 110, 20, 0, 255, 128, 33, 66, 99,
        ];
        let image = TextureImage::try_new(
            3,
            2,
            TexelChannels::Rgb,
            ColorSpace::Linear,
            TexelData::U8(samples),
        );
        Arc::new(image.expect("3 x 2 texels"))
    }

    const POINTS: [[f64; 3]; 6] = [
        [0.153, -0.627, -0.524],
        [-0.502, 1.95, 0.531],
        [0.697, -0.68, 0.72],
        [-1.508, -1.793, 1.401],
        [-1.964, 1.915, 1.308],
        [1.141, -1.808, -1.17],
    ];

    #[test]
    fn a_map_may_transmit_where_a_texel_does_or_none_is() {
        let with_alpha = |alpha: [u8; 2]| {
            let [a, b] = alpha;
            let data = TexelData::U8(vec![9, 9, 9, a, 7, 7, 7, b]);
            let image = TextureImage::try_new(2, 1, TexelChannels::Rgba, ColorSpace::Linear, data);
            ImageMap::new(Arc::new(image.expect("2 x 1 texels")))
        };
        let opaque = with_alpha([255, 255]);
        assert!(!opaque.may_transmit() && !ImageMap::new(picture()).may_transmit());
        assert!(with_alpha([255, 254]).may_transmit());
        let changed = |change: &dyn Fn(&mut ImageMap)| {
            let mut map = opaque.clone();
            change(&mut map);
            map.may_transmit()
        };
        assert!(changed(&|map| map.filter_all = 0.1));
        assert!(changed(&|map| map.transmit_all = 0.1));
        assert!(changed(&|map| map.once = true));
        // A sphere has no place beside the image.
        assert!(!changed(
            &|map| (map.once, map.map_type) = (true, MapType::Spherical)
        ));
        let palette = |indices: [u8; 2]| {
            changed(&|map| {
                map.palette = Some(Arc::new(PaletteTransparency {
                    indices: indices.into(),
                    entries: vec![[0.0, 0.0], [0.0, 0.5], [0.0, 0.0]],
                }));
            })
        };
        // The entry that transmits is used, or not.
        assert!(palette([0, 1]) && !palette([0, 2]));
    }

    /// Red, as POV-Ray 3.7.0.10 gives it.
    #[test]
    fn equals_the_measured_values() {
        let cases = [
            (
                MapType::Planar,
                Interpolation::Nearest,
                [
                    0.39215687, 0.98039216, 0.12941177, 0.0, 0.03921569, 0.39215687,
                ],
            ),
            (
                MapType::Planar,
                Interpolation::Bilinear,
                [
                    0.299584, 0.58578825, 0.14462502, 0.09097349, 0.18349522, 0.3354328,
                ],
            ),
            (
                MapType::Planar,
                Interpolation::NormalizedDistance,
                [
                    0.34267449, 0.60636914, 0.18799505, 0.01250192, 0.17448537, 0.377074,
                ],
            ),
            (
                MapType::Spherical,
                Interpolation::Nearest,
                [
                    0.12941177, 0.98039216, 0.39215687, 0.0, 0.98039216, 0.12941177,
                ],
            ),
            (
                MapType::Cylindrical,
                Interpolation::Bilinear,
                [
                    0.17380519, 0.42982876, 0.32011342, 0.18350138, 0.51626968, 0.17063667,
                ],
            ),
            (
                MapType::Toroidal,
                Interpolation::Nearest,
                [
                    0.12941177, 0.98039216, 0.39215687, 0.0, 0.98039216, 0.12941177,
                ],
            ),
        ];
        for (map_type, interpolation, values) in cases {
            let map = ImageMap {
                map_type,
                interpolation,
                ..ImageMap::new(picture())
            };
            for (p, expected) in POINTS.iter().zip(values) {
                let got = map.color(DVec3::from_array(*p)).expect("repeated").rgb.r;
                assert!(
                    (got - expected).abs() < 1e-6,
                    "{map_type:?} {interpolation:?} {p:?}: {got} {expected}"
                );
            }
        }
        let values = [
            0.3794902, 0.41039217, 0.23514119, 0.64622355, 0.48701963, 0.3794902,
        ];
        for (p, expected) in POINTS.iter().zip(values) {
            let got = ImageMap::new(picture()).gray(DVec3::from_array(*p));
            assert!((got - expected).abs() < 1e-6, "{p:?}: {got} {expected}");
        }
    }

    #[test]
    fn once_means_once_and_hostile_points_do_not_panic() {
        let once = ImageMap {
            once: true,
            ..ImageMap::new(picture())
        };
        assert!(once.color(DVec3::new(0.5, 0.5, 3.0)).is_some());
        assert!(once.color(DVec3::new(1.5, 0.5, 3.0)).is_none());
        assert_eq!(
            once.tilt(DVec3::new(1.5, 0.5, 3.0), DVec3::NEG_Z),
            DVec3::ZERO
        );
        for x in [f64::NAN, f64::INFINITY, 1e300, -1e-300] {
            for interpolation in [
                Interpolation::Nearest,
                Interpolation::Bilinear,
                Interpolation::Bicubic,
                Interpolation::NormalizedDistance,
            ] {
                let map = ImageMap {
                    interpolation,
                    ..ImageMap::new(picture())
                };
                let _ = (
                    map.color(DVec3::splat(x)),
                    map.tilt(DVec3::splat(x), DVec3::Y),
                );
            }
        }
    }

    #[test]
    fn numbers_of_texels_are_remainders_or_limited() {
        let mut map = ImageMap::new(picture());
        for number in [
            -7.0,
            -3.0,
            -1.0,
            -0.5,
            0.0,
            1.0,
            2.0,
            2.5,
            3.0,
            8.0,
            1e300,
            f64::NAN,
        ] {
            map.once = false;
            let repeated = (number as i64).rem_euclid(3) as u32;
            assert_eq!(map.within(number, 3), repeated, "{number}");
            map.once = true;
            let limited = number.clamp(0.0, 2.0) as u32;
            assert_eq!(map.within(number, 3), limited, "{number}");
        }
    }
}
