//! Drawings read, warped and written.

mod arcs;
mod contour;
mod covers;
mod degenerate_strokes;
mod features;
mod filters;
mod html;
mod keeping;
mod lettering;
mod live;
mod numbers;
mod open_fills;
mod page;
mod patterns;
mod reading;
mod report;
mod seen;
mod strokes;
mod structure;
mod style;
mod themes;
mod united;
mod unsupported;
mod vector_images;
