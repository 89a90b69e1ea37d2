//! Catmull-Clark refinement of a whole mesh with creases and corners, written down plainly from
//! the rules and sharing nothing with the library: what the surface is compared with.

use std::collections::BTreeMap;

use evenlight::mesh::{BoundaryRule, Corner, Crease, CreaseMethod, Mesh, Tags};
use evenlight::point::{Point, add_scaled, scale};
use evenlight::{FaceId, VertexId};

type Edge = [u32; 2];

fn edge(a: u32, b: u32) -> Edge {
    [a.min(b), a.max(b)]
}

/// What a step needs to know of a mesh.
struct Tables {
    faces: Vec<Vec<u32>>,
    /// The faces of every edge.
    edges: BTreeMap<Edge, Vec<usize>>,
    sharpness: BTreeMap<Edge, f64>,
    corners: Vec<f64>,
    edges_of: Vec<Vec<Edge>>,
    faces_of: Vec<Vec<usize>>,
}

impl Tables {
    fn new(mesh: &Mesh) -> Self {
        let faces: Vec<Vec<u32>> =
            mesh.faces.iter().map(|f| f.iter().map(|v| v.0).collect()).collect();
        let mut edges: BTreeMap<Edge, Vec<usize>> = BTreeMap::new();
        let mut faces_of = vec![Vec::new(); mesh.positions.len()];
        for (f, face) in faces.iter().enumerate() {
            for (k, &v) in face.iter().enumerate() {
                edges.entry(edge(v, face[(k + 1) % face.len()])).or_default().push(f);
                faces_of[v as usize].push(f);
            }
        }
        let mut sharpness: BTreeMap<Edge, f64> = edges.keys().map(|&e| (e, 0.0)).collect();
        for crease in &mesh.tags.creases {
            sharpness.insert(edge(crease.edge[0].0, crease.edge[1].0), crease.sharpness);
        }
        let mut edges_of = vec![Vec::new(); mesh.positions.len()];
        for (&e, around) in &edges {
            if around.len() == 1 {
                sharpness.insert(e, f64::INFINITY);
            }
            e.iter().for_each(|&v| edges_of[v as usize].push(e));
        }
        let mut corners = vec![0.0; mesh.positions.len()];
        for corner in &mesh.tags.corners {
            corners[corner.vertex.index()] = corner.sharpness;
        }
        if mesh.tags.boundary == BoundaryRule::EdgeAndCorner {
            for (v, around) in faces_of.iter().enumerate() {
                if around.len() == 1 && edges_of[v].len() == 2 {
                    corners[v] = f64::INFINITY;
                }
            }
        }
        Self { faces, edges, sharpness, corners, edges_of, faces_of }
    }
}

fn lower(s: f64) -> f64 {
    if s >= 10.0 { s } else { (s - 1.0).max(0.0) }
}

fn semi(s: f64) -> bool {
    s > 0.0 && s < 10.0
}

fn child_sharpness(t: &Tables, method: CreaseMethod, e: Edge, v: u32) -> f64 {
    let s = t.sharpness[&e];
    let semi_sharp: Vec<f64> =
        t.edges_of[v as usize].iter().map(|e| t.sharpness[e]).filter(|&s| semi(s)).collect();
    if method == CreaseMethod::Uniform || !semi(s) || semi_sharp.len() < 2 {
        return lower(s);
    }
    let (s, sum) = (s as f32, semi_sharp.iter().map(|&s| s as f32).sum::<f32>());
    let average = (sum - s) / (semi_sharp.len() as f32 - 1.0);
    lower(f64::from(0.75 * s + 0.25 * average))
}

fn average(points: &[Point]) -> Point {
    let mut sum = [0.0; 3];
    points.iter().for_each(|&p| add_scaled(&mut sum, 1.0 / points.len() as f64, p));
    sum
}

fn mix(w: f64, a: Point, b: Point) -> Point {
    let mut p = scale(w, a);
    add_scaled(&mut p, 1.0 - w, b);
    p
}

/// One step. Child k of face f comes after the children of the faces before it; child k of a quad
/// stands at its corner k in the quad's orientation, child k of an n-gon begins with its corner.
pub fn refine(mesh: &Mesh) -> Mesh {
    let t = Tables::new(mesh);
    let method = mesh.tags.crease_method;
    let at = |v: u32| mesh.positions[v as usize];
    let centre = |f: usize| average(&t.faces[f].iter().map(|&v| at(v)).collect::<Vec<_>>());
    let num_vertices = mesh.positions.len() as u32;
    let number: BTreeMap<Edge, u32> = t.edges.keys().copied().zip(num_vertices..).collect();
    let first_centre = num_vertices + t.edges.len() as u32;

    let mut positions: Vec<Point> =
        (0..num_vertices).map(|v| vertex(&t, method, mesh, v)).collect();
    for (&[a, b], around) in &t.edges {
        let middle = average(&[at(a), at(b)]);
        let s = t.sharpness[&[a, b]];
        let halves = [a, b].map(|v| child_sharpness(&t, method, [a, b], v));
        // Beyond the middle, as OpenSubdiv, if averaging ends an edge that is sharper than 1.
        positions.push(if halves.iter().all(|&h| h > 0.0) {
            middle
        } else {
            mix(s, middle, average(&[at(a), at(b), centre(around[0]), centre(around[1])]))
        });
    }
    positions.extend((0..t.faces.len()).map(centre));

    let mut faces: Vec<[u32; 4]> = Vec::new();
    let mut holes = Vec::new();
    for (f, face) in t.faces.iter().enumerate() {
        let n = face.len();
        for k in 0..n {
            let (v, next, before) = (face[k], face[(k + 1) % n], face[(k + n - 1) % n]);
            let mut child =
                [v, number[&edge(v, next)], first_centre + f as u32, number[&edge(before, v)]];
            if n == 4 {
                child.rotate_right(k);
            }
            if mesh.tags.holes.contains(&FaceId(f as u32)) {
                holes.push(FaceId(faces.len() as u32));
            }
            faces.push(child);
        }
    }
    let mut tags = Tags { holes, ..mesh.tags.clone() };
    tags.creases.clear();
    tags.corners.clear();
    for (&e, &middle) in &number {
        for v in e {
            let sharpness = child_sharpness(&t, method, e, v);
            if sharpness > 0.0 && t.edges[&e].len() == 2 {
                tags.creases.push(Crease { edge: [VertexId(v), VertexId(middle)], sharpness });
            }
        }
    }
    for v in 0..num_vertices {
        let sharpness = lower(t.corners[v as usize]);
        if sharpness > 0.0 {
            tags.corners.push(Corner { vertex: VertexId(v), sharpness });
        }
    }
    Mesh { tags, ..Mesh::new(positions, faces) }
}

#[derive(Clone, Copy, PartialEq)]
enum Rule {
    Smooth,
    Crease,
    Corner,
}

fn rule(corner: f64, edges: &[f64]) -> Rule {
    match edges.iter().filter(|&&s| s > 0.0).count() {
        _ if corner > 0.0 => Rule::Corner,
        0 | 1 => Rule::Smooth,
        2 => Rule::Crease,
        _ => Rule::Corner,
    }
}

fn vertex(t: &Tables, method: CreaseMethod, mesh: &Mesh, v: u32) -> Point {
    let i = v as usize;
    if t.faces_of[i].is_empty() {
        return mesh.positions[i];
    }
    let now: Vec<f64> = t.edges_of[i].iter().map(|e| t.sharpness[e]).collect();
    let then: Vec<f64> = t.edges_of[i].iter().map(|&e| child_sharpness(t, method, e, v)).collect();
    let corner_then = lower(t.corners[i]);
    let (before, after) = (rule(t.corners[i], &now), rule(corner_then, &then));
    let old = by_rule(t, mesh, v, before, &now);
    if before == after || before == Rule::Smooth {
        return old;
    }
    let mut ending: Vec<f64> =
        now.iter().zip(&then).filter(|&(&a, &b)| a > 0.0 && b == 0.0).map(|(&a, _)| a).collect();
    if t.corners[i] > 0.0 && corner_then == 0.0 {
        ending.push(t.corners[i]);
    }
    let sum: f32 = ending.iter().map(|&s| s as f32).sum();
    let weight = (sum / ending.len() as f32).min(1.0);
    mix(f64::from(weight), old, by_rule(t, mesh, v, after, &then))
}

fn by_rule(t: &Tables, mesh: &Mesh, v: u32, rule: Rule, edges: &[f64]) -> Point {
    let i = v as usize;
    let at = |v: u32| mesh.positions[v as usize];
    let other = |e: &Edge| at(e[0] + e[1] - v);
    match rule {
        Rule::Corner => at(v),
        Rule::Crease => {
            let sharp = t.edges_of[i].iter().zip(edges).filter(|&(_, &s)| s > 0.0);
            mix(0.75, at(v), average(&sharp.map(|(e, _)| other(e)).collect::<Vec<_>>()))
        }
        Rule::Smooth => {
            let n = t.edges_of[i].len() as f64;
            let centre =
                |&f: &usize| average(&t.faces[f].iter().map(|&v| at(v)).collect::<Vec<_>>());
            let q = average(&t.faces_of[i].iter().map(centre).collect::<Vec<_>>());
            let r = average(
                &t.edges_of[i].iter().map(|e| average(&[at(v), other(e)])).collect::<Vec<_>>(),
            );
            let mut p = scale(1.0 / n, q);
            add_scaled(&mut p, 2.0 / n, r);
            add_scaled(&mut p, (n - 3.0) / n, at(v));
            p
        }
    }
}
