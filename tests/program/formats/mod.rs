//! The extension selects the format: PDF, DXF, JPEG and WebP beside SVG and PNG, read back by programs and parsers that are independent of
//! pathwarp.

mod choice;
mod dxf;
mod dxf_reader;
mod nurbs;
mod page_size;
mod pdf;
mod pictures;
