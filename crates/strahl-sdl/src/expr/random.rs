//! `seed` and `rand`: POV-Ray 3.7's streams of random numbers.
//!
//! Found by experiment: the printed value of the first call after `seed(0)` is 12345 / (2^32 - 1), that after `seed(1)` gives the
//! multiplier, and both predict all others (see the table in the tests).

use crate::parser::{PResult, Parser, Place};

const MULTIPLIER: u32 = 1_812_433_253;
const INCREMENT: u32 = 12_345;

/// One step of the generator: the new state and the number in `0..=1`.
fn step(state: u32) -> (u32, f64) {
    let next = state.wrapping_mul(MULTIPLIER).wrapping_add(INCREMENT);
    (next, f64::from(next) / f64::from(u32::MAX))
}

/// The state for a seed, which is truncated to an integer; a number too large for 32 bits becomes the smallest integer, as x86
/// processors convert it.
fn initial(seed: f64) -> u32 {
    let whole = seed.trunc();
    if (-2_147_483_648.0..2_147_483_648.0).contains(&whole) {
        whole as i32 as u32
    } else {
        i32::MIN as u32
    }
}

impl Parser<'_> {
    /// Opens a stream; its number is the value.
    pub(super) fn seed(&mut self, seed: f64, place: Place) -> PResult<f64> {
        const STREAMS: usize = 1 << 24;
        if self.random.len() >= STREAMS {
            let message = format!("the scene opens more than {STREAMS} random streams");
            return Err(self.fail_fatally(place, message, "open the stream once, before the loop"));
        }
        self.random.push(initial(seed));
        Ok((self.random.len() - 1) as f64)
    }

    /// The next number of a stream.
    pub(super) fn rand(&mut self, stream: f64, place: Place) -> PResult<f64> {
        let index = stream as usize;
        match self.random.get_mut(index) {
            Some(state) if stream >= 0.0 => {
                let (next, number) = step(*state);
                *state = next;
                Ok(number)
            }
            _ => Err(self.fail_hint(
                place,
                format!("there is no random stream {stream}"),
                "open one first: `#declare Stream = seed(1);`, then `rand(Stream)`",
            )),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_numbers_are_those_of_povray() {
        // Printed by POV-Ray 3.7.0.10: `#debug str(rand(seed(N)),0,17)` and the calls after it.
        let measured: &[(f64, &str)] = &[
            (
                123.0,
                "0.90477298221196345 0.99513786891362110 0.51866659301302087 0.17814718353984579",
            ),
            (
                0.0,
                "0.00000287429429658 0.46656368450880137 0.24907022883395438 0.96587604213642797",
            ),
            (
                1.0,
                "0.42199287526821549 0.48712119820693534 0.66589621563113677 0.97573190507845298",
            ),
            (-1.0, "0.57801287355320830"),
            (2.7, "0.84398287624213442"),
            (2.0, "0.84398287624213442"),
            (4_294_967_301.0, "0.50000287441071189"),
            (5.0, "0.10995287869822999"),
        ];
        for (seed, numbers) in measured {
            let mut state = initial(*seed);
            for expected in numbers.split(' ') {
                let (next, number) = step(state);
                assert_eq!(format!("{number:.17}"), expected, "seed {seed}");
                state = next;
            }
        }
    }
}
