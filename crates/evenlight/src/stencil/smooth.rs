//! Rows of a surface: of places on it and of the coefficients of its patches.
//!
//! A place is a few weights of the nodes of one net; its piece is found as
//! [`Surface::eval`](crate::Surface::eval) finds it:
//!
//! ```text
//!   regular piece    4 x 4 nodes     products of B-splines
//!   ring, cap        6 n + 1 nodes   products of Bernstein polynomials, times the weights of the
//!                                    nodes in the coefficients of the patch (module `unit`)
//! ```

use std::sync::Arc;

use super::StencilError;
use super::basis::{factors, product, turned, turned_coefficient};
use super::columns::{Columns, Sums};
use super::unit::{PatchWeights, UnitNets};
use crate::cap::{CapError, CapOptions};
use crate::mesh::isolation::{CORNERS, Piece};
use crate::mesh::{RegularNet, VertexId};
use crate::patch::basis::{CUBIC_B_SPLINE_TO_BB, bernstein_basis, cubic_b_spline};
use crate::rings::{power, ring_of, scaled_up};
use crate::surface::{CapPlan, Layout, PatchPlace, QuadId, RingPatch, Source, quadrant, to_sector};

/// The net of surfaces over a layout, and what is kept of it while stencils are made.
#[derive(Debug)]
pub(super) struct SmoothNet {
    layout: Arc<Layout>,
    caps: Option<CapOptions>,
    columns: Columns,
    units: Vec<UnitNets>,
    /// The number of the unit nets of every extraordinary point.
    of_point: Vec<usize>,
}

/// The net of an extraordinary point, and its unit nets.
struct PointNet<'a> {
    units: &'a UnitNets,
    level: usize,
    vertices: &'a [VertexId],
    /// Of c-nets the centre is the first vertex, of fans the last, but always the last node of
    /// units.
    is_center_first: bool,
}

impl PointNet<'_> {
    /// The level and the vertex of a node.
    fn vertex(&self, node: usize) -> (usize, VertexId) {
        let count = self.vertices.len();
        let at = if self.is_center_first { (node + 1) % count } else { node };
        (self.level, self.vertices[at])
    }
}

/// What the coefficients of a patch are made of.
pub(super) enum PatchRows<'a> {
    /// A net of B-splines.
    Regular(&'a RegularNet),
    /// A patch of a ring or cap.
    Around {
        /// Which.
        spot: Spot<'a>,
        /// The corner of its square at which the extraordinary point is.
        corner: u8,
        /// What its table is scaled by.
        scale: f64,
    },
}

impl PatchRows<'_> {
    /// The degree of the patch in both parameters.
    pub(super) fn degree(&self) -> usize {
        match self {
            Self::Regular(_) => 3,
            Self::Around { spot, .. } => spot.weights.degree(),
        }
    }
}

/// A patch around an extraordinary point.
pub(super) struct Spot<'a> {
    point: PointNet<'a>,
    weights: PatchWeights,
}

impl Spot<'_> {
    /// The level and the vertex that weight k of a row is of.
    fn vertex(&self, k: usize) -> (usize, VertexId) {
        self.point.vertex(self.weights.node(k))
    }
}

impl SmoothNet {
    /// The net of surfaces over `columns`, which have no levels yet, closed by these caps.
    pub(super) fn new(
        layout: &Arc<Layout>,
        caps: Option<CapOptions>,
        columns: Columns,
    ) -> Result<Self, StencilError> {
        let (layout, plan) = (layout.clone(), layout.plan());
        let mut net = Self { layout, caps, columns, units: Vec::new(), of_point: Vec::new() };
        for (k, level) in plan.levels.iter().enumerate() {
            let coarse = plan.topology(net.layout.topology(), k);
            let mask = |v: VertexId| level.mask(coarse, &plan.sharpness[k], v);
            let rows = net.columns.refined(level.topology().num_vertices(), mask)?;
            net.columns.push(rows);
        }
        for point in 0..plan.points.len() {
            let units = net.units_of(point)?;
            net.of_point.push(units);
        }
        Ok(net)
    }

    /// The number of the unit nets of a point, which are made if there are none yet.
    fn units_of(&mut self, point: usize) -> Result<usize, StencilError> {
        let shared = self.layout.rules(point);
        if let Some(found) = self.units.iter().position(|units| units.are_of(shared.rules())) {
            return Ok(found);
        }
        let cap = |caps: CapOptions| Ok::<_, CapError>((shared.cap(caps.kind)?, caps.rings));
        let cap = self.caps.map(cap).transpose()?;
        self.units.push(UnitNets::new(shared.rules().clone(), cap));
        Ok(self.units.len() - 1)
    }

    /// The net of a point that exists.
    fn point(&self, point: usize) -> PointNet<'_> {
        let found = &self.layout.plan().points[point];
        PointNet {
            units: &self.units[self.of_point[point]],
            level: found.level,
            vertices: self.layout.net_vertices(point),
            is_center_first: found.fan.is_smooth(),
        }
    }

    pub(super) fn layout(&self) -> &Layout {
        &self.layout
    }

    /// Where the patches lie.
    pub(super) fn patch_places(&self, rings: usize) -> Result<Vec<PatchPlace>, StencilError> {
        let caps = self.caps.map(|caps| CapPlan::new(&self.layout, caps)).transpose()?;
        Ok(self.layout.places(rings, caps.as_ref()).collect())
    }

    pub(super) fn columns(&self) -> &Columns {
        &self.columns
    }

    /// Enters the R rows of a place, parameters from 0 to 1; `false` if there is no surface over
    /// the quad.
    pub(super) fn place<const R: usize>(
        &self,
        quad: QuadId,
        mut at: [f64; 2],
        sums: &mut Sums<R>,
    ) -> Result<bool, StencilError> {
        let (mut piece, mut zoom) = (self.layout.plan().pieces[quad.0 as usize], 1.0);
        loop {
            match piece {
                Piece::Omitted => return Ok(false),
                Piece::Regular(net) => {
                    let net = &self.layout.plan().nets[net as usize];
                    self.place_in_regular(net, at, zoom, sums);
                    return Ok(true);
                }
                Piece::Sector { point, sector, corner } => {
                    let (point, sector) = (point as usize, sector as usize);
                    self.place_around((point, sector, corner), at, zoom, sums)?;
                    return Ok(true);
                }
                Piece::Split(first) => {
                    let k = quadrant(at);
                    piece = self.layout.plan().pieces[first as usize + k];
                    at = [2.0 * at[0] - CORNERS[k][0], 2.0 * at[1] - CORNERS[k][1]];
                    zoom *= 2.0;
                }
            }
        }
    }

    fn place_in_regular<const R: usize>(
        &self,
        net: &RegularNet,
        [u, v]: [f64; 2],
        zoom: f64,
        sums: &mut Sums<R>,
    ) {
        let factors: [f64; R] = factors([1.0, zoom, zoom * zoom], [1.0; 2]);
        let (bu, bv) = (cubic_b_spline(u), cubic_b_spline(v));
        let weight = |k: usize| product(&factors, [&bu, &bv], [k / 4, k % 4]);
        self.enter_regular(net, std::array::from_fn(weight), sums);
    }

    fn enter_regular<const R: usize>(
        &self,
        net: &RegularNet,
        mut weights: [[f64; R]; 16],
        sums: &mut Sums<R>,
    ) {
        net.fold(&mut weights);
        for (&v, w) in net.vertices.iter().zip(weights).filter(|(_, w)| *w != [0.0; R]) {
            self.columns.enter((net.level as usize, v), w, sums);
        }
    }

    /// A place in the square of a sector, which is `zoom` times as small as the quad.
    fn place_around<const R: usize>(
        &self,
        (point, sector, corner): (usize, usize, u8),
        at: [f64; 2],
        zoom: f64,
        sums: &mut Sums<R>,
    ) -> Result<(), StencilError> {
        let point = self.point(point);
        let units = point.units;
        let sigma = units.rules().rules().sigma();
        let at = to_sector(corner, at);
        let in_hole = |count: usize| at.map(|x| scaled_up(x, count, sigma));
        let is_inside = |count: &usize| in_hole(*count).iter().all(|&x| x <= 1.0);
        let (weights, at, ring, sizes) = if let Some(count) = units.cap_rings().filter(is_inside) {
            let Some(cap) = units.cap()? else { return Ok(()) };
            let (which, at, size) = in_cap_patch(in_hole(count), cap.split());
            (units.of_sector(cap, sector, which), at, count, [size; 2])
        } else if at == [0.0; 2] {
            self.enter_center(&point, sums);
            return Ok(());
        } else {
            let ring = ring_of(at[0].max(at[1]), sigma);
            let place = units.rules().rules().locate(in_hole(ring));
            (units.in_ring(ring, sector, place.which), place.at, ring, place.size)
        };
        if let Some(weights) = weights {
            let [value, first, second] = scales(units, ring);
            let factors = factors([value, first * zoom, second * (zoom * zoom)], sizes);
            self.enter_spot(&Spot { point, weights }, at, factors, corner, sums);
        }
        Ok(())
    }

    /// Enters the rows of a place in a patch by its bases; the limit point has its part in the
    /// position.
    fn enter_spot<const R: usize>(
        &self,
        spot: &Spot<'_>,
        at: [f64; 2],
        factors: [f64; R],
        corner: u8,
        sums: &mut Sums<R>,
    ) {
        let degree = spot.weights.degree();
        let (order, [ba, bb]) = (degree + 1, at.map(|x| bernstein_basis(degree, x)));
        let mut weights = vec![[0.0; R]; spot.point.units.center().len()];
        for (k, row) in spot.weights.rows().enumerate() {
            let w = turned(corner, product(&factors, [&ba, &bb], [k / order, k % order]));
            for (sum, x) in weights.iter_mut().zip(row) {
                (0..R).for_each(|r| sum[r] += w[r] * x);
            }
        }
        for (k, (mut w, center)) in weights.into_iter().zip(spot.point.units.center()).enumerate() {
            w[0] += center;
            if w != [0.0; R] {
                self.columns.enter(spot.vertex(k), w, sums);
            }
        }
    }

    /// The extraordinary point itself, where derivatives do not exist.
    fn enter_center<const R: usize>(&self, point: &PointNet<'_>, sums: &mut Sums<R>) {
        for (node, &w) in point.units.center().iter().enumerate().filter(|&(_, &w)| w != 0.0) {
            let mut rows = [f64::NAN; R];
            rows[0] = w;
            self.columns.enter(point.vertex(node), rows, sums);
        }
    }

    /// What the coefficients of a patch are made of; `None` if it is not one of this surface.
    pub(super) fn patch(&self, place: &PatchPlace) -> Result<Option<PatchRows<'_>>, StencilError> {
        match place.source {
            Source::Net(net) => {
                Ok(self.layout.plan().nets.get(net as usize).map(PatchRows::Regular))
            }
            Source::Ring(at) => {
                self.patch_around(&at, |units| Ok(units.in_ring(at.ring, at.sector, at.which)))
            }
            Source::Cap(at) => self.patch_around(&at, |units| {
                let is_there = units.cap_rings() == Some(at.ring);
                let cap = if is_there { units.cap()? } else { None };
                Ok(cap.and_then(|cap| units.of_sector(cap, at.sector, at.which)))
            }),
        }
    }

    fn patch_around(
        &self,
        at: &RingPatch,
        weights: impl Fn(&UnitNets) -> Result<Option<PatchWeights>, StencilError>,
    ) -> Result<Option<PatchRows<'_>>, StencilError> {
        if at.point >= self.of_point.len() {
            return Ok(None);
        }
        let point = self.point(at.point);
        let scale = power(point.units.rules().subdominant().lambda, at.ring);
        Ok(weights(point.units)?.map(|weights| {
            let spot = Spot { point, weights };
            PatchRows::Around { spot, corner: at.corner, scale }
        }))
    }

    /// Enters coefficient (i,j) of a patch.
    pub(super) fn coefficient(
        &self,
        patch: &PatchRows<'_>,
        [i, j]: [usize; 2],
        sums: &mut Sums<1>,
    ) {
        match patch {
            PatchRows::Regular(net) => {
                let (bu, bv) = (&CUBIC_B_SPLINE_TO_BB[i], &CUBIC_B_SPLINE_TO_BB[j]);
                let weights = std::array::from_fn(|k| [bu[k / 4] * bv[k % 4]]);
                self.enter_regular(net, weights, sums);
            }
            PatchRows::Around { spot, corner, scale } => {
                let k = turned_coefficient(*corner, spot.weights.degree(), [i, j]);
                let row = spot.weights.rows().nth(k).unwrap_or_default();
                for (k, (w, center)) in row.iter().zip(spot.point.units.center()).enumerate() {
                    self.columns.enter(spot.vertex(k), [center + scale * w], sums);
                }
            }
        }
    }
}

/// The factors of positions, first and second derivatives by a and b in a ring, for patch
/// parameters that run once through all of a sector.
fn scales(units: &UnitNets, ring: usize) -> [f64; 3] {
    let lambda = units.rules().subdominant().lambda;
    let step = units.rules().rules().sigma();
    [lambda, lambda / step, lambda / (step * step)].map(|factor| power(factor, ring))
}

/// The patch of a cap that has a place of the hole, as [`Cap::eval`](crate::cap::Cap::eval) chooses
/// it, the parameters in that patch, and its size.
fn in_cap_patch(at: [f64; 2], split: usize) -> (usize, [f64; 2], f64) {
    let m = split as f64;
    let part = at.map(|x| ((x * m).ceil() as usize).saturating_sub(1).min(split - 1));
    let inside = [0, 1].map(|k| (at[k] - part[k] as f64 / m) * m);
    (part[0] * split + part[1], inside, 1.0 / m)
}
