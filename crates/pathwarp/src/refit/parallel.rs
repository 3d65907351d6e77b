//! Work on chunks of a path, on several threads if there is enough of it, with results in order.

#[cfg(feature = "parallel")]
use super::limits::WORTH_THREADS;

/// Applies `f` to each chunk with the index of its first item; the first error in their order ends it.
pub(super) fn in_parallel<T: Sync, R: Send, E: Send>(
    chunks: &[(usize, &[T])],
    f: impl Fn(usize, &[T]) -> Result<R, E> + Sync,
) -> Result<Vec<R>, E> {
    #[cfg(feature = "parallel")]
    if chunks.iter().map(|(_, c)| c.len()).sum::<usize>() >= WORTH_THREADS {
        use rayon::prelude::*;
        let results: Vec<Result<R, E>> = chunks.par_iter().map(|(i, c)| f(*i, c)).collect();
        return results.into_iter().collect();
    }
    chunks.iter().map(|(i, c)| f(*i, c)).collect()
}
