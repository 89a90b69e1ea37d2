//! The patches of a surface as one complex: patches, the edges where two of them meet, and the
//! vertices where edges end.
//!
//! ```text
//!   +-------+-------+-------+   Around an extraordinary point e the patches of ring k+1
//!   |       |       |       |   are half as wide as those of ring k, so that a side may
//!   |       |   A   |       |   meet several others (T). It is cut there: the lower side
//!   |       |       |       |   of patch A is two *uses* of two edges. An edge has
//!   |       +---T---+-------+
//!   |       | C | D |       |   two uses  where two patches meet: one polynomial for both;
//!   |       +---+---+       |   one use   at the boundary of the surface, beside faces
//!   |       | . | E |       |             without a surface, and at the rim of a hole (.),
//!   +-------e---+---+-------+             which is there without caps.
//! ```
//!
//! The complex is made from the connectivity of the cage and from the rules of its points, with
//! whole numbers (module `exact`): no two places are taken for one because they are near each
//! other, at any depth of the rings, whatever the positions are.
//!
//! ```
//! use evenlight::complex::{EdgeKind, PatchComplex};
//! use evenlight::io::load::Format;
//! use evenlight::{QuadId, Surface, SurfaceOptions};
//!
//! let text = "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\n\
//!             v -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n\
//!             f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
//! let (cage, _) = Format::Obj.read_cage(text.as_bytes())?;
//! let surface = Surface::build(cage, SurfaceOptions::default())?;
//!
//! // Two rings around each of the eight points.
//! let complex = PatchComplex::new(surface.layout(), 2, None)?;
//! assert_eq!(complex.num_patches(), 6 * (4 * 2 * 3));
//! let rims = complex.edges().filter(|(_, edge)| edge.kind == EdgeKind::Rim).count();
//! assert_eq!(rims, 8 * 3 * 2, "eight holes, each in three sectors with two sides");
//! let [v, e, f] = [complex.num_vertices(), complex.num_edges(), complex.num_patches()];
//! assert_eq!(v + f, e + 2 - 8, "a sphere with eight holes");
//!
//! // The patch at a place, and its neighbours.
//! let patch = complex.locate(QuadId(0), 0.5, 0.4).expect("this is not in a hole");
//! assert!(complex.neighbours(patch).all(|other| other != patch));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod border;
mod build;
mod carrier;
mod exact;
mod pair;
mod piece;

pub use border::Border;

use std::sync::Arc;

use crate::cap::CapError;
use crate::mesh::{FaceId, HalfEdgeId, VertexId};
use crate::surface::{CapPlan, Layout, PatchPlace, QuadId};
use piece::Numbers;

/// The number of a patch, in the order of [`Surface::patch_places`](crate::Surface::patch_places).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct PatchId(pub u32);

/// The number of an edge between patches: first those on edges of the cage, then those on lines of
/// n-gons, then those inside parametric quads.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct PatchEdgeId(pub u32);

/// The number of a vertex at which patches meet: first those at vertices of the cage, then centres
/// of n-gons, then those on edges of the cage, on lines of n-gons, and inside parametric quads.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct PatchVertexId(pub u32);

impl PatchId {
    /// The number as an index into an array.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

impl PatchEdgeId {
    /// The number as an index into an array.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

impl PatchVertexId {
    /// The number as an index into an array.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// How the surface goes on across an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum EdgeKind {
    /// Two patches in one parametrisation: C2 but at caps; [`cap`](crate::cap) says how those
    /// join. Semi-sharp edges of the cage are smooth.
    Smooth,
    /// Two patches that may form an angle, on an infinitely sharp edge of the cage.
    Sharp,
    /// One patch, at the boundary of the cage or beside a face without a surface.
    Boundary,
    /// One patch, and a hole behind rings without a cap.
    Rim,
}

/// Where an edge lies, with a coordinate along it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EdgePlace {
    /// On an edge of the cage, from 0 at the origin of the lower half-edge to 1.
    CageEdge(HalfEdgeId),
    /// Between the quads `corner` and `corner + 1` of an n-gon, from 0 on the edge to 1 at the
    /// centre.
    FaceLine {
        /// The n-gon.
        face: FaceId,
        /// The corner of the first of the two quads.
        corner: usize,
    },
    /// On the line v = `at` inside a parametric quad, along u.
    AlongU {
        /// The parametric quad.
        quad: QuadId,
        /// The value of v.
        at: f64,
    },
    /// On the line u = `at` inside a parametric quad, along v.
    AlongV {
        /// The parametric quad.
        quad: QuadId,
        /// The value of u.
        at: f64,
    },
}

/// Where a vertex lies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum VertexPlace {
    /// At a vertex of the cage.
    Vertex(VertexId),
    /// At the centre of an n-gon.
    FaceCentre(FaceId),
    /// On an edge of the cage, its coordinate as in [`EdgePlace::CageEdge`].
    OnEdge(HalfEdgeId, f64),
    /// On a line of an n-gon.
    OnFaceLine {
        /// The n-gon.
        face: FaceId,
        /// As in [`EdgePlace::FaceLine`].
        corner: usize,
        /// The coordinate along the line.
        at: f64,
    },
    /// Inside a parametric quad, at (u,v).
    Inside(QuadId, [f64; 2]),
}

/// A part of a side of a patch, as one edge has it.
///
/// ```text
///        side 2
///      + <----- +        Sides run counter-clockwise, each with a parameter from 0 to 1:
///      |        ^        v = 0, u = 1, v = 1, u = 0.
/// side |  patch | side
///   3  v        |   1
///      + -----> +
///        side 0
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EdgeUse {
    /// The patch.
    pub patch: PatchId,
    /// Which of its sides.
    pub side: u8,
    /// The part of the side, from lower to higher parameter.
    pub interval: [f64; 2],
    /// Whether the side runs from the first vertex of the edge to the second. The side of the
    /// first use does, the side of a second use does not.
    pub is_forward: bool,
}

impl EdgeUse {
    /// The patch's own (u,v) at `t` from 0 to 1 along the edge.
    pub fn parameters(&self, t: f64) -> [f64; 2] {
        let [from, to] = self.interval;
        let t = if self.is_forward { t } else { 1.0 - t };
        let s = from + t * (to - from);
        match self.side {
            0 => [s, 0.0],
            1 => [1.0, s],
            2 => [1.0 - s, 1.0],
            _ => [0.0, 1.0 - s],
        }
    }
}

/// A curve in which two patches meet, or at which the surface ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PatchEdge {
    /// Where it begins and ends, as its first use runs.
    pub vertices: [PatchVertexId; 2],
    /// How the surface goes on beyond.
    pub kind: EdgeKind,
    /// On which line it lies.
    pub place: EdgePlace,
    /// The coordinates along that line of its two vertices.
    pub interval: [f64; 2],
    uses: [EdgeUse; 2],
    num_uses: u8,
}

impl PatchEdge {
    /// The sides of patches that it is a part of, one or two.
    pub fn uses(&self) -> &[EdgeUse] {
        &self.uses[..usize::from(self.num_uses)]
    }

    /// The patch on the other side of the edge than `patch`.
    pub fn across(&self, patch: PatchId) -> Option<PatchId> {
        match self.uses() {
            [a, b] if a.patch == patch => Some(b.patch),
            [a, b] if b.patch == patch => Some(a.patch),
            _ => None,
        }
    }
}

/// Why there is no complex.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ComplexError {
    /// There are no such caps.
    #[error(transparent)]
    Cap(#[from] CapError),
    /// The rings become too small to be told apart.
    #[error("{rings} rings are too many for a complex, whose numbers have room for {most}")]
    TooDeep {
        /// The rings asked for.
        rings: usize,
        /// So many are possible.
        most: usize,
    },
    /// Patches or edges cannot be numbered with 32 bits.
    #[error("the patches or the edges are too many to be numbered with 32 bits")]
    TooMany,
}

/// All patches of a surface to some depth, and the edges and vertices where they meet: the same for
/// all surfaces over one layout.
#[derive(Clone, Debug)]
pub struct PatchComplex {
    layout: Arc<Layout>,
    /// The caps, if there are patches of them.
    caps: Option<Arc<CapPlan>>,
    places: Vec<PatchPlace>,
    numbers: Numbers,
    edges: Vec<PatchEdge>,
    /// The edges of every side of every patch, counter-clockwise.
    edges_of_sides: Lists,
    vertices: Vec<VertexPlace>,
    /// The edges at every vertex.
    edges_of_vertices: Lists,
}

/// Lists of edges, one after the other.
#[derive(Clone, Debug, Default)]
struct Lists {
    /// Where each list begins, and the length of all.
    starts: Vec<u32>,
    edges: Vec<PatchEdgeId>,
}

impl Lists {
    fn get(&self, lists: std::ops::Range<usize>) -> &[PatchEdgeId] {
        let at = |k: usize| self.starts.get(k).copied().unwrap_or(0) as usize;
        self.edges.get(at(lists.start)..at(lists.end)).unwrap_or(&[])
    }
}

impl PatchComplex {
    /// The layout of the surfaces that have this complex.
    pub fn layout(&self) -> &Arc<Layout> {
        &self.layout
    }

    /// The number of patches.
    pub fn num_patches(&self) -> usize {
        self.places.len()
    }

    /// The number of edges.
    pub fn num_edges(&self) -> usize {
        self.edges.len()
    }

    /// The number of vertices.
    pub fn num_vertices(&self) -> usize {
        self.vertices.len()
    }

    /// All patches: what each is part of (face, extraordinary point, ring, sector) and where it
    /// lies.
    pub fn patches(&self) -> impl ExactSizeIterator<Item = (PatchId, &PatchPlace)> {
        self.places.iter().enumerate().map(|(k, place)| (PatchId(k as u32), place))
    }

    /// All edges.
    pub fn edges(&self) -> impl ExactSizeIterator<Item = (PatchEdgeId, &PatchEdge)> {
        self.edges.iter().enumerate().map(|(k, edge)| (PatchEdgeId(k as u32), edge))
    }

    /// All vertices.
    pub fn vertices(&self) -> impl ExactSizeIterator<Item = (PatchVertexId, VertexPlace)> + '_ {
        self.vertices.iter().enumerate().map(|(k, &place)| (PatchVertexId(k as u32), place))
    }

    /// What a patch is part of, and where it lies; `None` if there is no such patch.
    pub fn place(&self, patch: PatchId) -> Option<&PatchPlace> {
        self.places.get(patch.index())
    }

    /// An edge; `None` if there is no such edge.
    pub fn edge(&self, edge: PatchEdgeId) -> Option<&PatchEdge> {
        self.edges.get(edge.index())
    }

    /// Where a vertex lies; `None` if there is no such vertex.
    pub fn vertex(&self, vertex: PatchVertexId) -> Option<VertexPlace> {
        self.vertices.get(vertex.index()).copied()
    }

    /// The edges of side `side` (0 to 3) of a patch, counter-clockwise; none if there is no such
    /// side.
    pub fn edges_of_side(&self, patch: PatchId, side: u8) -> &[PatchEdgeId] {
        let k = 4 * patch.index() + usize::from(side.min(3));
        let exists = side < 4 && patch.index() < self.places.len();
        if exists { self.edges_of_sides.get(k..k + 1) } else { &[] }
    }

    /// The edges around a patch, counter-clockwise from its corner (0,0); none if there is no such
    /// patch.
    pub fn edges_of_patch(&self, patch: PatchId) -> &[PatchEdgeId] {
        let exists = patch.index() < self.places.len();
        if exists { self.edges_of_sides.get(4 * patch.index()..4 * patch.index() + 4) } else { &[] }
    }

    /// The edges that begin or end at a vertex, in their order.
    pub fn edges_at(&self, vertex: PatchVertexId) -> &[PatchEdgeId] {
        let exists = vertex.index() < self.vertices.len();
        if exists { self.edges_of_vertices.get(vertex.index()..vertex.index() + 1) } else { &[] }
    }

    /// The patches across the edges of a patch, counter-clockwise; one that shares several edges
    /// with it comes as many times.
    pub fn neighbours(&self, patch: PatchId) -> impl Iterator<Item = PatchId> + '_ {
        let edges = self.edges_of_patch(patch).iter();
        edges.filter_map(move |edge| self.edges[edge.index()].across(patch))
    }

    /// The patch at (u,v) of `quad`, which are clamped to 0..1; on a border between patches of one
    /// quad the one that [`Surface::eval_as`](crate::Surface::eval_as) asks. `None` if there is no
    /// surface, no such quad, in a hole behind rings without a cap, on its rim, and if a parameter
    /// is NaN.
    pub fn locate(&self, quad: QuadId, u: f64, v: f64) -> Option<PatchId> {
        let place = self.layout.place_at(quad, [u, v], self.caps.as_deref())?;
        self.numbers.number(&place).map(PatchId)
    }
}
