//! Descriptors: Photoshop's trees of named values (Adobe Photoshop File Formats Specification, *Descriptor structure*).

use thiserror::Error;

/// Maximum nesting of descriptors.
const MAX_DEPTH: usize = 32;

/// Values with their keys, in file order.
pub(crate) type Items = Vec<(String, Value)>;

/// A value. Kinds that no warp needs are skipped.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Value {
    Number(f64),
    Numbers(Vec<f64>),
    /// The value of an enumeration, or a text.
    Word(String),
    Items(Items),
    Other,
}

/// Returns the value of a key.
pub(crate) fn get<'a>(items: &'a Items, key: &str) -> Option<&'a Value> {
    items.iter().find(|(k, _)| k == key).map(|v| &v.1)
}

impl Value {
    pub(crate) fn number(&self) -> Option<f64> {
        if let Self::Number(n) = self { Some(*n) } else { None }
    }

    pub(crate) fn numbers(&self) -> Option<&[f64]> {
        if let Self::Numbers(n) = self { Some(n) } else { None }
    }

    pub(crate) fn word(&self) -> Option<&str> {
        if let Self::Word(w) = self { Some(w) } else { None }
    }

    pub(crate) fn items(&self) -> Option<&Items> {
        if let Self::Items(i) = self { Some(i) } else { None }
    }
}

/// Reads a descriptor: its name and class, then its items.
pub(crate) fn read(input: &mut ByteReader<'_>) -> Result<Items, Error> {
    descriptor(input, 0)
}

fn descriptor(input: &mut ByteReader<'_>, depth: usize) -> Result<Items, Error> {
    if depth > MAX_DEPTH {
        return Err(input.error(format!("descriptors are nested more than {MAX_DEPTH} deep")));
    }
    text_and_class(input)?;
    let mut out = Items::new();
    for _ in 0..count(input)? {
        let name = key(input)?;
        let kind = input.tag()?;
        out.push((name, value(input, kind, depth)?));
    }
    Ok(out)
}

/// Reads a number of elements that take at least a byte each.
fn count(input: &mut ByteReader<'_>) -> Result<usize, Error> {
    let n = input.u32()? as usize;
    if n > input.left() { Err(input.error(format!("{n} elements do not fit into the bytes left"))) } else { Ok(n) }
}

/// Reads UTF-16 with its length, without a final zero.
pub(crate) fn text(input: &mut ByteReader<'_>) -> Result<String, Error> {
    let n = count(input)?;
    let bytes = input.take(2 * n)?;
    let units: Vec<u16> = bytes.as_chunks().0.iter().map(|c| u16::from_be_bytes(*c)).collect();
    Ok(String::from_utf16_lossy(&units).trim_end_matches('\0').to_owned())
}

/// Reads a key: four bytes if its length word is zero, else that many bytes.
fn key(input: &mut ByteReader<'_>) -> Result<String, Error> {
    let n = count(input)?;
    let bytes = input.take(if n == 0 { 4 } else { n })?;
    Ok(String::from_utf8_lossy(bytes).trim_end().to_owned())
}

fn doubles(input: &mut ByteReader<'_>) -> Result<Vec<f64>, Error> {
    let n = count(input)?;
    let mut numbers = input.window(8 * n)?;
    (0..n).map(|_| numbers.f64()).collect()
}

fn value(input: &mut ByteReader<'_>, kind: [u8; 4], depth: usize) -> Result<Value, Error> {
    Ok(match &kind {
        b"doub" => Value::Number(input.f64()?),
        // The tag is the unit.
        b"UntF" => {
            input.tag()?;
            Value::Number(input.f64()?)
        }
        b"UnFl" => {
            input.tag()?;
            Value::Numbers(doubles(input)?)
        }
        b"long" => Value::Number(f64::from(input.i32()?)),
        b"comp" => input.take(8).map(|_| Value::Other)?,
        b"bool" => Value::Number(f64::from(input.u8()?)),
        b"enum" => {
            key(input)?;
            Value::Word(key(input)?)
        }
        b"TEXT" => Value::Word(text(input)?),
        b"Objc" | b"GlbO" => Value::Items(descriptor(input, depth + 1)?),
        // Objects of one class: their number, and a descriptor with the values of all of them for each key.
        b"ObAr" => {
            input.u32()?;
            Value::Items(descriptor(input, depth + 1)?)
        }
        b"VlLs" => {
            if depth > MAX_DEPTH {
                return Err(input.error(format!("lists are nested more than {MAX_DEPTH} deep")));
            }
            let n = count(input)?;
            let mut numbers = Vec::new();
            for _ in 0..n {
                let kind = input.tag()?;
                numbers.push(value(input, kind, depth + 1)?.number());
            }
            numbers.into_iter().collect::<Option<Vec<f64>>>().map_or(Value::Other, Value::Numbers)
        }
        b"type" | b"GlbC" => text_and_class(input).map(|()| Value::Other)?,
        b"alis" | b"tdta" | b"Pth " => {
            let n = count(input)?;
            input.take(n)?;
            Value::Other
        }
        b"obj " => reference(input).map(|()| Value::Other)?,
        other => return Err(input.error(format!("unknown type of value `{}`", String::from_utf8_lossy(other)))),
    })
}

fn reference(input: &mut ByteReader<'_>) -> Result<(), Error> {
    for _ in 0..count(input)? {
        let kind = input.tag()?;
        text_and_class(input)?;
        match &kind {
            b"prop" => drop(key(input)?),
            b"Clss" => {}
            b"Enmr" => {
                key(input)?;
                key(input)?;
            }
            b"rele" | b"Idnt" | b"indx" => drop(input.u32()?),
            b"name" => drop(text(input)?),
            other => return Err(input.error(format!("unknown type of reference `{}`", String::from_utf8_lossy(other)))),
        }
    }
    Ok(())
}

fn text_and_class(input: &mut ByteReader<'_>) -> Result<(), Error> {
    text(input)?;
    key(input).map(drop)
}

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

/// The reason why a file cannot be read.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum Error {
    /// The file has no Photoshop header.
    #[error("not a Photoshop file (PSD or PSB)")]
    NotPsd,
    /// The file breaks its format.
    #[error("byte {at}: {what}")]
    Format {
        /// Offset in bytes.
        at: usize,
        /// Description of the problem.
        what: String,
    },
}
