//! Which surfaces are closed.

use super::data::Patches;
use super::part::Part;
use std::collections::HashMap;

/// Whether each curve of the outer border of a whole surface belongs to it in both directions, or is collapsed to a point.
///
/// Then the border winds around no ray, so that every line leaves the surface as often as it enters.
pub(super) fn is_closed(patches: &Patches) -> bool {
    let [across, up] = [0, 1].map(|k| patches.breaks[k].len() - 1);
    let mut open: HashMap<Vec<[u64; 4]>, i32> = HashMap::new();
    let mut add = |part: &Part, side: usize| {
        let curve = part.patch.border(side);
        if curve.windows(2).all(|pair| pair[0] == pair[1]) {
            return;
        }
        let mut back = curve.clone();
        back.reverse();
        let (key, sign) = match curve.cmp(&back) {
            std::cmp::Ordering::Less => (curve, 1),
            std::cmp::Ordering::Greater => (back, -1),
            // There and back again.
            std::cmp::Ordering::Equal => return,
        };
        *open.entry(key).or_default() += sign;
    };
    for (index, part) in patches.parts.iter().enumerate() {
        let (a, b) = (index % across, index / across);
        let is_outside = [b == 0, a + 1 == across, b + 1 == up, a == 0];
        for side in (0..4).filter(|side| is_outside[*side]) {
            add(part, side);
        }
    }
    open.values().all(|sum| *sum == 0)
}
