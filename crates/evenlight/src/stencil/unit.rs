//! Unit nets: the rings and the cap over nets in which a single node is 1, once for all points with
//! the same rules.
//!
//! Everything around an extraordinary point is linear in its net, from the limit point to the
//! coefficients of the cap, so its row of weights is read off the surfaces of unit nets, which the
//! code of all other surfaces makes. Their coordinates are numbers, [`WIDTH`] at a time. If the rules
//! commute with turning, the nodes of one sector are enough:
//!
//! ```text
//!   weight of node j of sector t in a patch of sector 0
//!                      = the coefficient in sector -t for the unit net of node j of sector 0
//! ```
//!
//! Numbers are scaled as in [`rings`](crate::rings), by lambda^l in ring l; they lie in no tangent
//! plane, so heights are scaled like everything else.

use std::sync::{Arc, OnceLock};

use super::StencilError;
use crate::cap::{Cap, ValenceCap};
use crate::net::{CNET_NODES, CNet};
use crate::patch::Patch;
use crate::rings::{CACHED_RINGS, Rings, ValenceRules};
use crate::scheme::FanLimit;

/// The most faces of a fan between sharp edges: all of its nodes need nets of their own.
const MOST_FAN_FACES: usize = 64;

/// So many unit nets are one net.
const WIDTH: usize = 4;

/// A number of each of them.
type Numbers = [f64; WIDTH];

/// The unit nets of some rules, and the cap that closes their rings.
#[derive(Debug)]
pub(super) struct UnitNets {
    rules: Arc<ValenceRules>,
    cap: Option<(Arc<ValenceCap>, usize)>,
    nets: OnceLock<Nets>,
    rings: [OnceLock<Arc<Table>>; CACHED_RINGS],
    cap_table: OnceLock<Arc<Table>>,
}

/// The rings over unit nets.
#[derive(Debug)]
struct Nets {
    /// The weights of all nodes in the limit point.
    center: Vec<f64>,
    /// Relative to the limit point.
    rings: Vec<Rings<WIDTH>>,
}

/// The weights of all nodes in the BB coefficients of patches: all sectors of a ring or cap, or
/// sector 0 of those that commute with turning.
#[derive(Debug)]
pub(super) struct Table {
    num_nodes: usize,
    pub(super) patches_per_sector: usize,
    /// The degree of the patches in both parameters.
    pub(super) degree: usize,
    /// Patch by patch, coefficient by coefficient.
    weights: Vec<f64>,
}

impl Table {
    /// Of a cap, the patches along each side of a sector.
    pub(super) fn split(&self) -> usize {
        self.patches_per_sector.isqrt()
    }

    /// The weights of all nodes in a patch, coefficient by coefficient.
    pub(super) fn patch(&self, sector: usize, which: usize) -> std::slice::Chunks<'_, f64> {
        let size = self.num_nodes * (self.degree + 1) * (self.degree + 1);
        let first = (sector * self.patches_per_sector + which) * size;
        self.weights[first..first + size].chunks(self.num_nodes)
    }
}

impl UnitNets {
    /// The unit nets of rules; `cap` closes them behind so many rings.
    pub(super) fn new(rules: Arc<ValenceRules>, cap: Option<(Arc<ValenceCap>, usize)>) -> Self {
        let rings = [const { OnceLock::new() }; CACHED_RINGS];
        Self { rules, cap, nets: OnceLock::new(), rings, cap_table: OnceLock::new() }
    }

    /// Whether they are those of a point.
    pub(super) fn are_of(&self, rules: &Arc<ValenceRules>) -> bool {
        Arc::ptr_eq(&self.rules, rules)
    }

    /// Fails if there are too many.
    pub(super) fn check(&self) -> Result<(), StencilError> {
        let faces = self.rules.rules().valence;
        if self.commutes() || faces <= MOST_FAN_FACES {
            return Ok(());
        }
        Err(StencilError::Fan { faces, most: MOST_FAN_FACES })
    }

    pub(super) fn rules(&self) -> &ValenceRules {
        &self.rules
    }

    /// The rings in front of the cap, if there is one.
    pub(super) fn cap_rings(&self) -> Option<usize> {
        self.cap.as_ref().map(|&(_, rings)| rings)
    }

    /// Whether the rules commute with turning.
    fn commutes(&self) -> bool {
        self.rules.fan_limit().is_none()
    }

    /// The number of nodes of a c-net or of the net of a fan.
    fn num_nodes(&self) -> usize {
        match self.rules.fan_limit() {
            Some(limit) => num_fan_nodes(limit),
            None => CNET_NODES * self.rules.rules().valence + 1,
        }
    }

    /// The sector whose patches stand for those of `sector`, and what number node `k` of that one
    /// has seen from there.
    pub(super) fn seen_from(&self, sector: usize) -> (usize, impl Fn(usize) -> usize + use<>) {
        let around = self.num_nodes() - 1;
        let commutes = self.commutes();
        let by = if commutes { CNET_NODES * sector } else { 0 };
        let number = move |k: usize| if k == around { k } else { (k + by) % around };
        (if commutes { 0 } else { sector }, number)
    }

    /// The weights of all nodes in the limit point.
    pub(super) fn center(&self) -> &[f64] {
        &self.nets().center
    }

    /// The weights in the patches of a ring, as its scale has them.
    pub(super) fn ring(&self, ring: usize) -> Arc<Table> {
        let make = || Arc::new(self.ring_table(ring));
        self.rings.get(ring).map_or_else(make, |kept| kept.get_or_init(make).clone())
    }

    /// The weights in the patches of the cap, as the ring behind the last has them.
    pub(super) fn cap(&self) -> Option<Arc<Table>> {
        let (rules, count) = self.cap.as_ref()?;
        let make = || Arc::new(self.make_cap_table(rules, *count));
        Some(self.cap_table.get_or_init(make).clone())
    }

    fn ring_table(&self, ring: usize) -> Table {
        let patches = self.nets().rings.iter().map(|nets| nets.frame_patches(ring));
        self.table(&patches.collect::<Vec<_>>())
    }

    fn make_cap_table(&self, rules: &ValenceCap, count: usize) -> Table {
        let of_nets = |nets: &Rings<WIDTH>| -> Vec<Patch<WIDTH>> {
            // As the caps of nets in front of the first ring, with no scale to come.
            let rings = Rings::over_numbers(nets.net(count), Arc::clone(&self.rules));
            let cap = Cap::with_rules(&rings, 0, rules);
            let per_sector = cap.patches_per_sector();
            let numbers = 0..per_sector * self.rules.rules().valence;
            numbers.map(|k| cap.patch(&rings, k / per_sector, k % per_sector)).collect()
        };
        self.table(&self.nets().rings.iter().map(of_nets).collect::<Vec<_>>())
    }

    /// The table of the patches of all unit nets, sector by sector.
    fn table(&self, patches: &[Vec<Patch<WIDTH>>]) -> Table {
        let (n, num_nodes) = (self.rules.rules().valence, self.num_nodes());
        let patches_per_sector = patches[0].len() / n;
        let degree = patches[0][0].degree()[0];
        let kept = if self.commutes() { patches_per_sector } else { patches[0].len() };
        let num_coefs = (degree + 1) * (degree + 1);
        let mut weights = Vec::with_capacity(kept * num_coefs * num_nodes);
        for (patch, coef) in (0..kept).flat_map(|p| (0..num_coefs).map(move |c| (p, c))) {
            weights.extend((0..num_nodes).map(|node| {
                let (net, turn) = self.net_of(node);
                let sector_patch = (turn * patches_per_sector + patch) % patches[0].len();
                patches[net / WIDTH][sector_patch].coefs()[coef][net % WIDTH]
            }));
        }
        Table { num_nodes, patches_per_sector, degree, weights }
    }

    /// The unit net that stands for a node, and the sector of it that stands for sector 0.
    fn net_of(&self, node: usize) -> (usize, usize) {
        let n = self.rules.rules().valence;
        if !self.commutes() {
            (node, 0)
        } else if node == CNET_NODES * n {
            (CNET_NODES, 0)
        } else {
            (node % CNET_NODES, (n - node / CNET_NODES) % n)
        }
    }

    fn nets(&self) -> &Nets {
        self.nets.get_or_init(|| {
            let n = self.rules.rules().valence;
            let unit_nodes: Vec<usize> = if self.commutes() {
                (0..CNET_NODES).chain([CNET_NODES * n]).collect()
            } else {
                (0..self.num_nodes()).collect()
            };
            let nets: Vec<(Numbers, Rings<WIDTH>)> =
                unit_nodes.chunks(WIDTH).map(|nodes| self.surface_of(nodes)).collect();
            let center = (0..self.num_nodes()).map(|node| {
                let (net, _) = self.net_of(node);
                nets[net / WIDTH].0[net % WIDTH]
            });
            let center = center.collect();
            Nets { center, rings: nets.into_iter().map(|(_, rings)| rings).collect() }
        })
    }

    /// The limit points and the rings of the unit nets of some nodes, one for each coordinate.
    fn surface_of(&self, unit_nodes: &[usize]) -> (Numbers, Rings<WIDTH>) {
        let mut nodes = vec![[0.0; WIDTH]; self.num_nodes()];
        unit_nodes.iter().enumerate().for_each(|(k, &node)| nodes[node][k] = 1.0);
        let (center, first) = match self.rules.fan_limit() {
            Some(limit) => (limit.limit_point(&nodes), limit.first_net(&nodes)),
            None => first_net(&nodes, &self.rules),
        };
        (center, Rings::over_numbers(first, Arc::clone(&self.rules)))
    }
}

fn num_fan_nodes(limit: &FanLimit) -> usize {
    let shape = limit.shape();
    2 * shape.lines() + 4 * shape.faces + 1
}

/// The limit point of a c-net, its centre the last node, and the net of the scheme relative to it.
fn first_net(nodes: &[Numbers], rules: &ValenceRules) -> (Numbers, Vec<Numbers>) {
    let (sectors, _) = nodes.as_chunks::<CNET_NODES>();
    let cnet = CNet { center: nodes[nodes.len() - 1], sectors: sectors.to_vec() };
    let (kind, rules) = (rules.kind(), rules.rules());
    let center = kind.limit_point(&cnet);
    let cnet = cnet.relative_to(center);
    let net = rules.guided_net(&cnet).unwrap_or_else(|| kind.net(&cnet));
    let net = match rules.default_quadratic(&net) {
        Some(q) => rules.with_quadratic(&net, q),
        None => net,
    };
    (center, net)
}
