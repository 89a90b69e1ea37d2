//! Why there is no surface.

use crate::mesh::isolation::Place;
use crate::scheme::{ContractionError, MAX_CATMULL_CLARK_VALENCE};

/// Why no surface could be built.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SurfaceError {
    /// The scheme has no such contraction.
    #[error(transparent)]
    Contraction(#[from] ContractionError),
    /// Not even Catmull-Clark has rules for the valence of these points.
    #[error(
        "there are rules for valences up to {MAX_CATMULL_CLARK_VALENCE}, but {}; \
         split such a vertex or face into several of lower valence",
        list_places(points)
    )]
    NoRules {
        /// The points and their valences.
        points: Vec<(Place, usize)>,
    },
}

/// The points of an error message, at most eight of them.
fn list_places(points: &[(Place, usize)]) -> String {
    let name = |&(place, valence): &(Place, usize)| match place {
        Place::Vertex(v) => {
            format!("vertex {} (number {} in a file) has valence {valence}", v.0, v.0 + 1)
        }
        Place::FaceCentre(f) => {
            format!("face {} (number {} in a file) has {valence} corners", f.0, f.0 + 1)
        }
    };
    let mut names: Vec<String> = points.iter().take(8).map(name).collect();
    if points.len() > names.len() {
        names.push(format!("{} more", points.len() - names.len()));
    }
    names.join(", ")
}
