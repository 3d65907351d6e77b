//! Work on the chunks of a slice, on several threads if there is enough of it, with results in order.

#[cfg(feature = "parallel")]
use super::limits::WORTH_THREADS;

/// Applies `f` to each chunk of `items` with its index; the first error in their order ends it.
pub(super) fn in_parallel<T: Sync, R: Send, E: Send>(
    items: &[T],
    chunk: usize,
    f: impl Fn(usize, &[T]) -> Result<R, E> + Sync,
) -> Result<Vec<R>, E> {
    #[cfg(feature = "parallel")]
    if items.len() >= WORTH_THREADS {
        use rayon::prelude::*;
        let results: Vec<Result<R, E>> = items.par_chunks(chunk).enumerate().map(|(i, c)| f(i, c)).collect();
        return results.into_iter().collect();
    }
    items.chunks(chunk).enumerate().map(|(i, c)| f(i, c)).collect()
}
