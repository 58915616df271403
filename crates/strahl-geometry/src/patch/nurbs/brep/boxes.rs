//! Which of many boxes meet another one.

/// A box: its lowest and its highest coordinates.
pub(super) type Bounds<const D: usize> = [[f64; D]; 2];

/// Boxes that lie beside each other in their order, as those of the pieces of curves do: each level has the boxes around pairs
/// of the one below.
#[derive(Debug)]
pub(super) struct Boxes<const D: usize> {
    levels: Vec<Vec<Bounds<D>>>,
}

impl<const D: usize> Boxes<D> {
    pub(super) fn new(boxes: Vec<Bounds<D>>) -> Self {
        let mut levels = vec![boxes];
        while let Some(last) = levels.last().filter(|last| last.len() > 1) {
            let pairs = last.chunks(2).map(|pair| {
                let both = |[low, high]: Bounds<D>, other: &Bounds<D>| {
                    [
                        std::array::from_fn(|k| low[k].min(other[0][k])),
                        std::array::from_fn(|k| high[k].max(other[1][k])),
                    ]
                };
                pair[1..].iter().fold(pair[0], both)
            });
            let next = pairs.collect();
            levels.push(next);
        }
        Self { levels }
    }

    /// Calls `visit` with the number of each box that meets this one.
    pub(super) fn meeting(&self, bounds: &Bounds<D>, mut visit: impl FnMut(usize)) {
        self.descend(self.levels.len() - 1, 0, bounds, &mut visit);
    }

    fn descend(
        &self,
        level: usize,
        number: usize,
        bounds: &Bounds<D>,
        visit: &mut impl FnMut(usize),
    ) {
        let Some([low, high]) = self.levels[level].get(number) else {
            return;
        };
        if (0..D).any(|k| low[k] > bounds[1][k] || high[k] < bounds[0][k]) {
            return;
        }
        if level == 0 {
            visit(number);
            return;
        }
        for half in [2 * number, 2 * number + 1] {
            self.descend(level - 1, half, bounds, visit);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Boxes;
    use crate::conformance::Random;

    #[test]
    fn all_boxes_that_meet_are_found() {
        let mut random = Random::new(5);
        for count in 0..40 {
            let mut interval = || {
                let at = random.unit();
                [[at], [at + 0.2 * random.unit()]]
            };
            let list: Vec<_> = (0..count).map(|_| interval()).collect();
            let asked = interval();
            let boxes = Boxes::new(list.clone());
            let mut found = vec![];
            boxes.meeting(&asked, |k| found.push(k));
            let meets = |k: &usize| list[*k][0] <= asked[1] && list[*k][1] >= asked[0];
            let expected: Vec<_> = (0..count).filter(meets).collect();
            assert_eq!(found, expected);
        }
    }
}
