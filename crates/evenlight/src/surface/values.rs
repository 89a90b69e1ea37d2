//! From values at the vertices of a cage to those of refined levels, and to rings.

use std::sync::Arc;

use super::{Layout, Surface};
use crate::mesh::isolation::Plan;
use crate::mesh::{HalfEdgeId, Topology, VertexId, cnet_vertices, fan_vertices};
use crate::net::CNet;
use crate::rings::Rings;

/// The values of the cage and of all refined levels.
pub(super) fn refined<const N: usize>(
    layout: &Layout,
    values: Arc<[[f64; N]]>,
) -> Vec<Arc<[[f64; N]]>> {
    let plan = &layout.plan;
    let mut levels = vec![values];
    for (k, level) in plan.levels.iter().enumerate() {
        let topology = plan.topology(layout.topology(), k);
        let fine = level.values(topology, &plan.sharpness[k], &levels[k]);
        levels.push(fine.into());
    }
    levels
}

impl<const N: usize> Surface<N> {
    /// The rings around a point, over its net at the level at which it is isolated.
    pub(super) fn make_rings(&self, point: usize) -> Rings<N> {
        let rules = self.layout.rules(point).rules().clone();
        if self.layout.plan.points[point].fan.is_smooth() {
            return Rings::with_rules(&self.net(point), rules);
        }
        let net: Vec<[f64; N]> = net_vertices(&self.layout, point)
            .into_iter()
            .map(|v| self.values_of_level(point)[v.index()])
            .collect();
        Rings::over_fan(&net, rules).expect("these are the rules of a fan")
    }

    /// The c-net of a point.
    fn net(&self, point: usize) -> CNet<N> {
        let values = self.values_of_level(point);
        let at = |v: VertexId| values[v.index()];
        let (topology, first) = place_of(&self.layout, point);
        CNet {
            center: at(topology.origin(first)),
            sectors: cnet_vertices(topology, first).into_iter().map(|s| s.map(at)).collect(),
        }
    }

    /// The values of the level at which a point is isolated.
    fn values_of_level(&self, point: usize) -> &[[f64; N]] {
        &self.levels[self.layout.plan.points[point].level]
    }
}

/// The connectivity of the level at which a point is isolated, and the half-edge that leaves the point
/// in front of sector 0.
fn place_of(layout: &Layout, point: usize) -> (&Topology, HalfEdgeId) {
    let plan: &Plan = &layout.plan;
    let topology = plan.topology(layout.topology(), plan.points[point].level);
    (topology, plan.first_half_edges[point])
}

/// The vertices of the net of a fan.
fn net_vertices(layout: &Layout, point: usize) -> Vec<VertexId> {
    let (topology, _) = place_of(layout, point);
    fan_vertices(topology, layout.plan.placed_fan(point))
}
