//! Vertices for graphics: one normal, one texture coordinate, one colour each.
//!
//! ```text
//!        3 vertices, sides 0 1 2         5 split vertices
//!
//!              2                              2   4
//!            / | \        the right         / |   | \
//!          /   |   \      triangle has    /   |   |   \      0 1 2: the sides with their
//!        0 --- 1 --- 0'   other values   0 -- 1   3 -- 0'    first values
//!                         along 1 2
//! ```

use super::{CornerValues, TriangleMesh};

/// The vertices of a mesh, split where sides or values of primvars differ.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SplitVertices {
    /// The side of each split vertex; the first are the sides themselves.
    pub sides: Vec<u32>,
    /// For each primvar the number of the value of each split vertex.
    pub values: Vec<Vec<u32>>,
    /// The corners of the triangles, as numbers of split vertices.
    pub triangles: Vec<[u32; 3]>,
}

/// No split vertex.
const NONE: u32 = u32::MAX;

impl TriangleMesh {
    /// Splits vertices so that each has one normal and one value of every primvar, which must be of
    /// this mesh ([`TriangleMesh::corner_values`]).
    ///
    /// Split vertices of one vertex have the position of [`TriangleMesh::vertex_of_side`], so that
    /// welding by position gives back `triangles`. `None` if a primvar has not as many triangles as
    /// the mesh.
    pub fn split(&self, primvars: &[&CornerValues]) -> Option<SplitVertices> {
        let fits = |primvar: &&CornerValues| primvar.corners.len() == self.triangles.len();
        primvars.iter().all(fits).then(|| self.split_by(primvars))
    }

    /// [`TriangleMesh::split`] by primvars of this mesh.
    pub(crate) fn split_by(&self, primvars: &[&CornerValues]) -> SplitVertices {
        let mut splitter = Splitter::new(self.normals.len(), primvars.len());
        let mut triangles = self.sides().to_vec();
        if !primvars.is_empty() {
            for (t, triangle) in triangles.iter_mut().enumerate() {
                for (k, corner) in triangle.iter_mut().enumerate() {
                    let value = |primvar: &&CornerValues| primvar.corners[t][k];
                    *corner = splitter.vertex(*corner, primvars.iter().map(value));
                }
            }
        }
        SplitVertices { sides: splitter.sides, values: splitter.values, triangles }
    }
}

struct Splitter {
    sides: Vec<u32>,
    values: Vec<Vec<u32>>,
    /// Whether the first split vertex of each side has its values.
    is_met: Vec<bool>,
    /// For each split vertex the next one of the same side.
    next: Vec<u32>,
}

impl Splitter {
    fn new(num_sides: usize, num_primvars: usize) -> Self {
        Self {
            sides: (0..num_sides as u32).collect(),
            values: vec![vec![0; num_sides]; num_primvars],
            is_met: vec![false; num_sides],
            next: vec![NONE; num_sides],
        }
    }

    /// The split vertex of `side` with these values, one for each primvar.
    fn vertex(&mut self, side: u32, values: impl Iterator<Item = u32> + Clone) -> u32 {
        if !std::mem::replace(&mut self.is_met[side as usize], true) {
            self.values.iter_mut().zip(values).for_each(|(of, x)| of[side as usize] = x);
            return side;
        }
        let (mut vertex, mut last) = (side, side);
        while vertex != NONE {
            if self.values.iter().zip(values.clone()).all(|(of, x)| of[vertex as usize] == x) {
                return vertex;
            }
            last = vertex;
            vertex = self.next[vertex as usize];
        }
        let added = self.sides.len() as u32;
        self.sides.push(side);
        self.next.push(NONE);
        self.next[last as usize] = added;
        self.values.iter_mut().zip(values).for_each(|(of, x)| of.push(x));
        added
    }
}
