//! Lists of millions of items that follow regularly from each other, in little memory.

use std::fmt::Debug;
use std::ops::Range;

/// A run of items: the first one and the rule by which the others follow.
pub(crate) trait Run: Clone + Debug {
    /// The items of the list.
    type Item: Clone + Debug;

    /// A run of one item.
    fn of(item: Self::Item) -> Self;

    /// Whether an item continues a run of `len` items. (The second item may set the steps.)
    fn goes_on(&mut self, len: u32, item: &Self::Item) -> bool;

    /// The item at a place in the run.
    fn item(&self, place: u32) -> Self::Item;
}

/// A list that is stored as runs if these are few. It has less than 2³² items.
#[derive(Clone, Debug)]
pub(crate) struct RunList<R: Run> {
    len: u32,
    storage: Storage<R>,
}

/// How the items are stored.
#[derive(Clone, Debug)]
enum Storage<R: Run> {
    /// Each with the number of its first item.
    Runs(Vec<(u32, R)>),
    Items(Vec<R::Item>),
}

/// In shorter lists the memory saved is not worth the search for the run.
const SHORT: u32 = 1 << 16;

/// Runs must have this many items on average, so that searching for one is fast.
const WORTH_IT: usize = 64;

impl<R: Run> Default for RunList<R> {
    fn default() -> Self {
        Self {
            len: 0,
            storage: Storage::Runs(Vec::new()),
        }
    }
}

impl<R: Run> RunList<R> {
    /// Number of items.
    pub(crate) const fn len(&self) -> usize {
        self.len as usize
    }

    /// Whether there are none.
    pub(crate) const fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Appends an item.
    pub(crate) fn push(&mut self, item: R::Item) {
        match &mut self.storage {
            Storage::Items(items) => items.push(item),
            Storage::Runs(runs) => {
                let goes_on = runs
                    .last_mut()
                    .is_some_and(|(first, run)| run.goes_on(self.len - *first, &item));
                if !goes_on {
                    runs.push((self.len, R::of(item)));
                }
            }
        }
        self.len += 1;
    }

    /// An item; the number must be below the length.
    #[inline(always)]
    pub(crate) fn at(&self, index: u32) -> R::Item {
        match &self.storage {
            Storage::Items(items) => items[index as usize].clone(),
            Storage::Runs(runs) => Self::in_runs(runs, index),
        }
    }

    /// The run of an item is the last one that does not begin behind it.
    #[inline(always)]
    fn in_runs(runs: &[(u32, R)], index: u32) -> R::Item {
        let mut rest = runs;
        while rest.len() > 1 {
            let (before, behind) = rest.split_at(rest.len() / 2);
            rest = if behind[0].0 <= index { behind } else { before };
        }
        let (first, run) = &rest[0];
        run.item(index - first)
    }

    /// An item, if there is one of that number.
    pub(crate) fn get(&self, index: u32) -> Option<R::Item> {
        (index < self.len).then(|| self.at(index))
    }

    /// All items in their order.
    pub(crate) fn iter(&self) -> impl Iterator<Item = R::Item> {
        let mut run = 0;
        (0..self.len).map(move |index| match &self.storage {
            Storage::Items(items) => items[index as usize].clone(),
            Storage::Runs(runs) => {
                run += usize::from(runs.get(run + 1).is_some_and(|(first, _)| *first == index));
                let (first, start) = &runs[run];
                start.item(index - first)
            }
        })
    }

    /// The runs of the list: the first item and the positions of each. Where items are stored one by one, each is a run.
    pub(crate) fn runs(&self) -> impl Iterator<Item = (R::Item, Range<u32>)> {
        let count = match &self.storage {
            Storage::Items(items) => items.len(),
            Storage::Runs(runs) => runs.len(),
        };
        (0..count).map(move |number| match &self.storage {
            Storage::Items(items) => {
                let place = number as u32;
                (items[number].clone(), place..place + 1)
            }
            Storage::Runs(runs) => {
                let (first, run) = &runs[number];
                let end = runs.get(number + 1).map_or(self.len, |(next, _)| *next);
                (run.item(0), *first..end)
            }
        })
    }

    /// The finished list in the form that is read fastest: item by item if runs do not pay.
    pub(crate) fn completed(self) -> Self {
        match &self.storage {
            Storage::Runs(runs) if self.len < SHORT || runs.len() * WORTH_IT > self.len() => Self {
                len: self.len,
                storage: Storage::Items(self.iter().collect()),
            },
            _ => self,
        }
    }

    /// Bytes it occupies.
    pub(crate) fn bytes(&self) -> usize {
        match &self.storage {
            Storage::Runs(runs) => size_of_val(runs.as_slice()),
            Storage::Items(items) => size_of_val(items.as_slice()),
        }
    }
}

impl<R: Run> FromIterator<R::Item> for RunList<R> {
    fn from_iter<I: IntoIterator<Item = R::Item>>(items: I) -> Self {
        let mut list = Self::default();
        for item in items {
            list.push(item);
        }
        list
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers with a constant step, which the second one sets.
    #[derive(Clone, Debug)]
    struct Steps {
        first: u32,
        step: u32,
    }

    impl Run for Steps {
        type Item = u32;

        fn of(first: u32) -> Self {
            Self { first, step: 0 }
        }

        fn goes_on(&mut self, len: u32, item: &u32) -> bool {
            if len == 1 {
                self.step = item.wrapping_sub(self.first);
            }
            self.item(len) == *item
        }

        fn item(&self, place: u32) -> u32 {
            self.first.wrapping_add(self.step.wrapping_mul(place))
        }
    }

    #[test]
    fn runs_are_the_list_they_were_made_from() {
        let ramps = |n: u32| (0..n).map(|i| i % 1000 * 3 + 7);
        let squares = |n: u32| (0..n).map(|i| i * i);
        for n in [0, 1, 2, 999, 1000, 1001, 5000, 100_000] {
            let lists: [Vec<u32>; 2] = [ramps(n).collect(), squares(n % 60_000).collect()];
            for numbers in lists {
                let list: RunList<Steps> = numbers.iter().copied().collect();
                for list in [list.clone(), list.completed()] {
                    assert_eq!(list.len(), numbers.len());
                    assert!(list.iter().eq(numbers.iter().copied()));
                    for (i, number) in (0..).zip(&numbers) {
                        assert_eq!(list.at(i), *number);
                    }
                    assert_eq!(list.get(numbers.len() as u32), None);
                    let mut next = 0;
                    for (first, places) in list.runs() {
                        assert_eq!((first, places.start), (list.at(next), next));
                        next = places.end;
                    }
                    assert_eq!(next as usize, numbers.len());
                }
            }
        }
    }

    #[test]
    fn runs_take_little_and_what_has_none_takes_no_more_than_its_items() {
        let list = |step: fn(u32) -> u32| {
            let list: RunList<Steps> = (0..100_000).map(step).collect();
            list.completed().bytes()
        };
        assert!(list(|i| i % 1000 * 3) < 3000);
        assert_eq!(list(|i| i.wrapping_mul(i)), 400_000);
    }
}
