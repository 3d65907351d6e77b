//! Typed access to parameter values in space: lengths, points and boxes.

use glam::DVec3;
use pathwarp::Error;
use pathwarp::kurbo::Rect;
use pathwarp::param::{Args, Axis, Frame, Length, LengthUnit, NamedText, Param, Settings};

/// Millimetres per px.
const MM_PER_PX: f64 = 25.4 / 96.0;

/// The length to which a percentage refers: the frame's size along an axis, or its diagonal.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Extent {
    /// The width.
    X,
    /// The height.
    Y,
    /// The depth.
    Z,
    /// The diagonal.
    Diagonal,
}

/// The box to which percentages refer, and the size of a unit of length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame3 {
    /// The box, usually the model's.
    pub bounds: Box3,
    /// Units of the model per millimetre: 1, as 3D printing software assumes, unless the file format defines another unit.
    pub units_per_mm: f64,
}

impl Frame3 {
    /// Makes a frame in which a unit is a millimetre.
    #[must_use]
    pub fn new(bounds: Box3) -> Self {
        Self { bounds, units_per_mm: 1.0 }
    }

    /// Returns the front of the box as a frame in the plane, for values that have no third dimension.
    #[must_use]
    pub fn front(&self) -> Frame {
        let Box3 { min, max } = self.bounds;
        let units_per_px = self.units_per_mm * MM_PER_PX;
        Frame::new(Rect::new(min.x, min.y, max.x, max.y)).with_units_per_px([units_per_px; 2])
    }

    fn extent(&self, along: Extent) -> f64 {
        let size = self.bounds.size();
        match along {
            Extent::X => size.x,
            Extent::Y => size.y,
            Extent::Z => size.z,
            Extent::Diagonal => size.length(),
        }
    }
}

/// The parameter values from which a deformation of space is built.
#[derive(Debug, Clone, Copy)]
pub struct Settings3<'a> {
    flat: Settings<'a>,
    frame: &'a Frame3,
}

impl<'a> Settings3<'a> {
    /// Checks `args` against the parameter table. `front` is [`Frame3::front`] of `frame`.
    ///
    /// # Errors
    /// [`Error::Usage`] or [`Error::Missing`], naming the parameter.
    pub fn new(params: &'a [Param], args: &'a Args, frame: &'a Frame3, front: &'a Frame) -> Result<Self, Error> {
        Ok(Self { flat: Settings::new(params, args, front)?, frame })
    }

    /// Returns the settings of the plane, for values without a third dimension: flags, numbers, angles, words, texts and files.
    #[must_use]
    pub fn flat(&self) -> &Settings<'a> {
        &self.flat
    }

    /// Returns the box to which percentages refer.
    #[must_use]
    pub fn bounds(&self) -> Box3 {
        self.frame.bounds
    }

    /// Returns the last value given for a text parameter, or its default.
    #[must_use]
    pub fn last(&self, name: &str) -> Option<&'a str> {
        self.flat.texts(name).last().copied()
    }

    /// Returns the words of all values of a text parameter, split at white space.
    #[must_use]
    pub fn words(&self, name: &str) -> Vec<&'a str> {
        self.flat.texts(name).into_iter().flat_map(str::split_whitespace).collect()
    }

    /// Reads a length from a text parameter, in units of the model.
    ///
    /// # Errors
    /// [`Error::Usage`], naming the parameter, when `text` is not a length.
    pub fn length_in(&self, name: &str, text: &str, along: Extent) -> Result<f64, Error> {
        let length: Length = text.trim().parse().map_err(|e| Error::usage(name, text, format!("{e}")))?;
        if length.unit == LengthUnit::Percent {
            return Ok(length.value / 100.0 * self.frame.extent(along));
        }
        // The axis matters to percentages only.
        Ok(length.in_units(Axis::X, &self.frame.front()))
    }

    /// Reads a vector `dx,dy,dz` of lengths from a text parameter.
    ///
    /// # Errors
    /// [`Error::Usage`], naming the parameter, when `text` is not three lengths.
    pub fn vector_in(&self, name: &str, text: &str) -> Result<DVec3, Error> {
        let parts: Vec<&str> = text.split(',').collect();
        let [x, y, z] = parts[..] else {
            return Err(Error::usage(name, text, "is not three lengths x,y,z"));
        };
        let length = |text: &str, along| self.length_in(name, text, along);
        Ok(DVec3::new(length(x, Extent::X)?, length(y, Extent::Y)?, length(z, Extent::Z)?))
    }

    /// Reads a point `x,y,z` from a text parameter. Percentages count from the left, bottom and back of the frame.
    ///
    /// # Errors
    /// [`Error::Usage`], naming the parameter, when `text` is not a point.
    pub fn point_in(&self, name: &str, text: &str) -> Result<DVec3, Error> {
        let mut p = self.vector_in(name, text)?.to_array();
        for ((v, word), origin) in p.iter_mut().zip(text.split(',')).zip(self.frame.bounds.min.to_array()) {
            if word.trim().ends_with('%') {
                *v += origin;
            }
        }
        Ok(DVec3::from_array(p))
    }

    /// Returns the point given for a text parameter, or `None` if there is neither a value nor a default.
    ///
    /// # Errors
    /// [`Error::Usage`], naming the parameter, when the value is not a point.
    pub fn point_if(&self, name: &str) -> Result<Option<DVec3>, Error> {
        self.last(name).map(|t| self.point_in(name, t)).transpose()
    }

    /// Returns the points given for a text parameter, separated by spaces or semicolons.
    pub(crate) fn listed_points(&self, name: &str) -> Result<Vec<DVec3>, Error> {
        let words = self.words(name).into_iter().flat_map(|w| w.split(';')).filter(|w| !w.is_empty());
        words.map(|w| self.point_in(name, w)).collect()
    }

    /// Returns the points `x,y,z x,y,z …` given for a text parameter.
    ///
    /// # Errors
    /// [`Error::Usage`], naming the parameter, when a word is not a point.
    pub fn points(&self, name: &str) -> Result<Vec<DVec3>, Error> {
        self.words(name).into_iter().map(|w| self.point_in(name, w)).collect()
    }

    /// Returns the pairs of points `x,y,z:x,y,z …` given for a text parameter.
    ///
    /// # Errors
    /// [`Error::Usage`], naming the parameter, when a word is not a pair of points.
    pub fn point_pairs(&self, name: &str) -> Result<Vec<(DVec3, DVec3)>, Error> {
        let pair = |word: &str| {
            let wrong = || Error::usage(name, word, "is not FROM:TO, such as 10,20,5:15,25,5");
            let (from, to) = word.split_once(':').ok_or_else(wrong)?;
            Ok((self.point_in(name, from)?, self.point_in(name, to)?))
        };
        self.words(name).into_iter().map(pair).collect()
    }

    /// Returns the box given for a text parameter as `x,y,z,w,h,d`. `None` if it is not given, or is the word `model`, meaning the frame.
    ///
    /// # Errors
    /// [`Error::Usage`], naming the parameter, when the value is not a box with a volume.
    pub fn box_if(&self, name: &str) -> Result<Option<Box3>, Error> {
        let Some(text) = self.last(name).filter(|t| *t != "model") else { return Ok(None) };
        let words: Vec<&str> = text.split(',').collect();
        let wrong = || Error::usage(name, text, "is neither a box x,y,z,w,h,d with positive sizes nor the word model");
        if words.len() != 6 {
            return Err(wrong());
        }
        let min = self.point_in(name, &words[..3].join(","))?;
        let size = self.vector_in(name, &words[3..].join(","))?;
        if size.min_element() > 0.0 { Ok(Some(Box3 { min, max: min + size })) } else { Err(wrong()) }
    }

    /// Returns three whole numbers from 1 to `max`, such as `4x3x2`; one number stands for all three. `None` if not given.
    ///
    /// # Errors
    /// [`Error::Usage`], naming the parameter, when the value is anything else.
    pub fn counts_if(&self, name: &str, max: usize) -> Result<Option<[usize; 3]>, Error> {
        let Some(text) = self.last(name) else { return Ok(None) };
        let number = |t: &str| t.trim().parse::<usize>().ok().filter(|n| (1..=max).contains(n));
        let numbers: Option<Vec<usize>> = text.split(['x', 'X', '×']).map(number).collect();
        match numbers.as_deref() {
            Some([n]) => Ok(Some([*n; 3])),
            Some([a, b, c]) => Ok(Some([*a, *b, *c])),
            _ => Err(Error::usage(name, text, format!("is not three numbers from 1 to {max}, such as 3x2x2"))),
        }
    }

    /// Returns the contents of the file named by a parameter.
    ///
    /// # Errors
    /// [`Error::Input`] when the file has not been read.
    pub fn file_if(&self, name: &str) -> Result<Option<&'a NamedText>, Error> {
        self.flat.file_if(name)
    }
}

/// Formats a point for messages, to six decimals.
pub(crate) fn show(p: DVec3) -> String {
    let round = |v: f64| pathwarp::engine::decimal::trimmed(v, 6);
    format!("{},{},{}", round(p.x), round(p.y), round(p.z))
}

/// Iterates over the numbers i, j, k of a grid of this size, with i running fastest.
pub(crate) fn grid([nx, ny, nz]: [usize; 3]) -> impl Iterator<Item = [usize; 3]> {
    (0..nz).flat_map(move |k| (0..ny).flat_map(move |j| (0..nx).map(move |i| [i, j, k])))
}

/// A box with edges along the axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Box3 {
    /// The corner at the left, bottom and back.
    pub min: DVec3,
    /// The corner at the right, top and front.
    pub max: DVec3,
}

impl Box3 {
    /// Returns the smallest box around two points.
    #[must_use]
    pub fn new(a: DVec3, b: DVec3) -> Self {
        Self { min: a.min(b), max: a.max(b) }
    }

    /// Returns the smallest box around the finite points among `points`, or `None` if there are none.
    #[must_use]
    pub fn around(points: impl IntoIterator<Item = DVec3>) -> Option<Self> {
        let finite = points.into_iter().filter(|p| p.is_finite());
        finite.map(|p| Self { min: p, max: p }).reduce(|a, b| Self { min: a.min.min(b.min), max: a.max.max(b.max) })
    }

    /// Returns width, height and depth.
    #[must_use]
    pub fn size(&self) -> DVec3 {
        self.max - self.min
    }

    /// Returns the centre.
    #[must_use]
    pub fn center(&self) -> DVec3 {
        0.5 * (self.min + self.max)
    }

    /// Returns the length of the diagonal.
    #[must_use]
    pub fn diagonal(&self) -> f64 {
        self.size().length()
    }

    /// Returns `true` if `p` is inside or on the boundary.
    #[must_use]
    pub fn contains(&self, p: DVec3) -> bool {
        p.cmpge(self.min).all() && p.cmple(self.max).all()
    }

    /// Returns the box with every face moved outwards by `by`.
    #[must_use]
    pub fn inflate(&self, by: DVec3) -> Self {
        Self { min: self.min - by, max: self.max + by }
    }

    /// Returns the eight corners; x changes fastest.
    #[must_use]
    pub fn corners(&self) -> [DVec3; 8] {
        let coordinate = |i: usize, axis: usize| if (i >> axis) & 1 == 0 { self.min[axis] } else { self.max[axis] };
        std::array::from_fn(|i| DVec3::from_array([0, 1, 2].map(|axis| coordinate(i, axis))))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_lengths_and_boxes() {
        const PARAMS: [Param; 1] = [Param::new("region", pathwarp::param::Kind::Text("B"), "A box.")];
        let frame = Frame3 {
            bounds: Box3::new(DVec3::new(10.0, 20.0, 30.0), DVec3::new(20.0, 40.0, 34.0)),
            units_per_mm: 0.001,
        };
        let (args, front) = (Args::from_pairs(&[("region", "50%,1,0%,10mm,50%,25%")]), frame.front());
        let s = Settings3::new(&PARAMS, &args, &frame, &front).unwrap();
        let b = s.box_if("region").unwrap().unwrap();
        assert!((b.min - DVec3::new(15.0, 1.0, 30.0)).length() < 1e-12, "{b:?}");
        assert!((b.size() - DVec3::new(0.01, 10.0, 1.0)).length() < 1e-12, "{b:?}");
        assert!(s.point_in("region", "1,2").is_err() && s.vector_in("region", "1,2,x").is_err());
        assert_eq!(s.vector_in("region", "1,-50%,100%").unwrap(), DVec3::new(1.0, -10.0, 4.0));
    }
}
