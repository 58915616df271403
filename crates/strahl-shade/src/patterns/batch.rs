//! Patterns at several places at once: the corners around which a normal measures heights, and surfaces whose textures are evaluated
//! together.

use arrayvec::ArrayVec;
use strahl_math::noise::store_noise;
use strahl_math::{DVec2, DVec3, det};
use strahl_simd::{Isa, Simd, dispatch};

use crate::ColorFt;

use super::{FieldRef, Modifiers, Pattern, PatternField, TexturePoint, noisy, plain};

/// The most points whose textures are evaluated together.
pub const BATCH: usize = 16;

/// At most `N` places where something is evaluated, each with the point of a surface to which it belongs.
#[derive(Clone, Debug)]
pub(crate) struct Batch<'a, const N: usize> {
    pub(crate) places: ArrayVec<DVec3, N>,
    /// As many as there are places. Of each only its position is another at its place.
    pub(crate) points: ArrayVec<&'a TexturePoint, N>,
}

impl<'a> Batch<'a, 4> {
    /// Four places that belong to one point.
    pub(crate) fn of_four(places: [DVec3; 4], point: &'a TexturePoint) -> Self {
        Self {
            places: ArrayVec::from(places),
            points: ArrayVec::from([point; 4]),
        }
    }
}

impl<'a, const N: usize> Batch<'a, N> {
    /// Points at their own positions; of more than `N`, the first.
    pub(crate) fn of(points: &'a [TexturePoint]) -> Self {
        Self {
            places: points.iter().take(N).map(|p| p.position).collect(),
            points: points.iter().take(N).collect(),
        }
    }

    pub(crate) fn len(&self) -> usize {
        self.places.len()
    }

    /// The same points at the places to which a map carries these.
    pub(crate) fn moved(&self, map: impl Fn(DVec3) -> DVec3) -> Self {
        Self {
            places: self.places.iter().map(|place| map(*place)).collect(),
            points: self.points.clone(),
        }
    }

    /// The same points at their surface coordinates, `(u, v, 0)`.
    pub(crate) fn on_surface(&self) -> Self {
        Self {
            places: self.points.iter().map(|p| p.uv.extend(0.0)).collect(),
            points: self.points.clone(),
        }
    }

    /// The places with these numbers.
    pub(crate) fn part(&self, lanes: &[usize]) -> Self {
        Self {
            places: lanes.iter().map(|lane| self.places[*lane]).collect(),
            points: lanes.iter().map(|lane| self.points[*lane]).collect(),
        }
    }

    /// The coordinates of the places, axis by axis.
    fn columns(&self) -> [[f64; N]; 3] {
        let mut columns = [[0.0; N]; 3];
        for (lane, place) in self.places.iter().enumerate() {
            for (column, x) in columns.iter_mut().zip(place.to_array()) {
                column[lane] = x;
            }
        }
        columns
    }

    /// Stores the values of a formula that takes four places, axis by axis.
    fn by_fours(&self, values: &mut [f64], formula: impl Fn(&[[f64; 4]; 3]) -> [f64; 4]) {
        for (four, values) in self.places.chunks(4).zip(values.chunks_mut(4)) {
            // The last place takes the lanes that are left.
            let place = |lane: usize| four[lane.min(four.len() - 1)];
            let [a, b, c, d] = [place(0), place(1), place(2), place(3)];
            let found = formula(&[
                [a.x, b.x, c.x, d.x],
                [a.y, b.y, c.y, d.y],
                [a.z, b.z, c.z, d.z],
            ]);
            values.copy_from_slice(&found[..values.len()]);
        }
    }
}

impl Pattern {
    /// Whether values at several places take less time together.
    pub(crate) fn gains_together(&self) -> bool {
        match self {
            Self::Function(function) => function.gains_together(),
            Self::Pigment(pigment) => pigment.gains_together(),
            Self::Bozo | Self::Fractal(_) | Self::Granite | Self::Wrinkles => true,
            _ => false,
        }
    }

    /// Whether its values depend on the normal of the surface.
    pub(crate) fn sees_normals(&self) -> bool {
        match self {
            Self::Pigment(pigment) => pigment.sees_normals(),
            Self::Aoi | Self::Slope { .. } => true,
            _ => false,
        }
    }

    /// Stores [`Pattern::raw`] at the places of a batch, as many as there are.
    fn store_raw<const N: usize>(
        &self,
        batch: &Batch<'_, N>,
        modifiers: &Modifiers,
        values: &mut [f64],
    ) {
        let noise = modifiers.noise;
        let count = batch.len();
        match self {
            Self::Bozo => {
                let [x, y, z] = batch.columns();
                store_noise([&x[..count], &y[..count], &z[..count]], noise, values);
            }
            Self::Fractal(fractal) => {
                let mut places = [DVec2::ZERO; N];
                for (flat, place) in places.iter_mut().zip(&batch.places) {
                    *flat = place.truncate();
                }
                fractal.store_values(&places[..count], values);
            }
            Self::Function(function) => {
                let [x, y, z] = batch.columns();
                function.store_values(&[&x[..count], &y[..count], &z[..count]], values);
                for value in values {
                    *value = plain::wrapped(*value);
                }
            }
            Self::Granite => batch.by_fours(values, |places| noisy::granite_of_four(places, noise)),
            Self::Leopard => batch.by_fours(values, leopard_of_four),
            Self::Pigment(pigment) => {
                let mut colors = [ColorFt::default(); N];
                pigment.store_batch(batch, &mut colors[..count]);
                for (value, color) in values.iter_mut().zip(&colors) {
                    *value = color.gray();
                }
            }
            Self::Wrinkles => {
                batch.by_fours(values, |places| noisy::wrinkles_of_four(places, noise));
            }
            _ => {
                let all = batch.places.iter().zip(&batch.points);
                for (value, (place, point)) in values.iter_mut().zip(all) {
                    *value = self.raw(*place, point, modifiers);
                }
            }
        }
    }
}

fn leopard_of_four([x, y, z]: &[[f64; 4]; 3]) -> [f64; 4] {
    let sums = dispatch!(Simd::best(), isa => {
        let sin_x = det::sines(isa, isa.load(x));
        let sin_y = det::sines(isa, isa.load(y));
        let sin_z = det::sines(isa, isa.load(z));
        isa.store(isa.div(isa.add(isa.add(sin_x, sin_y), sin_z), isa.splat(3.0)))
    });
    sums.map(|sum| sum * sum)
}

impl PatternField {
    /// Stores the values at several points, with the bits of [`PatternField::value`]. The slices have the same length.
    pub fn store_values_at(&self, points: &[TexturePoint], values: &mut [f64]) {
        for (points, values) in points.chunks(BATCH).zip(values.chunks_mut(BATCH)) {
            let batch = Batch::<BATCH>::of(points);
            self.store_moved(&batch.moved(|p| self.moved(p)), values);
        }
    }

    /// Stores the values at the places of a batch, as many as there are; [`PatternField::moved`] has led to them.
    pub(crate) fn store_moved<const N: usize>(&self, batch: &Batch<'_, N>, values: &mut [f64]) {
        self.as_ref().store_moved(batch, values);
    }
}

impl FieldRef<'_> {
    /// The same for a pattern and its modifiers.
    pub(crate) fn store_moved<const N: usize>(&self, batch: &Batch<'_, N>, values: &mut [f64]) {
        self.pattern.store_raw(batch, self.modifiers, values);
        for value in values {
            *value = self.value_of_raw(*value);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Color;
    use crate::patterns::Fractal;
    use crate::pigment::{BlendMap, Pigment};
    use std::sync::Arc;
    use strahl_function::{Graph, ScalarField};
    use strahl_math::noise::NoiseGenerator;

    fn ramp(pattern: Pattern) -> Pigment {
        let mut field = PatternField::from(pattern);
        field.modifiers.turbulence = DVec3::splat(0.2);
        let colors = vec![
            (0.1, Color::new(0.1, 0.5, 0.3).into()),
            (0.8, Color::new(0.9, 0.2, 0.7).into()),
        ];
        Pigment::ColorMap(Box::new(field), BlendMap::new(colors))
    }

    fn patterns() -> Vec<Pattern> {
        let pigments = || {
            vec![
                (0.2, ramp(Pattern::Leopard)),
                (0.6, ramp(Pattern::Wrinkles)),
                (0.6, ramp(Pattern::Onion)),
                (0.9, Pigment::Solid(Color::gray(0.3).into(), None)),
            ]
        };
        let pigment = |pigment: Pigment| Pattern::Pigment(Arc::new(pigment));
        let map = |pattern: Pattern| Pigment::PigmentMap(pattern.into(), BlendMap::new(pigments()));
        let members = || pigments().into_iter().map(|(_, pigment)| pigment);
        let field: Arc<dyn ScalarField> = Arc::new(PatternField::from(Pattern::Onion));
        let mut graph = Graph::new(["x", "y", "z"]);
        let place = graph.xyz();
        let noise = graph.internal("f_noise3d", &place, NoiseGenerator::Original);
        let wave = graph.sin(place[0]);
        let root = graph.mul(noise, wave);
        let function = graph.finish(root).expect("a small function");
        assert!(function.gains_together() && !field.gains_together());
        vec![
            Pattern::Bozo,
            Pattern::Fractal(Fractal::mandelbrot(20)),
            Pattern::Function(field),
            Pattern::Function(Arc::new(function)),
            Pattern::Granite,
            Pattern::Leopard,
            Pattern::Wrinkles,
            Pattern::Onion,
            pigment(ramp(Pattern::Granite)),
            pigment(map(Pattern::Bozo)),
            pigment(map(Pattern::Aoi)),
            pigment(Pigment::Blocks(
                Pattern::Hexagon.into(),
                members().collect(),
            )),
            pigment(Pigment::Average(pigments().into(), Box::default())),
            pigment(Pigment::UvMapped(Box::new(map(Pattern::Onion)))),
        ]
    }

    #[test]
    fn places_of_a_batch_have_the_bits_of_single_ones() {
        let generators = [
            NoiseGenerator::Original,
            NoiseGenerator::RangeCorrected,
            NoiseGenerator::Perlin,
        ];
        for pattern in patterns() {
            for noise in generators {
                let modifiers = Modifiers {
                    noise,
                    ..Modifiers::default()
                };
                for n in 0..100 {
                    let points: Vec<TexturePoint> = (0..=n % BATCH)
                        .map(|k| {
                            let t = (3 * n + 7 * k) as f64;
                            let place =
                                DVec3::new(t * 0.031 - 2.0, 1.0 - t * 0.017, t * 0.71 - 9.0);
                            let far = if n == 7 && k == 2 { 1e300 } else { 1.0 };
                            let mut point = TexturePoint::in_space(place * far);
                            point.uv.x = 0.3 * t;
                            point
                        })
                        .collect();
                    let batch: Batch<'_, BATCH> = Batch::of(&points);
                    let mut together = vec![0.0; points.len()];
                    pattern.store_raw(&batch, &modifiers, &mut together);
                    for (point, value) in points.iter().zip(together) {
                        let single = pattern.raw(point.position, point, &modifiers);
                        assert_eq!(value.to_bits(), single.to_bits(), "{pattern:?} {point:?}");
                    }
                }
            }
        }
    }
}
