//! Sheets, stars and fans, and what can be put on them.

use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::TAU;
use std::fmt::Write;

/// A cage in the making.
#[derive(Clone, Default)]
pub struct Cage {
    about: &'static str,
    positions: Vec<[f64; 3]>,
    faces: Vec<Vec<usize>>,
    uvs: Vec<[f64; 2]>,
    /// The texture coordinate of every corner.
    uv_faces: Vec<Vec<usize>>,
    tags: Vec<String>,
    /// The vertices on every spoke of a star, from the centre.
    spokes: Vec<Vec<usize>>,
}

/// The number of vertex (i,j) of a sheet with `n` quads along j.
pub fn at(n: usize, i: usize, j: usize) -> usize {
    i * (n + 1) + j
}

impl Cage {
    /// `m` x `n` quads; face (i,j) is number `i * n + j`.
    pub fn sheet(m: usize, n: usize) -> Self {
        let mut cage = Self::default();
        for (i, j) in (0..=m).flat_map(|i| (0..=n).map(move |j| (i, j))) {
            let [dx, dy, z] = uneven(7 * i + 5 * j + i * j);
            cage.positions.push([i as f64 + dx, j as f64 + dy, z]);
        }
        for (i, j) in (0..m).flat_map(|i| (0..n).map(move |j| (i, j))) {
            let [a, b] = [at(n, i, j), at(n, i + 1, j)];
            cage.faces.push(vec![a, b, b + 1, a + 1]);
        }
        cage.scaled(0.5)
    }

    /// `n` sectors of `r` x `r` quads around vertex 0; sector s is between the spokes s and s+1.
    pub fn star(n: usize, r: usize) -> Self {
        Self::around(n, n, r)
    }

    /// `k` sectors of `r` x `r` quads, as many as `of` of which would close, around vertex 0.
    pub fn fan(k: usize, of: usize, r: usize) -> Self {
        Self::around(k, of, r)
    }

    fn around(k: usize, of: usize, r: usize) -> Self {
        let mut cage = Self::default();
        let mut ids: BTreeMap<(usize, usize, usize), usize> = BTreeMap::new();
        let spoke = |s: usize| {
            let angle = TAU * s as f64 / of as f64;
            [angle.cos(), angle.sin()]
        };
        for s in 0..k {
            for (i, j) in (0..r).flat_map(|i| (0..r).map(move |j| (i, j))) {
                let face = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(i, j)| {
                    // The nodes on a spoke belong to both its sectors.
                    let key = match (i, j) {
                        (0, 0) => (0, 0, 0),
                        (0, j) => ((s + 1) % of, j, 0),
                        _ => (s, i, j),
                    };
                    *ids.entry(key).or_insert_with(|| {
                        let ([ax, ay], [bx, by]) = (spoke(s), spoke(s + 1));
                        let (a, b) = (i as f64, j as f64);
                        let [dx, dy, z] = uneven(3 * cage.positions.len() + 1);
                        let position = [a * ax + b * bx + dx, a * ay + b * by + dy, z];
                        cage.positions.push(position);
                        cage.positions.len() - 1
                    })
                });
                cage.faces.push(face.to_vec());
            }
        }
        cage.spokes = (0..k)
            .map(|s| (0..=r).map(|i| ids[&(if i == 0 { 0 } else { s }, i, 0)]).collect())
            .collect();
        cage.scaled(0.5)
    }

    /// The vertices on spoke `s` of a star, from the centre.
    pub fn spoke(&self, s: usize) -> &[usize] {
        &self.spokes[s]
    }

    /// A closed cage of given corners, with uneven places.
    pub fn solid(positions: &[[f64; 3]], faces: &[&[usize]]) -> Self {
        let mut cage = Self::default();
        for (k, &[x, y, z]) in positions.iter().enumerate() {
            let [dx, dy, dz] = uneven(5 * k + 2);
            cage.positions.push([x + dx, y + dy, z + dz]);
        }
        cage.faces = faces.iter().map(|face| face.to_vec()).collect();
        cage.scaled(0.5)
    }

    fn scaled(mut self, factor: f64) -> Self {
        for x in self.positions.iter_mut().flatten() {
            // Zero is added lest there be a negative one.
            *x = (*x * factor * 1000.0).round() / 1000.0 + 0.0;
        }
        self
    }

    /// What the cage is for.
    pub fn about(mut self, about: &'static str) -> Self {
        self.about = about;
        self
    }

    /// Joins another cage, moved along x by `dx`, without a common vertex.
    pub fn and(mut self, other: &Self, dx: f64) -> Self {
        let first = self.positions.len();
        self.positions.extend(other.positions.iter().map(|&[x, y, z]| [x + dx, y, z]));
        let shift = |face: &Vec<usize>| face.iter().map(|&v| v + first).collect();
        self.faces.extend(other.faces.iter().map(shift));
        self
    }

    /// Leaves faces out, and the vertices that no face has any more.
    pub fn without(mut self, faces: &[usize]) -> Self {
        let mut number = 0;
        self.faces.retain(|_| {
            number += 1;
            !faces.contains(&(number - 1))
        });
        let used: BTreeSet<usize> = self.faces.iter().flatten().copied().collect();
        let new: BTreeMap<usize, usize> = used.iter().enumerate().map(|(k, &v)| (v, k)).collect();
        self.positions = used.iter().map(|&v| self.positions[v]).collect();
        self.faces.iter_mut().flatten().for_each(|v| *v = new[v]);
        self
    }

    /// Puts these faces in place of one.
    pub fn replaced(mut self, face: usize, by: &[&[usize]]) -> Self {
        self.faces[face] = by[0].to_vec();
        self.faces.extend(by[1..].iter().map(|face| face.to_vec()));
        self
    }

    /// Makes one face of two with a common edge; the later one goes.
    pub fn merged(mut self, keep: usize, gone: usize) -> Self {
        let (a, b) = (self.faces[keep].clone(), self.faces[gone].clone());
        let edge = |face: &[usize], k: usize| (face[k % face.len()], face[(k + 1) % face.len()]);
        let is_twin = |k: &usize| (0..b.len()).any(|l| edge(&b, l) == swap(edge(&a, *k)));
        let k = (0..a.len()).find(is_twin).expect("the faces have a common edge");
        let (start, end) = edge(&a, k);
        let after = b.iter().position(|&v| v == start).expect("both faces have that vertex");
        let mut face: Vec<usize> = (1..=a.len()).map(|i| a[(k + i) % a.len()]).collect();
        face.extend((1..b.len()).map(|i| b[(after + i) % b.len()]).take_while(|&v| v != end));
        self.faces[keep] = face;
        self.without(&[gone])
    }

    /// A sharp line through these vertices.
    pub fn crease(mut self, line: &[usize], sharpness: f64) -> Self {
        for edge in line.windows(2) {
            self.tags.push(format!("t crease 2/1/0 {} {} {sharpness}", edge[0], edge[1]));
        }
        self
    }

    /// A sharp line whose edges have these values.
    pub fn graded_crease(mut self, line: &[usize], sharpness: &[f64]) -> Self {
        for (edge, &s) in line.windows(2).zip(sharpness) {
            self = self.crease(edge, s);
        }
        self
    }

    /// A sharp vertex.
    pub fn corner(mut self, vertex: usize, sharpness: f64) -> Self {
        self.tags.push(format!("t corner 1/1/0 {vertex} {sharpness}"));
        self
    }

    /// Faces without a surface.
    pub fn holes(mut self, faces: &[usize]) -> Self {
        let list: Vec<String> = faces.iter().map(ToString::to_string).collect();
        self.tags.push(format!("t hole {}/0/0 {}", faces.len(), list.join(" ")));
        self
    }

    /// The rule at the boundary: 0 none, 1 edge and corner, 2 edge only.
    pub fn boundary(mut self, rule: usize) -> Self {
        self.tags.push(format!("t interpolateboundary 1/0/0 {rule}"));
        self
    }

    /// Creases by Chaikin's rule.
    pub fn chaikin(mut self) -> Self {
        self.tags.push("t creasemethod 0/0/1 chaikin".to_owned());
        self
    }

    /// Texture coordinates: faces with the same label are joined along their common edges, those
    /// of different labels are apart. A pair in `cuts` is an edge that is a seam all the same, but
    /// for those of its ends that are in `joined`.
    pub fn textured(mut self, label: &[usize], cuts: &[[usize; 2]], joined: &[usize]) -> Self {
        let mut group = Groups::new(&self.faces);
        for (edge, [f, g]) in self.inner_edges() {
            let is_cut = cuts.contains(&edge) || cuts.contains(&[edge[1], edge[0]]);
            for &v in &edge {
                if label[f] == label[g] && (!is_cut || joined.contains(&v)) {
                    group.join((f, v), (g, v));
                }
            }
        }
        let mut ids = BTreeMap::new();
        for (f, face) in self.faces.clone().iter().enumerate() {
            let corners = face.iter().map(|&v| {
                let root = group.root((f, v));
                let uvs = &mut self.uvs;
                let [x, y, _] = self.positions[v];
                *ids.entry(root).or_insert_with(|| {
                    let [dx, dy, _] = uneven(11 * uvs.len() + 4);
                    let island = label[f] as f64;
                    let round = |x: f64| (x * 1000.0).round() / 1000.0 + 0.0;
                    uvs.push([round(0.6 * x + dx + 2.0 * island), round(0.6 * y + dy)]);
                    uvs.len()
                })
            });
            let corners = corners.collect();
            self.uv_faces.push(corners);
        }
        self
    }

    fn inner_edges(&self) -> Vec<([usize; 2], [usize; 2])> {
        let mut faces: BTreeMap<(usize, usize), usize> = BTreeMap::new();
        for (f, face) in self.faces.iter().enumerate() {
            for k in 0..face.len() {
                faces.insert((face[k], face[(k + 1) % face.len()]), f);
            }
        }
        let inner = |(&(a, b), &f): (&(usize, usize), &usize)| {
            (a < b).then(|| Some(([a, b], [f, *faces.get(&(b, a))?]))).flatten()
        };
        faces.iter().filter_map(inner).collect()
    }

    /// The text of the file.
    pub fn to_obj(&self, name: &str) -> String {
        let mut text = format!(
            "# {name}: {}\n# Written by `cargo xtask feature-cages`; ours; licence: MIT OR Apache-2.0.\n",
            self.about
        );
        for [x, y, z] in &self.positions {
            let _ = writeln!(text, "v {x} {y} {z}");
        }
        for [u, v] in &self.uvs {
            let _ = writeln!(text, "vt {u} {v}");
        }
        for (f, face) in self.faces.iter().enumerate() {
            text.push('f');
            for (k, v) in face.iter().enumerate() {
                let _ = write!(text, " {}", v + 1);
                if let Some(uvs) = self.uv_faces.get(f) {
                    let _ = write!(text, "/{}", uvs[k]);
                }
            }
            text.push('\n');
        }
        for tag in &self.tags {
            let _ = writeln!(text, "{tag}");
        }
        text
    }
}

fn swap((a, b): (usize, usize)) -> (usize, usize) {
    (b, a)
}

/// Three numbers in -0.2..0.2 that look like none, but are always the same.
fn uneven(k: usize) -> [f64; 3] {
    let part = |step: usize, of: usize| ((k * step + 3) % of) as f64 / of as f64;
    [0.3 * part(5, 13) - 0.15, 0.3 * part(7, 17) - 0.15, 0.8 * part(4, 11) - 0.4]
}

/// Corners (face, vertex) in groups.
struct Groups(BTreeMap<(usize, usize), (usize, usize)>);

impl Groups {
    fn new(faces: &[Vec<usize>]) -> Self {
        let corners =
            faces.iter().enumerate().flat_map(|(f, face)| face.iter().map(move |&v| (f, v)));
        Self(corners.map(|c| (c, c)).collect())
    }

    fn root(&self, corner: (usize, usize)) -> (usize, usize) {
        let up = self.0[&corner];
        if up == corner { corner } else { self.root(up) }
    }

    fn join(&mut self, a: (usize, usize), b: (usize, usize)) {
        let (a, b) = (self.root(a), self.root(b));
        self.0.insert(a.max(b), a.min(b));
    }
}
