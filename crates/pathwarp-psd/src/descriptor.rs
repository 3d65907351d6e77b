//! Descriptors: Photoshop's trees of named values (Adobe Photoshop File Formats Specification, *Descriptor structure*).

use crate::Error;
use crate::bytes::Bytes;

/// Descriptors within one another at most.
const MOST_DEPTH: usize = 32;

/// Values by their keys, in file order.
pub(crate) type Items = Vec<(String, Value)>;

/// A value; what no warp needs is read over.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Value {
    Number(f64),
    Numbers(Vec<f64>),
    /// The value of an enumeration.
    Name(String),
    Items(Items),
    Other,
}

/// The value under `key`.
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

    pub(crate) fn name(&self) -> Option<&str> {
        if let Self::Name(n) = self { Some(n) } else { None }
    }

    pub(crate) fn items(&self) -> Option<&Items> {
        if let Self::Items(i) = self { Some(i) } else { None }
    }
}

/// A descriptor: its name and class, then its items.
pub(crate) fn read(b: &mut Bytes<'_>) -> Result<Items, Error> {
    descriptor(b, 0)
}

fn descriptor(b: &mut Bytes<'_>, depth: usize) -> Result<Items, Error> {
    if depth > MOST_DEPTH {
        return Err(b.wrong(format!("descriptors lie more than {MOST_DEPTH} deep in one another")));
    }
    text(b)?;
    id(b)?;
    let count = counted(b)?;
    let mut out = Items::new();
    for _ in 0..count {
        let key = id(b)?;
        let kind = b.tag()?;
        out.push((key, value(b, kind, depth)?));
    }
    Ok(out)
}

/// A number of things, each of which takes bytes of its own.
fn counted(b: &mut Bytes<'_>) -> Result<usize, Error> {
    let n = b.u32()? as usize;
    if n > b.left() { Err(b.wrong(format!("{n} things cannot fit into what is left"))) } else { Ok(n) }
}

/// UTF-16 after its length; the closing zero, if any, goes.
pub(crate) fn text(b: &mut Bytes<'_>) -> Result<String, Error> {
    let n = counted(b)?;
    let bytes = b.take(2 * n)?;
    let units: Vec<u16> = bytes.chunks_exact(2).map(|c| u16::from_be_bytes([c[0], c[1]])).collect();
    Ok(String::from_utf16_lossy(&units).trim_end_matches('\0').to_owned())
}

/// A key: four bytes after a zero, else as long as it says.
fn id(b: &mut Bytes<'_>) -> Result<String, Error> {
    let n = counted(b)?;
    let bytes = b.take(if n == 0 { 4 } else { n })?;
    Ok(String::from_utf8_lossy(bytes).trim_end().to_owned())
}

fn doubles(b: &mut Bytes<'_>) -> Result<Vec<f64>, Error> {
    let n = counted(b)?;
    let mut inside = b.window(8 * n)?;
    (0..n).map(|_| inside.f64()).collect()
}

fn value(b: &mut Bytes<'_>, kind: [u8; 4], depth: usize) -> Result<Value, Error> {
    Ok(match &kind {
        b"doub" => Value::Number(b.f64()?),
        b"UntF" => {
            b.tag()?;
            Value::Number(b.f64()?)
        }
        b"UnFl" => {
            b.tag()?;
            Value::Numbers(doubles(b)?)
        }
        b"long" => Value::Number(f64::from(b.i32()?)),
        b"comp" => {
            b.take(8)?;
            Value::Other
        }
        b"bool" => Value::Number(f64::from(b.u8()?)),
        b"enum" => {
            id(b)?;
            Value::Name(id(b)?)
        }
        b"TEXT" => Value::Name(text(b)?),
        b"Objc" | b"GlbO" => Value::Items(descriptor(b, depth + 1)?),
        b"ObAr" => Value::Items(array(b, depth + 1)?),
        b"VlLs" => {
            if depth > MOST_DEPTH {
                return Err(b.wrong(format!("lists lie more than {MOST_DEPTH} deep in one another")));
            }
            let n = counted(b)?;
            let mut numbers = Vec::new();
            for _ in 0..n {
                let kind = b.tag()?;
                numbers.push(value(b, kind, depth + 1)?.number());
            }
            numbers.into_iter().collect::<Option<Vec<f64>>>().map_or(Value::Other, Value::Numbers)
        }
        b"type" | b"GlbC" => {
            text(b)?;
            id(b)?;
            Value::Other
        }
        b"alis" | b"tdta" | b"Pth " => {
            let n = counted(b)?;
            b.take(n)?;
            Value::Other
        }
        b"obj " => {
            reference(b)?;
            Value::Other
        }
        other => return Err(b.wrong(format!("`{}` is no known kind of value", String::from_utf8_lossy(other)))),
    })
}

/// Many objects of one class, each key with all its values.
fn array(b: &mut Bytes<'_>, depth: usize) -> Result<Items, Error> {
    b.u32()?;
    descriptor(b, depth)
}

fn reference(b: &mut Bytes<'_>) -> Result<(), Error> {
    for _ in 0..counted(b)? {
        let kind = b.tag()?;
        text_and_class(b)?;
        match &kind {
            b"prop" => drop(id(b)?),
            b"Clss" => {}
            b"Enmr" => {
                id(b)?;
                id(b)?;
            }
            b"rele" | b"Idnt" | b"indx" => drop(b.u32()?),
            b"name" => drop(text(b)?),
            other => return Err(b.wrong(format!("`{}` is no known kind of reference", String::from_utf8_lossy(other)))),
        }
    }
    Ok(())
}

fn text_and_class(b: &mut Bytes<'_>) -> Result<(), Error> {
    text(b)?;
    id(b)?;
    Ok(())
}
