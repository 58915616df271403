//! The first hits of four rays with an extrusion, side by side.
//!
//! These are the operations of [`Extrusion`]'s own test in the same order, so the hits have the same bits. Rays that start on the extrusion, that run along
//! its axis, or that may touch a curve are left to that test.

use super::curve::Piece;
use super::extrusion::{Extrusion, FIRST_WALL, HIGH_CAP, LOW_CAP};
use super::runs::Rect;
use crate::blocks::LANES;
use crate::blocks::convex::FourRays;
use crate::{PrimHit, SurfaceId};
use strahl_math::error::gamma;
use strahl_math::roots::newton_of_four;
use strahl_math::{DVec2, Interval, Ray};
use strahl_simd::{Isa, select};

/// The first hits of four rays.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct FourHits {
    /// The lanes whose first hit is known, as bits.
    known: u32,
    /// Those of them that have one.
    met: u32,
    t: [f64; LANES],
    facet: [u32; LANES],
    uv: [[f64; 2]; LANES],
}

impl FourHits {
    /// The first hit of a lane in a range that begins where the search began and doesn't reach further; `None` if it isn't known.
    #[inline]
    pub(crate) fn closest(&self, lane: usize, range: Interval) -> Option<Option<PrimHit>> {
        if self.known >> lane & 1 == 0 {
            return None;
        }
        let hit = PrimHit {
            t: self.t[lane],
            surface: SurfaceId {
                element: 0,
                facet: self.facet[lane],
            },
            uv: self.uv[lane],
        };
        let counts = self.met >> lane & 1 == 1 && range.accepts(hit.t);
        Some(counts.then_some(hit))
    }
}

/// A shape that finds the first hits of four rays at once.
pub(crate) trait FourFirstHits {
    /// The first hits of those of four rays that are `wanted`, as bits, at parameters of at least `min` and at most `max`; none of them starts on the shape.
    fn first_hits<I: Isa>(
        &self,
        isa: I,
        rays: FourRays<I>,
        wanted: u32,
        min: f64,
        max: I::F64x4,
    ) -> FourHits;
}

/// Straight lines in the plane of an outline, as [`Cut`](super::outline::Cut).
struct FourCuts<I: Isa> {
    normal: [I::F64x4; 2],
    anchor: [I::F64x4; 2],
    offset: I::F64x4,
}

impl<I: Isa> FourCuts<I> {
    #[inline(always)]
    fn sided(&self, isa: I, point: DVec2) -> Sided<I> {
        let side = self.side(isa, point);
        let above = isa.le(isa.splat(0.0), side);
        Sided { point, side, above }
    }

    #[inline(always)]
    fn side(&self, isa: I, p: DVec2) -> I::F64x4 {
        let ([x, y], [ax, ay]) = (self.normal, self.anchor);
        let x = isa.mul(x, isa.sub(isa.splat(p.x), ax));
        let y = isa.mul(y, isa.sub(isa.splat(p.y), ay));
        isa.add(isa.add(x, y), self.offset)
    }

    /// The errors of the sides of points of an outline that reaches so far.
    #[inline(always)]
    fn error(&self, isa: I, reach: DVec2) -> I::F64x4 {
        let ([nx, ny], [ax, ay]) = (self.normal, self.anchor);
        let x = isa.mul(isa.abs(nx), isa.add(isa.splat(reach.x), isa.abs(ax)));
        let y = isa.mul(isa.abs(ny), isa.add(isa.splat(reach.y), isa.abs(ay)));
        let sum = isa.add(isa.add(x, y), isa.abs(self.offset));
        isa.mul(isa.splat(gamma(16)), sum)
    }

    /// The lanes whose line may meet a rectangle.
    #[inline(always)]
    fn near(&self, isa: I, &Rect { min, max }: &Rect, error: I::F64x4) -> u32 {
        let (middle, size) = ((min + max) * 0.5, max - min);
        let ([x, y], half) = (self.normal, isa.splat(0.5));
        let x = isa.mul(isa.mul(isa.abs(x), half), isa.splat(size.x));
        let y = isa.mul(isa.mul(isa.abs(y), half), isa.splat(size.y));
        let side = isa.abs(self.side(isa, middle));
        isa.le(side, isa.add(isa.add(x, y), error))
    }
}

/// What the crossings with the walls that were met so far say, as [`Walls`](super::extrusion::Walls); lanes are bits.
struct FourWalls<I: Isa> {
    /// The lanes that something must be found out about.
    active: u32,
    /// Those with a crossing.
    any: u32,
    /// Those with an odd number of crossings before the apex.
    within: u32,
    /// Those with an odd number of crossings up to the place where the search begins.
    passed: u32,
    /// The first crossing behind it: its ray parameter, that on the piece, and the piece's number from 1 on, negative where the curve falls.
    t: I::F64x4,
    s: I::F64x4,
    wall: I::F64x4,
}

/// How rays meet walls.
struct Sweep<I: Isa> {
    rays: FourRays<I>,
    conic: bool,
    /// Where the search begins, and where it ends.
    begin: I::F64x4,
    far: I::F64x4,
    /// The ray parameters of the apex; negative infinity without one.
    apex: I::F64x4,
    /// The larger one of the direction's two components in the plane, and the lanes where it is the first.
    across: I::F64x4,
    by_x: u32,
    /// One over the larger component, and the errors of parameters found with it.
    inverse: I::F64x4,
    room: I::F64x4,
}

impl<I: Isa> Sweep<I> {
    /// The ray parameter of a control point, of rays that are not conic; rounded.
    #[inline(always)]
    fn about(&self, isa: I, p: DVec2) -> I::F64x4 {
        let [ox, oy, _] = self.rays.origin;
        let (x, y) = (isa.sub(isa.splat(p.x), ox), isa.sub(isa.splat(p.y), oy));
        isa.mul(select(isa, self.by_x, x, y), self.inverse)
    }

    /// The ray parameters of points of the outline.
    #[inline(always)]
    fn parameter(&self, isa: I, [x, y]: [I::F64x4; 2]) -> I::F64x4 {
        let ([ox, oy, oz], [dx, dy, dz]) = (self.rays.origin, self.rays.direction);
        if !self.conic {
            let way = select(isa, self.by_x, isa.sub(x, ox), isa.sub(y, oy));
            return isa.div(way, self.across);
        }
        let aside = [x, y, isa.splat(1.0)];
        let a = cross(isa, aside, [ox, oy, oz]);
        let b = cross(isa, aside, [dx, dy, dz]);
        // As `quotient`.
        let (x, y, z) = (isa.abs(b[0]), isa.abs(b[1]), isa.abs(b[2]));
        let first = isa.le(y, x) & isa.le(z, x);
        let second = isa.le(z, y);
        let a = select(isa, first, a[0], select(isa, second, a[1], a[2]));
        let b = select(isa, first, b[0], select(isa, second, b[1], b[2]));
        isa.div(negated(isa, a), b)
    }
}

#[inline(always)]
fn cross<I: Isa>(isa: I, a: [I::F64x4; 3], b: [I::F64x4; 3]) -> [I::F64x4; 3] {
    [
        isa.sub(isa.mul(a[1], b[2]), isa.mul(b[1], a[2])),
        isa.sub(isa.mul(a[2], b[0]), isa.mul(b[2], a[0])),
        isa.sub(isa.mul(a[0], b[1]), isa.mul(b[0], a[1])),
    ]
}

impl<I: Isa> FourWalls<I> {
    /// Finds the crossings with a line.
    #[inline(always)]
    fn meet_line(&self, isa: I, [first, last]: [Sided<I>; 2]) -> Option<Met<I>> {
        let lanes = (first.above ^ last.above) & self.active;
        if lanes == 0 {
            return None;
        }
        let s = isa.div(first.side, isa.sub(first.side, last.side));
        let [a, b] = [first.in_all_lanes(isa), last.in_all_lanes(isa)];
        Some(Met {
            lanes,
            rising: last.above,
            s,
            point: mix(isa, with_rest(isa, s), a, b),
        })
    }

    /// Finds the crossings with a parabola, and leaves lanes alone whose lines do more than cross it once.
    #[inline(always)]
    fn meet_parabola(
        &mut self,
        isa: I,
        sweep: &Sweep<I>,
        points: [Sided<I>; 3],
        error: I::F64x4,
    ) -> Option<Met<I>> {
        let [first, middle, last] = points;
        let changed = (first.above ^ middle.above) | (middle.above ^ last.above);
        if changed & self.active == 0 {
            return None;
        }
        let values = [first.side, middle.side, last.side];
        let twice = !(first.above ^ last.above) & changed;
        let apart = twice & keep_apart(isa, values, error);
        let single = !twice & changed & all_beyond(isa, error, &points);
        self.active &= single | apart | !changed;
        let lanes = self.open(isa, sweep, single, &points);
        if lanes == 0 {
            return None;
        }
        let rising = !first.above;
        let s = single_roots_of_parabolas(isa, values, rising);
        let part = with_rest(isa, s);
        let [a, b, c] = [
            first.in_all_lanes(isa),
            middle.in_all_lanes(isa),
            last.in_all_lanes(isa),
        ];
        let (ab, bc) = (mix(isa, part, a, b), mix(isa, part, b, c));
        Some(Met {
            lanes,
            rising,
            s,
            point: mix(isa, part, ab, bc),
        })
    }

    /// The same with a cubic.
    #[inline(always)]
    fn meet_cubic(
        &mut self,
        isa: I,
        sweep: &Sweep<I>,
        points: [Sided<I>; 4],
        error: I::F64x4,
    ) -> Option<Met<I>> {
        let [first, second, third, last] = points;
        let changes = [
            first.above ^ second.above,
            second.above ^ third.above,
            third.above ^ last.above,
        ];
        let changed = changes[0] | changes[1] | changes[2];
        if changed & self.active == 0 {
            return None;
        }
        let thrice = changes[0] & changes[1] & changes[2];
        let single = (first.above ^ last.above) & !thrice & all_beyond(isa, error, &points);
        self.active &= single | !changed;
        let lanes = self.open(isa, sweep, single, &points);
        if lanes == 0 {
            return None;
        }
        let rising = !first.above;
        let values = [first.side, second.side, third.side, last.side];
        let s = single_roots_of_cubics(isa, values, changes, lanes, rising);
        let part = with_rest(isa, s);
        let [a, b] = [first.in_all_lanes(isa), second.in_all_lanes(isa)];
        let [c, d] = [third.in_all_lanes(isa), last.in_all_lanes(isa)];
        let (ab, bc, cd) = (
            mix(isa, part, a, b),
            mix(isa, part, b, c),
            mix(isa, part, c, d),
        );
        let (abc, bcd) = (mix(isa, part, ab, bc), mix(isa, part, bc, cd));
        Some(Met {
            lanes,
            rising,
            s,
            point: mix(isa, part, abc, bcd),
        })
    }

    /// Of the lanes that cross a curve once those whose crossing has to be found: the others are passed, or lie too far away.
    #[inline(always)]
    fn open<const N: usize>(
        &mut self,
        isa: I,
        sweep: &Sweep<I>,
        lanes: u32,
        points: &[Sided<I>; N],
    ) -> u32 {
        let lanes = lanes & self.active;
        if sweep.conic {
            return lanes;
        }
        // A curve lies between its control points.
        let (mut low, mut high) = (isa.splat(f64::INFINITY), isa.splat(f64::NEG_INFINITY));
        for point in points {
            let t = sweep.about(isa, point.point);
            (low, high) = (isa.min(t, low), isa.max(t, high));
        }
        let passed = lanes & isa.le(isa.add(high, sweep.room), sweep.begin);
        let low = isa.sub(low, sweep.room);
        let behind = lanes & (isa.lt(self.t, low) | isa.lt(sweep.far, low));
        self.any |= passed | behind;
        self.passed ^= passed;
        lanes & !(passed | behind)
    }

    /// Takes the crossings with a piece.
    #[inline(always)]
    fn take(&mut self, isa: I, sweep: &Sweep<I>, number: usize, met: &Met<I>) {
        let Met { lanes, rising, .. } = *met;
        let t = sweep.parameter(isa, met.point);
        self.active &= isa.le(isa.abs(t), isa.splat(f64::MAX)) | !lanes;
        self.any |= lanes;
        self.within ^= lanes & isa.lt(t, sweep.apex);
        let passed = isa.le(t, sweep.begin);
        self.passed ^= lanes & passed;
        let first = lanes & !passed & isa.lt(t, self.t);
        if first != 0 {
            let number = (number + 1) as f64;
            let wall = select(isa, rising, isa.splat(number), isa.splat(-number));
            self.t = select(isa, first, t, self.t);
            self.s = select(isa, first, met.s, self.s);
            self.wall = select(isa, first, wall, self.wall);
        }
    }
}

/// Places on pieces, and what is left of the pieces.
#[inline(always)]
fn with_rest<I: Isa>(isa: I, s: I::F64x4) -> [I::F64x4; 2] {
    [s, isa.sub(isa.splat(1.0), s)]
}

/// Points between others, as [`Piece::at`] finds them.
#[inline(always)]
fn mix<I: Isa>(
    isa: I,
    [s, rest]: [I::F64x4; 2],
    a: [I::F64x4; 2],
    b: [I::F64x4; 2],
) -> [I::F64x4; 2] {
    [
        isa.add(isa.mul(a[0], rest), isa.mul(b[0], s)),
        isa.add(isa.mul(a[1], rest), isa.mul(b[1], s)),
    ]
}

/// The lanes whose parabolas have no root although their middle control points lie on the other side than both ends; as that of the outline.
#[inline(always)]
fn keep_apart<I: Isa>(isa: I, [a, b, c]: [I::F64x4; 3], error: I::F64x4) -> u32 {
    let zero = isa.splat(0.0);
    let (a, c) = (isa.sub(isa.abs(a), error), isa.sub(isa.abs(c), error));
    let b = isa.add(isa.abs(b), error);
    let most = isa.mul(isa.mul(a, c), isa.splat(1.0 - gamma(8)));
    isa.lt(zero, a) & isa.lt(zero, c) & isa.lt(isa.mul(b, b), most)
}

/// The roots of parabolas that have one from 0 to 1, as [`SingleRoot`](super::outline::SingleRoot) finds them.
#[inline(always)]
fn single_roots_of_parabolas<I: Isa>(isa: I, [a, b, end]: [I::F64x4; 3], rising: u32) -> I::F64x4 {
    let (zero, one) = (isa.splat(0.0), isa.splat(1.0));
    let h = isa.sub(b, a);
    let c = isa.add(isa.sub(a, b), isa.sub(end, b));
    let discriminant = isa.sub(isa.mul(h, h), isa.mul(a, c));
    let positive = isa.lt(zero, discriminant);
    let root = select(isa, positive, isa.sqrt(discriminant), zero);
    let slope = select(isa, rising, root, negated(isa, root));
    let stable = !(isa.le(zero, h) ^ rising);
    let over = select(isa, stable, negated(isa, a), isa.sub(slope, h));
    let s = isa.div(over, select(isa, stable, isa.add(h, slope), c));
    let s = select(isa, isa.lt(s, one), s, one);
    select(isa, isa.lt(zero, s), s, zero)
}

/// The same for cubics.
#[inline(always)]
fn single_roots_of_cubics<I: Isa>(
    isa: I,
    values: [I::F64x4; 4],
    changes: [u32; 3],
    lanes: u32,
    rising: u32,
) -> I::F64x4 {
    let [a, b, c, d] = values;
    let (two, three) = (isa.splat(2.0), isa.splat(3.0));
    let (ab, bc) = (isa.sub(b, a), isa.sub(c, b));
    let p = isa.mul(three, ab);
    let q = isa.mul(three, isa.sub(bc, ab));
    let r = isa.sub(isa.sub(d, a), isa.mul(three, bc));
    let mut guess = isa.splat(0.0);
    for (k, change) in changes.into_iter().enumerate() {
        let part = isa.div(values[k], isa.sub(values[k], values[k + 1]));
        let here = isa.mul(isa.add(isa.splat(k as f64), part), isa.splat(1.0 / 3.0));
        guess = select(isa, change, here, guess);
    }
    newton_of_four(
        isa,
        lanes,
        rising,
        guess,
        #[inline(always)]
        |s| {
            let inner = isa.add(q, isa.mul(s, r));
            let value = isa.add(a, isa.mul(s, isa.add(p, isa.mul(s, inner))));
            let inner = isa.add(isa.mul(two, q), isa.mul(s, isa.mul(three, r)));
            let slope = isa.add(p, isa.mul(s, inner));
            (value, isa.div(value, slope))
        },
    )
}

impl Extrusion<'_> {
    /// The first hits of those of four rays, in the extrusion's own space, that are `wanted`, from `min` to `max`; none of them starts on the extrusion.
    #[inline(always)]
    pub(super) fn first_hits<I: Isa>(
        &self,
        isa: I,
        rays: FourRays<I>,
        wanted: u32,
        min: f64,
        max: I::F64x4,
    ) -> FourHits {
        let mut out = FourHits::default();
        let ([ox, oy, oz], [dx, dy, dz]) = (rays.origin, rays.direction);
        let (zero, infinity) = (isa.splat(0.0), isa.splat(f64::INFINITY));
        let largest = isa.splat(f64::MAX);
        let level = isa.le(dz, zero) & isa.le(zero, dz);
        let mut usual = wanted & !level;
        for x in [ox, oy, oz, dx, dy, dz] {
            usual &= isa.le(isa.abs(x), largest);
        }
        if min.is_sign_negative() {
            return out;
        }

        // Between the caps.
        let a = isa.div(isa.sub(isa.splat(self.low), oz), dz);
        let b = isa.div(isa.sub(isa.splat(self.high), oz), dz);
        let ordered = isa.lt(a, b);
        let (near, far) = (select(isa, ordered, a, b), select(isa, ordered, b, a));
        usual &= isa.le(isa.abs(near), largest) & isa.le(isa.abs(far), largest);
        let start = isa.splat(min);
        let comes_in = isa.lt(start, near);
        let active = usual & isa.lt(near, far) & isa.lt(start, far) & isa.le(near, max);
        out.known = usual & !active;
        if active == 0 {
            return out;
        }

        let (cuts, apex) = if self.conic {
            let [nx, ny, offset] = cross(isa, rays.origin, rays.direction);
            let cuts = FourCuts {
                normal: [nx, ny],
                anchor: [zero; 2],
                offset,
            };
            (cuts, isa.div(negated(isa, oz), dz))
        } else {
            let cuts = FourCuts {
                normal: [negated(isa, dy), dx],
                anchor: [ox, oy],
                offset: zero,
            };
            (cuts, isa.splat(f64::NEG_INFINITY))
        };
        let (nx, ny) = (isa.abs(cuts.normal[0]), isa.abs(cuts.normal[1]));
        let by_x = isa.le(isa.abs(dy), isa.abs(dx));
        let across = select(isa, by_x, dx, dy);
        let inverse = isa.div(isa.splat(1.0), across);
        let reach = isa.splat(self.outline.reach().max_element());
        let size = isa.add(reach, isa.max(isa.abs(ox), isa.abs(oy)));
        let sweep = Sweep {
            rays,
            conic: self.conic,
            begin: select(isa, comes_in, near, start),
            apex,
            across,
            by_x,
            inverse,
            room: isa.mul(isa.mul(isa.splat(gamma(32)), size), isa.abs(inverse)),
            far,
        };
        let mut walls = FourWalls {
            active: active & (isa.lt(zero, nx) | isa.lt(zero, ny)),
            any: 0,
            within: 0,
            passed: 0,
            t: infinity,
            s: zero,
            wall: zero,
        };
        self.meet_walls(isa, &cuts, &sweep, &mut walls);

        let FourWalls { any, .. } = walls;
        let within = walls.within ^ walls.passed;
        let capped = if self.capped { !0 } else { 0 };
        let low = any & within & comes_in & capped;
        let side = any & !low & isa.lt(walls.t, far);
        let high = any & !low & !side & within & capped;
        out.known |= walls.active;
        out.met = walls.active & (low | side | high);
        if out.met == 0 {
            return out;
        }
        let t = select(isa, low, near, select(isa, side, walls.t, far));
        (out.t, out.known) = (isa.store(t), out.known & 0b1111);
        let (s, wall) = (isa.store(walls.s), isa.store(walls.wall));
        let upwards = isa.lt(zero, dz);
        for lane in 0..LANES {
            let is_in = |lanes: u32| lanes >> lane & 1 == 1;
            if !is_in(side) {
                let lower = is_in(low) == is_in(upwards);
                out.facet[lane] = if lower { LOW_CAP } else { HIGH_CAP };
                continue;
            }
            let piece = wall[lane].abs() as u32 - 1;
            out.facet[lane] = FIRST_WALL.saturating_add(piece);
            let rises = if wall[lane] > 0.0 { 1.0 } else { -1.0 };
            out.uv[lane] = [s[lane], rises];
        }
        if out.met & side != 0 {
            self.find_outer_sides(isa, &sweep.rays, &mut out, side, within);
        }
        out
    }

    /// Which side of the curve is outside where rays meet walls.
    #[inline(always)]
    fn find_outer_sides<I: Isa>(
        &self,
        isa: I,
        rays: &FourRays<I>,
        out: &mut FourHits,
        side: u32,
        within: u32,
    ) {
        let rays: [Ray; LANES] = rays.rays(isa);
        for (lane, ray) in rays.iter().enumerate() {
            if out.met & side & 1 << lane != 0
                && let Some(Some(hit)) = out.closest(lane, Interval::LINE)
            {
                let enters = within >> lane & 1 == 0;
                out.uv[lane][1] = self.outer_side(ray, &hit, enters);
            }
        }
    }

    /// Takes all crossings with walls.
    #[inline(always)]
    fn meet_walls<I: Isa>(
        &self,
        isa: I,
        cuts: &FourCuts<I>,
        sweep: &Sweep<I>,
        walls: &mut FourWalls<I>,
    ) {
        let error = cuts.error(isa, self.outline.reach());
        let asked = walls.active;
        self.outline.visit_leaves(
            #[inline(always)]
            |bounds| cuts.near(isa, bounds, error) & asked != 0,
            #[inline(always)]
            |first, pieces| {
                // The end of a piece is mostly the start of the next one.
                let mut end: Option<Sided<I>> = None;
                for (number, piece) in (first..).zip(pieces) {
                    let start = match end {
                        Some(end) if end.point == piece.start() => end,
                        _ => cuts.sided(isa, piece.start()),
                    };
                    let found = match *piece {
                        Piece::Line([_, b]) => {
                            let points = [start, cuts.sided(isa, b)];
                            end = Some(points[1]);
                            walls.meet_line(isa, points)
                        }
                        Piece::Quadratic([_, b, c]) => {
                            let points = [start, cuts.sided(isa, b), cuts.sided(isa, c)];
                            end = Some(points[2]);
                            walls.meet_parabola(isa, sweep, points, error)
                        }
                        Piece::Cubic([_, b, c, d]) => {
                            let (b, c) = (cuts.sided(isa, b), cuts.sided(isa, c));
                            let d = cuts.sided(isa, d);
                            end = Some(d);
                            walls.meet_cubic(isa, sweep, [start, b, c, d], error)
                        }
                    };
                    if let Some(met) = found {
                        walls.take(isa, sweep, number, &met);
                    }
                }
            },
        );
    }
}

/// A point of an outline, and on which sides of four lines it is.
#[derive(Clone, Copy)]
struct Sided<I: Isa> {
    point: DVec2,
    side: I::F64x4,
    /// The lanes where that is at least 0.
    above: u32,
}

impl<I: Isa> Sided<I> {
    #[inline(always)]
    fn in_all_lanes(&self, isa: I) -> [I::F64x4; 2] {
        [isa.splat(self.point.x), isa.splat(self.point.y)]
    }
}

/// Crossings of some lanes with a piece.
struct Met<I: Isa> {
    lanes: u32,
    /// The lanes in which the curve passes to the left of the ray.
    rising: u32,
    s: I::F64x4,
    point: [I::F64x4; 2],
}

/// The numbers with the other sign, also of zeros.
#[inline(always)]
fn negated<I: Isa>(isa: I, x: I::F64x4) -> I::F64x4 {
    isa.mul(x, isa.splat(-1.0))
}

/// The lanes whose points are all farther from the line than an error.
#[inline(always)]
fn all_beyond<I: Isa, const N: usize>(isa: I, error: I::F64x4, points: &[Sided<I>; N]) -> u32 {
    let mut lanes = !0;
    for point in points {
        lanes &= isa.lt(error, isa.abs(point.side));
    }
    lanes
}
