//! The courses of nodes along a ray: the parts of a tree that matter to the search for the first surface.

use super::boxes::Slabs;
use super::compiled::Collector;
use super::fusing::{Fusing, TooClose};
use super::half_spaces::HalfSpaces;
use super::leaf::Leaf;
use super::node::{Kind, Node};
use super::search::Search;
use super::sweep::Rule;
use super::timeline::State;
use crate::{Crossings, Side, SurfaceId};
use strahl_accel::{Accelerator, TraversalStats};
use strahl_math::Interval;

/// The states of a node along the relevant part of the ray.
#[derive(Clone, Copy, Debug)]
enum Course {
    /// The same everywhere.
    Constant(bool),
    /// The state where the ray starts, and the interval in which it may be inside or meet a surface.
    Varies { inside: bool, alive: Interval },
}

impl Search<'_> {
    /// The part of the range in which the ray meets the box of a node.
    fn clip(&mut self, node: &Node, range: Interval) -> Option<Interval> {
        let ray = self.ray;
        let slabs = self.slabs.get_or_insert_with(|| Slabs::new(ray));
        slabs.clip(&node.bounds, range)
    }

    /// The course of a node in the range; the crossings of its leaves are added to the timeline.
    #[inline]
    fn course(&mut self, index: u32, parent: u32, range: Interval) -> Result<Course, TooClose> {
        let csg = self.csg;
        let Some(node) = csg.node(index) else {
            return Err(TooClose);
        };
        // Quick shapes are intersected as fast as their boxes.
        if !node.quick && self.clip(node, range).is_none() {
            return Ok(Course::Constant(node.far));
        }
        self.met(index, node, parent, range)
    }

    /// The same for a node whose box the ray meets.
    #[inline]
    fn met(
        &mut self,
        index: u32,
        node: &Node,
        parent: u32,
        range: Interval,
    ) -> Result<Course, TooClose> {
        match node.kind {
            Kind::Leaf(leaf) => self.leaf(leaf, parent, range),
            Kind::Operation(rule) => self.operation(index, node, rule, range),
        }
    }

    fn operation(
        &mut self,
        index: u32,
        node: &Node,
        rule: Rule,
        range: Interval,
    ) -> Result<Course, TooClose> {
        let events = self.lists.timeline.len();
        let mut sum = Sum::new(rule, range);
        if !self.core(index, node, &mut sum)? {
            let alive = sum.alive;
            self.rest(index, node, Interval::LINE, alive, &mut sum)?;
        }
        let timeline = &mut self.lists.timeline;
        if let Some(decided) = sum.decided {
            timeline.truncate(events);
            return Ok(Course::Constant(decided));
        }
        let inside = sum.state.holds(rule);
        if timeline.len() == events {
            return Ok(Course::Constant(inside));
        }
        timeline.set_state(index, sum.state);
        let alive = match rule {
            Rule::Intersection => sum.alive,
            Rule::Union | Rule::Merge if node.far => Interval::LINE,
            Rule::Union | Rule::Merge => sum.reach,
        };
        Ok(Course::Varies { inside, alive })
    }

    /// Combines the operands of a node that decide wherever the ray misses them; true if the others don't matter.
    pub(super) fn core(
        &mut self,
        index: u32,
        node: &Node,
        sum: &mut Sum,
    ) -> Result<bool, TooClose> {
        let csg = self.csg;
        let half_spaces = node.half_spaces.as_ref();
        let planes = half_spaces.map_or(0, |planes| planes.len() as u32);
        // Quick ones first: they may make the others cheaper or unnecessary.
        let mut slow = false;
        for i in node.first..node.core - planes {
            let operand = csg.operand(i).unwrap_or_default();
            if csg.node(operand).is_some_and(|n| n.quick) {
                let course = self.course(operand, index, sum.alive)?;
                if sum.add(course, &self.fusing) {
                    return Ok(true);
                }
            } else {
                slow = true;
            }
        }
        if let Some(planes) = half_spaces {
            let course = self.half_spaces(planes, index, sum.alive)?;
            if sum.add(course, &self.fusing) {
                return Ok(true);
            }
        }
        if !slow {
            return Ok(false);
        }
        for i in node.first..node.core - planes {
            let operand = csg.operand(i).unwrap_or_default();
            if !csg.node(operand).is_some_and(|n| n.quick) {
                let course = self.course(operand, index, sum.alive)?;
                if sum.add(course, &self.fusing) {
                    return Ok(true);
                }
            }
        }
        Ok(false)
    }

    /// Combines those of a node's other operands whose boxes begin in the window (behind its start, up to its end) and overlap
    /// `alive`; true if all others don't matter.
    pub(super) fn rest(
        &mut self,
        index: u32,
        node: &Node,
        window: Interval,
        alive: Interval,
        sum: &mut Sum,
    ) -> Result<bool, TooClose> {
        let csg = self.csg;
        let Some(hierarchy) = &node.hierarchy else {
            if window.min > f64::NEG_INFINITY {
                return self.add_later(index, window, sum);
            }
            for i in node.core..node.end {
                let operand = csg.operand(i).unwrap_or_default();
                let Some(node) = csg.node(operand) else {
                    return Err(TooClose);
                };
                // Quick operands belong to the first window.
                if !node.quick {
                    let Some(within) = self.clip(node, alive) else {
                        continue;
                    };
                    if within.min > window.max {
                        self.lists.later.push((operand, within.min));
                        continue;
                    }
                }
                let course = self.met(operand, node, index, sum.alive)?;
                if sum.add(course, &self.fusing) {
                    return Ok(true);
                }
            }
            return Ok(false);
        };
        let bottom = self.lists.candidates.len();
        let mut collector = Collector {
            csg,
            core: node.core,
            candidates: &mut self.lists.candidates,
        };
        let range = alive.intersection(window);
        let mut stats = TraversalStats::default();
        hierarchy.traverse(self.ray, range, &mut collector, &mut stats);
        let everything = window == Interval::LINE;
        let mut decided = false;
        while !decided && self.lists.candidates.len() > bottom {
            let operand = self.lists.candidates.pop().unwrap_or_default();
            let quick = everything && csg.node(operand).is_some_and(|n| n.quick);
            decided = self.add_operand(operand, index, quick, window, alive, sum)?;
        }
        self.lists.candidates.truncate(bottom);
        Ok(decided)
    }

    /// Combines an operand, if it is quick or if its box begins in the window.
    #[inline]
    fn add_operand(
        &mut self,
        operand: u32,
        parent: u32,
        quick: bool,
        window: Interval,
        alive: Interval,
        sum: &mut Sum,
    ) -> Result<bool, TooClose> {
        let Some(node) = self.csg.node(operand) else {
            return Err(TooClose);
        };
        if !quick {
            match self.clip(node, alive) {
                // A line begins at minus infinity, where the first window does.
                Some(within)
                    if window.accepts(within.min)
                        || within.min == f64::NEG_INFINITY && window.min == within.min => {}
                _ => return Ok(false),
            }
        }
        let course = self.met(operand, node, parent, sum.alive)?;
        Ok(sum.add(course, &self.fusing))
    }

    /// Combines the operands without a hierarchy that the first window has left and that begin in this one.
    fn add_later(
        &mut self,
        parent: u32,
        window: Interval,
        sum: &mut Sum,
    ) -> Result<bool, TooClose> {
        for i in 0..self.lists.later.len() {
            let (operand, enter) = self.lists.later[i];
            if !window.accepts(enter) {
                continue;
            }
            let Some(node) = self.csg.node(operand) else {
                return Err(TooClose);
            };
            let course = self.met(operand, node, parent, sum.alive)?;
            if sum.add(course, &self.fusing) {
                return Ok(true);
            }
        }
        Ok(false)
    }

    fn leaf(&mut self, index: u32, parent: u32, range: Interval) -> Result<Course, TooClose> {
        let csg = self.csg;
        let from = self.start_on(index);
        let Some(leaf) = csg.leaf(index) else {
            return Err(TooClose);
        };
        if leaf.has_stays() {
            return self.stay(leaf, from, parent, range);
        }
        let mut list = self.scratch.take();
        leaf.bare_crossings(self.ray, range, from, self.scratch, &mut list);
        let course = self.listed(&list, parent, range);
        self.scratch.give(list);
        course
    }

    /// Adds the ends of a stay to the timeline.
    fn stay(
        &mut self,
        leaf: &Leaf,
        from: Option<SurfaceId>,
        parent: u32,
        range: Interval,
    ) -> Result<Course, TooClose> {
        let stay = leaf.stay(self.ray, from).ok_or(TooClose)?;
        // Whether the leaf contributes what is outside of the span.
        let outside = leaf.negative != stay.outside;
        let Some(span) = stay.span else {
            return Ok(Course::Constant(outside));
        };
        // Crossings just outside of the range may coincide with others in it.
        let near = self.fusing.widened(range);
        if span.exit.t < near.min || span.enter.t > near.max {
            return Ok(Course::Constant(outside));
        }
        let start = self.begin;
        let mut constant = true;
        for (end, enters) in [(span.enter, true), (span.exit, false)] {
            let own = from.is_some_and(|surface| end.t == 0.0 && surface.facet == end.facet);
            if own || end.t.is_infinite() {
                continue;
            }
            self.check_start(end.t)?;
            if end.t > start {
                constant = false;
                let surface = SurfaceId {
                    element: leaf.first_element,
                    facet: end.facet,
                };
                let enters = enters != outside;
                let timeline = &mut self.lists.timeline;
                timeline.push(end.t, surface, parent, enters, leaf.visible);
            }
        }
        let inside = (span.enter.t <= start && start < span.exit.t) != outside;
        if constant {
            return Ok(Course::Constant(inside));
        }
        let alive = if outside {
            Interval::LINE
        } else {
            Interval::new(span.enter.t, span.exit.t)
        };
        Ok(Course::Varies { inside, alive })
    }

    /// The same for half-spaces.
    fn half_spaces(
        &mut self,
        planes: &HalfSpaces,
        parent: u32,
        range: Interval,
    ) -> Result<Course, TooClose> {
        let mut list = self.scratch.take();
        let from = self.from.map(|(leaf, _)| leaf as usize);
        let leaving = self.from.is_some();
        let sure = planes.crossings(self.ray, range, from, leaving, &self.fusing, &mut list);
        let course = if sure {
            self.listed(&list, parent, range)
        } else {
            Err(TooClose)
        };
        self.scratch.give(list);
        course
    }

    /// Adds a list of crossings, made for a range, to the timeline.
    fn listed(
        &mut self,
        list: &Crossings,
        parent: u32,
        range: Interval,
    ) -> Result<Course, TooClose> {
        let start = self.begin;
        let mut inside = list.inside_at_start;
        let (mut first, mut state) = (None, inside);
        for crossing in &list.list {
            if crossing.side == Side::Inner {
                return Err(TooClose);
            }
            let t = crossing.hit.t;
            self.check_start(t)?;
            state = crossing.side == Side::Enter;
            if t > start {
                first.get_or_insert(t);
                self.lists.timeline.push_hit(crossing, parent);
            } else {
                inside = state;
            }
        }
        let Some(first) = first else {
            return Ok(Course::Constant(inside));
        };
        let last = list.list.last().map_or(range.max, |c| c.hit.t);
        let alive = Interval::new(
            if inside { range.min } else { first },
            if state { range.max } else { last },
        );
        Ok(Course::Varies { inside, alive })
    }
}

/// The operands of an operation, combined so far.
pub(super) struct Sum {
    rule: Rule,
    pub(super) state: State,
    /// The interval in which further operands matter.
    pub(super) alive: Interval,
    /// From the first to the last point where an operand is alive.
    reach: Interval,
    /// The result, if it is constant whatever the further operands are.
    decided: Option<bool>,
}

impl Sum {
    pub(super) fn new(rule: Rule, range: Interval) -> Self {
        Self {
            rule,
            state: State::default(),
            alive: range,
            reach: Interval::new(f64::INFINITY, f64::NEG_INFINITY),
            decided: None,
        }
    }

    /// Adds an operand; true if the others don't matter any more.
    #[inline]
    fn add(&mut self, course: Course, fusing: &Fusing) -> bool {
        match course {
            Course::Constant(constant) if constant == self.rule.neutral() => {}
            Course::Constant(_) if self.rule == Rule::Union => {
                // Inner surfaces of the others are still visible.
                self.reach = Interval::LINE;
                self.state.inside += 1;
                self.state.total += 1;
            }
            Course::Constant(constant) => self.decided = Some(constant),
            Course::Varies { inside, alive } => {
                self.state.inside += u32::from(inside);
                self.state.total += 1;
                if alive.min < self.reach.min {
                    self.reach.min = alive.min;
                }
                if alive.max > self.reach.max {
                    self.reach.max = alive.max;
                }
                if self.rule == Rule::Intersection {
                    self.alive = self.alive.intersection(fusing.widened(alive));
                    if !(self.alive.min <= self.alive.max) {
                        self.decided = Some(false);
                    }
                }
            }
        }
        self.decided.is_some()
    }
}
