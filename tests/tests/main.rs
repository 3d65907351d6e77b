//! The whole program from outside. All of it is one test binary, so that the program's crates are linked once.

mod architecture;
mod c_header;
mod cli;
#[path = "../../crates/pathwarp-svg/tests/common/mod.rs"]
mod common;
mod editor;
mod envelope;
mod filters;
mod formats;
mod gimp;
mod gradient_colors;
mod gradients;
mod guarantee;
mod hostile;
mod inkscape;
mod lettering;
mod oracle;
mod photographs;
mod pictures;
#[cfg(unix)]
mod plugins;
mod presets;
mod recipes;
mod solid;
mod straightened;
mod styles;
mod support;
mod text;
mod text_shapes;
mod watertight;
