//! The functions of `pathwarp.h`.

#![expect(unsafe_code, reason = "C calls these functions, and they take its pointers")]

use crate::raw::{
    Failed, array, array_mut, drop_bytes, drop_text, hand_over, owned_bytes, owned_text, place, put, status, take_back,
    text, value, value_mut, wrong,
};
use pathwarp::deform::Registry;
use pathwarp::kurbo::{Point, Rect};
use pathwarp_engine::Warper;
use pathwarp_engine::input::hatching;
use std::ffi::{CStr, c_char};
use std::path::Path;

/// Points mapped by one call of the map.
const BLOCK: usize = 256;

/// `pathwarp_warper`.
pub struct PathwarpWarper(Warper);

/// The version of the library.
#[unsafe(no_mangle)]
pub extern "C" fn pathwarp_version() -> *const c_char {
    const VERSION: &CStr = match CStr::from_bytes_with_nul(concat!(env!("CARGO_PKG_VERSION"), "\0").as_bytes()) {
        Ok(version) => version,
        Err(_) => c"",
    };
    VERSION.as_ptr()
}

/// Makes a deformation.
///
/// # Safety
/// Every pointer is null or as `pathwarp.h` says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pathwarp_new(
    name: *const c_char,
    names: *const *const c_char,
    values: *const *const c_char,
    count: usize,
    warper: *mut *mut PathwarpWarper,
    error: *mut *mut c_char,
) -> i32 {
    let made = || {
        // SAFETY: the header says that these are texts, and arrays of `count` texts.
        let (name, names, values) =
            unsafe { (text(name, "name")?, array(names, count, "names")?, array(values, count, "values")?) };
        let pairs = names.iter().zip(values).map(|(n, v)| {
            // SAFETY: as above.
            Ok(unsafe { (text(*n, "an element of names")?, text(*v, "an element of values")?) })
        });
        let pairs: Vec<(&str, &str)> = pairs.collect::<Result<_, Failed>>()?;
        Ok(Warper::new(&Registry::builtin(), name, &pairs)?)
    };
    // SAFETY: the header says that both may be written to.
    unsafe { status(error, || new_warper(warper, made)) }
}

/// Makes what a recipe says.
///
/// # Safety
/// Every pointer is null or as `pathwarp.h` says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pathwarp_from_recipe(
    text: *const c_char,
    folder: *const c_char,
    warper: *mut *mut PathwarpWarper,
    error: *mut *mut c_char,
) -> i32 {
    let made = || {
        // SAFETY: the header says that these are texts.
        let (text, folder) = unsafe { (crate::raw::text(text, "text")?, crate::raw::text(folder, "folder")?) };
        Ok(Warper::from_recipe(&Registry::builtin(), text, Path::new(folder), false)?)
    };
    // SAFETY: the header says that both may be written to.
    unsafe { status(error, || new_warper(warper, made)) }
}

/// Makes one warper followed by another.
///
/// # Safety
/// Every pointer is null or as `pathwarp.h` says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pathwarp_then(
    first: *const PathwarpWarper,
    second: *const PathwarpWarper,
    warper: *mut *mut PathwarpWarper,
    error: *mut *mut c_char,
) -> i32 {
    // SAFETY: the header says that these are warpers that were not released.
    let made = || unsafe { Ok(value(first, "first")?.0.then(&value(second, "second")?.0)) };
    // SAFETY: the header says that both may be written to.
    unsafe { status(error, || new_warper(warper, made)) }
}

/// Makes the inverse.
///
/// # Safety
/// Every pointer is null or as `pathwarp.h` says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pathwarp_inverse(
    of: *const PathwarpWarper,
    warper: *mut *mut PathwarpWarper,
    error: *mut *mut c_char,
) -> i32 {
    // SAFETY: the header says that it is a warper that was not released.
    let made = || unsafe { Ok(value(of, "of")?.0.inverted()) };
    // SAFETY: the header says that both may be written to.
    unsafe { status(error, || new_warper(warper, made)) }
}

/// Puts a new warper in its place.
///
/// # Safety
/// `warper` is null, or may be written to.
unsafe fn new_warper(
    warper: *mut *mut PathwarpWarper,
    made: impl FnOnce() -> Result<Warper, Failed>,
) -> Result<(), Failed> {
    place(warper, "warper")?;
    let made = hand_over(PathwarpWarper(made()?));
    // SAFETY: as the caller says.
    unsafe { put(warper, made) };
    Ok(())
}

/// Sets an option.
///
/// # Safety
/// Every pointer is null or as `pathwarp.h` says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pathwarp_set_option(
    warper: *mut PathwarpWarper,
    name: *const c_char,
    value: *const c_char,
    error: *mut *mut c_char,
) -> i32 {
    let set = || {
        // SAFETY: the header says that it is a warper, which no other thread uses now, and that these are texts.
        let (warper, name, value) =
            unsafe { (value_mut(warper, "warper")?, text(name, "name")?, text(value, "value")?) };
        Ok(warper.0.set_option(name, value)?)
    };
    // SAFETY: the header says that `error` may be written to.
    unsafe { status(error, set) }
}

/// Maps points.
///
/// # Safety
/// Every pointer is null or as `pathwarp.h` says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pathwarp_map_points(
    warper: *const PathwarpWarper,
    from: *const f64,
    to: *mut f64,
    count: usize,
    error: *mut *mut c_char,
) -> i32 {
    let map = || {
        let numbers = count.checked_mul(2).ok_or_else(|| wrong(format!("the count {count} is larger than memory")))?;
        // The points are copied, so that `from` may be `to`.
        // SAFETY: the header says that it is a warper, and that the numbers are there; both are done with before `to` is written.
        let (warper, from) = unsafe { (value(warper, "warper")?, array(from, numbers, "from")?) };
        let points: Vec<Point> = from.as_chunks().0.iter().map(|[x, y]| Point::new(*x, *y)).collect();
        let finite = || points.iter().filter(|p| p.is_finite());
        let bounds = || finite().map(|p| Rect::from_points(*p, *p)).reduce(|a, b| a.union(b));
        let map = warper.0.point_map(bounds, hatching)?;
        // SAFETY: the header says that the numbers may be written to; `from`, which may be the same, is not used any more.
        let to = unsafe { array_mut(to, numbers, "to")? };
        let mut images = [Point::ORIGIN; BLOCK];
        for (source, target) in points.chunks(BLOCK).zip(to.as_chunks_mut::<2>().0.chunks_mut(BLOCK)) {
            let images = &mut images[..source.len()];
            map.points(source, images);
            for (out, p) in target.iter_mut().zip(images) {
                *out = [p.x, p.y];
            }
        }
        Ok(())
    };
    // SAFETY: the header says that `error` may be written to.
    unsafe { status(error, map) }
}

/// Bends path data.
///
/// # Safety
/// Every pointer is null or as `pathwarp.h` says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pathwarp_warp_path(
    warper: *const PathwarpWarper,
    data: *const c_char,
    result: *mut *mut c_char,
    max_error: *mut f64,
    error: *mut *mut c_char,
) -> i32 {
    let warp = || {
        place(result, "result")?;
        // SAFETY: the header says that it is a warper, and a text.
        let (warper, data) = unsafe { (value(warper, "warper")?, text(data, "data")?) };
        let warped = warper.0.warp_path(data)?.path;
        // SAFETY: the header says that both may be written to, and `max_error` may be null.
        unsafe {
            put(result, owned_text(&warped.data));
            put(max_error, warped.report.max_error);
        }
        Ok(())
    };
    // SAFETY: the header says that `error` may be written to.
    unsafe { status(error, warp) }
}

/// Warps a drawing.
///
/// # Safety
/// Every pointer is null or as `pathwarp.h` says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pathwarp_warp_drawing(
    warper: *const PathwarpWarper,
    bytes: *const u8,
    length: usize,
    result: *mut *mut u8,
    result_length: *mut usize,
    report: *mut *mut c_char,
    error: *mut *mut c_char,
) -> i32 {
    let warp = || {
        place(result, "result")?;
        place(result_length, "result_length")?;
        // SAFETY: the header says that it is a warper, and that the bytes are there.
        let (warper, bytes) = unsafe { (value(warper, "warper")?, array(bytes, length, "bytes")?) };
        let warped = warper.0.warp_drawing(bytes, None)?;
        let (first, count) = owned_bytes(warped.bytes);
        // SAFETY: the header says that all may be written to, and `report` may be null.
        unsafe {
            put(result, first);
            put(result_length, count);
            if !report.is_null() {
                put(report, owned_text(&warped.report));
            }
        }
        Ok(())
    };
    // SAFETY: the header says that `error` may be written to.
    unsafe { status(error, warp) }
}

/// Releases a warper.
///
/// # Safety
/// It is null, or a warper that was not released.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pathwarp_free(warper: *mut PathwarpWarper) {
    // SAFETY: as the caller says.
    unsafe { take_back(warper) };
}

/// Releases a text.
///
/// # Safety
/// It is null, or a text of this library that was not released.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pathwarp_string_free(text: *mut c_char) {
    // SAFETY: as the caller says.
    unsafe { drop_text(text) };
}

/// Releases bytes.
///
/// # Safety
/// They are null, or bytes of this library with this length that were not released.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pathwarp_bytes_free(bytes: *mut u8, length: usize) {
    // SAFETY: as the caller says.
    unsafe { drop_bytes(bytes, length) };
}
