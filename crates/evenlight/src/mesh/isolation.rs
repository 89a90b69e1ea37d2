//! Isolation: which piece of surface covers which part of every face.
//!
//! A quad is a bi-3 patch if its four corners are regular: inner vertices of valence 4,
//! vertices on a regular crease, or corners of one face ([`Fan::is_regular`]). Any other vertex is
//! *isolated* at the refinement level at which nothing at it changes any more and two rings of
//! faces around it are regular. Then it is an extraordinary point and the faces around it are its
//! sectors. Faces that are neither patches nor sectors are refined, locally:
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
//! Without semi-sharp features two levels are enough, one if there are quads only. An edge or
//! vertex of sharpness s takes s levels more, at most ten. Its faces are refined along it; when it
//! has become smooth, the points around it are points of a smooth surface.
//!
//! All levels describe one surface, so pieces of different levels join as smoothly as pieces
//! of one level. This module needs topology and sharpness only, no positions.

use std::collections::{BTreeMap, HashMap};

use super::fan::{Features, PlacedFan, sectors};
use super::nets::RegularNet;
use super::refine::{Level, Origin};
use super::sharpness::{Beyond, Sharpness, half_edges_of, single};
use super::{
    BoundaryRule, Cage, FaceId, Fan, HalfEdgeId, INFINITELY_SHARP, Tags, Topology, VertexId,
    VertexRule,
};

/// The place of an extraordinary point in the cage.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Place {
    /// A vertex.
    Vertex(VertexId),
    /// The centre of a face that does not have four corners.
    FaceCentre(FaceId),
}

/// An extraordinary point before any surface is made.
///
/// A vertex on sharp edges is one point for each fan that is not regular.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Extraordinary {
    /// Where it is.
    pub place: Place,
    /// The number of edges that meet there.
    pub valence: usize,
    /// The faces around it.
    pub fan: Fan,
    /// The level of refinement at which it is isolated.
    pub level: usize,
    /// Whether some face of the fan has a surface; if not, the level is unknown.
    pub is_covered: bool,
    /// Whether the vertex or an edge at it was semi-sharp and has become smooth.
    pub was_semi_sharp: bool,
}

/// All extraordinary points: vertices first, each kind in the order of its numbers. Points without
/// a surface around them come last; only their valence makes them extraordinary.
pub fn extraordinary_points(cage: &Cage, boundary: BoundaryRule) -> Vec<Extraordinary> {
    let plan = Plan::new(cage.topology(), cage.tags(), boundary, BTreeMap::new());
    let mut points = plan.points;
    points.extend(uncovered_points(cage, boundary));
    points
}

fn uncovered_points(cage: &Cage, boundary: BoundaryRule) -> Vec<Extraordinary> {
    let t = cage.topology();
    let omitted = omitted_faces(cage, boundary);
    let is_omitted = |f: FaceId| omitted.binary_search(&f).is_ok();
    let point = |place: Place, valence: usize| Extraordinary {
        place,
        valence,
        fan: Fan { faces: valence, is_closed: true, has_dart: false, rule: VertexRule::Smooth },
        level: 0,
        is_covered: false,
        was_semi_sharp: false,
    };
    let vertices = (0..t.num_vertices() as u32).map(VertexId);
    let vertices = vertices
        .filter(|&v| t.is_used(v) && !t.is_boundary(v) && t.valence(v) != 4)
        .filter(|&v| t.ring(v).all(|h| is_omitted(t.face(h))))
        .map(|v| point(Place::Vertex(v), t.valence(v)));
    let centres = t.faces().ids().zip(t.faces().iter());
    let centres = centres
        .filter(|&(f, corners)| corners.len() != 4 && is_omitted(f))
        .map(|(f, corners)| point(Place::FaceCentre(f), corners.len()));
    vertices.chain(centres).collect()
}

/// Whether no surface is made over a face, see [`omitted_faces`]. Takes time linear in the size of
/// the cage.
pub fn is_omitted(cage: &Cage, boundary: BoundaryRule, face: FaceId) -> bool {
    omitted_faces(cage, boundary).binary_search(&face).is_ok()
}

/// The faces without a surface, in order: holes, and under the rule "none" faces with a vertex on
/// the boundary, unless tags make both boundary edges there infinitely sharp.
pub fn omitted_faces(cage: &Cage, boundary: BoundaryRule) -> Vec<FaceId> {
    omitted(cage.topology(), cage.tags(), boundary)
}

fn omitted(topology: &Topology, tags: &Tags, boundary: BoundaryRule) -> Vec<FaceId> {
    let mut omitted = tags.holes.clone();
    if boundary == BoundaryRule::None {
        let is_open = open_vertices(topology, tags);
        let faces = topology.faces();
        let touches = |f: &FaceId| faces.corners(*f).iter().any(|v| is_open[v.index()]);
        omitted.extend(faces.ids().filter(touches));
    }
    omitted.sort_unstable();
    omitted.dedup();
    omitted
}

/// For each vertex, whether it is at an edge of the boundary that no tag makes infinitely sharp.
fn open_vertices(topology: &Topology, tags: &Tags) -> Vec<bool> {
    let mut is_sharp = vec![false; topology.half_edges().len()];
    for crease in &tags.creases {
        for h in half_edges_of(topology, crease.edge) {
            is_sharp[h.index()] = single(crease.sharpness) >= INFINITELY_SHARP;
        }
    }
    let mut is_open = vec![false; topology.num_vertices()];
    let boundary = topology.half_edges().filter(|&h| topology.twin(h).is_none());
    for h in boundary.filter(|h| !is_sharp[h.index()]) {
        is_open[topology.origin(h).index()] = true;
        is_open[topology.target(h).index()] = true;
    }
    is_open
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
        /// The corner of the piece at which the point lies.
        corner: u8,
    },
    /// Four pieces with consecutive numbers, at the corners in order.
    Split(u32),
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
    /// The refined parts of the cage: levels 1, 2, ...
    pub(crate) levels: Vec<Level>,
    /// The sharpness of the cage and of all levels.
    pub(crate) sharpness: Vec<Sharpness>,
    /// The points with a surface around them.
    pub(crate) points: Vec<Extraordinary>,
    /// The half-edge of its level that leaves each point in front of sector 0.
    pub(crate) first_half_edges: Vec<HalfEdgeId>,
    /// The sectors of each point, without sectors in omitted faces.
    pub(crate) sectors: Vec<Vec<SectorPlace>>,
    /// The first parametric quad of every face, and the number of all quads.
    pub(crate) first_quads: Vec<u32>,
    /// All pieces; the pieces that are whole parametric quads come first.
    pub(crate) pieces: Vec<Piece>,
    pub(crate) nets: Vec<RegularNet>,
    pub(crate) omitted: Vec<FaceId>,
}

impl Plan {
    pub(crate) fn new(
        t: &Topology,
        tags: &Tags,
        boundary: BoundaryRule,
        beyond: BTreeMap<VertexId, Beyond>,
    ) -> Self {
        let omitted = omitted(t, tags, boundary);
        let mut sharpness = vec![Sharpness::new(t, tags, boundary).with_beyond(beyond)];
        let mut levels: Vec<Level> = Vec::new();
        let mut planner = Planner::new(t);
        let mut split = planner.cover_cage(&Features::new(t, &sharpness[0]), &omitted);
        // Ends after twelve levels at most: ten until nothing is semi-sharp any more, one until
        // all faces are quads, one until points are apart.
        while !split.is_empty() {
            let (coarse, coarse_sharpness) = (topology_of(t, &levels), sharpness.last());
            let coarse_sharpness = coarse_sharpness.expect("that of the cage is the first");
            let faces = split.iter().map(|tile| tile.face);
            let chosen = neighbourhood(coarse, faces, coarse_sharpness.is_averaged());
            let level = Level::refine(coarse, &chosen);
            let fine_sharpness = level.sharpness(coarse, coarse_sharpness);
            let tiles = planner.split(coarse, &level, &split);
            levels.push(level);
            sharpness.push(fine_sharpness);
            let last = sharpness.last().expect("one was put there");
            let features = Features::new(topology_of(t, &levels), last);
            split = planner.cover_tiles(&features, &levels, tiles);
        }
        for point in &mut planner.points {
            if let Place::Vertex(v) = point.place {
                point.was_semi_sharp = sharpness[0].is_semi_sharp_at(t, v);
            }
        }
        planner.finish(levels, sharpness, omitted)
    }

    /// The connectivity of a level.
    pub(crate) fn topology<'a>(&'a self, cage: &'a Topology, level: usize) -> &'a Topology {
        topology_of(cage, &self.levels[..level])
    }

    /// The fan of a point, at the level at which it is isolated.
    pub(crate) fn placed_fan(&self, point: usize) -> PlacedFan {
        PlacedFan { shape: self.points[point].fan, first: self.first_half_edges[point] }
    }
}

/// The connectivity of the last of these levels.
fn topology_of<'a>(cage: &'a Topology, levels: &'a [Level]) -> &'a Topology {
    levels.last().map_or(cage, Level::topology)
}

/// The faces to refine so that all is known around the children of `faces`: the faces that share a
/// vertex with them, since control nets reach one face further. If the sharpness of edges depends
/// on their neighbours, one face more.
fn neighbourhood(
    topology: &Topology,
    faces: impl Iterator<Item = FaceId>,
    is_averaged: bool,
) -> Vec<bool> {
    let mut chosen = vec![false; topology.faces().len()];
    faces.for_each(|f| chosen[f.index()] = true);
    for _ in 0..if is_averaged { 2 } else { 1 } {
        chosen = with_neighbours(topology, &chosen);
    }
    chosen
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

/// A face of some level, the square of a parametric quad that it covers, and the piece that is to
/// cover it.
#[derive(Clone, Copy, Debug)]
struct Tile {
    piece: u32,
    level: usize,
    face: FaceId,
    quad: u32,
    origin: [f64; 2],
    size: f64,
}

/// What is known of a corner of a face.
#[derive(Clone, Copy, Debug)]
enum CornerState {
    /// The face may be a bi-3 patch.
    Regular,
    /// The sector of a point.
    Isolated { point: u32, sector: u32 },
    /// The face must be refined.
    Unsettled,
}

struct Planner {
    points: Vec<Extraordinary>,
    /// The place of every point among those at the same vertex.
    orders: Vec<usize>,
    first_half_edges: Vec<HalfEdgeId>,
    sectors: Vec<Vec<SectorPlace>>,
    first_quads: Vec<u32>,
    pieces: Vec<Piece>,
    nets: Vec<RegularNet>,
    /// The corners of the level in hand that are not inner vertices of a regular, smooth grid.
    corners: HashMap<HalfEdgeId, CornerState>,
}

impl Planner {
    fn new(cage: &Topology) -> Self {
        let quads =
            |corners: &[VertexId]| if corners.len() == 4 { 1 } else { corners.len() as u32 };
        let mut first_quads = vec![0];
        first_quads.extend(cage.faces().iter().scan(0, |sum, corners| {
            *sum += quads(corners);
            Some(*sum)
        }));
        let num_quads = first_quads[cage.faces().len()] as usize;
        Self {
            points: Vec::new(),
            orders: Vec::new(),
            first_half_edges: Vec::new(),
            sectors: Vec::new(),
            first_quads,
            pieces: vec![Piece::Omitted; num_quads],
            nets: Vec::new(),
            corners: HashMap::new(),
        }
    }

    /// Covers the faces that need no refinement; returns the others.
    fn cover_cage(&mut self, features: &Features, omitted: &[FaceId]) -> Vec<Tile> {
        let faces = features.topology.faces();
        let mut split = Vec::new();
        let mut omitted = omitted.iter().peekable();
        for (face, corners) in faces.ids().zip(faces.iter()) {
            if omitted.next_if_eq(&&face).is_some() {
                continue;
            }
            let quad = self.first_quads[face.index()];
            let tile = Tile { piece: quad, level: 0, face, quad, origin: [0.0; 2], size: 1.0 };
            if corners.len() != 4 || !self.cover(features, &[], tile) {
                split.push(tile);
            }
        }
        split
    }

    /// Covers the tiles that need no refinement; returns the others.
    fn cover_tiles(
        &mut self,
        features: &Features,
        levels: &[Level],
        tiles: Vec<Tile>,
    ) -> Vec<Tile> {
        self.corners.clear();
        tiles.into_iter().filter(|&tile| !self.cover(features, levels, tile)).collect()
    }

    /// The children of tiles.
    fn split(&mut self, coarse: &Topology, level: &Level, tiles: &[Tile]) -> Vec<Tile> {
        let mut children = Vec::with_capacity(4 * tiles.len());
        for &tile in tiles {
            let num_corners = coarse.faces().corners(tile.face).len();
            let child = |k: usize| Tile {
                level: tile.level + 1,
                face: level.child(tile.face, k).expect("faces that are split have children"),
                ..tile
            };
            if num_corners != 4 {
                // Every corner of an n-gon is a parametric quad.
                let quad = |k: usize| tile.quad + k as u32;
                let of = |k: usize| Tile { piece: quad(k), quad: quad(k), ..child(k) };
                children.extend((0..num_corners).map(of));
                continue;
            }
            let first = self.pieces.len() as u32;
            self.pieces.extend([Piece::Omitted; 4]);
            self.pieces[tile.piece as usize] = Piece::Split(first);
            let size = 0.5 * tile.size;
            children.extend(CORNERS.into_iter().enumerate().map(|(k, [du, dv])| Tile {
                piece: first + k as u32,
                origin: [tile.origin[0] + du * size, tile.origin[1] + dv * size],
                size,
                ..child(k)
            }));
        }
        children
    }

    /// Covers a tile with one piece, if that is possible.
    fn cover(&mut self, features: &Features, levels: &[Level], tile: Tile) -> bool {
        let t = features.topology;
        let mut isolated = None;
        let mut is_smooth = true;
        for k in 0..4 {
            let h = t.half_edge(tile.face, k);
            if features.is_regular(t.origin(h)) {
                continue;
            }
            is_smooth = false;
            match self.corner(features, levels, h) {
                CornerState::Regular => {}
                CornerState::Isolated { point, sector } => isolated = Some((point, sector, k)),
                CornerState::Unsettled => return false,
            }
        }
        let piece = match isolated {
            Some((point, sector, corner)) => self.sector(tile, point, sector, corner),
            None => self.regular(features, tile, is_smooth),
        };
        self.pieces[tile.piece as usize] = piece;
        true
    }

    /// What is known of the corner that `h` leaves; it is found once for the whole fan.
    fn corner(&mut self, features: &Features, levels: &[Level], h: HalfEdgeId) -> CornerState {
        if let Some(&known) = self.corners.get(&h) {
            return known;
        }
        let v = features.topology.origin(h);
        let fan = features.has_quads(v).then(|| features.fan(h)).flatten();
        let Some(fan) = fan else {
            self.corners.insert(h, CornerState::Unsettled);
            return CornerState::Unsettled;
        };
        let of_sector = if fan.shape.is_regular() {
            |_, _| CornerState::Regular
        } else if features.is_isolated(fan) {
            self.add_point(features, levels, fan);
            |point, sector| CornerState::Isolated { point, sector }
        } else {
            |_, _| CornerState::Unsettled
        };
        let point = self.points.len().saturating_sub(1) as u32;
        for (s, h) in sectors(features.topology, fan).enumerate() {
            self.corners.insert(h, of_sector(point, s as u32));
        }
        self.corners[&h]
    }

    fn add_point(&mut self, features: &Features, levels: &[Level], fan: PlacedFan) {
        let t = features.topology;
        let v = t.origin(fan.first);
        self.points.push(Extraordinary {
            place: place(levels, v),
            valence: t.valence(v),
            fan: fan.shape,
            level: levels.len(),
            is_covered: true,
            was_semi_sharp: false,
        });
        self.orders.push(t.ring(v).position(|h| h == fan.first).unwrap_or(0));
        self.first_half_edges.push(fan.first);
        self.sectors.push(Vec::new());
    }

    fn sector(&mut self, tile: Tile, point: u32, sector: u32, corner: usize) -> Piece {
        let Tile { quad, origin, size, .. } = tile;
        let place = SectorPlace { sector: sector as usize, quad, origin, size, corner };
        self.sectors[point as usize].push(place);
        Piece::Sector { point, sector, corner: corner as u8 }
    }

    fn regular(&mut self, features: &Features, tile: Tile, is_smooth: bool) -> Piece {
        let t = features.topology;
        let h = t.half_edge(tile.face, 0);
        let net = if is_smooth {
            RegularNet::smooth(t, h, tile.level)
        } else {
            let edge = |k: usize| features.sharpness.edge(t, t.half_edge(tile.face, k));
            let sharp = [0, 1, 2, 3].map(|k| edge(k) > 0.0);
            RegularNet::with_sharp_sides(t, h, tile.level, sharp)
        };
        self.nets.push(net);
        Piece::Regular(self.nets.len() as u32 - 1)
    }

    /// The plan, with the points in the order of their places.
    fn finish(self, levels: Vec<Level>, sharpness: Vec<Sharpness>, omitted: Vec<FaceId>) -> Plan {
        let Self { points, orders, first_half_edges, mut sectors, .. } = self;
        let mut order: Vec<usize> = (0..points.len()).collect();
        order.sort_by_key(|&p| (points[p].place, orders[p]));
        let mut number = vec![0; points.len()];
        order.iter().zip(0..).for_each(|(&p, new)| number[p] = new);
        let mut pieces = self.pieces;
        for piece in &mut pieces {
            if let Piece::Sector { point, .. } = piece {
                *point = number[*point as usize];
            }
        }
        Plan {
            levels,
            sharpness,
            points: order.iter().map(|&p| points[p]).collect(),
            first_half_edges: order.iter().map(|&p| first_half_edges[p]).collect(),
            sectors: order.iter().map(|&p| std::mem::take(&mut sectors[p])).collect(),
            first_quads: self.first_quads,
            pieces,
            nets: self.nets,
            omitted,
        }
    }
}

/// Where a vertex of the last level comes from.
///
/// Vertices that refinement puts on edges and into quads are regular as soon as nothing at them
/// is semi-sharp, so a point comes from a vertex of the cage or from an n-gon.
fn place(levels: &[Level], v: VertexId) -> Place {
    let mut v = v;
    for level in levels.iter().rev() {
        match level.origin(v) {
            Origin::Vertex(coarse) => v = coarse,
            Origin::Face(f) => return Place::FaceCentre(f),
            Origin::Edge(_) => unreachable!("vertices on edges are regular once they are settled"),
        }
    }
    Place::Vertex(v)
}

/// The corners of the unit square in the order of a face's corners.
pub(crate) const CORNERS: [[f64; 2]; 4] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
