//! The stream of random numbers of the patterns that need one per cell.

use std::sync::LazyLock;

/// Uniform numbers in `0..1`: the first outputs of the Mersenne Twister with its customary seed 5489, divided by 2³².
///
/// That these are the numbers behind POV-Ray's `cells` and `crackle` was found by measurement. 4098 are needed: one per
/// hash, and two more for the last one's point.
static UNIFORM: LazyLock<Box<[f64]>> = LazyLock::new(|| {
    let mut twister = Twister::new(5489);
    (0..4098)
        .map(|_| f64::from(twister.next()) / 4_294_967_296.0)
        .collect()
});

/// Number `index` of the stream, for `index < 4098`; the stream is repeated beyond.
pub(super) fn uniform(index: usize) -> f64 {
    UNIFORM[index % 4098]
}

/// The first numbers of the stream: three from each hash below 4096 on.
pub(super) fn numbers() -> &'static [f64] {
    &UNIFORM
}

/// MT19937 (Matsumoto and Nishimura, "Mersenne Twister", ACM TOMACS 8, 1998).
struct Twister {
    state: [u32; 624],
    next: usize,
}

impl Twister {
    fn new(seed: u32) -> Self {
        let mut state = [seed; 624];
        for i in 1..624 {
            let previous = state[i - 1];
            state[i] = (previous ^ (previous >> 30))
                .wrapping_mul(1_812_433_253)
                .wrapping_add(i as u32);
        }
        Self { state, next: 624 }
    }

    fn next(&mut self) -> u32 {
        if self.next == 624 {
            for i in 0..624 {
                let y = (self.state[i] & 0x8000_0000) | (self.state[(i + 1) % 624] & 0x7fff_ffff);
                let twisted = (y >> 1) ^ if y & 1 == 1 { 0x9908_b0df } else { 0 };
                self.state[i] = self.state[(i + 397) % 624] ^ twisted;
            }
            self.next = 0;
        }
        let mut y = self.state[self.next];
        self.next += 1;
        y ^= y >> 11;
        y ^= (y << 7) & 0x9d2c_5680;
        y ^= (y << 15) & 0xefc6_0000;
        y ^ (y >> 18)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ten_thousandth_number_is_the_published_one() {
        let mut twister = Twister::new(5489);
        let last = (0..10_000).map(|_| twister.next()).last();
        assert_eq!(last, Some(4_123_659_995));
    }
}
