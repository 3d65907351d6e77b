//! Formats of bitmaps, told by their first bytes.

/// The first bytes of every PNG file.
pub(crate) const PNG_SIGNATURE: &[u8] = b"\x89PNG\r\n\x1a\n";

/// A format that can be read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Png,
    Jpeg,
    WebP,
    Gif,
}

impl Kind {
    /// The format of a file that starts with these bytes.
    pub(super) fn of(bytes: &[u8]) -> Option<Self> {
        if bytes.starts_with(PNG_SIGNATURE) {
            Some(Self::Png)
        } else if bytes.starts_with(b"\xff\xd8\xff") {
            Some(Self::Jpeg)
        } else if bytes.starts_with(b"RIFF") && bytes.get(8..12) == Some(b"WEBP") {
            Some(Self::WebP)
        } else if bytes.starts_with(b"GIF87a") || bytes.starts_with(b"GIF89a") {
            Some(Self::Gif)
        } else {
            None
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn first_bytes_tell() {
        assert_eq!(Kind::of(b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR"), Some(Kind::Png));
        assert_eq!(Kind::of(b"\xff\xd8\xff\xe0\0\x10JFIF"), Some(Kind::Jpeg));
        assert_eq!(Kind::of(b"RIFF\x1a\0\0\0WEBPVP8L"), Some(Kind::WebP));
        assert_eq!(Kind::of(b"GIF87a\x01\0\x01\0"), Some(Kind::Gif));
        assert_eq!(Kind::of(b"GIF89a\x01\0\x01\0"), Some(Kind::Gif));
        for other in [&b""[..], b"\x89PNG\r\n\x1a", b"\xff\xd8", b"RIFF\x1a\0\0\0WAVE", b"GIF88a", b"BM\0\0\0\0"] {
            assert_eq!(Kind::of(other), None);
        }
    }
}
