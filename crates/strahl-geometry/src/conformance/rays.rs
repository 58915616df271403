use super::Subject;
use strahl_math::{DVec3, Ray};

/// A small deterministic generator of random numbers: splitmix64 (Steele, Lea, Flood 2014).
#[derive(Clone, Debug)]
pub struct Random(u64);

impl Random {
    /// The generator of a seed.
    pub const fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// The next 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Uniform in `0..1`.
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Uniform in `low..high`.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// One of `0..n`.
    pub fn below(&mut self, n: u64) -> u64 {
        self.bits() % n.max(1)
    }

    /// A power of ten with an exponent uniform in `low..high`.
    pub fn magnitude(&mut self, low: f64, high: f64) -> f64 {
        strahl_math::det::pow(10.0, self.between(low, high))
    }

    /// A point of the cube from -1 to 1.
    pub fn cube(&mut self) -> DVec3 {
        DVec3::new(
            self.between(-1.0, 1.0),
            self.between(-1.0, 1.0),
            self.between(-1.0, 1.0),
        )
    }

    /// A unit vector, uniform over the sphere.
    pub fn direction(&mut self) -> DVec3 {
        loop {
            let v = self.cube();
            let length = v.length();
            if length > 0.1 && length <= 1.0 {
                return v / length;
            }
        }
    }
}

impl Subject {
    /// A point of the region.
    fn point(&self, random: &mut Random) -> DVec3 {
        self.region.center() + self.region.size() * 0.5 * random.cube()
    }

    /// A ray that probably hits: from within, nearby or far away towards a point of the region, of any length.
    pub(super) fn ray(&self, random: &mut Random) -> Ray {
        let target = self.point(random);
        let direction = random.direction();
        let distance = match random.below(8) {
            0 => 0.0,
            1 => random.magnitude(1.0, 5.0),
            _ => random.between(0.0, 4.0),
        };
        Ray::new(
            target - direction * (distance * self.size),
            direction * random.magnitude(-3.0, 3.0),
        )
    }

    /// A ray along an axis, often exactly through faces, edges, corners or the centre of the region.
    pub(super) fn axis_parallel_ray(&self, random: &mut Random) -> Ray {
        let mut origin = self.point(random);
        for k in 0..3 {
            match random.below(6) {
                0 => origin[k] = self.region.min[k],
                1 => origin[k] = self.region.max[k],
                2 => origin[k] = self.region.center()[k],
                _ => {}
            }
        }
        let axis = random.below(3) as usize;
        let sign = if random.below(2) == 0 { 1.0 } else { -1.0 };
        origin[axis] -= sign * self.size * random.between(0.0, 3.0);
        Ray::new(
            origin,
            DVec3::AXES[axis] * sign * random.magnitude(-2.0, 2.0),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::Random;

    #[test]
    fn the_generator_is_splitmix64() {
        // The first outputs for seed 1234567, from the reference implementation.
        let mut random = Random::new(1_234_567);
        assert_eq!(random.bits(), 6_457_827_717_110_365_317);
        assert_eq!(random.bits(), 3_203_168_211_198_807_973);
    }
}
