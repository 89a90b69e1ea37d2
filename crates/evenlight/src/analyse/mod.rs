//! Interrogation of surfaces: curvature, continuity, spectra.
