//! Pointers from C and to C: checked for null, borrowed, handed over, and taken back.

#![expect(unsafe_code, reason = "C's pointers can only be read and written so")]

use pathwarp_engine::{Error, ErrorKind};
use std::ffi::{CStr, CString, c_char};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// The statuses of `pathwarp.h`: the command line's exit statuses, of which 1 and 5 do not occur here.
const OK: i32 = 0;
const USAGE: i32 = 2;
const INPUT: i32 = 3;
const GEOMETRY: i32 = 4;
const LIMIT: i32 = 6;
const INTERNAL: i32 = 7;

/// The status and the message of a failed call.
pub(crate) struct Failed(i32, String);

impl From<Error> for Failed {
    fn from(e: Error) -> Self {
        let status = match e.kind {
            ErrorKind::Usage => USAGE,
            ErrorKind::Input => INPUT,
            ErrorKind::Geometry => GEOMETRY,
            ErrorKind::Limit => LIMIT,
            _ => INTERNAL,
        };
        Self(status, e.message)
    }
}

impl Failed {
    /// Makes the error for a file that cannot be used.
    pub(crate) fn input(message: String) -> Self {
        Self(INPUT, message)
    }

    /// Makes the error for a wrong argument.
    pub(crate) fn usage(message: String) -> Self {
        Self(USAGE, message)
    }
}

/// Calls `work`, and hands its status and message to C. Panics become [`INTERNAL`].
///
/// # Safety
/// `error` is null, or may be written to.
pub(crate) unsafe fn status(error: *mut *mut c_char, work: impl FnOnce() -> Result<(), Failed>) -> i32 {
    let (status, message) = match catch_unwind(AssertUnwindSafe(work)) {
        Ok(Ok(())) => (OK, std::ptr::null_mut()),
        Ok(Err(Failed(status, message))) => (status, owned_text(&message)),
        Err(_) => (INTERNAL, owned_text("pathwarp failed; please report it")),
    };
    if error.is_null() {
        // SAFETY: `owned_text` made it, and nobody else has it.
        unsafe { drop_text(message) };
    } else {
        // SAFETY: not null, and the caller guarantees that it may be written to.
        unsafe { error.write(message) };
    }
    status
}

/// Returns a text from C.
///
/// # Safety
/// `text` is null, or points to bytes that end with a zero and stay as they are while the result is used.
pub(crate) unsafe fn text<'a>(text: *const c_char, name: &str) -> Result<&'a str, Failed> {
    check_not_null(text, name)?;
    // SAFETY: not null, and the caller guarantees that the bytes end with a zero.
    let text = unsafe { CStr::from_ptr(text) };
    text.to_str().map_err(|e| Failed::usage(format!("{name} is not UTF-8 (byte {})", e.valid_up_to())))
}

/// Returns an array from C. The pointer may be null if the array is empty.
///
/// # Safety
/// `first` is null, or points to `count` values that stay as they are while the result is used.
pub(crate) unsafe fn array<'a, T>(first: *const T, count: usize, name: &str) -> Result<&'a [T], Failed> {
    if count == 0 {
        return Ok(&[]);
    }
    check_array(first, count, name)?;
    // SAFETY: neither null, nor misaligned, nor too large, and the caller guarantees that the values are there.
    Ok(unsafe { std::slice::from_raw_parts(first, count) })
}

/// Returns an array of C that is written to. The pointer may be null if the array is empty.
///
/// # Safety
/// `first` is null, or points to `count` values that nobody else uses while the result is used.
pub(crate) unsafe fn array_mut<'a, T>(first: *mut T, count: usize, name: &str) -> Result<&'a mut [T], Failed> {
    if count == 0 {
        return Ok(&mut []);
    }
    check_array(first, count, name)?;
    // SAFETY: neither null, nor misaligned, nor too large, and the caller guarantees that nobody else uses the values.
    Ok(unsafe { std::slice::from_raw_parts_mut(first, count) })
}

fn check_array<T>(first: *const T, count: usize, name: &str) -> Result<(), Failed> {
    check_not_null(first, name)?;
    if !first.is_aligned() {
        return Err(Failed::usage(format!("{name} is not aligned")));
    }
    if count.checked_mul(size_of::<T>()).is_none_or(|bytes| isize::try_from(bytes).is_err()) {
        return Err(Failed::usage(format!("{name}: the count {count} is larger than memory can hold")));
    }
    Ok(())
}

/// Checks that an argument, or the pointer to a result, is not null.
pub(crate) fn check_not_null<T>(pointer: *const T, name: &str) -> Result<(), Failed> {
    if pointer.is_null() { Err(Failed::usage(format!("{name} is NULL"))) } else { Ok(()) }
}

/// Returns the value behind a pointer.
///
/// # Safety
/// `pointer` is null, or points to a value that stays as it is while the result is used.
pub(crate) unsafe fn value<'a, T>(pointer: *const T, name: &str) -> Result<&'a T, Failed> {
    // SAFETY: the caller guarantees it.
    unsafe { pointer.as_ref() }.ok_or_else(|| Failed::usage(format!("{name} is NULL")))
}

/// Returns the value behind a pointer, to be changed.
///
/// # Safety
/// `pointer` is null, or points to a value that nobody else uses while the result is used.
pub(crate) unsafe fn value_mut<'a, T>(pointer: *mut T, name: &str) -> Result<&'a mut T, Failed> {
    // SAFETY: the caller guarantees it.
    unsafe { pointer.as_mut() }.ok_or_else(|| Failed::usage(format!("{name} is NULL")))
}

/// Writes a result, if its pointer is not null.
///
/// # Safety
/// `result` is null, or may be written to.
pub(crate) unsafe fn put<T>(result: *mut T, value: T) {
    if !result.is_null() {
        // SAFETY: not null, and the caller guarantees that it may be written to.
        unsafe { result.write(value) };
    }
}

/// Hands a text over to C. It ends at its first zero byte.
pub(crate) fn owned_text(text: &str) -> *mut c_char {
    let end = text.find('\0').unwrap_or(text.len());
    CString::new(&text[..end]).unwrap_or_default().into_raw()
}

/// Takes a text back and drops it.
///
/// # Safety
/// `text` is null, or came from [`owned_text`] and was not released.
pub(crate) unsafe fn drop_text(text: *mut c_char) {
    if !text.is_null() {
        // SAFETY: it came from `CString::into_raw`, and the caller gives it up.
        drop(unsafe { CString::from_raw(text) });
    }
}

/// Hands an array over to C: its first value and their count.
pub(crate) fn owned_array<T>(values: Box<[T]>) -> (*mut T, usize) {
    let count = values.len();
    (Box::into_raw(values).cast(), count)
}

/// Takes an array back; it is empty if the pointer is null.
///
/// # Safety
/// `first` is null, or came from [`owned_array`] with this count and was not released.
pub(crate) unsafe fn take_back_array<T>(first: *mut T, count: usize) -> Box<[T]> {
    if first.is_null() {
        return Box::default();
    }
    // SAFETY: it came from a boxed slice of this length, and the caller gives it up.
    unsafe { Box::from_raw(std::ptr::slice_from_raw_parts_mut(first, count)) }
}
