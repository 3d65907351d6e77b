//! A primitive of a glTF mesh: its vertices in the scene's coordinates, its faces, lines or points.

use super::accessor::Buffers;
use crate::mesh::error::MeshError;
use crate::mesh::model::{Corner, Mesh, NONE, PolygonKind};
use glam::{DMat3, DMat4, DVec3};
use gltf::Primitive;
use gltf::mesh::{Mode, Semantic};
use std::collections::BTreeSet;

/// Appends a primitive. `lost` collects what is left out.
pub(super) fn append(
    mesh: &mut Mesh,
    primitive: &Primitive<'_>,
    to_scene: &DMat4,
    buffers: &Buffers,
    lost: &mut BTreeSet<String>,
) -> Result<(), MeshError> {
    let Some(positions) = primitive.get(&Semantic::Positions) else {
        lost.insert("primitives without positions".into());
        return Ok(());
    };
    let count = positions.count();
    let own = buffers.floats::<3>(&positions)?;
    let first = mesh.positions.len();
    for p in own {
        let p = to_scene.transform_point3(DVec3::from_array(p));
        // The square of a larger number overflows.
        if p.abs().max_element().is_nan() || p.abs().max_element() > 1e100 {
            return Err(MeshError::whole(format!("a vertex of accessor {} is not finite", positions.index())));
        }
        mesh.positions.push(p);
    }
    let [normals, uvs] = attributes(mesh, primitive, to_scene, buffers, lost)?;
    if !mesh.colors.is_empty() {
        mesh.colors.resize(mesh.positions.len(), [1.0; 4]);
    }
    if primitive.morph_targets().next().is_some() {
        lost.insert("morph targets".into());
    }
    let indices = match primitive.indices() {
        Some(accessor) => buffers.indices(&accessor)?,
        None => (0..u32::try_from(count).unwrap_or(NONE)).collect(),
    };
    if let Some(i) = indices.iter().find(|i| **i as usize >= count) {
        return Err(MeshError::whole(format!("an index is out of range: {i}, and there are {count} vertices")));
    }
    let shifted =
        |from: Option<usize>, i: u32| from.map_or(NONE, |f| u32::try_from(f).unwrap_or(NONE).saturating_add(i));
    let corner =
        |i: &u32| Corner { vertex: shifted(Some(first), *i), uv: shifted(uvs, *i), normal: shifted(normals, *i) };
    polygons(mesh, primitive.mode(), &indices, to_scene.determinant() < 0.0, corner);
    Ok(())
}

/// Appends normals, texture coordinates and colours of the vertices that were added last, and returns the places of the first two.
fn attributes(
    mesh: &mut Mesh,
    primitive: &Primitive<'_>,
    to_scene: &DMat4,
    buffers: &Buffers,
    lost: &mut BTreeSet<String>,
) -> Result<[Option<usize>; 2], MeshError> {
    let count = primitive.get(&Semantic::Positions).map_or(0, |a| a.count());
    let same = |n: usize, what: &str| {
        let problem = || format!("has {n} {what} for {count} vertices");
        if n == count { Ok(()) } else { Err(MeshError::whole(problem())) }
    };
    let (mut normals, mut uvs) = (None, None);
    for (semantic, accessor) in primitive.attributes() {
        match semantic {
            Semantic::Positions => {}
            Semantic::Normals => {
                same(accessor.count(), "normals")?;
                normals = Some(mesh.normals.len());
                let m = DMat3::from_mat4(*to_scene);
                // The cofactors have the direction of the inverse transpose, or the opposite one if the node mirrors.
                let side = 1f64.copysign(m.determinant());
                let cofactors = [m.y_axis.cross(m.z_axis), m.z_axis.cross(m.x_axis), m.x_axis.cross(m.y_axis)];
                let turned = DMat3::from_cols(cofactors[0], cofactors[1], cofactors[2]) * side;
                let all = buffers.floats::<3>(&accessor)?.into_iter().map(DVec3::from_array);
                mesh.normals.extend(all.map(|n| (turned * n).try_normalize().unwrap_or(n)));
            }
            Semantic::TexCoords(0) => {
                same(accessor.count(), "texture coordinates")?;
                uvs = Some(mesh.uvs.len());
                // Counted from the top there, from the bottom here.
                mesh.uvs.extend(buffers.floats::<2>(&accessor)?.into_iter().map(|[u, v]| [u, 1.0 - v, 0.0]));
            }
            Semantic::Colors(0) => {
                same(accessor.count(), "colours")?;
                mesh.colors.resize(mesh.positions.len() - count, [1.0; 4]);
                if accessor.dimensions() == gltf::accessor::Dimensions::Vec4 {
                    mesh.colors.extend(buffers.floats::<4>(&accessor)?);
                } else {
                    mesh.colors.extend(buffers.floats::<3>(&accessor)?.into_iter().map(|[r, g, b]| [r, g, b, 1.0]));
                }
            }
            Semantic::Tangents => {
                lost.insert("tangents (viewers compute them from normals and texture coordinates)".into());
            }
            Semantic::Joints(_) | Semantic::Weights(_) => {
                lost.insert("skins".into());
            }
            other => {
                lost.insert(format!("attributes {}", other.to_string()));
            }
        }
    }
    Ok([normals, uvs])
}

/// Appends the polygons; a mirroring turns triangles over.
fn polygons(mesh: &mut Mesh, mode: Mode, indices: &[u32], mirrored: bool, corner: impl Fn(&u32) -> Corner) {
    let mut triangle = |[a, b, c]: [&u32; 3]| {
        let t = if mirrored { [a, c, b] } else { [a, b, c] };
        if a != b && b != c && c != a {
            mesh.push(PolygonKind::Face, t.map(&corner));
        }
    };
    match mode {
        Mode::Triangles => indices.chunks_exact(3).for_each(|t| triangle([&t[0], &t[1], &t[2]])),
        Mode::TriangleStrip => indices.windows(3).enumerate().for_each(|(i, t)| {
            triangle(if i % 2 == 0 { [&t[0], &t[1], &t[2]] } else { [&t[1], &t[0], &t[2]] });
        }),
        Mode::TriangleFan => {
            indices.windows(2).skip(1).for_each(|t| triangle([&indices[0], &t[0], &t[1]]));
        }
        Mode::Lines => indices.chunks_exact(2).for_each(|t| mesh.push(PolygonKind::Line, t.iter().map(&corner))),
        Mode::LineStrip if indices.len() > 1 => mesh.push(PolygonKind::Line, indices.iter().map(&corner)),
        Mode::LineLoop if indices.len() > 1 => {
            mesh.push(PolygonKind::Line, indices.iter().chain(indices.first()).map(&corner));
        }
        Mode::Points if !indices.is_empty() => mesh.push(PolygonKind::Points, indices.iter().map(&corner)),
        _ => {}
    }
}
