//! Deforming and refitting paths, tested from outside against independent measurements.

mod budget;
mod exact;
mod far;
mod few_nodes;
mod figures;
mod folds;
mod hidden;
mod lattice;
mod limits;
mod lines;
mod merge_random;
mod node_figures;
mod nodes;
mod random;
mod refit;
mod repeats;
mod report;
mod shaper;
mod touching;
