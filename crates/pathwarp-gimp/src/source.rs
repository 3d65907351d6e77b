//! A reader that knows its offset: a seekable file, or a decompressed stream that only moves forwards.

use crate::error::{Error, ErrorKind as FormatError};
use std::io::{BufReader, ErrorKind, Read, Seek, SeekFrom};

/// A seekable reader, as a trait object.
pub(crate) trait ReadSeek: Read + Seek {}
impl<T: Read + Seek> ReadSeek for T {}

/// Bytes read into memory at a time.
const CHUNK: usize = 1 << 16;

/// Maximum number of bytes read, not skipped, from compressed data: over a million points. A few kilobytes can unpack to any
/// amount.
const MOST_PACKED: u64 = 1 << 24;

/// Maximum size of text (SVG, JSON, GIMP 1): a hundred times the path data of any real drawing.
const MOST_TEXT: u64 = 1 << 28;

enum Backend<'a> {
    File(BufReader<&'a mut dyn ReadSeek>),
    Stream(BufReader<Box<dyn Read + 'a>>),
}

/// A source of big-endian numbers that knows its offset.
pub(crate) struct ByteSource<'a> {
    backend: Backend<'a>,
    at: u64,
    /// Upper bound for the end of the data.
    pub(crate) end: u64,
    /// Number of bytes that may still be read.
    allowance: u64,
}

impl<'a> ByteSource<'a> {
    /// Reads a file from its start.
    pub(crate) fn file(file: &'a mut dyn ReadSeek) -> Result<Self, Error> {
        let length = |f: &mut dyn ReadSeek| {
            let end = f.seek(SeekFrom::End(0))?;
            f.seek(SeekFrom::Start(0))?;
            Ok(end)
        };
        let end = length(file).map_err(|e: std::io::Error| Error::io(0, &e))?;
        // Most reads are a word followed by a seek, so keep the buffer small.
        Ok(Self { backend: Backend::File(BufReader::with_capacity(1 << 12, file)), at: 0, end, allowance: u64::MAX })
    }

    /// Reads the output of a decoder, at most `most` bytes.
    pub(crate) fn stream(decoder: impl Read + 'a, most: u64) -> Self {
        let backend = Backend::Stream(BufReader::with_capacity(CHUNK, Box::new(decoder)));
        Self { backend, at: 0, end: most, allowance: MOST_PACKED }
    }

    pub(crate) fn at(&self) -> u64 {
        self.at
    }

    pub(crate) fn left(&self) -> u64 {
        self.end.saturating_sub(self.at)
    }

    /// Fills `buffer`; an error at the end of the data names `what`.
    pub(crate) fn bytes(&mut self, buffer: &mut [u8], what: &str) -> Result<(), Error> {
        if self.left() < buffer.len() as u64 {
            let needed = format!("{what} needs {} more bytes", buffer.len());
            return Err(Error::truncated(self.at, &needed, self.left()));
        }
        self.allowance = self.allowance.checked_sub(buffer.len() as u64).ok_or_else(|| {
            let problem = format!(
                "compressed data holds more than {MOST_PACKED} bytes of paths, which is the limit; unpack the file first"
            );
            Error::too_large(self.at, problem)
        })?;
        let read = match &mut self.backend {
            Backend::File(f) => f.read_exact(buffer),
            Backend::Stream(s) => s.read_exact(buffer),
        };
        read.map_err(|e| match e.kind() {
            ErrorKind::UnexpectedEof => {
                Error::new(FormatError::Truncated, self.at, format!("the file ends inside {what}"))
            }
            _ => Error::io(self.at, &e),
        })?;
        self.at += buffer.len() as u64;
        Ok(())
    }

    /// Reads `count` bytes, bounded by those left. Allocates as they arrive.
    pub(crate) fn vec(&mut self, count: u64, what: &str) -> Result<Vec<u8>, Error> {
        if count > self.left() {
            return Err(Error::truncated(self.at, &format!("{what} needs {count} bytes"), self.left()));
        }
        let mut out = Vec::new();
        let mut left = usize::try_from(count).unwrap_or(usize::MAX);
        while left > 0 {
            let from = out.len();
            out.resize(from + left.min(CHUNK), 0);
            self.bytes(&mut out[from..], what)?;
            left -= out.len() - from;
        }
        Ok(out)
    }

    /// Reads everything up to the end as UTF-8.
    pub(crate) fn text(&mut self) -> Result<String, Error> {
        let mut out = Vec::new();
        let read = match &mut self.backend {
            Backend::File(f) => f.take(MOST_TEXT + 1).read_to_end(&mut out),
            Backend::Stream(s) => s.take(MOST_TEXT + 1).read_to_end(&mut out),
        };
        read.map_err(|e| Error::io(self.at, &e))?;
        if out.len() as u64 > MOST_TEXT {
            return Err(Error::too_large(
                MOST_TEXT,
                format!("text of more than {MOST_TEXT} bytes, which is the limit"),
            ));
        }
        self.at += out.len() as u64;
        String::from_utf8(out).map_err(|e| {
            let at = e.utf8_error().valid_up_to() as u64;
            Error::new(FormatError::UnknownFormat, at, "neither an XCF file nor UTF-8 text")
        })
    }

    /// Returns the next `count` bytes, or fewer at the end of the data, without consuming them.
    pub(crate) fn peek(&mut self, count: usize) -> Result<Vec<u8>, Error> {
        let buffer = match &mut self.backend {
            Backend::File(f) => std::io::BufRead::fill_buf(f),
            Backend::Stream(s) => std::io::BufRead::fill_buf(s),
        };
        let buffer = buffer.map_err(|e| Error::io(self.at, &e))?;
        Ok(buffer[..buffer.len().min(count)].to_vec())
    }

    /// Moves to byte `to`; a stream only moves forwards.
    pub(crate) fn seek(&mut self, to: u64, what: &str) -> Result<(), Error> {
        if to > self.end {
            return Err(Error::damaged(
                self.at,
                format!("{what} points to byte {to}, but the file ends at {}", self.end),
            ));
        }
        match &mut self.backend {
            Backend::File(f) => {
                let offset = i64::try_from(to).unwrap_or(i64::MAX) - i64::try_from(self.at).unwrap_or(i64::MAX);
                f.seek_relative(offset).map_err(|e| Error::io(self.at, &e))?;
            }
            Backend::Stream(s) => {
                let Some(count) = to.checked_sub(self.at) else {
                    return Err(Error::damaged(self.at, format!("{what} points backwards to byte {to}")));
                };
                let skipped = std::io::copy(&mut s.take(count), &mut std::io::sink());
                let skipped = skipped.map_err(|e| Error::io(self.at, &e))?;
                if skipped < count {
                    let end = self.at + skipped;
                    return Err(Error::damaged(
                        self.at,
                        format!("{what} points to byte {to}, but the data ends at {end}"),
                    ));
                }
            }
        }
        self.at = to;
        Ok(())
    }

    pub(crate) fn skip(&mut self, count: u64, what: &str) -> Result<(), Error> {
        if count > self.left() {
            return Err(Error::truncated(self.at, &format!("{what} needs {count} bytes"), self.left()));
        }
        self.seek(self.at + count, what)
    }

    pub(crate) fn u8(&mut self, what: &str) -> Result<u8, Error> {
        let mut b = [0; 1];
        self.bytes(&mut b, what)?;
        Ok(b[0])
    }

    pub(crate) fn u32(&mut self, what: &str) -> Result<u32, Error> {
        let mut b = [0; 4];
        self.bytes(&mut b, what)?;
        Ok(u32::from_be_bytes(b))
    }

    pub(crate) fn u64(&mut self, what: &str) -> Result<u64, Error> {
        let mut b = [0; 8];
        self.bytes(&mut b, what)?;
        Ok(u64::from_be_bytes(b))
    }
}
