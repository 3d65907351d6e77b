//! Maps given by formulas for x' and y'.
//!
//! The text becomes a list of operations ([`formula`](crate::formula)), which runs on plain and on dual numbers, so that derivatives
//! are exact. Each kink of abs, min or max, and each jump of sign or floor, is a crease, given by a level set. A branch continues the
//! map smoothly beyond the creases around a point: in its list, every such operation is replaced by its formula there (abs(a) by a or −a).

use super::entry::{Built, ByHand, Case, Entry, Example, Info, Law};
use crate::error::Error;
use crate::formula::{Binary, Kink, Names, Program, SyntaxError, is_function, is_name, parse};
use crate::map::{Class, Cost, Crease, Creases, Dual, Enclosure, Field, Jet, Level, Map};
use crate::param::{Kind, Param};
use kurbo::{Affine, Point, Rect};
use std::sync::Arc;

/// A map given by formulas for x' and y', with exact derivatives.
///
/// Formulas use numbers, `+ - * / ^`, brackets, the functions sin cos tan asin acos atan atan2 sinh cosh tanh asinh sqrt exp ln abs sign
/// floor ceil round mod min max pow hypot smoothstep noise, and the names x, y (the point), u, v (its position in the box, 0 to 1), w, h
/// (the size of the box), cx, cy (its centre), pi, tau, e.
///
/// `mod(a, b)` = a − b·⌊a/b⌋, `smoothstep(a, b, c)` = t²(3 − 2t) with t = (c − a)/(b − a) cut off at 0 and 1. `noise(a, b)` is smooth, with
/// hills one unit wide: 2/16 of the sum of the sines of π(1 + {ip})(a·cos π{ig} + b·sin π{ig}) + 2π{iq}, i from 1 to 16, with {} the
/// fractional part, g = 0.618033988749895, p = 0.754877666246693, q = 0.569840290998053. It is usually within ±1, and always within ±2.
///
/// ```
/// use pathwarp::{deform::Expr, kurbo::{Point, Rect}, map::Map};
///
/// let ripple = Expr::new(Rect::new(0.0, 0.0, 100.0, 50.0)).define("a", "w/25").x("x + a*sin(y)").build()?;
/// assert!((ripple.map.point(Point::new(1.0, 2.0)).x - (1.0 + 4.0 * 2f64.sin())).abs() < 1e-12);
/// # Ok::<(), pathwarp::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Expr {
    frame: Rect,
    x: Option<String>,
    y: Option<String>,
    /// `NAME=FORMULA`.
    definitions: Vec<String>,
}

impl Expr {
    /// Creates a map over the artwork's box. At least one coordinate needs a formula.
    #[must_use]
    pub fn new(frame: Rect) -> Self {
        Self { frame, x: None, y: None, definitions: Vec::new() }
    }

    setters! {
        /// Sets the formula for x'. Default: `x`.
        x(formula: &str) => x: Some(formula.to_owned());
        /// Sets the formula for y'. Default: `y`.
        y(formula: &str) => y: Some(formula.to_owned());
    }

    /// Defines a name by a formula, for use in the formulas after it.
    #[must_use]
    pub fn define(mut self, name: &str, formula: &str) -> Self {
        self.definitions.push(format!("{name}={formula}"));
        self
    }

    /// Parses the formulas and builds the map.
    ///
    /// # Errors
    /// [`Error::Missing`] without any formula, [`Error::Usage`] for a syntax error, which a caret marks.
    pub fn build(&self) -> Result<Built, Error> {
        if self.x.is_none() && self.y.is_none() {
            return Err(Error::missing("x", "a formula for x, y or both, such as 'x + 4*sin(y/16)'"));
        }
        let mut program = Program::default();
        let mut names = builtin_names(&mut program, self.frame)
            .ok_or_else(|| Error::usage("x", "", "has no room for the built-in names"))?;
        for text in &self.definitions {
            let Some((name, formula)) = text.split_once('=') else {
                return Err(Error::usage("let", text, "is not NAME=FORMULA"));
            };
            let (name, skipped) = (name.trim(), text.len() - formula.len());
            if !is_name(name) {
                let problem = format!("has `{name}` for a name: use letters, digits and _, starting with a letter");
                return Err(Error::usage("let", text, problem));
            }
            if names.get(name).is_some() || is_function(name) {
                return Err(Error::usage("let", text, format!("redefines `{name}`")));
            }
            let value = parse(formula, &names, &mut program)
                .map_err(|e| Error::usage("let", text, SyntaxError { at: e.at + skipped, ..e }.show(text)))?;
            names.set(name, value);
        }
        let mut read = |param: &str, formula: &Option<String>| -> Result<u32, Error> {
            let text = formula.as_deref().unwrap_or(param);
            parse(text, &names, &mut program).map_err(|e| Error::usage(param, text, e.show(text)))
        };
        let (x, y) = (read("x", &self.x)?, read("y", &self.y)?);
        let program = Arc::new(program);
        let map = ExprMap { program: Arc::clone(&program), x, y };
        let mut built = Built::new(Arc::new(map.clone()));
        let texts =
            [("x", &self.x), ("y", &self.y)].map(|(name, text)| text.clone().unwrap_or_else(|| name.to_owned()));
        // Constants are folded when a formula is read, so there may be no operation to blame.
        let blamed_formula = move |p: Point| {
            let image = map.point(p);
            let blamed = if image.x.is_finite() { &texts[1] } else { &texts[0] };
            (!image.is_finite()).then(|| format!("{blamed} has no finite value"))
        };
        built.undefined = Some(Arc::new(move |p| program.undefined_at(p.x, p.y).or_else(|| blamed_formula(p))));
        Ok(built)
    }
}

static INFO: Info = Info::new("expr", "move every point by a formula for x and y")
    .group("Formulas")
    .by_hand(ByHand {
        label: Some("Formula"),
        showing: &[("y", "y + h*((2*u-1)^2/2 - 0.2)")],
        ..ByHand::NONE
    })
    .about("Formulas for the new x and y; a coordinate without one stays. Numbers, + - * / and ^ or ** (power), brackets, and\n  \
x y      the point, in user units, y downwards\n  \
u v      the same within the artwork's box, from 0 to 1, from the left and the top\n  \
w h      the box's width and height\n  \
cx cy    its middle\n  \
pi tau e the numbers; angles are in radians\n  \
sin cos tan asin acos atan atan2(y,x) sinh cosh tanh asinh\n  \
sqrt exp ln abs sign floor ceil round mod(a,b) min(a,b) max(a,b)\n  \
pow(a,b) hypot(a,b)\n  \
smoothstep(a,b,c)  0 for c below a, 1 above b, a smooth step between\n  \
noise(a,b)  hills and dales one unit wide, from -1 to 1 or a little more; always the same\n\n\
--let names a value for the formulas after it. Curves are split at the kinks of abs, min and max, and where sign, floor and the like jump.")
    .source("forward-mode differentiation of the formula itself; parsing after V. Pratt, Top down operator precedence, POPL 1973")
    .params(&[
        Param::new("x", Kind::Text("FORMULA"), "The new x.").default("x"),
        Param::new("y", Kind::Text("FORMULA"), "The new y.").default("y"),
        Param::new("let", Kind::Text("NAME=FORMULA"), "A name for a value, used after it; may be given many times.")
            .repeated(),
    ])
    .demo(&[("x", "x + 4*sin(y/16)"), ("y", "y + 3*cos(u*pi)^2 - x*y/500")])
    .examples(&[
        Example {
            what: "A ripple from side to side",
            command: "expr samples/logo.svg --x 'x + 4*sin(y/16)' -o out.svg",
        },
        Example {
            what: "A parabola's arch",
            command: "expr samples/lettering.svg --let 's=2*u-1' --y 'y + h*(s^2/2 - 0.2)' -o out.svg",
        },
        Example {
            what: "A roof, with its ridge in the middle",
            command: "expr samples/grid.svg --y 'y + 0.25*abs(x - cx) - 0.1*h' -o out.svg",
        },
    ])
    .laws(&[
        Law::Identity(&[("x", "x")]),
        Law::Identity(&[("x", "w*u"), ("y", "v*h")]),
        Law::Identity(&[("x", "cx + hypot(x-cx, y-cy)*cos(atan2(y-cy, x-cx))"), ("y", "sqrt(y)^2")]),
        Law::Identity(&[("x", "exp(ln(x+1)) - 1"), ("y", "tan(atan(y))")]),
        Law::Identity(&[("x", "100*sin(asin(u))"), ("y", "100*cos(acos(v))")]),
        Law::Area(&[("x", "x + 9*sin(y/9)")], 1.0),
        Law::KeepsLines(&[("x", "(2*x - y/3 + 1)*2"), ("y", "-(y + x)")]),
        Law::Same(&[("let", "a=2*pi"), ("let", "b=a*u"), ("y", "y+sin(b)")], &[("y", "y+sin(tau*x/w)")]),
        Law::Same(&[("x", "x+abs(y-30)")], &[("x", "x+max(y-30, 30-y)")]),
        Law::Same(&[("x", "-min(-x, -y)^2")], &[("x", "-(max(x, y)**2)")]),
    ])
    .cases(&[
        Case {
            args: &[("x", "x + 4*sin(y/16)")],
            at: (1.0, 8.0 * std::f64::consts::PI),
            to: (5.0, 8.0 * std::f64::consts::PI),
            tolerance: 1e-12,
        },
        Case {
            args: &[("x", "2^3^2 - -2*3"), ("y", "-2^2 + 10/5/2")],
            at: (1.0, 1.0),
            to: (518.0, -3.0),
            tolerance: 0.0,
        },
        Case {
            args: &[("x", "1.5e1 + .5"), ("y", "pow(x, 0.5) + e - e")],
            at: (9.0, 1.0),
            to: (15.5, 3.0),
            tolerance: 1e-12,
        },
    ]);

/// Reads the deformation from text.
pub(super) const ENTRY: Entry = Entry::new(&INFO, |s| {
    let formula = |name| s.texts(name).last().filter(|_| s.given(name)).map(|t| (*t).to_owned());
    let definitions = s.texts("let").into_iter().map(str::to_owned).collect();
    Expr { frame: s.frame().rect, x: formula("x"), y: formula("y"), definitions }.build()
});

/// Defines the built-in names. `None` if the program becomes too long, which no new one does.
fn builtin_names<'a>(p: &mut Program, r: Rect) -> Option<Names<'a>> {
    let mut names = Names::new();
    let (x, y) = (p.x()?, p.y()?);
    names.set("x", x);
    names.set("y", y);
    for (name, coordinate, from, size) in [("u", x, r.x0, r.width()), ("v", y, r.y0, r.height())] {
        let (from, size) = (p.constant(from)?, p.constant(size)?);
        let distance = p.binary(Binary::Sub, coordinate, from)?;
        names.set(name, p.binary(Binary::Div, distance, size)?);
    }
    let c = r.center();
    for (name, value) in [
        ("w", r.width()),
        ("h", r.height()),
        ("cx", c.x),
        ("cy", c.y),
        ("pi", std::f64::consts::PI),
        ("tau", std::f64::consts::TAU),
        ("e", std::f64::consts::E),
    ] {
        names.set(name, p.constant(value)?);
    }
    Some(names)
}

/// The map: a program, and the indices of x' and y' among its values.
#[derive(Debug, Clone)]
struct ExprMap {
    program: Arc<Program>,
    x: u32,
    y: u32,
}

/// Points evaluated at a time.
const LANES: usize = 8;

impl ExprMap {
    fn jets_of<const N: usize>(&self, ps: [Point; N]) -> [Jet; N] {
        let x = ps.map(|p| Dual { v: p.x, x: 1.0, y: 0.0 });
        let y = ps.map(|p| Dual { v: p.y, x: 0.0, y: 1.0 });
        let values = self.program.run(x, y);
        let (x, y) = (values[self.x as usize], values[self.y as usize]);
        std::array::from_fn(|i| Jet {
            p: Point::new(x[i].v, y[i].v),
            dx: (x[i].x, y[i].x).into(),
            dy: (x[i].y, y[i].y).into(),
        })
    }

    fn points_of<const N: usize>(&self, ps: [Point; N]) -> [Point; N] {
        let values = self.program.run(ps.map(|p| p.x), ps.map(|p| p.y));
        let (x, y) = (values[self.x as usize], values[self.y as usize]);
        std::array::from_fn(|i| Point::new(x[i], y[i]))
    }
}

/// Number of operations that take as long as a bicubic net, the unit of [`Cost::work`].
const OPERATIONS_PER_COST: f64 = 8.0;

impl Map for ExprMap {
    fn cost(&self) -> Cost<'_> {
        Cost::new(1.0 + self.program.len() as f64 / OPERATIONS_PER_COST)
    }

    fn jet(&self, p: Point) -> Jet {
        self.jets_of([p])[0]
    }

    fn point(&self, p: Point) -> Point {
        self.points_of([p])[0]
    }

    fn jets(&self, ps: &[Point], out: &mut [Jet]) {
        for (ps, out) in ps.chunks(LANES).zip(out.chunks_mut(LANES)) {
            match <[Point; LANES]>::try_from(ps) {
                Ok(all) => out.copy_from_slice(&self.jets_of(all)),
                Err(_) => ps.iter().zip(out).for_each(|(p, o)| *o = self.jet(*p)),
            }
        }
    }

    fn points(&self, ps: &[Point], out: &mut [Point]) {
        for (ps, out) in ps.chunks(LANES).zip(out.chunks_mut(LANES)) {
            match <[Point; LANES]>::try_from(ps) {
                Ok(all) => out.copy_from_slice(&self.points_of(all)),
                Err(_) => ps.iter().zip(out).for_each(|(p, o)| *o = self.point(*p)),
            }
        }
    }

    fn class(&self) -> Class {
        match (self.program.affine(self.x), self.program.affine(self.y)) {
            (Some([a, c, e]), Some([b, d, f])) => Class::Affine(Affine::new([a, b, c, d, e, f])),
            _ => Class::Smooth,
        }
    }

    fn creases(&self, out: &mut Creases) {
        for kink in self.program.kinks([self.x, self.y]) {
            out.push(Crease::kink(Level::Field(Arc::new((kink, self.program.clone())))));
        }
    }

    fn branch(&self, inside: Point) -> Option<Arc<dyn Map>> {
        if self.program.kinks([self.x, self.y]).is_empty() {
            return None;
        }
        let program = Arc::new(self.program.branch(inside.x, inside.y));
        Some(Arc::new(Self { program, ..*self }))
    }

    fn enclose(&self, [x, y]: [Enclosure; 2]) -> Option<[Enclosure; 2]> {
        let values = self.program.run([x], [y]);
        Some([values[self.x as usize][0], values[self.y as usize][0]])
    }
}

/// The function that is zero at a kink or a jump of a program.
impl Field for (Kink, Arc<Program>) {
    fn at(&self, p: Point) -> f64 {
        self.0.level(&self.1.run([p.x], [p.y]))
    }

    fn enclose(&self, [x, y]: [Enclosure; 2]) -> Option<Enclosure> {
        Some(self.0.level(&self.1.run([x], [y])))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check;
    use crate::deform::Deformation as _;
    use crate::param::Args;

    #[test]
    fn is_sound() {
        let faults = check::entry(&ENTRY);
        assert!(faults.is_empty(), "{faults:#?}");
    }

    fn build(pairs: &[(&str, &str)]) -> Result<Arc<dyn Map>, Error> {
        ENTRY.build_from(&Args::from_pairs(pairs), &check::frame()).map(|b| b.map)
    }

    #[test]
    fn functions_and_their_derivatives() {
        let p = Point::new(0.6, 0.3);
        let (x, y) = (p.x, p.y);
        for (text, value, dx, dy) in [
            ("sin(x*y)", (x * y).sin(), y * (x * y).cos(), x * (x * y).cos()),
            ("tan(x)", x.tan(), 1.0 + x.tan().powi(2), 0.0),
            ("asin(x)", x.asin(), 1.0 / (1.0 - x * x).sqrt(), 0.0),
            ("acos(y)", y.acos(), 0.0, -1.0 / (1.0 - y * y).sqrt()),
            ("atan(x/y)", (x / y).atan(), y / (x * x + y * y), -x / (x * x + y * y)),
            ("atan2(x,y)", x.atan2(y), y / (x * x + y * y), -x / (x * x + y * y)),
            ("x^y", x.powf(y), y * x.powf(y - 1.0), x.ln() * x.powf(y)),
            ("2^x", 2f64.powf(x), 2f64.ln() * 2f64.powf(x), 0.0),
            ("x^-2", x.powi(-2), -2.0 * x.powi(-3), 0.0),
            ("x^0.7", x.powf(0.7), 0.7 * x.powf(-0.3), 0.0),
            ("min(x,y)*max(x,y)", x * y, y, x),
            ("abs(y-x)", x - y, 1.0, -1.0),
            ("ln(x)+exp(y)-sqrt(x)", x.ln() + y.exp() - x.sqrt(), 1.0 / x - 0.5 / x.sqrt(), y.exp()),
            ("hypot(x,y)", x.hypot(y), x / x.hypot(y), y / x.hypot(y)),
            ("tanh(x-y)", (x - y).tanh(), 1.0 / (x - y).cosh().powi(2), -1.0 / (x - y).cosh().powi(2)),
            ("tanh(-400*x)", -1.0, 0.0, 0.0),
            ("sinh(-x)", -x.sinh(), -x.cosh(), 0.0),
            ("cosh(y)", y.cosh(), 0.0, y.sinh()),
            ("asinh(-7*x)", -(7.0 * x).asinh(), -7.0 / (1.0 + 49.0 * x * x).sqrt(), 0.0),
            ("asinh(y)", y.asinh(), 0.0, 1.0 / (1.0 + y * y).sqrt()),
            ("floor(-3*x)+ceil(5*y)+x", -2.0 + 2.0 + x, 1.0, 0.0),
            ("round(x)*y+sign(x)-sign(-y)+sign(0)", y + 2.0, 0.0, 1.0),
            ("mod(7*x,1)-mod(-y,2)", 0.2 - 1.7, 7.0, 1.0),
            ("smoothstep(0,2,x)", 0.3 * 0.3 * (3.0 - 2.0 * 0.3), 3.0 * 0.3 * 0.7, 0.0),
            ("smoothstep(1,0,y-2)+smoothstep(0,1,x+1)", 2.0, 0.0, 0.0),
        ] {
            let j = build(&[("x", text)]).unwrap().jet(p);
            let error = (j.p.x - value).abs() + (j.dx.x - dx).abs() + (j.dy.x - dy).abs();
            assert!(error < 1e-13, "{text}: {j:?}, wanted {value} {dx} {dy}");
        }
    }

    /// Checks noise against the sum in the documentation, and its stated size.
    #[test]
    fn noise_is_the_documented_sum() {
        let noise = build(&[("x", "noise(x, y)")]).unwrap();
        let mut largest = 0.0f64;
        for i in 0..2000 {
            let p = Point::new(f64::from(i) * 0.37 - 300.0, f64::from(i * i % 977) * 0.11);
            let wave = |i: f64| {
                let [g, q, r] = [0.618033988749895, 0.754877666246693, 0.569840290998053].map(|s: f64| (i * s).fract());
                let pi = std::f64::consts::PI;
                (pi * (1.0 + q) * (p.x * (pi * g).cos() + p.y * (pi * g).sin()) + 2.0 * pi * r).sin()
            };
            let sum: f64 = (1..=16).map(|i| wave(f64::from(i))).sum();
            assert!((noise.point(p).x - sum / 8.0).abs() < 1e-11, "{p:?}");
            largest = largest.max((sum / 8.0).abs());
        }
        assert!((0.8..1.3).contains(&largest), "{largest}");
    }

    /// Every jump becomes a vertical line, and nothing else does. The jump of sign, which is 0 in the middle, becomes two.
    #[test]
    fn jumps_are_creases() {
        let line = crate::Outline::from_svg("M0.25,0 H9.75").unwrap();
        for (text, pieces) in [("floor(x)", 19), ("y+3*sign(x-4)", 4), ("y+mod(x,2.5)", 7), ("y+smoothstep(3,5,x)", 3)]
        {
            let map = build(&[("y", text)]).unwrap();
            let w = crate::refit::warp_path(&line, &*map, &crate::refit::Options::new(1e-2)).unwrap();
            assert_eq!(w.report.segments_out, pieces, "{text}: {:?}", w.path);
        }
    }

    #[test]
    fn faults_have_a_caret_below_them() {
        let fault = |text: &str| build(&[("x", text)]).err().unwrap().to_string();
        for (text, column, part) in [
            ("x + sin(y", 7, "never closed"),
            ("x + * y", 4, "expected a value"),
            ("2x", 1, "operator is missing"),
            ("2 + fud(x)", 4, "no `fud`"),
            ("x +", 3, "missing at the end"),
            ("x)", 1, "never opened"),
            ("sin x", 4, "in brackets"),
            ("hypot(x)", 7, "two arguments"),
            ("sin(x, y)", 5, "comma"),
            ("smoothstep(0, 1)", 15, "three arguments"),
            ("ä + 1", 0, "expected a value"),
            ("x + ü", 4, "expected a value"),
            ("x ; y", 2, "no meaning"),
            ("1e999", 0, "too large"),
            ("", 0, "missing at the end"),
        ] {
            let message = fault(text);
            assert!(message.contains(part), "{message}");
            assert!(message.ends_with(&format!("\n  {text}\n  {}^", " ".repeat(column))), "{message}");
        }
        let e = build(&[("let", "k = 2 +* 3"), ("x", "k")]).err().unwrap().to_string();
        assert!(e.starts_with("let: `k") && e.ends_with("\n         ^"), "{e}");
        for text in ["sin=3", "x=3", "4=3", "k"] {
            assert!(build(&[("let", text), ("x", "y")]).is_err(), "{text}");
        }
        assert!(build(&[]).is_err());
    }

    #[test]
    fn no_input_is_too_deep_or_too_long() {
        for text in ["(".repeat(5000), "-".repeat(5000), "2^".repeat(4000), "x+".repeat(6000), "sin(".repeat(2000)] {
            assert!(build(&[("x", &text)]).is_err());
        }
        // Long, but flat, is fine as long as its operations are bounded.
        let sum = vec!["x"; 900].join("+");
        assert!((build(&[("x", &sum)]).unwrap().point(Point::new(2.0, 0.0)).x - 1800.0).abs() < 1e-9);
        let many: Vec<String> = (0..1500).map(|i| format!("x^{i}")).collect();
        assert!(build(&[("x", &many.join("+"))]).is_err());
    }

    #[test]
    fn straight_formulas_are_affine_and_kinks_are_creases() {
        assert_eq!(
            build(&[("x", "2*(x - y)/4 + w"), ("y", "-x")]).unwrap().class(),
            Class::Affine(Affine::new([0.5, -1.0, -0.5, 0.0, 100.0, 0.0]))
        );
        assert_eq!(build(&[("x", "x*y")]).unwrap().class(), Class::Smooth);
        let roof = build(&[("y", "y + abs(x - cx)"), ("let", "unused=abs(x-3)")]).unwrap();
        let mut creases = Creases::default();
        roof.creases(&mut creases);
        assert_eq!(creases.items().len(), 1);
        let line = crate::Outline::from_svg("M0,0 H100").unwrap();
        let w = crate::refit::warp_path(&line, &*roof, &crate::refit::Options::new(1e-6)).unwrap();
        assert_eq!(w.report.segments_out, 2, "{:?}", w.path);
    }
}
