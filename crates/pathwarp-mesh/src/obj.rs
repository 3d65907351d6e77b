//! Writes Wavefront OBJ.

use crate::refine::TriangleMesh;
use crate::shape::Point3;
use std::fmt::Write as _;

/// Collects the text of a file.
pub(crate) struct ObjWriter {
    text: String,
    vertices: usize,
}

impl ObjWriter {
    pub(crate) fn new() -> Self {
        Self { text: String::from("# pathwarp: x right, y up, z towards the viewer; user units\n"), vertices: 0 }
    }

    fn object(&mut self, name: &str) {
        // Many readers end names at white space.
        let name: String = name.chars().map(|c| if c.is_whitespace() || c.is_control() { '_' } else { c }).collect();
        let _ = writeln!(self.text, "o {name}");
    }

    fn vertex(&mut self, p: &Point3) {
        // Subtracting avoids negative zeros.
        let _ = writeln!(self.text, "v {} {} {}", p[0], 0.0 - p[1], 0.0 - p[2]);
    }

    pub(crate) fn mesh(&mut self, name: &str, mesh: &TriangleMesh) {
        if mesh.triangles.is_empty() {
            return;
        }
        self.object(name);
        for p in &mesh.points {
            self.vertex(p);
        }
        let first = self.vertices as u64 + 1;
        for t in &mesh.triangles {
            let [a, b, c] = t.map(|i| u64::from(i) + first);
            let _ = writeln!(self.text, "f {a} {b} {c}");
        }
        self.vertices += mesh.points.len();
    }

    pub(crate) fn polylines(&mut self, name: &str, lines: &[(Vec<Point3>, bool)]) {
        self.object(name);
        for (points, closed) in lines.iter().filter(|(p, _)| p.len() > 1) {
            for p in points {
                self.vertex(p);
            }
            self.text.push('l');
            for i in (0..points.len()).chain(closed.then_some(0)) {
                let _ = write!(self.text, " {}", self.vertices + i + 1);
            }
            self.text.push('\n');
            self.vertices += points.len();
        }
    }

    pub(crate) fn finish(self) -> String {
        self.text
    }
}
