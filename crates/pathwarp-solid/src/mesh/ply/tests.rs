use super::{read, sniff, write};
use crate::mesh::{Corner, Mesh, NONE, PolygonKind, gltf, obj};
use pathwarp::budget::{Budget, Limits};

const TEXT: &str = "ply\nformat ascii 1.0\ncomment a quad and a triangle\nelement vertex 5\nproperty float x\nproperty float y\nproperty double z\n\
    property float nx\nproperty float ny\nproperty float nz\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nproperty float s\n\
    property float t\nproperty float quality\nelement face 2\nproperty list uchar int vertex_indices\nelement edge 1\nproperty int vertex1\n\
    property int vertex2\nend_header\n\
    0 0 0.5 0 0 1 255 0 0 0 0 9\n1 0 0.5 0 0 1 0 255 0 1 0 9\n1 1 0.5 0 0 1 0 0 255 1 1 9\n0 1 0.5 0 0 1 51 0 0 0 1 9\n2 2 1 0 0 1 0 0 0 0 0 9\n\
    4 0 1 2 3\n3 1 4 2\n0 4\n";

#[test]
fn quads_colours_normals_and_edges_come_back() {
    assert!(sniff(TEXT.as_bytes()));
    let mut mesh = read(TEXT.as_bytes()).unwrap();
    assert_eq!(mesh.left_out, ["properties of elements `vertex`: quality"]);
    mesh.left_out.clear();
    let kinds: Vec<_> = mesh.polygons().map(|(k, c)| (k, c.len())).collect();
    assert_eq!(kinds, [(PolygonKind::Face, 4), (PolygonKind::Face, 3), (PolygonKind::Line, 2)]);
    assert!((mesh.colors[3], mesh.positions[4].z, mesh.uvs[2]) == ([0.2, 0.0, 0.0, 1.0], 1.0, [1.0, 1.0, 0.0]));
    let back = read(&write(&mesh).unwrap()).unwrap();
    assert_eq!((&back.positions, &back.colors), (&mesh.positions, &mesh.colors));
    // Beside a triangle, the quad is written as two triangles from its first corner.
    let kinds = |mesh: &Mesh| -> Vec<_> { mesh.polygons().map(|(k, c)| (k, c.len())).collect() };
    assert_eq!(kinds(&back), [&[(PolygonKind::Face, 3); 3][..], &[(PolygonKind::Line, 2)]].concat());
    // The edge has no texture coordinates, but its vertices have.
    assert_eq!(back.corners[..9], [0, 1, 2, 0, 2, 3, 4, 5, 6].map(|i| mesh.corners[i]));
    let quad = read(TEXT.replace("face 2", "face 1").replace("3 1 4 2\n", "").as_bytes()).unwrap();
    let back = read(&write(&quad).unwrap()).unwrap();
    assert_eq!(kinds(&back), [(PolygonKind::Face, 4), (PolygonKind::Line, 2)]);
    assert_eq!(back.corners[..4], quad.corners[..4]);
}

/// Other programs omit zeros and leave lines empty.
#[test]
fn numbers_may_lack_zeros_and_lines_be_empty() {
    let loose = TEXT.replace("0.5", ".5").replace("1 1 .5", "1. +1.e0 5.E-1").replace("end_header\n", "end_header\n\n");
    assert_ne!(loose, TEXT);
    for text in [loose.clone(), loose.replace('\n', "\r\n"), format!("{loose}\n \n")] {
        assert_eq!(read(text.as_bytes()), read(TEXT.as_bytes()), "{text}");
    }
    assert!(read(TEXT.replace("0 0 0.5", "0 0 .").as_bytes()).is_err());
}

#[test]
fn opacity_stays() {
    let text = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\n\
        property uchar green\nproperty uchar blue\nproperty uchar alpha\nelement face 1\nproperty list uchar int vertex_indices\n\
        end_header\n0 0 0 255 0 0 255\n1 0 0 0 255 0 51\n1 1 0 0 0 255 0\n3 0 1 2\n";
    let mesh = read(text.as_bytes()).unwrap();
    assert!(mesh.left_out.is_empty() && mesh.is_translucent());
    assert_eq!(
        read(&write(&mesh).unwrap()).unwrap().colors,
        [[1.0, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, 0.2], [0.0, 0.0, 1.0, 0.0]]
    );
    let budget = Budget::new(Limits::default());
    let back = gltf::read(&gltf::write_binary(&mesh).unwrap(), &budget).unwrap();
    assert!(back.left_out.is_empty());
    assert!(back.colors.iter().zip(&mesh.colors).all(|(a, b)| (0..4).all(|k| (a[k] - b[k]).abs() < 1e-7)));
    // Opaque colours need no fourth number.
    let opaque = read(text.replace(" 51", " 255").replace("255 0\n", "255 255\n").as_bytes()).unwrap();
    assert!(!opaque.is_translucent() && !String::from_utf8_lossy(&write(&opaque).unwrap()).contains("alpha"));
}

#[test]
fn corners_with_their_own_texture_become_vertices() {
    let mesh = obj::read(b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\nf 1/2 3/3 4/1\n")
        .unwrap();
    let back = read(&write(&mesh).unwrap()).unwrap();
    assert_eq!(back.positions.len(), 5);
    let at = |c: &Corner| (back.positions[c.vertex as usize], back.uvs[c.uv as usize]);
    let was = |c: &Corner| (mesh.positions[c.vertex as usize], mesh.uvs[c.uv as usize]);
    assert!(back.corners.iter().zip(&mesh.corners).all(|(a, b)| at(a) == was(b) && a.normal == NONE));
}

#[test]
fn damaged_files_are_refused_quickly() {
    let good = write(&obj::read(b"v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n").unwrap()).unwrap();
    let text = String::from_utf8_lossy(&good).into_owned();
    let header = text.find("end_header\n").unwrap() + 11;
    let announced = |what: &str, n: &str| {
        let mut out = text[..header].replace(what, &format!("{what}{n}")).into_bytes();
        out.extend_from_slice(&good[header..]);
        out
    };
    let many = announced("element vertex 3", "000000000");
    let faces = announced("element face 1", "000000000");
    let mut nan = good.clone();
    nan[header..header + 8].copy_from_slice(&f64::NAN.to_le_bytes());
    let mut index = good.clone();
    let end = index.len();
    index[end - 4..].copy_from_slice(&7u32.to_le_bytes());
    let mut long = good.clone();
    long[end - 13] = 255;
    let empty = b"ply\nformat binary_little_endian 1.0\nelement vertex 1000000000\nend_header\n";
    let no_x = b"ply\nformat ascii 1.0\nelement vertex 1\nproperty float y\nend_header\n1\n";
    let minus = TEXT.replace("3 1 4 2", "3 1 4 -2");
    for (file, part) in [
        (&many[..], "announces 3000000000 elements `vertex`"),
        (&faces[..], "announces 1000000000 elements `face`"),
        (&nan[..], "vertex 1 is not finite"),
        (&index[..], "an index of face 1 is out of range: there are 3 vertices"),
        (&long[..], "damaged"),
        (&good[..end - 2], "damaged"),
        (&good[..header - 5], "damaged"),
        (&empty[..], "without properties"),
        (&no_x[..], "without x, y and z"),
        (minus.as_bytes(), "an index of face 2 is out of range"),
        (b"ply\nformat ascii 1.0\nend_header\n", "no vertices"),
        (b"ply\n\xff\xff\n", "damaged"),
    ] {
        let e = read(file).unwrap_err().to_string();
        assert!(e.contains(part), "{part}: {e}");
    }
}
