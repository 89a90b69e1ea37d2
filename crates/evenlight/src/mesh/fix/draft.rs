//! A mesh between the repairs: every vertex, face and corner remembers where it comes from.

use std::collections::HashSet;

use super::Change;
use crate::mesh::{Corner, Crease, FaceId, Faces, Interpolation, Mesh, Primvar, Tags, VertexId};

/// A corner of a face.
#[derive(Clone, Copy, Debug)]
pub(super) struct DraftCorner {
    /// The vertex of the draft.
    pub vertex: u32,
    /// The place among all corners of the mesh.
    source: u32,
}

/// A face that is not deleted.
#[derive(Clone, Debug)]
pub(super) struct DraftFace {
    /// The face of the mesh.
    pub source: FaceId,
    pub corners: Vec<DraftCorner>,
}

impl DraftFace {
    /// Reverses the order, from the same first corner.
    pub fn flip(&mut self) {
        if let [_, others @ ..] = &mut self.corners[..] {
            others.reverse();
        }
    }

    /// The edges in order, as pairs of places of corners.
    pub fn edges(&self) -> impl Iterator<Item = [usize; 2]> + use<> {
        let n = self.corners.len();
        (0..n).map(move |k| [k, (k + 1) % n])
    }

    /// Joins neighbouring corners at one vertex; says whether three corners are left.
    fn collapse(&mut self) -> bool {
        self.corners.dedup_by_key(|corner| corner.vertex);
        while let [first, .., last] = self.corners[..]
            && first.vertex == last.vertex
        {
            self.corners.pop();
        }
        self.corners.len() >= 3
    }
}

/// The mesh and the mesh that it becomes.
pub(super) struct Draft<'a> {
    pub mesh: &'a Mesh,
    pub faces: Vec<DraftFace>,
    /// The vertex of the mesh from which each vertex of the draft comes; old vertices are first.
    pub sources: Vec<u32>,
    /// For every vertex of the mesh the vertex that it was merged into, or itself.
    pub merged: Vec<u32>,
    /// Whether a vertex of the draft is left out.
    is_dropped: Vec<bool>,
}

impl<'a> Draft<'a> {
    pub fn new(mesh: &'a Mesh) -> Self {
        let mut source = 0..;
        let mut corner =
            |v: &VertexId| DraftCorner { vertex: v.0, source: source.next().unwrap_or(u32::MAX) };
        let mut face = |(source, corners): (FaceId, &[VertexId])| DraftFace {
            source,
            corners: corners.iter().map(&mut corner).collect(),
        };
        let faces = mesh.faces.ids().zip(mesh.faces.iter()).map(&mut face).collect();
        let all: Vec<u32> = (0..mesh.positions.len() as u32).collect();
        let is_dropped = vec![false; all.len()];
        Self { mesh, faces, sources: all.clone(), merged: all, is_dropped }
    }

    /// The faces with two corners in a row at one vertex.
    pub fn faces_with_repeats(&self) -> Vec<FaceId> {
        let vertex = |face: &DraftFace, k: usize| face.corners[k].vertex;
        let repeats = |face: &&DraftFace| {
            face.corners.len() >= 3 && face.edges().any(|[a, b]| vertex(face, a) == vertex(face, b))
        };
        self.faces.iter().filter(repeats).map(|face| face.source).collect()
    }

    /// Moves all corners to what their vertices were merged into; gives the faces this deletes.
    pub fn apply_merged(&mut self) -> Vec<FaceId> {
        for corner in self.faces.iter_mut().flat_map(|face| &mut face.corners) {
            corner.vertex = self.merged[corner.vertex as usize];
        }
        for (v, &into) in self.merged.iter().enumerate() {
            self.is_dropped[v] = into != v as u32;
        }
        let mut deleted = Vec::new();
        self.faces.retain_mut(|face| {
            // If a face had too few corners before, the check will name it.
            let had_three = face.corners.len() >= 3;
            let is_kept = face.collapse() || !had_three;
            if !is_kept {
                deleted.push(face.source);
            }
            is_kept
        });
        deleted
    }

    /// A new vertex: a copy of `vertex` with another number.
    pub fn copy_vertex(&mut self, vertex: u32) -> u32 {
        self.sources.push(self.sources[vertex as usize]);
        self.is_dropped.push(false);
        self.sources.len() as u32 - 1
    }

    /// Leaves out the vertices in no face.
    pub fn drop_unused(&mut self) -> Option<Change> {
        let mut is_used = vec![false; self.sources.len()];
        for corner in self.faces.iter().flat_map(|face| &face.corners) {
            is_used[corner.vertex as usize] = true;
        }
        let mut vertices = Vec::new();
        for (v, is_used) in is_used.into_iter().enumerate() {
            if !is_used && !self.is_dropped[v] {
                self.is_dropped[v] = true;
                vertices.push(VertexId(self.sources[v]));
            }
        }
        (!vertices.is_empty()).then_some(Change::Dropped { vertices })
    }

    /// The repaired mesh.
    pub fn finish(self) -> Mesh {
        let numbers = self.numbers();
        let kept = || self.sources.iter().zip(&self.is_dropped).filter(|(_, dropped)| !**dropped);
        let sources: Vec<usize> = kept().map(|(&source, _)| source as usize).collect();
        let mut faces = Faces::default();
        for face in &self.faces {
            let vertex = |c: &DraftCorner| VertexId(numbers[c.vertex as usize].unwrap_or(0));
            faces.push(face.corners.iter().map(vertex));
        }
        let positions = sources.iter().map(|&v| self.mesh.positions[v]).collect();
        let primvars = self.mesh.primvars.iter().map(|p| self.primvar(p, &sources)).collect();
        let tags = self.tags(&numbers, &faces);
        Mesh { positions, faces, tags, primvars }
    }

    /// The final number of every vertex of the draft.
    fn numbers(&self) -> Vec<Option<u32>> {
        let mut next = 0..;
        let number = |&is_dropped: &bool| if is_dropped { None } else { next.next() };
        self.is_dropped.iter().map(number).collect()
    }

    fn primvar(&self, primvar: &Primvar, sources: &[usize]) -> Primvar {
        let mut primvar = primvar.clone();
        match primvar.interpolation {
            Interpolation::FaceVarying => {
                let corners = self.faces.iter().flat_map(|face| &face.corners);
                let index = |c: &DraftCorner| primvar.indices.get(c.source as usize).copied();
                primvar.indices = corners.filter_map(index).collect();
            }
            Interpolation::Vertex | Interpolation::Varying => {
                let width = primvar.width;
                let value = |&v: &usize| primvar.values.get(width * v..width * (v + 1));
                primvar.values = sources.iter().filter_map(value).flatten().copied().collect();
            }
        }
        primvar
    }

    /// Tags in final numbers. All copies of a sharp vertex are sharp; of the copies of a sharp edge
    /// all that are edges.
    fn tags(&self, numbers: &[Option<u32>], faces: &Faces) -> Tags {
        let mut copies: Vec<Vec<u32>> = vec![Vec::new(); self.mesh.positions.len()];
        for (v, number) in numbers.iter().enumerate() {
            copies[self.sources[v] as usize].extend(number);
        }
        let of = |v: VertexId| {
            let merged = self.merged.get(v.index());
            merged.map_or(&[][..], |&v| &copies[v as usize])
        };
        let tags = &self.mesh.tags;
        let corners = tags.corners.iter().flat_map(|corner| {
            of(corner.vertex).iter().map(|&v| Corner { vertex: VertexId(v), ..*corner })
        });
        let edges = if copies.iter().any(|copies| copies.len() > 1) {
            edges(faces)
        } else {
            HashSet::new()
        };
        let creases = tags.creases.iter().flat_map(|crease| {
            let [a, b] = crease.edge.map(of);
            let is_single = a.len() == 1 && b.len() == 1;
            let pairs = a.iter().flat_map(move |&a| b.iter().map(move |&b| [a, b]));
            let is_edge =
                |&[a, b]: &[u32; 2]| a != b && (is_single || edges.contains(&[a.min(b), a.max(b)]));
            let pairs = pairs.filter(is_edge).collect::<Vec<_>>();
            pairs.into_iter().map(|edge| Crease { edge: edge.map(VertexId), ..*crease })
        });
        let mut face_numbers = vec![None; self.mesh.faces.len()];
        for (k, face) in self.faces.iter().enumerate() {
            face_numbers[face.source.index()] = Some(FaceId(k as u32));
        }
        let hole = |face: &FaceId| face_numbers.get(face.index()).copied().flatten();
        let holes = tags.holes.iter().filter_map(hole).collect();
        Tags { corners: corners.collect(), creases: creases.collect(), holes, ..tags.clone() }
    }
}

/// All edges, the lower vertex first.
fn edges(faces: &Faces) -> HashSet<[u32; 2]> {
    let of_face = |corners: &[VertexId]| {
        let n = corners.len();
        let edge = |k: usize| [corners[k].0, corners[(k + 1) % n].0];
        (0..n).map(edge).map(|[a, b]| [a.min(b), a.max(b)]).collect::<Vec<_>>()
    };
    faces.iter().flat_map(of_face).collect()
}
