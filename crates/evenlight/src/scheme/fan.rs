//! Catmull-Clark subdivision around a vertex with sharp edges, or sharp itself: the rules of one
//! *fan* of faces [CC78], [DKT98].
//!
//! The net of a fan of f faces has two nodes on each of its lines, four in each of its sectors and
//! the vertex c in its middle. In sector s, a runs along line s and b along line s+1:
//!
//! ```text
//!   line s+1
//!   (0,2) --- (1,2) --- (2,2)       order of the nodes: (1,0), (2,0) of every line,
//!     |         |         |         then (1,1), (1,2), (2,1), (2,2) of every sector
//!   (0,1) --- (1,1) --- (2,1)
//!     |         |         |         beyond a sharp line stands the mirror image of the row behind
//!     c ------(1,0)-----(2,0)       it: (a,-1) = 2 (a,0) - (a,1)
//!                      line s
//! ```
//!
//! One refinement gives the nodes up to (3,3), hence three bi-3 patches per sector and the next
//! such net. All rules except the rule of c are cubic knot insertion. As for smooth vertices, c is
//! no node of the rules: it follows, since the limit point is the origin. With the left eigenvector
//! of eigenvalue 1 that is w_c c + sum w_k p_k = 0. The weights are known for creases (1/6, 2/3,
//! 1/6) and corners (c alone), and found by iteration for darts.

mod fair;

pub use fair::MAX_FAIR_FACES;
pub(crate) use fair::{FairFan, fair_rules, is_fair};

use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};

use super::rules::{PatchRule, Row, Rules, Symmetry};
use crate::angle::{cosine, sine};
use crate::net::{Fan, VertexRule};
use crate::patch::basis::CUBIC_B_SPLINE_TO_BB;
use crate::point::{Point, Vector, add_scaled, cross, dot, norm, sub, unit};

/// The limit point of a fan and its tangent plane.
#[derive(Clone, Debug)]
pub(crate) struct FanLimit {
    shape: Fan,
    /// The factor by which nets shrink in each step, in the long run.
    pub(crate) lambda: f64,
    /// The limit point of a net, where the node c is the last.
    point: Row,
    tangents: Tangents,
    /// The first net of the rules as weights of the net of the fan, where c is the last node;
    /// `None` if it is the net of the fan without c.
    first_net: Option<Vec<Row>>,
    /// For rules with 2 x 2 patches per square: the BB coefficients of the patches of the hole that
    /// do not touch the centre, as weights of the net. In half widths of the hole these patches are
    /// [0,1] x [1,2], [1,2] x [0,1], [1,2] x [1,2].
    cells: Vec<[Vec<Row>; 3]>,
}

/// How the tangent plane at the centre is found.
#[derive(Clone, Debug)]
enum Tangents {
    /// There is none: at a corner of two faces or more, at a sharp vertex, and on creases with four
    /// faces or more on a side, where more than two directions shrink no faster than the crease.
    None,
    /// Two rows, where c is the last node; the normal is the cross product of the directions.
    Rows([Row; 2]),
    /// The rules have a tangent plane of their own.
    OfRules,
    /// A single face at a crease. The first direction is along the crease; the second is the bend
    /// of the crease, or, if the crease is straight, the direction across the face.
    Tip,
}

/// Directions shorter than this part of the net count as zero.
const FLATTEST: f64 = 1e-12;

/// The rules of fans of this shape, with the rows of all sectors.
pub(crate) fn rules(shape: Fan) -> (Rules, FanLimit) {
    let net = Net::new(shape);
    let refine: Vec<Row> = net.kept_nodes().iter().map(|row| net.eliminate(row)).collect();
    let patches = (0..shape.faces as isize)
        .flat_map(|s| [(1, 1), (1, 0), (0, 1)].map(|(a, b)| net.patch(s, a, b)))
        .collect();
    let lambda = growth(&refine);
    let tangents = tangents(&net, &refine);
    let rules = Rules {
        valence: shape.faces,
        symmetry: Symmetry::None,
        nodes_per_sector: net.num_nodes(),
        refine,
        degree: 3,
        split: 1,
        patches,
        quadratic: None,
        guide: None,
    };
    let point = net.limit.into_iter().collect();
    (rules, FanLimit { shape, lambda, point, tangents, first_net: None, cells: Vec::new() })
}

impl FanLimit {
    pub(crate) fn shape(&self) -> Fan {
        self.shape
    }

    /// The number of nodes of the net, the node c included.
    pub(crate) fn num_nodes(&self) -> usize {
        2 * self.shape.lines() + 4 * self.shape.faces + 1
    }

    /// The limit point as weights of the nodes, where c is the last.
    pub(crate) fn point(&self) -> &Row {
        &self.point
    }

    /// The rows of the two directions that span the tangent plane, where c is the last node. The
    /// first is along the crease if there is one. `None` if there are no such directions.
    pub(crate) fn tangent_rows(&self) -> Option<&[Row; 2]> {
        match &self.tangents {
            Tangents::Rows(rows) => Some(rows),
            Tangents::None | Tangents::Tip | Tangents::OfRules => None,
        }
    }

    /// Adds c to a net that is relative to its limit point.
    pub(crate) fn with_vertex<const N: usize>(&self, nodes: &[[f64; N]]) -> Vec<[f64; N]> {
        let (mut sum, mut own) = ([0.0; N], 1.0);
        for &(k, w) in &self.point {
            match nodes.get(k) {
                Some(&p) => add_scaled(&mut sum, -w, p),
                None => own = w,
            }
        }
        let vertex = sum.map(|x| x / own);
        nodes.iter().copied().chain([vertex]).collect()
    }

    /// The limit point of a net, where c is the last node.
    pub(crate) fn limit_point<const N: usize>(&self, net: &[[f64; N]]) -> [f64; N] {
        let mut sum = net[net.len() - 1];
        let center = sum;
        for &(k, w) in &self.point {
            add_scaled(&mut sum, w, sub(net[k], center));
        }
        sum
    }

    /// The first net of the rules relative to the limit point, from the net of the fan.
    pub(crate) fn first_net<const N: usize>(&self, net: &[[f64; N]]) -> Vec<[f64; N]> {
        let center = self.limit_point(net);
        let relative: Vec<[f64; N]> = net.iter().map(|&p| sub(p, center)).collect();
        match &self.first_net {
            Some(rows) => rows.iter().map(|row| apply(row, &relative)).collect(),
            None => relative[..relative.len() - 1].to_vec(),
        }
    }

    /// The patches of the hole that do not touch the centre, sector by sector, if the rules have
    /// them.
    pub(crate) fn cells<const N: usize>(&self, net: &[[f64; N]]) -> Vec<[Vec<[f64; N]>; 3]> {
        let patch = |rows: &Vec<Row>| rows.iter().map(|row| apply(row, net)).collect();
        self.cells.iter().map(|cells| cells.each_ref().map(patch)).collect()
    }

    /// The unit normal at the limit point, NaN if there is no tangent plane; `None` if the rules
    /// know it themselves.
    pub(crate) fn normal(&self, net: &[Point]) -> Option<Vector> {
        let center = self.limit_point(net);
        let relative: Vec<Vector> = net.iter().map(|&p| sub(p, center)).collect();
        let size = relative.iter().map(|&p| norm(p)).fold(0.0, f64::max);
        let [along, across] = match &self.tangents {
            Tangents::None => return Some([f64::NAN; 3]),
            Tangents::OfRules => return None,
            Tangents::Rows(rows) => rows.each_ref().map(|row| apply(row, &relative)),
            Tangents::Tip => tip_tangents(net, size),
        };
        let (normal, longer) = (cross(along, across), norm(along).max(norm(across)));
        let is_plane = longer > FLATTEST * size && norm(normal) > FLATTEST * longer * longer;
        Some(if is_plane { unit(normal) } else { [f64::NAN; 3] })
    }
}

/// At a crease the nodes (1,0), (0,1) and (1,1) of a single face shrink by 1/2 along the crease,
/// and by 1/4 with a Jordan block across: the bend m of the crease leads, and without it the face.
fn tip_tangents(net: &[Point], size: f64) -> [Vector; 2] {
    let [first, last, face] = [0, 2, 4].map(|k| sub(net[k], net[net.len() - 1]));
    let mut bend = first;
    add_scaled(&mut bend, 1.0, last);
    [sub(first, last), if norm(bend) > FLATTEST * size { bend } else { face }]
}

fn apply<const N: usize>(row: &Row, net: &[[f64; N]]) -> [f64; N] {
    let mut sum = [0.0; N];
    row.iter().for_each(|&(k, w)| add_scaled(&mut sum, w, net[k]));
    sum
}

/// The weights of a row by node, where c is the last node.
type Weights = BTreeMap<usize, f64>;

/// The nodes of a fan.
struct Net {
    shape: Fan,
    /// The limit point as weights of the nodes, where c is the last.
    limit: Weights,
}

impl Net {
    fn new(shape: Fan) -> Self {
        let mut net = Self { shape, limit: Weights::new() };
        net.limit = net.limit_row();
        net
    }

    /// The number of nodes without c.
    fn num_nodes(&self) -> usize {
        2 * self.shape.lines() + 4 * self.shape.faces
    }

    fn center(&self) -> usize {
        self.num_nodes()
    }

    fn faces(&self) -> isize {
        self.shape.faces as isize
    }

    fn has_sharp_line(&self, line: isize) -> bool {
        if self.shape.is_closed {
            self.shape.has_dart && line.rem_euclid(self.faces()) == 0
        } else {
            line == 0 || line == self.faces()
        }
    }

    /// The number of node (a,0) of a line.
    fn on_line(&self, line: isize, a: isize) -> usize {
        2 * line.rem_euclid(self.shape.lines() as isize) as usize + a as usize - 1
    }

    /// The number of node (a,b) of a sector, a and b 1 or 2.
    fn inside(&self, s: isize, a: isize, b: isize) -> usize {
        let s = s.rem_euclid(self.faces()) as usize;
        2 * self.shape.lines() + 4 * s + 2 * (a as usize - 1) + b as usize - 1
    }

    /// The node (a,b) of sector s, a and b from -1 to 2.
    fn node(&self, s: isize, a: isize, b: isize) -> Weights {
        let old = |s: isize, a: isize, b: isize| self.node(s, a, b);
        match (a, b) {
            (0, 0) => [(self.center(), 1.0)].into(),
            (a, b) if b < 0 => self.beyond_first(s, a, &old),
            (a, b) if a < 0 => self.beyond_last(s, b, &old),
            (a, 0) => [(self.on_line(s, a), 1.0)].into(),
            (0, b) => [(self.on_line(s + 1, b), 1.0)].into(),
            (a, b) => [(self.inside(s, a, b), 1.0)].into(),
        }
    }

    /// The node (a,-1) of a net; `at` gives the other nodes.
    fn beyond_first(
        &self,
        s: isize,
        a: isize,
        at: &dyn Fn(isize, isize, isize) -> Weights,
    ) -> Weights {
        if self.has_sharp_line(s) { mirrored(&at(s, a, 0), &at(s, a, 1)) } else { at(s - 1, 1, a) }
    }

    /// The node (-1,b) of a net; `at` gives the other nodes.
    fn beyond_last(
        &self,
        s: isize,
        b: isize,
        at: &dyn Fn(isize, isize, isize) -> Weights,
    ) -> Weights {
        let is_sharp = self.has_sharp_line(s + 1);
        if is_sharp { mirrored(&at(s, 0, b), &at(s, 1, b)) } else { at(s + 1, b, 1) }
    }

    /// The node (a,b), -1 <= a,b <= 3, of the refined net.
    fn refined(&self, s: isize, a: isize, b: isize) -> Weights {
        let new = |s: isize, a: isize, b: isize| self.refined(s, a, b);
        match (a, b) {
            (0, 0) => self.refined_center(),
            (a, b) if b < 0 => self.beyond_first(s, a, &new),
            (a, b) if a < 0 => self.beyond_last(s, b, &new),
            (a, b) => self.inserted(s, a, b),
        }
    }

    fn inserted(&self, s: isize, a: isize, b: isize) -> Weights {
        let mut row = Weights::new();
        for (x, wx) in knot_insertion(a) {
            for (y, wy) in knot_insertion(b) {
                add(&mut row, wx * wy, &self.node(s, x, y));
            }
        }
        row
    }

    fn refined_center(&self) -> Weights {
        let c = self.node(0, 0, 0);
        let mut row = Weights::new();
        match self.shape.rule {
            VertexRule::Corner => row = c,
            VertexRule::Crease => {
                add(&mut row, 0.75, &c);
                for line in [0, self.faces()] {
                    add(&mut row, 0.125, &[(self.on_line(line, 1), 1.0)].into());
                }
            }
            VertexRule::Smooth => {
                let n = self.shape.faces as f64;
                add(&mut row, (n - 2.0) / n, &c);
                for s in 0..self.faces() {
                    add(&mut row, 1.0 / (n * n), &self.node(s, 1, 0));
                    for (a, b) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
                        add(&mut row, 0.25 / (n * n), &self.node(s, a, b));
                    }
                }
            }
        }
        row
    }

    /// The refined nodes in their order, without c.
    fn kept_nodes(&self) -> Vec<Weights> {
        let last = self.faces() - 1;
        let line = |line: isize| match line {
            // The last line of an open fan is the b-axis of the last sector.
            l if l > last => [(last, 0, 1), (last, 0, 2)],
            l => [(l, 1, 0), (l, 2, 0)],
        };
        let lines = (0..self.shape.lines() as isize).flat_map(line);
        let inner = (0..=last).flat_map(|s| [(s, 1, 1), (s, 1, 2), (s, 2, 1), (s, 2, 2)]);
        lines.chain(inner).map(|(s, a, b)| self.refined(s, a, b)).collect()
    }

    /// The row with the other nodes in the place of c, as the limit point is the origin.
    fn eliminate(&self, row: &Weights) -> Row {
        let mut rest = row.clone();
        if let Some(w) = rest.remove(&self.center()) {
            let own = self.limit[&self.center()];
            for (&k, &x) in self.limit.iter().filter(|&(&k, _)| k != self.center()) {
                *rest.entry(k).or_insert(0.0) -= w * x / own;
            }
        }
        rest.into_iter().filter(|&(_, w)| w != 0.0).collect()
    }

    fn limit_row(&self) -> Weights {
        let c = self.center();
        match self.shape.rule {
            VertexRule::Corner => [(c, 1.0)].into(),
            VertexRule::Crease => {
                let ends = [0, self.faces()].map(|line| (self.on_line(line, 1), 1.0 / 6.0));
                ends.into_iter().chain([(c, 2.0 / 3.0)]).collect()
            }
            VertexRule::Smooth => self.iterated_limit_row(),
        }
    }

    /// The left eigenvector of eigenvalue 1 by iteration: the rows of high powers all approach it.
    fn iterated_limit_row(&self) -> Weights {
        let mut rows = self.kept_nodes();
        rows.push(self.refined_center());
        let mut w = vec![0.0; rows.len()];
        w[self.center()] = 1.0;
        for _ in 0..POWER_STEPS {
            let mut next = vec![0.0; w.len()];
            for (row, x) in rows.iter().zip(&w) {
                row.iter().for_each(|(&k, y)| next[k] += x * y);
            }
            w = next;
        }
        let sum: f64 = w.iter().sum();
        w.into_iter().map(|x| x / sum).enumerate().filter(|&(_, x)| x > 1e-18).collect()
    }

    /// The bi-3 patch over the refined square (a,b) to (a+1,b+1) of sector s.
    fn patch(&self, s: isize, a: isize, b: isize) -> PatchRule {
        let node = |k: isize| self.refined(s, a - 1 + k / 4, b - 1 + k % 4);
        let nodes: Vec<Weights> = (0..16).map(node).collect();
        let coef = |k: usize| {
            let mut row = Weights::new();
            for (m, node) in nodes.iter().enumerate() {
                let w = CUBIC_B_SPLINE_TO_BB[k / 4][m / 4] * CUBIC_B_SPLINE_TO_BB[k % 4][m % 4];
                add(&mut row, w, node);
            }
            self.eliminate(&row)
        };
        PatchRule { old: (0..16).map(coef).collect(), new: vec![Row::new(); 16] }
    }
}

/// Enough for the slowest: at 1024 faces the second eigenvalue is .655.
const POWER_STEPS: usize = 200;

/// `row` + w `other`.
fn add(row: &mut Weights, w: f64, other: &Weights) {
    if w != 0.0 {
        other.iter().for_each(|(&k, &x)| *row.entry(k).or_insert(0.0) += w * x);
    }
}

/// 2 p - q.
fn mirrored(p: &Weights, q: &Weights) -> Weights {
    let mut row = Weights::new();
    add(&mut row, 2.0, p);
    add(&mut row, -1.0, q);
    row
}

/// Uniform cubic knot insertion: the new node `k` from old nodes.
fn knot_insertion(k: isize) -> Vec<(isize, f64)> {
    let p = k.div_euclid(2);
    if k % 2 == 0 {
        vec![(p - 1, 0.125), (p, 0.75), (p + 1, 0.125)]
    } else {
        vec![(p, 0.5), (p + 1, 0.5)]
    }
}

/// By how much a net without symmetries shrinks in one step, after many steps.
fn growth(refine: &[Row]) -> f64 {
    let mut net: Vec<f64> = (0..refine.len()).map(|k| 1.0 + (k % 7) as f64).collect();
    let mut factor = 0.5;
    for _ in 0..POWER_STEPS {
        let next: Vec<f64> =
            refine.iter().map(|row| row.iter().map(|&(k, w)| w * net[k]).sum()).collect();
        let size = |net: &[f64]| net.iter().map(|x: &f64| x.abs()).fold(0.0, f64::max);
        factor = size(&next) / size(&net);
        let scale = size(&next);
        net = next.into_iter().map(|x| x / scale).collect();
    }
    factor
}

fn tangents(net: &Net, refine: &[Row]) -> Tangents {
    let Fan { faces, is_closed, rule, .. } = net.shape;
    match rule {
        VertexRule::Crease if faces == 1 => Tangents::Tip,
        VertexRule::Crease if faces < 4 => Tangents::Rows(crease_tangents(net)),
        VertexRule::Smooth if is_closed && faces > 2 => Tangents::Rows(dart_tangents(net, refine)),
        _ => Tangents::None,
    }
}

/// Along the crease, and the left eigenvector of the fan's first mode across it.
///
/// With theta = pi/f that mode is sin(k theta) on the lines. It has the eigenvalue of a smooth
/// vertex with 2 pi / n = theta. The eigenvector on the faces, the crease and c follows.
fn crease_tangents(net: &Net) -> [Row; 2] {
    let f = net.shape.faces;
    let theta = PI / f as f64;
    let c = cosine(theta);
    let lambda = (c + 5.0 + ((c + 1.0) * (c + 9.0)).sqrt()) / 16.0;
    let line = |k: usize| if k == 0 || k == f { 0.0 } else { sine(k as f64 * theta) };
    let face = |s: usize| (line(s) + line(s + 1)) / (16.0 * lambda - 4.0);
    let mut across: Row = Row::new();
    let (mut lines, mut faces) = (0.0, 0.0);
    for k in 1..f {
        across.push((net.on_line(k as isize, 1), line(k)));
        lines += line(k);
    }
    for s in 0..f {
        across.push((net.inside(s as isize, 1, 1), face(s)));
        faces += face(s);
    }
    // (lambda - 1/2) e - g/8 = p on the crease, (lambda - 3/4) g - e = q at c.
    let (p, q) = (line(1) / 16.0 + face(0) / 4.0, 0.375 * lines + 0.25 * faces);
    let g = (q * (lambda - 0.5) + p) / ((lambda - 1.0) * (lambda - 0.25));
    let e = (lambda - 0.75) * g - q;
    let ends = [0, f as isize].map(|line| net.on_line(line, 1));
    across.extend(ends.map(|at| (at, e)));
    across.push((net.center(), g));
    [vec![(ends[0], 1.0), (ends[1], -1.0)], across]
}

/// The left eigenvectors of the largest eigenvalues, symmetric and antisymmetric in the dart's
/// line, by iteration.
fn dart_tangents(net: &Net, refine: &[Row]) -> [Row; 2] {
    let mirror = mirror_images(net);
    let mut rows = [1.0, -1.0].map(|sign| {
        let mut w: Vec<f64> = (0..refine.len()).map(|k| 1.0 / (1.0 + k as f64)).collect();
        for _ in 0..4 * POWER_STEPS {
            let mut next = vec![0.0; w.len()];
            for (row, x) in refine.iter().zip(&w) {
                row.iter().for_each(|&(k, y)| next[k] += x * y);
            }
            let folded = |k: usize| next[k] + sign * next[mirror[k]];
            let size = (0..w.len()).map(|k| folded(k).abs()).fold(0.0, f64::max);
            w = (0..w.len()).map(|k| folded(k) / size).collect();
        }
        w.into_iter().enumerate().collect::<Row>()
    });
    // The sign is such that a flat fan, which turns counter-clockwise, has its normal above.
    let flat = flat_net(net);
    let [a, b] = rows.each_ref().map(|row| apply(row, &flat));
    if dot(cross(a, b), [0.0, 0.0, 1.0]) < 0.0 {
        rows.swap(0, 1);
    }
    rows
}

/// The node at the mirror image of every node in line 0.
fn mirror_images(net: &Net) -> Vec<usize> {
    let f = net.faces();
    let lines = (0..f).flat_map(|k| [1, 2].map(|a| net.on_line(-k, a)));
    let inner = (0..f)
        .flat_map(|s| [(1, 1), (2, 1), (1, 2), (2, 2)].map(|(a, b)| net.inside(-1 - s, a, b)));
    lines.chain(inner).collect()
}

/// A regular closed fan in the plane z = 0, without c, which is the origin.
fn flat_net(net: &Net) -> Vec<Vector> {
    let angle = TAU / net.shape.faces as f64;
    let along = |line: isize| [cosine(line as f64 * angle), sine(line as f64 * angle), 0.0];
    let at = |s: isize, a: f64, b: f64| {
        let mut p = [0.0; 3];
        add_scaled(&mut p, a, along(s));
        add_scaled(&mut p, b, along(s + 1));
        p
    };
    let lines = (0..net.faces()).flat_map(|k| [at(k, 1.0, 0.0), at(k, 2.0, 0.0)]);
    let inner = (0..net.faces())
        .flat_map(|s| [(1.0, 1.0), (1.0, 2.0), (2.0, 1.0), (2.0, 2.0)].map(|(a, b)| at(s, a, b)));
    lines.chain(inner).collect()
}
