//! Several orbits side by side: each step waits for the one before, so one orbit alone leaves the processor idle most of the time.

use strahl_math::DVec2;
use strahl_simd::{Isa, Simd, dispatch};

use super::complex::{Complex, Four, OrbitPoint};
use super::{
    CONVERGED, FIRST_STRETCH, Fractal, FractalKind, Magnet1, Magnet2, Power, Rule, Square,
};

/// The number of orbits that are followed together.
const LANES: usize = 4;

/// One orbit: what the vectors do not hold.
#[derive(Clone, Copy)]
struct Orbit {
    /// The number of its point.
    index: usize,
    /// The steps that were taken.
    number: u32,
    /// The steps after which it ends.
    end: u32,
    /// Where the point was reached that the orbit may return to, and the steps from there to the next such point.
    seen_at: u32,
    stretch: u32,
}

impl Orbit {
    /// The steps to the next one after which something is to be done even if the orbit neither escapes nor returns.
    #[inline(always)]
    fn quiet(&self) -> u32 {
        let left = self.end - self.number;
        match self.stretch.checked_sub(self.number - self.seen_at) {
            None | Some(0) => left,
            Some(next) => left.min(next),
        }
    }
}

/// The numbers of four orbits, one for each lane.
struct Lanes {
    x: [f64; LANES],
    y: [f64; LANES],
    c_x: [f64; LANES],
    c_y: [f64; LANES],
    seen_x: [f64; LANES],
    seen_y: [f64; LANES],
    smallest: [f64; LANES],
}

impl Lanes {
    const EMPTY: Self = Self {
        x: [0.0; LANES],
        y: [0.0; LANES],
        c_x: [0.0; LANES],
        c_y: [0.0; LANES],
        seen_x: [0.0; LANES],
        seen_y: [0.0; LANES],
        smallest: [0.0; LANES],
    };

    #[inline(always)]
    fn point(&self, lane: usize) -> OrbitPoint<f64> {
        OrbitPoint::new(Complex::new(self.x[lane], self.y[lane]))
    }

    /// Takes at most `most` steps of all orbits, fewer if one of the `active` ones escapes, converges or returns to the real part of
    /// its seen point. Returns the steps taken, and a bit for each orbit that has escaped or converged.
    #[inline(always)]
    fn advance<I: Isa, R: Rule>(
        &mut self,
        isa: I,
        rule: R,
        bailout: f64,
        most: u32,
        active: u32,
    ) -> (u32, u32) {
        let number = |x: f64| Four::load(isa, &[x; LANES]);
        let (one, two, three) = (number(1.0), number(2.0), number(3.0));
        let c = Complex::new(Four::load(isa, &self.c_x), Four::load(isa, &self.c_y));
        let x = Four::load(isa, &self.x);
        let mut z = OrbitPoint::new(Complex::new(x, Four::load(isa, &self.y)));
        let seen_x = isa.load(&self.seen_x);
        let mut smallest = isa.load(&self.smallest);
        let (bailout, converged) = (isa.splat(bailout), isa.splat(CONVERGED));
        let (mut steps, mut ended) = (0, 0);
        while steps < most {
            z = OrbitPoint::new(rule.step(z, c, one, two, three));
            let absolute = (z.x2 + z.y2).numbers;
            smallest = isa.min(absolute, smallest);
            ended = !isa.le(absolute, bailout);
            if R::CONVERGES {
                ended |= isa.lt(z.distance2_from(one).numbers, converged);
            }
            steps += 1;
            let returned = isa.le(z.x.numbers, seen_x) & isa.le(seen_x, z.x.numbers);
            if (ended | returned) & active != 0 {
                break;
            }
        }
        self.x = isa.store(z.x.numbers);
        self.y = isa.store(z.y.numbers);
        self.smallest = isa.store(smallest);
        (steps, ended)
    }
}

/// Four orbits, whose places are taken by the next ones when they end.
struct Together<'a> {
    fractal: &'a Fractal,
    points: &'a [DVec2],
    values: &'a mut [f64],
    /// The number of the next point.
    next: usize,
    lanes: Lanes,
    orbits: [Option<Orbit>; LANES],
}

impl Together<'_> {
    #[inline(always)]
    fn run<I: Isa, R: Rule>(&mut self, isa: I, rule: R) {
        for lane in 0..LANES {
            self.begin(lane);
        }
        loop {
            let (mut most, mut active) = (u32::MAX, 0);
            for (lane, orbit) in self.orbits.iter().enumerate() {
                if let Some(orbit) = orbit {
                    most = most.min(orbit.quiet());
                    active |= 1 << lane;
                }
            }
            if active == 0 {
                return;
            }
            let bailout = self.fractal.bailout();
            let (steps, ended) = self.lanes.advance(isa, rule, bailout, most, active);
            for lane in 0..LANES {
                self.look_at(lane, steps, ended & (1 << lane) != 0);
            }
        }
    }

    /// Starts the orbit of the next point that needs one.
    fn begin(&mut self, lane: usize) {
        self.orbits[lane] = None;
        while self.orbits[lane].is_none()
            && let Some(point) = self.points.get(self.next)
        {
            match self.fractal.value_at_once(*point) {
                Some(value) => self.values[self.next] = value,
                None => self.put(lane, *point),
            }
            self.next += 1;
        }
    }

    fn put(&mut self, lane: usize, point: DVec2) {
        let lanes = &mut self.lanes;
        let c = self.fractal.julia.unwrap_or(point);
        (lanes.c_x[lane], lanes.c_y[lane]) = (c.x, c.y);
        let (z, smallest) = self.fractal.start(point.x, point.y);
        (lanes.x[lane], lanes.y[lane]) = (z.x, z.y);
        (lanes.seen_x[lane], lanes.seen_y[lane]) = (z.x, z.y);
        lanes.smallest[lane] = smallest;
        self.orbits[lane] = Some(Orbit {
            index: self.next,
            number: 0,
            end: self.fractal.iterations,
            seen_at: 0,
            stretch: FIRST_STRETCH,
        });
    }

    /// What [`Fractal::follow`] does after a step, for an orbit that has gone on by `steps`.
    fn look_at(&mut self, lane: usize, steps: u32, ended: bool) {
        let Some(orbit) = &mut self.orbits[lane] else {
            return;
        };
        let (z, lanes) = (self.lanes.point(lane), &mut self.lanes);
        orbit.number += steps;
        let value = if ended {
            self.fractal.outside(orbit.number - 1, z)
        } else {
            let round = orbit.number - orbit.seen_at;
            if z.x == lanes.seen_x[lane] && z.y == lanes.seen_y[lane] {
                orbit.end = orbit.number + (orbit.end - orbit.number) % round;
            } else if round == orbit.stretch {
                (lanes.seen_x[lane], lanes.seen_y[lane]) = (z.x, z.y);
                orbit.seen_at = orbit.number;
                orbit.stretch *= 2;
            }
            if orbit.number < orbit.end {
                return;
            }
            self.fractal.inside(z, lanes.smallest[lane])
        };
        self.values[orbit.index] = value;
        self.begin(lane);
    }
}

/// Stores what [`Fractal::value`] returns for each point.
pub(super) fn values(simd: Simd, fractal: &Fractal, points: &[DVec2], values: &mut [f64]) {
    let orbits = points
        .iter()
        .filter(|point| fractal.value_at_once(**point).is_none());
    if fractal.iterations == 0 || orbits.take(2).count() < 2 {
        for (point, value) in points.iter().zip(values) {
            *value = fractal.value(*point);
        }
        return;
    }
    let mut together = Together {
        fractal,
        points,
        values,
        next: 0,
        lanes: Lanes::EMPTY,
        orbits: [None; LANES],
    };
    match fractal.kind {
        FractalKind::Power { exponent: 2 } => dispatch!(simd, isa => together.run(isa, Square)),
        FractalKind::Power { exponent } => {
            dispatch!(simd, isa => together.run(isa, Power(exponent)));
        }
        FractalKind::Magnet1 => dispatch!(simd, isa => together.run(isa, Magnet1)),
        FractalKind::Magnet2 => dispatch!(simd, isa => together.run(isa, Magnet2)),
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Exterior, Interior};
    use super::*;

    /// Points in and around the sets, and some far away.
    fn points() -> Vec<DVec2> {
        let place = |n: i32| {
            DVec2::new(
                f64::from(n % 37) * 0.11 - 2.6,
                f64::from(n / 37) * 0.13 - 1.3,
            )
        };
        let mut points: Vec<DVec2> = (0..777).map(place).collect();
        points.extend([DVec2::splat(1e200), DVec2::NAN, DVec2::ZERO, DVec2::X]);
        points
    }

    fn check(fractal: &Fractal) {
        let points = points();
        let expected: Vec<u64> = points.iter().map(|p| fractal.value(*p).to_bits()).collect();
        for simd in Simd::available() {
            for size in [1, 2, 4, 16, points.len()] {
                let mut found = vec![0.0; points.len()];
                for (points, found) in points.chunks(size).zip(found.chunks_mut(size)) {
                    values(simd, fractal, points, found);
                }
                let found: Vec<u64> = found.into_iter().map(f64::to_bits).collect();
                assert!(found == expected, "{fractal:?}, {size}, {}", simd.level());
            }
        }
    }

    #[test]
    fn orbits_side_by_side_end_as_each_alone() {
        let kinds = [
            FractalKind::Power { exponent: 2 },
            FractalKind::Power { exponent: 3 },
            FractalKind::Power { exponent: 7 },
            FractalKind::Magnet1,
            FractalKind::Magnet2,
        ];
        for kind in kinds {
            for julia in [
                None,
                Some(DVec2::new(0.353, 0.288)),
                Some(DVec2::new(-1.0, 0.0)),
            ] {
                for iterations in [0, 1, 7, 8, 9, 60, 1000] {
                    for number in 0..7 {
                        check(&Fractal {
                            kind,
                            julia,
                            iterations,
                            exterior: Exterior::from_number(number, 0.3).expect("a number"),
                            interior: Interior::from_number(number, 0.7).expect("a number"),
                        });
                    }
                }
            }
        }
    }
}
