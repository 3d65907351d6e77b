//! Bytes with a place: a file that is sought in, or packed data that only runs forwards.

use crate::error::Error;
use std::io::{BufReader, ErrorKind, Read, Seek, SeekFrom};

/// Something that can be read anywhere.
pub(crate) trait ReadSeek: Read + Seek {}
impl<T: Read + Seek> ReadSeek for T {}

/// Path data that is taken into memory at a time.
const CHUNK: usize = 1 << 16;

/// The most that is read (not passed over) of packed data: over a million points. A few kilobytes can unpack to any amount.
const MOST_PACKED: u64 = 1 << 24;

/// As much text (SVG, JSON, GIMP 1) as is read: a hundred times the path data of any real drawing.
const MOST_TEXT: u64 = 1 << 28;

enum Source<'a> {
    File(BufReader<&'a mut dyn ReadSeek>),
    Stream(BufReader<Box<dyn Read + 'a>>),
}

/// A source of big-endian numbers that knows where it is.
pub(crate) struct Input<'a> {
    source: Source<'a>,
    at: u64,
    /// Where the data ends at the latest.
    pub(crate) end: u64,
    /// How many bytes may still be read.
    allowance: u64,
}

impl<'a> Input<'a> {
    /// A file, from its start.
    pub(crate) fn file(file: &'a mut dyn ReadSeek) -> Result<Self, Error> {
        let length = |f: &mut dyn ReadSeek| {
            let end = f.seek(SeekFrom::End(0))?;
            f.seek(SeekFrom::Start(0))?;
            Ok(end)
        };
        let end = length(file).map_err(|e: std::io::Error| unreadable(0, &e))?;
        // A small buffer: most reads are a word, then a leap.
        Ok(Self { source: Source::File(BufReader::with_capacity(1 << 12, file)), at: 0, end, allowance: u64::MAX })
    }

    /// What a decoder gives, at most `most` bytes.
    pub(crate) fn stream(decoder: impl Read + 'a, most: u64) -> Self {
        let source = Source::Stream(BufReader::with_capacity(CHUNK, Box::new(decoder)));
        Self { source, at: 0, end: most, allowance: MOST_PACKED }
    }

    pub(crate) fn at(&self) -> u64 {
        self.at
    }

    pub(crate) fn left(&self) -> u64 {
        self.end.saturating_sub(self.at)
    }

    /// Fills `buffer` or says that the file ends inside `what`.
    pub(crate) fn bytes(&mut self, buffer: &mut [u8], what: &str) -> Result<(), Error> {
        if self.left() < buffer.len() as u64 {
            let needed = format!("{what}: {} bytes must follow here", buffer.len());
            return Err(Error::short(self.at, &needed, self.left()));
        }
        self.allowance = self.allowance.checked_sub(buffer.len() as u64).ok_or_else(|| {
            let problem = format!(
                "more than {MOST_PACKED} bytes of paths in packed data; that is more than is read: unpack it first"
            );
            Error::at(self.at, problem)
        })?;
        let read = match &mut self.source {
            Source::File(f) => f.read_exact(buffer),
            Source::Stream(s) => s.read_exact(buffer),
        };
        read.map_err(|e| match e.kind() {
            ErrorKind::UnexpectedEof => Error::at(self.at, format!("the file ends inside {what}")),
            _ => unreadable(self.at, &e),
        })?;
        self.at += buffer.len() as u64;
        Ok(())
    }

    /// `count` bytes, bounded by what is left; memory is taken as the bytes arrive.
    pub(crate) fn vec(&mut self, count: u64, what: &str) -> Result<Vec<u8>, Error> {
        if count > self.left() {
            return Err(Error::short(self.at, &format!("{what} of {count} bytes"), self.left()));
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

    /// Everything up to the end, as text.
    pub(crate) fn text(&mut self) -> Result<String, Error> {
        let mut out = Vec::new();
        let read = match &mut self.source {
            Source::File(f) => f.take(MOST_TEXT + 1).read_to_end(&mut out),
            Source::Stream(s) => s.take(MOST_TEXT + 1).read_to_end(&mut out),
        };
        read.map_err(|e| unreadable(self.at, &e))?;
        if out.len() as u64 > MOST_TEXT {
            return Err(Error::at(
                MOST_TEXT,
                format!("more than {MOST_TEXT} bytes of text; that is more than is read"),
            ));
        }
        self.at += out.len() as u64;
        String::from_utf8(out).map_err(|e| {
            let at = e.utf8_error().valid_up_to() as u64;
            Error::at(at, "this is neither an XCF file nor UTF-8 text")
        })
    }

    /// The first `count` bytes, or fewer if there are no more; the input stays at its start.
    pub(crate) fn peek(&mut self, count: usize) -> Result<Vec<u8>, Error> {
        let buffer = match &mut self.source {
            Source::File(f) => std::io::BufRead::fill_buf(f),
            Source::Stream(s) => std::io::BufRead::fill_buf(s),
        };
        let buffer = buffer.map_err(|e| unreadable(self.at, &e))?;
        Ok(buffer[..buffer.len().min(count)].to_vec())
    }

    /// Goes on at byte `to`; a stream only forwards.
    pub(crate) fn go(&mut self, to: u64, what: &str) -> Result<(), Error> {
        if to > self.end {
            return Err(Error::at(self.at, format!("{what} leads to byte {to}, but the file ends at {}", self.end)));
        }
        match &mut self.source {
            Source::File(f) => {
                let leap = i64::try_from(to).unwrap_or(i64::MAX) - i64::try_from(self.at).unwrap_or(i64::MAX);
                f.seek_relative(leap).map_err(|e| unreadable(self.at, &e))?;
            }
            Source::Stream(s) => {
                let Some(count) = to.checked_sub(self.at) else {
                    return Err(Error::at(self.at, format!("{what} leads backwards, to byte {to}")));
                };
                let passed = std::io::copy(&mut s.take(count), &mut std::io::sink());
                let passed = passed.map_err(|e| unreadable(self.at, &e))?;
                if passed < count {
                    let end = self.at + passed;
                    return Err(Error::at(self.at, format!("{what} leads to byte {to}, but the data ends at {end}")));
                }
            }
        }
        self.at = to;
        Ok(())
    }

    pub(crate) fn skip(&mut self, count: u64, what: &str) -> Result<(), Error> {
        if count > self.left() {
            return Err(Error::short(self.at, &format!("{what} of {count} bytes"), self.left()));
        }
        self.go(self.at + count, what)
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

fn unreadable(at: u64, e: &std::io::Error) -> Error {
    Error::at(at, format!("cannot be read: {e}"))
}
