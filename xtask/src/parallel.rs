//! Work on a list with several threads.

use anyhow::{Result, bail};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Processes a list with `jobs` threads, at least one; `work` gets the index of an item and the item. The results are in the order
/// of the list.
pub(crate) fn in_parallel<T: Sync, R: Send>(
    items: &[T],
    jobs: usize,
    work: impl Fn(usize, &T) -> Result<R> + Sync,
) -> Result<Vec<R>> {
    let next = AtomicUsize::new(0);
    let results = Mutex::new(vec![]);
    std::thread::scope(|scope| {
        let one = || -> Result<()> {
            loop {
                let index = next.fetch_add(1, Ordering::Relaxed);
                let Some(item) = items.get(index) else {
                    return Ok(());
                };
                let result = work(index, item)?;
                if let Ok(mut results) = results.lock() {
                    results.push((index, result));
                }
            }
        };
        let threads: Vec<_> = (0..jobs.max(1)).map(|_| scope.spawn(one)).collect();
        threads.into_iter().try_for_each(|t| match t.join() {
            Ok(result) => result,
            Err(_) => bail!("a thread panicked"),
        })
    })?;
    let mut results = results.into_inner().unwrap_or_default();
    results.sort_by_key(|(index, _)| *index);
    Ok(results.into_iter().map(|(_, result)| result).collect())
}

#[cfg(test)]
mod tests {
    use super::in_parallel;
    use anyhow::bail;

    #[test]
    fn results_come_in_order() {
        let numbers: Vec<usize> = (0..50).collect();
        let doubled = in_parallel(&numbers, 7, |index, n| Ok(index + n)).unwrap();
        assert_eq!(doubled, (0..50).map(|n| 2 * n).collect::<Vec<_>>());
        let failing = |_, n: &usize| if *n == 9 { bail!("no") } else { Ok(()) };
        assert!(in_parallel(&numbers, 3, failing).is_err());
    }
}
