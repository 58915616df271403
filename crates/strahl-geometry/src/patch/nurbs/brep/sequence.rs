//! Which of the crossings of a line with the faces of a shell are crossings of the shell.

/// A crossing of a line with a face, or with what lies just beyond its border.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Doubt {
    /// Whether the line gets inside there.
    pub(super) enters: bool,
    /// Whether it is on the face.
    pub(super) is_on: bool,
    /// What it costs to take it for the contrary.
    pub(super) cost: f64,
}

/// The crossings of a line with a shell.
#[derive(Clone, Debug)]
pub(super) struct Settled {
    /// Which of the crossings with faces they are.
    pub(super) taken: Vec<bool>,
    /// How much they contradict the faces; at least [`CERTAIN`] if a certain crossing is left out.
    pub(super) cost: f64,
}

/// What it costs to leave out a crossing that is not near a border: more than to decide all others otherwise.
pub(super) const CERTAIN: f64 = 1e9;

/// Which crossings of a whole line count, so that it enters and leaves by turns, first and last being outside.
///
/// It is the choice that contradicts least what the faces say: each crossing that is left out although it is on its face, and each
/// that is taken although it is beyond, costs the more the further it is from the border. The cheapest choice up to each
/// crossing, once for a line that is then outside and once for one that is inside, follows from those up to the one before (R. Bellman,
/// Dynamic Programming, 1957).
///
/// `known` has for some of the crossings, in their order, whether the line is inside behind them. What contradicts all sequences is ignored.
pub(super) fn settle(crossings: &[Doubt], known: &[(usize, bool)]) -> Settled {
    let mut costs = [0.0, f64::INFINITY];
    let mut choices: Vec<[bool; 2]> = Vec::with_capacity(crossings.len());
    let mut known_left = known.iter().peekable();
    for (number, crossing) in crossings.iter().enumerate() {
        let (leave, take) = if crossing.is_on {
            (crossing.cost, 0.0)
        } else {
            (0.0, crossing.cost)
        };
        let after = usize::from(crossing.enters);
        let (left, crossed) = (costs[after] + leave, costs[1 - after] + take);
        let is_taken = crossed < left || crossed == left && crossing.is_on;
        let mut choice = [false; 2];
        choice[after] = is_taken;
        costs[1 - after] += leave;
        costs[after] = if is_taken { crossed } else { left };
        choices.push(choice);
        if let Some((_, is_inside)) = known_left.next_if(|(place, _)| *place == number) {
            costs[usize::from(!is_inside)] = f64::INFINITY;
        }
    }
    if costs[0] == f64::INFINITY {
        return settle(crossings, &[]);
    }
    let mut state = 0;
    let mut taken = vec![false; crossings.len()];
    for (number, choice) in choices.iter().enumerate().rev() {
        if choice[state] {
            taken[number] = true;
            state = 1 - state;
        }
    }
    Settled {
        taken,
        cost: costs[0],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conformance::Random;

    fn crossing(enters: bool, is_on: bool, cost: f64) -> Doubt {
        Doubt {
            enters,
            is_on,
            cost,
        }
    }

    /// All choices are tried.
    fn exhaustive(crossings: &[Doubt]) -> f64 {
        let cost = |choice: u32| {
            let (mut inside, mut sum) = (false, 0.0);
            for (k, c) in crossings.iter().enumerate() {
                let takes = choice >> k & 1 == 1;
                if takes {
                    if inside == c.enters {
                        return f64::INFINITY;
                    }
                    inside = c.enters;
                }
                if takes != c.is_on {
                    sum += c.cost;
                }
            }
            if inside { f64::INFINITY } else { sum }
        };
        (0..1 << crossings.len())
            .map(cost)
            .fold(f64::INFINITY, f64::min)
    }

    #[test]
    fn the_cheapest_sequence_is_found() {
        let mut random = Random::new(1);
        for _ in 0..5000 {
            let all: Vec<Doubt> = (0..random.below(9))
                .map(|_| {
                    let cost = if random.below(2) == 0 {
                        CERTAIN
                    } else {
                        random.unit()
                    };
                    crossing(random.below(2) == 0, random.below(3) > 0, cost)
                })
                .collect();
            let Settled { taken, cost: told } = settle(&all, &[]);
            let mut inside = false;
            let mut cost = 0.0;
            for (c, is_taken) in all.iter().zip(&taken) {
                if *is_taken {
                    assert_ne!(inside, c.enters);
                    inside = c.enters;
                }
                cost += if *is_taken == c.is_on { 0.0 } else { c.cost };
            }
            assert!(!inside);
            let best = exhaustive(&all);
            assert!((cost - best).abs() <= 1e-12 * best, "{cost} {best}");
            assert!((cost - told).abs() <= 1e-12 * best, "{cost} {told}");
        }
    }

    #[test]
    fn what_alternates_stays_and_doubts_beside_an_edge_are_settled() {
        let sure = |enters| crossing(enters, true, CERTAIN);
        let taken = |all: &[Doubt]| settle(all, &[]).taken;
        assert_eq!(taken(&[]), Vec::<bool>::new());
        assert_eq!(taken(&[sure(true), sure(false)]), [true, true]);
        // A gap.
        assert_eq!(
            taken(&[crossing(true, false, 0.1), sure(false)]),
            [true, true]
        );
        // An overlap.
        let twice = [
            crossing(true, true, 0.2),
            crossing(true, true, 0.1),
            sure(false),
        ];
        assert_eq!(taken(&twice), [true, false, true]);
        // A face that is missing.
        assert_eq!(taken(&[sure(true)]), [false]);
        assert_eq!(settle(&[sure(true)], &[]).cost, CERTAIN);
    }

    #[test]
    fn what_is_known_between_two_gaps_decides() {
        let gaps = [crossing(true, false, 0.1), crossing(false, false, 0.3)];
        assert_eq!(settle(&gaps, &[]).taken, [false, false]);
        assert_eq!(settle(&gaps, &[(0, false)]).taken, [false, false]);
        assert_eq!(settle(&gaps, &[(0, true)]).taken, [true, true]);
        // What is known contradicts all sequences.
        assert_eq!(settle(&gaps, &[(1, true)]).taken, [false, false]);
        assert_eq!(settle(&gaps[1..], &[(0, true)]).taken, [false]);
    }
}
