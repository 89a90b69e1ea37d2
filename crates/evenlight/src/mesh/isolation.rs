//! Isolation: which piece of surface covers which part of every face.
//!
//! An extraordinary point is *isolated* at the refinement level at which it is surrounded by
//! two rings of quads with regular direct and diagonal neighbours (a c-net). Faces are refined
//! only where that is needed:
//!
//! - a vertex is isolated at level 0 if its neighbours allow it; else at level 1 if all its
//!   faces are quads; else at level 2;
//! - the centre of an n-gon becomes a vertex at level 1, isolated there if the corners of the
//!   n-gon are regular, else at level 2;
//! - a face with four regular vertices is one bi-3 patch of level 0, whatever happens around.
//!
//! ```text
//!   face with one isolated      face whose corner is isolated     a quad beside an n-gon:
//!   extraordinary corner        at level 1                        four bi-3 patches
//!   +-----------+               +-----+-----+                     +-----+-----+
//!   |           |               | bi3 | bi3 |                     | bi3 | bi3 |
//!   |  sector   |               +-----+-----+                     +-----+-----+
//!   |           |               | sec.| bi3 |                     | bi3 | bi3 |
//!   e-----------+               e-----+-----+                     +-----+-----+
//! ```
//!
//! All levels describe one surface, so pieces of different levels join as smoothly as pieces
//! of the same. Topology only: nothing here knows positions.

use super::refine::Level;
use super::{FaceId, HalfEdgeId, Topology, VertexId};

/// The place of an extraordinary point in the cage.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Place {
    /// An interior vertex of valence other than 4.
    Vertex(VertexId),
    /// The centre of a face with other than four corners.
    FaceCentre(FaceId),
}

/// An extraordinary point before any surface is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Extraordinary {
    /// Where it is.
    pub place: Place,
    /// The number of edges that meet there.
    pub valence: usize,
    /// The level of refinement (0, 1 or 2) at which it is isolated.
    pub level: usize,
    /// Whether some face around it has a surface.
    pub is_covered: bool,
}

/// All extraordinary points, vertices first, each kind in the order of its numbers.
pub fn extraordinary_points(topology: &Topology) -> Vec<Extraordinary> {
    let vertices = (0..topology.num_vertices() as u32).map(VertexId);
    let vertices = vertices.filter(|&v| is_extraordinary(topology, v)).map(|v| Extraordinary {
        place: Place::Vertex(v),
        valence: topology.valence(v),
        level: vertex_level(topology, v),
        is_covered: topology.ring(v).any(|h| !is_omitted(topology, topology.face(h))),
    });
    let ngons = topology.faces().ids().filter(|&f| topology.faces().corners(f).len() != 4);
    let centres = ngons.map(|f| Extraordinary {
        place: Place::FaceCentre(f),
        valence: topology.faces().corners(f).len(),
        level: centre_level(topology, f),
        is_covered: !is_omitted(topology, f),
    });
    vertices.chain(centres).collect()
}

/// Whether no surface is made over a face: it touches the boundary.
pub fn is_omitted(topology: &Topology, face: FaceId) -> bool {
    topology.faces().corners(face).iter().any(|&v| topology.is_boundary(v))
}

fn is_extraordinary(topology: &Topology, v: VertexId) -> bool {
    topology.is_used(v) && !topology.is_boundary(v) && topology.valence(v) != 4
}

/// Whether all faces around `v` are quads.
fn has_quads(topology: &Topology, v: VertexId) -> bool {
    topology.ring(v).all(|h| topology.faces().corners(topology.face(h)).len() == 4)
}

/// Whether `v` is an inner vertex of a regular grid.
fn is_regular(topology: &Topology, v: VertexId) -> bool {
    !topology.is_boundary(v) && topology.valence(v) == 4 && has_quads(topology, v)
}

fn vertex_level(topology: &Topology, v: VertexId) -> usize {
    if !has_quads(topology, v) {
        return 2;
    }
    let neighbours = |h: HalfEdgeId| {
        let face = topology.faces().corners(topology.face(h));
        (1..=2).map(move |k| face[(topology.corner(h) + k) % 4])
    };
    let isolated = topology.ring(v).flat_map(neighbours).all(|w| is_regular(topology, w));
    usize::from(!isolated)
}

fn centre_level(topology: &Topology, f: FaceId) -> usize {
    let regular = |&v: &VertexId| !topology.is_boundary(v) && topology.valence(v) == 4;
    if topology.faces().corners(f).iter().all(regular) { 1 } else { 2 }
}

/// What covers a part of a parametric quad.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Piece {
    /// No surface.
    Omitted,
    /// A bi-3 patch: the number of its control net.
    Regular(u32),
    /// A sector of an extraordinary point.
    Sector {
        /// The number of the point.
        point: u32,
        /// The sector.
        sector: u32,
        /// The corner of the piece at which the point is.
        corner: u8,
    },
    /// Four pieces with consecutive numbers, at the corners in order.
    Split(u32),
}

/// The control net of a regular piece: the refinement level and the 4x4 vertices, the index
/// along v fastest.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RegularNet {
    pub(crate) level: u8,
    pub(crate) vertices: [VertexId; 16],
}

/// A sector of a point and the parametric quad, depth and corner at which it lies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SectorPlace {
    pub(crate) sector: usize,
    pub(crate) quad: u32,
    /// The square of the sector in the quad: its origin and size.
    pub(crate) origin: [f64; 2],
    pub(crate) size: f64,
    pub(crate) corner: usize,
}

/// All pieces of a surface.
#[derive(Debug)]
pub(crate) struct Plan {
    /// The refined parts of the cage: level 1 and, if needed, level 2.
    pub(crate) levels: Vec<Level>,
    /// The points with a surface around them.
    pub(crate) points: Vec<Extraordinary>,
    /// The half-edge of its level that leaves each point in front of sector 0.
    pub(crate) first_half_edges: Vec<HalfEdgeId>,
    /// The sectors of each point, without those in omitted faces.
    pub(crate) sectors: Vec<Vec<SectorPlace>>,
    /// The first parametric quad of every face, and the number of all quads.
    pub(crate) first_quads: Vec<u32>,
    /// All pieces, those of the parametric quads first.
    pub(crate) pieces: Vec<Piece>,
    pub(crate) nets: Vec<RegularNet>,
    pub(crate) omitted: Vec<FaceId>,
}

impl Plan {
    pub(crate) fn new(cage: &Topology) -> Self {
        let points: Vec<Extraordinary> =
            extraordinary_points(cage).into_iter().filter(|p| p.is_covered).collect();
        let levels = refined_levels(cage, &points);
        let mut planner = Planner::new(cage, &levels, &points);
        for face in cage.faces().ids() {
            planner.add_face(face);
        }
        let Planner { first_half_edges, sectors, first_quads, pieces, nets, omitted, .. } = planner;
        let first_half_edges = first_half_edges
            .into_iter()
            .map(|h| h.expect("a covered point has a face with a surface"))
            .collect();
        Self { levels, points, first_half_edges, sectors, first_quads, pieces, nets, omitted }
    }

    /// The connectivity of a level.
    pub(crate) fn topology<'a>(&'a self, cage: &'a Topology, level: usize) -> &'a Topology {
        if level == 0 { cage } else { self.levels[level - 1].topology() }
    }
}

/// Refines what must be refined: the faces that are split, and all faces that touch them,
/// since control nets reach one face further.
fn refined_levels(cage: &Topology, points: &[Extraordinary]) -> Vec<Level> {
    let split = faces_to_split(cage, points);
    if !split.contains(&true) {
        return Vec::new();
    }
    let first = Level::refine(cage, &with_neighbours(cage, &split));
    let deep = faces_to_split_again(cage, points, &first);
    if !deep.contains(&true) {
        return vec![first];
    }
    let second = Level::refine(first.topology(), &with_neighbours(first.topology(), &deep));
    vec![first, second]
}

/// The faces of the cage that are not one piece: n-gons, faces beside n-gons, faces at vertices
/// that are not isolated at level 0.
fn faces_to_split(cage: &Topology, points: &[Extraordinary]) -> Vec<bool> {
    let mut split = vec![false; cage.faces().len()];
    let mut split_ring = |v: VertexId| {
        cage.ring(v).for_each(|h| split[cage.face(h).index()] = true);
    };
    for point in points.iter().filter(|p| p.level > 0) {
        match point.place {
            Place::Vertex(v) => split_ring(v),
            Place::FaceCentre(f) => cage.faces().corners(f).iter().for_each(|&v| split_ring(v)),
        }
    }
    // An n-gon at the boundary has no surface, but its inner vertices are not regular.
    for f in cage.faces().ids().filter(|&f| cage.faces().corners(f).len() != 4) {
        cage.faces().corners(f).iter().for_each(|&v| split_ring(v));
    }
    for f in cage.faces().ids() {
        split[f.index()] &= !is_omitted(cage, f);
    }
    split
}

/// The faces of level 1 at the points that are isolated at level 2 only.
fn faces_to_split_again(cage: &Topology, points: &[Extraordinary], first: &Level) -> Vec<bool> {
    let mut split = vec![false; first.topology().faces().len()];
    for point in points.iter().filter(|p| p.level == 2) {
        let mut split_child = |f: FaceId, k: usize| {
            if !is_omitted(cage, f) {
                let child = first.child(f, k).expect("faces that are split have children");
                split[child.index()] = true;
            }
        };
        match point.place {
            Place::Vertex(v) => {
                cage.ring(v).for_each(|h| split_child(cage.face(h), cage.corner(h)));
            }
            Place::FaceCentre(f) => (0..point.valence).for_each(|k| split_child(f, k)),
        }
    }
    split
}

/// The chosen faces and all that share a vertex with them.
fn with_neighbours(topology: &Topology, chosen: &[bool]) -> Vec<bool> {
    let mut all = chosen.to_vec();
    for f in topology.faces().ids().filter(|f| chosen[f.index()]) {
        for &v in topology.faces().corners(f) {
            topology.ring(v).for_each(|h| all[topology.face(h).index()] = true);
        }
    }
    all
}

/// A face of some level and the square of a parametric quad that it covers.
#[derive(Clone, Copy, Debug)]
struct Tile {
    level: usize,
    face: FaceId,
    quad: u32,
    origin: [f64; 2],
    size: f64,
}

struct Planner<'a> {
    cage: &'a Topology,
    levels: &'a [Level],
    points: &'a [Extraordinary],
    /// The number of the point at every vertex and at every face's centre.
    at_vertex: Vec<u32>,
    at_centre: Vec<u32>,
    first_half_edges: Vec<Option<HalfEdgeId>>,
    sectors: Vec<Vec<SectorPlace>>,
    first_quads: Vec<u32>,
    pieces: Vec<Piece>,
    nets: Vec<RegularNet>,
    omitted: Vec<FaceId>,
}

const NONE: u32 = u32::MAX;

impl<'a> Planner<'a> {
    fn new(cage: &'a Topology, levels: &'a [Level], points: &'a [Extraordinary]) -> Self {
        let mut at_vertex = vec![NONE; cage.num_vertices()];
        let mut at_centre = vec![NONE; cage.faces().len()];
        for (number, point) in points.iter().enumerate() {
            match point.place {
                Place::Vertex(v) => at_vertex[v.index()] = number as u32,
                Place::FaceCentre(f) => at_centre[f.index()] = number as u32,
            }
        }
        let quads =
            |corners: &[VertexId]| if corners.len() == 4 { 1 } else { corners.len() as u32 };
        let mut first_quads = vec![0];
        first_quads.extend(cage.faces().iter().scan(0, |sum, corners| {
            *sum += quads(corners);
            Some(*sum)
        }));
        let num_quads = first_quads[cage.faces().len()] as usize;
        Self {
            cage,
            levels,
            points,
            at_vertex,
            at_centre,
            first_half_edges: vec![None; points.len()],
            sectors: vec![Vec::new(); points.len()],
            first_quads,
            pieces: vec![Piece::Omitted; num_quads],
            nets: Vec::new(),
            omitted: Vec::new(),
        }
    }

    fn topology(&self, level: usize) -> &'a Topology {
        if level == 0 { self.cage } else { self.levels[level - 1].topology() }
    }

    fn add_face(&mut self, face: FaceId) {
        if is_omitted(self.cage, face) {
            self.omitted.push(face);
            return;
        }
        let quad = self.first_quads[face.index()];
        let corners = self.cage.faces().corners(face).len();
        let whole = Tile { level: 0, face, quad, origin: [0.0; 2], size: 1.0 };
        if corners == 4 {
            self.pieces[quad as usize] = self.face_piece(whole);
            return;
        }
        for k in 0..corners {
            let child = self.child(0, face, k);
            let quad = quad + k as u32;
            let tile = Tile { level: 1, face: child, quad, ..whole };
            // The extraordinary points are at corner 0, the vertex, and corner 2, the centre.
            let points = [self.point_at_corner(face, k), NONE, self.at_centre[face.index()], NONE];
            self.pieces[quad as usize] = self.refined_piece(tile, points);
        }
    }

    fn child(&self, level: usize, face: FaceId, k: usize) -> FaceId {
        self.levels[level].child(face, k).expect("faces that are split have children")
    }

    fn point_at_corner(&self, face: FaceId, k: usize) -> u32 {
        self.at_vertex[self.cage.faces().corners(face)[k].index()]
    }

    /// The piece of a whole quad of the cage.
    fn face_piece(&mut self, tile: Tile) -> Piece {
        let corners = self.cage.faces().corners(tile.face);
        if corners.iter().all(|&v| is_regular(self.cage, v)) {
            return self.regular(tile);
        }
        let isolated = (0..4).find(|&k| {
            let point = self.point_at_corner(tile.face, k);
            point != NONE && self.points[point as usize].level == 0
        });
        if let Some(corner) = isolated {
            return self.sector(tile, self.point_at_corner(tile.face, corner), corner);
        }
        let points = [0, 1, 2, 3].map(|k| self.point_at_corner(tile.face, k));
        self.split(tile, |k| {
            let mut at = [NONE; 4];
            at[k] = points[k];
            at
        })
    }

    /// The piece of a quad of level 1 or 2 with these extraordinary points at its corners.
    fn refined_piece(&mut self, tile: Tile, points: [u32; 4]) -> Piece {
        let Some(corner) = (0..4).find(|&k| points[k] != NONE) else { return self.regular(tile) };
        let point = points[corner];
        if self.points[point as usize].level == tile.level {
            return self.sector(tile, point, corner);
        }
        self.split(tile, |k| {
            let mut at = [NONE; 4];
            at[k] = points[k];
            at
        })
    }

    fn split(&mut self, tile: Tile, points: impl Fn(usize) -> [u32; 4]) -> Piece {
        let first = self.pieces.len();
        self.pieces.extend([Piece::Omitted; 4]);
        for (k, [du, dv]) in CORNERS.into_iter().enumerate() {
            let size = 0.5 * tile.size;
            let child = Tile {
                level: tile.level + 1,
                face: self.child(tile.level, tile.face, k),
                origin: [tile.origin[0] + du * size, tile.origin[1] + dv * size],
                size,
                ..tile
            };
            self.pieces[first + k] = self.refined_piece(child, points(k));
        }
        Piece::Split(first as u32)
    }

    fn regular(&mut self, tile: Tile) -> Piece {
        let topology = self.topology(tile.level);
        let vertices = regular_net(topology, topology.half_edge(tile.face, 0));
        self.nets.push(RegularNet { level: tile.level as u8, vertices });
        Piece::Regular(self.nets.len() as u32 - 1)
    }

    fn sector(&mut self, tile: Tile, point: u32, corner: usize) -> Piece {
        let topology = self.topology(tile.level);
        let h = topology.half_edge(tile.face, corner);
        let mut ring = topology.ring(topology.origin(h));
        let first = ring.clone().next().expect("the vertex has this sector");
        self.first_half_edges[point as usize] = Some(first);
        let sector = ring.position(|other| other == h).expect("h leaves the vertex");
        let Tile { quad, origin, size, .. } = tile;
        let place = SectorPlace { sector, quad, origin, size, corner };
        self.sectors[point as usize].push(place);
        Piece::Sector { point, sector: sector as u32, corner: corner as u8 }
    }
}

/// The corners of the unit square in the order of a face's corners.
pub(crate) const CORNERS: [[f64; 2]; 4] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];

/// The 4x4 control net of a face with regular vertices, `h` leaving its corner 0.
///
/// Each of the four faces that touch a corner of the face only gives four nodes:
///
/// ```text
///  v ^  3--7-11-15
///    |  2--6-10-14      node (i,j) is number 4 i + j, i along u;
///    |  1--5--9-13      the face itself is 5 9 10 6
///    |  0--4--8-12 -> u
/// ```
fn regular_net(t: &Topology, h: HalfEdgeId) -> [VertexId; 16] {
    let across = |h: HalfEdgeId| t.twin(h).expect("edges at regular vertices are interior");
    let forward_u = |h| t.next(across(t.next(h)));
    let back_u = |h| t.previous(across(t.previous(h)));
    let forward_v = |h| across(t.next(t.next(h)));
    let back_v = |h| t.next(t.next(across(h)));
    let mut net = [VertexId(0); 16];
    let mut put = |h: HalfEdgeId, i: usize, j: usize| {
        let (mut h, places) = (h, [4 * i + j, 4 * (i + 1) + j, 4 * (i + 1) + j + 1, 4 * i + j + 1]);
        for place in places {
            net[place] = t.origin(h);
            h = t.next(h);
        }
    };
    put(back_v(back_u(h)), 0, 0);
    put(back_v(forward_u(h)), 2, 0);
    put(forward_v(back_u(h)), 0, 2);
    put(forward_v(forward_u(h)), 2, 2);
    net
}

/// The vertices of a c-net, per sector in the order (0,1), (0,2), (1,1), (1,2), (2,1), (2,2),
/// around an isolated vertex; `first` leaves it in front of sector 0.
pub(crate) fn cnet_vertices(t: &Topology, first: HalfEdgeId) -> Vec<[VertexId; 6]> {
    let across = |h: HalfEdgeId| t.twin(h).expect("edges around an isolated vertex are interior");
    let forward_a = |h| t.next(across(t.next(h)));
    let forward_b = |h| across(t.next(t.next(h)));
    let upper_left = |h| t.origin(t.previous(h));
    let upper_right = |h| t.target(t.next(h));
    t.ring(t.origin(first))
        .map(|h| {
            let (right, above) = (forward_a(h), forward_b(h));
            [
                upper_left(h),
                upper_left(above),
                upper_right(h),
                upper_right(above),
                upper_right(right),
                upper_right(forward_b(right)),
            ]
        })
        .collect()
}
