//! The pieces of single segments, fitted when they are needed: where merging succeeds, most never are.

use super::carry::Site;
use crate::refit::piece::FittedPiece;
use crate::refit::report::PathReport;
use kurbo::Point;

/// The segments of a run with their own pieces.
pub(super) struct OwnPieces<'a> {
    pub(super) site: Site<'a>,
    pieces: Vec<FittedPiece>,
    /// For each segment, its range of `pieces` and their report.
    known: Vec<Option<(usize, usize, PathReport)>>,
}

impl<'a> OwnPieces<'a> {
    pub(super) fn new(site: Site<'a>) -> Self {
        Self { site, pieces: Vec::new(), known: site.segs.iter().map(|_| None).collect() }
    }

    fn fit(&mut self, i: usize) -> Result<&(usize, usize, PathReport), Point> {
        if self.known[i].is_none() {
            let (start, mut report) = (self.pieces.len(), PathReport::default());
            let Site { fitter, segs, jets } = self.site;
            let [first, last] = &jets[i];
            fitter.fit(&segs[i], [first, last], &mut self.pieces, &mut report)?;
            self.known[i] = Some((start, self.pieces.len(), report));
        }
        Ok(self.known[i].get_or_insert_with(|| (0, 0, PathReport::default())))
    }

    /// Number of pieces of segment `i`.
    pub(super) fn count(&mut self, i: usize) -> Result<usize, Point> {
        self.fit(i).map(|(from, to, _)| to - from)
    }

    /// Number of segments.
    pub(super) fn segments(&self) -> usize {
        self.site.segs.len()
    }

    /// Number of pieces of all segments.
    pub(super) fn total(&mut self) -> Result<usize, Point> {
        (0..self.segments()).map(|i| self.count(i)).sum()
    }

    /// Appends the pieces of segment `i`.
    pub(super) fn append(
        &mut self,
        i: usize,
        out: &mut Vec<FittedPiece>,
        report: &mut PathReport,
    ) -> Result<(), Point> {
        let (from, to, own) = self.fit(i)?;
        let (from, to) = (*from, *to);
        report.add(own.clone());
        out.extend_from_slice(&self.pieces[from..to]);
        Ok(())
    }
}
