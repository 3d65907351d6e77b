//! Drawings of any size, equal in every run.

use std::f64::consts::TAU;
use std::fmt::Write as _;

/// Width of the page.
const SIZE: f64 = 1000.0;
/// Segments per petal.
const PER_PETAL: f64 = 12.0;
/// Seed of the pseudorandom numbers.
const SEED: u64 = 20_261_122;

/// Numbers in [0, 1) by a linear congruential generator (Knuth's MMIX).
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// A drawing of `n` smooth cubic segments, `per_path` to a path: flowers r(φ) = R·(1 + a·cos(kφ + p)) with random a and p.
pub(super) fn flowers(n: usize, per_path: usize) -> String {
    let mut random = Random(SEED);
    let paths = n.div_ceil(per_path.max(1));
    let columns = (paths as f64).sqrt().ceil();
    let cell = SIZE / columns;
    let mut out = format!("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {SIZE} {SIZE}'>\n");
    for k in 0..paths {
        let count = per_path.min(n - k * per_path);
        let (x, y) = (((k as f64 % columns) + 0.5) * cell, ((k as f64 / columns).floor() + 0.5) * cell);
        let (a, phase) = (0.1 + 0.2 * random.next(), TAU * random.next());
        let petals = (count as f64 / PER_PETAL).ceil().max(3.0);
        // The point at φ = 2πi/count and the handle there, a third of the derivative by i. Petals stay within 0.38·1.3 of a cell.
        let at = |i: usize| {
            let phi = TAU * i as f64 / count as f64;
            let (wave_sin, wave_cos) = (petals * phi + phase).sin_cos();
            let (r, dr) = (0.38 * cell * (1.0 + a * wave_cos), -0.38 * cell * a * petals * wave_sin);
            let ((s, c), handle) = (phi.sin_cos(), TAU / count as f64 / 3.0);
            ([x + r * c, y + r * s], [(dr * c - r * s) * handle, (dr * s + r * c) * handle])
        };
        let (start, _) = at(0);
        let _ = write!(out, "<path d='M{:.4},{:.4}", start[0], start[1]);
        for i in 0..count {
            let ((p, t), (q, u)) = (at(i), at((i + 1) % count));
            let (c1, c2) = ([p[0] + t[0], p[1] + t[1]], [q[0] - u[0], q[1] - u[1]]);
            let _ = write!(out, " C{:.4},{:.4} {:.4},{:.4} {:.4},{:.4}", c1[0], c1[1], c2[0], c2[1], q[0], q[1]);
        }
        out += "Z'/>\n";
    }
    out + "</svg>\n"
}

/// A page of `paragraphs` paragraphs, each of [`LETTERS`] letters in words of two to nine.
pub(super) fn page(paragraphs: usize, font: &str) -> String {
    let mut random = Random(SEED);
    let mut out = format!(
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {SIZE} {}' font-family='{font}' font-size='10'>\n",
        paragraphs * 30
    );
    for k in 0..paragraphs {
        let _ = write!(out, "<text x='10' y='{}'>", 20 + 30 * k);
        let mut left = LETTERS;
        while left > 0 {
            let word = left.min(2 + (8.0 * random.next()) as usize);
            out.extend((0..word).map(|_| char::from(b'a' + (26.0 * random.next()) as u8)));
            out.push(' ');
            left -= word;
        }
        out += "</text>\n";
    }
    out + "</svg>\n"
}

/// Letters per paragraph.
pub(super) const LETTERS: usize = 250;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn drawings_have_the_segments_and_letters_asked_for() {
        for (n, each) in [(1000, 1000), (1000, 60)] {
            let svg = flowers(n, each);
            assert_eq!((svg.matches(" C").count(), svg.matches("<path").count()), (n, n.div_ceil(each)));
            assert_eq!(svg, flowers(n, each));
            assert!(usvg::Tree::from_str(&svg, &usvg::Options::default()).is_ok());
        }
        let text = page(3, "sans-serif");
        let letters: usize = text
            .lines()
            .filter(|l| l.starts_with("<text"))
            .map(|l| {
                let inner = l.split(['<', '>']).nth(2).unwrap();
                inner.chars().filter(char::is_ascii_lowercase).count()
            })
            .sum();
        assert_eq!(letters, 3 * LETTERS);
        assert!(usvg::Tree::from_str(&text, &usvg::Options::default()).is_ok());
    }

    /// The handles before and after a node are parallel.
    #[test]
    fn joints_are_smooth() {
        let svg = flowers(120, 120);
        let data = svg.split("d='M").nth(1).unwrap().split('\'').next().unwrap();
        let numbers: Vec<f64> = data.split([' ', ',', 'C', 'Z']).filter_map(|w| w.parse().ok()).collect();
        let points: Vec<&[f64]> = numbers.chunks(2).collect();
        for k in (3..points.len() - 1).step_by(3) {
            let [a, b, c] = [points[k - 1], points[k], points[k + 1]];
            let (u, v) = ([b[0] - a[0], b[1] - a[1]], [c[0] - b[0], c[1] - b[1]]);
            let sine = (u[0] * v[1] - u[1] * v[0]) / (u[0].hypot(u[1]) * v[0].hypot(v[1]));
            assert!(sine.abs() < 1e-3, "{k}: {sine}");
        }
    }
}
