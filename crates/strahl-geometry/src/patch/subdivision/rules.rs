//! The rules of subdivision about one vertex: where it moves, where it ends, and how sharp it is.
//!
//! Faces that share a vertex compute its rules from their own copies of what is around it, beginning at different places. So all
//! sums are taken in an order that depends on the numbers alone, and neighbours agree to the last bit.

use super::SubdivisionScheme;
use std::sync::{Arc, OnceLock};
use strahl_math::{Aabb, DVec3, det};

/// Edges and vertices that are at least so sharp stay sharp for ever, as in OpenSubdiv.
pub(super) const SHARPEST: f64 = 10.0;
/// What remains around an irregular vertex is replaced by one patch when it has shrunk by so many powers of two.
const SHRUNK: f64 = 30.0;

/// What is around the end of a crease shrinks by 2/3 in each round at least, and has no size after so many.
const ROUNDS: u32 = 100;

/// Faces at a vertex with more edges share one fan, and those of later levels. What they need for themselves must not grow with the
/// number of edges, or the cost of the vertex grows with its square.
pub(super) const FEW: usize = 64;

/// No vertex is divided to a deeper level: [`depth`] of a vertex with edges without number.
pub(super) const DEEPEST: u32 = 50;

/// An edge at a vertex.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spoke {
    /// Its other end.
    pub(super) point: DVec3,
    /// 0 for a smooth edge, infinite for a border or a crease for ever.
    pub(super) sharpness: f64,
    /// The [`Fan::depth`] of the other end.
    pub(super) depth: u32,
}

/// A face at a vertex.
#[derive(Clone, Copy, Debug)]
pub(super) struct Facet {
    /// The mean of its corners; unused by Loop's scheme.
    pub(super) center: DVec3,
    /// Its number of corners; 0 for the gap at a vertex of the border.
    pub(super) sides: u32,
}

impl Facet {
    pub(super) const GAP: Self = Self {
        center: DVec3::ZERO,
        sides: 0,
    };
}

/// A vertex with all that is around it, counter-clockwise: facet `j` is between the spokes `j` and `j + 1`.
#[derive(Clone, Debug)]
pub(super) struct Fan {
    pub(super) point: DVec3,
    /// Where the vertex ends on the limit surface, since its rule has not changed any more.
    pub(super) limit: Option<DVec3>,
    /// An irregular vertex as it was when its rules became final, relative to itself, and how many levels ago that was.
    pub(super) origin: Option<Arc<Fan>>,
    pub(super) age: u32,
    /// The sharpness of the vertex itself.
    pub(super) sharpness: f64,
    /// 0 for a vertex about which the surface is made of regular patches; otherwise the level at which its faces are no
    /// longer divided.
    pub(super) depth: u32,
    pub(super) spokes: Vec<Spoke>,
    pub(super) facets: Vec<Facet>,
    /// What all faces at a vertex with many edges share; `None` if it has few.
    shared: Option<Box<Shared>>,
}

/// What follows from a fan, computed when a face asks for it first.
#[derive(Clone, Debug, Default)]
struct Shared {
    refined: OnceLock<Arc<Fan>>,
    nearer: OnceLock<Arc<Fan>>,
    pole: OnceLock<Pole>,
    hull: OnceLock<Aabb>,
    carriers: OnceLock<Option<[DVec3; 2]>>,
}

/// What is the same for all faces at the tip of an irregular vertex.
#[derive(Clone, Copy, Debug)]
struct Pole {
    rule: Rule,
    /// The largest coordinate of a spoke.
    size: f64,
    /// The direction of the normal of a smooth vertex.
    around: DVec3,
}

/// The surface about an irregular vertex.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tip {
    /// The normal, on the side of its first face.
    pub(super) normal: Option<DVec3>,
}

/// How a vertex moves.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Rule {
    Smooth,
    /// Along a curve through two neighbours.
    Crease(usize, usize),
    /// Not at all.
    Corner,
}

/// The sum of vectors in the order of their coordinates.
pub(super) fn sum(points: impl Iterator<Item = DVec3>) -> DVec3 {
    let mut all: Vec<DVec3> = points.collect();
    all.sort_by(|a, b| {
        a.x.total_cmp(&b.x)
            .then(a.y.total_cmp(&b.y))
            .then(a.z.total_cmp(&b.z))
    });
    all.into_iter().fold(DVec3::ZERO, |sum, p| sum + p)
}

/// The mean of the corners of a face with four corners, in their order.
pub(super) fn mean4(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> DVec3 {
    ((a + c) + (b + d)) * 0.25
}

/// The mean of the corners of a face.
pub(super) fn mean(corners: &[DVec3]) -> DVec3 {
    if let [a, b, c, d] = *corners {
        return mean4(a, b, c, d);
    }
    sum(corners.iter().copied()) / corners.len() as f64
}

/// The sharpness on the next level.
pub(super) fn duller(sharpness: f64) -> f64 {
    if sharpness > 1.0 {
        sharpness - 1.0
    } else {
        0.0
    }
}

fn is_settled(sharpness: f64) -> bool {
    sharpness == 0.0 || sharpness == f64::INFINITY
}

/// The level at which the faces around an irregular vertex of this valence are small enough.
///
/// They shrink by the eigenvalue of the subdivision that comes after 1 (J. Stam, "Exact evaluation of Catmull-Clark subdivision
/// surfaces at arbitrary parameter values", SIGGRAPH 1998, section 4; C. Loop, "Smooth subdivision surfaces based on
/// triangles", 1987).
pub(super) fn depth(scheme: SubdivisionScheme, valence: u32) -> u32 {
    let c = det::cos(std::f64::consts::TAU / f64::from(valence));
    let shrinks = match scheme {
        SubdivisionScheme::CatmullClark => {
            (5.0 + c + ((c + 9.0) * (c + 1.0).max(0.0)).sqrt()) / 16.0
        }
        SubdivisionScheme::Loop => 0.375 + 0.25 * c,
    };
    let shrinks = shrinks.max(0.25);
    (SHRUNK * std::f64::consts::LN_2 / -det::ln(shrinks)).ceil() as u32
}

impl Fan {
    /// A vertex, without what follows from this.
    pub(super) fn new(
        point: DVec3,
        sharpness: f64,
        spokes: Vec<Spoke>,
        facets: Vec<Facet>,
    ) -> Self {
        Self {
            point,
            limit: None,
            origin: None,
            age: 0,
            sharpness,
            depth: 0,
            shared: shared(spokes.len()),
            spokes,
            facets,
        }
    }

    /// The index of the spoke so many places after another one.
    pub(super) fn turn(&self, j: usize, places: usize) -> usize {
        (j + places) % self.spokes.len()
    }

    /// The index of the spoke before.
    pub(super) fn before(&self, j: usize) -> usize {
        self.turn(j, self.spokes.len() - 1)
    }

    fn rule(&self, is_next: bool) -> Rule {
        let sharp = |s: f64| (if is_next { duller(s) } else { s }) > 0.0;
        if sharp(self.sharpness) {
            return Rule::Corner;
        }
        let mut edges = (0..self.spokes.len()).filter(|j| sharp(self.spokes[*j].sharpness));
        match (edges.next(), edges.next(), edges.next()) {
            (Some(a), Some(b), None) => Rule::Crease(a, b),
            (_, _, None) => Rule::Smooth,
            _ => Rule::Corner,
        }
    }

    /// Whether nothing about the rules changes on later levels.
    fn is_final(&self) -> bool {
        is_settled(self.sharpness) && self.spokes.iter().all(|s| is_settled(s.sharpness))
    }

    fn moved_by(&self, scheme: SubdivisionScheme, rule: Rule) -> DVec3 {
        let v = self.point;
        match rule {
            Rule::Corner => v,
            Rule::Crease(a, b) => (v * 6.0 + (self.spokes[a].point + self.spokes[b].point)) * 0.125,
            Rule::Smooth => {
                let n = self.spokes.len() as f64;
                let spokes = sum(self.spokes.iter().map(|s| s.point));
                match scheme {
                    SubdivisionScheme::CatmullClark => {
                        let facets = sum(self.facets.iter().map(|f| f.center));
                        ((spokes + facets) + v * (n * (n - 2.0))) / (n * n)
                    }
                    SubdivisionScheme::Loop => {
                        let weight = loop_weight(self.spokes.len());
                        v * (1.0 - n * weight) + spokes * weight
                    }
                }
            }
        }
    }

    /// The vertex on the next level.
    ///
    /// Where sharpness ends between two levels, the rules of both are blended (T. DeRose, M. Kass, T. Truong, "Subdivision surfaces
    /// in character animation", SIGGRAPH 1998, section 3).
    pub(super) fn moved(&self, scheme: SubdivisionScheme) -> DVec3 {
        let (now, next) = (self.rule(false), self.rule(true));
        let place = self.moved_by(scheme, now);
        if now == next {
            return place;
        }
        let all = self.spokes.iter().map(|s| s.sharpness);
        let ends = |s: &f64| *s > 0.0 && duller(*s) == 0.0;
        let mut ending: Vec<f64> = all.chain([self.sharpness]).filter(ends).collect();
        ending.sort_by(f64::total_cmp);
        let part = ending.iter().sum::<f64>() / ending.len() as f64;
        place * part + self.moved_by(scheme, next) * (1.0 - part)
    }

    /// The new vertex on spoke `j`.
    pub(super) fn edge_point(&self, scheme: SubdivisionScheme, j: usize) -> DVec3 {
        let Spoke {
            point, sharpness, ..
        } = self.spokes[j];
        let middle = (self.point + point) * 0.5;
        if sharpness >= 1.0 {
            return middle;
        }
        let (before, after) = (self.before(j), self.turn(j, 1));
        let smooth = match scheme {
            SubdivisionScheme::CatmullClark => {
                let sides = self.facets[before].center + self.facets[j].center;
                ((self.point + point) + sides) * 0.25
            }
            SubdivisionScheme::Loop => {
                let sides = self.spokes[before].point + self.spokes[after].point;
                ((self.point + point) * 3.0 + sides) * 0.125
            }
        };
        if sharpness == 0.0 {
            smooth
        } else {
            smooth * (1.0 - sharpness) + middle * sharpness
        }
    }

    /// The limit of the vertex if all rules stay as they are.
    fn end(&self, scheme: SubdivisionScheme) -> DVec3 {
        let v = self.point;
        match self.rule(false) {
            Rule::Corner => v,
            Rule::Crease(a, b) => (v * 4.0 + (self.spokes[a].point + self.spokes[b].point)) / 6.0,
            Rule::Smooth if self.spokes.iter().any(|s| s.sharpness > 0.0) => {
                // The end of a crease has no simple formula; what is around it shrinks to its limit. The steps are computed
                // relative to the vertex, so that their errors shrink, too.
                let (mut fan, mut way) = (self.relative(), DVec3::ZERO);
                for _ in 0..ROUNDS {
                    fan = fan.divided(scheme);
                    way += fan.point;
                    fan = fan.relative();
                }
                v + way
            }
            Rule::Smooth => {
                let n = self.spokes.len() as f64;
                let spokes = sum(self.spokes.iter().map(|s| s.point));
                match scheme {
                    SubdivisionScheme::CatmullClark => {
                        let facets = sum(self.facets.iter().map(|f| f.center));
                        ((spokes * 2.0 + facets * 4.0) + v * (n * (n - 1.0))) / (n * (n + 5.0))
                    }
                    SubdivisionScheme::Loop => {
                        let own = 0.375 / loop_weight(self.spokes.len());
                        (v * own + spokes) / (own + n)
                    }
                }
            }
        }
    }

    /// Whether all faces around the vertex can be regular patches, and if not, when they are small enough.
    fn own_depth(&self, scheme: SubdivisionScheme) -> u32 {
        let (sides, around) = match scheme {
            SubdivisionScheme::CatmullClark => (4, 4),
            SubdivisionScheme::Loop => (3, 6),
        };
        let faces = self.facets.iter().filter(|f| f.sides != 0).count();
        // The largest number of faces between sharp edges.
        let mut sectors: Vec<usize> = vec![];
        let sharp = (0..self.spokes.len()).filter(|j| self.spokes[*j].sharpness > 0.0);
        let sharp: Vec<usize> = sharp.collect();
        for (k, from) in sharp.iter().enumerate() {
            let to = sharp[(k + 1) % sharp.len()];
            let count = (to + self.spokes.len() - from - 1) % self.spokes.len() + 1;
            if self.facets[*from].sides != 0 {
                sectors.push(count);
            }
        }
        let are = |count: usize| sectors.iter().all(|s| *s == count);
        let is_regular = self.is_final()
            && self.facets.iter().all(|f| f.sides == sides || f.sides == 0)
            && match self.rule(false) {
                Rule::Smooth => sharp.is_empty() && faces == around,
                Rule::Crease(..) => are(around / 2),
                Rule::Corner => !sectors.is_empty() && are(1),
            };
        if is_regular {
            return 0;
        }
        let most = sectors.iter().copied().max().unwrap_or(0);
        let valence = if sharp.len() < 2 {
            faces.max(around)
        } else {
            (2 * most).max(around)
        };
        let valence = if self.is_final() && sharp.is_empty() {
            faces
        } else {
            valence
        };
        if self.rule(false) == Rule::Corner && sharp.len() < 2 {
            // The tip of a cone shrinks along its axis as if there were faces without number.
            return depth(scheme, u32::MAX);
        }
        depth(scheme, valence as u32)
    }

    /// Sets what follows from the rest.
    pub(super) fn finished(mut self, scheme: SubdivisionScheme) -> Self {
        if self.limit.is_none() && self.is_final() {
            self.limit = Some(self.end(scheme));
        }
        self.depth = self.own_depth(scheme);
        if self.origin.is_none() && self.depth > 0 && self.is_final() {
            self.origin = Some(Arc::new(self.relative()));
        }
        self
    }

    /// The same, relative to the vertex.
    fn relative(&self) -> Self {
        let (mut spokes, mut facets) = (self.spokes.clone(), self.facets.clone());
        for spoke in &mut spokes {
            spoke.point -= self.point;
        }
        for facet in facets.iter_mut().filter(|f| f.sides != 0) {
            facet.center -= self.point;
        }
        Self::new(DVec3::ZERO, self.sharpness, spokes, facets)
    }

    /// What is known of the surface about an irregular vertex, on the side of facet `first`, from what is around it on this level; `None`
    /// if the vertex is regular, or its rules still change, or the facet is not narrower than the limit.
    ///
    /// The spokes are computed relative to the vertex from the level on from which the rules don't change, and doubled on each
    /// level: nothing is lost to cancellation, however near to the vertex they are.
    pub(super) fn tip(
        &self,
        scheme: SubdivisionScheme,
        first: usize,
        limit: Option<f64>,
    ) -> Option<Tip> {
        let mut fan = Arc::clone(self.origin.as_ref()?);
        for _ in 0..self.age {
            fan = fan.nearer(scheme);
        }
        let pole = fan.pole(first);
        let doubled = 2.0_f64.powi(self.age as i32);
        // Across the longer side of the facet.
        let width = fan.cross(first, pole.size).length() * pole.size / doubled;
        if limit.is_some_and(|limit| width >= limit || width.is_nan()) {
            return None;
        }
        let normal = fan.normal(first, &pole).try_normalize();
        Some(Tip { normal })
    }

    /// What is around a vertex at the origin on the next level, twice as large.
    fn nearer(&self, scheme: SubdivisionScheme) -> Arc<Self> {
        let make = || {
            let mut fan = self.divided(scheme).relative();
            fan.spokes.iter_mut().for_each(|s| s.point *= 2.0);
            fan.facets.iter_mut().for_each(|f| f.center *= 2.0);
            Arc::new(fan)
        };
        match &self.shared {
            Some(shared) => Arc::clone(shared.nearer.get_or_init(make)),
            None => make(),
        }
    }

    fn pole(&self, first: usize) -> Pole {
        let make = |first: usize| {
            let size = self.spokes.iter().fold(0.0, |most: f64, s| {
                let far = s.point.abs().max_element();
                if far > most { far } else { most }
            });
            let rule = self.rule(false);
            let around = match rule {
                Rule::Smooth => (0..self.facets.len())
                    .map(|k| self.cross(self.turn(first, k), size))
                    .sum(),
                _ => DVec3::ZERO,
            };
            Pole { rule, size, around }
        };
        match &self.shared {
            Some(shared) => *shared.pole.get_or_init(|| make(0)),
            None => make(first),
        }
    }

    /// The normal of facet `j` about a vertex at the origin.
    fn cross(&self, j: usize, size: f64) -> DVec3 {
        let [a, b] = [j, self.turn(j, 1)].map(|j| self.spokes[j].point / size);
        a.cross(b)
    }

    /// The direction of the normal about a vertex at the origin, on the side of facet `first`.
    fn normal(&self, first: usize, pole: &Pole) -> DVec3 {
        let is_sharp = |j: usize| self.spokes[j].sharpness > 0.0;
        match pole.rule {
            Rule::Smooth => pole.around,
            Rule::Crease(..) => {
                // The faces on this side of the crease.
                let (mut from, mut to) = (first, self.turn(first, 1));
                while !is_sharp(from) {
                    from = self.before(from);
                }
                while !is_sharp(to) {
                    to = self.turn(to, 1);
                }
                let count = (to + self.spokes.len() - from) % self.spokes.len();
                (0..count)
                    .map(|k| self.cross(self.turn(from, k), pole.size))
                    .sum()
            }
            Rule::Corner if (0..self.spokes.len()).any(is_sharp) => self.cross(first, pole.size),
            // About the tip of a cone normals point in all directions.
            Rule::Corner => DVec3::ZERO,
        }
    }

    /// Where the vertex ends.
    pub(super) fn place(&self, scheme: SubdivisionScheme) -> DVec3 {
        self.limit.unwrap_or_else(|| self.end(scheme))
    }

    /// The vertex on the next level, with the new vertices on its edges and the new faces at it.
    pub(super) fn refined(&self, scheme: SubdivisionScheme) -> Arc<Self> {
        let make = || Arc::new(self.divided(scheme).finished(scheme));
        match &self.shared {
            Some(shared) => Arc::clone(shared.refined.get_or_init(make)),
            None => make(),
        }
    }

    /// The same, without what follows from the rest.
    fn divided(&self, scheme: SubdivisionScheme) -> Self {
        let count = self.spokes.len();
        let point = self.moved(scheme);
        let spokes: Vec<Spoke> = (0..count)
            .map(|j| {
                let sharpness = duller(self.spokes[j].sharpness);
                Spoke {
                    point: self.edge_point(scheme, j),
                    sharpness,
                    depth: edge_depth(scheme, sharpness),
                }
            })
            .collect();
        let facets = (0..count)
            .map(|j| match (self.facets[j].sides, scheme) {
                (0, _) => Facet::GAP,
                (_, SubdivisionScheme::Loop) => self.facets[j],
                _ => Facet {
                    center: mean4(
                        point,
                        spokes[j].point,
                        self.facets[j].center,
                        spokes[self.turn(j, 1)].point,
                    ),
                    sides: 4,
                },
            })
            .collect();
        Self {
            point,
            limit: self.limit,
            origin: self.origin.clone(),
            age: self.age + 1,
            sharpness: duller(self.sharpness),
            depth: 0,
            shared: shared(spokes.len()),
            spokes,
            facets,
        }
    }

    /// Two points so that the vertex is within the triangle of itself and them on all later levels, too; `None` if they are not known.
    fn find_carriers(&self, scheme: SubdivisionScheme) -> Option<[DVec3; 2]> {
        if !self.is_final() {
            return None;
        }
        match self.rule(false) {
            Rule::Corner => Some([self.point; 2]),
            Rule::Crease(a, b) => Some([a, b].map(|j| self.spokes[j].point)),
            Rule::Smooth if self.spokes.iter().any(|s| s.sharpness > 0.0) => None,
            Rule::Smooth => {
                // The vertex and the means of its neighbours depend on each other alone, with positive weights.
                let n = self.spokes.len() as f64;
                let spokes = sum(self.spokes.iter().map(|s| s.point)) / n;
                Some(match scheme {
                    SubdivisionScheme::CatmullClark => {
                        [spokes, sum(self.facets.iter().map(|f| f.center)) / n]
                    }
                    SubdivisionScheme::Loop => [spokes; 2],
                })
            }
        }
    }

    /// A box around facet `first` on all levels from this one on.
    ///
    /// All points of later levels are means of those around the vertex, with positive weights. Points near the facet depend on facets
    /// that are one further away on each level, and on the vertex: of many facets the far ones don't count.
    pub(super) fn hull(&self, scheme: SubdivisionScheme, first: usize, level: u32) -> Aabb {
        let all = 0..self.spokes.len();
        let Some(shared) = &self.shared else {
            return Aabb::from_points(self.points(scheme, all));
        };
        let carriers = shared.carriers.get_or_init(|| self.find_carriers(scheme));
        // The patches of the last level reach one spoke further than their facet, and are compared with those of the next.
        let reach = (DEEPEST.saturating_sub(level) + 3) as usize;
        match carriers {
            Some(carriers) if 2 * reach + 2 < self.spokes.len() => {
                let from = self.turn(first, self.spokes.len() - reach);
                let near = (0..2 * reach + 2).map(|k| self.turn(from, k));
                Aabb::from_points(self.points(scheme, near).chain(*carriers))
            }
            _ => *shared
                .hull
                .get_or_init(|| Aabb::from_points(self.points(scheme, all))),
        }
    }

    /// The vertex, and these of its spokes and facets, from which points of later levels are made.
    fn points(
        &self,
        scheme: SubdivisionScheme,
        which: impl Iterator<Item = usize> + Clone,
    ) -> impl Iterator<Item = DVec3> {
        let has_centers = scheme == SubdivisionScheme::CatmullClark;
        let facets = which
            .clone()
            .map(|j| self.facets[j])
            .filter(move |f| has_centers && f.sides != 0)
            .map(|f| f.center);
        let spokes = which.map(|j| self.spokes[j].point);
        std::iter::once(self.point).chain(spokes).chain(facets)
    }

    /// The bytes that it takes, with what it has made for all faces.
    pub(super) fn bytes(&self) -> usize {
        let mut sum = size_of::<Self>()
            + size_of_val(self.spokes.as_slice())
            + size_of_val(self.facets.as_slice());
        if let Some(shared) = &self.shared {
            let made = [&shared.refined, &shared.nearer];
            let made = made.into_iter().filter_map(|fan| fan.get());
            sum += size_of::<Shared>() + made.map(|fan| fan.bytes()).sum::<usize>();
        }
        sum
    }

    /// Whether all faces at the vertex share it.
    pub(super) fn is_shared(&self) -> bool {
        self.shared.is_some()
    }
}

fn shared(spokes: usize) -> Option<Box<Shared>> {
    (spokes > FEW).then(Box::default)
}

/// The depth of a new vertex on an edge that has this sharpness from now on.
fn edge_depth(scheme: SubdivisionScheme, sharpness: f64) -> u32 {
    if is_settled(sharpness) {
        return 0;
    }
    match scheme {
        SubdivisionScheme::CatmullClark => depth(scheme, 4),
        SubdivisionScheme::Loop => depth(scheme, 6),
    }
}

/// The depth of a new vertex in a face of so many sides.
pub(super) fn face_depth(scheme: SubdivisionScheme, sides: u32) -> u32 {
    if sides == 4 { 0 } else { depth(scheme, sides) }
}

/// The weight of a neighbour in Loop's rule.
fn loop_weight(valence: usize) -> f64 {
    let n = valence as f64;
    let c = 0.375 + 0.25 * det::cos(std::f64::consts::TAU / n);
    (0.625 - c * c) / n
}
