use super::super::event::{Event, Question};
use super::component::{Chord, Inner, Part};
use super::{Blob, BlobComponent, Index, bits_of};
use std::ops::ControlFlow;
use strahl_accel::{Accelerator, TraversalStats, Visitor};
use strahl_math::error::gamma;
use strahl_math::roots::{Bernstein, RootCount, Window, find_root};
use strahl_math::{DVec3, Interval, Ray};

/// Working memory of a walk along a ray.
#[derive(Clone, Debug, Default)]
pub(crate) struct Pieces {
    /// The intervals of the ray within the fields of the parts of components, sorted by their beginnings.
    list: Vec<Piece>,
    /// Their ends, ascending.
    places: Vec<f64>,
    /// The intervals around the current position.
    active: Vec<u32>,
}

/// An interval of the ray within the field of a part of a component.
#[derive(Clone, Copy, Debug)]
struct Piece {
    low: f64,
    high: f64,
    component: u32,
    part: Part,
    strength: f64,
    /// A bound of the field, see [`Chord::most`].
    most: f64,
}

impl Pieces {
    pub(crate) fn clear(&mut self) {
        self.list.clear();
        self.places.clear();
        self.active.clear();
    }
}

/// The threshold less the field between two places, as a polynomial in `s` from 0 to 1: negative inside.
#[derive(Clone, Copy)]
struct Stretch {
    low: f64,
    width: f64,
    coefficients: [f64; 5],
    /// Bound on the sum of the errors of the coefficients.
    error: f64,
    /// Whether the components are too weak for a surface.
    empty: bool,
}

/// Collects pieces along the ray.
struct Collector<'a> {
    components: &'a [BlobComponent],
    start: DVec3,
    along: DVec3,
    list: &'a mut Vec<Piece>,
}

impl Visitor for Collector<'_> {
    fn visit(&mut self, id: u32, t_max: f64) -> f64 {
        if let Some(component) = self.components.get(id as usize) {
            let inner = component.inner(self.start, self.along);
            component.stretches(&inner, |part, chord| {
                let Chord { low, high, most } = chord;
                self.list.push(Piece {
                    low,
                    high,
                    component: id,
                    part,
                    strength: component.strength(),
                    most,
                });
            });
        }
        t_max
    }
}

impl Blob {
    /// Reports the crossings along the ray to the visitor, until it stops.
    pub(super) fn walk(
        &self,
        ray: &Ray,
        question: &Question,
        pieces: &mut Pieces,
        visit: &mut dyn FnMut(Event) -> ControlFlow<()>,
    ) {
        let along = ray.direction;
        if !(ray.origin.is_finite() && along.is_finite()) || along == DVec3::ZERO {
            return;
        }
        let on_surface = question.on_surface;
        let reach = if on_surface {
            Interval::FORWARD
        } else {
            Interval::LINE
        };
        let Some(clip) = self.reach.clip(ray, reach) else {
            return;
        };
        // Measured from where the ray enters the bounds, so that the distance of its origin does not matter.
        let offset = if on_surface { 0.0 } else { clip.min };
        let start = ray.origin + along * offset;
        if !start.is_finite() {
            return;
        }
        self.collect(start, along, clip, question, pieces);
        let mut walk = Walk {
            blob: self,
            start,
            along,
            offset,
            question,
            started: false,
            visit,
        };
        // The result only matters while visiting.
        let _ = walk.run(pieces);
    }

    fn collect(
        &self,
        start: DVec3,
        along: DVec3,
        clip: Interval,
        question: &Question,
        pieces: &mut Pieces,
    ) {
        let mut collector = Collector {
            components: &self.components,
            start,
            along,
            list: &mut pieces.list,
        };
        match &self.index {
            Index::Balls(balls) => {
                for id in bits_of(balls.met_by(start, along)) {
                    collector.visit(id as u32, f64::INFINITY);
                }
            }
            Index::Tree(tree) => {
                let ray = Ray::new(start, along);
                let behind = if question.on_surface { 0.0 } else { clip.min };
                let length = clip.max - behind;
                // Slightly longer than the way through the box: rounding must not lose an interval.
                let range = Interval::new(-0.01 * length, 1.01 * length);
                tree.traverse(&ray, range, &mut collector, &mut TraversalStats::default());
            }
        }
        if question.on_surface {
            pieces.list.retain(|piece| piece.high > 0.0);
        }
        // Most rays near a blob miss it: they meet its fields where these are weak.
        if !question.on_surface && self.is_out_of_reach(pieces.list.iter()) {
            pieces.list.clear();
            return;
        }
        let key = |p: &Piece| (p.component, p.part);
        pieces
            .list
            .sort_unstable_by(|a, b| a.low.total_cmp(&b.low).then(key(a).cmp(&key(b))));
        let ends = pieces.list.iter().flat_map(|p| [p.low, p.high]);
        pieces.places.extend(ends);
        pieces.places.sort_unstable_by(f64::total_cmp);
        pieces.places.dedup();
    }

    /// Whether the field is certainly below the threshold where no more than these pieces are, by more than all errors of the polynomials.
    fn is_out_of_reach<'p>(&self, pieces: impl Iterator<Item = &'p Piece>) -> bool {
        const SURELY: f64 = 1.0 - 1e-9;
        let most: f64 = pieces.map(|p| p.most).filter(|most| *most > 0.0).sum();
        most < self.threshold * SURELY
    }
}

struct Walk<'a> {
    blob: &'a Blob,
    start: DVec3,
    along: DVec3,
    /// The parameter of the start.
    offset: f64,
    question: &'a Question,
    /// Whether the visitor has been told the state at the start of the range.
    started: bool,
    visit: &'a mut dyn FnMut(Event) -> ControlFlow<()>,
}

impl Walk<'_> {
    /// Goes from interval to interval, always knowing the next one: where two meet, the sign of the later one counts for both.
    fn run(&mut self, pieces: &mut Pieces) -> ControlFlow<()> {
        let Pieces {
            list,
            places,
            active,
        } = pieces;
        let mut waiting = list.iter().enumerate().peekable();
        let mut known: Option<Stretch> = None;
        for pair in places.windows(2) {
            let &[low, high] = pair else { continue };
            active.retain(|i| list.get(*i as usize).is_some_and(|p| p.high > low));
            while let Some((i, _)) = waiting.next_if(|(_, piece)| piece.low <= low) {
                active.push(i as u32);
            }
            let (low, on_surface) = match self.question.on_surface {
                true if high <= 0.0 => continue,
                true if low < 0.0 => (0.0, true),
                surface => (low, surface && low == 0.0),
            };
            let stretch = self.stretch(list, active, low, high, on_surface);
            if let Some(known) = known.replace(stretch) {
                self.cross(&known, stretch.positive_at_start())?;
            }
        }
        match known {
            // Behind the last piece there is no field.
            Some(known) => self.cross(&known, true),
            None => ControlFlow::Continue(()),
        }
    }

    fn stretch(
        &self,
        list: &[Piece],
        active: &[u32],
        low: f64,
        high: f64,
        on_surface: bool,
    ) -> Stretch {
        let threshold = self.blob.threshold;
        let width = high - low;
        let pieces = || active.iter().filter_map(|i| list.get(*i as usize));
        let mut stretch = Stretch {
            low,
            width,
            coefficients: [threshold, 0.0, 0.0, 0.0, 0.0],
            error: 0.0,
            empty: !on_surface && self.blob.is_out_of_reach(pieces()),
        };
        if stretch.empty {
            return stretch;
        }
        let (start, along) = (self.start + self.along * low, self.along * width);
        let mut magnitude = threshold;
        for piece in pieces() {
            let Some(component) = self.blob.components.get(piece.component as usize) else {
                continue;
            };
            let inner: Inner = component.inner(start, along);
            let [a, b, c] = component.closeness(piece.part, &inner);
            let square = [a * a, 2.0 * a * b, b * b + 2.0 * a * c, 2.0 * b * c, c * c];
            for (sum, part) in stretch.coefficients.iter_mut().zip(square) {
                *sum -= piece.strength * part;
            }
            let size = 2.0 + a.abs() + b.abs() + c.abs();
            magnitude += piece.strength.abs() * size * size;
        }
        stretch.error = gamma(16 + 2 * active.len() as u32) * magnitude;
        if on_surface {
            // The root at the start is known and divided out; the quotient has the sign of the polynomial.
            let [_, c1, c2, c3, c4] = stretch.coefficients;
            stretch.coefficients = [c1, c2, c3, c4, 0.0];
        }
        stretch
    }

    /// Visits the crossings of one stretch.
    fn cross(&mut self, stretch: &Stretch, positive_at_end: bool) -> ControlFlow<()> {
        let Stretch {
            low,
            width,
            coefficients,
            error,
            empty,
        } = stretch;
        let range = self.question.range;
        let positive = stretch.positive_at_start();
        let end = self.offset + (low + width);
        // The next interval knows everything that an interval which ends before the range could tell.
        if end <= range.min {
            return ControlFlow::Continue(());
        }
        if !std::mem::replace(&mut self.started, true) {
            (self.visit)(Event::Start { inside: !positive })?;
        }
        let begin = self.offset + low;
        if begin > range.max && begin >= range.min {
            return ControlFlow::Break(());
        }
        if *empty && positive && positive_at_end {
            return ControlFlow::Continue(());
        }
        let polynomial = Bernstein::on_unit_interval(coefficients, *error);
        let mut window = Window {
            from: f64::NEG_INFINITY,
            to: f64::INFINITY,
            starts_negative: None,
        };
        polynomial.isolate_within((positive, positive_at_end), &mut window, &mut |part| {
            if part.count == RootCount::Even {
                return ControlFlow::Continue(());
            }
            let s = find_root(part.low(), part.high(), part.rising, part.estimate(), |s| {
                stretch.value_and_slope(s)
            });
            let t = self.offset + (low + s * width);
            let t_error = if self.question.errors {
                gamma(4) * t.abs() + stretch.root_error(s) * width + self.start_error(t)
            } else {
                0.0
            };
            let enters = !part.rising;
            (self.visit)(Event::Crossing { t, t_error, enters })
        })
    }

    /// The error of a parameter caused by rounding the points on the ray.
    fn start_error(&self, t: f64) -> f64 {
        let reach = self.start.abs() + self.along.abs() * t.abs();
        gamma(8) * reach.length() / self.along.length()
    }
}

impl Stretch {
    fn positive_at_start(&self) -> bool {
        let [first, ..] = self.coefficients;
        first >= 0.0
    }

    fn value_and_slope(&self, s: f64) -> (f64, f64) {
        let [c0, c1, c2, c3, c4] = self.coefficients;
        (
            c0 + s * (c1 + s * (c2 + s * (c3 + s * c4))),
            c1 + s * (2.0 * c2 + s * (3.0 * c3 + s * (4.0 * c4))),
        )
    }

    fn root_error(&self, s: f64) -> f64 {
        let [_, _, c2, c3, c4] = self.coefficients;
        let (_, slope) = self.value_and_slope(s);
        let bend = c2 + s * (3.0 * c3 + s * (6.0 * c4));
        let (straight, tangent) = (self.error / slope.abs(), (self.error / bend.abs()).sqrt());
        let error = if straight < tangent || !tangent.is_finite() {
            straight
        } else {
            tangent
        };
        let most = gamma(1).sqrt();
        if error < most { error } else { most }
    }
}
