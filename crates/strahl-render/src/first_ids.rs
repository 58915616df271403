//! The numbers of elements by primitives.

/// The numbers that the elements of a group's primitives have, where some primitive has more or fewer than one element.
#[derive(Clone, Debug)]
pub(crate) struct FirstIds {
    /// The number of the first element of each primitive, ascending.
    first: Vec<u64>,
    /// The primitive of each element, or of the first one of each `2^shift`: every hit and every ray that starts on a surface asks for it.
    prims: Vec<u32>,
    shift: u32,
}

impl FirstIds {
    /// The most numbers in the list for each primitive, and in any case: lists that fit into the cache are faster than longer ones.
    const LISTED: u64 = 8;
    const LEAST: u64 = 1 << 10;

    /// Given the first numbers, ascending from 0, and the number of all elements.
    pub(crate) fn new(first: Vec<u64>, count: u64) -> Self {
        let mut shift = 0;
        let most = (Self::LISTED * first.len() as u64).max(Self::LEAST);
        while count >> shift > most {
            shift += 1;
        }
        let mut prims = Vec::new();
        let ends = first.iter().skip(1).copied().chain([count]);
        for (prim, end) in (0..).zip(ends) {
            // Groups of elements that begin in front of the end.
            let groups = end.div_ceil(1 << shift);
            prims.resize(groups as usize, prim);
        }
        Self {
            first,
            prims,
            shift,
        }
    }

    /// The number of a primitive's first element.
    #[inline]
    pub(crate) fn of(&self, prim: u32) -> u64 {
        self.first.get(prim as usize).copied().unwrap_or_default()
    }

    /// The primitive of an element.
    #[inline]
    pub(crate) fn prim_of(&self, id: u64) -> u32 {
        match self.prims.get((id >> self.shift) as usize) {
            Some(prim) if self.shift == 0 => *prim,
            Some(prim) => self.find_from(*prim, id),
            None => self.find(id),
        }
    }

    /// The primitive of an element, which is one of those from this one on.
    #[inline]
    fn find_from(&self, prim: u32, id: u64) -> u32 {
        /// More primitives are not tried one by one.
        const STEPS: u32 = 4;
        for prim in prim..prim + STEPS {
            let next = self.first.get(prim as usize + 1);
            if next.is_none_or(|next| id < *next) {
                return prim;
            }
        }
        self.find(id)
    }

    #[inline(never)]
    fn find(&self, id: u64) -> u32 {
        (self.first.partition_point(|first| *first <= id) - 1) as u32
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn listed_elements_have_the_primitives_that_are_found() {
        // The third primitive has no element.
        let ids = FirstIds::new(vec![0, 1, 4, 4, 5], 9);
        let prims: Vec<u32> = (0..9).map(|id| ids.prim_of(id)).collect();
        assert_eq!(prims, [0, 1, 1, 1, 3, 4, 4, 4, 4]);
        assert!((0..9).all(|id| ids.find(id) == prims[id as usize]));
        assert_eq!((ids.of(2), ids.of(3), ids.of(4)), (4, 4, 5));
        let many = FirstIds::new(vec![0, 7], FirstIds::LEAST + 1);
        assert_eq!((many.prim_of(6), many.prim_of(7)), (0, 1));
    }

    #[test]
    fn one_of_many_elements_is_listed() {
        let first = vec![0, 1, 3, 3, 4, 5, 6, 7, 100_000, 100_001, 299_999];
        let ids = FirstIds::new(first, 300_000);
        assert_eq!(ids.shift, 9);
        assert!((0..300_000).all(|id| ids.prim_of(id) == ids.find(id)));
        let many = FirstIds::new((0..1000).map(|k| 777 * k).collect(), 777_000);
        assert!((0..777_000).all(|id| many.prim_of(id) == many.find(id)));
    }
}
