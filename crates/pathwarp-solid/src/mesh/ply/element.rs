//! A vertex, face or edge of a PLY file.

use ply_rs_bw::ply::{Property, PropertyAccess, PropertyAccessResult};

/// Numbers that a vertex may have, in the order of [`Element::values`]; several names mean the same.
const NAMES: [&[&str]; 12] = [
    &["x"],
    &["y"],
    &["z"],
    &["nx"],
    &["ny"],
    &["nz"],
    &["red", "r", "diffuse_red"],
    &["green", "g", "diffuse_green"],
    &["blue", "b", "diffuse_blue"],
    &["alpha", "a", "diffuse_alpha"],
    &["s", "u", "texture_u"],
    &["t", "v", "texture_v"],
];
/// The places of normals, colours, opacity and texture coordinates among them.
pub(super) const NORMAL: usize = 3;
pub(super) const COLOR: usize = 6;
pub(super) const ALPHA: usize = 9;
pub(super) const UV: usize = 10;

/// The names of the lists of a face's vertices.
pub(super) const INDICES: [&str; 2] = ["vertex_indices", "vertex_index"];
/// And of its texture coordinates.
pub(super) const TEXTURE: &str = "texcoord";
/// The ends of an edge.
pub(super) const ENDS: [&str; 2] = ["vertex1", "vertex2"];

/// The place of a vertex's property among the values.
pub(super) fn place(name: &str) -> Option<usize> {
    NAMES.iter().position(|all| all.contains(&name))
}

/// An element of any kind.
#[derive(Debug, Default)]
pub(super) struct Element {
    /// The numbers of a vertex.
    pub(super) values: [f64; 12],
    /// The vertices of a face or an edge.
    pub(super) indices: Vec<u32>,
    /// u and v for each corner of a face.
    pub(super) uvs: Vec<f32>,
    /// An index is negative or no whole number.
    pub(super) damaged: bool,
}

impl PropertyAccess for Element {
    fn new() -> Self {
        Self::default()
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        let single = match &property {
            Property::Char(v) => Some(f64::from(*v)),
            Property::UChar(v) => Some(f64::from(*v)),
            Property::Short(v) => Some(f64::from(*v)),
            Property::UShort(v) => Some(f64::from(*v)),
            Property::Int(v) => Some(f64::from(*v)),
            Property::UInt(v) => Some(f64::from(*v)),
            Property::Float(v) => Some(f64::from(*v)),
            Property::Double(v) => Some(*v),
            _ => None,
        };
        if let (Some(v), Some(i)) = (single, place(name)) {
            // Whole numbers of eight bits are shares of 255.
            let share = (COLOR..UV).contains(&i) && matches!(property, Property::UChar(_));
            self.values[i] = if share { v / 255.0 } else { v };
        } else if let (Some(v), true) = (single, ENDS.contains(&name)) {
            self.damaged |= v < 0.0 || v.fract() != 0.0;
            // A cast of a number that is too large gives the largest index, which is out of range.
            self.indices.push(v as u32);
        } else if INDICES.contains(&name) {
            self.set_indices(property);
        } else if name == TEXTURE {
            match property {
                Property::ListFloat(v) => self.uvs = v,
                Property::ListDouble(v) => self.uvs = v.into_iter().map(|v| v as f32).collect(),
                _ => return PropertyAccessResult::Ignored,
            }
        } else {
            return PropertyAccessResult::Ignored;
        }
        PropertyAccessResult::Set
    }

    fn get_float(&self, name: &str) -> Option<f32> {
        place(name).map(|i| self.values[i] as f32)
    }

    fn get_double(&self, name: &str) -> Option<f64> {
        place(name).map(|i| self.values[i])
    }

    fn get_uchar(&self, name: &str) -> Option<u8> {
        // A cast saturates.
        place(name).map(|i| (self.values[i] * 255.0).round() as u8)
    }

    fn get_uint(&self, name: &str) -> Option<u32> {
        ENDS.iter().position(|e| *e == name).and_then(|i| self.indices.get(i).copied())
    }

    fn get_list_uint(&self, name: &str) -> Option<&[u32]> {
        INDICES.contains(&name).then_some(&self.indices)
    }
}

impl Element {
    fn set_indices(&mut self, property: Property) {
        let mut bad = false;
        let mut index = |v: Option<u32>| {
            bad |= v.is_none();
            v.unwrap_or(u32::MAX)
        };
        self.indices = match property {
            Property::ListChar(v) => v.into_iter().map(|v| index(u32::try_from(v).ok())).collect(),
            Property::ListUChar(v) => v.into_iter().map(u32::from).collect(),
            Property::ListShort(v) => v.into_iter().map(|v| index(u32::try_from(v).ok())).collect(),
            Property::ListUShort(v) => v.into_iter().map(u32::from).collect(),
            Property::ListInt(v) => v.into_iter().map(|v| index(u32::try_from(v).ok())).collect(),
            Property::ListUInt(v) => v,
            _ => vec![index(None)],
        };
        self.damaged |= bad;
    }
}
