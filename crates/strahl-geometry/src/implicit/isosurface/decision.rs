//! Isosurfaces of functions whose sign polynomials decide: `x*x + y*y - z`, `f_sphere`, most of POV-Ray's functions of algebraic surfaces.

use super::Isosurface;
use super::trust::{direction, place};
use crate::algebraic::{Event, Question};
use crate::{Polynomial, Primitive as _};
use arrayvec::ArrayVec;
use std::ops::ControlFlow;
use strahl_function::{Region, Workspace};
use strahl_math::{Aabb, DVec3, Interval, Ray};

/// The most polynomials, and the most crossings of a ray with all of them.
const MOST: (usize, usize) = (8, 96);

/// Whether polynomials are as exact as the function is seen at so many crossings, which are looked for on so many lines: of surfaces that
/// lines hardly meet nothing is known.
const CROSSINGS: (u32, u32) = (100, 500);

/// Fewer crossings tell nothing.
const FEWEST: u32 = 20;

/// Crossings of the polynomials are this near to those of the function, as a part of the size of what is rendered.
const NEAR: f64 = 1e-7;

/// The inside of an isosurface by the signs of polynomials, which are solved along a ray instead of searching it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Decision {
    /// The coordinates of the polynomials are relative to this point.
    center: DVec3,
    polynomials: Vec<Polynomial>,
    rule: Rule,
}

/// What is inside, given of which polynomials a place is inside.
#[derive(Clone, Debug, PartialEq)]
enum Rule {
    /// What is inside of the polynomial of this number.
    Polynomial(usize),
    All(Vec<Rule>),
    Any(Vec<Rule>),
}

/// A set of numbers of polynomials.
#[derive(Clone, Copy, Default)]
struct Set(u32);

impl Set {
    fn has(self, number: usize) -> bool {
        self.0 >> number & 1 == 1
    }

    fn put(&mut self, number: usize, is_in: bool) {
        self.0 = self.0 & !(1 << number) | u32::from(is_in) << number;
    }
}

impl Rule {
    fn contains(&self, inside: Set) -> bool {
        match self {
            Self::Polynomial(number) => inside.has(*number),
            Self::All(parts) => parts.iter().all(|part| part.contains(inside)),
            Self::Any(parts) => parts.iter().any(|part| part.contains(inside)),
        }
    }
}

/// A crossing with one of several polynomials.
#[derive(Clone, Copy)]
struct Passing {
    t: f64,
    number: usize,
    enters: bool,
}

impl Decision {
    /// The decision of a region in coordinates relative to a center.
    fn new(region: &Region, center: DVec3) -> Option<Self> {
        let mut polynomials = vec![];
        let rule = rule(region, &mut polynomials)?;
        (polynomials.len() <= MOST.0).then_some(Self {
            center,
            polynomials,
            rule,
        })
    }

    /// A box around the surface, if it is known to be closed.
    fn extent(&self) -> Aabb {
        match &*self.polynomials {
            [polynomial] => {
                let bounds = polynomial.bounds();
                Aabb::new(bounds.min + self.center, bounds.max + self.center)
            }
            _ => Aabb::EVERYTHING,
        }
    }

    /// Reports what a ray meets within a stretch of it to the visitor, in order: the state where the question's range begins, then the
    /// crossings.
    pub(super) fn walk(
        &self,
        ray: &Ray,
        stretch: Interval,
        question: &Question,
        visit: &mut dyn FnMut(Event) -> ControlFlow<()>,
    ) {
        let ray = &Ray::new(ray.origin - self.center, ray.direction);
        if let [polynomial] = &*self.polynomials {
            polynomial.walk_within(ray, stretch, question, visit);
        } else {
            self.walk_all(ray, stretch, question, visit);
        }
    }

    fn walk_all(
        &self,
        ray: &Ray,
        stretch: Interval,
        question: &Question,
        visit: &mut dyn FnMut(Event) -> ControlFlow<()>,
    ) {
        let mut inside = Set::default();
        let mut passings = ArrayVec::<Passing, { MOST.1 }>::new();
        let left = question.on_surface.then(|| self.nearest(ray.origin));
        for (number, polynomial) in self.polynomials.iter().enumerate() {
            let question = Question {
                on_surface: left == Some(number),
                ..*question
            };
            polynomial.walk_within(ray, stretch, &question, &mut |event| {
                match event {
                    Event::Start { inside: is_inside } => inside.put(number, is_inside),
                    Event::Crossing { t, enters, .. } => {
                        let passing = Passing { t, number, enters };
                        if passings.try_push(passing).is_err() {
                            return ControlFlow::Break(());
                        }
                    }
                }
                ControlFlow::Continue(())
            });
        }
        passings.sort_by(|a, b| a.t.total_cmp(&b.t));
        let mut is_inside = self.rule.contains(inside);
        let mut flow = visit(Event::Start { inside: is_inside });
        for Passing { t, number, enters } in passings {
            if flow.is_break() {
                return;
            }
            inside.put(number, enters);
            let enters = self.rule.contains(inside);
            if enters != is_inside {
                is_inside = enters;
                flow = visit(Event::Crossing {
                    t,
                    t_error: 0.0,
                    enters,
                });
            }
        }
    }

    /// The polynomial whose surface is nearest to a point on one of them.
    fn nearest(&self, point: DVec3) -> usize {
        let distance = |polynomial: &Polynomial| polynomial.distance(point);
        let distances = self.polynomials.iter().map(distance).enumerate();
        let nearest = distances.min_by(|(_, a), (_, b)| a.total_cmp(b));
        nearest.map_or(0, |(number, _)| number)
    }
}

fn rule(region: &Region, polynomials: &mut Vec<Polynomial>) -> Option<Rule> {
    let mut list = |parts: &[Region]| -> Option<Vec<Rule>> {
        parts.iter().map(|part| rule(part, polynomials)).collect()
    };
    match region {
        Region::All(parts) => Some(Rule::All(list(parts)?)),
        Region::Any(parts) => Some(Rule::Any(list(parts)?)),
        Region::Negative(terms) => {
            polynomials.push(Polynomial::try_new(terms.iter().copied()).ok()?);
            Some(Rule::Polynomial(polynomials.len() - 1))
        }
    }
}

impl Isosurface {
    /// The polynomials that decide about the function, if there are some, and if they are as exact as the function.
    pub(super) fn find_decision(&self, workspace: &mut Workspace) -> Option<Decision> {
        let bounds = self.container.bounds();
        let center = bounds.center();
        let region = self
            .function
            .region_below(self.options.threshold, center.to_array())?;
        // Roots of negative numbers.
        if self.bounds_within(workspace, &bounds).nan {
            return None;
        }
        let decision = Decision::new(&region, center)?;
        self.is_exact(&decision, workspace).then_some(decision)
    }

    /// Whether the function changes its sign where the polynomials do, on lines that depend on nothing but the container and the surface.
    fn is_exact(&self, decision: &Decision, workspace: &mut Workspace) -> bool {
        let places = decision.extent().intersection(&self.container.bounds());
        let near = NEAR * places.size().max_element();
        let (mut hits, mut misses) = (0, 0);
        for number in 0..CROSSINGS.1 {
            let direction = direction(number).normalize();
            let place = place(&places, number);
            let ray = Ray::new(place - direction * (2.0 * self.size()), direction);
            let Some(passage) = self.container.passage(&ray, None) else {
                continue;
            };
            let stretch = Interval::new(passage.start(), passage.exit.hit.t);
            let question = Question {
                range: stretch,
                on_surface: false,
                errors: false,
            };
            decision.walk(&ray, stretch, &question, &mut |event| {
                if let Event::Crossing { t, enters, .. } = event {
                    let mut is_inside = |t: f64| self.value(workspace, ray.at(t)) < 0.0;
                    let agrees = is_inside(t - near) != enters && is_inside(t + near) == enters;
                    hits += 1;
                    misses += u32::from(!agrees);
                }
                ControlFlow::Continue(())
            });
            if hits >= CROSSINGS.0 {
                break;
            }
        }
        // By chance a line may touch the surface.
        hits >= FEWEST && misses * 50 <= hits
    }
}
