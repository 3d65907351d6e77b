//! Loops over chunks of a picture: on all processors with the feature `parallel`, else one after the other.

#[cfg(feature = "parallel")]
use rayon::prelude::*;

/// Calls `f` with the index and the content of every chunk of `size` elements.
pub(crate) fn for_each_chunk<T: Send>(data: &mut [T], size: usize, f: impl Fn(usize, &mut [T]) + Send + Sync) {
    #[cfg(feature = "parallel")]
    data.par_chunks_mut(size).enumerate().for_each(|(i, chunk)| f(i, chunk));
    #[cfg(not(feature = "parallel"))]
    data.chunks_mut(size).enumerate().for_each(|(i, chunk)| f(i, chunk));
}

/// Calls `f` with the index and the content of every chunk of `size` elements of two slices of the same length.
pub(crate) fn for_each_chunk_pair<T: Send, U: Send>(
    a: &mut [T],
    b: &mut [U],
    size: usize,
    f: impl Fn(usize, &mut [T], &mut [U]) + Send + Sync,
) {
    #[cfg(feature = "parallel")]
    a.par_chunks_mut(size).zip(b.par_chunks_mut(size)).enumerate().for_each(|(i, (a, b))| f(i, a, b));
    #[cfg(not(feature = "parallel"))]
    a.chunks_mut(size).zip(b.chunks_mut(size)).enumerate().for_each(|(i, (a, b))| f(i, a, b));
}
