//! Which candidates of a search are hits, where they are doubtful.

use super::newton::Candidate;

/// The hits among all candidates of a line; `winding` is how often the border of the patch winds around it.
///
/// Twins from neighbouring pieces are made one. Then the hits, with their signs, must add up to the number of times that
/// the border of the patch winds around the ray, which is known exactly and agrees with that of the neighbours: if they
/// don't, the decisions nearest to the border are turned around. What is still missing the search has lost, where the
/// patch is folded, collapsed or seen from its edge: `lost` finds a hit of a sign that these hits lack.
pub(super) fn settle(
    mut found: Vec<Candidate>,
    winding: impl FnOnce() -> i32,
    lost: impl Fn(&[Candidate], &[Candidate], i32) -> Candidate,
) -> Vec<Candidate> {
    // The order of parameters, so that nothing depends on the order of the search.
    found.sort_by(|a, b| {
        a.t.total_cmp(&b.t)
            .then(a.u.total_cmp(&b.u))
            .then(a.v.total_cmp(&b.v))
    });
    let mut single: Vec<Candidate> = Vec::with_capacity(found.len());
    // Only the border knows about these.
    let mut given_up: Vec<Candidate> = vec![];
    for candidate in found {
        if candidate.sign == 0 {
            given_up.push(candidate);
            continue;
        }
        if !single.iter().any(|other| other.is_twin(&candidate)) {
            single.push(candidate);
        }
    }
    let is_at_border = |c: &Candidate| c.margin().abs() <= 1.0;
    let (at_border, mut hits): (Vec<_>, Vec<_>) = single.into_iter().partition(is_at_border);
    if at_border.is_empty() && given_up.is_empty() {
        return hits;
    }
    let mut missing = winding();
    for hit in &hits {
        missing -= hit.sign;
    }
    let mut open: Vec<(Candidate, bool)> = Vec::with_capacity(at_border.len());
    for candidate in at_border {
        let inside = candidate.margin() >= 0.0;
        if inside {
            missing -= candidate.sign;
        }
        open.push((candidate, inside));
    }
    open.sort_by(|(a, _), (b, _)| a.margin().abs().total_cmp(&b.margin().abs()));
    for (candidate, inside) in &mut open {
        // What turning this decision around adds to the sum.
        let gain = if *inside {
            -candidate.sign
        } else {
            candidate.sign
        };
        if missing * gain > 0 {
            *inside = !*inside;
            missing -= gain;
        }
    }
    hits.extend(
        open.into_iter()
            .filter(|(_, inside)| *inside)
            .map(|(c, _)| c),
    );
    add_lost(hits, missing, |hits, sign| lost(hits, &given_up, sign))
}

/// The hits, with so many more of the sign of `missing`.
pub(super) fn add_lost(
    mut hits: Vec<Candidate>,
    missing: i32,
    lost: impl Fn(&[Candidate], i32) -> Candidate,
) -> Vec<Candidate> {
    for _ in 0..missing.abs() {
        hits.push(lost(&hits, missing.signum()));
    }
    hits
}
