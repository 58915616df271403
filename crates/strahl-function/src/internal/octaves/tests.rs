use super::*;
use strahl_math::noise::{Segment, noise};

/// The sums as their formulas are written.
fn plain(sum: Sum, parameters: &Parameters, p: DVec3) -> f64 {
    let mut p = p;
    let generator = numbered(parameters[5]);
    let signed = |p| 2.0 * noise(p, generator) - 1.0;
    if sum == Sum::Ridge {
        let &[lambda, octaves, omega, offset, ridge, _] = parameters;
        let octaves = if octaves < 256.0 { octaves } else { 256.0 };
        let whole = if octaves >= 1.0 { octaves.trunc() } else { 1.0 };
        let rest = octaves - octaves.trunc();
        let (mut sum, mut total, mut weight, mut octave) = (0.0, 0.0, 1.0, 0.0);
        while octave < whole || rest > 0.0 && octave == whole {
            let share = if octave < whole {
                weight
            } else {
                weight * rest
            };
            let distance = (noise(p, generator) - ridge).abs() / larger(ridge);
            p *= lambda;
            sum += share * ((distance - offset) / larger(offset));
            total += share;
            weight *= omega;
            octave += 1.0;
        }
        return sum / total;
    }
    let &[h, lacunarity, octaves, offset, last, _] = parameters;
    let octaves = if octaves < 256.0 { octaves } else { 256.0 };
    let ridge = |p| (offset - f64::abs(signed(p))) * (offset - f64::abs(signed(p)));
    let mut signal = ridge(p);
    let mut value = match sum {
        Sum::Hetero => offset + signed(p),
        _ => signal,
    };
    let (mut frequency, mut octave) = (lacunarity, 1.0);
    p *= lacunarity;
    while octave < octaves {
        if sum == Sum::Hetero {
            let increment = (signed(p) + offset) * det::pow(frequency, -h);
            value += increment * det::pow(value, last.trunc());
        } else {
            let weight = signal * last;
            // NaN counts as zero.
            let weight = if weight > 0.0 { weight.min(1.0) } else { 0.0 };
            signal = ridge(p) * weight;
            value += signal * det::pow(frequency, -h);
        }
        frequency *= lacunarity;
        p *= lacunarity;
        octave += 1.0;
    }
    let rest = octaves - octaves.trunc();
    if sum == Sum::Hetero && rest != 0.0 {
        let increment = (signed(p) + offset) * det::pow(frequency, -h);
        value += rest * increment * value;
    }
    value
}

struct Random(u64);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    fn one_of(&mut self, numbers: &[f64]) -> f64 {
        numbers[(self.unit() * numbers.len() as f64) as usize]
    }

    fn point(&mut self) -> DVec3 {
        let size = self.one_of(&[0.1, 3.0, 3.0, 100.0, 1e7, 1e12]);
        DVec3::new(
            self.within(-size, size),
            self.within(-size, size),
            self.within(-size, size),
        )
    }

    /// Parameters as scenes have them, and a strange one among them every other time.
    fn parameters(&mut self, sum: Sum) -> Parameters {
        let generator = self.one_of(&[0.1, 1.0, 2.0, 2.0, 3.0]);
        let octaves = self.one_of(&[0.3, 1.0, 2.0, 3.5, 5.0, 6.7, 9.0, 19.2]);
        let lacunarity = self.one_of(&[2.0, 2.0, 2.17, 1.3]);
        let offset = self.within(-1.0, 1.5);
        let mut parameters = match sum {
            Sum::Ridge => [
                lacunarity,
                octaves,
                self.within(0.1, 1.0),
                offset,
                self.within(0.0, 1.0),
                generator,
            ],
            _ => [
                self.within(0.0, 1.2),
                lacunarity,
                octaves,
                offset,
                self.one_of(&[0.0, 0.7, 1.0, 1.4, 3.0]),
                generator,
            ],
        };
        if self.unit() < 0.5 {
            let at = (self.unit() * 5.0) as usize;
            let strange = [
                0.0,
                -0.0,
                0.5,
                -1.0,
                -2.3,
                2.0,
                40.0,
                300.0,
                1e-200,
                1e30,
                -1e200,
                f64::INFINITY,
                f64::NEG_INFINITY,
                f64::NAN,
            ];
            parameters[at] = self.one_of(&strange);
        }
        parameters
    }
}

const SUMS: [Sum; 3] = [Sum::Hetero, Sum::Ridge, Sum::Ridged];

fn is_same(a: f64, b: f64) -> bool {
    a.to_bits() == b.to_bits() || a.is_nan() && b.is_nan()
}

#[test]
fn values_have_the_bits_of_plain_loops() {
    let mut random = Random(1);
    let places = [0.0, -0.0, 1e30, -1e300, f64::INFINITY, f64::NAN];
    for case in 0..6000 {
        let sum = SUMS[case % 3];
        let parameters = random.parameters(sum);
        let octaves = Octaves::new(sum, &parameters);
        for _ in 0..3 {
            let mut p = random.point();
            if random.unit() < 0.1 {
                p.y = random.one_of(&places);
            }
            let (value, expected) = (octaves.value(p), plain(sum, &parameters, p));
            assert!(
                is_same(value, expected),
                "{sum:?} {parameters:?} {p}: {value}, not {expected}"
            );
        }
    }
}

#[test]
fn neighbours_have_the_values_of_points() {
    let mut random = Random(2);
    for case in 0..1500 {
        let sum = SUMS[case % 3];
        let parameters = random.parameters(sum);
        let octaves = Octaves::new(sum, &parameters);
        let (middle, size) = (random.point(), random.one_of(&[1e-6, 0.01, 1.0]));
        let mut points = [[[0.0; 4]; 3]; 2];
        for half in &mut points {
            for (axis, x) in half.iter_mut().zip(middle.to_array()) {
                for lane in axis {
                    *lane = x + random.within(-size, size);
                }
            }
        }
        let values = octaves.values_of_neighbours(&points);
        for (at, value) in values.into_iter().enumerate() {
            let p = DVec3::from_array(points[at / 4].map(|axis| axis[at % 4]));
            let alone = octaves.value(p);
            assert!(
                is_same(value, alone),
                "{sum:?} {parameters:?} {p}: {value}, not {alone}"
            );
        }
    }
}

#[test]
fn bounds_contain_values_and_are_as_narrow_as_step_by_step() {
    let mut random = Random(3);
    let mut usual = 0;
    for case in 0..6000 {
        let sum = SUMS[case % 3];
        let parameters = random.parameters(sum);
        if parameters.iter().any(|x| x.is_nan()) {
            continue;
        }
        let octaves = Octaves::new(sum, &parameters);
        let size = random.one_of(&[0.0, 1e-6, 1e-3, 0.05, 0.3, 2.0]);
        let min = random.point().to_array();
        let max = min.map(|x| x + size * random.unit());
        let area = [0, 1, 2].map(|axis| Bounds::argument(min[axis], max[axis]));
        let bounds = octaves.bounds(&area);
        for _ in 0..10 {
            let place = |axis: usize, share: f64| {
                let x = min[axis] + share * (max[axis] - min[axis]);
                if x < max[axis] { x } else { max[axis] }
            };
            let p = DVec3::new(
                place(0, random.unit()),
                place(1, random.unit()),
                place(2, random.unit()),
            );
            let value = octaves.value(p);
            assert!(
                bounds.contains(value),
                "{sum:?} {parameters:?} {p}: {value}, not in {bounds:?}"
            );
        }
        if !octaves.is_usual {
            continue;
        }
        usual += 1;
        let ranges = octaves.ranges(&area);
        let steps = match sum {
            Sum::Hetero => octaves.hetero_within(ranges),
            Sum::Ridge => octaves.ridge_within(ranges),
            Sum::Ridged => octaves.ridged_within(ranges),
        };
        // What is not told apart from rounding.
        let largest = if steps.max > -steps.min {
            steps.max
        } else {
            -steps.min
        };
        let room = 1e-12 * (1.0 + largest);
        assert!(
            bounds.min >= steps.min - room && bounds.max <= steps.max + room,
            "{sum:?} {parameters:?} {area:?}: {bounds:?} {steps:?}"
        );
    }
    assert!(usual > 2500, "{usual}");
}

#[test]
fn where_noise_can_be_anything_so_can_its_sums() {
    let wide = [Bounds::new(-5.0, 7.0); 3];
    let ridged = Octaves::new(Sum::Ridged, &[0.5, 2.0, 9.0, 0.7, 0.8, 2.0]).bounds(&wide);
    assert!(ridged.min == 0.0 && ridged.max > 0.49 && !ridged.nan);
    let infinite = [Bounds::new(-5.0, f64::INFINITY); 3];
    for sum in SUMS {
        let octaves = Octaves::new(sum, &[0.5, 2.0, 5.0, 0.7, 0.8, 2.0]);
        assert!(octaves.bounds(&infinite).nan, "{sum:?}");
    }
}

#[test]
fn segments_bound_values_and_how_fast_they_change() {
    let mut random = Random(4);
    let (mut known, mut narrow, mut steep) = (0, 0, 0);
    for case in 0..6000 {
        let sum = [Sum::Hetero, Sum::Ridge, Sum::Ridged][case % 3];
        let parameters = random.parameters(sum);
        if parameters.iter().any(|x| x.is_nan()) {
            continue;
        }
        let octaves = Octaves::new(sum, &parameters);
        let size = random.one_of(&[1e-5, 1e-3, 0.02, 0.2]);
        let segment = Segment {
            middle: random.point(),
            reach: DVec3::new(
                random.within(-1.0, 1.0),
                random.within(-1.0, 1.0),
                random.within(-1.0, 1.0),
            ) * size,
        };
        let Some((values, rate)) = octaves.along(segment) else {
            continue;
        };
        let at = |s: f64| octaves.value(segment.middle + segment.reach * s);
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for _ in 0..20 {
            let (a, b) = (random.within(-1.0, 1.0), random.within(-1.0, 1.0));
            let (p, q) = (at(a), at(b));
            assert!(values.contains(p), "{sum:?} {parameters:?} {p} {values:?}");
            (low, high) = (low.min(p).min(q), high.max(p).max(q));
            if rate.nan {
                continue;
            }
            let (x, y) = ((b - a) * rate.min, (b - a) * rate.max);
            // Coordinates are rounded, too, by the gradient noise to multiples of 2⁻²⁹.
            let mut step = match octaves.generator {
                NoiseGenerator::Perlin => 4e-9,
                _ => 2e-15 * segment.middle.abs().max_element(),
            };
            for _ in 1..octaves.count {
                step *= parameters[usize::from(sum != Sum::Ridge)].abs().max(1.0);
            }
            let largest = values.max.abs().max(values.min.abs()) + 1.0;
            let room = 1e-11 * largest + 100.0 * step * largest;
            let change = q - p;
            assert!(
                x.min(y) - room <= change && change <= x.max(y) + room,
                "{sum:?} {parameters:?} {segment:?}: {change}, not {x}..{y}"
            );
        }
        if !rate.nan {
            known += 1;
            narrow += u32::from(values.max - values.min < 3.0 * (high - low));
            steep += u32::from(rate.min > 0.0 || rate.max < 0.0);
        }
    }
    assert!(known > 1500, "{known}");
    assert!(narrow > known / 3, "{narrow} of {known}");
    assert!(steep > known / 3, "{steep} of {known}");
}
