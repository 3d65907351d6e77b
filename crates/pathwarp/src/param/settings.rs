//! Typed and range-checked access to the values of parameters.

use super::value::{self, ValueError};
use super::{Args, Axis, Frame, Kind, NamedPath, NamedText, Param, circle, is_path_data, shape};
use crate::error::{Error, GeometryError};
use crate::outline::Outline;
use kurbo::{Point, Rect};

/// A number out of range that is at least this large may be meant as a percentage.
const LIKELY_PERCENT: f64 = 5.0;

/// The parameters of a deformation with their values and the frame, from which it is built.
#[derive(Debug, Clone, Copy)]
pub struct Settings<'a> {
    params: &'a [Param],
    args: &'a Args,
    frame: &'a Frame,
    /// `true` if ranges are not checked.
    any_range: bool,
}

impl<'a> Settings<'a> {
    /// Creates settings after a check of the names in `args`.
    ///
    /// # Errors
    /// [`Error::Usage`] for an unknown parameter or one given too often, [`Error::Missing`] without a required one.
    pub fn new(params: &'a [Param], args: &'a Args, frame: &'a Frame) -> Result<Self, Error> {
        for (name, values) in args.iter() {
            let Some(p) = params.iter().find(|p| p.name == name) else {
                let known: Vec<_> = params.iter().map(|p| p.name).collect();
                let problem = format!("is not a parameter of this deformation, which has {}", known.join(", "));
                return Err(Error::usage(name, values.join(" "), problem));
            };
            if values.len() > 1 && !p.repeat {
                return Err(Error::usage(name, values.join(" "), "is given more than once"));
            }
        }
        for p in params {
            if p.needed && args.get(p.name).is_empty() {
                return Err(Error::missing(p.name, p.help));
            }
        }
        Ok(Self { params, args, frame, any_range: false })
    }

    /// Checks the values that do not depend on the artwork: numbers, counts, angles, points, words and switches, and the notation of
    /// lengths.
    ///
    /// # Errors
    /// [`Error::Usage`] for a value that is not of its kind or out of range.
    pub fn check_values(&self) -> Result<(), Error> {
        for (name, values) in self.args.iter() {
            let kind = self.params.iter().find(|p| p.name == name).map(|p| p.kind);
            for value in values {
                let one = Args::from_pairs(&[(name, value.as_str())]);
                let any_range = matches!(kind, Some(Kind::Length(_)));
                let alone = Settings { params: self.params, args: &one, frame: self.frame, any_range };
                match kind {
                    Some(Kind::Flag) => drop(alone.flag(name)?),
                    Some(Kind::Number | Kind::Count | Kind::Angle | Kind::Length(_)) => drop(alone.number_if(name)?),
                    Some(Kind::Numbers(_)) => drop(alone.numbers_if(name)?),
                    Some(Kind::Point) => drop(alone.point(name)?),
                    Some(Kind::Choice(_)) => drop(alone.choice(name)?),
                    _ => {}
                }
            }
        }
        Ok(())
    }

    /// Creates settings with the defaults alone; `args` must be empty. Ranges are not checked, as lengths may exceed them in this frame.
    pub(crate) fn defaults(params: &'a [Param], args: &'a Args, frame: &'a Frame) -> Self {
        Self { params, args, frame, any_range: true }
    }

    /// Returns the box to which percentages refer.
    #[must_use]
    pub fn frame(&self) -> &'a Frame {
        self.frame
    }

    /// Returns `true` if a value was given for `name`. A default does not count.
    #[must_use]
    pub fn given(&self, name: &str) -> bool {
        !self.args.get(name).is_empty()
    }

    /// Returns `true` if a flag is set.
    ///
    /// # Errors
    /// [`Error::Usage`] when the value is neither true nor false.
    pub fn flag(&self, name: &str) -> Result<bool, Error> {
        match self.text(name).map(|(t, _)| t) {
            None | Some("false") => Ok(false),
            Some("true") => Ok(true),
            Some(other) => Err(Error::usage(name, other, "is not true or false")),
        }
    }

    /// Returns a number, integer, length (in user units) or angle (in degrees), according to the parameter's kind.
    ///
    /// # Errors
    /// [`Error::Usage`] when the value is not of its kind or out of range, [`Error::Missing`] with neither a value nor a default.
    pub fn number(&self, name: &str) -> Result<f64, Error> {
        self.number_if(name)?.ok_or_else(|| self.missing(name))
    }

    /// Returns the number, integer, length or angle of an optional parameter.
    ///
    /// # Errors
    /// [`Error::Usage`] when the value is not of its kind or out of range.
    pub fn number_if(&self, name: &str) -> Result<Option<f64>, Error> {
        let Some((text, param)) = self.text(name) else { return Ok(None) };
        let value = match param.kind {
            Kind::Count => value::count(text),
            Kind::Length(axis) => value::length(text, axis, self.frame),
            Kind::Angle => value::angle(text),
            _ => value::number(text),
        };
        let value = value.map_err(|e| usage(name, text, &e))?;
        let (min, max) = param.range;
        if !self.any_range && (value < min || value > max) {
            let may_be_percent = param.kind == Kind::Number && !text.contains('%') && value.abs() >= LIKELY_PERCENT;
            let is_percent = may_be_percent && (min..=max).contains(&(value / 100.0));
            let advice = if is_percent { format!("; for {text} per cent write {text}%") } else { String::new() };
            return Err(Error::usage(name, text, format!("is out of range: {min} to {max}{advice}")));
        }
        Ok(Some(value))
    }

    /// Returns the list of numbers of an optional parameter, as many as its kind has.
    ///
    /// # Errors
    /// [`Error::Usage`] when the value is not a list of that many numbers.
    pub fn numbers_if(&self, name: &str) -> Result<Option<Vec<f64>>, Error> {
        let Some((text, param)) = self.text(name) else { return Ok(None) };
        let expected = if let Kind::Numbers(n) = param.kind { n } else { 1 };
        value::numbers(text, expected).map(Some).map_err(|e| usage(name, text, &e))
    }

    /// Returns a point.
    ///
    /// # Errors
    /// [`Error::Usage`] when the value is not `x,y`, [`Error::Missing`] with neither a value nor a default.
    pub fn point(&self, name: &str) -> Result<Point, Error> {
        let (text, _) = self.text(name).ok_or_else(|| self.missing(name))?;
        value::point(text, self.frame).map_err(|e| usage(name, text, &e))
    }

    /// Returns the chosen word.
    ///
    /// # Errors
    /// [`Error::Usage`] when the value is not one of the words, [`Error::Missing`] with neither a value nor a default.
    pub fn choice(&self, name: &str) -> Result<&'static str, Error> {
        let (text, param) = self.text(name).ok_or_else(|| self.missing(name))?;
        let words = if let Kind::Choice(words) = param.kind { words } else { &[] };
        let unknown = || Error::usage(name, text, format!("is not one of {}", words.join(", ")));
        words.iter().find(|w| **w == text).copied().ok_or_else(unknown)
    }

    /// Returns the values of a text parameter in the order given, or the default.
    #[must_use]
    pub fn texts(&self, name: &str) -> Vec<&'a str> {
        let typed = self.args.get(name).iter().map(String::as_str);
        let default = self.param(name).and_then(|p| p.default).filter(|_| !self.given(name));
        typed.chain(default).collect()
    }

    /// Reads a length in the text of parameter `name`, in user units.
    ///
    /// # Errors
    /// [`Error::Usage`] when `text` is not a length.
    pub fn length_in(&self, name: &str, text: &str, axis: Axis) -> Result<f64, Error> {
        value::length(text, axis, self.frame).map_err(|e| usage(name, text, &e))
    }

    /// Reads an angle in the text of parameter `name`, in degrees.
    ///
    /// # Errors
    /// [`Error::Usage`] when `text` is not an angle.
    pub fn angle_in(&self, name: &str, text: &str) -> Result<f64, Error> {
        value::angle(text).map_err(|e| usage(name, text, &e))
    }

    /// Reads a plain number or a percentage in the text of parameter `name`.
    ///
    /// # Errors
    /// [`Error::Usage`] when `text` is not a number.
    pub fn number_in(&self, name: &str, text: &str) -> Result<f64, Error> {
        value::number(text).map_err(|e| usage(name, text, &e))
    }

    /// Reads the indices of a control point, and returns them with the text after them: `I,J:REST` or `I,J,K:REST`.
    ///
    /// # Errors
    /// [`Error::Usage`] when `text` does not have this form with `N` integers.
    pub fn node_in<'t, const N: usize>(&self, name: &str, text: &'t str) -> Result<([usize; N], &'t str), Error> {
        let wrong = || {
            let node = ["I", "J", "K"][..N.min(3)].join(",");
            Error::usage(name, text, format!("does not begin with the indices of a control point and a colon, {node}:"))
        };
        let (node, rest) = text.split_once(':').ok_or_else(wrong)?;
        let numbers: Option<Vec<usize>> = node.split(',').map(|n| n.trim().parse().ok()).collect();
        let node = numbers.and_then(|n| <[usize; N]>::try_from(n).ok()).ok_or_else(wrong)?;
        Ok((node, rest.trim()))
    }

    /// Reads a point in the text of parameter `name`. Percentages count from the left and top of the frame.
    ///
    /// # Errors
    /// [`Error::Usage`] when `text` is not a point.
    pub fn point_in(&self, name: &str, text: &str) -> Result<Point, Error> {
        value::point(text, self.frame).map_err(|e| usage(name, text, &e))
    }

    /// Reads points `x,y x,y …` in the text of parameter `name`. Percentages count from the left and top of the frame.
    ///
    /// # Errors
    /// [`Error::Usage`] when `text` is not a list of points.
    pub fn points_in(&self, name: &str, text: &str) -> Result<Vec<Point>, Error> {
        value::points(text, self.frame).map_err(|e| usage(name, text, &e))
    }

    /// Returns the box given by a text parameter: `artwork` (the frame), or `x,y,w,h` with percentages of the frame. `None` if it is
    /// the frame or not given.
    ///
    /// # Errors
    /// [`Error::Usage`] when the value is not a box, or has no area.
    pub fn rect_if(&self, name: &str) -> Result<Option<Rect>, Error> {
        let Some((text, _)) = self.text(name).filter(|(t, _)| *t != "artwork") else { return Ok(None) };
        value::rect(text, self.frame).map(Some).map_err(|e| usage(name, text, &e))
    }

    /// Returns the file, already read, that a parameter of kind [`Kind::File`] or [`Kind::NameOrFile`] names. `None` if it names none.
    ///
    /// # Errors
    /// [`Error::Input`] when the file was not read, because [`Args::resolve_files`] was not called.
    pub fn file_if(&self, name: &str) -> Result<Option<&'a NamedText>, Error> {
        let Some((file, _)) = self.text(name).filter(|(t, p)| p.reads_file(t)) else { return Ok(None) };
        let unread = || Error::input(file, "cannot be read here");
        self.args.files.get(file).map(Some).ok_or_else(unread)
    }

    /// Returns the path of an optional path parameter.
    ///
    /// # Errors
    /// [`Error::Usage`] when the value is not a path, [`Error::Geometry`] for a coordinate that is not finite.
    pub fn path_if(&self, name: &str) -> Result<Option<NamedPath>, Error> {
        Ok(self.paths(name)?.pop())
    }

    /// Returns all paths of a path parameter that may be repeated.
    ///
    /// # Errors
    /// [`Error::Usage`] when a value is not a path, [`Error::Geometry`] for a coordinate that is not finite.
    pub fn paths(&self, name: &str) -> Result<Vec<NamedPath>, Error> {
        self.texts(name).into_iter().map(|t| self.path_from(name, t)).collect()
    }

    /// Returns the path that was looked up for a reference, or reads an inline one.
    fn path_from(&self, name: &str, text: &str) -> Result<NamedPath, Error> {
        if let Some(known) = self.args.paths.get(text) {
            return Ok(NamedPath { name: format!("{name} {}", known.name), outline: known.outline.clone() });
        }
        let outline = if let Some(circle) = circle::circle(text, self.frame) {
            circle.map_err(|e| Error::usage(name, text, e))?
        } else if let Some(shape) = shape::shape(text, self.frame) {
            shape.map_err(|e| Error::usage(name, text, e))?
        } else if is_path_data(text) {
            Outline::from_svg(text).map_err(|e| Error::usage(name, text, format!("is not valid path data: {e}")))?
        } else {
            let points = value::points(text, self.frame)
                .map_err(|e| Error::usage(name, text, format!("is neither path data nor points: it {e}")))?;
            Outline::from_points(&points, false)
        };
        if let Some(bad) = outline.segs().find(|s| !s.is_finite()) {
            return Err(GeometryError::NotFinite { shape: name.to_owned(), at: bad.start() }.into());
        }
        Ok(NamedPath { name: name.to_owned(), outline })
    }

    /// Returns the parameter of this name.
    pub(super) fn param(&self, name: &str) -> Option<&'a Param> {
        self.params.iter().find(|p| p.name == name)
    }

    /// Returns the last value given, or the default, with the parameter.
    pub(super) fn text(&self, name: &str) -> Option<(&'a str, &'a Param)> {
        let param = self.param(name)?;
        let typed = self.args.get(name).last().map(String::as_str);
        typed.or(param.default).map(|t| (t, param))
    }

    /// Returns the error for a parameter that has no value.
    pub(super) fn missing(&self, name: &str) -> Error {
        Error::missing(name, self.param(name).map_or("no such parameter", |p| p.help))
    }
}

/// Returns the error for a value that does not parse.
fn usage(name: &str, text: &str, error: &ValueError) -> Error {
    Error::usage(name, text, error.to_string())
}
