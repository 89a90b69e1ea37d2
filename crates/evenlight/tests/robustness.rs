//! Random cages, closed and flat, with n-gons, boundaries, creases, corners and holes: whatever
//! passes the checks gives a surface in every scheme, and the surface is C2 where it should be,
//! without cracks, flat if the cage is, and its triangles are watertight.
#![allow(clippy::unwrap_used, reason = "a test that finds no surface fails")]

mod common;

use std::collections::BTreeMap;
use std::sync::Arc;

use common::Random;
use evenlight::analyse::caps::cap_report;
use evenlight::analyse::continuity::continuity;
use evenlight::cap::{CapKind, CapOptions};
use evenlight::mesh::{BoundaryRule, Corner, Crease, CreaseMethod};
use evenlight::surface::QuadId;
use evenlight::tessellate::{TriangleMesh, tessellate};
use evenlight::{Cage, FaceId, Mesh, Point, SchemeKind, Surface, VertexId};

/// A mesh under random changes of its faces.
#[derive(Clone)]
struct Sculpture {
    positions: Vec<Point>,
    faces: Vec<Vec<u32>>,
    is_flat: bool,
}

impl Sculpture {
    fn of(mesh: Mesh) -> Self {
        let faces = mesh.faces.iter().map(|f| f.iter().map(|v| v.0).collect()).collect();
        let is_flat = mesh.positions.iter().all(|p| p[2] == 0.0);
        Self { positions: mesh.positions, faces, is_flat }
    }

    fn torus() -> Self {
        Self::of(common::torus(7, 5))
    }

    fn sheet(random: &mut Random) -> Self {
        let mut mesh = common::fans::sheet(6, 5, random);
        mesh.positions.iter_mut().for_each(|p| p[2] = 0.0);
        Self::of(mesh)
    }

    /// The cage with a random few of its edges and vertices sharp, and perhaps a hole.
    fn tagged(&self, random: &mut Random) -> Arc<Cage> {
        let mut mesh = Mesh::new(self.positions.clone(), &self.faces);
        let tags = &mut mesh.tags;
        tags.boundary = [BoundaryRule::None, BoundaryRule::EdgeOnly, BoundaryRule::EdgeAndCorner]
            [random.below(3)];
        if random.below(2) == 0 {
            tags.crease_method = CreaseMethod::Chaikin;
        }
        let sharpness = |random: &mut Random| match random.below(3) {
            0 => 3.0 * random.unit(),
            _ => 10.0,
        };
        for (f, face) in self.faces.iter().enumerate() {
            for k in 0..face.len() {
                let edge = [face[k], face[(k + 1) % face.len()]].map(VertexId);
                if random.below(8) == 0 {
                    tags.creases.push(Crease { edge, sharpness: sharpness(random) });
                }
                if random.below(40) == 0 {
                    tags.corners.push(Corner { vertex: edge[0], sharpness: sharpness(random) });
                }
            }
            if random.below(40) == 0 {
                tags.holes.push(FaceId(f as u32));
            }
        }
        Arc::new(Cage::new(mesh).expect("the tags are on what is there"))
    }

    fn cage(&self) -> Option<Cage> {
        Cage::new(Mesh::new(self.positions.clone(), &self.faces)).ok()
    }

    /// One random change; what it leads to may not be a cage.
    fn change(&mut self, random: &mut Random) {
        match random.below(5) {
            0 => self.cut(random),
            1 => self.join(random),
            2 => self.poke(random),
            3 => self.remove(random),
            _ => self.jitter(random),
        }
    }

    /// Cuts a face along a diagonal.
    fn cut(&mut self, random: &mut Random) {
        let f = random.below(self.faces.len());
        let mut face = self.faces[f].clone();
        if face.len() < 4 {
            return;
        }
        let turn = random.below(face.len());
        face.rotate_left(turn);
        let k = 2 + random.below(face.len() - 3);
        self.faces[f] = face[..=k].to_vec();
        self.faces.push([&face[k..], &face[..1]].concat());
    }

    /// Joins a face with one that shares an edge.
    fn join(&mut self, random: &mut Random) {
        let f = random.below(self.faces.len());
        let mut face = self.faces[f].clone();
        let turn = random.below(face.len());
        face.rotate_left(turn);
        let (a, b) = (face[0], face[face.len() - 1]);
        let follows = |g: &Vec<u32>| (0..g.len()).find(|&k| g[k] == a && g[(k + 1) % g.len()] == b);
        let other = (0..self.faces.len()).find(|&g| g != f && follows(&self.faces[g]).is_some());
        let Some(g) = other else { return };
        let mut neighbour = self.faces[g].clone();
        let start = follows(&neighbour).unwrap_or(0);
        neighbour.rotate_left(start + 1);
        // The neighbour now begins with b and ends with a.
        neighbour.pop();
        face.extend(&neighbour[1..]);
        self.faces[f] = face;
        self.faces.swap_remove(g);
    }

    /// Puts a vertex into a face.
    fn poke(&mut self, random: &mut Random) {
        let f = random.below(self.faces.len());
        let face = self.faces.swap_remove(f);
        let n = face.len() as f64;
        let middle =
            [0, 1, 2].map(|k| face.iter().map(|&v| self.positions[v as usize][k]).sum::<f64>() / n);
        self.positions.push(middle);
        let v = self.positions.len() as u32 - 1;
        for k in 0..face.len() {
            self.faces.push(vec![face[k], face[(k + 1) % face.len()], v]);
        }
    }

    fn remove(&mut self, random: &mut Random) {
        if random.below(4) == 0 {
            self.faces.swap_remove(random.below(self.faces.len()));
        }
    }

    fn jitter(&mut self, random: &mut Random) {
        let v = random.below(self.positions.len());
        let moved = if self.is_flat { 2 } else { 3 };
        self.positions[v][..moved].iter_mut().for_each(|x| *x += random.unit() - 0.5);
    }
}

fn check(cage: &Arc<Cage>, seed: u64, schemes: &[SchemeKind]) {
    let mut random = Random::new(seed);
    for &scheme in schemes {
        let mut surface = common::surface(cage, scheme);
        for _ in 0..20 {
            if surface.num_quads() == 0 {
                break;
            }
            let quad = QuadId(random.below(surface.num_quads()) as u32);
            let found = surface.eval(quad, random.unit(), random.unit());
            assert_eq!(found.is_none(), surface.is_omitted(surface.face_of(quad).unwrap().0));
            assert!(found.is_none_or(|p| p.jet.p.iter().all(|x| x.is_finite())), "seed {seed}");
        }
        let found = continuity(&surface, 2, 1).expect("there are few patches");
        let jumps = found.all;
        assert!(jumps.parametric < 1e-9, "seed {seed}, {}: {jumps:?}", scheme.name());
        assert!(found.creases.defect.position < 1e-12, "seed {seed}: {:?}", found.creases);
        is_watertight(&surface, seed);
        if scheme == SchemeKind::Qas4 {
            surface.set_caps(Some(CapOptions { rings: 1, kind: CapKind::Bi4 })).expect("they fit");
            is_watertight(&surface, seed);
            for cap in cap_report(&surface) {
                for defect in [cap.lines, cap.inside, cap.ring] {
                    assert!(defect.position < 1e-12, "seed {seed}: {cap:?}");
                }
            }
        }
    }
}

/// The triangles join along all their edges but where the surface ends, and are flat over flat
/// cages.
fn is_watertight(surface: &Surface, seed: u64) {
    let mesh: TriangleMesh = tessellate(surface, 2).expect("few triangles");
    assert!(mesh.positions.iter().flatten().all(|x| x.is_finite()));
    if surface.positions().iter().all(|p| p[2] == 0.0) {
        assert!(mesh.positions.iter().all(|p| p[2] == 0.0), "seed {seed}: not flat");
    }
    let mut edges: BTreeMap<[u32; 2], i32> = BTreeMap::new();
    for [a, b, c] in mesh.triangles {
        for edge in [[a, b], [b, c], [c, a]] {
            *edges.entry(edge).or_default() += 1;
        }
    }
    assert!(edges.values().all(|&count| count == 1), "seed {seed}: an edge twice in one direction");
    let single = edges.keys().filter(|&&[a, b]| !edges.contains_key(&[b, a])).count();
    let topology = surface.topology();
    let has_surface = |h| !surface.is_omitted(topology.get(h).unwrap().face());
    let ends = topology
        .half_edges()
        .filter(|&h| has_surface(h) && !topology.twin(h).is_some_and(has_surface));
    assert_eq!(single, ends.count() * mesh.rate, "seed {seed}: open edges");
}

/// Sculptures of many changes, each step of which was a cage.
fn sculpt(seeds: std::ops::Range<u64>) {
    for seed in seeds {
        let mut random = Random::new(seed + 1);
        let mut sculpture =
            if seed % 4 < 2 { Sculpture::torus() } else { Sculpture::sheet(&mut random) };
        let mut cage = sculpture.cage().expect("a torus and a sheet are cages");
        for _ in 0..1 + random.below(40) {
            let mut changed = sculpture.clone();
            changed.change(&mut random);
            if let Some(new) = changed.cage() {
                (sculpture, cage) = (changed, new);
            }
        }
        if seed % 2 == 0 {
            check(&Arc::new(cage), seed, &SchemeKind::ALL);
        } else {
            check(
                &sculpture.tagged(&mut random),
                seed,
                &[SchemeKind::CatmullClark, SchemeKind::Qas4],
            );
        }
    }
}

#[test]
fn random_cages_give_surfaces() {
    sculpt(0..160);
}

#[test]
#[ignore = "slow: some minutes"]
fn ten_thousand_random_cages_give_surfaces() {
    sculpt(0..10_000);
}
