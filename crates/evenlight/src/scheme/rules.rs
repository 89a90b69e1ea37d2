//! The rules of one scheme at one valence, as linear maps in coordinates relative to the
//! limit point.
//!
//! Every scheme here is *stationary*: one linear map takes the net around the extraordinary
//! point to the next, smaller net, and a second one makes a ring of patches of both. The limit
//! point is known before and stays where it is, so all coordinates are taken relative to it:
//!
//! ```text
//!   net x_0 --refine--> x_1 --refine--> x_2 ...        x_l = A^l x_0 -> 0
//!        \            /    \           /
//!         3n patches        3n patches                 ring 1, ring 2, ...
//! ```
//!
//! The maps commute with turning by one sector, so a row is written for sector 0 only. Fans are an
//! exception ([`Symmetry`]).

use crate::angle::sector_cosine;
use crate::net::{self, CNET_NODES, CNet, Expansion, NodeRef};
use crate::point::add_scaled;

/// One row of a linear map: weights of nodes, written for sector 0.
///
/// Node `k` of the sector `r` sectors further on is `r * nodes_per_sector + k`.
pub(crate) type Row = Vec<(usize, f64)>;

/// Whether rules commute with turning by one sector.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Symmetry {
    /// They do: rows and patches are written for sector 0.
    Turning,
    /// They do not, as the rules of a fan: rows and patches are written for all sectors, and all
    /// nodes count as nodes of one sector.
    None,
}

/// The linear rules of one scheme at one valence.
///
/// The patches of a ring lie in three squares of each sector, one patch, 2 x 2 or 3 x 3 in each:
///
/// ```text
///  b ^ line s                      a and b in [0,1] from the centre along lines s-1 and s;
///  1 +-----+-----+                 each patch has its own parameters running the same way
///    |  2  |  0  |
/// .5 +-----+-----+      one patch per square, or   | 1 3 |   (number 4 square + k)
///    | next|  1  |                                 | 0 2 |
///    | ring|     |
///  0 +-----+-----+--> a, line s-1
///    0    .5     1
/// ```
///
/// With [`Cuts`] the lines are elsewhere, sigma in the place of .5.
#[derive(Clone, Debug)]
pub(crate) struct Rules {
    /// The valence n.
    pub(crate) valence: usize,
    pub(crate) symmetry: Symmetry,
    /// How many nodes each sector owns.
    pub(crate) nodes_per_sector: usize,
    /// The new nodes of sector 0 from the old net.
    pub(crate) refine: Vec<Row>,
    /// The degree of the patches in both parameters.
    pub(crate) degree: usize,
    /// The patches along each side of a square: 1, 2 or 3.
    pub(crate) split: usize,
    /// The BB coefficients of the patches of sector 0.
    pub(crate) patches: Vec<PatchRule>,
    /// The quadratic q, if the scheme carries one along.
    pub(crate) quadratic: Option<QuadraticPart>,
    /// The guide, if the scheme follows one.
    pub(crate) guide: Option<GuidePart>,
}

/// How a guided scheme begins. The last 35 nodes of every sector are the powers of the guide's
/// piece relative to the limit point; the powers alpha, beta, gamma, delta, epsilon come first. The
/// other nodes are the data along the outer border.
#[derive(Clone, Debug)]
pub(crate) struct GuidePart {
    /// All nodes of sector 0 as weights of the nodes of a c-net, e the last.
    pub(crate) from_cnet: Vec<Vec<f64>>,
    /// The factor by which the guide is scaled down in each step.
    pub(crate) lambda: f64,
    /// Where rings are cut, if not in halves.
    pub(crate) cuts: Option<Cuts>,
}

/// Where the lines between the patches of a ring are, in a and in b alike.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Cuts {
    /// The ring's hole is \[0,sigma\]^2.
    pub(crate) sigma: f64,
    /// All lines from 0 to 1, sigma in the middle.
    pub(crate) lines: Vec<f64>,
}

/// The powers of a piece of a guide.
const GUIDE_NODES: usize = 35;

/// How a scheme with a quadratic q begins. The last five nodes of every sector are alpha, beta,
/// gamma, delta, epsilon of q in that sector's coordinates; the others are the control net.
#[derive(Clone, Debug)]
pub(crate) struct QuadraticPart {
    /// The default q of sector 0, as rows on the control net (nodes of q not counted).
    pub(crate) from_net: [Row; 5],
    /// The factor by which q is scaled down in each step.
    pub(crate) lambda: f64,
}

/// The corners of the three squares that are nearest to the centre.
const SQUARES: [[f64; 2]; 3] = [[0.5, 0.5], [0.5, 0.0], [0.0, 0.5]];

/// The interval of a or of b that a patch covers.
#[derive(Clone, Copy, Debug)]
struct Side {
    start: f64,
    /// start + size up to rounding; it is exactly the start of the neighbour.
    end: f64,
    size: f64,
}

/// A place in a patch of the outermost ring.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PatchParameters {
    /// The number of the patch in its sector.
    pub(crate) which: usize,
    /// The patch's own parameters.
    pub(crate) at: [f64; 2],
    /// The size of the patch in a and b.
    pub(crate) size: [f64; 2],
}

/// A place along one parameter of a square of a ring: the number of the patch across the square,
/// the patch's own parameter and its size.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PartParameter {
    pub(crate) part: usize,
    pub(crate) at: f64,
    pub(crate) size: f64,
}

/// How a patch follows from the net and its refinement.
#[derive(Clone, Debug, Default)]
pub(crate) struct PatchRule {
    /// The part of each BB coefficient (`b` index fastest) that comes from the old net.
    pub(crate) old: Vec<Row>,
    /// The part that comes from the refined net.
    pub(crate) new: Vec<Row>,
}

impl Rules {
    /// The number of nodes of a net.
    pub(crate) fn num_nodes(&self) -> usize {
        self.turns() * self.nodes_per_sector
    }

    /// The number of sectors that have the same rules up to a turn.
    fn turns(&self) -> usize {
        match self.symmetry {
            Symmetry::Turning => self.valence,
            Symmetry::None => 1,
        }
    }

    /// The number of nodes per sector, without the nodes of q or of the guide.
    pub(crate) fn control_nodes_per_sector(&self) -> usize {
        let others = match (&self.quadratic, &self.guide) {
            (Some(_), _) => 5,
            (_, Some(_)) => GUIDE_NODES,
            _ => 0,
        };
        self.nodes_per_sector - others
    }

    /// lambda of a scheme that carries the linear terms at the centre along: in every sector node
    /// number `control_nodes_per_sector()` is alpha and the next node is beta.
    pub(crate) fn lambda_of_linear_terms(&self) -> Option<f64> {
        let of_quadratic = self.quadratic.as_ref().map(|part| part.lambda);
        of_quadratic.or(self.guide.as_ref().map(|part| part.lambda))
    }

    /// The net of a guided scheme from a c-net relative to its limit point; `None` for others.
    pub(crate) fn guided_net<const N: usize>(&self, cnet: &CNet<N>) -> Option<Vec<[f64; N]>> {
        let part = self.guide.as_ref()?;
        let nodes: Vec<[f64; N]> = cnet.sectors.iter().flatten().copied().collect();
        let mut net = Vec::with_capacity(self.num_nodes());
        for s in 0..self.valence {
            let (behind, ahead) = nodes.split_at(CNET_NODES * s);
            let seen = || ahead.iter().chain(behind).chain([&cnet.center]);
            net.extend(part.from_cnet.iter().map(|row| {
                let mut sum = [0.0; N];
                row.iter().zip(seen()).for_each(|(&w, &p)| add_scaled(&mut sum, w, p));
                sum
            }));
        }
        Some(net)
    }

    /// The default q of a control net; `None` for schemes without q.
    pub(crate) fn default_quadratic<const N: usize>(
        &self,
        net: &[[f64; N]],
    ) -> Option<Expansion<N>> {
        self.quadratic
            .as_ref()
            .map(|part| part.from_net.each_ref().map(|row| weighted(row, |k| net[k])))
    }

    /// The control net with the nodes of q, given in sector 0.
    pub(crate) fn with_quadratic<const N: usize>(
        &self,
        net: &[[f64; N]],
        q: Expansion<N>,
    ) -> Vec<[f64; N]> {
        let c = sector_cosine(self.valence);
        let mut q = q;
        let mut all = Vec::with_capacity(self.num_nodes());
        for sector in net.chunks(self.control_nodes_per_sector()) {
            all.extend(sector);
            all.extend(q);
            q = net::turned(c, q);
        }
        all
    }

    /// The refined net A x.
    pub(crate) fn refine<const N: usize>(&self, net: &[[f64; N]]) -> Vec<[f64; N]> {
        let mut refined = Vec::with_capacity(net.len());
        for s in 0..self.turns() {
            let seen = turned(net, s * self.nodes_per_sector);
            refined.extend(self.refine.iter().map(|row| weighted(row, |k| seen[k])));
        }
        refined
    }

    /// The number of patches in each sector of a ring.
    pub(crate) fn patches_per_sector(&self) -> usize {
        3 * self.split * self.split
    }

    /// Where rings are cut, if not in halves.
    pub(crate) fn cuts(&self) -> Option<&Cuts> {
        self.guide.as_ref()?.cuts.as_ref()
    }

    /// The width of a ring's hole, the ring being 1 wide.
    pub(crate) fn sigma(&self) -> f64 {
        self.cuts().map_or(0.5, |cuts| cuts.sigma)
    }

    /// The corner (a,b) of patch `which` nearest to the centre, and the patch's size.
    pub(crate) fn patch_square(&self, which: usize) -> ([f64; 2], [f64; 2]) {
        let sides = self.patch_sides(which);
        (sides.map(|side| side.start), sides.map(|side| side.size))
    }

    /// The part [[a0, a1], [b0, b1]] of a sector that patch `which` of the outermost ring covers.
    pub(crate) fn patch_domain(&self, which: usize) -> [[f64; 2]; 2] {
        self.patch_sides(which).map(|side| [side.start, side.end])
    }

    /// The numbers of the lines at which patch `which` begins in a and in b: from 0 at the spoke to
    /// 2 split at the outer border, split at the hole.
    pub(crate) fn patch_lines(&self, which: usize) -> [usize; 2] {
        let (square, part) = self.square_and_part(which);
        [0, 1].map(|k| self.first_line(square, k) + part[k])
    }

    /// The square of a patch, and its place in it.
    fn square_and_part(&self, which: usize) -> (usize, [usize; 2]) {
        let (square, part) = (which / (self.split * self.split), which % (self.split * self.split));
        (square, [part / self.split, part % self.split])
    }

    fn patch_sides(&self, which: usize) -> [Side; 2] {
        let (square, part) = self.square_and_part(which);
        [0, 1].map(|k| match self.cuts() {
            None => {
                let size = 0.5 / self.split as f64;
                let start = SQUARES[square][k] + part[k] as f64 * size;
                Side { start, end: start + size, size }
            }
            Some(Cuts { lines, .. }) => {
                let first = self.first_line(square, k) + part[k];
                let [start, end] = [lines[first], lines[first + 1]];
                Side { start, end, size: end - start }
            }
        })
    }

    /// The number of the line at which a square begins.
    fn first_line(&self, square: usize, k: usize) -> usize {
        if SQUARES[square][k] == 0.0 { 0 } else { self.split }
    }

    /// The patch of the outermost ring that contains (a,b), sigma < max(a,b) <= 1 up to rounding.
    pub(crate) fn patch_at(&self, at: [f64; 2]) -> usize {
        self.locate(at).which
    }

    /// The place of (a,b) in the outermost ring, sigma < max(a,b) <= 1 up to rounding.
    #[inline]
    pub(crate) fn locate(&self, [a, b]: [f64; 2]) -> PatchParameters {
        let square = square_of([a, b], self.sigma());
        let (a, b) = (self.locate_along(square, 0, a), self.locate_along(square, 1, b));
        PatchParameters {
            which: self.patch_of([a.part, b.part], square),
            at: [a.at, b.at],
            size: [a.size, b.size],
        }
    }

    /// The number of patch (i, j) of a square, i along a.
    pub(crate) fn patch_of(&self, [i, j]: [usize; 2], square: usize) -> usize {
        (square * self.split + i) * self.split + j
    }

    /// Where a (k = 0) or b (k = 1) is among the patches of a square; on a line between patches it
    /// is in the one before.
    #[inline]
    pub(crate) fn locate_along(&self, square: usize, k: usize, x: f64) -> PartParameter {
        if let Some(Cuts { lines, .. }) = self.cuts() {
            let first = self.first_line(square, k);
            let inner = &lines[first + 1..first + self.split];
            let part = inner.iter().filter(|&&line| x > line).count();
            let (start, end) = (lines[first + part], lines[first + part + 1]);
            let size = end - start;
            return PartParameter { part, at: (x - start) / size, size };
        }
        // From 0 to the number of patches across the square.
        let m = self.split as f64;
        let x = (x - SQUARES[square][k]) * (2.0 * m);
        let below = x as usize;
        let on_line = below > 0 && below as f64 == x;
        let part = (below - usize::from(on_line)).min(self.split - 1);
        PartParameter { part, at: x - part as f64, size: 0.5 / m }
    }

    /// The BB coefficients of patch `which` of sector `s` in the ring between `old` and
    /// `new` = A `old`.
    pub(crate) fn patch<const N: usize>(
        &self,
        s: usize,
        which: usize,
        old: &[[f64; N]],
        new: &[[f64; N]],
    ) -> Vec<[f64; N]> {
        self.patch_of_scaled(s, which, old, (new, [1.0; N]))
    }

    /// [`Rules::patch`] where A `old` is `new` with its coordinates multiplied by `scale`.
    pub(crate) fn patch_of_scaled<const N: usize>(
        &self,
        s: usize,
        which: usize,
        old: &[[f64; N]],
        (new, scale): (&[[f64; N]], [f64; N]),
    ) -> Vec<[f64; N]> {
        let (by, own) = match self.symmetry {
            Symmetry::None => (0, s * self.patches_per_sector()),
            Symmetry::Turning => (s * self.nodes_per_sector, 0),
        };
        // The net is not copied in turned order: nets may be large, and a patch is quickly made.
        let node = |net: &[[f64; N]], k: usize| {
            let at = k + by;
            net[if at < net.len() { at } else { at - net.len() }]
        };
        let rule = &self.patches[own + which];
        let mut coefs = Vec::with_capacity(rule.old.len());
        for (a, b) in rule.old.iter().zip(&rule.new) {
            let mut coef = weighted(a, |k| node(old, k));
            let new = weighted(b, |k| node(new, k));
            for k in 0..N {
                coef[k] += scale[k] * new[k];
            }
            coefs.push(coef);
        }
        coefs
    }
}

/// The square in which (a,b) lies.
#[inline]
fn square_of([a, b]: [f64; 2], sigma: f64) -> usize {
    match (a > sigma, b > sigma) {
        (true, true) => 0,
        (true, false) => 1,
        _ => 2,
    }
}

/// A net turned so that node `by` becomes node 0.
fn turned<const N: usize>(net: &[[f64; N]], by: usize) -> Vec<[f64; N]> {
    let (behind, ahead) = net.split_at(by);
    [ahead, behind].concat()
}

/// A row applied to the nodes of a net.
#[inline]
fn weighted<const N: usize>(row: &Row, node: impl Fn(usize) -> [f64; N]) -> [f64; N] {
    let mut sum = [0.0; N];
    for &(k, w) in row {
        add_scaled(&mut sum, w, node(k));
    }
    sum
}

/// Collects the weights of a row; weights of one node add up.
#[derive(Clone, Debug)]
pub(crate) struct RowBuilder {
    valence: usize,
    nodes_per_sector: usize,
    weights: Vec<f64>,
}

impl RowBuilder {
    pub(crate) fn new(valence: usize, nodes_per_sector: usize) -> Self {
        Self { valence, nodes_per_sector, weights: vec![0.0; valence * nodes_per_sector] }
    }

    pub(crate) fn valence(&self) -> usize {
        self.valence
    }

    /// Adds weight `w` on node `node` of the sector `turn` sectors further on.
    pub(crate) fn add(&mut self, at: NodeRef, w: f64) {
        let r = at.turn.rem_euclid(self.valence as isize) as usize;
        self.weights[r * self.nodes_per_sector + at.node] += w;
    }

    /// Adds `w` times a row on as many nodes per sector, or fewer, turned by `turn` sectors.
    pub(crate) fn add_turned(&mut self, row: &Row, nodes_per_sector: usize, turn: isize, w: f64) {
        for &(at, x) in row {
            let r = (at / nodes_per_sector) as isize + turn;
            self.add(NodeRef { turn: r, node: at % nodes_per_sector }, w * x);
        }
    }

    /// Adds `w` times another row.
    pub(crate) fn add_row(&mut self, row: &Row, w: f64) {
        for &(node, x) in row {
            self.weights[node] += w * x;
        }
    }

    /// The row, without the nodes of weight zero.
    pub(crate) fn finish(self) -> Row {
        self.weights.into_iter().enumerate().filter(|&(_, w)| w != 0.0).collect()
    }
}
