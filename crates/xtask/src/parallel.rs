//! Spreads work over plain threads. Threads of rayon's pool must not block on work that itself needs that pool.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

/// Applies `f` to every item, on as many threads as the machine has, and returns the results in order.
pub(crate) fn map<T: Sync, R: Send>(items: &[T], f: impl Fn(&T) -> R + Sync) -> Vec<R> {
    let next = AtomicUsize::new(0);
    let worker = || {
        let taken = std::iter::repeat_with(|| next.fetch_add(1, Ordering::Relaxed));
        taken.map_while(|i| Some((i, f(items.get(i)?)))).collect::<Vec<_>>()
    };
    let mut found = thread::scope(|scope| {
        let threads = thread::available_parallelism().map_or(1, usize::from);
        let workers: Vec<_> = (0..threads).map(|_| scope.spawn(worker)).collect();
        let join = |w: thread::ScopedJoinHandle<'_, _>| w.join().unwrap_or_else(|p| std::panic::resume_unwind(p));
        workers.into_iter().flat_map(join).collect::<Vec<_>>()
    });
    found.sort_unstable_by_key(|(i, _)| *i);
    found.into_iter().map(|(_, result)| result).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[test]
    fn results_keep_the_order_of_the_items() {
        let items: Vec<u64> = (0..50).collect();
        let slow_first = |n: &u64| {
            thread::sleep(Duration::from_micros(2000 - 40 * n));
            n * n
        };
        assert_eq!(map(&items, slow_first), items.iter().map(|n| n * n).collect::<Vec<_>>());
        assert!(map(&[], slow_first).is_empty());
    }
}
