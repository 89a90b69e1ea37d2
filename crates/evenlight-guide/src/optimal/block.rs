//! Fourier blocks: the nets that are waves of one frequency around the point.
//!
//! Everything commutes with turning by a sector. So nets of the form
//!
//! ```text
//!   d_k of sector s = w^(f s) c_k          for nodes k inside of sectors,     w = exp(2 pi i / n),
//!   d_k of sector s = w^(f s + f/2) c_k    for nodes k on line s, half a turn further
//! ```
//!
//! keep this form with frequency f under every map here; a map has one complex block of order 12
//! for each f. Everything commutes with the mirror in the diagonal of sector 0 too, which maps the
//! wave f, c to the wave -f, c' with the nodes (i, j) and (j, i) exchanged. The complex numbers c
//! with c' = conj(c) are a *real* space of dimension 12, in which the blocks are real matrices:
//!
//! ```text
//!   (i, i), (3, j)     c = y                     one real coordinate
//!   (i, j), i > j      c = y + i y',    its image (j, i) has   c = y - i y'
//! ```
//!
//! Frequency -f has the same matrix as f, so that f = 0..=n/2 suffice. All that is needed are
//! cosines and sines of multiples of a half turn pi/n.

use crate::linear::Matrix;
use crate::nets::NODES_PER_SECTOR;
use crate::optimal::nets::Combination;
use crate::real::Real;
use crate::rules::RULES;

/// A complex number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Complex {
    /// Its real part.
    pub re: Real,
    /// Its imaginary part.
    pub im: Real,
}

impl Complex {
    /// Zero.
    pub const ZERO: Self = Self { re: Real::ZERO, im: Real::ZERO };

    /// The product.
    pub fn times(self, other: Self) -> Self {
        Self {
            re: self.re * other.re - self.im * other.im,
            im: self.re * other.im + self.im * other.re,
        }
    }

    /// The sum.
    pub fn plus(self, other: Self) -> Self {
        Self { re: self.re + other.re, im: self.im + other.im }
    }

    /// The multiple by a real number.
    pub fn scaled(self, factor: Real) -> Self {
        Self { re: factor * self.re, im: factor * self.im }
    }

    /// i times this number.
    pub fn turned(self) -> Self {
        Self { re: -self.im, im: self.re }
    }
}

/// The powers of exp(i pi / n), a half turn.
#[derive(Clone, Debug)]
pub struct HalfTurns(Vec<Complex>);

impl HalfTurns {
    /// The powers for valence n >= 2.
    pub fn new(valence: usize) -> Self {
        let cos = Real::cos_of_turn(2 * valence);
        let one = Complex { re: Real::ONE, im: Real::ZERO };
        let turn = Complex { re: cos, im: (Real::ONE - cos * cos).sqrt() };
        let powers = std::iter::successors(Some(one), |power| Some(power.times(turn)));
        Self(powers.take(2 * valence).collect())
    }

    /// The power with this exponent.
    pub fn power(&self, exponent: isize) -> Complex {
        self.0[exponent.rem_euclid(self.0.len() as isize) as usize]
    }
}

/// How the mirror in the diagonal of its sector maps a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    /// On the diagonal.
    Diagonal,
    /// On line s.
    Line,
    /// One of a pair, whose coordinate is the real part; with the number of the other.
    First(usize),
    /// The other one.
    Second(usize),
}

/// The nodes 00 10 20 30 01 11 21 31 02 12 22 32 of a sector.
const NODES: [Kind; NODES_PER_SECTOR] = [
    Kind::Diagonal,
    Kind::First(4),
    Kind::First(8),
    Kind::Line,
    Kind::Second(1),
    Kind::Diagonal,
    Kind::First(9),
    Kind::Line,
    Kind::Second(2),
    Kind::Second(6),
    Kind::Diagonal,
    Kind::Line,
];

/// The nodes 01 02 11 12 21 22 of a sector of a c-net.
const CNET_NODES: [Kind; 6] =
    [Kind::Line, Kind::Line, Kind::Diagonal, Kind::Second(4), Kind::First(3), Kind::Diagonal];

/// One frequency.
#[derive(Clone, Debug)]
pub struct Block {
    /// The valence n.
    pub valence: usize,
    /// The frequency f.
    pub frequency: usize,
    /// The powers of exp(i pi / n).
    pub half_turns: HalfTurns,
}

/// The real and the imaginary part of a combination of nodes, as rows on the real coordinates.
pub type Parts = [Vec<Real>; 2];

impl Block {
    /// All blocks of a valence, f = 0..=n/2.
    pub fn all(valence: usize) -> Vec<Self> {
        let half_turns = HalfTurns::new(valence);
        let block = |frequency| Self { valence, frequency, half_turns: half_turns.clone() };
        (0..=valence / 2).map(block).collect()
    }

    /// In how many of the frequencies 0..n the block occurs: f and n - f.
    pub fn multiplicity(&self) -> Real {
        let alone = self.frequency == 0 || 2 * self.frequency == self.valence;
        Real::from(if alone { 1 } else { 2 })
    }

    /// The half turns of a wave between a node of sector s + r and the middle of sector s.
    fn phase(&self, kind: Kind, turn: isize) -> isize {
        self.frequency as isize * (2 * turn + isize::from(kind == Kind::Line))
    }

    /// A combination of nodes of a d-net that belongs to an inside of a sector.
    pub fn parts(&self, combination: &Combination) -> Parts {
        self.parts_on(&NODES, combination, 0)
    }

    /// A combination that belongs to node `node` of a d-net, as the row or rows of its coordinates:
    /// the real part, and the imaginary part if it is one of a pair.
    pub fn node_parts(&self, node: usize, combination: &Combination) -> Parts {
        self.parts_on(&NODES, combination, self.phase(NODES[node], 0))
    }

    /// A combination that belongs to a node of a c-net, likewise.
    pub fn node_parts_on_cnet(&self, node: usize, combination: &Combination) -> Parts {
        self.parts_on(&CNET_NODES, combination, self.phase(NODES[node], 0))
    }

    fn parts_on(&self, kinds: &[Kind], combination: &Combination, back: isize) -> Parts {
        let mut parts = [vec![Real::ZERO; kinds.len()], vec![Real::ZERO; kinds.len()]];
        let mut add = |coordinate: usize, value: Complex| {
            parts[0][coordinate] += value.re;
            parts[1][coordinate] += value.im;
        };
        for &((turn, node), weight) in combination {
            let exponent = self.phase(kinds[node], turn) - back;
            let c = self.half_turns.power(exponent).scaled(weight);
            match kinds[node] {
                Kind::Diagonal | Kind::Line => add(node, c),
                Kind::First(other) => {
                    add(node, c);
                    add(other, c.turned());
                }
                Kind::Second(other) => {
                    add(other, c);
                    add(node, c.turned().scaled(-Real::ONE));
                }
            }
        }
        parts
    }

    /// The matrix of a map of nets to nets, by the rules of its nodes; nodes without one become 0.
    ///
    /// Of two nodes that are mirror images only the rule of the first is asked for.
    pub fn matrix(&self, rule: impl Fn(usize) -> Option<Parts>) -> Matrix {
        let columns = |parts: &Parts| parts[0].len();
        let rules: Vec<Option<Parts>> = (0..NODES_PER_SECTOR).map(rule).collect();
        let width = rules.iter().flatten().map(columns).max().unwrap_or(0);
        let mut matrix = Matrix::zeros(NODES_PER_SECTOR, width);
        for (node, parts) in rules.iter().enumerate() {
            match (NODES[node], parts) {
                (Kind::Second(_), _) | (_, None) => {}
                (Kind::First(other), Some([re, im])) => {
                    matrix.set_row(node, re);
                    matrix.set_row(other, im);
                }
                (_, Some([re, _])) => matrix.set_row(node, re),
            }
        }
        matrix
    }

    /// The values c_k = x + i y at all nodes of sector 0 as real coordinates; they must be those of
    /// a wave that the mirror keeps.
    pub fn coordinates(&self, values: impl Fn(usize) -> Complex) -> Vec<Real> {
        let value = |node: usize| {
            let back = self.half_turns.power(-self.phase(NODES[node], 0));
            match NODES[node] {
                Kind::Second(first) => values(first).im,
                _ => values(node).times(back).re,
            }
        };
        (0..NODES_PER_SECTOR).map(value).collect()
    }

    /// The squared length of the coordinate vectors: 1 for each node.
    pub fn metric() -> Matrix {
        Matrix::from_fn(NODES_PER_SECTOR, NODES_PER_SECTOR, |i, j| match (i == j, NODES[i]) {
            (false, _) => Real::ZERO,
            (true, Kind::Diagonal | Kind::Line) => Real::ONE,
            (true, _) => Real::from(2),
        })
    }

    /// The complex coordinates of the part of this frequency of the net that is 1 at a node of
    /// sector s = `turn` and 0 elsewhere.
    pub fn unit(&self, turn: usize, node: usize) -> [Complex; NODES_PER_SECTOR] {
        let mut unit = [Complex::ZERO; NODES_PER_SECTOR];
        let phase = self.half_turns.power(-self.phase(NODES[node], turn as isize));
        let c = phase.scaled(Real::ratio(1, self.valence as i32));
        let half = c.scaled(Real::ratio(1, 2));
        match NODES[node] {
            Kind::Diagonal | Kind::Line => unit[node] = c,
            Kind::First(other) => {
                unit[node] = half;
                unit[other] = half.turned().scaled(-Real::ONE);
            }
            Kind::Second(other) => {
                unit[other] = half;
                unit[node] = half.turned();
            }
        }
        unit
    }

    /// The value at the inner node number `rule` of sector 0 of the wave whose coordinates at the
    /// six inner nodes are `wave`.
    pub fn value(&self, rule: usize, wave: &[Complex; 6]) -> Complex {
        match RULES[rule] {
            (3, _) => wave[rule].times(self.half_turns.power(self.frequency as isize)),
            (2, 1) => wave[1].plus(wave[2].turned()),
            (1, 2) => wave[1].plus(wave[2].turned().scaled(-Real::ONE)),
            _ => wave[rule],
        }
    }
}

/// Rows times a complex vector.
pub fn applied<const N: usize>(rows: &Matrix, vector: &[Complex]) -> [Complex; N] {
    std::array::from_fn(|i| {
        let terms = rows.row(i).iter().zip(vector);
        terms.fold(Complex::ZERO, |sum, (&weight, z)| sum.plus(z.scaled(weight)))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::nets::{DNet, Mirror, own_nodes};

    #[test]
    fn pairs_are_mirror_images() {
        for (i, j) in own_nodes() {
            let (_, a, b) = Mirror::Diagonal.image((0, i, j));
            match NODES[i + 4 * j] {
                Kind::Diagonal => assert_eq!((i, j), (a, b)),
                Kind::Line => assert_eq!(i, 3),
                Kind::First(other) => assert_eq!((other, i > j), (a + 4 * b, true)),
                Kind::Second(other) => assert_eq!((other, i < j), (a + 4 * b, true)),
            }
        }
    }

    /// Taking every unit net apart and summing its waves at a node gives it back.
    #[test]
    fn waves_sum_to_the_net() {
        for n in [3, 5, 8] {
            let net = DNet { valence: n };
            for (turn, node) in (0..n).flat_map(|t| (0..12).map(move |k| (t, k))) {
                for (number, (h, k)) in RULES.into_iter().enumerate() {
                    let sum: Real = Block::all(n)
                        .iter()
                        .map(|block| {
                            let unit = block.unit(turn, node);
                            let wave = [5, 6, 9, 10, 7, 11].map(|k| unit[k]);
                            block.multiplicity() * block.value(number, &wave).re
                        })
                        .sum();
                    let same = net.index(0, h, k) == 12 * turn + node;
                    let expected = Real::from(i32::from(same));
                    assert!((sum - expected).abs().to_f64() < 1e-29, "n = {n}");
                }
            }
        }
    }
}
