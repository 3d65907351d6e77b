//! Typed, range-checked access to what was typed.

use super::{Args, Axis, Frame, Kind, NamedPath, NamedText, Param, args, unit};
use crate::error::Error;
use crate::outline::Outline;
use kurbo::{Point, Rect};

/// A deformation's parameters with their values: what [`build`](crate::deform::Deformation::build) reads.
#[derive(Debug, Clone, Copy)]
pub struct Settings<'a> {
    params: &'a [Param],
    args: &'a Args,
    frame: &'a Frame,
}

impl<'a> Settings<'a> {
    /// Checks that `args` has only known names, flags without values, and every needed one.
    ///
    /// # Errors
    /// [`Error::Usage`] or [`Error::Missing`], naming the parameter.
    pub fn new(params: &'a [Param], args: &'a Args, frame: &'a Frame) -> Result<Self, Error> {
        for (name, values) in args.iter() {
            let Some(p) = params.iter().find(|p| p.name == name) else {
                let known: Vec<_> = params.iter().map(|p| p.name).collect();
                return Err(Error::usage(
                    name,
                    values.join(" "),
                    format!("is not known here; known are {}", known.join(", ")),
                ));
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
        Ok(Self { params, args, frame })
    }

    /// The box that gives `%` a meaning.
    #[must_use]
    pub fn frame(&self) -> &'a Frame {
        self.frame
    }

    /// Whether the user gave `name` (a default does not count).
    #[must_use]
    pub fn given(&self, name: &str) -> bool {
        !self.args.get(name).is_empty()
    }

    /// Whether a flag is set.
    ///
    /// # Errors
    /// The value is something else than true or false.
    pub fn flag(&self, name: &str) -> Result<bool, Error> {
        match self.text(name).map(|(t, _)| t) {
            None | Some("false") => Ok(false),
            Some("true") => Ok(true),
            Some(other) => Err(Error::usage(name, other, "is a switch: true or false")),
        }
    }

    /// A number, whole number, length (user units) or angle (degrees), by the parameter's kind.
    ///
    /// # Errors
    /// Not of its kind, out of range, or neither given nor defaulted.
    pub fn number(&self, name: &str) -> Result<f64, Error> {
        self.number_if(name)?.ok_or_else(|| self.missing(name))
    }

    /// The same for a parameter that may stay away.
    ///
    /// # Errors
    /// Not of its kind, or out of range.
    pub fn number_if(&self, name: &str) -> Result<Option<f64>, Error> {
        let Some((text, param)) = self.text(name) else { return Ok(None) };
        let value = match param.kind {
            Kind::Count => unit::count(text),
            Kind::Length(axis) => unit::length(text, axis, self.frame),
            Kind::Angle => unit::angle(text),
            _ => unit::number(text),
        };
        let value = value.map_err(|e| Error::usage(name, text, e))?;
        let (least, most) = param.range;
        if value < least || value > most {
            return Err(Error::usage(name, text, format!("is out of range: {least} to {most}")));
        }
        Ok(Some(value))
    }

    /// A fixed number of numbers.
    ///
    /// # Errors
    /// Not numbers, or not as many as wanted.
    pub fn numbers_if(&self, name: &str) -> Result<Option<Vec<f64>>, Error> {
        let Some((text, param)) = self.text(name) else { return Ok(None) };
        let wanted = if let Kind::Numbers(n) = param.kind { n } else { 1 };
        unit::numbers(text, wanted).map(Some).map_err(|e| Error::usage(name, text, e))
    }

    /// A place.
    ///
    /// # Errors
    /// Not `x,y`, or neither given nor defaulted.
    pub fn point(&self, name: &str) -> Result<Point, Error> {
        let (text, _) = self.text(name).ok_or_else(|| self.missing(name))?;
        unit::point(text, self.frame).map_err(|e| Error::usage(name, text, e))
    }

    /// The word chosen.
    ///
    /// # Errors
    /// Not one of the words, or neither given nor defaulted.
    pub fn choice(&self, name: &str) -> Result<&'static str, Error> {
        let (text, param) = self.text(name).ok_or_else(|| self.missing(name))?;
        let words = if let Kind::Choice(words) = param.kind { words } else { &[] };
        words
            .iter()
            .find(|w| **w == text)
            .copied()
            .ok_or_else(|| Error::usage(name, text, format!("is not one of {}", words.join(", "))))
    }

    /// The values of a text parameter, in the order they were typed; the default if none was.
    #[must_use]
    pub fn texts(&self, name: &str) -> Vec<&'a str> {
        let typed = self.args.get(name);
        if typed.is_empty() {
            return self.param(name).and_then(|p| p.default).into_iter().collect();
        }
        typed.iter().map(String::as_str).collect()
    }

    /// A length within a text parameter, in user units: for deformations that read their own notation.
    ///
    /// # Errors
    /// Not a length; the message names the parameter.
    pub fn length_in(&self, name: &str, text: &str, axis: Axis) -> Result<f64, Error> {
        unit::length(text, axis, self.frame).map_err(|e| Error::usage(name, text, e))
    }

    /// An angle within a text parameter, in degrees.
    ///
    /// # Errors
    /// Not an angle; the message names the parameter.
    pub fn angle_in(&self, name: &str, text: &str) -> Result<f64, Error> {
        unit::angle(text).map_err(|e| Error::usage(name, text, e))
    }

    /// A plain number or a percentage within a text parameter.
    ///
    /// # Errors
    /// Not a number; the message names the parameter.
    pub fn number_in(&self, name: &str, text: &str) -> Result<f64, Error> {
        unit::number(text).map_err(|e| Error::usage(name, text, e))
    }

    /// A control point's number and what follows: `I,J:REST` or `I,J,K:REST`.
    ///
    /// # Errors
    /// Not of that form, or not `N` whole numbers; the message names the parameter.
    pub fn node_in<'t, const N: usize>(&self, name: &str, text: &'t str) -> Result<([usize; N], &'t str), Error> {
        let wrong = || {
            let node = ["I", "J", "K"][..N.min(3)].join(",");
            Error::usage(name, text, format!("does not begin with a control point's number and a colon, {node}:"))
        };
        let (node, rest) = text.split_once(':').ok_or_else(wrong)?;
        let numbers: Option<Vec<usize>> = node.split(',').map(|n| n.trim().parse().ok()).collect();
        let node = numbers.and_then(|n| <[usize; N]>::try_from(n).ok()).ok_or_else(wrong)?;
        Ok((node, rest.trim()))
    }

    /// A place within a text parameter, percentages from the frame's left and top.
    ///
    /// # Errors
    /// Not a place; the message names the parameter.
    pub fn point_in(&self, name: &str, text: &str) -> Result<Point, Error> {
        unit::point(text, self.frame).map_err(|e| Error::usage(name, text, e))
    }

    /// Plain points `x,y x,y …` within a text parameter, percentages from the frame's left and top.
    ///
    /// # Errors
    /// Not points; the message names the parameter.
    pub fn points_in(&self, name: &str, text: &str) -> Result<Vec<Point>, Error> {
        unit::points(text, self.frame).map_err(|e| Error::usage(name, text, e))
    }

    /// The box that a text parameter gives: `artwork` (the frame) or `x,y,w,h`, percentages of the frame; `None` if it is the
    /// frame or not given.
    ///
    /// # Errors
    /// Not a box, or one without area; the message names the parameter.
    pub fn rect_if(&self, name: &str) -> Result<Option<Rect>, Error> {
        let Some((text, _)) = self.text(name).filter(|(t, _)| *t != "artwork") else { return Ok(None) };
        unit::rect(text, self.frame).map(Some).map_err(|e| Error::usage(name, text, e))
    }

    /// The file that a parameter of kind [`Kind::File`] or [`Kind::NameOrFile`] names, already read; `None` if a name was given
    /// instead.
    ///
    /// # Errors
    /// It was named but not read: [`Args::resolve_files`] was not called.
    pub fn file_if(&self, name: &str) -> Result<Option<&'a NamedText>, Error> {
        let Some((file, _)) = self.text(name).filter(|(t, p)| p.reads_file(t)) else { return Ok(None) };
        let unread = || Error::input(file, "cannot be read here");
        self.args.file(file).map(Some).ok_or_else(unread)
    }

    /// The path referred to, if given.
    ///
    /// # Errors
    /// The reference's text is not a path.
    pub fn path_if(&self, name: &str) -> Result<Option<NamedPath>, Error> {
        Ok(self.paths(name)?.pop())
    }

    /// All paths referred to by a parameter that may be given several times.
    ///
    /// # Errors
    /// A reference's text is not a path.
    pub fn paths(&self, name: &str) -> Result<Vec<NamedPath>, Error> {
        let typed = self.args.get(name);
        let default = self.param(name).and_then(|p| p.default).map(str::to_owned);
        let texts: Vec<&String> = if typed.is_empty() { default.iter().collect() } else { typed.iter().collect() };
        texts.into_iter().map(|t| self.path_from(name, t)).collect()
    }

    fn path_from(&self, name: &str, text: &str) -> Result<NamedPath, Error> {
        if let Some(p) = self.args.looked_up(text) {
            return Ok(NamedPath { name: format!("{name} {}", p.name), outline: p.outline.clone() });
        }
        let outline = if args::is_path_data(text) {
            Outline::from_svg(text).map_err(|e| Error::usage(name, text, format!("is not sound path data: {e}")))?
        } else {
            let points = unit::points(text, self.frame)
                .map_err(|e| Error::usage(name, text, format!("is neither path data nor points: it {e}")))?;
            Outline::from_points(&points, false)
        };
        if let Some(bad) = outline.segs().find(|s| !s.is_finite()) {
            return Err(crate::error::GeometryError::NotFinite { shape: name.to_owned(), at: bad.start() }.into());
        }
        Ok(NamedPath { name: name.to_owned(), outline })
    }

    fn param(&self, name: &str) -> Option<&'a Param> {
        self.params.iter().find(|p| p.name == name)
    }

    /// The text typed, or the default.
    fn text(&self, name: &str) -> Option<(&'a str, &'a Param)> {
        let param = self.param(name)?;
        let typed = self.args.get(name).last().map(String::as_str);
        typed.or(param.default).map(|t| (t, param))
    }

    fn missing(&self, name: &str) -> Error {
        let hint = self.param(name).map_or("no such parameter", |p| p.help);
        Error::missing(name, hint)
    }
}
