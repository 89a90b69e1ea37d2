//! Primvars beside the surface: texture coordinates, colours, anything of up to four numbers.
//!
//! | interpolation | over a parametric quad |
//! | --- | --- |
//! | vertex | as the position: by the scheme, with the cage's creases and corners |
//! | varying | bilinear; an n-gon by the middles of its edges and its centre |
//! | face-varying | a surface of its own on the channel's own net, whose seams are boundaries, see [`FaceVaryingRule`]; with the rule "all" like varying |
//!
//! Where the net of a face-varying channel is smooth around an extraordinary point it has the
//! surface's scheme there; elsewhere Catmull-Clark's rules, also if positions have
//! fair rings beside creases ([`CreaseRings::Fair`]).
//!
//! Channels are built when they are first asked for.

use std::collections::BTreeMap;
use std::sync::{Arc, OnceLock};

use super::{CreaseRings, QuadId, Surface, SurfaceOptions};
use crate::cap::CapOptions;
use crate::mesh::channel::{ChannelNet, triple};
use crate::mesh::sharpness::Beyond;
use crate::mesh::{Cage, FaceVaryingRule, Interpolation, Mesh, Primvar, VertexId};
use crate::patch::Jet;

/// The value of a primvar and its derivatives by the parameters of a quad; numbers beyond the
/// primvar's width are 0.
///
/// Derivatives do not exist (NaN) where those of a surface do not: at extraordinary points.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PrimvarJet {
    /// The value.
    pub value: [f64; 4],
    /// The derivative in u.
    pub du: [f64; 4],
    /// The derivative in v.
    pub dv: [f64; 4],
    /// The second derivative in u.
    pub duu: [f64; 4],
    /// The mixed second derivative.
    pub duv: [f64; 4],
    /// The second derivative in v.
    pub dvv: [f64; 4],
}

impl PrimvarJet {
    /// Puts the numbers of a jet from number `first` on.
    fn put(&mut self, first: usize, jet: &Jet) {
        let own = [
            &mut self.value,
            &mut self.du,
            &mut self.dv,
            &mut self.duu,
            &mut self.duv,
            &mut self.dvv,
        ];
        for (own, row) in own.into_iter().zip(jet.rows()) {
            own.iter_mut().skip(first).zip(row).for_each(|(x, y)| *x = y);
        }
    }

    /// The bilinear map of a value at each corner of the unit square, in the order of a face.
    fn bilinear(corners: [[f64; 4]; 4], u: f64, v: f64) -> Self {
        let mix = |weights: [f64; 4]| {
            [0, 1, 2, 3].map(|k| (0..4).map(|corner| weights[corner] * corners[corner][k]).sum())
        };
        Self {
            value: mix([(1.0 - u) * (1.0 - v), u * (1.0 - v), u * v, (1.0 - u) * v]),
            du: mix([v - 1.0, 1.0 - v, v, -v]),
            dv: mix([u - 1.0, -u, u, 1.0 - u]),
            duv: mix([1.0, -1.0, 1.0, -1.0]),
            ..Self::default()
        }
    }
}

/// A primvar that can be evaluated.
#[derive(Debug)]
pub(super) enum Channel {
    Linear,
    /// Surfaces of three of the numbers each; `None` if there is none, see [`Channel::surface`].
    Smooth(Vec<Option<Surface>>),
}

impl Channel {
    fn new(surface: &Surface, primvar: &Primvar) -> Self {
        let (cage, options, caps) = (&surface.cage, surface.options, surface.cap_options());
        let parts = (0..primvar.width).step_by(3);
        match primvar.interpolation {
            Interpolation::Varying => Self::Linear,
            Interpolation::FaceVarying if cage.tags().face_varying == FaceVaryingRule::All => {
                Self::Linear
            }
            Interpolation::FaceVarying => {
                let boundary = options.boundary.unwrap_or(cage.tags().boundary);
                let net = ChannelNet::new(cage, primvar, boundary);
                // The channel has a boundary rule of its own, and at its seams what others make of it.
                let creases = CreaseRings::CatmullClark;
                let options = SurfaceOptions { boundary: None, creases, ..options };
                let beyond = || net.beyond.clone();
                let surface =
                    |first| Self::surface(net.mesh(primvar, first), options, caps, beyond());
                Self::Smooth(parts.map(surface).collect())
            }
            Interpolation::Vertex => {
                let mesh = |first| as_positions(cage, primvar, first);
                let surface = |first| Self::surface(mesh(first), options, caps, BTreeMap::new());
                Self::Smooth(parts.map(surface).collect())
            }
        }
    }

    /// The surface over a channel's mesh. There always is one: its smooth extraordinary points are
    /// among those of the positions, for which the scheme has rules, and the others have those of
    /// Catmull-Clark.
    fn surface(
        mesh: Mesh,
        options: SurfaceOptions,
        caps: Option<CapOptions>,
        beyond: BTreeMap<VertexId, Beyond>,
    ) -> Option<Surface> {
        let cage = Arc::new(Cage::new(mesh).ok()?);
        let surface = Surface::build_channel(cage, options, beyond).ok();
        debug_assert!(surface.is_some(), "a channel has no points that the positions have not");
        let mut surface = surface?;
        let closed = surface.set_caps(caps);
        debug_assert!(closed.is_ok(), "its rings are as those of the positions");
        Some(surface)
    }
}

/// The cage with the numbers of a vertex primvar in the place of positions.
fn as_positions(cage: &Cage, primvar: &Primvar, first: usize) -> Mesh {
    let positions = (0..cage.positions().len()).map(|v| triple(primvar, v, first)).collect();
    let (faces, tags) = (cage.topology().faces().clone(), cage.tags().clone());
    Mesh { positions, faces, tags, primvars: Vec::new() }
}

impl Surface {
    /// The primvars of the cage.
    pub fn primvars(&self) -> &[Primvar] {
        self.cage.primvars()
    }

    /// Value and derivatives of a primvar, by its index, at (u,v) of `quad`, which are clamped to
    /// 0..1; `None` where [`Surface::eval`] is, and if there is no such primvar.
    ///
    /// ```
    /// use evenlight::io::obj;
    /// use evenlight::{FaceId, Surface, SurfaceOptions};
    ///
    /// let text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 2 0\nvt 2 2\nvt 0 2\n\
    ///             f 1/1 2/2 3/3 4/4\n";
    /// let (cage, _) = obj::read_cage(text.as_bytes())?;
    /// let surface = Surface::build(cage, SurfaceOptions::default())?;
    /// let quad = surface.quad(FaceId(0), 0).expect("the only face is a quad");
    /// let st = surface.eval_primvar(0, quad, 0.5, 0.5).expect("there is a texture");
    /// assert!((st.value[0] - 1.0).abs() < 1e-15 && (st.value[1] - 1.0).abs() < 1e-15);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn eval_primvar(&self, primvar: usize, quad: QuadId, u: f64, v: f64) -> Option<PrimvarJet> {
        let of_cage = self.primvars().get(primvar)?;
        if u.is_nan() || v.is_nan() || (quad.0 as usize) >= self.num_quads() {
            return None;
        }
        let (u, v) = (u.clamp(0.0, 1.0), v.clamp(0.0, 1.0));
        if self.is_omitted(self.face_of(quad).0) {
            return None;
        }
        let channel = self.channels[primvar].get_or_init(|| Channel::new(self, of_cage));
        let surfaces = match channel {
            Channel::Linear => return Some(self.eval_linear(of_cage, quad, u, v)),
            Channel::Smooth(surfaces) => surfaces,
        };
        let mut jet = PrimvarJet::default();
        for (part, surface) in surfaces.iter().enumerate() {
            jet.put(3 * part, &surface.as_ref()?.eval(quad, u, v)?.jet);
        }
        Some(jet)
    }

    /// The surface that has the numbers 0 to 2 of a primvar for positions, by its index; `None` if there
    /// is none, as of primvars that are interpolated linearly.
    pub(crate) fn smooth_channel(&self, primvar: usize) -> Option<&Self> {
        let of_cage = self.primvars().get(primvar)?;
        match self.channels[primvar].get_or_init(|| Channel::new(self, of_cage)) {
            Channel::Linear => None,
            Channel::Smooth(surfaces) => surfaces.first()?.as_ref(),
        }
    }

    fn eval_linear(&self, primvar: &Primvar, quad: QuadId, u: f64, v: f64) -> PrimvarJet {
        let (face, corner) = self.face_of(quad);
        let faces = self.cage.topology().faces();
        let range = faces.corner_range(face);
        let size = range.len();
        let number = |k: usize| match primvar.interpolation {
            Interpolation::FaceVarying => primvar.indices[range.start + k % size] as usize,
            _ => faces.corners(face)[k % size].index(),
        };
        let value = |k: usize| {
            let numbers = &primvar.values[number(k) * primvar.width..][..primvar.width];
            [0, 1, 2, 3].map(|i| numbers.get(i).copied().unwrap_or(0.0))
        };
        if size == 4 {
            return PrimvarJet::bilinear([0, 1, 2, 3].map(value), u, v);
        }
        let mean = |a: [f64; 4], b: [f64; 4]| [0, 1, 2, 3].map(|i| 0.5 * (a[i] + b[i]));
        let centre =
            [0, 1, 2, 3].map(|i| (0..size).map(|k| value(k)[i]).sum::<f64>() / size as f64);
        let here = value(corner);
        let corners =
            [here, mean(here, value(corner + 1)), centre, mean(here, value(corner + size - 1))];
        PrimvarJet::bilinear(corners, u, v)
    }
}

/// Places for the channels of a cage, none of them built.
pub(super) fn unbuilt(cage: &Cage) -> Vec<OnceLock<Channel>> {
    cage.primvars().iter().map(|_| OnceLock::new()).collect()
}
