use crate::grammar::Entity;
use crate::parser::{PResult, Parser};
use strahl_geometry::{CLOSING_DISTANCE, Polygon};
use strahl_math::DVec3;

/// `polygon { count, corner, ... }`
///
/// A corner at the first one of its ring closes the ring; the next corner begins another ring, which cuts a hole (or fills
/// one).
pub(super) fn polygon(p: &mut Parser<'_>) -> PResult<Entity> {
    let place = p.place();
    p.shape(|p| {
        let count = p.float()?;
        if !(count >= 3.0) {
            let message = format!("a polygon has at least 3 corners, found {count}");
            return Err(p.fail(place, message));
        }
        let mut rings: Vec<Vec<DVec3>> = vec![];
        let mut open = false;
        // Each corner is read, so the count cannot ask for more memory than the text has.
        let mut read = 0.0;
        while read < count {
            p.comma()?;
            p.count_parts(1)?;
            let corner = p.vector3()?;
            read += 1.0;
            match rings.last_mut().filter(|_| open) {
                Some(ring) if is_closed_by(ring, corner) => open = false,
                Some(ring) => ring.push(corner),
                None => {
                    rings.push(vec![corner]);
                    open = true;
                }
            }
        }
        if open && rings.last().is_some_and(|ring| ring.len() > 1) {
            p.warn(
                place,
                "the last corner of the polygon differs from the first; an edge closes the polygon",
            );
        }
        // A single corner after the last ring encloses no area.
        rings.retain(|ring| ring.len() > 1);
        let mut rings = rings.into_iter();
        let outer = rings.next().unwrap_or_default();
        let holes: Vec<_> = rings.collect();
        Ok(Polygon::try_with_holes(&outer, &holes))
    })
}

/// Whether a corner closes a ring.
fn is_closed_by(ring: &[DVec3], corner: DVec3) -> bool {
    ring.first()
        .is_some_and(|first| (*first - corner).abs().max_element() <= CLOSING_DISTANCE)
}
