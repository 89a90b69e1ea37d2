//! Unit nets: the rings and the cap over nets in which a single node is 1, once for all points with
//! the same rules.
//!
//! Everything around an extraordinary point is linear in its net, from the limit point to the
//! coefficients of the cap, so its row of weights is read off the surfaces of unit nets, which the
//! code of all other surfaces makes. Their coordinates are numbers, [`WIDTH`] at a time. If the
//! rules commute with turning, the nodes of one sector are enough:
//!
//! ```text
//!   weight of node j of sector t in a patch of sector 0
//!                      = the coefficient in sector -t for the unit net of node j of sector 0
//! ```
//!
//! Numbers are scaled as in [`rings`](crate::rings), by lambda^l in ring l; they lie in no tangent
//! plane, so heights are scaled like everything else.
//!
//! Fans of many faces have too many nodes for that. Their rules are sparse, and a row goes back
//! through the refinements instead, from the patch that is asked for to the net (module
//! [`backwards`](super::backwards)).

use std::sync::{Arc, OnceLock};

use super::{StencilError, backwards};
use crate::cap::{Cap, ValenceCap};
use crate::net::{CNET_NODES, CNet};
use crate::pairs::pairs;
use crate::patch::Patch;
use crate::rings::{CACHED_RINGS, Rings, ValenceRules};

/// The most faces of a fan between sharp edges for unit nets, as all of its nodes need some.
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
    patches_per_sector: usize,
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
}

/// The weights of all nodes in the coefficients of one patch.
#[derive(Debug)]
pub(super) struct PatchWeights {
    table: Arc<Table>,
    /// The number of the patch in the table.
    patch: usize,
    /// What is added to the number of a node to have it seen from the sector of the patch.
    turn: usize,
}

impl PatchWeights {
    /// The degree of the patch in both parameters.
    pub(super) fn degree(&self) -> usize {
        self.table.degree
    }

    /// The weights coefficient by coefficient, the index along b fastest.
    pub(super) fn rows(&self) -> std::slice::Chunks<'_, f64> {
        let Table { num_nodes, degree, ref weights, .. } = *self.table;
        let size = num_nodes * (degree + 1) * (degree + 1);
        weights[self.patch * size..][..size].chunks(num_nodes)
    }

    /// The node that a weight is of, by its number in a row.
    pub(super) fn node(&self, k: usize) -> usize {
        let around = self.table.num_nodes - 1;
        if k == around { k } else { (k + self.turn) % around }
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
            Some(limit) => limit.num_nodes(),
            None => CNET_NODES * self.rules.rules().valence + 1,
        }
    }

    /// The weights of all nodes in the limit point.
    pub(super) fn center(&self) -> &[f64] {
        &self.nets().center
    }

    /// The weights in a patch of a ring, as its scale has them; `None` if there is no such patch.
    pub(super) fn in_ring(&self, ring: usize, sector: usize, which: usize) -> Option<PatchWeights> {
        let rules = self.rules.rules();
        if sector >= rules.valence || which >= rules.patches_per_sector() {
            return None;
        }
        if self.is_large() {
            let weights = backwards::patch(&self.rules, ring, sector, which);
            let num_nodes = self.num_nodes();
            let table = Table { num_nodes, patches_per_sector: 1, degree: rules.degree, weights };
            return Some(PatchWeights { table: Arc::new(table), patch: 0, turn: 0 });
        }
        let make = || Arc::new(self.ring_table(ring));
        let table = self.rings.get(ring).map_or_else(make, |kept| kept.get_or_init(make).clone());
        self.of_sector(table, sector, which)
    }

    /// The weights in the cap, as the ring behind the last has them, if there is one.
    ///
    /// # Errors
    ///
    /// [`StencilError::Fan`] if there are too many faces.
    pub(super) fn cap(&self) -> Result<Option<Arc<Table>>, StencilError> {
        let Some((rules, count)) = &self.cap else { return Ok(None) };
        if self.is_large() {
            let faces = self.rules.rules().valence;
            return Err(StencilError::Fan { faces, most: MOST_FAN_FACES });
        }
        let make = || Arc::new(self.make_cap_table(rules, *count));
        Ok(Some(self.cap_table.get_or_init(make).clone()))
    }

    /// The weights in a patch of a table of all sectors; `None` if there is no such patch.
    pub(super) fn of_sector(
        &self,
        table: Arc<Table>,
        sector: usize,
        which: usize,
    ) -> Option<PatchWeights> {
        let is_there = sector < self.rules.rules().valence && which < table.patches_per_sector;
        is_there.then(|| match self.commutes() {
            true => PatchWeights { table, patch: which, turn: CNET_NODES * sector },
            false => {
                let patch = sector * table.patches_per_sector + which;
                PatchWeights { table, patch, turn: 0 }
            }
        })
    }

    /// Whether there are too many nodes for unit nets.
    fn is_large(&self) -> bool {
        !self.commutes() && self.rules.rules().valence > MOST_FAN_FACES
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
            numbers.map(|k| cap.patch_at(&rings, k / per_sector, k % per_sector)).collect()
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
        for (patch, coef) in pairs(kept, num_coefs) {
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
            if let Some(limit) = self.rules.fan_limit().filter(|_| self.is_large()) {
                return Nets { center: backwards::limit(limit), rings: Vec::new() };
            }
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
