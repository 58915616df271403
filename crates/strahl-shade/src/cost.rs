//! The cost of evaluating patterns and pigments, which call functions and are called by them.

use strahl_function::Cost;

use crate::patterns::{Pattern, PatternField};
use crate::pigment::Pigment;

/// Turbulence, warps and the noise of a pattern together; measured roughly, in operations of a function.
const PATTERN: Cost = Cost::operations(256);

impl Pattern {
    /// The cost of a value.
    fn cost(&self) -> Cost {
        match self {
            Self::Function(function) => function.cost(),
            Self::Pigment(pigment) => pigment.cost(),
            Self::Object(object) => object.cost(),
            Self::Fractal(fractal) => Cost::operations(u64::from(fractal.iterations)),
            Self::Ripples { sources } | Self::Waves { sources } => {
                Cost::operations(u64::from(*sources))
            }
            _ => Cost::operations(0),
        }
    }
}

impl PatternField {
    /// The cost of a value, as [`ScalarField::cost`](strahl_function::ScalarField::cost) returns it.
    pub(crate) fn whole_cost(&self) -> Cost {
        PATTERN.and(self.pattern.cost())
    }
}

impl Pigment {
    /// The cost of a colour.
    pub fn cost(&self) -> Cost {
        match self {
            Self::Solid(..) => Cost::operations(1),
            Self::ColorMap(field, _) => field.whole_cost(),
            Self::PigmentMap(field, map) => {
                let member = dearest(map.entries.iter().map(|(_, pigment)| pigment.cost()));
                let members = match map.entries.len() {
                    0 | 1 => member,
                    // Between two entries both are evaluated.
                    _ => member.and(member),
                };
                field.whole_cost().and(members).around()
            }
            Self::Blocks(field, list) => {
                let member = dearest(list.iter().map(Self::cost));
                field.whole_cost().and(member).around()
            }
            Self::Image(..) => PATTERN,
            Self::Average(members, _) => members
                .iter()
                .fold(PATTERN, |sum, (_, pigment)| sum.and(pigment.cost()))
                .around(),
            Self::UvMapped(inner) | Self::Quick(_, inner) => inner.cost().around(),
        }
    }
}

/// The highest cost, if only one of several is evaluated.
fn dearest(costs: impl Iterator<Item = Cost>) -> Cost {
    costs.fold(Cost::operations(0), |most, cost| Cost {
        operations: most.operations.max(cost.operations),
        depth: most.depth.max(cost.depth),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pigment::BlendMap;
    use std::sync::Arc;

    #[test]
    fn members_that_are_all_evaluated_all_count() {
        let plain = Pigment::ColorMap(Pattern::Bozo.into(), BlendMap::new(vec![]));
        let one = plain.cost().operations;
        let average =
            |n: usize| Pigment::Average(vec![(1.0, plain.clone()); n].into(), Box::default());
        assert!(average(8).cost().operations >= 8 * one);
        // Only one block of a list is evaluated.
        let blocks =
            |n: usize| Pigment::Blocks(Pattern::Checker.into(), vec![plain.clone(); n].into());
        assert_eq!(blocks(8).cost(), blocks(2).cost());
        let map = |n: usize| {
            let entries: Vec<_> = (0..n).map(|i| (i as f64, plain.clone())).collect();
            Pigment::PigmentMap(Pattern::Bozo.into(), BlendMap::new(entries)).cost()
        };
        assert_eq!(map(8), map(2));
        assert!(map(2).operations > map(1).operations);
        let mut pigment = plain.clone();
        for _ in 0..10 {
            pigment = Pigment::ColorMap(
                Pattern::Pigment(Arc::new(Pigment::UvMapped(Box::new(pigment)))).into(),
                BlendMap::new(vec![]),
            );
        }
        assert_eq!(pigment.cost().depth, 10);
    }
}
