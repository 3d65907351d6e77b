//! Bounds-checked reading of big-endian data.

use crate::error::Error;

/// A reader over a window of a file.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ByteReader<'a> {
    data: &'a [u8],
    at: usize,
    /// Offset of the window in the file.
    origin: usize,
}

impl<'a> ByteReader<'a> {
    pub(crate) fn new(data: &'a [u8]) -> Self {
        Self { data, at: 0, origin: 0 }
    }

    pub(crate) fn offset(&self) -> usize {
        self.origin + self.at
    }

    pub(crate) fn left(&self) -> usize {
        self.data.len() - self.at
    }

    pub(crate) fn error(&self, what: impl Into<String>) -> Error {
        Error::Format { at: self.offset(), what: what.into() }
    }

    pub(crate) fn take(&mut self, n: usize) -> Result<&'a [u8], Error> {
        let end = self.at.checked_add(n).filter(|e| *e <= self.data.len());
        let end = end.ok_or_else(|| self.error(format!("the file ends here, but {n} more bytes are needed")))?;
        let out = &self.data[self.at..end];
        self.at = end;
        Ok(out)
    }

    fn array<const N: usize>(&mut self) -> Result<[u8; N], Error> {
        let offset = self.offset();
        let bytes = self.take(N)?;
        bytes.try_into().map_err(|_| Error::Format { at: offset, what: "is cut short".into() })
    }

    pub(crate) fn u8(&mut self) -> Result<u8, Error> {
        self.array().map(u8::from_be_bytes)
    }

    pub(crate) fn u16(&mut self) -> Result<u16, Error> {
        self.array().map(u16::from_be_bytes)
    }

    pub(crate) fn u32(&mut self) -> Result<u32, Error> {
        self.array().map(u32::from_be_bytes)
    }

    pub(crate) fn i32(&mut self) -> Result<i32, Error> {
        self.array().map(i32::from_be_bytes)
    }

    pub(crate) fn f64(&mut self) -> Result<f64, Error> {
        self.array().map(f64::from_be_bytes)
    }

    pub(crate) fn tag(&mut self) -> Result<[u8; 4], Error> {
        self.array()
    }

    /// Reads a length of four bytes, or eight in large documents.
    pub(crate) fn length(&mut self, wide: bool) -> Result<usize, Error> {
        if !wide {
            return Ok(self.u32()? as usize);
        }
        let long = u64::from_be_bytes(self.array()?);
        usize::try_from(long).map_err(|_| self.error("a length is larger than any file"))
    }

    /// Returns a reader over the next `n` bytes.
    pub(crate) fn window(&mut self, n: usize) -> Result<Self, Error> {
        let origin = self.offset();
        Ok(Self { data: self.take(n)?, at: 0, origin })
    }
}
