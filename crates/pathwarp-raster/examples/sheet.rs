//! Renders SVG files to PNG files of the same name: `cargo run --example sheet -- OUT-DIR WIDTH FILE.svg…`.

use pathwarp_raster::{Color, RenderOptions, Size, encode_png};
use std::{error::Error, fs, path::Path, sync::Arc};

fn main() -> Result<(), Box<dyn Error>> {
    let mut args = std::env::args().skip(1);
    let (Some(out), Some(width)) = (args.next(), args.next()) else {
        return Err("usage: sheet OUT-DIR WIDTH FILE.svg…".into());
    };
    let mut options = usvg::Options::default();
    let fonts = Arc::make_mut(&mut options.fontdb);
    fonts.load_font_file(
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../pathwarp-svg/fonts/NotoSans-Regular.subset.ttf"),
    )?;
    fonts.set_sans_serif_family("Noto Sans");
    for file in args {
        let tree = usvg::Tree::from_str(&fs::read_to_string(&file)?, &options)?;
        let render = RenderOptions { size: Size::Width(width.parse()?), background: Some(Color::WHITE) };
        let name = Path::new(&file).file_stem().ok_or("no file name")?;
        fs::write(Path::new(&out).join(name).with_extension("png"), encode_png(&render.render(&tree)?)?)?;
    }
    Ok(())
}
