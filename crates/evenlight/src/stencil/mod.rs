//! Stencils: the surface as weights of the values of its cage.
//!
//! Everything on a surface is linear in the positions of its vertices. A *stencil* is the weights
//! of one result: made once, it gives that result for any positions, and for any other values that
//! are interpolated like positions, by a short sum.
//!
//! ```text
//!        columns: the vertices of the cage, or the values of a primvar
//!       +---------------------------------+
//!    S  | 0  1/2 1/2  0   0   0   0   0   |   rows: the vertices of the refined cage,
//!       | 0  1/6 4/6 1/6  0   0   0   0   |         the Bernstein-Bezier coefficients of patches, or
//!       | 0 -1/2  0  1/2  0   0   0   0   |         p, du, dv, duu, duv, dvv of places (quad, u, v)
//!       +---------------------------------+
//!                                                 S V = results
//! ```
//!
//! ```
//! use evenlight::io::load::Format;
//! use evenlight::stencil::StencilBuilder;
//! use evenlight::{FaceId, Surface, SurfaceOptions};
//!
//! let text = "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\n\
//!             v -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n\
//!             f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
//! let (cage, _) = Format::Obj.read_cage(text.as_bytes())?;
//! let surface = Surface::build(cage, SurfaceOptions::default())?;
//! let quad = surface.quad(FaceId(1), 0).expect("face 1 is a quad");
//!
//! let stencils = StencilBuilder::of_surface(&surface)?.places(&[(quad, 0.3, 0.6)], 1)?;
//! let [p, du, dv] = stencils.apply(surface.positions())?[..] else { panic!("3 rows") };
//! let jet = surface.eval_first(quad, 0.3, 0.6).expect("there is a surface");
//! let distance = |a: [f64; 3], b: [f64; 3]| (0..3).map(|k| (a[k] - b[k]).abs()).sum::<f64>();
//! assert!(distance(p, jet.p) + distance(du, jet.du) + distance(dv, jet.dv) < 1e-13);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! **Exactness.** The rows of positions sum to 1, the rows of derivatives to 0. Results agree with
//! [`Surface`] to rounding, with every scheme, at boundaries, creases, caps and seams.
//! Derivatives of order k are exact relative to (lambda / sigma^k)^l times the extent of the net,
//! in ring l around a point whose rings shrink by lambda and their parameters by sigma. That is
//! their own size at any depth. But the height above the limit tangent plane is lambda^l times as
//! small as the tangential part of a derivative, and one sum of weights cannot keep digits for it
//! alone. So curvature that is computed from results has a relative error of
//! about 1e-16 lambda^-l, and is lost after some fifty rings; [`Surface::eval`] has it exact.
//!
//! **At an extraordinary point itself** without a cap the row of the position gives the limit
//! point. Derivatives do not exist there: their rows are NaN, as the answers of [`Surface::eval`].
//!
//! **What is meant.** Stencils belong to a [`Layout`] and take the default quadratics. A surface
//! with a quadratic of its own ([`Surface::set_quadratic`]) is not linear in its cage around that
//! point. Caps are linear; a surface's stencils have its caps.

mod backwards;
mod basis;
mod columns;
mod error;
mod linear;
mod patches;
mod refined;
mod smooth;
mod unit;

use std::sync::Arc;

pub use crate::sparse::{LengthError, Stencils};
pub use error::StencilError;
pub use patches::PatchStencils;
pub use refined::RefinedCage;

use crate::cap::CapOptions;
use crate::mesh::primvar_net::PrimvarNet;
use crate::mesh::{FaceVaryingRule, Interpolation, Primvar};
use crate::surface::{ArrayError, Layout, PatchPlace, QuadId, Surface, own_layout, row_width};
use columns::{Columns, Sums, in_parts};
use linear::LinearNet;
use refined::Masks;
use smooth::SmoothNet;

/// Makes stencils of surfaces over a layout, or of a primvar, and keeps what they have in common:
/// the refined vertices that patches need, and the surfaces of unit nets, for every kind of
/// extraordinary point once.
///
/// After that a place costs what its evaluation costs for as many numbers as its rows have weights,
/// about 16 in regular faces.
#[derive(Debug)]
pub struct StencilBuilder {
    /// The layout whose quads places are in.
    layout: Arc<Layout>,
    net: Net,
}

/// What values are interpolated by.
#[derive(Debug)]
enum Net {
    /// Surfaces over a layout, of a face-varying primvar over its own.
    Smooth(Box<SmoothNet>),
    Linear(LinearNet),
}

impl StencilBuilder {
    /// For positions over a layout and for primvars with [`Interpolation::Vertex`], closed by such
    /// caps if there are to be some: the columns are the vertices.
    ///
    /// # Errors
    ///
    /// [`StencilError::Cap`] if there are no such caps; [`StencilError::TooLarge`] if the cage is.
    pub fn new(layout: &Arc<Layout>, caps: Option<CapOptions>) -> Result<Self, StencilError> {
        let columns = Columns::of_vertices(layout.num_vertices());
        let net = SmoothNet::new(layout, caps, columns)?;
        Ok(Self { layout: layout.clone(), net: Net::Smooth(Box::new(net)) })
    }

    /// [`StencilBuilder::new`] with the layout and the caps of a surface.
    ///
    /// # Errors
    ///
    /// [`StencilError::TooLarge`] if the cage is.
    pub fn of_surface<const N: usize>(surface: &Surface<N>) -> Result<Self, StencilError> {
        Self::new(surface.layout(), surface.cap_options())
    }

    /// For a primvar, by its index: the columns are the vertices, or of face-varying ones the
    /// values.
    ///
    /// # Errors
    ///
    /// [`StencilError::Primvar`] if there is no such primvar, [`StencilError::TooLarge`].
    pub fn of_primvar(surface: &Surface, primvar: usize) -> Result<Self, StencilError> {
        let missing = StencilError::Primvar { primvar };
        let of_cage = surface.primvars().get(primvar).ok_or(missing.clone())?;
        let layout = surface.layout();
        let net = match of_cage.interpolation {
            Interpolation::Vertex => return Self::of_surface(surface),
            Interpolation::Varying => {
                let columns = Columns::of_vertices(layout.num_vertices());
                Net::Linear(LinearNet { topology: layout.shared_topology().clone(), columns })
            }
            Interpolation::FaceVarying if layout.tags().face_varying == FaceVaryingRule::All => {
                Net::Linear(linear_net(layout, of_cage).ok_or(missing)?)
            }
            Interpolation::FaceVarying => {
                let (own, values) = own_layout(layout, of_cage).ok_or(missing)?;
                let columns = value_columns(of_cage, values);
                Net::Smooth(Box::new(SmoothNet::new(&own, surface.cap_options(), columns)?))
            }
        };
        Ok(Self { layout: layout.clone(), net })
    }

    fn columns(&self) -> &Columns {
        match &self.net {
            Net::Smooth(net) => net.columns(),
            Net::Linear(net) => &net.columns,
        }
    }

    /// The number of columns.
    pub fn num_columns(&self) -> usize {
        self.columns().count()
    }

    /// The rows of places on the limit surface: quad, u and v, which are clamped to 0..1. With
    /// derivatives up to `order` 0, 1 or 2 each place has 1, 3 or 6 rows: p, du, dv, duu, duv, dvv.
    ///
    /// # Errors
    ///
    /// [`StencilError`] with the first place that is none: there is no such quad, no surface over
    /// it, or a parameter is NaN. [`ArrayError::Order`].
    pub fn places(
        &self,
        places: &[(QuadId, f64, f64)],
        order: usize,
    ) -> Result<Stencils, StencilError> {
        self.rows(places.len(), |k| places[k], order)
    }

    /// [`StencilBuilder::places`] of arrays of the numbers of quads and of parameters.
    ///
    /// # Errors
    ///
    /// As of [`StencilBuilder::places`], and [`ArrayError::Length`].
    pub fn place_arrays(
        &self,
        quads: &[u32],
        uv: &[[f64; 2]],
        order: usize,
    ) -> Result<Stencils, StencilError> {
        if quads.len() != uv.len() {
            let (expected, found) = (quads.len(), uv.len());
            return Err(ArrayError::Length { what: "uv", expected, found }.into());
        }
        self.rows(quads.len(), |k| (QuadId(quads[k]), uv[k][0], uv[k][1]), order)
    }

    fn rows(
        &self,
        count: usize,
        place: impl Fn(usize) -> (QuadId, f64, f64) + Sync,
        order: usize,
    ) -> Result<Stencils, StencilError> {
        match row_width::<1>(order)? {
            1 => self.rows_of::<1>(count, place),
            3 => self.rows_of::<3>(count, place),
            _ => self.rows_of::<6>(count, place),
        }
    }

    fn rows_of<const R: usize>(
        &self,
        count: usize,
        place: impl Fn(usize) -> (QuadId, f64, f64) + Sync,
    ) -> Result<Stencils, StencilError> {
        let num_columns = self.num_columns();
        in_parts(num_columns, count, |range| {
            let (mut rows, mut sums) = (Stencils::empty(num_columns), Sums::<R>::new(num_columns));
            for k in range {
                self.enter(k, place(k), &mut sums)?;
                sums.move_to(&mut rows)?;
            }
            Ok(rows)
        })
    }

    /// Enters the rows of place number `place`.
    fn enter<const R: usize>(
        &self,
        place: usize,
        (quad, u, v): (QuadId, f64, f64),
        sums: &mut Sums<R>,
    ) -> Result<(), StencilError> {
        let on = self.layout.face_of(quad).ok_or(StencilError::Quad { place, quad })?;
        if u.is_nan() || v.is_nan() {
            return Err(StencilError::Parameter { place });
        }
        let at = [u.clamp(0.0, 1.0), v.clamp(0.0, 1.0)];
        let is_covered = !self.layout.is_omitted(on.0)
            && match &self.net {
                Net::Smooth(net) => net.place(quad, at, sums)?,
                Net::Linear(net) => {
                    net.place(on, at, sums);
                    true
                }
            };
        if is_covered { Ok(()) } else { Err(StencilError::Omitted { place, quad }) }
    }

    /// Where the patches lie that [`StencilBuilder::patches`] knows: of positions as
    /// [`Surface::patch_places`] has them. A face-varying primvar has patches of its own, and none
    /// if it is linear.
    ///
    /// # Errors
    ///
    /// [`StencilError::Linear`] for linear primvars.
    pub fn patch_places(&self, rings: usize) -> Result<Vec<PatchPlace>, StencilError> {
        let Net::Smooth(net) = &self.net else { return Err(StencilError::Linear) };
        let mut places = net.patch_places(rings)?;
        places.retain(|place| !self.layout.is_omitted(self.layout.face_of_quad(place.quad).0));
        Ok(places)
    }

    /// The rows of the Bernstein-Bezier coefficients of patches, as [`Surface::patch`] has them, at
    /// places of [`StencilBuilder::patch_places`].
    ///
    /// # Errors
    ///
    /// [`StencilError::Patch`] if there is no such patch, [`StencilError::Linear`] for linear
    /// primvars.
    pub fn patches(&self, places: &[PatchPlace]) -> Result<PatchStencils, StencilError> {
        match &self.net {
            Net::Smooth(net) => PatchStencils::new(net, places),
            Net::Linear(_) => Err(StencilError::Linear),
        }
    }

    /// The cage refined so many times, all of it, holes too. The faces of a face-varying primvar
    /// are those of its own net: they come in the same order, but have vertices of their own at
    /// seams.
    ///
    /// # Errors
    ///
    /// [`StencilError::TooLarge`] if 32 bits cannot number its corners or weights.
    pub fn refined(&self, steps: usize) -> Result<RefinedCage, StencilError> {
        let columns = self.columns().without_levels();
        match &self.net {
            Net::Smooth(net) => {
                let masks = Masks::Smooth(&net.layout().plan().sharpness[0]);
                refined::refined(net.layout().topology(), &masks, columns, steps)
            }
            Net::Linear(net) => refined::refined(&net.topology, &Masks::Linear, columns, steps),
        }
    }
}

/// The net of a linear face-varying primvar.
fn linear_net(layout: &Layout, primvar: &Primvar) -> Option<LinearNet> {
    let boundary = layout.options().boundary.unwrap_or(layout.tags().boundary);
    let net = PrimvarNet::new(layout.topology(), layout.tags(), primvar, boundary);
    let topology = layout.topology().with_vertices(net.faces, net.values.len()).ok()?;
    Some(LinearNet { topology: Arc::new(topology), columns: value_columns(primvar, net.values) })
}

/// The columns of a face-varying primvar: its values; `of_vertex` says which vertex has which.
fn value_columns(primvar: &Primvar, of_vertex: Vec<u32>) -> Columns {
    Columns::of_values(primvar.values.len() / usize::max(primvar.width, 1), of_vertex)
}
