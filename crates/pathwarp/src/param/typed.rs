//! Parameters as fields: one declaration gives the type of a deformation, its setters, defaults, ranges and table, and reads it from text.

use super::{Kind, NamedPath, Param, Settings};
use crate::error::{Error, check_range};
use kurbo::Point;

/// A value that a field of a deformation can hold.
pub(crate) trait Value: Sized {
    /// Reads the value of a parameter, or its default.
    fn read(s: &Settings<'_>, name: &str) -> Result<Self, Error>;

    /// Returns the number to which the parameter's range applies, if it has one.
    fn number(&self) -> Option<f64> {
        None
    }

    /// Refuses a number outside the parameter's range.
    fn check(&self, params: &[Param], name: &str) -> Result<(), Error> {
        let range = params.iter().find(|p| p.name == name).map(|p| p.range);
        match (self.number(), range) {
            (Some(number), Some((min, max))) => check_range(name, number, min, max).map(|_| ()),
            _ => Ok(()),
        }
    }
}

impl Value for f64 {
    fn read(s: &Settings<'_>, name: &str) -> Result<Self, Error> {
        s.number(name)
    }

    fn number(&self) -> Option<f64> {
        Some(*self)
    }
}

impl Value for usize {
    fn read(s: &Settings<'_>, name: &str) -> Result<Self, Error> {
        s.number(name).map(|n| n as Self)
    }

    fn number(&self) -> Option<f64> {
        Some(*self as f64)
    }
}

/// `true` for a flag, or for the second of two words.
impl Value for bool {
    fn read(s: &Settings<'_>, name: &str) -> Result<Self, Error> {
        match s.param(name).map(|p| p.kind) {
            Some(Kind::Choice(words)) => Ok(words.get(1) == Some(&s.choice(name)?)),
            _ => s.flag(name),
        }
    }
}

impl Value for Point {
    fn read(s: &Settings<'_>, name: &str) -> Result<Self, Error> {
        s.point(name)
    }
}

impl Value for NamedPath {
    fn read(s: &Settings<'_>, name: &str) -> Result<Self, Error> {
        s.path_if(name)?.ok_or_else(|| s.missing(name))
    }
}

/// `None` with neither a value nor a default.
impl<T: Value> Value for Option<T> {
    fn read(s: &Settings<'_>, name: &str) -> Result<Self, Error> {
        s.text(name).map(|_| T::read(s, name)).transpose()
    }

    fn number(&self) -> Option<f64> {
        self.as_ref().and_then(T::number)
    }
}

/// Declares a deformation with its parameters. Each has its help, which is also the setter's documentation, its field, and the
/// [`Param`] that describes it.
///
/// ```text
/// parameters! {
///     /// What the deformation does.
///     pub struct Wave(s) {
///         /// Distance of a crest from the middle.
///         height: f64 = length("height", Axis::Y).default("10%");
///         /// Move points across the wave (shear) or along it (push).
///         push: bool = either("kind", &["shear", "push"]);
///         /// The same as --kind push.
///         param = flag("along");
///         let frame: Rect = s.frame().rect;
///     }
/// }
/// ```
///
/// `Option` is for parameters that may have no value; a parameter without a type has no field. A field after `let` is no parameter, and
/// follows from the settings `s`. A field without a default is an argument: `pub struct Bend(s, along: NamedPath)`.
///
/// The type gets the table `PARAMS`, a setter for each parameter's field, `read(s, …)`, `defaults(frame, …)` without given values, and
/// `check()`, which refuses numbers out of range.
macro_rules! parameters {
    (
        $(#[$about:meta])*
        pub struct $type:ident($s:ident $(, $given:ident: $given_type:ty)*) {
            $(
                $(#[doc = $help:literal])+
                $field:ident $(: $value:ident $(<$inner:ident>)?)? = $kind:ident($name:literal $(, $kind_of:expr)*)
                    $(.$set:ident($($to:tt)*))*;
            )*
            $(let $derived:ident: $derived_type:ty = $follows:expr;)*
        }
    ) => {
        $(#[$about])*
        pub struct $type {
            $($($field: $value $(<$inner>)?,)?)*
            $($given: $given_type,)*
            $($derived: $derived_type,)*
        }

        impl $type {
            /// The table of parameters.
            const PARAMS: &'static [$crate::param::Param] = &[$(
                $crate::param::Param::$kind($name, $($kind_of,)* concat!($($help),+).trim_ascii_start())
                    $(.$set($($to)*))*
            ),*];

            $($crate::param::parameters! {
                @setter
                $(#[doc = $help])+
                #[doc = ""]
                #[doc = concat!($crate::param::parameters!(@unit $kind) $(, $crate::param::parameters!(@note $set $($to)*))*)]
                $name, $field $(: $value $(<$inner>)?)?
            })*

            /// Reads the values from settings.
            fn read($s: &$crate::param::Settings<'_> $(, $given: $given_type)*) -> Result<Self, $crate::Error> {
                Ok(Self {
                    $($($field: <$value $(<$inner>)? as $crate::param::Value>::read($s, $name)?,)?)*
                    $($derived: $follows,)*
                    $($given,)*
                })
            }

            /// The values if none are given. Reading them cannot fail: `check::entry` reads every default, and here no range is checked.
            fn defaults(frame: kurbo::Rect $(, $given: $given_type)*) -> Self {
                let (args, frame) = ($crate::param::Args::new(), $crate::param::Frame::new(frame));
                let settings = $crate::param::Settings::defaults(Self::PARAMS, &args, &frame);
                Self::read(&settings $(, $given)*).expect("defaults can be read")
            }

            /// Refuses numbers out of range.
            fn check(&self) -> Result<(), $crate::Error> {
                $($(<$value $(<$inner>)? as $crate::param::Value>::check(&self.$field, Self::PARAMS, $name)?;)?)*
                Ok(())
            }
        }
    };
    (@unit length) => { "User units; percentages are of the frame." };
    (@unit angle) => { "Degrees." };
    (@unit $kind:ident) => { "" };
    (@note default $default:literal) => { concat!(" Default: ", $default, ".") };
    (@note within $min:literal, $max:literal) => { concat!(" From ", stringify!($min), " to ", stringify!($max), ".") };
    (@note $set:ident $($to:tt)*) => { "" };
    (@setter $(#[$about:meta])* $name:literal, $field:ident) => {};
    (@setter $(#[$about:meta])* $name:literal, $field:ident: Point) => {
        $crate::setters! { $(#[$about])* $field($field: impl Into<Point>) => $field: $field.into(); }
    };
    (@setter $(#[$about:meta])* $name:literal, $field:ident: Option<Point>) => {
        $crate::setters! { $(#[$about])* $field($field: impl Into<Point>) => $field: Some($field.into()); }
    };
    (@setter $(#[$about:meta])* $name:literal, $field:ident: Option<NamedPath>) => {
        $crate::setters! {
            $(#[$about])*
            $field($field: &$crate::Outline) => $field: Some(NamedPath { name: $name.into(), outline: $field.clone() });
        }
    };
    (@setter $(#[$about:meta])* $name:literal, $field:ident: Option<$inner:ident>) => {
        $crate::setters! { $(#[$about])* $field($field: $inner) => $field: Some($field); }
    };
    (@setter $(#[$about:meta])* $name:literal, $field:ident: $value:ident) => {
        $crate::setters! { $(#[$about])* $field($field: $value); }
    };
}

/// An enum with a word for each variant.
pub(crate) trait Choice: Copy + PartialEq + 'static {
    /// The words.
    const WORDS: &'static [&'static str];
    /// The variants, in the words' order.
    const VARIANTS: &'static [Self];

    /// Returns the variant for a word.
    fn named(word: &str) -> Option<Self> {
        Self::WORDS.iter().position(|w| *w == word).map(|i| Self::VARIANTS[i])
    }

    /// Returns the word for this variant.
    fn name(self) -> &'static str {
        Self::WORDS.iter().zip(Self::VARIANTS).find(|(_, v)| **v == self).map_or("", |(word, _)| word)
    }
}

impl<T: Choice> Value for T {
    fn read(s: &Settings<'_>, name: &str) -> Result<Self, Error> {
        let word = s.choice(name)?;
        Self::named(word).ok_or_else(|| Error::usage(name, word, "is not known"))
    }
}

/// Declares an enum of [`Choice`]s, with a word after each variant.
macro_rules! choice {
    (
        $(#[$about:meta])*
        pub enum $type:ident { $($(#[$about_variant:meta])* $variant:ident = $word:literal,)+ }
    ) => {
        $(#[$about])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum $type { $($(#[$about_variant])* $variant,)+ }

        impl $crate::param::Choice for $type {
            const WORDS: &'static [&'static str] = &[$($word),+];
            const VARIANTS: &'static [Self] = &[$(Self::$variant),+];
        }
    };
}

pub(crate) use {choice, parameters};
