//! Fair subdivision surfaces from quad meshes.
//!
//! A *cage* is a mesh of quads (and, if need be, other polygons) as people model with. Where it
//! is regular, its surface is a bi-cubic spline, one patch per face. Around *extraordinary
//! points* (interior vertices of valence other than 4, centres of n-gons) the surface is an
//! infinite sequence of ever smaller rings of patches, made by one of several *schemes*.
//!
//! # A tour along the pipeline
//!
//! Read a cage from OBJ, PLY or USD and check it; an error names all faults with their lines.
//!
//! ```
//! use std::sync::Arc;
//! use evenlight::io;
//!
//! let (cage, notices) = io::read_cage("examples/cube.obj")?;
//! assert!(notices.is_empty());
//! assert_eq!(cage.interior_valences(), [(3, 8)].into());
//!
//! // Build a surface over it.
//! use evenlight::{SchemeKind, Surface, SurfaceOptions};
//!
//! let options = SurfaceOptions { scheme: SchemeKind::Qas4, ..SurfaceOptions::default() };
//! let surface = Surface::build(Arc::new(cage), options)?;
//! assert_eq!(surface.extraordinary_points().len(), 8);
//!
//! // Ask it anything at (face, u, v): here the corner of the cube, where three faces meet.
//! use evenlight::FaceId;
//!
//! let quad = surface.quad(FaceId(1), 0).expect("face 1 is a quad");
//! let corner = surface.eval(quad, 1.0, 1.0).expect("the cage has no boundary");
//! let [x, y, z] = corner.normal;
//! assert!((x - y).abs() < 1e-14 && (y - z).abs() < 1e-14, "the corner looks outwards");
//! assert!(corner.gauss > 0.0, "qas4 has a curvature there too");
//!
//! // Take the polynomials: regular patches and the first six rings.
//! let patches: Vec<_> = surface.patches(6).collect();
//! assert_eq!(patches.len(), 6 * (4 * 6 * 3), "6 faces of 4 sectors, 6 rings of 3 patches");
//!
//! // Or triangles, or a report.
//! use evenlight::{analyse::curvature::curvature_report, tessellate::tessellate};
//!
//! let triangles = tessellate(&surface, 8)?;
//! assert_eq!(triangles.triangles.len(), 6 * 8 * 8 * 2);
//! let report = curvature_report(&surface, 6)?;
//! assert!(report.jumps.parametric < 1e-11, "all patches join C2");
//!
//! // Write a file: triangles in the format that the ending of its name tells, or patches.
//! use evenlight::io::{MeshFormat, PatchFormat};
//!
//! let format = MeshFormat::from_path("cube.glb").expect("a known ending");
//! let mut file = Vec::new();
//! format.write(&triangles, &triangles.corner_primvars(&surface), &mut file)?;
//! PatchFormat::Json.write(&surface, 6, &mut file)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Modules in pipeline order
//!
//! | module | |
//! | --- | --- |
//! | [`point`] | points and vectors |
//! | [`task`] | threads, progress, cancelling |
//! | [`patch`] | Bernstein-Bezier patches, jets |
//! | [`net`] | control nets around one extraordinary point, the quadratic q |
//! | [`mesh`] | cages, connectivity, isolation of extraordinary points |
//! | [`scheme`] | which rules there are |
//! | [`rings`] | the surface around one extraordinary point at any depth |
//! | [`cap`] | finitely many patches instead of all further rings |
//! | [`basis`] | eigenfunctions and refinable functions of guided subdivision |
//! | [`surface`] | the whole surface |
//! | [`stencil`] | the surface as weights of the cage's vertices |
//! | [`complex`] | its patches, and the edges and vertices where they meet |
//! | [`tessellate`] | triangles |
//! | [`analyse`] | curvature, continuity, highlight lines, spectra |
//! | [`io`] | OBJ, PLY, USD, glTF, STL, BezierView, JSON |
//! | `picture` (feature) | pictures with exact normals |
//!
//! # Features
//!
//! None is on by default; then the only dependency is `thiserror`, and the crate builds for
//! WebAssembly.
//!
//! | feature | adds | needs |
//! | --- | --- | --- |
//! | `parallel` | all threads in tessellation and pictures; the bytes stay the same | |
//! | `picture` | module `picture`: pictures with exact normals, as PNG | png |
//! | `derive` | rules of guided schemes derived when asked for: any contraction, valences to 32 | evenlight-guide |
//! | `spectrum` | module `analyse::spectrum`: eigenvalues of the subdivision matrices | nalgebra |
//!
//! # Read on
//!
//! [`docs`] has the chapters of the documentation, among them a glossary. `examples` has small
//! programs: load, evaluate, patches, a new pose, stencils.
//!
//! # What is not promised
//!
//! At boundaries, infinitely sharp creases and corners every scheme is Catmull-Clark. A surface may
//! intersect itself if its cage does. Coordinates near the ends of the range of `f64` may overflow
//! in derivatives.

pub mod analyse;
mod angle;
pub mod basis;
pub mod cap;
pub mod complex;
mod dense;
pub mod io;
pub mod mesh;
mod names;
pub mod net;
mod pairs;
pub mod patch;
#[cfg(feature = "picture")]
pub mod picture;
pub mod point;
mod quadrature;
pub mod rings;
pub mod scheme;
mod sparse;
pub mod stencil;
pub mod surface;
pub mod task;
pub mod tessellate;

pub use mesh::{Cage, FaceId, Mesh, VertexId};
pub use names::UnknownName;
pub use patch::SurfacePoint;
pub use point::{Point, Vector};
pub use scheme::{Contraction, RuleSet, SchemeKind, Variant};
pub use surface::{Layout, QuadId, Surface, SurfaceOptions};

#[cfg(any(doc, doctest))]
pub mod docs;

/// Tests the example in the README of the crate; `xtask` tests the README of the repository.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
