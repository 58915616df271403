//! Lists whose copies share their memory.

use std::ops::Deref;
use std::sync::Arc;

/// A list whose copies share its memory until one of them is changed.
///
/// Scenes copy textures: each of a thousand objects with `pigment { Stones scale 2 }` has a copy of `Stones` with a scale of its own. The members
/// of the maps of `Stones` are the same in all of them.
#[derive(Debug, PartialEq)]
pub struct SharedList<T>(Arc<[T]>);

impl<T: Clone> SharedList<T> {
    /// The list, to be changed; copied first if it has other owners.
    pub fn make_mut(&mut self) -> &mut [T] {
        Arc::make_mut(&mut self.0)
    }
}

impl<T> Clone for SharedList<T> {
    fn clone(&self) -> Self {
        Self(Arc::clone(&self.0))
    }
}

impl<T> Default for SharedList<T> {
    fn default() -> Self {
        Self(Arc::from([]))
    }
}

impl<T> Deref for SharedList<T> {
    type Target = [T];

    fn deref(&self) -> &[T] {
        &self.0
    }
}

impl<T> From<Vec<T>> for SharedList<T> {
    fn from(list: Vec<T>) -> Self {
        Self(list.into())
    }
}

impl<T> FromIterator<T> for SharedList<T> {
    fn from_iter<I: IntoIterator<Item = T>>(items: I) -> Self {
        Self(items.into_iter().collect())
    }
}

impl<'a, T> IntoIterator for &'a SharedList<T> {
    type Item = &'a T;
    type IntoIter = std::slice::Iter<'a, T>;

    fn into_iter(self) -> Self::IntoIter {
        self.0.iter()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn copies_share_memory_until_one_is_changed() {
        let list = SharedList::from(vec![1, 2]);
        let mut copy = list.clone();
        assert!(std::ptr::eq(&*list, &*copy));
        copy.make_mut()[1] = 3;
        assert_eq!((&*list, &*copy), (&[1, 2][..], &[1, 3][..]));
    }
}
