//! The surface as an object: position, derivatives and curvature at any (face, u, v).
//!
//! Every quad of the cage is one *parametric quad*, (u,v) in the unit square; an n-gon is n of
//! them, one per corner:
//!
//! ```text
//!  d (0,1) --- c (1,1)            quad k of an n-gon: (0,0) is corner k, u runs towards
//!     |           |               corner k+1 (half of that edge), v towards corner k-1,
//!     |  (u,v)    |               (1,1) is the face's centre.
//!     |           |
//!  a (0,0) --- b (1,0)
//! ```
//!
//! A parametric quad is one bi-3 patch, one sector of an extraordinary point, or four smaller
//! pieces ([`isolation`](crate::mesh::isolation)). Evaluation finds the piece and its own
//! parameters; all pieces are parts of one surface.
//!
//! A surface is a [`Layout`], which knows topology, tags and options, and the values at the
//! vertices of the cage. Positions are values of three numbers; primvars, of one to four, are
//! surfaces too.

mod arrays;
mod cache;
mod caps;
mod error;
mod eval;
mod grid;
mod layout;
mod options;
mod patches;
mod place;
mod primvar;
mod rule;
mod values;

pub use arrays::{ArrayError, Number, PatchBlock, row_width};
pub use cache::RuleCache;
pub(crate) use caps::CapPlan;
pub use error::SurfaceError;
pub use layout::{ExtraordinaryPoint, Layout, Sector};
pub use options::{CreaseRings, SurfaceOptions};
pub use place::{PatchPlace, PlacedPatch, Role};
pub(crate) use place::{RingPatch, Source, quadrant, to_sector};
pub(crate) use primvar::own_layout;
pub use rule::{PointRule, Reason};

use std::sync::{Arc, OnceLock};

use crate::mesh::{Cage, FaceId, HalfEdgeId, Primvar, Tags, Topology, ValuesError, check_values};
use crate::net::Quadratic;
use crate::patch::SurfacePoint;
use crate::point::Point;
use crate::rings::Rings;
use caps::Caps;
use values::refined;

/// The number of a parametric quad: all quads of face 0, then of face 1, and so on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct QuadId(pub u32);

/// A subdivision surface over a cage: of positions, N = 3, or of other values of N numbers.
///
/// What it computes once it keeps: the values of refined levels, the rings and caps around
/// extraordinary points, and its primvars. New values ([`Surface::set_values`]) and new quadratics
/// make it forget what depends on them.
#[derive(Debug)]
pub struct Surface<const N: usize = 3> {
    layout: Arc<Layout>,
    /// The values at the vertices of the cage, and of every refined level.
    levels: Vec<Arc<[[f64; N]]>>,
    /// The rings around every extraordinary point, made when they are first asked for.
    rings: Vec<OnceLock<Rings<N>>>,
    /// What closes the holes behind some rings.
    caps: Option<Caps<N>>,
    /// The primvars of the cage; of a primvar none.
    primvars: Arc<[Primvar]>,
    /// Their surfaces, built when they are first asked for, shared with all poses.
    primvar_surfaces: Vec<Arc<OnceLock<primvar::PrimvarSurface>>>,
}

impl Surface {
    /// Builds the surface over `cage`.
    ///
    /// Time and memory are linear in the number of faces; rings are made when they are first
    /// asked for.
    ///
    /// # Errors
    ///
    /// [`SurfaceError::NoRules`] if more than 1024 faces meet at a point; where the scheme has no
    /// rules, the point gets Catmull-Clark's ([`ExtraordinaryPoint::rule`]).
    /// [`SurfaceError::Contraction`] if the scheme has no such contraction
    /// ([`SchemeKind::check_contraction`](crate::SchemeKind::check_contraction)).
    pub fn build(
        cage: impl Into<Arc<Cage>>,
        options: SurfaceOptions,
    ) -> Result<Self, SurfaceError> {
        let cage = cage.into();
        let layout = Arc::new(Layout::new(&cage, options)?);
        let values = cage.shared_positions().clone();
        Ok(Self::with_primvars(layout, values, cage.shared_primvars().clone()))
    }

    /// The surface of a cage over its layout, which others may share.
    ///
    /// ```
    /// use std::sync::Arc;
    /// use evenlight::surface::Layout;
    /// use evenlight::{Cage, Mesh, Surface, SurfaceOptions};
    ///
    /// let square = vec![[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.]];
    /// let cage = Cage::new(Mesh::new(square, [[0, 1, 2, 3]]))?;
    /// let layout = Arc::new(Layout::new(&cage, SurfaceOptions::default())?);
    /// let surface = Surface::of_cage(&layout, &cage)?;
    /// assert_eq!(surface.positions(), cage.positions());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`ValuesError::Count`] if the cage has not as many vertices as the layout.
    pub fn of_cage(layout: &Arc<Layout>, cage: &Cage) -> Result<Self, ValuesError> {
        let values = cage.shared_positions().clone();
        check_values(&values, layout.num_vertices())?;
        // Those of another cage do not fit.
        let is_own = cage.topology().faces() == layout.topology().faces();
        let primvars = if is_own { cage.shared_primvars().clone() } else { Arc::default() };
        Ok(Self::with_primvars(layout.clone(), values, primvars))
    }

    /// The positions of the cage's vertices.
    pub fn positions(&self) -> &[Point] {
        self.values()
    }

    /// The same surface over other positions of the cage's vertices, with the same layout, kind of
    /// caps and primvars. Quadratics are the default ones again.
    ///
    /// ```
    /// use evenlight::{Cage, Mesh, QuadId, Surface, SurfaceOptions};
    ///
    /// let square = vec![[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.]];
    /// let cage = Cage::new(Mesh::new(square, [[0, 1, 2, 3]]))?;
    /// let surface = Surface::build(cage, SurfaceOptions::default())?;
    /// let lifted: Vec<_> = surface.positions().iter().map(|&[x, y, _]| [x, y, 2.0]).collect();
    /// let pose = surface.with_positions(lifted)?;
    /// let [x, y, z] = pose.eval_position(QuadId(0), 0.5, 0.5).ok_or("there is a surface")?;
    /// assert!((x - 0.5).abs() < 1e-15 && (y - 0.5).abs() < 1e-15 && (z - 2.0).abs() < 1e-15);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`ValuesError`] if there are not as many, or one is not finite.
    pub fn with_positions(&self, positions: Vec<Point>) -> Result<Self, ValuesError> {
        self.with_values(positions)
    }

    /// [`Surface::with_positions`] in place.
    ///
    /// # Errors
    ///
    /// [`ValuesError`] if there are not as many, or one is not finite; the surface stays as it was.
    pub fn set_positions(&mut self, positions: Vec<Point>) -> Result<(), ValuesError> {
        self.set_values(positions)
    }

    /// Position, derivatives, normal and curvature at (u,v) of `quad`, which are clamped to
    /// 0..1; `None` if the face is omitted, there is no such quad or a parameter is NaN.
    ///
    /// At an extraordinary point itself, unless a cap is there, the position is the limit point and
    /// the normal the limit normal; derivatives do not exist there and are NaN. Schemes with a
    /// quadratic or a guide take the curvature from it ([`Rings::center_curvature`]); with other
    /// schemes curvature is NaN too. Anywhere else, however near, all are exact to rounding
    /// ([`Rings::eval`]).
    pub fn eval(&self, quad: QuadId, u: f64, v: f64) -> Option<SurfacePoint> {
        self.eval_as(quad, u, v)
    }
}

impl<const N: usize> Surface<N> {
    /// The surface of values, one for each vertex of the cage, over a layout.
    ///
    /// # Errors
    ///
    /// [`ValuesError`] if there are not as many, or one is not finite.
    pub fn over(layout: &Arc<Layout>, values: Vec<[f64; N]>) -> Result<Self, ValuesError> {
        check_values(&values, layout.num_vertices())?;
        Ok(Self::with_primvars(layout.clone(), values.into(), Arc::default()))
    }

    /// Over values that are known to fit.
    fn with_primvars(
        layout: Arc<Layout>,
        values: Arc<[[f64; N]]>,
        primvars: Arc<[Primvar]>,
    ) -> Self {
        let levels = refined(&layout, values);
        let rings = unmade(layout.extraordinary_points().len());
        let primvar_surfaces = primvar::unbuilt(&primvars);
        Self { layout, levels, rings, caps: None, primvars, primvar_surfaces }
    }

    /// The same surface over other values, with the same layout, kind of caps and primvars.
    /// Quadratics are the default ones again.
    ///
    /// Takes the time of checking the values and refining what is refined; rings and caps are made
    /// when they are asked for.
    ///
    /// # Errors
    ///
    /// [`ValuesError`] if there are not as many, or one is not finite.
    pub fn with_values(&self, values: Vec<[f64; N]>) -> Result<Self, ValuesError> {
        check_values(&values, self.layout.num_vertices())?;
        Ok(Self {
            layout: self.layout.clone(),
            levels: refined(&self.layout, values.into()),
            rings: unmade(self.rings.len()),
            caps: self.caps.as_ref().map(Caps::unmade),
            primvars: self.primvars.clone(),
            primvar_surfaces: self.primvar_surfaces.clone(),
        })
    }

    /// [`Surface::with_values`] in place.
    ///
    /// # Errors
    ///
    /// [`ValuesError`] if there are not as many, or one is not finite; the surface stays as it was.
    pub fn set_values(&mut self, values: Vec<[f64; N]>) -> Result<(), ValuesError> {
        *self = self.with_values(values)?;
        Ok(())
    }

    /// The layout: topology, tags, options, and what follows from them.
    pub fn layout(&self) -> &Arc<Layout> {
        &self.layout
    }

    /// The values at the cage's vertices.
    pub fn values(&self) -> &[[f64; N]] {
        &self.levels[0]
    }

    /// The connectivity of the cage.
    pub fn topology(&self) -> &Topology {
        self.layout.topology()
    }

    /// Boundary rule, creases, corners and holes of the cage.
    pub fn tags(&self) -> &Tags {
        self.layout.tags()
    }

    /// How it was built.
    pub fn options(&self) -> SurfaceOptions {
        self.layout.options()
    }

    /// The number of parametric quads, omitted ones included.
    pub fn num_quads(&self) -> usize {
        self.layout.num_quads()
    }

    /// [`Layout::quad`].
    pub fn quad(&self, face: FaceId, corner: usize) -> Option<QuadId> {
        self.layout.quad(face, corner)
    }

    /// [`Layout::face_of`].
    pub fn face_of(&self, quad: QuadId) -> Option<(FaceId, usize)> {
        self.layout.face_of(quad)
    }

    /// [`Layout::is_omitted`].
    pub fn is_omitted(&self, face: FaceId) -> bool {
        self.layout.is_omitted(face)
    }

    /// [`Layout::omitted_faces`].
    pub fn omitted_faces(&self) -> &[FaceId] {
        self.layout.omitted_faces()
    }

    /// [`Layout::is_infinitely_sharp`].
    pub fn is_infinitely_sharp(&self, h: HalfEdgeId) -> bool {
        self.layout.is_infinitely_sharp(h)
    }

    /// [`Layout::extraordinary_points`].
    pub fn extraordinary_points(&self) -> &[ExtraordinaryPoint] {
        self.layout.extraordinary_points()
    }

    /// The rings around an extraordinary point, by its index; `None` if there is no such point.
    pub fn rings(&self, point: usize) -> Option<&Rings<N>> {
        (point < self.rings.len()).then(|| self.rings_at(point))
    }

    /// The rings around a point that exists.
    #[inline]
    pub(crate) fn rings_at(&self, point: usize) -> &Rings<N> {
        self.rings[point].get_or_init(|| self.make_rings(point))
    }

    /// Replaces the quadratic q of an extraordinary point, by its index; `false` if the scheme has
    /// no quadratics, or there is no such point.
    pub fn set_quadratic(&mut self, point: usize, q: &Quadratic<N>) -> bool {
        let Some(rings) = self.rings(point).and_then(|rings| rings.with_quadratic(q)) else {
            return false;
        };
        self.rings[point] = OnceLock::from(rings);
        if let Some(caps) = &mut self.caps {
            caps.forget(point);
        }
        true
    }
}

/// So many rings, none of them made.
fn unmade<const N: usize>(count: usize) -> Vec<OnceLock<Rings<N>>> {
    std::iter::repeat_with(OnceLock::new).take(count).collect()
}
