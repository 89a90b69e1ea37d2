//! The complex of patches: a surface with boundary made of polynomial patches, cut nowhere twice.

#![allow(clippy::unwrap_used, reason = "a test that cannot build its surface fails")]

mod common;

use std::collections::BTreeSet;
use std::sync::Arc;

use common::{Random, all_cages, cage, feature_cages, options};
use evenlight::cap::CapOptions;
use evenlight::complex::{
    ComplexError, EdgeKind, EdgePlace, PatchComplex, PatchEdge, PatchEdgeId, PatchId,
    PatchVertexId, VertexPlace,
};
use evenlight::mesh::BoundaryRule;
use evenlight::patch::Jet;
use evenlight::point::{Vector, add, norm, scale, sub};
use evenlight::surface::{CreaseRings, Role};
use evenlight::{Cage, Contraction, QuadId, SchemeKind, Surface, SurfaceOptions, VertexId};

/// The depths at which complexes are made.
const DEPTHS: [usize; 5] = [0, 1, 2, 3, 20];

/// V - E + F of the faces with a surface.
fn euler_of_cage(surface: &Surface) -> i64 {
    let topology = surface.topology();
    let (mut vertices, mut edges, mut faces) = (BTreeSet::<VertexId>::new(), BTreeSet::new(), 0);
    for face in topology.faces().ids().filter(|&f| !surface.is_omitted(f)) {
        faces += 1;
        vertices.extend(topology.faces().corners(face));
        for k in 0..topology.faces().corners(face).len() {
            let h = topology.half_edge_at(face, k).unwrap().id();
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
    let topology = surface.topology();
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
        let covered = |h| !surface.is_omitted(topology.get(h).unwrap().face());
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
        let (a, b) = (a.raised(degree).unwrap(), b.raised(degree).unwrap());
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
    let complex = PatchComplex::of(surface, rings).unwrap();
    let has_holes = !surface.extraordinary_points().is_empty();
    check_patches(&complex, name);
    check_edges(surface, &complex, has_holes, name);
    let [mut rest, mut caps] = largest_difference(surface, &complex);
    let mut with_caps = surface.with_positions(surface.positions().to_vec()).unwrap();
    let options = CapOptions { rings, ..CapOptions::default() };
    if with_caps.set_caps(Some(options)).is_err() {
        assert_ne!(surface.options().contraction, Contraction::CatmullClark, "{name}");
        assert!(rings == 0 || euler(&complex) == euler_of_cage(surface) - holes(surface), "{name}");
        return [rest, caps];
    }
    let whole = PatchComplex::of(&with_caps, rings).unwrap();
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

/// V - E + F of the holes: of the sectors of points without their outer borders, and of the edges
/// and vertices that no other patch has.
fn holes(surface: &Surface) -> i64 {
    let topology = surface.topology();
    let mut sum = 0;
    let mut of_points: BTreeSet<(VertexId, QuadId)> = BTreeSet::new();
    let mut vertices = BTreeSet::new();
    for point in surface.extraordinary_points() {
        let Some(vertex) = point.vertex() else {
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
            let face = topology.get(h).unwrap().face();
            let corners = topology.faces().corners(face).len();
            surface
                .quad(face, if corners == 4 { 0 } else { topology.get(h).unwrap().corner() })
                .unwrap()
        };
        let has_hole = |h| of_points.contains(&(vertex, quad(h)));
        let is_covered = |h| !surface.is_omitted(topology.get(h).unwrap().face());
        // Sectors that are holes; edges at the vertex without a patch on either side.
        let faces = topology.ring(vertex).filter(|&h| has_hole(h)).count() as i64;
        let mut edges = 0;
        for h in topology.ring(vertex) {
            let clockwise = topology.get(h).unwrap().twin().map(|twin| twin.next().id());
            let around = [Some(h), clockwise].into_iter().flatten().filter(|&h| is_covered(h));
            let around: Vec<_> = around.collect();
            edges += i64::from(!around.is_empty() && around.iter().all(|&h| has_hole(h)));
            // The last edge at a boundary leaves no half-edge.
            let last = topology.get(h).unwrap().previous().twin().is_none();
            edges += i64::from(last && is_covered(h) && has_hole(h));
        }
        let all = topology.ring(vertex).filter(|&h| is_covered(h)).all(has_hole);
        sum += faces - edges + i64::from(all);
    }
    sum
}

/// How far borders may be apart, as a part of the largest coordinate: a few units of rounding. A
/// wrong pair would be off by the size of a patch, which is 1e-8 or more of the cage even in ring
/// 20.
const SAME: f64 = 1e-13;

fn check_all_depths(surface: &Surface, depths: &[usize], name: &str) {
    for &rings in depths {
        let [rest, caps] = check(surface, rings, name);
        assert!(rest.max(caps) < SAME, "{name}, {rings} rings: {rest:e}, caps {caps:e}");
    }
}

#[test]
fn complexes_of_all_cages_are_surfaces_of_patches() {
    for (name, cage) in all_cages().into_iter().chain(feature_cages()) {
        check_all_depths(&common::surface(&cage, SchemeKind::default()), &DEPTHS, &name);
    }
}

/// N-gons and boundaries, semi-sharp features, junctions and darts, holes, valence 2.
const CAGES: [&str; 7] = [
    "features/polygons_creased.obj",
    "features/polygons_boundary.obj",
    "features/crease_graded.obj",
    "features/star6_junction.obj",
    "features/star5_dart.obj",
    "features/holes.obj",
    "features/valence_two.obj",
];

/// All schemes, rings beside creases, contractions and rules at the boundary.
fn all_options() -> Vec<SurfaceOptions> {
    let mut all = Vec::new();
    for scheme in SchemeKind::ALL {
        all.push(options(scheme));
        all.push(SurfaceOptions { creases: CreaseRings::Fair, ..options(scheme) });
        let contractions = [Contraction::Half, Contraction::Lambda(0.42)];
        let fitting = contractions.into_iter().filter(|&c| scheme.check_contraction(c).is_ok());
        all.extend(fitting.map(|contraction| SurfaceOptions { contraction, ..options(scheme) }));
    }
    let rules = [BoundaryRule::None, BoundaryRule::EdgeOnly, BoundaryRule::EdgeAndCorner];
    let default = SurfaceOptions::default();
    all.extend(rules.map(|rule| SurfaceOptions { boundary: Some(rule), ..default }));
    all
}

#[test]
fn complexes_of_all_schemes_are_surfaces_of_patches() {
    for name in CAGES {
        let cage = cage(name);
        for options in all_options() {
            let surface = Surface::build(cage.clone(), options).unwrap();
            check_all_depths(&surface, &DEPTHS, &format!("{name} {options:?}"));
        }
    }
}

/// The point of a use at `t` along its edge: position, derivative along the edge and inwards, both
/// by a coordinate of the edge's line that is 1 over the edge.
fn at_edge(
    surface: &Surface,
    complex: &PatchComplex,
    edge: &PatchEdge,
    which: usize,
    t: f64,
) -> [Vector; 3] {
    let used = edge.uses()[which];
    let place = complex.place(used.patch).unwrap();
    let own = used.parameters(t);
    let [u, v] = [0, 1].map(|d| {
        let [from, to] = place.domain[d];
        from + own[d] * (to - from)
    });
    let Jet { p, du, dv, .. } = surface.eval_on(place, u, v).unwrap().jet;
    let face = surface.face_of(place.quad).unwrap().0;
    let is_half = matches!(edge.place, EdgePlace::CageEdge(_))
        && surface.topology().faces().corners(face).len() != 4;
    let [from, to] = edge.interval;
    let unit = (to - from).abs() * if is_half { 2.0 } else { 1.0 };
    let direction = if used.is_forward { unit } else { -unit };
    let (along, inwards) = match used.side {
        0 => (du, dv),
        1 => (dv, scale(-1.0, du)),
        2 => (scale(-1.0, du), scale(-1.0, dv)),
        _ => (scale(-1.0, dv), du),
    };
    [p, scale(direction, along), scale(unit, inwards)]
}

/// Derivatives have full precision at any depth, unlike coordinates: what is compared here is
/// compared with the size of the patches themselves.
#[test]
fn patches_go_on_across_their_edges_in_one_parametrisation() {
    let cages = all_cages().into_iter().step_by(5).chain(feature_cages());
    let mut largest = 0.0_f64;
    for (name, cage) in cages {
        let mut surface = common::surface(&cage, SchemeKind::default());
        for caps in [None, Some(CapOptions { rings: 20, ..CapOptions::default() })] {
            surface.set_caps(caps).unwrap();
            let complex = PatchComplex::of(&surface, 20).unwrap();
            for (_, edge) in complex.edges().filter(|(_, edge)| edge.uses().len() == 2) {
                let is_cap =
                    edge.uses().iter().any(|u| complex.place(u.patch).unwrap().role == Role::Cap);
                for t in [0.25, 0.5, 0.875] {
                    let [a, b] = [0, 1].map(|which| at_edge(&surface, &complex, edge, which, t));
                    let size = norm(a[1]) + norm(a[2]);
                    let along = norm(sub(a[1], b[1]));
                    assert!(along <= 1e-10 * size, "{name}: {along:e} of {size:e}, {edge:?}");
                    if edge.kind == EdgeKind::Smooth && !is_cap {
                        let across = norm(add(a[2], b[2]));
                        largest = largest.max(along.max(across) / size);
                        assert!(across <= 1e-10 * size, "{name}: {across:e} of {size:e}, {edge:?}");
                    }
                }
            }
        }
    }
    println!("{largest:e}");
}

#[test]
fn a_place_is_in_the_patch_that_is_located() {
    let mut random = Random::new(11);
    for (name, cage) in all_cages().into_iter().step_by(9).chain(feature_cages()) {
        for (scheme, rings, capped) in [
            (SchemeKind::Qas4, 3, false),
            (SchemeKind::Guided3, 2, true),
            (SchemeKind::Qas3, 1, false),
            (SchemeKind::Qas4, 0, true),
        ] {
            let mut surface = common::surface(&cage, scheme);
            let options = CapOptions { rings, ..CapOptions::default() };
            surface.set_caps(capped.then_some(options)).unwrap();
            let complex = PatchComplex::of(&surface, rings).unwrap();
            for quad in (0..surface.num_quads() as u32).map(QuadId) {
                for k in 0..20 {
                    // Anywhere, and where borders are.
                    let [u, v] = [0, 1].map(|_| match k {
                        0..10 => random.unit(),
                        10..15 => random.below(17) as f64 / 16.0,
                        _ => random.below(13) as f64 / 12.0,
                    });
                    check_place(&surface, &complex, rings, (quad, [u, v]), &name);
                }
            }
        }
    }
}

fn check_place(
    surface: &Surface,
    complex: &PatchComplex,
    rings: usize,
    (quad, [u, v]): (QuadId, [f64; 2]),
    name: &str,
) {
    let expected = surface.eval(quad, u, v);
    let Some(patch) = complex.locate(quad, u, v) else {
        let is_in_hole = is_in_hole(surface, rings, quad, [u, v]);
        assert!(expected.is_none() || is_in_hole, "{name}: {quad:?} {u} {v}");
        return;
    };
    let place = complex.place(patch).unwrap();
    assert_eq!(place.quad, quad);
    for (x, [from, to]) in [u, v].into_iter().zip(place.domain) {
        assert!(from - 1e-15 <= x && x <= to + 1e-15, "{name}: {x} in {place:?}");
    }
    let (found, expected) = (surface.eval_on(place, u, v).unwrap().jet.p, expected.unwrap().jet.p);
    assert!(norm(sub(found, expected)) <= 1e-14 * norm(expected).max(1.0), "{name} {place:?}");
}

/// Whether a place is in the hole behind so many rings.
fn is_in_hole(surface: &Surface, rings: usize, quad: QuadId, [u, v]: [f64; 2]) -> bool {
    let mut points = surface.extraordinary_points().iter().enumerate();
    points.any(|(point, of_point)| {
        of_point.sectors.iter().filter(|sector| sector.quad == quad).any(|sector| {
            let step = [u - sector.center[0], v - sector.center[1]];
            let [a, b] = sector.along.map(|line| {
                (step[0] * line[0] + step[1] * line[1]) / (line[0] * line[0] + line[1] * line[1])
            });
            let hole = surface.rings(point).unwrap().sigma().powi(rings as i32);
            a.min(b) >= 0.0 && a.max(b) <= hole
        })
    })
}

#[test]
fn vertices_are_where_the_patches_say() {
    let cage = cage("own_polygons.obj");
    let surface = common::surface(&cage, SchemeKind::default());
    let complex = PatchComplex::of(&surface, 2).unwrap();
    for (_, edge) in complex.edges() {
        for used in edge.uses() {
            for (end, t) in edge.vertices.into_iter().zip([0.0, 1.0]) {
                let place = complex.place(used.patch).unwrap();
                let own = used.parameters(t);
                let uv: [f64; 2] = std::array::from_fn(|d| {
                    let [from, to] = place.domain[d];
                    from + own[d] * (to - from)
                });
                let expected = position(&surface, complex.vertex(end).unwrap());
                let found = surface.eval_on(place, uv[0], uv[1]).unwrap().jet.p;
                assert!(norm(sub(found, expected)) < 1e-14 * norm(expected).max(1.0));
            }
        }
    }
}

/// The point of the surface at a vertex of the complex.
fn position(surface: &Surface, place: VertexPlace) -> Vector {
    let topology = surface.topology();
    let quad = |face, corner| surface.quad(face, corner).unwrap();
    let at = |quad, [u, v]: [f64; 2]| surface.eval(quad, u, v).unwrap().jet.p;
    let on_edge = |h, t: f64| {
        let (face, k) = (topology.get(h).unwrap().face(), topology.get(h).unwrap().corner());
        let corners = topology.faces().corners(face).len();
        match (corners, t <= 0.5) {
            (4, _) => at(quad(face, 0), [[t, 0.0], [1.0, t], [1.0 - t, 1.0], [0.0, 1.0 - t]][k]),
            (_, true) => at(quad(face, k), [2.0 * t, 0.0]),
            (_, false) => at(quad(face, (k + 1) % corners), [0.0, 2.0 - 2.0 * t]),
        }
    };
    match place {
        VertexPlace::Vertex(v) => on_edge(topology.ring(v).next().unwrap(), 0.0),
        VertexPlace::FaceCentre(face) => at(quad(face, 0), [1.0, 1.0]),
        VertexPlace::OnEdge(h, t) => on_edge(h, t),
        VertexPlace::OnFaceLine { face, corner, at: t } => at(quad(face, corner), [1.0, t]),
        VertexPlace::Inside(quad, uv) => at(quad, uv),
    }
}

#[test]
fn what_does_not_exist_is_none() {
    let surface = common::surface(&cage("obstacle/flat_n5.obj"), SchemeKind::default());
    let complex = PatchComplex::of(&surface, 1).unwrap();
    let (patch, edge, vertex) = (PatchId(u32::MAX), PatchEdgeId(u32::MAX), PatchVertexId(u32::MAX));
    assert_eq!(complex.place(patch), None);
    assert_eq!(complex.edge(edge), None);
    assert_eq!(complex.vertex(vertex), None);
    assert_eq!(complex.border(&surface, edge), None);
    assert_eq!(complex.border_of_use(&surface, PatchEdgeId(0), 2), None);
    assert!(complex.edges_of_patch(patch).is_empty() && complex.edges_at(vertex).is_empty());
    assert!(complex.edges_of_side(PatchId(0), 4).is_empty());
    assert_eq!(complex.neighbours(patch).count(), 0);
    assert_eq!(complex.locate(QuadId(u32::MAX), 0.5, 0.5), None);
    assert_eq!(complex.locate(QuadId(0), f64::NAN, 0.5), None);
    let at_end = complex.locate(QuadId(0), 1.0, 1.0);
    assert_eq!(complex.locate(QuadId(0), 2.0, f64::INFINITY), at_end);
}

#[test]
fn a_hundred_rings_are_possible_and_no_more() {
    let cage = cage("obstacle/flat_n5.obj");
    let surface = common::surface(&cage, SchemeKind::default());
    check_all_depths(&surface, &[100], "flat_n5");
    for rings in [101, usize::MAX] {
        let error = PatchComplex::of(&surface, rings).unwrap_err();
        assert_eq!(error, ComplexError::TooDeep { rings, most: 100 });
    }
    let torus = Arc::new(Cage::new(common::torus(4, 5)).unwrap());
    let regular = common::surface(&torus, SchemeKind::default());
    let complex = PatchComplex::of(&regular, usize::MAX).unwrap();
    assert_eq!((complex.num_patches(), complex.num_edges(), complex.num_vertices()), (20, 40, 20));
}
