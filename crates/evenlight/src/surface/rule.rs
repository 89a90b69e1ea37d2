//! Which rule an extraordinary point gets, and why it may be another than the chosen scheme.

use std::fmt;

use super::{CreaseRings, SurfaceOptions};
use crate::mesh::isolation::{Extraordinary, Place};
use crate::mesh::{Topology, VertexRule};
use crate::scheme::{SchemeKind, is_fair};

/// The rule of an extraordinary point.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum PointRule {
    /// The chosen scheme.
    Scheme,
    /// Catmull-Clark's rings, exactly as its subdivision with creases and corners has them.
    CatmullClark(Reason),
    /// Fair rings beside a crease, which is the reason; only with [`CreaseRings::Fair`].
    FairCrease(Reason),
}

/// Why a point does not get the chosen scheme.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum Reason {
    /// The scheme has no rules for the valence.
    Valence,
    /// The point is on the boundary.
    Boundary,
    /// An infinitely sharp crease passes through it.
    Crease,
    /// An infinitely sharp crease ends there.
    Dart,
    /// It is an infinitely sharp vertex, or three infinitely sharp edges or more meet there.
    Corner,
}

impl PointRule {
    /// The rule of a point of a cage with this topology.
    pub fn of(topology: &Topology, point: &Extraordinary, options: SurfaceOptions) -> Self {
        if point.fan.is_smooth() {
            let has_rules = options.scheme.has_rules(options.variant(), point.valence);
            return if has_rules { Self::Scheme } else { Self::CatmullClark(Reason::Valence) };
        }
        let on_boundary = matches!(point.place, Place::Vertex(v) if topology.is_boundary(v));
        let reason = match point.fan.rule {
            _ if on_boundary => Reason::Boundary,
            VertexRule::Corner => Reason::Corner,
            VertexRule::Crease => Reason::Crease,
            VertexRule::Smooth => Reason::Dart,
        };
        if options.creases == CreaseRings::Fair && is_fair(point.fan) {
            return Self::FairCrease(reason);
        }
        Self::CatmullClark(reason)
    }

    /// A word for files and tables: "fair-crease", or the name of the scheme whose rings the
    /// point has. `chosen` is the scheme of the surface.
    pub fn name(self, chosen: SchemeKind) -> &'static str {
        match self {
            Self::Scheme => chosen.name(),
            Self::CatmullClark(_) => SchemeKind::CatmullClark.name(),
            Self::FairCrease(_) => "fair-crease",
        }
    }
}

impl Reason {
    /// A word for files and tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Valence => "valence",
            Self::Boundary => "boundary",
            Self::Crease => "crease",
            Self::Dart => "dart",
            Self::Corner => "corner",
        }
    }
}

impl fmt::Display for Reason {
    /// The reason in words, as of a point.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Valence => "no rules of the scheme for this valence",
            Self::Boundary => "on the boundary",
            Self::Crease => "an infinitely sharp crease through it",
            Self::Dart => "an infinitely sharp crease that ends there",
            Self::Corner => "infinitely sharp, or three infinitely sharp edges",
        })
    }
}
