//! A reader of OBJ files for tests, independent of the program's.

/// Vertices and faces.
pub struct Model {
    pub vertices: Vec<[f64; 3]>,
    /// Indices from 0.
    pub faces: Vec<Vec<usize>>,
}

impl Model {
    pub fn read(text: &str) -> Self {
        let (mut vertices, mut faces) = (Vec::new(), Vec::new());
        for line in text.lines() {
            let mut words = line.split(' ');
            match words.next() {
                Some("v") => {
                    let n: Vec<f64> = words.map(|w| w.parse().unwrap()).collect();
                    vertices.push([n[0], n[1], n[2]]);
                }
                Some("f") => {
                    faces.push(words.map(|w| w.split('/').next().unwrap().parse::<usize>().unwrap() - 1).collect());
                }
                _ => {}
            }
        }
        Self { vertices, faces }
    }
}
