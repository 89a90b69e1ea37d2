//! The refinement rules: the guide sampled at the scale lambda.
//!
//! One step of the scheme with an attracting quadratic, QAS [KP23-QAS, sec. 4], goes from (d, q) to
//! the averaged L-net of g at the scale lambda, turned from BB form into spline nodes. Of these the
//! six nodes (h, k) = (1,1), (2,1), (1,2), (2,2), (3,1), (3,2) of each sector are used; all others
//! follow regular refinement. The nodes (3, k) on line s come out of the two adjacent sectors s and
//! s+1 and are averaged, which makes the sectors join C2 [KP23-EG, fig. 8c].
//!
//! The Evolving-Guide rules, EG [KP23-EG, eq. 7], are these with q itself expressed by d and the
//! extraordinary point p = c_0: by the q_2..q_6 that minimise the sum of F_k (module
//! [`crate::quadratic`]) over the n sectors of the guide, for k = 4. So each step evolves the guide
//! anew.
//!
//! ```text
//!   d_hk(new, sector s) = a_0^hk c_0 + sum over r, i, j of a_ij^(r,hk) d_ij^(s+r)
//! ```
//!
//! The construction is symmetric under the mirrors in lines and diagonals. With (h, k) below 3:
//!
//! ```text
//!   a_ij^(r,hk) = a_ji^(-r,kh)       a_3j^(r,hk) = a_3j^(-r-1,kh)
//!   a_ij^(r,3k) = a_ji^(1-r,3k)      a_3j^(r,3k) = a_3j^(-r,3k)         (i, j below 3)
//! ```

use crate::border::{NUM_PLACES, bb_to_net, place_index, places};
use crate::characteristic::{CharacteristicMap, characteristic_map};
use crate::guide::{Guide, guide};
use crate::linear::Matrix;
use crate::nets::{DNet, own_nodes};
use crate::quadratic::{functional, turn};
use crate::real::Real;

/// The new nodes (h, k) with special rules, in the order of the tables.
pub const RULES: [(usize, usize); 6] = [(1, 1), (2, 1), (1, 2), (2, 2), (3, 1), (3, 2)];

/// The order k of the functional F_k that determines q in the Evolving-Guide rules.
pub const EG_ORDER: usize = 4;

/// The order k of the functional F_k that determines the first q of the scheme with an attracting
/// quadratic.
pub const QAS_ORDER: usize = 5;

/// The refinement step (d, q) -> d at one valence.
#[derive(Clone, Debug)]
pub struct Step {
    net: DNet,
    /// The characteristic map by which the guide is sampled.
    pub chi: CharacteristicMap,
    /// The guide of one sector.
    pub guide: Guide,
    /// The matrix of the passage of q to the next sector.
    turn: Matrix,
    /// The new L-net of one sector, before the sides of the lines are averaged.
    sampled_on_net: Matrix,
    sampled_on_q: Matrix,
}

/// One rule of a [`Step`]: a new node of sector 0.
#[derive(Clone, Debug)]
pub struct StepRule {
    /// The weights of the 12n nodes of the d-net.
    pub on_net: Vec<Real>,
    /// The weights of q_1..q_6 of sector 0.
    pub on_q: Vec<Real>,
}

/// One Evolving-Guide rule: a new node of sector 0.
#[derive(Clone, Debug, PartialEq)]
pub struct EgRule {
    /// The weights a_ij^r of the 12n nodes of the d-net, numbered by [`DNet::index`].
    pub on_net: Vec<Real>,
    /// The weight a_0 of the extraordinary point.
    pub on_centre: Real,
}

/// Derives the step of valence n >= 3.
pub fn step(valence: usize) -> Step {
    let chi = characteristic_map(valence);
    let guide = guide(&chi.border);
    let sampled = &bb_to_net() * &chi.border.sample(chi.lambda, 5);
    Step {
        net: DNet { valence },
        turn: turn(valence),
        sampled_on_net: &sampled * &guide.on_net,
        sampled_on_q: &sampled * &guide.on_q,
        chi,
        guide,
    }
}

/// The six Evolving-Guide rules of valence n >= 3, in the order of [`RULES`], with q minimising
/// F_`order`; the scheme has `order` = [`EG_ORDER`].
///
/// At n = 4 the result is not the regular refinement and of no use.
pub fn evolving_guide(valence: usize, order: usize) -> [EgRule; 6] {
    let step = step(valence);
    let q = step.quadratic(order);
    RULES.map(|(h, k)| step.rule(h, k).with_quadratic(&q))
}

impl Step {
    /// The rule of the new node (h, k), one of [`RULES`], of sector 0.
    pub fn rule(&self, h: usize, k: usize) -> StepRule {
        if h < 3 {
            return self.one_sided_rule(0, h, k);
        }
        let (own, next) = (self.one_sided_rule(0, 3, k), self.one_sided_rule(1, k, 3));
        StepRule {
            on_net: averages(&own.on_net, &next.on_net),
            on_q: averages(&own.on_q, &next.on_q),
        }
    }

    /// The node at the place (h, k) of the new L-net of `sector`.
    fn one_sided_rule(&self, sector: usize, h: usize, k: usize) -> StepRule {
        let row = place_index(h, k);
        let on_q = &self.sampled_on_q.select_rows(&[row]) * &self.turned(sector);
        let on_net = self.spread(sector, self.sampled_on_net.row(row));
        StepRule { on_net, on_q: on_q.row(0).to_vec() }
    }

    /// The rules of q_2..q_6 of sector 0 that minimise the sum of F_`order` over all sectors, given
    /// the net and q_1 = p: five rows on the 12n nodes of the net and on p.
    ///
    /// With G the functional, g = D_t d + Q A^t q in sector t and H = sum (A^t)^T Q^T G Q A^t, the
    /// normal equations are: rows 2..6 of H q + sum (A^t)^T Q^T G D_t d = 0.
    pub fn quadratic(&self, order: usize) -> Matrix {
        let weighted = &self.guide.on_q.transposed() * &functional(order);
        let (of_q, of_net) = (&weighted * &self.guide.on_q, &weighted * &self.guide.on_net);
        let mut hessian = Matrix::zeros(6, 6);
        let mut right = Matrix::zeros(6, self.net.num_nodes());
        for sector in 0..self.net.valence {
            let turned = self.turned(sector);
            hessian = &hessian + &(&turned.transposed() * &(&of_q * &turned));
            let local = &turned.transposed() * &of_net;
            right = &right + &self.spread_rows(sector, &local);
        }
        let free = [1, 2, 3, 4, 5];
        let right = right.beside(&hessian.columns(0..1)).select_rows(&free);
        let hessian = hessian.select_rows(&free).columns(1..6);
        let solution = hessian.solve(&right.scaled(-Real::ONE));
        solution.expect("positive definite: a guide without cost over a zero border is zero")
    }

    /// A^t: q of sector 0 to q of sector t.
    fn turned(&self, sector: usize) -> Matrix {
        (0..sector).fold(Matrix::identity(6), |power, _| &self.turn * &power)
    }

    /// Weights on the 21 places of `sector`'s L-net as weights on the 12n nodes.
    fn spread(&self, sector: usize, weights: &[Real]) -> Vec<Real> {
        let mut spread = vec![Real::ZERO; self.net.num_nodes()];
        for ((i, j), &weight) in places().zip(weights) {
            spread[self.net.index(sector as isize, i, j)] = weight;
        }
        spread
    }

    /// [`Self::spread`] of each row.
    fn spread_rows(&self, sector: usize, rows: &Matrix) -> Matrix {
        assert_eq!(rows.num_columns(), NUM_PLACES, "one column per place");
        let mut spread = Matrix::zeros(rows.num_rows(), self.net.num_nodes());
        for row in 0..rows.num_rows() {
            spread.set_row(row, &self.spread(sector, rows.row(row)));
        }
        spread
    }
}

impl StepRule {
    /// The rule with q_2..q_6 replaced by their rules on net and centre, and q_1 by the centre.
    pub fn with_quadratic(&self, q: &Matrix) -> EgRule {
        let substituted = |column: usize| -> Real {
            (0..5).map(|row| self.on_q[row + 1] * q[(row, column)]).sum()
        };
        let nodes = self.on_net.len();
        EgRule {
            on_net: (0..nodes).map(|node| self.on_net[node] + substituted(node)).collect(),
            on_centre: self.on_q[0] + substituted(nodes),
        }
    }
}

/// The six rules with each weight averaged with its mirror image.
///
/// In exact arithmetic nothing changes; after it the symmetries hold to the last bit.
pub fn symmetrised(valence: usize, rules: &[EgRule; 6]) -> [EgRule; 6] {
    let net = DNet { valence };
    std::array::from_fn(|number| {
        let weights = (0..valence).flat_map(|r| own_nodes().map(move |(i, j)| (r, i, j)));
        let on_net = weights.map(|(r, i, j)| {
            let (mirror, r2, i2, j2) = mirrored(valence, number, (r, i, j));
            let own = rules[number].on_net[net.index(r as isize, i, j)];
            average(own, rules[mirror].on_net[net.index(r2 as isize, i2, j2)])
        });
        let mirror = mirrored(valence, number, (0, 0, 0)).0;
        EgRule {
            on_net: on_net.collect(),
            on_centre: average(rules[number].on_centre, rules[mirror].on_centre),
        }
    })
}

/// The mirror image of the weight a_ij^r of rule `number` (in [`RULES`]): the weight
/// (number, r, i, j) that is equal to it.
pub fn mirrored(
    valence: usize,
    number: usize,
    (r, i, j): (usize, usize, usize),
) -> (usize, usize, usize, usize) {
    let (h, k) = RULES[number];
    let minus_r = valence - r;
    let (own_line, image) = if h < 3 { (minus_r - 1, (k, h)) } else { (minus_r, (h, k)) };
    let number = RULES.iter().position(|&rule| rule == image).expect("the image is a rule");
    if i == 3 {
        (number, own_line % valence, i, j)
    } else {
        (number, (own_line + 1) % valence, j, i)
    }
}

fn average(a: Real, b: Real) -> Real {
    Real::ratio(1, 2) * (a + b)
}

fn averages(a: &[Real], b: &[Real]) -> Vec<Real> {
    a.iter().zip(b).map(|(&a, &b)| average(a, b)).collect()
}
