use super::compiled::{Collector, Csg};
use super::fusing::Fusing;
use super::leaf::Query;
use super::node::{Kind, Node};
use super::search::Lists;
use super::sweep::{Event, Rule, Slot, sort, sweep};
use crate::{Crossing, Crossings, Scratch, Side, SurfaceId};
use strahl_accel::{Accelerator, TraversalStats};
use strahl_math::{Aabb, Interval, Ray};

/// The stacks of an evaluation, reused from ray to ray.
#[derive(Debug, Default)]
pub(crate) struct Workspace {
    frames: Vec<Frame>,
    /// The crossings of all operands of the frames, the topmost frame's last.
    events: Vec<Event>,
    /// The operands with crossings, frame by frame.
    slots: Vec<Slot>,
    /// The remaining operands whose boxes the ray meets, frame by frame, the next one last.
    candidates: Vec<u32>,
    /// The lists of the search for the first surface.
    pub(super) first: Lists,
}

impl Workspace {
    fn clear(&mut self) {
        self.frames.clear();
        self.events.clear();
        self.slots.clear();
        self.candidates.clear();
    }
}

/// An operation whose operands are being evaluated.
#[derive(Clone, Copy, Debug)]
struct Frame {
    node: u32,
    rule: Rule,
    /// The range in which its result matters.
    range: Interval,
    /// The next of the node's core operands; after them come the `candidates`.
    next: u32,
    /// Whether the other operands have been added to the candidates.
    listed: bool,
    /// The beginning of its entries in the stacks.
    events: usize,
    slots: usize,
    candidates: usize,
    /// Whether the ray is inside of some operand in the whole range.
    always_inside: bool,
    /// The result, if it has become constant in the range, whatever the remaining operands are.
    decided: Option<bool>,
}

/// The evaluation of one tree for one ray.
pub(super) struct Evaluation<'a> {
    csg: &'a Csg,
    ray: &'a Ray,
    /// The leaf on which the ray starts, and its surface there.
    from: Option<(usize, SurfaceId)>,
    fusing: Fusing,
}

impl<'a> Evaluation<'a> {
    /// Writes the crossings of a ray with a tree to `out`, as [`crate::Solid::crossings`] promises.
    pub(super) fn run(
        csg: &'a Csg,
        ray: &'a Ray,
        range: Interval,
        from: Option<SurfaceId>,
        scratch: &mut Scratch,
        out: &mut Crossings,
    ) {
        let start = if from.is_some() && range.min < 0.0 {
            0.0
        } else {
            range.min
        };
        if start.is_nan() || start == f64::INFINITY {
            return;
        }
        // An empty range has a start, too.
        let end = if start < range.max { range.max } else { start };
        let fusing = Fusing::new(ray);
        // Crossings that coincide with an end of the range must be included, or the result at the end would depend on the
        // range.
        let wide = fusing.widened(Interval::new(start, end));
        let evaluation = Self {
            csg,
            ray,
            from: from.map(|surface| {
                let (leaf, element) = csg.leaf_of(surface.element);
                (leaf, SurfaceId { element, ..surface })
            }),
            fusing,
        };
        let mut workspace = scratch.take_csg();
        workspace.clear();
        evaluation.walk(wide, &mut workspace, scratch, out);
        scratch.give_csg(workspace);
        if evaluation.from.is_some() {
            // Lids and inner surfaces that coincide with the surface on which the ray starts are already crossed.
            let reach = |crossing: &Crossing| evaluation.fusing.reach(crossing);
            out.list
                .retain(|c| c.side != Side::Inner || c.hit.t > reach(c));
        }
        cut(out, Interval::new(start, end));
    }

    /// Evaluates the tree operands first, without recursion.
    fn walk(
        &self,
        range: Interval,
        work: &mut Workspace,
        scratch: &mut Scratch,
        out: &mut Crossings,
    ) {
        self.begin(0, range, work, scratch, out);
        while let Some(frame) = work.frames.last_mut() {
            let Some(node) = self.csg.node(frame.node) else {
                return;
            };
            if let Some(half_spaces) = &node.half_spaces
                && frame.decided.is_none()
                && frame.next as usize + half_spaces.len() == node.core as usize
            {
                let mut list = scratch.take();
                let from = self.from.map(|(leaf, _)| leaf);
                let leaving = self.from.is_some();
                let (range, fusing) = (frame.range, &self.fusing);
                if half_spaces.crossings(self.ray, range, from, leaving, fusing, &mut list) {
                    frame.next = node.core;
                    self.csg.hide_unseen(&mut list, self.ray, scratch);
                    self.absorb(&list, work, scratch);
                    scratch.give(list);
                    continue;
                }
                scratch.give(list);
            }
            match self.next_operand(node, frame, &mut work.candidates) {
                Some(operand) => {
                    let range = frame.range;
                    let mut list = scratch.take();
                    if self.begin(operand, range, work, scratch, &mut list) {
                        self.absorb(&list, work, scratch);
                    }
                    scratch.give(list);
                }
                None => {
                    let mut list = scratch.take();
                    self.conclude(work, &mut list);
                    if work.frames.is_empty() {
                        std::mem::swap(out, &mut list);
                    } else {
                        self.absorb(&list, work, scratch);
                    }
                    scratch.give(list);
                }
            }
        }
    }

    /// Begins a node: writes the crossings of a leaf (true) or pushes an operation on the stack (false).
    fn begin(
        &self,
        index: u32,
        range: Interval,
        work: &mut Workspace,
        scratch: &mut Scratch,
        out: &mut Crossings,
    ) -> bool {
        let Some(node) = self.csg.node(index) else {
            return true;
        };
        if self.misses(&node.bounds, range) {
            out.inside_at_start = node.far;
            return true;
        }
        match node.kind {
            Kind::Leaf(leaf) => {
                let from = self.from.filter(|(other, _)| *other == leaf as usize);
                let query = Query {
                    ray: self.ray,
                    range,
                    from: from.map(|(_, surface)| surface),
                    leaving: self.from.is_some(),
                    fusing: &self.fusing,
                };
                if let Some(leaf) = self.csg.leaf(leaf) {
                    leaf.crossings(&query, scratch, out);
                    self.csg.hide_unseen(out, self.ray, scratch);
                }
                true
            }
            Kind::Operation(rule) => {
                work.frames.push(Frame {
                    node: index,
                    rule,
                    range,
                    next: node.first,
                    listed: false,
                    events: work.events.len(),
                    slots: work.slots.len(),
                    candidates: work.candidates.len(),
                    always_inside: false,
                    decided: None,
                });
                false
            }
        }
    }

    /// The operand to evaluate next, `None` when all that matter have been.
    fn next_operand(
        &self,
        node: &Node,
        frame: &mut Frame,
        candidates: &mut Vec<u32>,
    ) -> Option<u32> {
        if frame.decided.is_some() {
            return None;
        }
        if frame.next < node.core {
            frame.next += 1;
            return self.csg.operand(frame.next - 1);
        }
        if !frame.listed {
            frame.listed = true;
            self.list_candidates(node, frame.range, candidates);
        }
        if candidates.len() > frame.candidates {
            candidates.pop()
        } else {
            None
        }
    }

    /// Appends those of the node's other operands whose boxes the ray meets, the last one first.
    fn list_candidates(&self, node: &Node, range: Interval, candidates: &mut Vec<u32>) {
        let meets = |operand: &u32| {
            self.csg
                .node(*operand)
                .is_some_and(|node| !self.misses(&node.bounds, range))
        };
        let Some(hierarchy) = &node.hierarchy else {
            let rest = (node.core..node.end).rev();
            candidates.extend(rest.filter_map(|i| self.csg.operand(i)).filter(meets));
            return;
        };
        let begin = candidates.len();
        let mut collector = Collector {
            csg: self.csg,
            core: node.core,
            candidates,
        };
        hierarchy.traverse(
            self.ray,
            range,
            &mut collector,
            &mut TraversalStats::default(),
        );
        // The hierarchy's boxes are wider, and the order of its visits must not matter.
        if let Some(found) = candidates.get_mut(begin..) {
            found.sort_unstable_by(|a, b| b.cmp(a));
        }
        let mut kept = begin;
        for i in begin..candidates.len() {
            if candidates.get(i).is_some_and(meets) {
                candidates.swap(kept, i);
                kept += 1;
            }
        }
        candidates.truncate(kept);
    }

    fn misses(&self, bounds: &Aabb, range: Interval) -> bool {
        bounds.is_empty() || bounds.clip(self.ray, range).is_none()
    }

    /// Adds an operand's crossings to the topmost frame.
    fn absorb(&self, list: &Crossings, work: &mut Workspace, scratch: &mut Scratch) {
        let Some(frame) = work.frames.last_mut() else {
            return;
        };
        let intersection = frame.rule == Rule::Intersection;
        let sequential = intersection && !frame.listed;
        if list.list.is_empty() && list.inside_at_start != frame.rule.neutral() {
            // Nothing is left of an intersection, or a merge is full. A union still has inner surfaces.
            if frame.rule == Rule::Union {
                frame.always_inside = true;
            } else {
                frame.decided = Some(!intersection);
            }
            return;
        }
        if list.list.is_empty() && !sequential {
            return;
        }
        let slot = (work.slots.len() - frame.slots) as u32;
        work.slots.push(Slot::new(list.inside_at_start));
        let events = list.list.iter();
        work.events.extend(events.map(|crossing| Event {
            crossing: *crossing,
            slot,
        }));
        if sequential && slot > 0 {
            // The positive operands of an intersection are combined one by one, to notice immediately when nothing is left.
            let mut combined = scratch.take();
            combine(
                frame,
                &mut work.events,
                &mut work.slots,
                &self.fusing,
                &mut combined,
            );
            if combined.list.is_empty() && !combined.inside_at_start {
                frame.decided = Some(false);
            }
            work.slots.push(Slot::new(combined.inside_at_start));
            let events = combined.list.iter();
            work.events.extend(events.map(|crossing| Event {
                crossing: *crossing,
                slot: 0,
            }));
            scratch.give(combined);
        }
        if sequential
            && let (Some(slot), Some(events)) =
                (work.slots.get(frame.slots), work.events.get(frame.events..))
        {
            // Further operands matter only where something is left.
            let alive = alive(slot, events, frame.range);
            frame.range = frame.range.intersection(self.fusing.widened(alive));
        }
    }

    /// Removes the topmost frame and writes its result.
    fn conclude(&self, work: &mut Workspace, out: &mut Crossings) {
        let Some(frame) = work.frames.pop() else {
            return;
        };
        if let Some(result) = frame.decided {
            out.inside_at_start = result;
        } else {
            combine(&frame, &mut work.events, &mut work.slots, &self.fusing, out);
        }
        work.events.truncate(frame.events);
        work.slots.truncate(frame.slots);
        work.candidates.truncate(frame.candidates);
    }
}

/// Sweeps over the crossings of a frame and removes it from the stacks.
fn combine(
    frame: &Frame,
    events: &mut Vec<Event>,
    slots: &mut Vec<Slot>,
    fusing: &Fusing,
    out: &mut Crossings,
) {
    if let (Some(events), Some(slots)) =
        (events.get_mut(frame.events..), slots.get_mut(frame.slots..))
    {
        if slots.len() > 1 {
            sort(events);
        }
        sweep(frame.rule, events, slots, frame.always_inside, fusing, out);
    }
    events.truncate(frame.events);
    slots.truncate(frame.slots);
}

/// The part of the range from the first to the last point where an operand has an inside or a surface.
fn alive(slot: &Slot, events: &[Event], range: Interval) -> Interval {
    let at = |event: Option<&Event>| event.map(|event| event.crossing.hit.t);
    let last_change = events
        .iter()
        .rev()
        .find(|event| event.crossing.side != Side::Inner);
    let inside_at_end = last_change.map_or(slot.inside, |event| event.crossing.side == Side::Enter);
    let first = if slot.inside {
        None
    } else {
        at(events.first())
    };
    let last = if inside_at_end {
        None
    } else {
        at(events.last())
    };
    Interval::new(first.unwrap_or(range.min), last.unwrap_or(range.max))
}

/// Clips a list to a part of its range.
fn cut(list: &mut Crossings, range: Interval) {
    list.inside_at_start = list.inside_after(range.min);
    list.list.retain(|crossing| range.accepts(crossing.hit.t));
}
