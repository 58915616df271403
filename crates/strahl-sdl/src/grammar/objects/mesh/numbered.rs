//! Lists without duplicates.

use hashbrown::hash_table::Entry;
use hashbrown::{DefaultHashBuilder, HashTable};
use std::hash::{BuildHasher, Hash};

/// An entry of a [`Numbered`] list.
pub(super) trait NumberedEntry: Copy {
    /// What equal entries have in common.
    type Key: Copy + Eq + Hash;

    fn key(self) -> Self::Key;
}

/// Zeros of both signs are equal.
impl NumberedEntry for [f64; 2] {
    type Key = [u64; 2];

    #[inline]
    fn key(self) -> [u64; 2] {
        self.map(|x| (x + 0.0).to_bits())
    }
}

impl NumberedEntry for [f64; 3] {
    type Key = [u64; 3];

    #[inline]
    fn key(self) -> [u64; 3] {
        self.map(|x| (x + 0.0).to_bits())
    }
}

impl NumberedEntry for [u32; 3] {
    type Key = Self;

    #[inline]
    fn key(self) -> Self {
        self
    }
}

/// As many entries at the end of a list are compared before all others are looked up: neighbouring triangles share corners.
const LAST: usize = 4;

/// A list without duplicates: equal entries have one number.
#[derive(Debug)]
pub(super) struct Numbered<T> {
    pub(super) list: Vec<T>,
    /// The numbers of the entries.
    known: HashTable<u32>,
    hasher: DefaultHashBuilder,
}

impl<T> Default for Numbered<T> {
    fn default() -> Self {
        Self {
            list: vec![],
            known: HashTable::new(),
            hasher: DefaultHashBuilder::default(),
        }
    }
}

impl<T: NumberedEntry> Numbered<T> {
    /// The number of an entry, which is added if the list does not have it.
    pub(super) fn number(&mut self, entry: T) -> u32 {
        let Self {
            list,
            known,
            hasher,
        } = self;
        let key = entry.key();
        let end = list.len();
        let last = list.iter().rev().take(LAST);
        if let Some(back) = last.map(|other| other.key()).position(|other| other == key) {
            return (end - 1 - back) as u32;
        }
        let key_of = |number: u32| list.get(number as usize).map(|entry| entry.key());
        let found = known.entry(
            hasher.hash_one(key),
            |number| key_of(*number) == Some(key),
            |number| key_of(*number).map_or(0, |key| hasher.hash_one(key)),
        );
        match found {
            Entry::Occupied(number) => *number.get(),
            Entry::Vacant(place) => {
                let number = end as u32;
                place.insert(number);
                list.push(entry);
                number
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Numbered;

    #[test]
    fn equal_entries_have_one_number() {
        let mut all = Numbered::default();
        let (far, near) = ([1.0, 2.0, 3.0], [-0.0, 0.5, 0.0]);
        assert_eq!(all.number(far), 0);
        assert_eq!(all.number(near), 1);
        // Zeros of both signs are equal; the first one stays.
        assert_eq!(all.number([0.0, 0.5, -0.0]), 1);
        for k in 0..1000 {
            assert_eq!(all.number([f64::from(k), 0.0, 9.0]), 2 + k);
        }
        assert_eq!((all.number(far), all.number(near)), (0, 1));
        assert_eq!(all.number([500.0, -0.0, 9.0]), 502);
        assert!(all.list[1][0].is_sign_negative());
        assert_eq!(all.list.len(), 1002);
    }
}
