//! Numbers in the buffers of a glTF file, every access checked.

use crate::mesh::error::MeshError;
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use gltf::accessor::{DataType, Dimensions};
use gltf::buffer::{Source, View};
use gltf::{Accessor, Gltf};

/// The bytes of all buffers.
pub(super) struct Buffers(Vec<Vec<u8>>);

impl Buffers {
    /// # Errors
    /// A buffer outside the file, or one that is shorter than announced.
    pub(super) fn of(file: &mut Gltf) -> Result<Self, MeshError> {
        let mut blob = file.blob.take();
        let mut out = Vec::new();
        for (i, buffer) in file.document.buffers().enumerate() {
            let bytes = match buffer.source() {
                Source::Bin => blob.take().ok_or_else(|| MeshError::whole(format!("buffer {i} is missing")))?,
                Source::Uri(uri) => inside(uri).map_err(|e| MeshError::whole(format!("buffer {i} {e}")))?,
            };
            if bytes.len() < buffer.length() {
                let (have, want) = (bytes.len(), buffer.length());
                return Err(MeshError::whole(format!("buffer {i} has {have} bytes, and announces {want}")));
            }
            out.push(bytes);
        }
        Ok(Self(out))
    }

    /// The bytes of a view.
    pub(super) fn view(&self, view: &View<'_>) -> Option<&[u8]> {
        let end = view.offset().checked_add(view.length())?;
        self.0.get(view.buffer().index())?.get(view.offset()..end)
    }

    /// The numbers of an accessor, `N` at a time; fewer components are followed by zeros.
    pub(super) fn floats<const N: usize>(&self, accessor: &Accessor<'_>) -> Result<Vec<[f64; N]>, MeshError> {
        let normalized = accessor.normalized();
        let mut out = Vec::new();
        self.each(accessor, |numbers| {
            let mut item = [0.0; N];
            item.iter_mut().zip(numbers).for_each(|(o, v)| *o = v.float(normalized));
            out.push(item);
        })?;
        Ok(out)
    }

    /// The indices of an accessor.
    pub(super) fn indices(&self, accessor: &Accessor<'_>) -> Result<Vec<u32>, MeshError> {
        let mut out = Vec::new();
        self.each(accessor, |numbers| out.extend(numbers.first().map(Number::index)))?;
        Ok(out)
    }

    /// Calls `f` with the components of every item.
    fn each(&self, accessor: &Accessor<'_>, mut f: impl FnMut(&[Number])) -> Result<(), MeshError> {
        let wrong = |what: &str| MeshError::whole(format!("accessor {} {what}", accessor.index()));
        if accessor.sparse().is_some() {
            return Err(wrong("is sparse, which is not read; save the model without sparse accessors"));
        }
        let view = accessor.view().ok_or_else(|| wrong("has no data"))?;
        let bytes = self.view(&view).ok_or_else(|| wrong("is outside its buffer"))?;
        let components = match accessor.dimensions() {
            Dimensions::Scalar => 1,
            Dimensions::Vec2 => 2,
            Dimensions::Vec3 => 3,
            Dimensions::Vec4 => 4,
            _ => return Err(wrong("holds matrices")),
        };
        let (kind, size) = (accessor.data_type(), accessor.size());
        let stride = view.stride().unwrap_or(size).max(size);
        // The last item ends within the view.
        let last = accessor.count().checked_sub(1).and_then(|n| n.checked_mul(stride));
        let end = last.and_then(|n| n.checked_add(accessor.offset())).and_then(|n| n.checked_add(size));
        if accessor.count() > 0 && end.is_none_or(|end| end > bytes.len()) {
            return Err(wrong(&format!("announces {} items, and its data ends before", accessor.count())));
        }
        let mut numbers = [Number::U8(0); 4];
        for i in 0..accessor.count() {
            let start = accessor.offset() + i * stride;
            let item = &bytes[start..start + size];
            for (n, part) in numbers.iter_mut().zip(item.chunks_exact(size / components)) {
                *n = Number::read(kind, part).ok_or_else(|| wrong("is damaged"))?;
            }
            f(&numbers[..components]);
        }
        Ok(())
    }
}

/// A number as stored.
#[derive(Clone, Copy)]
enum Number {
    I8(i8),
    U8(u8),
    I16(i16),
    U16(u16),
    U32(u32),
    F32(f32),
}

impl Number {
    fn read(kind: DataType, bytes: &[u8]) -> Option<Self> {
        Some(match kind {
            DataType::I8 => Self::I8(i8::from_le_bytes(bytes.try_into().ok()?)),
            DataType::U8 => Self::U8(u8::from_le_bytes(bytes.try_into().ok()?)),
            DataType::I16 => Self::I16(i16::from_le_bytes(bytes.try_into().ok()?)),
            DataType::U16 => Self::U16(u16::from_le_bytes(bytes.try_into().ok()?)),
            DataType::U32 => Self::U32(u32::from_le_bytes(bytes.try_into().ok()?)),
            DataType::F32 => Self::F32(f32::from_le_bytes(bytes.try_into().ok()?)),
        })
    }

    /// The value; normalized whole numbers are shares of their largest.
    fn float(self, normalized: bool) -> f64 {
        let (value, largest) = match self {
            Self::I8(v) => (f64::from(v), f64::from(i8::MAX)),
            Self::U8(v) => (f64::from(v), f64::from(u8::MAX)),
            Self::I16(v) => (f64::from(v), f64::from(i16::MAX)),
            Self::U16(v) => (f64::from(v), f64::from(u16::MAX)),
            Self::U32(v) => (f64::from(v), f64::from(u32::MAX)),
            Self::F32(v) => return f64::from(v),
        };
        if normalized { (value / largest).max(-1.0) } else { value }
    }

    /// The value as an index; one that is none is out of range.
    fn index(&self) -> u32 {
        match self {
            Self::U8(v) => u32::from(*v),
            Self::U16(v) => u32::from(*v),
            Self::U32(v) => *v,
            Self::I8(_) | Self::I16(_) | Self::F32(_) => u32::MAX,
        }
    }
}

/// The bytes of a data URI.
fn inside(uri: &str) -> Result<Vec<u8>, String> {
    let shown: String = uri.chars().take(60).collect();
    let outside =
        || format!("is outside the file (`{shown}`), and only the file itself is read; save the model as .glb");
    let (_, data) = uri.strip_prefix("data:").and_then(|rest| rest.split_once(";base64,")).ok_or_else(outside)?;
    STANDARD.decode(data).map_err(|e| format!("is damaged: {e}"))
}
