//! Which side of each face is outside.

use super::face::Face;
use super::{Meeting, NurbsBrep};
use crate::GeometryError;
use strahl_math::{DVec2, DVec3, Ray};

/// Lines are shot along these directions, which are parallel to nothing that occurs in scenes.
pub(super) const DIRECTIONS: [DVec3; 3] = [
    DVec3::new(0.526_438_109_1, 0.315_904_772_9, 0.789_365_214_7),
    DVec3::new(-0.713_820_448_3, 0.612_497_311_7, 0.339_518_836_1),
    DVec3::new(0.205_113_977_9, -0.881_604_120_7, 0.424_990_518_3),
];
/// So many lines through a face are enough.
const ENOUGH: u32 = 8;
/// So many places of a face are tried.
const TRIES: u32 = 400;
/// Steps away from a border, in parts of the parameters, for narrow faces.
const STEPS: [f64; 4] = [1e-2, 1e-3, 1e-4, 1e-5];
/// A line that meets a face at a lower sine than this is left out.
const LOW: f64 = 0.05;

/// For how many lines `dS/du x dS/dv` points outwards, and for how many inwards.
#[derive(Clone, Copy, Debug, Default)]
struct Votes {
    outwards: u32,
    inwards: u32,
}

impl Votes {
    fn sum(self) -> u32 {
        self.outwards + self.inwards
    }
}

/// Finds out which way each face is turned: 1 if `dS/du x dS/dv` points outwards, otherwise -1.
///
/// The first crossing of a line enters, the second leaves, and so on. Only lines are asked that are far from all borders.
///
/// # Errors
/// Lines disagree: then faces cross each other.
pub(super) fn turns(shell: &NurbsBrep) -> Result<Vec<i32>, GeometryError> {
    let mut votes = vec![Votes::default(); shell.faces.len()];
    for number in 0..shell.faces.len() {
        for (target, normal) in targets(&shell.faces[number], shell.reach()) {
            if votes[number].sum() >= ENOUGH {
                break;
            }
            for direction in DIRECTIONS {
                if normal.dot(direction).abs() >= LOW {
                    ask(shell, &Ray::new(target, direction), &mut votes);
                }
            }
        }
    }
    let mut turns = vec![];
    for (number, votes) in votes.iter().enumerate() {
        if 4 * votes.outwards.min(votes.inwards) > votes.sum() {
            return Err(GeometryError::NotClosedAt {
                what: "brep",
                index: number as u64,
                why: format!(
                    "face {number} (counted from 0) has the inside on both sides, so faces cross or lie on each other"
                ),
            });
        }
        // A face so narrow that no line meets it far from its border may be turned either way.
        turns.push(if votes.inwards > votes.outwards {
            -1
        } else {
            1
        });
    }
    Ok(turns)
}

/// Adds what a line tells, if all of it is certain.
fn ask(shell: &NurbsBrep, line: &Ray, votes: &mut [Votes]) {
    let meetings = shell.meetings(line, shell.reach());
    if !meetings.len().is_multiple_of(2) || !meetings.iter().all(Meeting::is_certain) {
        return;
    }
    for (place, meeting) in meetings.iter().enumerate() {
        let enters = place % 2 == 0;
        // A positive sign is a line along dS/du x dS/dv.
        if (meeting.sign > 0) == enters {
            votes[meeting.face].inwards += 1;
        } else {
            votes[meeting.face].outwards += 1;
        }
    }
}

/// Points of a face far from its border, with normals.
fn targets(face: &Face, reach: f64) -> impl Iterator<Item = (DVec3, DVec3)> {
    let spread = (0..TRIES).map(|k| {
        let part = k as usize % face.parts().len();
        // Roberts's sequence, which fills the square evenly.
        let along = |step: f64| (0.5 + f64::from(k) * step).fract();
        (
            part,
            [
                along(0.754_877_666_246_692_8),
                along(0.569_840_290_998_053_3),
            ],
        )
    });
    let stride = face.curves.len().div_ceil(TRIES as usize).max(1);
    let beside = face.curves.iter().step_by(stride).flat_map(move |curve| {
        let [place, by] = curve.at(0.5);
        let aside = by.perp().try_normalize().unwrap_or(DVec2::X);
        let steps = STEPS.iter().flat_map(|step| [*step, -step]);
        steps.filter_map(move |step| face.locate(place + aside * step))
    });
    spread.chain(beside).filter_map(move |(part, local)| {
        let standing = face.standing(part, local, reach);
        if !standing.is_on || standing.distance.is_some() {
            return None;
        }
        let [point, by_u, by_v] = face.jet_in(face.parts().get(part)?, local);
        Some((point, by_u.cross(by_v).try_normalize()?))
    })
}
