//! From values at the vertices of a cage to those of refined levels, and to rings.

use std::sync::Arc;

use super::{Layout, Surface};
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
        let found = &self.layout.plan.points[point];
        let values = &self.levels[found.level];
        let net: Vec<[f64; N]> =
            self.layout.net_vertices(point).iter().map(|v| values[v.index()]).collect();
        if !found.fan.is_smooth() {
            return Rings::over_fan(&net, rules).expect("these are the rules of a fan");
        }
        let (sectors, _) = net[1..].as_chunks();
        Rings::with_rules(&CNet { center: net[0], sectors: sectors.to_vec() }, rules)
    }
}
