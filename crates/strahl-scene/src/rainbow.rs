use crate::Span;
use strahl_math::{DVec3, det};
use strahl_shade::pigment::{Blend, BlendMap};
use strahl_shade::{Color, ColorFt};

/// A rainbow: a ring of colours around a direction, in front of the background (POV-Ray's model, whose formulas were measured).
///
/// Where the angle `α` between ray and direction is within half the `width` of `angle`, the map has the colour at
/// `(α - angle) / width + 1/2`. With the weight `w` of the arc at the ray's place around the ring, the share
/// `T = max(exp(-length / distance), 1 - w (1 - transmit))` of the light from behind passes, tinted by `1 - f + f·colour`,
/// `f = filter (1 - T)`; the rainbow adds `(1 - T)·colour`. Of several rainbows seen at one place the mean holds.
#[derive(Clone, Debug, PartialEq)]
pub struct Rainbow {
    /// Unit direction of the light that makes it: that of the rays to its centre.
    pub direction: DVec3,
    /// The direction from the centre to the middle of the arc.
    pub up: DVec3,
    /// Degrees from the centre to the middle of the ring.
    pub angle: f64,
    /// Degrees from its inner to its outer edge; positive.
    pub width: f64,
    /// Degrees of the visible arc; 360 is the whole ring, and more never fades out.
    pub arc_angle: f64,
    /// Degrees along the ring that have their full strength; from there to the ends of the arc it fades.
    pub falloff_angle: f64,
    /// The least distance of objects that the rainbow covers; infinite for a rainbow behind all objects.
    pub distance: f64,
    /// The colours from the inner to the outer edge.
    pub colors: BlendMap<ColorFt>,
    /// The amplitude of the random offset in the map, which differs from direction to direction.
    pub jitter: f64,
    /// The place in the scene that made it.
    pub span: Span,
}

impl Rainbow {
    /// The attenuation of light from the end of a ray by the rainbow, and the light it adds; `None` outside of the arc.
    pub fn along(&self, direction: DVec3, length: f64) -> Option<(Color, Color)> {
        let toward = direction.normalize_or_zero();
        let angle = det::acos(toward.dot(self.direction).clamp(-1.0, 1.0)).to_degrees();
        let place = (angle - self.angle) / self.width + 0.5 + self.jitter * random(toward);
        if !(0.0..=1.0).contains(&place) {
            return None;
        }
        let weight = self.weight(toward);
        if weight == 0.0 {
            return None;
        }
        let color = match self.colors.lookup(place)? {
            Blend::One(color) => *color,
            Blend::Two(low, high, t) => low.lerp(*high, t),
        };
        let before = if self.distance == f64::INFINITY {
            if length == f64::INFINITY { 0.0 } else { 1.0 }
        } else {
            det::exp(-length / self.distance)
        };
        let clear = 1.0 - weight * (1.0 - color.transmit);
        let passes = if before > clear { before } else { clear };
        let filter = color.filter * (1.0 - passes);
        let tint = Color::gray(1.0 - filter) + color.rgb * filter;
        Some((tint * passes, color.rgb * (1.0 - passes)))
    }

    /// The weight of the arc in a direction around the ring.
    fn weight(&self, toward: DVec3) -> f64 {
        let (full, end) = (0.5 * self.falloff_angle, 0.5 * self.arc_angle);
        if full >= 180.0 && end >= 180.0 {
            return 1.0;
        }
        let flat = |v: DVec3| (v - self.direction * v.dot(self.direction)).normalize_or_zero();
        let cos = flat(toward).dot(flat(self.up));
        let around = det::acos(cos.clamp(-1.0, 1.0)).to_degrees();
        if around > end {
            0.0
        } else if around <= full {
            1.0
        } else {
            let s = (around - full) / (end - full);
            1.0 - s * s * (3.0 - 2.0 * s)
        }
    }
}

/// A number from -1 to 1 that depends on a direction alone.
fn random(direction: DVec3) -> f64 {
    // splitmix64's mixing function (Steele et al., OOPSLA 2014) over the bits of the coordinates.
    let mix = |mut z: u64| {
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    };
    let coordinates = direction.to_array();
    let hash = coordinates.iter().fold(0x9e37_79b9_7f4a_7c15, |h: u64, x| {
        mix(h.wrapping_add(x.to_bits()))
    });
    (hash >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bow(color: ColorFt) -> Rainbow {
        Rainbow {
            direction: DVec3::Z,
            up: DVec3::Y,
            angle: 15.0,
            width: 20.0,
            arc_angle: 360.0,
            falloff_angle: 360.0,
            distance: f64::INFINITY,
            colors: BlendMap::new(vec![(0.0, color), (1.0, color)]),
            jitter: 0.0,
            span: Span::NONE,
        }
    }

    /// The direction so many degrees from the centre and around it.
    fn at(angle: f64, around: f64) -> DVec3 {
        let (a, b) = (angle.to_radians(), around.to_radians());
        DVec3::new(a.sin() * b.sin(), a.sin() * b.cos(), a.cos())
    }

    /// Measured with POV-Ray 3.7, 16 bits per channel.
    #[test]
    fn rainbows_are_as_measured() {
        let sky = Color::new(0.3, 0.6, 0.9);
        let filtering = ColorFt {
            rgb: Color::new(0.5, 0.2, 0.8),
            filter: 0.6,
            transmit: 0.3,
        };
        let arc = Rainbow {
            arc_angle: 120.0,
            falloff_angle: 60.0,
            ..bow(filtering)
        };
        let near = Rainbow {
            distance: 5.0,
            ..bow(filtering)
        };
        let far = f64::INFINITY;
        // At 21.052 degrees a plane at z = 5 is 5.3576 away.
        let cases = [
            (
                bow(filtering),
                at(15.0, 90.0),
                far,
                [0.4211, 0.2595, 0.8073],
            ),
            (arc.clone(), at(15.0, 45.0), far, [0.3495, 0.3945, 0.8404]),
            (near, at(21.052, 90.0), 5.3576, [0.4112, 0.2721, 0.8099]),
        ];
        for (bow, direction, length, expected) in cases {
            let (keeps, adds) = bow.along(direction * 3.0, length).expect("seen");
            let seen = (sky * keeps + adds).to_array();
            for (s, e) in seen.iter().zip(expected) {
                assert!((s - e).abs() < 2e-4, "{seen:?} is not {expected:?}");
            }
        }
        assert!(arc.along(at(15.0, 61.0), far).is_none());
        assert!(arc.along(at(26.0, 0.0), far).is_none() && arc.along(at(4.0, 0.0), far).is_none());
    }

    #[test]
    fn a_rainbow_lies_behind_all_things_unless_it_has_a_distance() {
        let red = ColorFt::opaque(Color::new(1.0, 0.0, 0.0));
        let (keeps, adds) = bow(red).along(at(15.0, 0.0), 1e12).expect("seen");
        assert_eq!((keeps, adds), (Color::WHITE, Color::BLACK));
        let (keeps, adds) = bow(red).along(at(15.0, 0.0), f64::INFINITY).expect("seen");
        assert_eq!((keeps, adds), (Color::BLACK, red.rgb));
    }
}
