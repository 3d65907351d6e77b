//! Reads and writes photographs, with orientation, colour profile and EXIF metadata.

mod bitmap;
mod decode;
mod encode;
mod exif;
mod gif;
mod jpeg;
mod orientation;
mod png;
mod webp;

use crate::error::Error;
use crate::picture::bitmap::Kind;
use crate::picture::jpeg::Compression;
use crate::picture::orientation::Orientation;
use pathwarp::budget::Limits;
use tiny_skia::Pixmap;

pub use bitmap::EarlyEnd;
pub(crate) use bitmap::PNG_SIGNATURE;
pub use decode::header_size;
pub use encode::PictureFormat;

/// A bitmap with its colour profile and metadata.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    /// The pixels.
    pub pixmap: Pixmap,
    /// The ICC profile of the file; `None` for sRGB. One for other colours than RGB does not fit the pixels and is not written.
    pub profile: Option<Vec<u8>>,
    /// The EXIF metadata as the file has them, starting with the header of TIFF.
    pub exif: Option<Vec<u8>>,
    /// The extent of the picture in the file, if that ends early.
    pub early_end: Option<EarlyEnd>,
}

impl From<Pixmap> for Picture {
    fn from(pixmap: Pixmap) -> Self {
        Self { pixmap, profile: None, exif: None, early_end: None }
    }
}

impl Picture {
    /// Returns `true` if the bytes start like a PNG, JPEG or WebP file.
    #[must_use]
    pub fn sniff(bytes: &[u8]) -> bool {
        matches!(Kind::sniff(bytes), Some(Kind::Png | Kind::Jpeg | Kind::WebP))
    }

    /// Reads a PNG, JPEG or WebP and applies its EXIF orientation.
    ///
    /// # Errors
    /// [`Error::Decode`] for other and damaged files; [`Error::TooLarge`] above the default limits, before any memory is
    /// allocated for the pixels.
    pub fn read(bytes: &[u8]) -> Result<Self, Error> {
        Self::read_within(bytes, &Limits::default().for_input(bytes.len()))
    }

    /// Reads a PNG, JPEG or WebP within limits and applies its EXIF orientation.
    ///
    /// # Errors
    /// [`Error::Decode`] for other and damaged files; [`Error::TooLarge`] above the limits.
    pub fn read_within(bytes: &[u8], limits: &Limits) -> Result<Self, Error> {
        if !Self::sniff(bytes) {
            return Err(Error::Decode("neither a PNG nor a JPEG nor a WebP".to_owned()));
        }
        decode::decode(bytes, true, limits)
    }

    /// Reads an image of a drawing (PNG, JPEG, GIF or WebP) as it is stored, without applying its orientation. Takes the first image of an
    /// animation.
    ///
    /// # Errors
    /// [`Error::Decode`] for other and damaged files; [`Error::TooLarge`] above the default limits.
    pub fn read_stored(bytes: &[u8]) -> Result<Self, Error> {
        Self::read_stored_within(bytes, &Limits::default().for_input(bytes.len()))
    }

    /// Reads an image of a drawing as it is stored, within limits.
    ///
    /// # Errors
    /// [`Error::Decode`] for other and damaged files; [`Error::TooLarge`] above the limits.
    pub fn read_stored_within(bytes: &[u8], limits: &Limits) -> Result<Self, Error> {
        decode::decode(bytes, false, limits)
    }

    /// Returns `true` if the EXIF metadata of a PNG, JPEG or WebP ask to turn its pixels. Decodes no pixels.
    #[must_use]
    pub fn is_turned(bytes: &[u8], limits: &Limits) -> bool {
        Self::sniff(bytes) && decode::orientation(bytes, limits) != Orientation::default()
    }

    /// Returns `true` if the bytes are a JPEG in CMYK, which is read as RGB.
    #[must_use]
    pub fn is_of_inks(bytes: &[u8]) -> bool {
        Compression::read(bytes).is_some_and(|c| c.components == 4)
    }

    /// Turns the pixels of an image of a drawing as browsers do if its EXIF metadata ask for it. `None` if they do not, if it is neither a
    /// JPEG nor a PNG, or if it cannot be read within the limits.
    #[must_use]
    pub fn turned(bytes: &[u8], limits: &Limits) -> Option<Vec<u8>> {
        let is_turned = matches!(Kind::sniff(bytes)?, Kind::Jpeg | Kind::Png) && Self::is_turned(bytes, limits);
        is_turned.then(|| Self::read_within(bytes, limits).ok()?.write_like(bytes).ok())?
    }

    /// Gives an image of a drawing the size at which browsers show it. In a JPEG only the header changes, and a second call restores it;
    /// others are [`turned`](Self::turned). [`Picture::read_sized_within`] reads the result.
    #[must_use]
    pub fn sized(bytes: &[u8], limits: &Limits) -> Option<Vec<u8>> {
        if Kind::sniff(bytes) != Some(Kind::Jpeg) {
            return Self::turned(bytes, limits);
        }
        decode::orientation(bytes, limits).transpose.then(|| jpeg::with_sides_exchanged(bytes))?
    }

    /// Reads an image of a drawing as browsers show it, from the result of [`Picture::sized`], or from the image where that is `None`.
    ///
    /// # Errors
    /// [`Error::Decode`] for other and damaged files; [`Error::TooLarge`] above the limits.
    pub fn read_sized_within(bytes: &[u8], limits: &Limits) -> Result<Self, Error> {
        if Kind::sniff(bytes) != Some(Kind::Jpeg) || !Self::is_turned(bytes, limits) {
            return Self::read_stored_within(bytes, limits);
        }
        decode::decode(Self::sized(bytes, limits).as_deref().unwrap_or(bytes), true, limits)
    }

    /// A picture of new pixels made from this one, with its colour profile, if that fits, and its EXIF metadata, if they are sound,
    /// adapted to the new size and upright pixels. They lack the thumbnail and, unless `keep_location`, the geographic position.
    #[must_use]
    pub fn remade(&self, pixmap: Pixmap, keep_location: bool) -> Self {
        let size = (pixmap.width(), pixmap.height());
        let exif = self.exif.as_deref().and_then(|e| exif::edited(e, size, keep_location));
        Self { profile: self.profile_of_pixels().map(<[u8]>::to_vec), exif, ..Self::from(pixmap) }
    }

    /// The profile, if it is for RGB like the pixels.
    fn profile_of_pixels(&self) -> Option<&[u8]> {
        // ICC.1:2022, 7.2: the colour space, and a signature.
        let is_other = |p: &[u8]| p.get(36..40) == Some(b"acsp") && p.get(16..20) != Some(b"RGB ");
        self.profile.as_deref().filter(|p| !p.is_empty() && !is_other(p))
    }

    /// Encodes the picture as an image of a drawing whose pixels come from `source`. If that is a JPEG, the result is one with the same
    /// quantization tables, on white where it is transparent; else it is a PNG. It has no EXIF metadata.
    ///
    /// # Errors
    /// [`Error::Encode`] when the encoder fails, as for a JPEG with a side of more than 65535 pixels.
    pub fn write_like(&self, source: &[u8]) -> Result<Vec<u8>, Error> {
        match Compression::read(source) {
            Some(like) => encode::encode_like(&like, &self.pixmap, self.profile_of_pixels()),
            None => encode::encode(&self.pixmap, self.profile_of_pixels(), None, PictureFormat::Png),
        }
    }

    /// Encodes the picture.
    ///
    /// # Errors
    /// [`Error::Encode`] when the encoder fails, as for a JPEG with a side of more than 65535 pixels.
    pub fn write(&self, format: PictureFormat) -> Result<Vec<u8>, Error> {
        encode::encode(&self.pixmap, self.profile_of_pixels(), self.exif.as_deref(), format)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tiny_skia::ColorU8;

    fn half_red() -> Picture {
        let mut pixmap = Pixmap::new(16, 8).unwrap();
        for (i, p) in pixmap.pixels_mut().iter_mut().enumerate() {
            *p = ColorU8::from_rgba(255, 0, 0, if i % 16 < 8 { 255 } else { 0 }).premultiply();
        }
        Picture { profile: Some(b"a profile".to_vec()), ..Picture::from(pixmap) }
    }

    const JPEG: PictureFormat = PictureFormat::Jpeg { quality: PictureFormat::QUALITY };

    #[test]
    fn png_and_webp_are_lossless() {
        for (format, signature) in [(PictureFormat::Png, b"\x89PNG"), (PictureFormat::WebP, b"RIFF")] {
            let bytes = half_red().write(format).unwrap();
            assert!(bytes.starts_with(signature) && Picture::sniff(&bytes));
            assert_eq!(Picture::read(&bytes).unwrap(), half_red(), "{format:?}");
        }
    }

    #[test]
    fn a_lower_quality_is_smaller() {
        let size = |quality| half_red().write(PictureFormat::Jpeg { quality }).unwrap().len();
        assert!(size(1) < size(50) && size(50) < size(100));
    }

    #[test]
    fn jpeg_is_on_white() {
        let bytes = half_red().write(JPEG).unwrap();
        assert!(Picture::sniff(&bytes));
        let back = Picture::read(&bytes).unwrap();
        let at = |x| back.pixmap.pixel(x, 4).unwrap();
        assert!(at(2).red() > 240 && at(2).green() < 20 && at(13).green() > 240);
        assert_eq!(back.profile, half_red().profile);
    }

    /// The tables come through, in the order in which a file has them, however the source samples its colours.
    #[test]
    fn another_jpeg_is_as_coarse() {
        let photo = half_red();
        let samples: Vec<u8> = photo.pixmap.pixels().iter().flat_map(|p| [p.red(), p.green(), p.blue()]).collect();
        let table = |of: u16| Box::new(std::array::from_fn(|i| 2 + of * i as u16));
        for (across, down) in [(1, 1), (2, 1), (1, 2), (2, 2)] {
            let mut source = Vec::new();
            let mut encoder = jpeg_encoder::Encoder::new(&mut source, 90);
            let custom = [table(1), table(3)].map(jpeg_encoder::QuantizationTableType::Custom);
            encoder.set_quantization_tables(custom[0].clone(), custom[1].clone());
            encoder.set_sampling_factor(jpeg_encoder::SamplingFactor::from_factors(across, down).unwrap());
            encoder.encode(&samples, 16, 8, jpeg_encoder::ColorType::Rgb).unwrap();
            let written = photo.write_like(&source).unwrap();
            let back = Picture::read(&written).unwrap().pixmap;
            let [red, white] = [2, 13].map(|x| back.pixel(x, 4).unwrap());
            assert!(red.red() > 200 && red.green() < 60 && red.blue() < 60, "{across} x {down}: {red:?}");
            assert!(white.green() > 200 && white.blue() > 200, "{across} x {down}: {white:?}");
            let like = Compression::read(&written).unwrap();
            assert_eq!((like.tables, like.components), ([*table(1), *table(3)], 3));
        }
        let mut grey = Vec::new();
        let luma: Vec<u8> = samples.iter().step_by(3).copied().collect();
        jpeg_encoder::Encoder::new(&mut grey, 50).encode(&luma, 16, 8, jpeg_encoder::ColorType::Luma).unwrap();
        let like = photo.write_like(&grey).unwrap();
        assert_eq!(Compression::read(&like).unwrap().components, 1);
        assert_eq!(Compression::read(&like).unwrap().tables, Compression::read(&grey).unwrap().tables);
        // Files that end early or have no tables are written as PNG.
        for end in [0, 3, 30] {
            assert!(photo.write_like(&grey[..end]).unwrap().starts_with(PNG_SIGNATURE), "{end}");
        }
    }

    #[test]
    fn orientation_is_applied() {
        let mut bytes = half_red().write(JPEG).unwrap();
        // Add an APP1 segment with orientation (0x0112) = 6: the first row is the right side.
        let exif = b"\xff\xe1\x00\x22Exif\0\0MM\0\x2a\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0\x06\0\0\0\0\0\0";
        bytes.splice(2..2, exif.iter().copied());
        let back = Picture::read(&bytes).unwrap().pixmap;
        assert_eq!((back.width(), back.height()), (8, 16));
        assert!(back.pixel(4, 2).unwrap().green() < 20 && back.pixel(4, 13).unwrap().green() > 240);
    }

    #[test]
    fn images_are_turned_as_browsers_do() {
        // A TIFF header, and a directory with the orientation alone.
        let exif =
            |n: u8| [&b"MM\0\x2a\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0"[..], &[n, 0, 0, 0, 0, 0, 0]].concat();
        let picture = half_red();
        let [width, height] = [picture.pixmap.width(), picture.pixmap.height()];
        for (format, turns) in [
            (PictureFormat::Png, true),
            (PictureFormat::Jpeg { quality: PictureFormat::QUALITY }, true),
            (PictureFormat::WebP, false),
        ] {
            let limits = Limits::default();
            let with = |n| Picture { exif: Some(exif(n)), ..picture.clone() }.write(format).unwrap();
            assert_eq!(Picture::turned(&with(1), &limits), None);
            let file = with(6);
            let turned = Picture::turned(&file, &limits);
            let size = turned.as_deref().map(|file| header_size(file).unwrap());
            assert_eq!(size, turns.then_some((height, width)));
            assert_eq!(turned.and_then(|file| Picture::turned(&file, &limits)), None);
            let sized = Picture::sized(&file, &limits);
            assert_eq!(sized.as_deref().map(|file| header_size(file).unwrap()), turns.then_some((height, width)));
            let sized = sized.unwrap_or_else(|| file.clone());
            let shown = if turns { Picture::read(&file) } else { Picture::read_stored(&file) };
            assert_eq!(Picture::read_sized_within(&sized, &limits).unwrap().pixmap, shown.unwrap().pixmap);
            let again = Picture::sized(&sized, &limits);
            assert_eq!(again, matches!(format, PictureFormat::Jpeg { .. }).then_some(file));
        }
    }

    #[test]
    fn damaged_files_are_errors() {
        for format in [PictureFormat::Png, JPEG, PictureFormat::WebP] {
            let bytes = half_red().write(format).unwrap();
            for end in [0, 3, 9, 20, 60] {
                assert!(matches!(Picture::read(&bytes[..end]), Err(Error::Decode(_))), "{format:?} {end}");
            }
        }
    }
}
