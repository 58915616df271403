//! Lists of large elements.

use super::bytes;
use std::ops::{Deref, DerefMut};

/// A list of large elements whose slots are used again: an element is put together where it stays, because a copy of what has just been
/// stored waits for the stores.
#[derive(Debug)]
pub(super) struct Slots<T> {
    list: Vec<T>,
    count: usize,
}

impl<T> Default for Slots<T> {
    fn default() -> Self {
        Self {
            list: Vec::new(),
            count: 0,
        }
    }
}

impl<T: Clone> Slots<T> {
    /// The bytes of the list.
    pub(super) fn bytes(&self) -> usize {
        bytes(&self.list)
    }

    pub(super) fn clear(&mut self) {
        self.count = 0;
    }

    /// The slot of one element more. It has the element that was there before, or `first`.
    #[inline]
    pub(super) fn add(&mut self, first: &T) -> &mut T {
        if self.count == self.list.len() {
            self.list.push(first.clone());
        }
        self.count += 1;
        &mut self.list[self.count - 1]
    }

    /// Takes the last element.
    #[inline]
    pub(super) fn take(&mut self) -> Option<&T> {
        self.count = self.count.checked_sub(1)?;
        self.list.get(self.count)
    }

    /// Removes an element; the last one takes its place.
    #[inline]
    pub(super) fn swap_remove(&mut self, index: usize) {
        self.count -= 1;
        if index != self.count {
            self.list[index] = self.list[self.count].clone();
        }
    }
}

impl<T> Deref for Slots<T> {
    type Target = [T];

    #[inline]
    fn deref(&self) -> &[T] {
        &self.list[..self.count]
    }
}

impl<T> DerefMut for Slots<T> {
    #[inline]
    fn deref_mut(&mut self) -> &mut [T] {
        &mut self.list[..self.count]
    }
}
