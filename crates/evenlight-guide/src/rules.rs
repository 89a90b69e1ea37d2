//! The refinement step (d, q) -> d: the guide sampled at the scale lambda.
//!
//! One step goes from the net d and the quadratic q to the averaged L-net of the guide g at the
//! scale lambda, turned from BB form into spline nodes. Of these the six nodes (h, k) = (1,1),
//! (2,1), (1,2), (2,2), (3,1), (3,2) of each sector are used; all others follow regular refinement.
//! The nodes (3, k) on line s come out of the two adjacent sectors s and s+1 and are averaged,
//! which makes the sectors join C2 [KP23-EG, fig. 8c]. As each sector of the guide knows only its
//! own L-net and its own q, the rules are local [KP23-QAS, eq. 6]:
//!
//! ```text
//!   d_hk(new, sector s) = sum over r = -1..1, i, j of kappa_ij^(r,hk) d_ij^(s+r)
//!                       + sum over m = 2..6 of tau_m^hk q_m^s + (1 - sums) p        for h < 3,
//! ```
//!
//! and on line s, where half of each side counts, [KP23-QAS, eq. 7]:
//!
//! ```text
//!   d_3k(new, sector s) = sum over r = -1..2, i, j of kappa_ij^(r,3k) d_ij^(s+r)
//!                       + 1/2 sum over m = 2..6 of tau_m^3k (q_m^s + q_m'^(s+1)) + (1 - sums) p,
//! ```
//!
//! m' being the mirror image of m: 4, 6, 2, 5, 3 for m = 2..6.
//!
//! ```text
//!   kappa of h < 3: the L-net of sector s     of h = 3: the L-nets on both sides of line s
//!
//!          o o o       sector s-1                    o o o . o o o     sectors s-1, s+2
//!          x x x       sector s-1                    x x x . x x x     sectors s-1, s+1
//!     j=2  o o o x o   sectors s, s+1           j=2  o o o x o o o     sectors s, s+1
//!     j=1  o o o x o                            j=1  o o o x o o o
//!     j=0  o o o x o       x: on a line         j=0  o o o x o o o
//!        i=0     i=3                               i=0     i=3
//! ```
//!
//! The construction is symmetric under the mirrors in lines and diagonals. With (h, k) below 3 and
//! i, j below 3:
//!
//! ```text
//!   kappa_ij^(r,hk) = kappa_ji^(-r,kh)     kappa_3j^(r,hk) = kappa_3j^(-1-r,kh)
//!   kappa_ij^(r,3k) = kappa_ji^(1-r,3k)    kappa_3j^(r,3k) = kappa_3j^(-r,3k)
//!   tau_m^hk = tau_m'^kh
//! ```

use crate::border::{NUM_PLACES, bb_to_net, place_index, places};
use crate::characteristic::{CharacteristicMap, characteristic_map};
use crate::guide::{Guide, guide};
use crate::linear::Matrix;
use crate::nets::{DNet, Mirror, NODES_PER_SECTOR, home, own_nodes};
use crate::quadratic::{Q_MIRRORED, functional, turn};
use crate::real::Real;

/// The new nodes (h, k) with special rules, in the order of the tables.
pub const RULES: [(usize, usize); 6] = [(1, 1), (2, 1), (1, 2), (2, 2), (3, 1), (3, 2)];

/// The sectors s + r that a rule of sector s can reach, by r.
pub const TURNS: [isize; 4] = [-1, 0, 1, 2];

/// The refinement step (d, q) -> d at one valence.
#[derive(Clone, Debug)]
pub struct Step {
    /// The numbering of the net.
    pub net: DNet,
    /// The characteristic map by which the guide is sampled.
    pub chi: CharacteristicMap,
    /// The guide of one sector.
    pub guide: Guide,
    /// The new L-net of one sector, before the sides of the lines are averaged.
    sampled_on_net: Matrix,
    sampled_on_q: Matrix,
}

/// One rule of a [`Step`]: a new node of sector s.
#[derive(Clone, Debug, PartialEq)]
pub struct StepRule {
    /// The new node (h, k), one of [`RULES`].
    pub node: (usize, usize),
    /// For each r of [`TURNS`] the weights kappa_ij^r of the nodes d_ij^(s+r), in flat order.
    pub kappa: [[Real; NODES_PER_SECTOR]; 4],
    /// The weights tau of q_2..q_6 of sector s; of a node on line s, where one half counts for
    /// each side, twice these weights.
    pub tau: [Real; 5],
    /// The weight of the extraordinary point, derived, not one minus the sum of the others.
    pub on_centre: Real,
}

/// Derives the step of valence n >= 3.
pub fn step(valence: usize) -> Step {
    let chi = characteristic_map(valence);
    let guide = guide(&chi.border);
    let sampled = &bb_to_net() * &chi.border.sample(chi.lambda, 5);
    Step {
        net: DNet { valence },
        sampled_on_net: &sampled * &guide.on_net,
        sampled_on_q: &sampled * &guide.on_q,
        chi,
        guide,
    }
}

impl Step {
    /// The rule of the new node (h, k), one of [`RULES`].
    pub fn rule(&self, h: usize, k: usize) -> StepRule {
        let own = self.one_sided_rule(h, k);
        if h < 3 {
            return own;
        }
        // The same node seen from sector s+1: one sector further, and q in reverse.
        let mut next = self.one_sided_rule(k, 3);
        next.kappa.rotate_right(1);
        next.tau = tau_mirrored(&next.tau);
        own.averaged_with(&next)
    }

    /// The node at the place (h, k) of the new L-net of sector s, before the sides of the lines
    /// are averaged.
    fn one_sided_rule(&self, h: usize, k: usize) -> StepRule {
        let row = place_index(h, k);
        let mut kappa = [[Real::ZERO; NODES_PER_SECTOR]; 4];
        for ((i, j), &weight) in places().zip(self.sampled_on_net.row(row)) {
            let (r, i, j) = home(i, j);
            kappa[(r - TURNS[0]) as usize][i + 4 * j] = weight;
        }
        let on_q = self.sampled_on_q.row(row);
        let tau = std::array::from_fn(|m| on_q[m + 1]);
        StepRule { node: (h, k), kappa, tau, on_centre: on_q[0] }
    }

    /// The q of sector 0 whose q_1 is p and whose q_2..q_6 minimise the sum of F_`order` over all
    /// sectors: six rows on the 12n nodes of the net and on p.
    ///
    /// With G the functional, g = D_t d + Q A^t q in sector t and H = sum (A^t)^T Q^T G Q A^t, the
    /// normal equations are: rows 2..6 of H q + sum (A^t)^T Q^T G D_t d = 0.
    pub fn quadratic(&self, order: usize) -> Matrix {
        let weighted = &self.guide.on_q.transposed() * &functional(order);
        let (of_q, of_net) = (&weighted * &self.guide.on_q, &weighted * &self.guide.on_net);
        let turn = turn(self.net.valence);
        let mut turned = Matrix::identity(6); // A^t
        let mut hessian = Matrix::zeros(6, 6);
        let mut right = Matrix::zeros(6, self.net.num_nodes());
        for sector in 0..self.net.valence {
            hessian = &hessian + &(&turned.transposed() * &(&of_q * &turned));
            let local = &turned.transposed() * &of_net;
            right = &right + &self.spread_rows(sector, &local);
            turned = &turn * &turned;
        }
        let free = [1, 2, 3, 4, 5];
        let right = right.beside(&hessian.columns(0..1)).select_rows(&free);
        let hessian = hessian.select_rows(&free).columns(1..6);
        let solution = hessian.solve(&right.scaled(-Real::ONE));
        let p = self.net.num_nodes();
        Matrix::from_fn(1, p + 1, |_, node| if node == p { Real::ONE } else { Real::ZERO })
            .above(&solution.expect("positive definite: a guide without cost over no net is zero"))
    }

    /// Rows on the 21 places of `sector`'s L-net as rows on the 12n nodes.
    fn spread_rows(&self, sector: usize, rows: &Matrix) -> Matrix {
        assert_eq!(rows.num_columns(), NUM_PLACES, "one column per place");
        let mut spread = Matrix::zeros(rows.num_rows(), self.net.num_nodes());
        for (place, (i, j)) in places().enumerate() {
            let node = self.net.index(sector as isize, i, j);
            for row in 0..rows.num_rows() {
                spread[(row, node)] = rows[(row, place)];
            }
        }
        spread
    }
}

impl StepRule {
    /// The weights of q_2..q_6 of sector s and of q_2..q_6 of sector s+1.
    pub fn on_quadratics(&self) -> [[Real; 5]; 2] {
        if self.node.0 < 3 {
            return [self.tau, [Real::ZERO; 5]];
        }
        let half = Real::ratio(1, 2);
        [self.tau, tau_mirrored(&self.tau)].map(|tau| tau.map(|weight| half * weight))
    }

    /// The sum of all weights: 1, since constants are reproduced.
    pub fn sum(&self) -> Real {
        let weights = self.kappa.iter().flatten().chain(&self.tau).chain([&self.on_centre]);
        weights.copied().sum()
    }

    /// The rule as seen in the mirror of [`mirror_of`] its number; the image of a rule on line s
    /// has the same tau by the form of equation 7.
    pub fn mirrored(&self) -> Self {
        let (h, k) = self.node;
        let (mirror, _) = mirror_of(number_of(h, k));
        let mut kappa = [[Real::ZERO; NODES_PER_SECTOR]; 4];
        for (row, r) in kappa.iter_mut().zip(TURNS) {
            for (weight, (i, j)) in row.iter_mut().zip(own_nodes()) {
                *weight = self.kappa_of(mirror.image((r, i, j)));
            }
        }
        match mirror {
            Mirror::Line => Self { kappa, ..self.clone() },
            Mirror::Diagonal => {
                Self { node: (k, h), kappa, tau: tau_mirrored(&self.tau), ..self.clone() }
            }
        }
    }

    /// kappa_ij^r, zero out of reach.
    fn kappa_of(&self, (r, i, j): (isize, usize, usize)) -> Real {
        let row = TURNS.iter().position(|&turn| turn == r);
        row.map_or(Real::ZERO, |row| self.kappa[row][i + 4 * j])
    }

    /// Each weight averaged with the weight of `other`.
    fn averaged_with(&self, other: &Self) -> Self {
        Self {
            node: self.node,
            kappa: std::array::from_fn(|r| averages(&self.kappa[r], &other.kappa[r])),
            tau: averages(&self.tau, &other.tau),
            on_centre: average(self.on_centre, other.on_centre),
        }
    }
}

/// The six rules, in the order of [`RULES`], with each weight averaged with its mirror image.
///
/// In exact arithmetic nothing changes; after it the symmetries hold to the last bit.
pub fn symmetrised(rules: &[StepRule; 6]) -> [StepRule; 6] {
    std::array::from_fn(|number| {
        let (_, image) = mirror_of(number);
        rules[number].averaged_with(&rules[image].mirrored())
    })
}

/// The mirror that maps rule `number` (in [`RULES`]) to a rule of the same sector, and the number
/// of that rule: itself, except that 12 and 21 change places.
pub fn mirror_of(number: usize) -> (Mirror, usize) {
    match RULES[number] {
        (3, _) => (Mirror::Line, number),
        (h, k) => (Mirror::Diagonal, number_of(k, h)),
    }
}

/// The number of a rule in [`RULES`].
///
/// # Panics
///
/// If (h, k) has no special rule.
pub fn number_of(h: usize, k: usize) -> usize {
    RULES.iter().position(|&rule| rule == (h, k)).expect("the other nodes have regular rules")
}

/// The weights of q_2..q_6 seen in the mirror that exchanges the two lines.
pub fn tau_mirrored(tau: &[Real; 5]) -> [Real; 5] {
    std::array::from_fn(|m| tau[Q_MIRRORED[m + 1] - 1])
}

/// The mean of two numbers, the same whichever comes first.
pub(crate) fn average(a: Real, b: Real) -> Real {
    Real::ratio(1, 2) * (a + b)
}

fn averages<const N: usize>(a: &[Real; N], b: &[Real; N]) -> [Real; N] {
    std::array::from_fn(|k| average(a[k], b[k]))
}
