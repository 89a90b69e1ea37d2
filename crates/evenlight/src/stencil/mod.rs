//! Stencils: the surface as weights of the values of its cage.
//!
//! Everything on a surface is linear in the positions of its vertices. A *stencil* is the weights of
//! one result: made once, it gives that result for any positions, and for any other values that are
//! interpolated like positions, by a short sum.
//!
//! ```text
//!   S V = results          rows                                     of a place (quad, u, v)
//!                          vertices of the refined cage             p
//!   columns: vertices of   Bernstein-Bezier coefficients            p, du, dv
//!   the cage, or values    places on the limit surface              p, du, dv, duu, duv, dvv
//!   of a primvar
//! ```
//!
//! ```
//! use evenlight::io::obj;
//! use evenlight::stencil::{Order, StencilBuilder};
//! use evenlight::{FaceId, Surface, SurfaceOptions};
//!
//! let text = "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n\
//!             f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
//! let (cage, _) = obj::read_cage(text.as_bytes())?;
//! let surface = Surface::build(cage, SurfaceOptions::default())?;
//! let quad = surface.quad(FaceId(1), 0).expect("face 1 is a quad");
//!
//! let stencils = StencilBuilder::new(&surface)?.places(&[(quad, 0.3, 0.6)], Order::First)?;
//! let [p, du, dv] = stencils.apply(surface.cage().positions())?[..] else { panic!("3 rows") };
//! let jet = surface.eval_first(quad, 0.3, 0.6).expect("there is a surface");
//! let distance = |a: [f64; 3], b: [f64; 3]| (0..3).map(|k| (a[k] - b[k]).abs()).sum::<f64>();
//! assert!(distance(p, jet.p) + distance(du, jet.du) + distance(dv, jet.dv) < 1e-13);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! **Exactness.** The rows of positions sum to 1, those of derivatives to 0, and results are those of
//! [`Surface`] to rounding, relative to the sum of |weight| |value|. That holds at any depth around an
//! extraordinary point, also for derivatives, whose weights shrink or grow with them. What stencils
//! lose there is what a sum of weights cannot keep: in ring l the height above the limit tangent plane is
//! lambda^l times as small as the tangential part of a derivative, so that curvature computed of
//! their results has a relative error of about 1e-16 lambda^-l. [`Surface::eval`] has it exact.
//!
//! **At an extraordinary point itself** without a cap the row of the position is that of the limit
//! point, and those of derivatives, which do not exist, are NaN, as the answers of [`Surface::eval`].
//!
//! **What is meant.** Stencils are those of the default quadratics: a surface with a quadratic of its own
//! ([`Surface::set_quadratic`]) is not linear in its cage around that point. Caps are linear too, and are
//! in.

mod basis;
mod columns;
mod error;
mod linear;
mod patches;
mod refined;
mod smooth;
mod unit;

use std::borrow::Cow;

pub use crate::sparse::{LengthError, Stencils};
pub use error::StencilError;
pub use patches::PatchStencils;
pub use refined::RefinedCage;

use crate::mesh::channel::ChannelNet;
use crate::mesh::{Interpolation, Primvar, Topology};
use crate::surface::{PatchPlace, QuadId, Surface};
use columns::{Columns, Sums, in_parts};
use linear::LinearNet;
use refined::Masks;
use smooth::SmoothNet;

/// Which derivatives have rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Order {
    /// One row: the position.
    Position,
    /// Three rows: position, derivative in u, derivative in v.
    First,
    /// Six rows: these, and the second derivatives in u twice, in u and v, in v twice.
    Second,
}

impl Order {
    /// The number of rows of a place.
    pub fn rows(self) -> usize {
        match self {
            Self::Position => 1,
            Self::First => 3,
            Self::Second => 6,
        }
    }
}

/// Makes stencils of a surface or of one of its primvars, and keeps what they have in common: the
/// refined vertices that patches need, and the surfaces of unit nets, for every kind of extraordinary
/// point once.
///
/// After that a place costs what its evaluation costs for as many numbers as its rows have weights,
/// about 16 in regular faces.
#[derive(Debug)]
pub struct StencilBuilder<'a> {
    /// The surface of the positions.
    surface: &'a Surface,
    net: Net<'a>,
}

/// What values are interpolated by.
#[derive(Debug)]
enum Net<'a> {
    /// The surface, or that of a face-varying primvar.
    Smooth(&'a Surface, Box<SmoothNet<'a>>),
    Linear(LinearNet<'a>),
}

impl<'a> StencilBuilder<'a> {
    /// For positions, and primvars with [`Interpolation::Vertex`]: the columns are the vertices.
    ///
    /// # Errors
    ///
    /// [`StencilError::TooLarge`], if the cage is.
    pub fn new(surface: &'a Surface) -> Result<Self, StencilError> {
        let columns = Columns::of_vertices(surface.cage().positions().len());
        Self::smooth(surface, surface, columns)
    }

    /// For a primvar, by its index: the columns are the vertices, or of face-varying ones the values.
    ///
    /// # Errors
    ///
    /// [`StencilError::Primvar`] if there is no such primvar, [`StencilError::TooLarge`].
    pub fn of_primvar(surface: &'a Surface, primvar: usize) -> Result<Self, StencilError> {
        let missing = StencilError::Primvar { primvar };
        let of_cage = surface.primvars().get(primvar).ok_or(missing.clone())?;
        let topology = surface.cage().topology();
        match of_cage.interpolation {
            Interpolation::Vertex => Self::new(surface),
            Interpolation::Varying => {
                let columns = Columns::of_vertices(topology.num_vertices());
                let net = LinearNet { topology: Cow::Borrowed(topology), columns };
                Ok(Self { surface, net: Net::Linear(net) })
            }
            Interpolation::FaceVarying => {
                let net = channel_net(surface, of_cage);
                let columns = value_columns(of_cage, &net);
                if let Some(channel) = surface.smooth_channel(primvar) {
                    return Self::smooth(surface, channel, columns);
                }
                let topology = Topology::build(net.faces, net.values.len()).map_err(|_| missing)?;
                let net = LinearNet { topology: Cow::Owned(topology), columns };
                Ok(Self { surface, net: Net::Linear(net) })
            }
        }
    }

    fn smooth(
        surface: &'a Surface,
        of_net: &'a Surface,
        columns: Columns,
    ) -> Result<Self, StencilError> {
        let net = SmoothNet::new(of_net, columns)?;
        Ok(Self { surface, net: Net::Smooth(of_net, Box::new(net)) })
    }

    fn columns(&self) -> &Columns {
        match &self.net {
            Net::Smooth(_, net) => net.columns(),
            Net::Linear(net) => &net.columns,
        }
    }

    /// The number of columns.
    pub fn num_columns(&self) -> usize {
        self.columns().count()
    }

    /// The rows of places on the limit surface: quad, u and v, which are clamped to 0..1. Each place
    /// has [`Order::rows`] rows, one after the other.
    ///
    /// # Errors
    ///
    /// [`StencilError`] with the first place that is none: there is no such quad, no surface over it,
    /// or a parameter is NaN.
    pub fn places(
        &self,
        places: &[(QuadId, f64, f64)],
        order: Order,
    ) -> Result<Stencils, StencilError> {
        match order {
            Order::Position => self.rows_of::<1>(places),
            Order::First => self.rows_of::<3>(places),
            Order::Second => self.rows_of::<6>(places),
        }
    }

    fn rows_of<const R: usize>(
        &self,
        places: &[(QuadId, f64, f64)],
    ) -> Result<Stencils, StencilError> {
        let num_columns = self.num_columns();
        in_parts(num_columns, places.len(), |range| {
            let (mut rows, mut sums) = (Stencils::empty(num_columns), Sums::<R>::new(num_columns));
            for place in range {
                self.enter(place, places[place], &mut sums)?;
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
        if quad.0 as usize >= self.surface.num_quads() {
            return Err(StencilError::Quad { place, quad });
        }
        if u.is_nan() || v.is_nan() {
            return Err(StencilError::Parameter { place });
        }
        let at = [u.clamp(0.0, 1.0), v.clamp(0.0, 1.0)];
        let on = self.surface.face_of(quad);
        let is_covered = !self.surface.is_omitted(on.0)
            && match &self.net {
                Net::Smooth(_, net) => net.place(quad, at, sums)?,
                Net::Linear(net) => {
                    net.place(on, at, sums);
                    true
                }
            };
        if is_covered { Ok(()) } else { Err(StencilError::Omitted { place, quad }) }
    }

    /// Where the patches lie that [`StencilBuilder::patches`] knows: of positions as
    /// [`Surface::patch_places`] has them. A face-varying primvar has patches of its own, and none if it
    /// is linear.
    pub fn patch_places(&self, rings: usize) -> Vec<PatchPlace> {
        match &self.net {
            Net::Smooth(of_net, _) => {
                let is_covered = |place: &PatchPlace| {
                    !self.surface.is_omitted(self.surface.face_of(place.quad).0)
                };
                of_net.patch_places(rings).filter(is_covered).collect()
            }
            Net::Linear(_) => Vec::new(),
        }
    }

    /// The rows of the Bernstein-Bezier coefficients of patches, as [`Surface::patch`] has them, at
    /// places of [`StencilBuilder::patch_places`].
    ///
    /// # Errors
    ///
    /// [`StencilError::Patch`] if there is no such patch, [`StencilError::Linear`] for linear primvars.
    pub fn patches(&self, places: &[PatchPlace]) -> Result<PatchStencils, StencilError> {
        match &self.net {
            Net::Smooth(_, net) => PatchStencils::new(net, places),
            Net::Linear(_) => Err(StencilError::Linear),
        }
    }

    /// The cage refined so many times, all of it, holes too. The faces of a face-varying primvar are
    /// those of its own net: they come in the same order, but have vertices of their own at seams.
    ///
    /// # Errors
    ///
    /// [`StencilError::TooLarge`] if 32 bits cannot number its corners or weights.
    pub fn refined(&self, steps: usize) -> Result<RefinedCage, StencilError> {
        let columns = self.columns().without_levels();
        match &self.net {
            Net::Smooth(surface, _) => {
                let masks = Masks::Smooth(&surface.plan().sharpness[0]);
                refined::refined(surface.cage().topology(), &masks, columns, steps)
            }
            Net::Linear(net) => refined::refined(&net.topology, &Masks::Linear, columns, steps),
        }
    }
}

/// The net of a face-varying primvar.
fn channel_net(surface: &Surface, primvar: &Primvar) -> ChannelNet {
    let cage = surface.cage();
    let boundary = surface.options().boundary.unwrap_or(cage.tags().boundary);
    ChannelNet::new(cage, primvar, boundary)
}

/// The columns of a face-varying primvar: its values.
fn value_columns(primvar: &Primvar, net: &ChannelNet) -> Columns {
    let count = primvar.values.len() / usize::max(primvar.width, 1);
    Columns::of_values(count, net.values.clone())
}
