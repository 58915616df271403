//! The numbers of elements by primitives.

/// The numbers that the elements of a group's primitives have, where some primitive has more or fewer than one element.
#[derive(Clone, Debug)]
pub(crate) struct FirstIds {
    /// The number of the first element of each primitive, ascending.
    first: Vec<u64>,
    /// The primitive of each element, if there are few elements: every hit and every ray that starts on a surface asks for it.
    prims: Vec<u32>,
}

impl FirstIds {
    /// The most elements that are listed one by one.
    const FEW: u64 = 1 << 16;

    /// Given the first numbers, ascending from 0, and the number of all elements.
    pub(crate) fn new(first: Vec<u64>, count: u64) -> Self {
        let mut prims = Vec::new();
        if count <= Self::FEW {
            let ends = first.iter().skip(1).copied().chain([count]);
            for (prim, end) in (0..).zip(ends) {
                prims.resize(end as usize, prim);
            }
        }
        Self { first, prims }
    }

    /// The number of a primitive's first element.
    #[inline]
    pub(crate) fn of(&self, prim: u32) -> u64 {
        self.first.get(prim as usize).copied().unwrap_or_default()
    }

    /// The primitive of an element.
    #[inline]
    pub(crate) fn prim_of(&self, id: u64) -> u32 {
        match self.prims.get(id as usize) {
            Some(prim) => *prim,
            None => self.find(id),
        }
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
        let many = FirstIds::new(vec![0, 7], FirstIds::FEW + 1);
        assert_eq!((many.prim_of(6), many.prim_of(7)), (0, 1));
    }
}
