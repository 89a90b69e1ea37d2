//! Primvars beside the surface: texture coordinates, colours, anything of up to four numbers.
//!
//! | interpolation | over a parametric quad |
//! | --- | --- |
//! | vertex | as the position: by the scheme, with the cage's creases and corners |
//! | varying | bilinear; an n-gon by the middles of its edges and its centre |
//! | face-varying | a surface of its own on the primvar's own net, whose seams are boundaries, see [`FaceVaryingRule`]; with the rule "all" like varying |
//!
//! Where the net of a face-varying primvar is smooth around an extraordinary point it has the
//! surface's scheme there; elsewhere Catmull-Clark's rules, also if positions have
//! fair rings beside creases ([`CreaseRings::Fair`]).
//!
//! A vertex primvar has the layout of the positions, a face-varying one a layout of its own. Both
//! are [`Surface`]s of as many numbers as the primvar has, built when they are first asked for.

use std::sync::{Arc, OnceLock};

use super::{CreaseRings, Layout, QuadId, Surface, SurfaceOptions};
use crate::cap::CapOptions;
use crate::mesh::primvar_net::PrimvarNet;
use crate::mesh::{FaceVaryingRule, Interpolation, Primvar};
use crate::patch::Jet;

/// A primvar that can be evaluated.
#[derive(Debug)]
pub(super) enum PrimvarSurface {
    /// Bilinear over every quad.
    Linear,
    /// Smooth, by its width.
    Smooth1(Surface<1>),
    Smooth2(Surface<2>),
    Smooth3(Surface<3>),
    Smooth4(Surface<4>),
    /// There is no surface. This does not happen: the smooth extraordinary points of a primvar are
    /// extraordinary points of the positions too, so the scheme has rules for them. All other
    /// points have the rules of Catmull-Clark.
    None,
}

impl PrimvarSurface {
    fn new(layout: &Arc<Layout>, caps: Option<CapOptions>, primvar: &Primvar) -> Self {
        let over = match primvar.interpolation {
            Interpolation::Varying => return Self::Linear,
            Interpolation::FaceVarying if layout.tags().face_varying == FaceVaryingRule::All => {
                return Self::Linear;
            }
            Interpolation::FaceVarying => Self::own_layout(layout, primvar),
            Interpolation::Vertex => {
                let vertices = 0..layout.num_vertices() as u32;
                Some((layout.clone(), vertices.collect()))
            }
        };
        let Some((layout, values)) = over else { return Self::None };
        let smooth = match primvar.width {
            1 => surface(&layout, caps, primvar, &values).map(Self::Smooth1),
            2 => surface(&layout, caps, primvar, &values).map(Self::Smooth2),
            3 => surface(&layout, caps, primvar, &values).map(Self::Smooth3),
            _ => surface(&layout, caps, primvar, &values).map(Self::Smooth4),
        };
        debug_assert!(smooth.is_some(), "a primvar has no points that the positions have not");
        smooth.unwrap_or(Self::None)
    }

    /// The layout of a face-varying primvar, and the number of the value at each of its vertices.
    fn own_layout(layout: &Layout, primvar: &Primvar) -> Option<(Arc<Layout>, Vec<u32>)> {
        let options = layout.options();
        let boundary = options.boundary.unwrap_or(layout.tags().boundary);
        let net = PrimvarNet::new(layout.topology(), layout.tags(), primvar, boundary);
        // The primvar has a boundary rule of its own, and at its seams what others make of it.
        let creases = CreaseRings::CatmullClark;
        let options = SurfaceOptions { boundary: None, creases, ..options };
        let topology = layout.topology().with_vertices(net.faces, net.values.len()).ok()?;
        let topology = Arc::new(topology);
        let tags = Arc::new(net.tags);
        let own = Layout::of_net(topology, tags, net.beyond, options, layout.cache()).ok()?;
        Some((Arc::new(own), net.values))
    }
}

/// The layout of a smooth face-varying primvar, and the number of the value at each of its
/// vertices.
pub(crate) fn own_layout(layout: &Layout, primvar: &Primvar) -> Option<(Arc<Layout>, Vec<u32>)> {
    PrimvarSurface::own_layout(layout, primvar)
}

/// The surface of a primvar over a layout at whose vertices it has the values of these numbers.
fn surface<const N: usize>(
    layout: &Arc<Layout>,
    caps: Option<CapOptions>,
    primvar: &Primvar,
    values: &[u32],
) -> Option<Surface<N>> {
    let (all, _) = primvar.values.as_chunks::<N>();
    let values = values.iter().map(|&number| all[number as usize]).collect();
    let mut surface = Surface::over(layout, values).ok()?;
    surface.set_caps(caps).ok()?;
    Some(surface)
}

/// The first N numbers of a value; those beyond the primvar's width are 0.
fn padded<const N: usize>(primvar: &Primvar, value: usize) -> [f64; N] {
    let numbers = &primvar.values[value * primvar.width..][..primvar.width];
    std::array::from_fn(|k| numbers.get(k).copied().unwrap_or(0.0))
}

/// The first N numbers of a jet of M.
#[inline]
fn resized<const M: usize, const N: usize>(jet: &Jet<M>) -> Jet<N> {
    let row = |x: &[f64; M]| {
        let mut row = [0.0; N];
        row[..N.min(M)].copy_from_slice(&x[..N.min(M)]);
        row
    };
    let Jet { p, du, dv, duu, duv, dvv } = jet;
    Jet { p: row(p), du: row(du), dv: row(dv), duu: row(duu), duv: row(duv), dvv: row(dvv) }
}

/// The bilinear map of a value at each corner of the unit square, in the order of a face.
fn bilinear<const N: usize>(corners: [[f64; N]; 4], u: f64, v: f64) -> Jet<N> {
    let mix = |weights: [f64; 4]| -> [f64; N] {
        std::array::from_fn(|k| (0..4).map(|corner| weights[corner] * corners[corner][k]).sum())
    };
    Jet {
        p: mix([(1.0 - u) * (1.0 - v), u * (1.0 - v), u * v, (1.0 - u) * v]),
        du: mix([v - 1.0, 1.0 - v, v, -v]),
        dv: mix([u - 1.0, -u, u, 1.0 - u]),
        duv: mix([1.0, -1.0, 1.0, -1.0]),
        ..Jet::default()
    }
}

impl Surface {
    /// The primvars of the cage.
    pub fn primvars(&self) -> &[Primvar] {
        &self.primvars
    }

    /// Value and derivatives of a primvar, by its index, at (u,v) of `quad`, which are clamped to
    /// 0..1: its first N numbers, those beyond its width being 0. `None` where [`Surface::eval`]
    /// is, and if there is no such primvar.
    ///
    /// Derivatives do not exist (NaN) at extraordinary points, as for positions.
    ///
    /// ```
    /// use evenlight::io::load::Format;
    /// use evenlight::{FaceId, Surface, SurfaceOptions};
    ///
    /// let text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 2 0\nvt 2 2\nvt 0 2\n\
    ///             f 1/1 2/2 3/3 4/4\n";
    /// let (cage, _) = Format::Obj.read_cage(text.as_bytes())?;
    /// let surface = Surface::build(cage, SurfaceOptions::default())?;
    /// let quad = surface.quad(FaceId(0), 0).expect("the only face is a quad");
    /// let st = surface.eval_primvar::<2>(0, quad, 0.5, 0.5).expect("there is a texture");
    /// assert!((st.p[0] - 1.0).abs() < 1e-15 && (st.p[1] - 1.0).abs() < 1e-15);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn eval_primvar<const N: usize>(
        &self,
        primvar: usize,
        quad: QuadId,
        u: f64,
        v: f64,
    ) -> Option<Jet<N>> {
        match self.built_primvar(primvar)? {
            PrimvarSurface::Linear => self.eval_linear(primvar, quad, [u, v]),
            PrimvarSurface::Smooth1(surface) => {
                surface.eval_second(quad, u, v).map(|jet| resized(&jet))
            }
            PrimvarSurface::Smooth2(surface) => {
                surface.eval_second(quad, u, v).map(|jet| resized(&jet))
            }
            PrimvarSurface::Smooth3(surface) => {
                surface.eval_second(quad, u, v).map(|jet| resized(&jet))
            }
            PrimvarSurface::Smooth4(surface) => {
                surface.eval_second(quad, u, v).map(|jet| resized(&jet))
            }
            PrimvarSurface::None => None,
        }
    }

    /// The surface of a primvar, by its index, if it is smooth and has N numbers; for everything
    /// that surfaces can do.
    pub fn primvar_surface<const N: usize>(&self, primvar: usize) -> Option<&Surface<N>> {
        let surface: &dyn std::any::Any = match self.built_primvar(primvar)? {
            PrimvarSurface::Smooth1(surface) => surface,
            PrimvarSurface::Smooth2(surface) => surface,
            PrimvarSurface::Smooth3(surface) => surface,
            PrimvarSurface::Smooth4(surface) => surface,
            PrimvarSurface::Linear | PrimvarSurface::None => return None,
        };
        surface.downcast_ref()
    }

    fn built_primvar(&self, primvar: usize) -> Option<&PrimvarSurface> {
        let of_cage = self.primvars.get(primvar)?;
        let make = || PrimvarSurface::new(&self.layout, self.cap_options(), of_cage);
        Some(self.primvar_surfaces[primvar].get_or_init(make))
    }

    /// The values of a primvar where lines of constant u meet lines of constant v, as
    /// [`Surface::eval_grid`].
    pub(crate) fn primvar_grid(
        &self,
        primvar: usize,
        quad: QuadId,
        us: &[f64],
        vs: &[f64],
    ) -> Option<Vec<[f64; 4]>> {
        let all = |surface: &dyn GridOfValues| surface.values(quad, us, vs);
        match self.built_primvar(primvar)? {
            PrimvarSurface::Linear => {
                let places = us.iter().flat_map(|&u| vs.iter().map(move |&v| [u, v]));
                places.map(|at| Some(self.eval_linear(primvar, quad, at)?.p)).collect()
            }
            PrimvarSurface::Smooth1(surface) => Some(all(surface)),
            PrimvarSurface::Smooth2(surface) => Some(all(surface)),
            PrimvarSurface::Smooth3(surface) => Some(all(surface)),
            PrimvarSurface::Smooth4(surface) => Some(all(surface)),
            PrimvarSurface::None => None,
        }
    }

    fn eval_linear<const N: usize>(
        &self,
        primvar: usize,
        quad: QuadId,
        [u, v]: [f64; 2],
    ) -> Option<Jet<N>> {
        let (face, corner) = self.face_of(quad)?;
        if u.is_nan() || v.is_nan() || self.is_omitted(face) {
            return None;
        }
        let (u, v) = (u.clamp(0.0, 1.0), v.clamp(0.0, 1.0));
        let (primvar, faces) = (self.primvars.get(primvar)?, self.topology().faces());
        let range = faces.corner_range(face);
        let size = range.len();
        let value = |k: usize| -> [f64; N] {
            let number = match primvar.interpolation {
                Interpolation::FaceVarying => primvar.indices[range.start + k % size] as usize,
                _ => faces.corners(face)[k % size].index(),
            };
            padded(primvar, number)
        };
        if size == 4 {
            return Some(bilinear([0, 1, 2, 3].map(value), u, v));
        }
        let mean = |a: [f64; N], b: [f64; N]| std::array::from_fn(|i| 0.5 * (a[i] + b[i]));
        let centre: [f64; N] =
            std::array::from_fn(|i| (0..size).map(|k| value(k)[i]).sum::<f64>() / size as f64);
        let here = value(corner);
        let ahead = mean(here, value(corner + 1));
        let behind = mean(here, value(corner + size - 1));
        Some(bilinear([here, ahead, centre, behind], u, v))
    }
}

/// A surface of any width, by its values alone.
trait GridOfValues {
    /// The values where lines meet; numbers beyond the width are 0.
    fn values(&self, quad: QuadId, us: &[f64], vs: &[f64]) -> Vec<[f64; 4]>;
}

impl<const N: usize> GridOfValues for Surface<N> {
    fn values(&self, quad: QuadId, us: &[f64], vs: &[f64]) -> Vec<[f64; 4]> {
        let mut found = vec![[f64::NAN; N]; us.len() * vs.len()];
        let all = self.eval_grid(quad, us, vs, &mut found);
        debug_assert_eq!(all, Ok(()), "there is an answer for every pair");
        let in_four = |x: &[f64; N]| std::array::from_fn(|k| x.get(k).copied().unwrap_or(0.0));
        found.iter().map(in_four).collect()
    }
}

/// Places for the surfaces of primvars, none of them built.
pub(super) fn unbuilt(primvars: &[Primvar]) -> Vec<Arc<OnceLock<PrimvarSurface>>> {
    primvars.iter().map(|_| Arc::default()).collect()
}
