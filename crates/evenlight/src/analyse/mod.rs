//! Interrogation of surfaces: curvature, continuity, spectra.

pub mod continuity;
pub mod highlight;
