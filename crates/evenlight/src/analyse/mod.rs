//! Interrogation of surfaces: numbers and functions that show their quality.

pub mod caps;
pub mod continuity;
pub mod curvature;
pub mod defect;
pub mod highlight;
pub mod injectivity;
pub mod shape;
#[cfg(feature = "spectrum")]
pub mod spectrum;
