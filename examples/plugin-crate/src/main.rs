//! The whole of a program that is pathwarp with one deformation more.
//!
//! `ripple` pushes every point away from and towards a centre, as rings on water do:
//! r' = r + a·sin(2π·r/λ), the direction kept.

use pathwarp::Error;
use pathwarp::deform::{Built, Case, Deformation, Example, Info, Law, Registry};
use pathwarp::kurbo::Point;
use pathwarp::map::{Formula, Real};
use pathwarp::param::{Axis, Kind, Param, Settings};
use std::f64::consts::TAU;
use std::sync::Arc;

fn main() -> std::process::ExitCode {
    pathwarp_cli::main_with(Registry::builtin().with(RippleDeformation))
}

struct RippleDeformation;

static INFO: Info = Info::new("ripple", "rings on water, spreading from a centre")
    .group("Plug-ins")
    .about("Pushes every point along its ray from the centre, outwards and inwards in turn.")
    .source("this crate")
    .params(&[
        Param::new("center", Kind::Point, "Where the rings start.").default("50%,50%"),
        Param::length("wavelength", Axis::Diagonal, "Distance from ring to ring.").default("20%").within(1e-3, 1e9),
        Param::length("height", Axis::Diagonal, "How far a point is pushed at most.").default("1%"),
    ])
    .examples(&[
        Example { what: "As it comes", command: "ripple samples/grid.svg -o out.svg" },
        Example { what: "From a corner", command: "ripple samples/logo.svg --center 0%,0% --height 2% -o out.svg" },
    ])
    .laws(&[Law::Identity(&[("height", "0")])])
    .cases(&[Case {
        args: &[("center", "50,50"), ("wavelength", "40"), ("height", "3")],
        at: (60.0, 50.0),
        to: (63.0, 50.0),
        tolerance: 1e-12,
    }]);

impl Deformation for RippleDeformation {
    fn info(&self) -> &Info {
        &INFO
    }

    fn build(&self, s: &Settings<'_>) -> Result<Built, Error> {
        let map =
            Ripple { center: s.point("center")?, wavelength: s.number("wavelength")?, height: s.number("height")? };
        Ok(Built::new(Arc::new(map)))
    }
}

struct Ripple {
    center: Point,
    wavelength: f64,
    height: f64,
}

impl Formula for Ripple {
    fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
        let (dx, dy) = (x - self.center.x, y - self.center.y);
        let r = dx.hypot(dy);
        // sin(2π·r/λ)/r tends to 2π/λ at the centre.
        let push = if r.value() < 1e-9 * self.wavelength {
            S::from(TAU / self.wavelength * self.height)
        } else {
            (r / self.wavelength * TAU).sin() / r * self.height
        };
        (x + dx * push, y + dy * push)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn is_sound() {
        let faults = pathwarp::check::entry(&RippleDeformation);
        assert!(faults.is_empty(), "{faults:#?}");
    }
}
