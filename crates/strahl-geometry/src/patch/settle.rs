//! Which candidates of a search are hits, where they are doubtful.

use super::border::Region;
use super::newton::Candidate;

/// The hits among all candidates of a line; `winding` is how often the border of a region of the patch winds around it.
///
/// Twins from neighbouring pieces are made one. Then the hits, with their signs, must add up to the number of times that
/// the border of the patch winds around the ray, which is known exactly and agrees with that of the neighbours: if they
/// don't, the decisions nearest to the border are turned around. What is still missing the search has lost, where the
/// patch is folded, collapsed or seen from its edge: `lost` finds a hit of a sign that these hits lack.
///
/// If there are several candidates at the border, that of the whole patch does not tell which of them are hits: if two have opposite
/// signs, it winds as often around both as around none. So each of them is decided by the border of a small region around it. The
/// neighbour decides about the same place by the same stretch of the common curve, so that exactly one of the two has the hit.
pub(super) fn settle(
    mut found: Vec<Candidate>,
    winding: impl Fn(&Region) -> i32,
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
    let whole = winding(&Region::WHOLE);
    if at_border.len() + given_up.len() == 1 {
        let missing = whole - sum(&hits);
        hits.extend(decided(at_border, missing));
    } else {
        for group in groups(&hits, &at_border, &given_up) {
            if !group.at_border.is_empty() {
                let missing = winding(&group.region) - group.sum;
                hits.extend(decided(group.at_border, missing));
            }
        }
    }
    let missing = whole - sum(&hits);
    add_lost(hits, missing, |hits, sign| lost(hits, &given_up, sign))
}

fn sum(hits: &[Candidate]) -> i32 {
    hits.iter().map(|hit| hit.sign).sum()
}

/// Those of some candidates at the border that are hits, if the signs of these must add up to `missing`.
fn decided(candidates: Vec<Candidate>, mut missing: i32) -> impl Iterator<Item = Candidate> {
    let mut open: Vec<(Candidate, bool)> = Vec::with_capacity(candidates.len());
    for candidate in candidates {
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
    open.into_iter()
        .filter(|(_, inside)| *inside)
        .map(|(c, _)| c)
}

/// A region of a patch with the candidates in it.
struct Group {
    region: Region,
    at_border: Vec<Candidate>,
    /// The sum of the signs of the hits that are certain.
    sum: i32,
}

impl Group {
    fn new(candidate: &Candidate) -> Self {
        let Candidate { u, v, zone, .. } = *candidate;
        Self {
            // A candidate is no further than its zone from where the ray is: no side of the region within the patch is nearer to it than another zone.
            region: Region::around([u, v], zone.map(|zone| 2.0 * zone)),
            at_border: vec![],
            sum: 0,
        }
    }
}

/// Regions that don't meet, each around one candidate, or around several that are too near to each other.
fn groups(hits: &[Candidate], at_border: &[Candidate], given_up: &[Candidate]) -> Vec<Group> {
    let certain = hits.iter().map(|candidate| Group {
        sum: candidate.sign,
        ..Group::new(candidate)
    });
    let doubtful = at_border.iter().map(|candidate| Group {
        at_border: vec![*candidate],
        ..Group::new(candidate)
    });
    let unknown = given_up.iter().map(Group::new);
    let mut groups: Vec<Group> = vec![];
    for mut own in doubtful.chain(certain).chain(unknown) {
        while let Some(k) = groups.iter().position(|g| g.region.meets(&own.region)) {
            let group = groups.swap_remove(k);
            own.region = own.region.with(&group.region);
            own.at_border.extend(group.at_border);
            own.sum += group.sum;
        }
        groups.push(own);
    }
    groups
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
