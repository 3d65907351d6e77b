//! The work of parsing style sheets, counted before it is done. simplecss copies the declarations of a rule for each of its
//! selectors. And it computes line and column of every place at which it cannot go on, by going through all text before it; the
//! end of every value and of every number without a unit is such a place.

/// Bytes of text before a place, and of those on its line, that are gone through in the time of a comparison. Measured, for the four
/// times that a sheet is parsed.
const BEFORE: f64 = 200.0;
const ON_LINE: f64 = 90.0;

/// Comparisons that a copy of a declaration counts as, by the memory that it takes.
const COPY: f64 = 8.0;

/// Rules that are sorted in the time of a comparison: all of them again after each sheet.
const SORTED: f64 = 5.0;

/// Counts comparisons over the sheets of a drawing.
#[derive(Default)]
pub(super) struct ParsingWork {
    /// Length of the sheets so far, and the number of their rules.
    length: usize,
    rules: f64,
    /// Comparisons so far.
    pub(super) steps: f64,
}

impl ParsingWork {
    /// Adds a sheet.
    pub(super) fn add(&mut self, css: &str) {
        let bytes = css.as_bytes();
        let (mut selectors, mut declarations, mut inside) = (1.0, 1.0, false);
        let (mut line, mut at) = (0, 0);
        while let Some(&b) = bytes.get(at) {
            let next = bytes.get(at + 1).copied().unwrap_or(b';');
            let fails = match b {
                b'0'..=b'9' => inside && !is_part_of_number(next),
                b'#' => inside && next.is_ascii_digit(),
                b';' | b'}' | b'@' | b'\\' | b'!' | b'?' | b'$' | b'^' | b'&' | b'`' | b'<' => true,
                _ => false,
            };
            if fails {
                self.steps += (self.length + at) as f64 / BEFORE + (at - line) as f64 / ON_LINE;
            }
            match b {
                b'\n' => line = at,
                b'{' => inside = true,
                b',' if !inside => selectors += 1.0,
                b';' if inside => declarations += 1.0,
                b'}' => {
                    self.steps += COPY * selectors * declarations;
                    self.rules += selectors;
                    (selectors, declarations, inside) = (1.0, 1.0, false);
                }
                _ => {}
            }
            at += skipped(&bytes[at..], next);
        }
        self.steps += COPY * selectors * declarations + self.rules / SORTED;
        self.length += bytes.len();
    }
}

/// Returns `true` if a number goes on with this byte, by a digit or a unit.
fn is_part_of_number(b: u8) -> bool {
    b.is_ascii_alphanumeric() || matches!(b, b'.' | b'%' | b'-' | b'_') || !b.is_ascii()
}

/// Length of the string, the comment or the arguments that a text begins with, or 1: they are gone through once.
fn skipped(text: &[u8], next: u8) -> usize {
    let end = |of: &[u8]| memchr::memmem::find(&text[1..], of).map_or(text.len(), |i| 1 + i + of.len());
    match text.first() {
        Some(b'(') => end(b")"),
        Some(b'/') if next == b'*' => end(b"*/"),
        Some(quote @ (b'"' | b'\'')) => end(&[*quote]),
        _ => 1,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn steps(css: &str) -> f64 {
        let mut work = ParsingWork::default();
        work.add(css);
        work.steps
    }

    #[test]
    fn work_grows_with_the_square() {
        let many = |n: usize| steps(&"rect{fill:red;a:1 2 #3}".repeat(n));
        assert!(many(1000) < 2e6 && many(8000) > 30e6);
        assert!((many(8000) / many(4000) - 4.0).abs() < 0.1);
        // Lines are looked at from their beginning only.
        assert!(steps(&"rect{fill:red;a:1 2 #3}\n".repeat(4000)) < 0.5 * many(4000));
        // A sheet is searched from the first one on.
        let (mut two, one) = (ParsingWork::default(), "a{b:c}\n".repeat(1000));
        two.add(&one);
        two.add(&one);
        assert!(two.steps > 2.5 * steps(&one));
        let mut sheets = ParsingWork::default();
        (0..30_000).for_each(|_| sheets.add("rect{fill:red}"));
        assert!(sheets.steps > 15e6);
    }

    #[test]
    fn declarations_are_copied_for_each_selector() {
        let list = |n: usize| steps(&format!("{}b{{{}}}", "a,".repeat(n), "a:b;".repeat(n)));
        assert!(list(4000) > 16e6 * COPY && list(30) < 2e4);
    }

    #[test]
    fn embedded_fonts_take_nothing() {
        let font = "9+8/7;6#5!".repeat(50_000);
        for css in [format!("@font-face{{src:url(data:x,{font})}}"), format!("a{{b:'{font}'}}"), format!("/*{font}*/")]
        {
            assert!(steps(&css) < 50e3, "{}", steps(&css));
        }
        // Whatever is not closed ends.
        for css in ["(", "'", "/*", "a{b:c", "{}}{;:@\\", ""] {
            steps(css);
        }
    }
}
