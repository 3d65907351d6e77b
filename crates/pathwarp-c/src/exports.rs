//! The functions of `pathwarp.h`. Each is safe if every pointer is null or as the header says.

#![expect(unsafe_code, reason = "C calls these functions, and they take its pointers")]
#![expect(clippy::missing_safety_doc, reason = "the module's text says it for all functions")]

use crate::function::{Function, PathwarpFunction, on_all_threads, on_calling_thread};
use crate::raw::{
    Failed, array, array_mut, check_not_null, drop_text, owned_array, owned_text, put, status, take_back_array, text,
    value, value_mut,
};
use pathwarp::deform::{Deformation as _, Registry};
use pathwarp::kurbo::{Point, Rect};
use pathwarp_engine::input::hatching;
use pathwarp_engine::{Warper, reserved_names};
use pathwarp_plugin::Reserved;
use std::ffi::{CStr, c_char};
use std::path::Path;
use std::sync::Arc;

/// Points mapped by one call of the map.
const BLOCK: usize = 256;

/// `pathwarp_warper` of the header.
pub struct PathwarpWarper {
    warper: Warper,
    /// `true` if any thread may call the functions of C among its deformations.
    any_thread: bool,
}

impl PathwarpWarper {
    /// Calls `work` with the warper on all cores, or on the calling thread alone if its functions need that.
    fn run<T: Send>(&self, work: impl FnOnce(&Warper) -> T + Send) -> T {
        let work = || work(&self.warper);
        if self.any_thread { on_all_threads(work) } else { on_calling_thread(work) }
    }
}

/// Returns the version of the library.
#[unsafe(no_mangle)]
pub extern "C" fn pathwarp_version() -> *const c_char {
    const VERSION: &CStr = match CStr::from_bytes_with_nul(concat!(env!("CARGO_PKG_VERSION"), "\0").as_bytes()) {
        Ok(version) => version,
        Err(_) => c"",
    };
    VERSION.as_ptr()
}

/// Makes a deformation.
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
        // SAFETY: the header requires texts, and arrays of `count` texts.
        let (name, pairs) = unsafe { (text(name, "name")?, pairs(names, values, count)?) };
        let registry = Registry::builtin();
        let is_edit = pathwarp_engine::edits::info(name).is_some();
        let made = if is_edit { Warper::edit(&registry, name, &pairs) } else { Warper::new(&registry, name, &pairs) };
        Ok(PathwarpWarper { warper: made?, any_thread: true })
    };
    // SAFETY: the header requires that both may be written to.
    unsafe { status(error, || new_warper(warper, made)) }
}

/// Makes the deformation of a plug-in.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pathwarp_new_plugin(
    file: *const c_char,
    names: *const *const c_char,
    values: *const *const c_char,
    count: usize,
    warper: *mut *mut PathwarpWarper,
    error: *mut *mut c_char,
) -> i32 {
    let made = || {
        // SAFETY: the header requires texts, and arrays of `count` texts.
        let (file, pairs) = unsafe { (text(file, "file")?, pairs(names, values, count)?) };
        let built_in = Registry::builtin();
        let taken: Vec<&str> = built_in.entries().iter().map(|e| e.info().name).collect();
        let parameters: Vec<&str> = reserved_names().collect();
        let reserved = Reserved { names: &taken, parameters: &parameters };
        let started = pathwarp_plugin::by_file(Path::new(file), reserved);
        let plugin = started.map_err(|fault| Failed::input(fault.of(Path::new(file)).to_string()))?;
        let name = plugin.info().name;
        Ok(PathwarpWarper { warper: Warper::new(&built_in.with(plugin), name, &pairs)?, any_thread: true })
    };
    // SAFETY: the header requires that both may be written to.
    unsafe { status(error, || new_warper(warper, made)) }
}

/// Makes a deformation of a function.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pathwarp_new_function(
    function: *const PathwarpFunction,
    warper: *mut *mut PathwarpWarper,
    error: *mut *mut c_char,
) -> i32 {
    let made = || {
        // SAFETY: the header requires a description of functions.
        let (function, abilities, any_thread) = unsafe { Function::read(function)? };
        let warper = Warper::from_function(&Registry::builtin(), Arc::new(function), abilities);
        Ok(PathwarpWarper { warper, any_thread })
    };
    // SAFETY: the header requires that both may be written to.
    unsafe { status(error, || new_warper(warper, made)) }
}

/// Reads the names and values of parameters.
///
/// # Safety
/// The arrays are null, or hold `count` texts that stay as they are while the result is used.
unsafe fn pairs<'a>(
    names: *const *const c_char,
    values: *const *const c_char,
    count: usize,
) -> Result<Vec<(&'a str, &'a str)>, Failed> {
    // SAFETY: the caller guarantees it.
    let (names, values) = unsafe { (array(names, count, "names")?, array(values, count, "values")?) };
    let pair = |(n, v): (&*const c_char, &*const c_char)| {
        // SAFETY: the caller guarantees it.
        Ok(unsafe { (text(*n, "an element of names")?, text(*v, "an element of values")?) })
    };
    names.iter().zip(values).map(pair).collect()
}

/// Makes the steps of a recipe. `folder` is where its relative paths begin.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pathwarp_from_recipe(
    text: *const c_char,
    folder: *const c_char,
    warper: *mut *mut PathwarpWarper,
    error: *mut *mut c_char,
) -> i32 {
    let made = || {
        // SAFETY: the header requires texts.
        let (text, folder) = unsafe { (crate::raw::text(text, "text")?, crate::raw::text(folder, "folder")?) };
        let warper = Warper::from_recipe(&Registry::builtin(), text, Path::new(folder), false)?;
        Ok(PathwarpWarper { warper, any_thread: true })
    };
    // SAFETY: the header requires that both may be written to.
    unsafe { status(error, || new_warper(warper, made)) }
}

/// Makes one warper followed by another.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pathwarp_then(
    first: *const PathwarpWarper,
    second: *const PathwarpWarper,
    warper: *mut *mut PathwarpWarper,
    error: *mut *mut c_char,
) -> i32 {
    let made = || {
        // SAFETY: the header requires warpers that were not released.
        let (first, second) = unsafe { (value(first, "first")?, value(second, "second")?) };
        let warper = first.warper.then(&second.warper);
        Ok(PathwarpWarper { warper, any_thread: first.any_thread && second.any_thread })
    };
    // SAFETY: the header requires that both may be written to.
    unsafe { status(error, || new_warper(warper, made)) }
}

/// Makes the inverse of a warper.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pathwarp_inverse(
    of: *const PathwarpWarper,
    warper: *mut *mut PathwarpWarper,
    error: *mut *mut c_char,
) -> i32 {
    let made = || {
        // SAFETY: the header requires a warper that was not released.
        let of = unsafe { value(of, "of")? };
        Ok(PathwarpWarper { warper: of.warper.inverted(), any_thread: of.any_thread })
    };
    // SAFETY: the header requires that both may be written to.
    unsafe { status(error, || new_warper(warper, made)) }
}

/// Writes a new warper to `warper`.
///
/// # Safety
/// `warper` is null, or may be written to.
unsafe fn new_warper(
    warper: *mut *mut PathwarpWarper,
    made: impl FnOnce() -> Result<PathwarpWarper, Failed>,
) -> Result<(), Failed> {
    check_not_null(warper, "warper")?;
    let made = made()?;
    // SAFETY: the caller guarantees it.
    unsafe { put(warper, Box::into_raw(Box::new(made))) };
    Ok(())
}

/// Sets an option.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pathwarp_set_option(
    warper: *mut PathwarpWarper,
    name: *const c_char,
    value: *const c_char,
    error: *mut *mut c_char,
) -> i32 {
    let set = || {
        // SAFETY: the header requires a warper that no other thread uses now, and texts.
        let (warper, name, value) =
            unsafe { (value_mut(warper, "warper")?, text(name, "name")?, text(value, "value")?) };
        Ok(warper.warper.set_option(name, value)?)
    };
    // SAFETY: the header requires that `error` may be written to.
    unsafe { status(error, set) }
}

/// Maps points.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pathwarp_map_points(
    warper: *const PathwarpWarper,
    from: *const f64,
    to: *mut f64,
    count: usize,
    error: *mut *mut c_char,
) -> i32 {
    let map = || {
        let too_large = || Failed::usage(format!("the count {count} is larger than memory can hold"));
        let numbers = count.checked_mul(2).ok_or_else(too_large)?;
        // The points are copied, since `from` may be `to`.
        // SAFETY: the header requires a warper and these numbers; both are done with before `to` is written.
        let (warper, from) = unsafe { (value(warper, "warper")?, array(from, numbers, "from")?) };
        let points: Vec<Point> = from.as_chunks().0.iter().map(|[x, y]| Point::new(*x, *y)).collect();
        let finite = points.iter().filter(|p| p.is_finite());
        let bounds = || finite.map(|p| Rect::from_points(*p, *p)).reduce(|a, b| a.union(b));
        let map = warper.run(|warper| warper.point_map(bounds, hatching))?;
        let block = if map.prefers_batches() { points.len().max(1) } else { BLOCK };
        let mut images = vec![Point::ORIGIN; points.len()];
        for (source, images) in points.chunks(block).zip(images.chunks_mut(block)) {
            map.points(source, images);
        }
        map.check()?;
        // SAFETY: the header requires that the numbers may be written to; `from`, which may be the same array, is not used any more.
        let to = unsafe { array_mut(to, numbers, "to")? };
        for (out, p) in to.as_chunks_mut::<2>().0.iter_mut().zip(images) {
            *out = [p.x, p.y];
        }
        Ok(())
    };
    // SAFETY: the header requires that `error` may be written to.
    unsafe { status(error, map) }
}

/// Bends path data.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pathwarp_warp_path(
    warper: *const PathwarpWarper,
    data: *const c_char,
    result: *mut *mut c_char,
    max_error: *mut f64,
    error: *mut *mut c_char,
) -> i32 {
    let warp = || {
        check_not_null(result, "result")?;
        // SAFETY: the header requires a warper and a text.
        let (warper, data) = unsafe { (value(warper, "warper")?, text(data, "data")?) };
        let warped = warper.run(|warper| warper.warp_path(data))?.path;
        // SAFETY: the header requires that both may be written to; `max_error` may be null.
        unsafe {
            put(result, owned_text(&warped.data));
            put(max_error, warped.report.max_error);
        }
        Ok(())
    };
    // SAFETY: the header requires that `error` may be written to.
    unsafe { status(error, warp) }
}

/// Warps a drawing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pathwarp_warp_drawing(
    warper: *const PathwarpWarper,
    bytes: *const u8,
    length: usize,
    name: *const c_char,
    result: *mut *mut u8,
    result_length: *mut usize,
    report: *mut *mut c_char,
    warnings: *mut *mut *mut c_char,
    warning_count: *mut usize,
    error: *mut *mut c_char,
) -> i32 {
    let warp = || {
        check_not_null(result, "result")?;
        check_not_null(result_length, "result_length")?;
        if !warnings.is_null() {
            check_not_null(warning_count, "warning_count")?;
        }
        // SAFETY: the header requires a warper and these bytes.
        let (warper, bytes) = unsafe { (value(warper, "warper")?, array(bytes, length, "bytes")?) };
        // SAFETY: the header requires NULL or a text.
        let name = if name.is_null() { None } else { Some(Path::new(unsafe { text(name, "name")? })) };
        let warped = warper.run(|warper| warper.warp_drawing(bytes, name))?;
        let (first, count) = owned_array(warped.bytes.into_boxed_slice());
        // SAFETY: the header requires that all may be written to; `report` and `warnings` may be null.
        unsafe {
            put(result, first);
            put(result_length, count);
            if !report.is_null() {
                put(report, owned_text(&warped.report));
            }
            if !warnings.is_null() {
                let (texts, count) = owned_array(warped.warnings.iter().map(|w| owned_text(w)).collect());
                put(warnings, texts);
                put(warning_count, count);
            }
        }
        Ok(())
    };
    // SAFETY: the header requires that `error` may be written to.
    unsafe { status(error, warp) }
}

/// Sets words as a drawing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pathwarp_text(
    words: *const c_char,
    font: *const c_char,
    size: f64,
    result: *mut *mut u8,
    result_length: *mut usize,
    error: *mut *mut c_char,
) -> i32 {
    let set = || {
        check_not_null(result, "result")?;
        check_not_null(result_length, "result_length")?;
        // SAFETY: the header requires texts; `font` may be null.
        let (words, font) =
            unsafe { (text(words, "words")?, if font.is_null() { None } else { Some(text(font, "font")?) }) };
        let drawing = pathwarp_engine::lettering_drawing(words, font, size)?;
        let (first, count) = owned_array(drawing.into_bytes().into_boxed_slice());
        // SAFETY: the header requires that both may be written to.
        unsafe {
            put(result, first);
            put(result_length, count);
        }
        Ok(())
    };
    // SAFETY: the header requires that `error` may be written to.
    unsafe { status(error, set) }
}

/// Releases a warper.
///
/// # Safety
/// It is null, or a warper that was not released.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pathwarp_free(warper: *mut PathwarpWarper) {
    if !warper.is_null() {
        // SAFETY: it came from `Box::into_raw`, and the caller gives it up.
        drop(unsafe { Box::from_raw(warper) });
    }
}

/// Releases a text.
///
/// # Safety
/// It is null, or a text of this library that was not released.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pathwarp_string_free(text: *mut c_char) {
    // SAFETY: the caller guarantees it.
    unsafe { drop_text(text) };
}

/// Releases a list of texts.
///
/// # Safety
/// It is null, or a list of this library with this count that was not released.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pathwarp_strings_free(texts: *mut *mut c_char, count: usize) {
    // SAFETY: the caller guarantees it, and each text came from `owned_text`.
    unsafe { take_back_array(texts, count).into_iter().for_each(|text| drop_text(text)) };
}

/// Releases bytes.
///
/// # Safety
/// They are null, or bytes of this library with this length that were not released.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pathwarp_bytes_free(bytes: *mut u8, length: usize) {
    // SAFETY: the caller guarantees it.
    drop(unsafe { take_back_array(bytes, length) });
}
