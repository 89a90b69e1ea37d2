//! The shape of a fan: the faces around a vertex between two sharp edges.
//!
//! `mesh::fan` finds the fans of a mesh. The control net of one fan, and the rules on it, depend on
//! its shape alone.

/// The shape of a fan. Refinement does not change it any more.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Fan {
    /// The number of its faces.
    pub faces: usize,
    /// Whether it goes all around the vertex, with one sharp edge or none.
    pub is_closed: bool,
    /// Whether it is closed and has a sharp edge.
    pub has_dart: bool,
    /// The rule of the vertex.
    pub rule: VertexRule,
}

impl Fan {
    /// Whether neither the vertex nor an edge at it is sharp.
    pub fn is_smooth(self) -> bool {
        self.is_closed && !self.has_dart && self.rule == VertexRule::Smooth
    }

    /// Whether its faces are bi-3 patches if their other corners allow it.
    pub fn is_regular(self) -> bool {
        let Self { faces, is_closed, .. } = self;
        match self.rule {
            VertexRule::Smooth => self.is_smooth() && faces == 4,
            VertexRule::Crease => !is_closed && faces == 2,
            VertexRule::Corner => !is_closed && faces == 1,
        }
    }

    /// The number of its edges.
    pub fn lines(self) -> usize {
        self.faces.saturating_add(usize::from(!self.is_closed))
    }
}

/// The kind of rule of a vertex.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum VertexRule {
    /// The rule of Catmull-Clark for smooth surfaces; also for a single sharp edge (a dart).
    Smooth,
    /// A cubic spline along the two sharp edges.
    Crease,
    /// The vertex stays where it is.
    Corner,
}

impl VertexRule {
    /// The rule of a vertex with this sharpness and this number of sharp edges.
    pub(crate) fn of(sharpness: f64, sharp_edges: usize) -> Self {
        match sharp_edges {
            _ if sharpness > 0.0 => Self::Corner,
            0 | 1 => Self::Smooth,
            2 => Self::Crease,
            _ => Self::Corner,
        }
    }
}
