//! One attempt: fits a single piece to a stretch.

use super::lanes::Lanes;
use super::outcome::FitOutcome;
use super::piece::FittedPiece;
use super::source::BreakPoint;
use super::stretch::StretchFitter;
use kurbo::Point;

impl StretchFitter<'_> {
    /// Fits one piece to a stretch: a line, the Hermite cubic, or the best cubic that [`improve`](Self::improve) finds.
    #[inline(never)]
    pub(super) fn attempt(&mut self, from: &BreakPoint, to: &BreakPoint) -> Result<FitOutcome, Point> {
        let mut g = Lanes::default();
        let mut request = self.start(from, to, &mut g)?;
        if let Some(line) = self.line(&request)? {
            return Ok(line);
        }
        if let Some(error) = self.hermite_error(&mut request)? {
            return Ok(FitOutcome::Fits { piece: FittedPiece::Cubic(request.hermite()), error, reach: error });
        }
        self.improve(&mut request)
    }
}
