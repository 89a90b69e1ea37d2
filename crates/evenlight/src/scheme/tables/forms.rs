//! What the generated files hold: one form for each kind of table.

use super::NODES;
use crate::net::CNET_NODES;

/// The Evolving-Guide rules of one valence: numerators over [`DENOMINATOR`](super::DENOMINATOR).
///
/// A rule is a list of rows r = 0, 1, ...; a row has the weights of the nodes
/// 00 10 20 30 01 11 21 31 02 12 22 32 of sector s + r.
pub(super) struct EgTable {
    /// The valence n.
    pub valence: usize,
    /// The rule of d_11, rows 0..=n/2.
    pub rule_11: &'static [[i64; NODES]],
    /// The rule of d_22, rows 0..=n/2.
    pub rule_22: &'static [[i64; NODES]],
    /// The rule of d_21, all n rows.
    pub rule_21: &'static [[i64; NODES]],
    /// The rule of d_31, rows 0..=(n+1)/2.
    pub rule_31: &'static [[i64; NODES]],
    /// The rule of d_32, rows 0..=(n+1)/2.
    pub rule_32: &'static [[i64; NODES]],
}

/// The Quadratic-Attraction rules of one valence: numerators over
/// [`DENOMINATOR`](super::DENOMINATOR).
///
/// `kappa` has the weights of the twelve nodes 00 10 20 30 01 11 21 31 02 12 22 32 of sector s;
/// of 30 31 32 20 21 22 of sector s-1; and, in rule 21 alone, of 02 12 22 of sector s+1:
///
/// ```text
///   j=4  15 16 17
///   j=3  12 13 14
///   j=2   8  9 10 11 20        the L-net of sector s; at j = 3, 4 nodes of sector s-1,
///   j=1   4  5  6  7 19        at i = 4 of sector s+1
///   j=0   0  1  2  3 18
///       i=0      i=3
/// ```
///
/// `tau` has the weights of q_2..q_6.
pub(super) struct QasTable {
    /// The valence n.
    pub valence: usize,
    /// The rule of d_11, 18 weights.
    pub kappa_11: &'static [i64],
    /// The rule of d_22, 18 weights.
    pub kappa_22: &'static [i64],
    /// The rule of d_21, 21 weights.
    pub kappa_21: &'static [i64],
    /// The rule of d_31, 18 weights.
    pub kappa_31: &'static [i64],
    /// The rule of d_32, 18 weights.
    pub kappa_32: &'static [i64],
    /// The weights of q in d_11.
    pub tau_11: [i64; 5],
    /// The weights of q in d_22.
    pub tau_22: [i64; 5],
    /// The weights of q in d_21.
    pub tau_21: [i64; 5],
    /// Twice the weights of q of sector s in d_31.
    pub tau_31: [i64; 5],
    /// Twice the weights of q of sector s in d_32.
    pub tau_32: [i64; 5],
    /// The rule of q_4, rows r = 0..=(n+1)/2 of the twelve nodes of sector s + r.
    pub mu_4: &'static [[i64; NODES]],
    /// The rule of q_5, rows r = 0..=n/2.
    pub mu_5: &'static [[i64; NODES]],
}

/// The guide of one valence: numerators over [`DENOMINATOR`](super::DENOMINATOR).
pub(super) struct GuidedTable {
    /// The valence n.
    pub valence: usize,
    /// For each of the coefficients that are listed the weights of the nodes (0,1) (0,2) (1,1)
    /// (1,2) (2,1) (2,2) of sectors s + r: r = -1, 0, 1, .. for p_i0, r = 0, 1, .. for all others.
    pub coefs: [&'static [[i64; CNET_NODES]]; 20],
    /// The map of a cap.
    #[cfg_attr(not(test), expect(dead_code, reason = "surfaces have rings at any depth, no caps"))]
    pub cap_map: [[i64; 7]; 7],
}
