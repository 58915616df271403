use strahl_math::DVec3;

/// The vertices in the form in which they are stored until the faces are known.
pub(super) enum Positions {
    /// Declared as `float`: exactly what the file says.
    Single(Vec<[f32; 3]>),
    /// Anything else.
    Double(Vec<DVec3>),
}

impl Positions {
    pub(super) fn len(&self) -> usize {
        match self {
            Self::Single(list) => list.len(),
            Self::Double(list) => list.len(),
        }
    }

    /// Moves vertices that have no finite position to another one: no triangle uses them.
    pub(super) fn replace_not_finite(&mut self, vertex: u32) {
        let index = vertex as usize;
        match self {
            Self::Single(list) => {
                let other = list[index];
                let odd = list.iter_mut().filter(|p| !p.iter().all(|x| x.is_finite()));
                odd.for_each(|p| *p = other);
            }
            Self::Double(list) => {
                let other = list[index];
                let odd = list.iter_mut().filter(|p| !p.is_finite());
                odd.for_each(|p| *p = other);
            }
        }
    }

    /// A vertex; the index has been checked.
    #[inline]
    pub(super) fn at(&self, index: u32) -> DVec3 {
        match self {
            Self::Single(list) => DVec3::from_array(list[index as usize].map(f64::from)),
            Self::Double(list) => list[index as usize],
        }
    }
}
