//! pathwarp with one deformation more: `swell` makes artwork higher in the middle.

use pathwarp::Error;
use pathwarp::deform::{Built, Case, Deformation, Example, Info, Law, Registry};
use pathwarp::kurbo::Rect;
use pathwarp::map::{Formula, Real};
use pathwarp::param::{Param, Settings};
use std::f64::consts::PI;
use std::sync::Arc;

fn main() -> std::process::ExitCode {
    pathwarp_cli::main_with(Registry::builtin().with(SwellDeformation))
}

struct SwellDeformation;

static INFO: Info = Info::new("swell", "swell the middle of the artwork")
    .group("Plug-ins")
    .about("Makes the artwork higher in the middle, and leaves its left and right ends as they are.")
    .source("this crate")
    .params(&[Param::number("amount", "Growth in the middle: 100% doubles the height.")
        .default("50%")
        .within(-0.9, 5.0)])
    .examples(&[
        Example { what: "As it comes", command: "swell samples/logo.svg -o out.svg" },
        Example { what: "A waist", command: "swell samples/logo.svg --amount -40% -o out.svg" },
    ])
    .laws(&[Law::Identity(&[("amount", "0")]), Law::KeepsLinesAlong(&[], (0.0, 1.0))])
    .cases(&[Case { args: &[("amount", "50%")], at: (50.0, 30.0), to: (50.0, 20.0), tolerance: 1e-12 }]);

impl Deformation for SwellDeformation {
    fn info(&self) -> &Info {
        &INFO
    }

    fn build(&self, s: &Settings<'_>) -> Result<Built, Error> {
        Ok(Built::new(Arc::new(Swell { frame: s.frame().rect, amount: s.number("amount")? })))
    }
}

struct Swell {
    frame: Rect,
    amount: f64,
}

impl Formula for Swell {
    fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
        let wave = ((x - self.frame.x0) * (PI / self.frame.width())).sin();
        let middle = self.frame.center().y;
        (x, (y - middle) * (wave * wave * self.amount + 1.0) + middle)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn is_sound() {
        let faults = pathwarp::check::entry(&SwellDeformation);
        assert!(faults.is_empty(), "{faults:#?}");
    }
}
