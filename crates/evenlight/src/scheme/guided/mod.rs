//! Guided C2 subdivision [KP18-Guided]: rings of degree bi-6, bi-5, bi-4 (2 x 2 patches) or bi-3
//! (3 x 3) that follow a guide.
//!
//! The guide is a G2 surface g of n bi-5 pieces that has the shape but does not meet the
//! surroundings. Ring l samples g(lambda^l chi), chi being the characteristic ring of
//! Catmull-Clark subdivision, and joins ring l - 1, or the surrounding surface, C2:
//!
//! ```text
//!             outer border
//!   o o o o o o | o o o o o o      square 2 (left above), 0 (right above), 1 (right below);
//!   o o o o o o | o o o o o o      * 3 x 3 jets of g(lambda^l chi) at the inner corners
//!   o o o o o o | o o o o o o        (bi-6: 4 x 4, averaged where they overlap);
//!   * * *       | * * *   o o      o continues the three layers outside the border
//!   * * *       | * * *   o o
//!   * * * * * * | * * *   o o
//!   ------------+-------------
//! ```
//!
//! As a stationary rule, a sector's nodes are the three layers outside its two outer edges, BB
//! coefficients of a patch as wide as the sector, and the coefficients a_ij, 0 < i + j, of its
//! piece g = sum a_ij u^i v^j relative to c_0:
//!
//! ```text
//!   a_ij  <-  lambda^(i+j) a_ij,     layers  <-  the inner layers of the ring's squares 1 and 2.
//! ```
//!
//! So the eigenvalues are powers of lambda, and the surface tends to the expansion a_10, a_01,
//! a_20, a_11, a_02. Curvature is bounded; with bi-6 rings, which reproduce a quadratic of chi, it
//! is continuous. Bi-4 and bi-3 rings replace the segments of bi-5 rings by splines (module
//! `segment`).

mod model;
mod sampling;
mod segment;

use super::contraction::Contraction;
use super::rules::{Cuts, GuidePart, PatchRule, Row, Rules, Symmetry};
use crate::net::{CNET_NODES, cnet_node};
use crate::pairs::pairs;
pub(super) use model::LAST_VALENCE;
use model::Model;
use sampling::sampled;
use segment::{
    Matrix, bb_at_end, bb_at_start, in_units, knots, matrix, num_pieces, parts, pieces, raised,
    taylor_at_end, taylor_at_start,
};

/// The powers u^i v^j of a piece of the guide without the constant, by falling eigenvalue.
const NUM_MONOMIALS: usize = 35;

/// The number of layers of BB coefficients in second-order data.
const LAYERS: usize = 3;

/// The coefficients of a cubic on [0,1] from the uniform B-spline nodes -1, 0, 1, 2, times 6.
const NODES_TO_BB: [[f64; 4]; 4] =
    [[1.0, 4.0, 1.0, 0.0], [0.0, 4.0, 2.0, 0.0], [0.0, 2.0, 4.0, 0.0], [0.0, 1.0, 4.0, 1.0]];

/// The rules with rings of bi-`degree` 3 to 6 at valence `n`, if there is a guide.
pub(super) fn rules(n: usize, degree: usize, contraction: Contraction) -> Option<Rules> {
    let model = Model::new(n, contraction)?;
    let ring = Ring::new(&model, degree);
    let cuts = (model.sigma != 0.5).then(|| ring.cuts());
    Some(Rules {
        valence: n,
        symmetry: Symmetry::Turning,
        nodes_per_sector: ring.num_nodes(),
        refine: ring.refine(model.lambda),
        degree,
        split: num_pieces(degree),
        patches: ring.patches(),
        quadratic: None,
        guide: Some(GuidePart {
            from_cnet: ring.border_of_cnet(n).into_iter().chain(model.guide).collect(),
            lambda: model.lambda,
            cuts,
        }),
    })
}

/// (i,j) with 0 < i + j and i, j <= 5, by i + j: the last nodes of every sector; the first five are
/// the expansion.
fn monomials() -> Vec<(usize, usize)> {
    let of_degree = |s: usize| (0..=5).rev().filter(move |&i| i <= s && s - i <= 5);
    (1..=10).flat_map(|s| of_degree(s).map(move |i| (i, s - i))).collect()
}

/// The powers of a piece of a guide, in the order of the nodes.
pub(crate) fn guide_monomials() -> Vec<(usize, usize)> {
    monomials()
}

/// For every power of [`guide_monomials`] the patch of bi-`degree` 3 to 6 that samples it, in jets
/// at the corners, along the two coordinates of a map.
pub(crate) fn sampled_guide(map: &[Vec<f64>; 2], degree: usize) -> Vec<Vec<f64>> {
    let count = match degree {
        6 => 4,
        3 => 2,
        _ => 3,
    };
    sampled(map, degree, count, &monomials())
}

/// The linear maps of a ring, on the nodes of one sector: first the layers outside u = 1, then
/// those outside v = 1, layer by layer inside out, then the guide.
///
/// The patches outside belong to the ring before, so they are (1 - sigma) / sigma times as wide as
/// the sector.
struct Ring {
    sigma: f64,
    /// The degree of the patches.
    degree: usize,
    /// The degree in which rings are sampled, 6 or 5.
    sampled: usize,
    /// For each square and coefficient a_ij the sampled patch.
    inside: [Vec<Vec<f64>>; 3],
}

impl Ring {
    fn new(model: &Model, degree: usize) -> Self {
        let (sampled_degree, count) = if degree == 6 { (6, 4) } else { (5, 3) };
        let inside = model
            .characteristic
            .each_ref()
            .map(|square| sampled(square, sampled_degree, count, &monomials()));
        Self { sigma: model.sigma, degree, sampled: sampled_degree, inside }
    }

    /// The lines between the patches: the knots of the segments \[0,sigma\] and \[sigma,1\].
    fn cuts(&self) -> Cuts {
        let sigma = self.sigma;
        let [inner, outer] = knots(self.degree, sigma);
        let inside = inner.into_iter().map(|x| sigma * x);
        let beyond = outer.into_iter().map(|x| sigma + (1.0 - sigma) * x);
        let lines = [0.0].into_iter().chain(inside).chain([sigma]).chain(beyond).chain([1.0]);
        Cuts { sigma, lines: lines.collect() }
    }

    /// The coefficients of a sampled patch along one side.
    fn order(&self) -> usize {
        self.sampled + 1
    }

    fn num_border(&self) -> usize {
        2 * LAYERS * self.order()
    }

    fn num_nodes(&self) -> usize {
        self.num_border() + NUM_MONOMIALS
    }

    /// The node of a layer outside edge u = 1 (0) or v = 1 (1).
    fn border_node(&self, edge: usize, layer: usize, along: usize) -> usize {
        (edge * LAYERS + layer) * self.order() + along
    }

    /// The new nodes from the old.
    fn refine(&self, lambda: f64) -> Vec<Row> {
        let order = self.order();
        let layers = (0..LAYERS).flat_map(|layer| (0..order).map(move |k| (layer, k)));
        let beside_u = layers.clone().map(|(layer, k)| (1, layer * order + k));
        let beside_v = layers.map(|(layer, k)| (2, k * order + layer));
        let border = beside_u.chain(beside_v).map(|(square, coef)| self.row_on_guide(square, coef));
        let border: Vec<Row> = border.map(|row| sparse(&row)).collect();
        let guide = monomials().into_iter().enumerate().map(|(k, (i, j))| {
            vec![(self.num_border() + k, (0..i + j).fold(1.0, |power, _| power * lambda))]
        });
        border.into_iter().chain(guide).collect()
    }

    /// A coefficient of a sampled patch, on the nodes of the sector.
    fn row_on_guide(&self, square: usize, coef: usize) -> Vec<f64> {
        let mut row = vec![0.0; self.num_nodes()];
        for (weight, patch) in row[self.num_border()..].iter_mut().zip(&self.inside[square]) {
            *weight = patch[coef];
        }
        row
    }

    /// The patches of sector 0.
    fn patches(&self) -> Vec<PatchRule> {
        (0..3).flat_map(|square| self.pieces(square, &self.square(square))).collect()
    }

    /// The sampled patch of a square with its border, a row on the nodes for each coefficient.
    fn square(&self, square: usize) -> Matrix {
        let order = self.order();
        let mut rows: Matrix =
            (0..order * order).map(|coef| self.row_on_guide(square, coef)).collect();
        let outer = order - LAYERS;
        // The parts of edge u = 1 that belong to squares 0 and 1, and of v = 1 to squares 0 and 2.
        let [beside_u, beside_v] = [[Some(1), Some(0), None], [Some(1), None, Some(0)]];
        for (layer, k) in (0..LAYERS).flat_map(|layer| (0..order).map(move |k| (layer, k))) {
            if let Some(part) = beside_u[square] {
                rows[(outer + layer) * order + k] = self.continued(0, part, layer, k);
            }
            if let Some(part) = beside_v[square] {
                rows[k * order + outer + layer] = self.continued(1, part, layer, k);
            }
        }
        rows
    }

    /// Coefficient number `k` along one part of an edge of the `layer` inside it.
    fn continued(&self, edge: usize, part: usize, layer: usize, k: usize) -> Vec<f64> {
        let across = matrix(LAYERS, |outside| {
            // The other coefficients of the outside patch do not enter.
            let mut patch = outside.to_vec();
            patch.resize(self.order(), 0.0);
            bb_at_end(self.sampled, &in_units(self.sigma, &taylor_at_start(&patch, LAYERS)))
        });
        let along = matrix(self.order(), |whole| {
            let [low, high] = parts(&knots(self.degree, self.sigma)[0], self.sigma, whole);
            if part == 0 { low } else { high }
        });
        let mut row = vec![0.0; self.num_nodes()];
        for (m, &w) in across[layer].iter().enumerate() {
            for (l, &x) in along[k].iter().enumerate() {
                row[self.border_node(edge, m, l)] = w * x;
            }
        }
        row
    }

    /// The patches that replace the sampled patch of a square.
    fn pieces(&self, which: usize, square: &Matrix) -> Vec<PatchRule> {
        let (split, order) = (num_pieces(self.degree), self.degree + 1);
        let segments = knots(self.degree, self.sigma)
            .map(|knots| matrix(self.order(), |b| pieces(&knots, b).concat()));
        // Whether the square is in the outer part of u and of v.
        let [of_u, of_v] = [[1, 1], [1, 0], [0, 1]][which].map(|part| &segments[part]);
        let coef = |i: usize, j: usize| {
            let mut sum = vec![0.0; self.num_nodes()];
            for (row, (k, l)) in square.iter().zip(pairs(self.order(), self.order())) {
                let w = of_u[i][k] * of_v[j][l];
                if w != 0.0 {
                    sum.iter_mut().zip(row).for_each(|(sum, x)| *sum += w * x);
                }
            }
            sparse(&sum)
        };
        let piece = |which: usize| {
            let (u, v) = (which / split * order, which % split * order);
            let old = (0..order * order).map(|at| coef(u + at / order, v + at % order)).collect();
            PatchRule { old, new: vec![Row::new(); order * order] }
        };
        (0..split * split).map(piece).collect()
    }

    /// The layers outside the border of the first ring, as weights of a c-net: they continue the
    /// tensor border b_ij of the net.
    fn border_of_cnet(&self, n: usize) -> Vec<Vec<f64>> {
        let width = (1.0 - self.sigma) / self.sigma;
        let across =
            matrix(4, |b| bb_at_start(self.sampled, &in_units(width, &taylor_at_end(b, LAYERS))));
        let along = matrix(4, |b| raised(b, self.sampled));
        let mut rows = vec![vec![0.0; CNET_NODES * n + 1]; self.num_border()];
        for (layer, k) in (0..LAYERS).flat_map(|m| (0..self.order()).map(move |k| (m, k))) {
            for (i, j) in pairs(4, 4) {
                let w = across[layer][i] * along[k][j];
                add_border_coefficient(&mut rows[self.border_node(0, layer, k)], n, [i, j], w);
                add_border_coefficient(&mut rows[self.border_node(1, layer, k)], n, [j, i], w);
            }
        }
        rows
    }
}

/// Adds `w` b_ij: the tensor border, bi-3 coefficients that the nodes of a c-net would have over
/// the unit square. b_00 is no part of it; its `w` is zero.
fn add_border_coefficient(row: &mut [f64], n: usize, [i, j]: [usize; 2], w: f64) {
    for (a, b) in pairs(4, 4) {
        let weight = w * NODES_TO_BB[i][a] * NODES_TO_BB[j][b] / 36.0;
        if weight == 0.0 {
            continue;
        }
        let node = cnet_node(a as isize - 1, b as isize - 1).map_or(CNET_NODES * n, |at| {
            CNET_NODES * at.turn.rem_euclid(n as isize) as usize + at.node
        });
        row[node] += weight;
    }
}

fn sparse(weights: &[f64]) -> Row {
    weights.iter().copied().enumerate().filter(|&(_, w)| w != 0.0).collect()
}
