//! Pictures of filter effects, bent pixel by pixel where affine fits of the filters would look different.

use crate::bitmap::{Bender, Pixel, count_evaluations, count_pixels, too_much};
use pathwarp::budget::{Budget, Limit};
use pathwarp_raster::{Continued, DrawingWarp, Error, Picture, encode_smooth_png};
use pathwarp_svg::ReadOptions;
use pathwarp_svg::engine::{BentImage, FilterPainter, FilterRequest, PictureError};
use pathwarp_svg::usvg_tree::{ReadTree, read_tree};

/// The share of a drawing's remaining work that its filters may take, and the share of the remainder that a single filter may take.
const SHARE: f64 = 0.5;
const SHARE_OF_ONE: f64 = 0.5;

impl FilterPainter for Bender {
    fn paint(&self, r: &FilterRequest<'_>) -> Result<Option<Vec<Option<BentImage>>>, PictureError> {
        let floor = *self.filters_leave.get_or_init(|| (1.0 - SHARE) * self.budget.left());
        let most = SHARE_OF_ONE * (self.budget.left() - floor).max(0.0);
        let budget = Budget::new(self.budget.limits().with(Limit::Work, most));
        let pictures = self.pictures(r, &budget);
        self.budget.spend(most - budget.left()).map_err(too_much)?;
        pictures
    }
}

impl Bender {
    fn pictures(&self, r: &FilterRequest<'_>, budget: &Budget) -> Result<Option<Vec<Option<BentImage>>>, PictureError> {
        /// Most pixels of one picture, and of all pictures of a drawing.
        const MOST: f64 = 2e6;
        const MOST_TOGETHER: f64 = 8e6;
        /// Evaluations of the map for each filter and for each pixel.
        const FILTER_EVALUATIONS: f64 = 12e3;
        const PIXEL_EVALUATIONS: f64 = 0.5;
        /// Pixels per px of a picture with little detail, and where the affine fit is compared with the exact result.
        const COARSEST: f64 = 0.25;
        const COMPARED: f64 = 2.0;
        /// Share of the page on which the differences of all filters together stay unseen.
        const UNSEEN: f64 = 0.002;
        /// Density of a picture beside a shape with sharp edges, as a share of the density of pictures that stand alone.
        const FINEST: f64 = 0.75;
        let reason = |e: Error| PictureError::from(e.to_string());
        let count = |width: f64, height: f64| {
            count_evaluations(budget, &*self.map, PIXEL_EVALUATIONS * width * height)?;
            count_pixels(budget, Pixel::Warped, width * height)
        };
        count_evaluations(budget, &*self.map, FILTER_EVALUATIONS).map_err(too_much)?;
        let [inner, outer] = [r.graphic, r.area].map(|area| r.placed.transform_rect_bbox(area));
        let map = Continued::new(r.map, inner.intersect(outer), outer);
        let warp = DrawingWarp::new((r.area, r.placed), &map, r.after, &count, budget);
        let warp = warp.ok_or("the map is undefined on part of it, or makes nothing of it")?;
        let px_per_unit = (r.to_px * r.after.inverse()).determinant().abs().sqrt();
        if let Some([drawing, fitted]) = r.compared {
            let [drawing, fitted] = [tree(&drawing(r.area), budget)?, tree(&fitted(warp.bounds()), budget)?];
            let unseen = UNSEEN * r.page / r.among.max(1) as f64;
            if warp.resembles(&drawing.tree, &fitted.tree, COMPARED * px_per_unit, unseen).map_err(reason)? {
                return Ok(None);
            }
        }
        let most = MOST.min(MOST_TOGETHER / r.among.max(1) as f64) / warp.bounds().area();
        let size = (warp.bounds().width(), warp.bounds().height());
        let finest = (FINEST * self.seen_density(px_per_unit, size)).min(most.sqrt());
        let picture = |svg: Option<String>| {
            let Some(svg) = svg else { return Ok(None) };
            let painted = warp.paint(&tree(&svg, budget)?.tree, COARSEST * px_per_unit, finest).map_err(reason)?;
            let Some((picture, area)) = painted else { return Ok(None) };
            Ok(Some(BentImage::new(encode_smooth_png(&picture).map_err(reason)?, area)))
        };
        let pictures = (r.layers)().into_iter().map(picture).collect::<Result<_, PictureError>>()?;
        budget.exceeded().map_or(Ok(Some(pictures)), |e| Err(too_much(e)))
    }
}

/// Reads a drawing that was written for a filter.
fn tree(svg: &str, budget: &Budget) -> Result<ReadTree, PictureError> {
    count_pixels(budget, Pixel::Decoded, svg.len() as f64).map_err(too_much)?;
    let read = ReadOptions::default().with_turned(Some(Picture::turned));
    read_tree(svg.as_bytes(), "what a filter draws", &read).map_err(|e| e.to_string().into())
}
