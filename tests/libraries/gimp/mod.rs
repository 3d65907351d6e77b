//! GIMP's files.

mod seeds;
mod xcf;
