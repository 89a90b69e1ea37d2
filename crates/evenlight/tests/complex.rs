//! The complex of patches: a surface with boundary made of polynomial patches, cut nowhere twice.

#![allow(clippy::unwrap_used, reason = "a test that cannot build its surface fails")]

mod common;

use std::collections::BTreeSet;
use std::sync::Arc;

use common::{Random, all_cages, cage, feature_cages, options};
use evenlight::cap::CapOptions;
use evenlight::complex::{
    EdgeKind, EdgePlace, PatchComplex, PatchEdge, PatchEdgeId, PatchId, VertexPlace,
};
use evenlight::patch::Jet;
use evenlight::point::{Vector, add, norm, scale, sub};
use evenlight::surface::{CreaseRings, Role};
use evenlight::{Cage, Contraction, FaceId, QuadId, SchemeKind, Surface, SurfaceOptions, VertexId};

/// The depths at which complexes are made.
const DEPTHS: [usize; 5] = [0, 1, 2, 3, 20];

fn closed(surface: &Surface, rings: usize) -> Surface {
    let mut closed = Surface::build(Arc::new(surface.cage().clone()), surface.options()).unwrap();
    closed.set_caps(Some(CapOptions { rings, ..CapOptions::default() })).unwrap();
    closed
}

/// V - E + F of the faces with a surface.
fn euler_of_cage(surface: &Surface) -> i64 {
    let topology = surface.cage().topology();
    let (mut vertices, mut edges, mut faces) = (BTreeSet::<VertexId>::new(), BTreeSet::new(), 0);
    for face in topology.faces().ids().filter(|&f| !surface.is_omitted(f)) {
        faces += 1;
        vertices.extend(topology.faces().corners(face));
        for k in 0..topology.faces().corners(face).len() {
            let h = topology.half_edge(face, k);
            edges.insert(topology.twin(h).map_or(h, |twin| twin.min(h)));
        }
    }
    vertices.len() as i64 - edges.len() as i64 + faces
}

fn euler(complex: &PatchComplex) -> i64 {
    let [v, e, f] = [complex.num_vertices(), complex.num_edges(), complex.num_patches()];
    v as i64 - e as i64 + f as i64
}

/// V - E + F of what only caps have: the holes that are there without them.
fn euler_of_caps(complex: &PatchComplex) -> i64 {
    let is_cap = |patch: PatchId| complex.place(patch).unwrap().role == Role::Cap;
    let only_caps = |edge: &PatchEdge| edge.uses().iter().all(|used| is_cap(used.patch));
    let of_caps = |id: &PatchEdgeId| only_caps(complex.edge(*id).unwrap());
    let faces = complex.patches().filter(|&(id, _)| is_cap(id)).count() as i64;
    let edges = complex.edges().filter(|(_, edge)| only_caps(edge)).count() as i64;
    let vertices = complex.vertices().filter(|&(id, _)| complex.edges_at(id).iter().all(of_caps));
    vertices.count() as i64 - edges + faces
}

/// The sides of every patch are cut without gaps, and its edges close around it.
fn check_patches(complex: &PatchComplex, name: &str) {
    for (id, _) in complex.patches() {
        let mut corners = Vec::new();
        for side in 0..4 {
            let mut at = 0.0;
            for &edge_id in complex.edges_of_side(id, side) {
                let edge = complex.edge(edge_id).unwrap();
                let of_side = edge.uses().iter().find(|u| u.patch == id && u.side == side).unwrap();
                assert_eq!(of_side.interval[0], at, "{name}: {id:?} side {side}");
                at = of_side.interval[1];
                let [a, b] = edge.vertices;
                corners.push(if of_side.is_forward { (a, b) } else { (b, a) });
            }
            assert_eq!(at, 1.0, "{name}: {id:?} side {side}");
        }
        for k in 0..corners.len() {
            assert_eq!(corners[k].1, corners[(k + 1) % corners.len()].0, "{name}: {id:?}");
        }
        assert_eq!(corners.len(), complex.edges_of_patch(id).len());
        for other in complex.neighbours(id) {
            assert!(complex.neighbours(other).any(|back| back == id), "{name}: {id:?} {other:?}");
        }
    }
}

/// Edges have the uses of their kind, and are of the kind that the cage says.
fn check_edges(surface: &Surface, complex: &PatchComplex, has_holes: bool, name: &str) {
    let topology = surface.cage().topology();
    for (id, edge) in complex.edges() {
        let is_interior = matches!(edge.kind, EdgeKind::Smooth | EdgeKind::Sharp);
        assert_eq!(edge.uses().len(), if is_interior { 2 } else { 1 }, "{name}: {edge:?}");
        assert!(edge.uses().iter().enumerate().all(|(k, used)| used.is_forward == (k == 0)));
        assert!(edge.kind != EdgeKind::Rim || has_holes, "{name}: {edge:?}");
        for v in edge.vertices {
            assert!(complex.edges_at(v).contains(&id));
        }
        let EdgePlace::CageEdge(h) = edge.place else {
            assert!(matches!(edge.kind, EdgeKind::Smooth | EdgeKind::Rim), "{name}: {edge:?}");
            continue;
        };
        let covered = |h| !surface.is_omitted(topology.face(h));
        let sides = [Some(h), topology.twin(h)].into_iter().flatten().filter(|&h| covered(h));
        let expected = match sides.count() {
            1 => [EdgeKind::Boundary; 2],
            _ if surface.is_infinitely_sharp(h) => [EdgeKind::Sharp, EdgeKind::Rim],
            _ => [EdgeKind::Smooth, EdgeKind::Rim],
        };
        assert!(expected.contains(&edge.kind), "{name}: {edge:?}");
    }
}

/// The largest difference of the borders of the two uses of an edge, as a part of the largest
/// coordinate; caps and the rest apart.
fn largest_difference(surface: &Surface, complex: &PatchComplex) -> [f64; 2] {
    let mut largest = [0.0_f64; 2];
    for (id, edge) in complex.edges().filter(|(_, edge)| edge.uses().len() == 2) {
        let [a, b] = [0, 1].map(|k| complex.border_of_use(surface, id, k).unwrap());
        let degree = a.degree().max(b.degree());
        let (a, b) = (a.raised(degree), b.raised(degree));
        let size = a.coefs().iter().map(|&p| norm(p)).fold(0.0, f64::max);
        let apart = a.coefs().iter().zip(b.coefs()).map(|(&p, &q)| norm(sub(p, q)));
        let is_cap = |k: usize| complex.place(edge.uses()[k].patch).unwrap().role == Role::Cap;
        let of_kind = &mut largest[usize::from(is_cap(0) || is_cap(1))];
        *of_kind = of_kind.max(apart.fold(0.0, f64::max) / size);
    }
    largest
}

/// Everything at one depth, without caps and, where there are caps, with them.
fn check(surface: &Surface, rings: usize, name: &str) -> [f64; 2] {
    let complex = PatchComplex::new(surface, rings).unwrap();
    let has_holes = !surface.extraordinary_points().is_empty();
    check_patches(&complex, name);
    check_edges(surface, &complex, has_holes, name);
    let [mut rest, mut caps] = largest_difference(surface, &complex);
    let mut with_caps = Surface::build(Arc::new(surface.cage().clone()), surface.options()).unwrap();
    let options = CapOptions { rings, ..CapOptions::default() };
    if with_caps.set_caps(Some(options)).is_err() {
        assert_ne!(surface.options().contraction, Contraction::CatmullClark, "{name}");
        assert!(rings == 0 || euler(&complex) == euler_of_cage(surface) - holes(surface), "{name}");
        return [rest, caps];
    }
    let whole = PatchComplex::new(&with_caps, rings).unwrap();
    check_patches(&whole, name);
    check_edges(&with_caps, &whole, false, name);
    assert_eq!(euler(&whole), euler_of_cage(surface), "{name}, {rings} rings with caps");
    assert_eq!(euler(&complex), euler(&whole) - euler_of_caps(&whole), "{name}, {rings} rings");
    if rings > 0 {
        assert_eq!(euler(&complex), euler_of_cage(surface) - holes(surface), "{name}");
    }
    let [a, b] = largest_difference(&with_caps, &whole);
    (rest, caps) = (rest.max(a), caps.max(b));
    [rest, caps]
}

/// V - E + F of the holes: of the sectors of points without their outer borders, and of the edges and
/// vertices that no other patch has.
fn holes(surface: &Surface) -> i64 {
    let topology = surface.cage().topology();
    let mut sum = 0;
    let mut of_points: BTreeSet<(VertexId, QuadId)> = BTreeSet::new();
    let mut vertices = BTreeSet::new();
    for point in surface.extraordinary_points() {
        let Some(vertex) = point.vertex else {
            // A disc around the centre of an n-gon.
            sum += 1;
            continue;
        };
        vertices.insert(vertex);
        for sector in &point.sectors {
            assert!(of_points.insert((vertex, sector.quad)));
        }
    }
    for &vertex in &vertices {
        let quad = |h| {
            let face = topology.face(h);
            let corners = topology.faces().corners(face).len();
            surface.quad(face, if corners == 4 { 0 } else { topology.corner(h) }).unwrap()
        };
        let has_hole = |h| of_points.contains(&(vertex, quad(h)));
        let is_covered = |h| !surface.is_omitted(topology.face(h));
        // Sectors that are holes; edges at the vertex without a patch on either side.
        let faces = topology.ring(vertex).filter(|&h| has_hole(h)).count() as i64;
        let mut edges = 0;
        for h in topology.ring(vertex) {
            let clockwise = topology.twin(h).map(|twin| topology.next(twin));
            let around = [Some(h), clockwise].into_iter().flatten().filter(|&h| is_covered(h));
            let around: Vec<_> = around.collect();
            edges += i64::from(!around.is_empty() && around.iter().all(|&h| has_hole(h)));
            // The last edge at a boundary leaves no half-edge.
            let last = topology.twin(topology.previous(h)).is_none();
            edges += i64::from(last && is_covered(h) && has_hole(h));
        }
        let all = topology.ring(vertex).filter(|&h| is_covered(h)).all(has_hole);
        sum += faces - edges + i64::from(all);
    }
    sum
}

/// As far apart as borders may be: rounding of coordinates.
const SAME: f64 = 1e-13;

#[test]
fn complexes_of_all_cages_are_surfaces_of_patches() {
    for (name, cage) in all_cages().into_iter().chain(feature_cages()) {
        let surface = common::surface(&cage, SchemeKind::default());
        for rings in DEPTHS {
            let [rest, caps] = check(&surface, rings, &name);
            println!("{name} {rings}: {rest:.1e} {caps:.1e}");
        }
    }
}
