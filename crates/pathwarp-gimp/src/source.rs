//! A reader that knows its offset: a seekable file, or a decompressed stream that only moves forwards.

use crate::error::{Error, ErrorKind as FormatError};
use pathwarp::budget::{Limit, Limits};
use std::io::{BufRead, BufReader, ErrorKind, Read, Seek, SeekFrom};

/// A seekable reader, as a trait object.
pub(crate) trait ReadSeek: Read + Seek {}
impl<T: Read + Seek> ReadSeek for T {}

/// Bytes read into memory at a time.
const CHUNK: usize = 1 << 16;

enum Backend<'a> {
    File(BufReader<&'a mut dyn ReadSeek>),
    Stream(BufReader<Box<dyn Read + 'a>>),
}

impl Backend<'_> {
    fn reader(&mut self) -> &mut dyn BufRead {
        match self {
            Self::File(f) => f,
            Self::Stream(s) => s,
        }
    }
}

/// Returns the length of a file, and rewinds it.
pub(crate) fn length(file: &mut dyn ReadSeek) -> Result<u64, Error> {
    let end = file.seek(SeekFrom::End(0)).and_then(|end| file.seek(SeekFrom::Start(0)).map(|_| end));
    end.map_err(|e| Error::io(0, &e))
}

/// A source of big-endian numbers that knows its offset.
pub(crate) struct ByteSource<'a> {
    backend: Backend<'a>,
    at: u64,
    /// Upper bound for the end of the data.
    pub(crate) end: u64,
    limits: Limits,
    /// Bytes read, not skipped, from compressed data, of which a few kilobytes can unpack to any amount.
    unpacked: u64,
}

impl<'a> ByteSource<'a> {
    /// Reads a file from its start.
    pub(crate) fn file(file: &'a mut dyn ReadSeek, limits: Limits) -> Result<Self, Error> {
        let end = length(file)?;
        // Most reads are a word followed by a seek, so keep the buffer small.
        Ok(Self { backend: Backend::File(BufReader::with_capacity(1 << 12, file)), at: 0, end, limits, unpacked: 0 })
    }

    /// Reads the output of a decoder, up to the limit on bytes.
    pub(crate) fn stream(decoder: impl Read + 'a, limits: Limits) -> Self {
        let backend = Backend::Stream(BufReader::with_capacity(CHUNK, Box::new(decoder)));
        Self { backend, at: 0, end: limits.of(Limit::Bytes) as u64, limits, unpacked: 0 }
    }

    /// Checks that `count` bytes are left. Otherwise returns an error at byte `at` with the clause `needed`. A stream ends at the limit,
    /// unless a length word ends it before.
    pub(crate) fn need(&self, count: u64, at: u64, needed: impl FnOnce() -> String) -> Result<(), Error> {
        if count <= self.left() {
            return Ok(());
        }
        let known = Error::truncated(at, &needed(), self.left());
        let ends_at_limit = self.end == self.limits.of(Limit::Bytes) as u64;
        Err(if ends_at_limit { self.beyond(self.at.saturating_add(count), known) } else { known })
    }

    /// Chooses the error about a byte `to` beyond the end: the limit if a stream exceeds it, else `known`.
    pub(crate) fn beyond(&self, to: u64, known: Error) -> Error {
        match (&self.backend, self.limits.check(Limit::Bytes, to as f64)) {
            (Backend::Stream(_), Err(e)) => Error::too_large(known.offset, "unpacked, the file takes", e.cut_short()),
            _ => known,
        }
    }

    pub(crate) fn offset(&self) -> u64 {
        self.at
    }

    pub(crate) fn left(&self) -> u64 {
        self.end.saturating_sub(self.at)
    }

    /// Fills `buffer`. An error at the end of the data names `what`.
    pub(crate) fn bytes(&mut self, buffer: &mut [u8], what: &str) -> Result<(), Error> {
        self.need(buffer.len() as u64, self.at, || format!("{what} needs {} more bytes", buffer.len()))?;
        if let Backend::Stream(_) = self.backend {
            self.unpacked += buffer.len() as u64;
            self.limits
                .check(Limit::Bytes, self.unpacked as f64)
                .map_err(|e| Error::too_large(self.at, "unpacked, its paths take", e.cut_short()))?;
        }
        self.backend.reader().read_exact(buffer).map_err(|e| match e.kind() {
            ErrorKind::UnexpectedEof => {
                Error::new(FormatError::Truncated, self.at, format!("the file ends inside {what}"))
            }
            _ => Error::io(self.at, &e),
        })?;
        self.at += buffer.len() as u64;
        Ok(())
    }

    /// Reads `count` bytes, after checking that they are left. Allocates memory as they arrive.
    pub(crate) fn vec(&mut self, count: u64, what: &str) -> Result<Vec<u8>, Error> {
        self.need(count, self.at, || format!("{what} needs {count} bytes"))?;
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
        let max = (self.limits.of(Limit::Bytes) as u64).saturating_add(1);
        self.backend.reader().take(max).read_to_end(&mut out).map_err(|e| Error::io(self.at, &e))?;
        self.limits
            .check(Limit::Bytes, out.len() as f64)
            .map_err(|e| Error::too_large(self.at, "its text takes", e.cut_short()))?;
        self.at += out.len() as u64;
        String::from_utf8(out).map_err(|e| {
            let at = e.utf8_error().valid_up_to() as u64;
            Error::new(FormatError::UnknownFormat, at, "neither an XCF file nor UTF-8 text")
        })
    }

    /// Returns the next `count` bytes, or fewer at the end of the data, without consuming them.
    pub(crate) fn peek(&mut self, count: usize) -> Result<Vec<u8>, Error> {
        let buffer = self.backend.reader().fill_buf().map_err(|e| Error::io(self.at, &e))?;
        Ok(buffer[..buffer.len().min(count)].to_vec())
    }

    /// Moves to byte `to`. Streams only move forwards.
    pub(crate) fn seek(&mut self, to: u64, what: &str) -> Result<(), Error> {
        if to > self.end {
            let problem = format!("{what} points to byte {to}, but the file ends at {}", self.end);
            return Err(self.beyond(to, Error::damaged(self.at, problem)));
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
                    let problem = format!("{what} points to byte {to}, but the data ends at {end}");
                    return Err(Error::damaged(self.at, problem));
                }
            }
        }
        self.at = to;
        Ok(())
    }

    pub(crate) fn skip(&mut self, count: u64, what: &str) -> Result<(), Error> {
        if count > self.left() {
            let known = Error::truncated(self.at, &format!("{what} needs {count} bytes"), self.left());
            return Err(self.beyond(self.at.saturating_add(count), known));
        }
        self.seek(self.at + count, what)
    }

    /// Runs `read` on the next `length` bytes alone, the length that the file gives for `owner`.
    pub(crate) fn limited<T>(
        &mut self,
        length: u64,
        owner: &str,
        read: impl FnOnce(&mut Self) -> Result<T, Error>,
    ) -> Result<T, Error> {
        let file_end = self.end;
        let end = self.at.saturating_add(length);
        self.end = end.min(file_end);
        let out = read(self);
        self.end = file_end;
        out.map_err(|mut e| {
            if e.kind == FormatError::Truncated && end < file_end {
                e.problem += &format!(" of the {length} bytes given for {owner}");
            }
            e
        })
    }

    pub(crate) fn array<const N: usize>(&mut self, what: &str) -> Result<[u8; N], Error> {
        let mut bytes = [0; N];
        self.bytes(&mut bytes, what)?;
        Ok(bytes)
    }

    pub(crate) fn u8(&mut self, what: &str) -> Result<u8, Error> {
        self.array(what).map(u8::from_be_bytes)
    }

    pub(crate) fn u32(&mut self, what: &str) -> Result<u32, Error> {
        self.array(what).map(u32::from_be_bytes)
    }

    pub(crate) fn u64(&mut self, what: &str) -> Result<u64, Error> {
        self.array(what).map(u64::from_be_bytes)
    }
}
