use super::{read, sniff, write_binary, write_text};
use crate::mesh::{Corner, Mark, Mesh, PolygonKind};
use crate::mesh::{deform, obj};
use glam::DVec3;
use pathwarp::budget::{Budget, Limit, Limits};
use serde_json::{Value, json};

fn budget() -> Budget {
    Budget::new(Limits::default())
}

/// Returns two textured triangles, and the JSON of a file that shows them twice.
fn file() -> (Value, Vec<u8>) {
    let floats: [f32; 36] = [
        0., 0., 0., 1., 0., 0., 1., 1., 0., 0., 1., 0., // positions
        0., 0., 1., 0., 0., 1., 0., 0., 1., 0., 0., 1., // normals
        0., 1., 1., 1., 1., 0., 0., 0., // texture coordinates
        0., 0., 0., 0.,
    ];
    let mut bin: Vec<u8> = floats[..32].iter().flat_map(|v| v.to_le_bytes()).collect();
    bin.extend([0u16, 1, 2, 0, 2, 3].iter().flat_map(|v| v.to_le_bytes()));
    bin.extend_from_slice(b"PICTURE!");
    let root = json!({
        "asset": {"version": "2.0"}, "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [
            {"name": "pair", "children": [1, 2], "translation": [10, 0, 0]},
            {"name": "left", "mesh": 0},
            {"name": "mirrored", "mesh": 0, "scale": [-2, 1, 1]}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2}, "indices": 3, "material": 1}]}],
        "materials": [{"name": "plain"}, {"name": "paint", "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "metallicFactor": 0.25}}],
        "textures": [{"source": 0}],
        "images": [{"bufferView": 4, "mimeType": "image/png"}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]},
            {"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC3"},
            {"bufferView": 2, "componentType": 5126, "count": 4, "type": "VEC2"},
            {"bufferView": 3, "componentType": 5123, "count": 6, "type": "SCALAR"}],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 48},
            {"buffer": 0, "byteOffset": 96, "byteLength": 32}, {"buffer": 0, "byteOffset": 128, "byteLength": 12},
            {"buffer": 0, "byteOffset": 140, "byteLength": 8}],
        "buffers": [{"byteLength": bin.len()}],
    });
    (root, bin)
}

fn binary(root: &Value, bin: &[u8]) -> Vec<u8> {
    let header = gltf::binary::Header { magic: *b"glTF", version: 2, length: 0 };
    gltf::Glb { header, json: serde_json::to_vec(root).unwrap().into(), bin: Some(bin.into()) }.to_vec().unwrap()
}

#[test]
fn nodes_materials_textures_and_pictures_survive() {
    let (root, bin) = file();
    let mesh = read(&binary(&root, &bin), &budget()).unwrap();
    assert!(mesh.left_out.is_empty());
    assert_eq!((mesh.positions.len(), mesh.polygons.len()), (8, 4));
    assert_eq!((mesh.positions[1], mesh.positions[5]), (DVec3::new(11e3, 0.0, 0.0), DVec3::new(8e3, 0.0, 0.0)));
    // The triangles of a mirrored node still face the viewer.
    assert!(mesh.triangles().all(|t| {
        let [a, b, c] = t.map(|c| mesh.positions[c.vertex as usize]);
        (b - a).cross(c - a).z > 0.0 && t.iter().all(|c| mesh.normals[c.normal as usize].z == 1.0)
    }));
    assert_eq!((mesh.uvs[0], mesh.name_of(3)), ([0.0, 0.0, 0.0], "mirrored"));
    for again in [write_binary(&mesh).unwrap(), write_text(&mesh).unwrap()] {
        assert!(sniff(&again));
        let back = read(&again, &budget()).unwrap();
        // The corners must be equal, though their vertices may be numbered otherwise.
        let corners = |m: &Mesh| -> Vec<(DVec3, [f64; 3], DVec3)> {
            let at = |c: &Corner| (m.positions[c.vertex as usize], m.uvs[c.uv as usize], m.normals[c.normal as usize]);
            m.corners.iter().map(at).collect()
        };
        assert_eq!(corners(&back), corners(&mesh));
        assert_eq!((&back.marks, &back.polygons), (&mesh.marks, &mesh.polygons));
        let assets = back.assets.as_deref().unwrap();
        assert_eq!(
            (&assets.materials, &assets.pictures[0].1[..]),
            (&vec!["plain".to_owned(), "paint".into()], &b"PICTURE!"[..])
        );
        assert_eq!(assets.json["materials"], root["materials"]);
    }
}

/// Checks normals under a shear against values by hand, and splits faces of five corners into triangles.
#[test]
fn polygons_become_triangles_and_objects_keep_their_materials() {
    let text = "o a\nusemtl red\nv 0 0 0\nv 4 0 0\nv 5 2 0\nv 2 4 0\nv -1 2 0\nvn 0 0 1\nf 1//1 2//1 3//1 4//1 5//1\no b\nusemtl blue\nf 1 2 3\nl 1 3\n";
    let mut mesh = obj::read(text.as_bytes()).unwrap();
    let shear = glam::DMat4::from_cols_array_2d(&[
        [1.0, 0.0, 1.0, 0.0],
        [0.0, 1.0, 0.0, 0.0],
        [0.0, 0.0, 1.0, 0.0],
        [0.0, 0.0, 0.0, 1.0],
    ]);
    deform(&mut mesh, &crate::map::Collineation::new(shear)).unwrap();
    let back: Mesh = read(&write_binary(&mesh).unwrap(), &budget()).unwrap();
    let kinds: Vec<_> = back.polygons().map(|(k, c)| (k, c.len())).collect();
    assert_eq!(
        kinds,
        [
            (PolygonKind::Face, 3),
            (PolygonKind::Face, 3),
            (PolygonKind::Face, 3),
            (PolygonKind::Face, 3),
            (PolygonKind::Line, 2)
        ]
    );
    // z = x after the shear: the normal is (−1, 0, 1)/√2.
    assert!(back.normals.iter().all(|n| (*n - DVec3::new(-1.0, 0.0, 1.0).normalize()).length() < 1e-7));
    let materials: Vec<&str> = back
        .marks
        .iter()
        .filter_map(|(_, m)| if let Mark::Material(t) = m { Some(t.as_str()) } else { None })
        .collect();
    assert_eq!(materials, ["red", "blue", "blue"]);
}

#[test]
fn damaged_and_outside_files_are_refused_quickly() {
    let (root, bin) = file();
    let changed = |f: &dyn Fn(&mut Value)| {
        let mut r = root.clone();
        f(&mut r);
        binary(&r, &bin)
    };
    let mut index = bin.clone();
    index[128] = 9;
    let mut nan = bin.clone();
    nan[..4].copy_from_slice(&f32::NAN.to_le_bytes());
    let good = binary(&root, &bin);
    for (file, part) in [
        (changed(&|r| r["accessors"][0]["count"] = json!(1_000_000_000)), "announces 1000000000 items"),
        (changed(&|r| r["accessors"][0]["count"] = json!(u64::MAX)), "announces"),
        (changed(&|r| r["accessors"][3]["count"] = json!(7)), "announces 7 items"),
        (changed(&|r| r["accessors"][1]["count"] = json!(3)), "3 normals for 4 vertices"),
        (changed(&|r| r["accessors"][0]["byteOffset"] = json!(40)), "announces 4 items"),
        (
            changed(&|r| {
                r["accessors"][0].as_object_mut().unwrap().remove("bufferView");
            }),
            "damaged glTF",
        ),
        (changed(&|r| r["bufferViews"][0]["byteLength"] = json!(4_000_000_000u64)), "accessor 0 is outside its buffer"),
        (changed(&|r| r["buffers"][0]["byteLength"] = json!(1000)), "buffer 0 has 148 bytes"),
        (
            changed(&|r| r["buffers"][0]["uri"] = json!("https://example.org/a.bin")),
            "buffer 0 is outside the file (`https://example.org/a.bin`)",
        ),
        (changed(&|r| r["buffers"][0]["uri"] = json!("../../etc/passwd")), "outside the file"),
        (changed(&|r| r["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = json!(99)), "damaged glTF"),
        (changed(&|r| r["nodes"][1]["mesh"] = json!(5)), "damaged glTF"),
        (changed(&|r| r["nodes"][1]["children"] = json!([0])), "elements"),
        (changed(&|r| r["scenes"] = json!([])), "damaged glTF"),
        (binary(&root, &index), "the index 9 is out of range: there are 4 vertices"),
        (binary(&root, &nan), "not finite"),
        (good[..good.len() - 30].to_vec(), "damaged glTF"),
        (b"glTF\x02\0\0\0\xff\xff\xff\xff".to_vec(), "damaged glTF"),
        (b"{\"asset\":{\"version\":\"2.0\"}}".to_vec(), "no scene"),
        (b"{\"asset\":".to_vec(), "damaged glTF"),
    ] {
        let e = read(&file, &budget()).unwrap_err().to_string();
        assert!(e.contains(part), "{part}: {e}");
    }
    // A small file that shows one mesh again and again.
    let many = changed(&|r| {
        for i in 0..20 {
            r["nodes"]
                .as_array_mut()
                .unwrap()
                .push(json!({"mesh": 0, "children": if i == 0 { json!([1]) } else { json!([i + 2, i + 2]) }}));
        }
        r["scenes"][0]["nodes"] = json!([22]);
    });
    let e = read(&many, &Budget::new(Limits::default().with(Limit::Elements, 1e9).with(Limit::Work, 1e5))).unwrap_err();
    assert!(e.to_string().contains("`work`"), "{e}");
}
