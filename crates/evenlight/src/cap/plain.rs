//! Plain caps: one patch per sector, at all points that have no other caps. These are fans between
//! sharp edges, darts, sharp vertices, and points of valence 2, 4 and above [`MAX_VALENCE`].
//!
//! ```text
//!   line s+1
//!   1 + - - + - - +      rings of Catmull-Clark go on C2 in the parameters, so the hole has one
//!     | . . . r r |      cubic along each of its outer edges: r, two rows of coefficients, are
//!     + t x x r r |      those of position and first derivative there
//!     | t x x . . |      c  the limit point
//!     | c t t . . |      t  the tangents T of the lines, and what follows on the cubics of lines
//!     +-----------+ 1    x  inside
//!      line s
//! ```
//!
//! *Lines.* A crease or boundary is a cubic up to the vertex, so it stays exactly what it is, and
//! the surfaces on both sides of it go on sharing it. Other lines are cubics too, with the tangents
//!
//! ```text
//!   T_s = cos(s theta) X + sin(s theta) Y,     theta = pi/f between two creases, 2 pi/f at a dart,
//! ```
//!
//! where X and Y are the directions of the limit tangent plane. Their lengths are such that the
//! lines of the eigenvectors are parabolas. Without a tangent plane every line is a parabola.
//!
//! *Inside.* The bi-3 patch with the least third differences is raised to bi-4 and moved as little
//! as possible, so that for sectors a ahead and b behind a line
//!
//! ```text
//!   a_v + b_v = (1-u)^2 W(u),     W = 2 cos(theta) a_u [KP18-Guided, eq. 6],
//! ```
//!
//! hence with one tangent plane. This condition gives, for each coefficient of a line, the sum of
//! the two coefficients beside it. The sums of the twists t_s beside the centre form a chain
//! t_0 + t_1, t_1 + t_2, ... from the first to the last line. Bi-3 patches take the value of W at
//! the centre, W = 2 cos(theta) T_s, and come close. Without a tangent plane W = T_(s-1) + T_(s+1),
//! and each twist takes half of what its sums lack, as the solution of a chain would alternate.

use std::f64::consts::{PI, TAU};

use super::border::Border;
use super::spline::{Space, raising};
use super::{CapKind, MAX_VALENCE, domains};
use crate::angle::{cosine, sine};
use crate::pairs::pairs;
use crate::patch::Patch;
use crate::point::{add, add_scaled, scale, sub};
use crate::rings::{Rings, ValenceRules};
use crate::scheme::{FanLimit, Row, Rules};

/// Whether these rules have plain caps. All such rules are Catmull-Clark's.
pub(super) fn is_plain(rules: &ValenceRules) -> bool {
    let n = rules.rules().valence;
    rules.fan_limit().is_some() || n == 2 || n == 4 || n > MAX_VALENCE
}

/// The rules of plain caps of one shape.
#[derive(Clone, Debug)]
pub(crate) struct PlainCap {
    degree: usize,
    lines: FanLines,
    border: Border,
    /// Whether there is a tangent plane. In it the lines leave the centre at equal angles.
    has_plane: bool,
    /// The directions from which the tangents of lines follow, if they are not given.
    directions: Option<Directions>,
}

/// The lines of a fan of sectors: line s is the first of sector s.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FanLines {
    sectors: usize,
    /// Whether the last sector ends at line 0; else there is one more line.
    is_closed: bool,
    /// Whether line 0 is sharp though the fan is closed.
    has_dart: bool,
}

/// The directions of the limit tangent plane, as rows on a net with its vertex, and how much of
/// cos(s theta) and sin(s theta) is in each. The first is along the crease if there is one.
type Directions = [(Row, [f64; 2]); 2];

/// The bi-3 patch of a sector, the coefficients along line s+1 fastest.
pub(super) type Bicubic<const N: usize> = [[f64; N]; 16];

impl PlainCap {
    /// Bi-3 if that is asked for, else bi-4.
    pub(super) fn new(rules: &ValenceRules, kind: CapKind) -> Self {
        let mut cap = Self::inside(rules, kind);
        cap.directions = rules.fan_limit().and_then(|limit| {
            Some(limit.tangent_rows()?.each_ref().map(|row| {
                let rules = rules.rules();
                let ends = line_ends_of_eigenvector(row, rules, limit, &cap.border, cap.lines);
                (row.clone(), cap.lines.waves(&ends))
            }))
        });
        cap.has_plane = cap.directions.is_some();
        cap
    }

    /// The rules inside fair rings beside a crease, which have a tangent plane and find the
    /// tangents themselves.
    pub(super) fn inside(rules: &ValenceRules, kind: CapKind) -> Self {
        let border = Border::new(3, &domains(rules.rules()), Space::polynomials(3));
        let degree = if kind == CapKind::Bi3 { 3 } else { 4 };
        Self { degree, lines: FanLines::of(rules), border, has_plane: true, directions: None }
    }

    pub(super) fn space(&self) -> Space {
        Space::polynomials(self.degree)
    }

    /// The patches of all sectors for the hole behind `count` rings, in the frame of the rings.
    pub(super) fn patches<const N: usize>(&self, rings: &Rings<N>, count: usize) -> Vec<Patch<N>> {
        let ring: Vec<Vec<[f64; N]>> =
            rings.frame_patches(count).iter().map(|patch| patch.coefs().to_vec()).collect();
        let outside: Vec<Vec<[f64; N]>> = ring
            .chunks(rings.patches_per_sector())
            .map(|patches| self.border.data(patches))
            .collect();
        let tangents = self.tangents_of_lines(rings, count, &outside);
        self.patches_within(&outside, &tangents)
    }

    /// The patches with these data on the outer edges and with these tangents of the lines.
    pub(super) fn patches_within<const N: usize>(
        &self,
        outside: &[Vec<[f64; N]>],
        tangents: &[[f64; N]],
    ) -> Vec<Patch<N>> {
        let cubics: Vec<Bicubic<N>> = (0..self.lines.sectors)
            .map(|s| bicubic(&outside[s], [tangents[s], tangents[self.lines.next(s)]]))
            .collect();
        let mut nets: Vec<Vec<[f64; N]>> = cubics.iter().map(|net| self.raised(net)).collect();
        self.join(&mut nets, &cubics, tangents);
        nets.into_iter().map(|net| Patch::of([self.degree; 2], net)).collect()
    }

    /// T of every line.
    fn tangents_of_lines<const N: usize>(
        &self,
        rings: &Rings<N>,
        count: usize,
        outside: &[Vec<[f64; N]>],
    ) -> Vec<[f64; N]> {
        let lines = self.lines;
        let ends = (0..lines.count()).map(|line| LineEnd::of(outside, lines, line));
        let mut found: Vec<[f64; N]> =
            ends.enumerate().map(|(line, end)| end.tangent(lines.is_crease(line))).collect();
        let limit = rings.rules().fan_limit();
        if let Some((directions, limit)) = self.directions.as_ref().zip(limit) {
            let net = limit.with_vertex(&rings.net(count));
            let along_crease = found[0];
            for line in (0..lines.count()).filter(|&line| !lines.is_crease(line)) {
                let crease = (!lines.is_closed).then_some(along_crease);
                found[line] = lines.tangent(line, directions, &net, crease);
            }
        }
        found
    }

    /// The coefficients of a sector in the cap's degree.
    pub(super) fn raised<const N: usize>(&self, cubic: &Bicubic<N>) -> Vec<[f64; N]> {
        let (raise, order) = (raising(3, self.degree), self.degree + 1);
        let coef = |k: usize| {
            let mut sum = [0.0; N];
            for (m, &p) in cubic.iter().enumerate() {
                add_scaled(&mut sum, raise[(k / order, m / 4)] * raise[(k % order, m % 4)], p);
            }
            sum
        };
        (0..order * order).map(coef).collect()
    }

    /// Moves the coefficients beside all smooth lines to the sums that they must have.
    fn join<const N: usize>(
        &self,
        nets: &mut [Vec<[f64; N]>],
        cubics: &[Bicubic<N>],
        tangents: &[[f64; N]],
    ) {
        let order = self.degree + 1;
        let mut twists = Vec::new();
        for line in self.lines.smooth() {
            let behind = self.lines.behind(line);
            let sums = self.sums(line, &cubics[line], tangents);
            for (i, sum) in (1..self.degree - 1).zip(sums) {
                let mut missing = scale(1.0 / self.degree as f64, sum);
                add_scaled(&mut missing, 2.0, nets[line][order * i]);
                let present = add(nets[line][order * i + 1], nets[behind][order + i]);
                missing = sub(missing, present);
                if i == 1 {
                    twists.push((line, missing));
                } else {
                    add_scaled(&mut nets[line][order * i + 1], 0.5, missing);
                    add_scaled(&mut nets[behind][order + i], 0.5, missing);
                }
            }
        }
        let by =
            if self.has_plane { self.lines.chain(&twists) } else { self.lines.half_way(&twists) };
        nets.iter_mut().zip(by).for_each(|(net, by)| add_scaled(&mut net[order + 1], 1.0, by));
    }

    /// The BB coefficients 1 and 2 of (1-u)^2 W(u) on a line, those of degree 3 or 4.
    fn sums<const N: usize>(
        &self,
        line: usize,
        cubic: &Bicubic<N>,
        tangents: &[[f64; N]],
    ) -> [[f64; N]; 2] {
        if self.has_plane && self.degree == 4 {
            let slope = |k: usize| scale(3.0, sub(cubic[4 * k + 4], cubic[4 * k]));
            let c = cosine(self.lines.angle());
            return [scale(c, slope(1)), scale(c / 3.0, slope(2))];
        }
        let around = [self.lines.behind(line), self.lines.next(line)];
        let [before, after] = around.map(|line| tangents[line]);
        let w = add(before, after);
        if self.degree == 3 {
            [scale(1.0 / 3.0, w), [0.0; N]]
        } else {
            [scale(1.0 / 2.0, w), scale(1.0 / 6.0, w)]
        }
    }
}

impl FanLines {
    pub(crate) fn of(rules: &ValenceRules) -> Self {
        let sectors = rules.rules().valence;
        let shape = rules.fan_limit().map(FanLimit::shape);
        Self {
            sectors,
            is_closed: shape.is_none_or(|shape| shape.is_closed),
            has_dart: shape.is_some_and(|shape| shape.has_dart),
        }
    }

    pub(super) fn count(self) -> usize {
        self.sectors + usize::from(!self.is_closed)
    }

    /// Whether a line bounds an open fan.
    pub(super) fn is_crease(self, line: usize) -> bool {
        !self.is_closed && (line == 0 || line == self.sectors)
    }

    /// The lines between two sectors across which the surface is smooth.
    pub(crate) fn smooth(self) -> std::ops::Range<usize> {
        usize::from(!self.is_closed || self.has_dart)..self.sectors
    }

    /// Line 0 if it is sharp between two sectors.
    pub(crate) fn dart(self) -> Option<usize> {
        self.has_dart.then_some(0)
    }

    /// The sector behind a line, and the line before it.
    pub(crate) fn behind(self, line: usize) -> usize {
        (line + self.sectors - 1) % self.sectors
    }

    /// The line after a line, the other one of its sector.
    fn next(self, line: usize) -> usize {
        (line + 1) % self.count()
    }

    /// The angle between neighbouring lines where there is a tangent plane.
    pub(super) fn angle(self) -> f64 {
        (if self.is_closed { TAU } else { PI }) / self.sectors as f64
    }

    /// T of a line for a net with its vertex, the first direction being `crease` if that is known.
    fn tangent<const N: usize>(
        self,
        line: usize,
        directions: &Directions,
        net: &[[f64; N]],
        crease: Option<[f64; N]>,
    ) -> [f64; N] {
        let angle = line as f64 * self.angle();
        let (c, s) = (cosine(angle), sine(angle));
        let [along, across] = directions.each_ref().map(|(row, [in_cos, in_sin])| {
            let mut sum = [0.0; N];
            let weight = in_cos * c + in_sin * s;
            row.iter().for_each(|&(k, w)| add_scaled(&mut sum, weight * w, net[k]));
            sum
        });
        add(crease.map_or(along, |crease| scale(c, crease)), across)
    }

    /// How much of cos(s theta) and of sin(s theta) is in values on the smooth lines; values that
    /// are mirrored or change sign in the middle line of all have one of them only.
    pub(super) fn waves(self, values: &[f64]) -> [f64; 2] {
        [cosine, sine].map(|wave| {
            let at = |line: usize| wave(line as f64 * self.angle());
            let size: f64 = self.smooth().map(|line| at(line) * at(line)).sum();
            let sum: f64 = self.smooth().map(|line| at(line) * values[line]).sum();
            if size == 0.0 { 0.0 } else { sum / size }
        })
    }

    /// The shortest moves t of the sectors with t_(s-1) + t_s = what is missing on line s.
    fn chain<const N: usize>(self, missing: &[(usize, [f64; N])]) -> Vec<[f64; N]> {
        let sign = |s: usize| if s.is_multiple_of(2) { 1.0 } else { -1.0 };
        let mut moves = vec![[0.0; N]; self.sectors];
        missing.iter().for_each(|&(line, sum)| moves[line] = sub(sum, moves[line - 1]));
        let mut alternating = [0.0; N];
        let share = -1.0 / self.sectors as f64;
        moves
            .iter()
            .enumerate()
            .for_each(|(s, &t)| add_scaled(&mut alternating, share * sign(s), t));
        moves.iter_mut().enumerate().for_each(|(s, t)| add_scaled(t, sign(s), alternating));
        moves
    }

    /// For every sector the mean of the halves that are missing on its smooth lines.
    fn half_way<const N: usize>(self, missing: &[(usize, [f64; N])]) -> Vec<[f64; N]> {
        let mut moves = vec![([0.0; N], 0.0); self.sectors];
        for &(line, sum) in missing {
            for s in [line, self.behind(line)] {
                add_scaled(&mut moves[s].0, 0.5, sum);
                moves[s].1 += 1.0;
            }
        }
        moves.into_iter().map(|(sum, count)| scale(1.0 / f64::max(count, 1.0), sum)).collect()
    }
}

/// The surface at the outer end of a line of the hole: position and derivatives along the line.
pub(super) struct LineEnd<const N: usize>([[f64; N]; 3]);

impl<const N: usize> LineEnd<N> {
    pub(super) fn of(outside: &[Vec<[f64; N]>], lines: FanLines, line: usize) -> Self {
        // The last line of an open fan is the b-axis of the last sector.
        let (sector, edge) = if line == lines.sectors { (line - 1, 1) } else { (line, 0) };
        Self([0, 1, 2].map(|layer| outside[sector][at(edge, layer, 0)]))
    }

    /// The derivative at the centre, which is the origin, of the curve that continues the line: a
    /// cubic with second derivatives, or a parabola with first ones.
    pub(super) fn tangent(&self, is_cubic: bool) -> [f64; N] {
        let weights = if is_cubic { [3.0, -2.0, 0.5] } else { [2.0, -1.0, 0.0] };
        let mut sum = [0.0; N];
        weights.into_iter().zip(self.0).for_each(|(w, p)| add_scaled(&mut sum, w, p));
        sum
    }
}

/// The place of BB coefficient k of the derivative of order `layer` along edge 0 (a = 1) or 1
/// (b = 1) among the [data](Border::data) of a sector.
fn at(edge: usize, layer: usize, k: usize) -> usize {
    12 * edge + 4 * layer + k
}

/// The bi-3 patch with the given outer edges and tangents at the origin and, as far as it can in
/// the square mean, without third differences through its first inner coefficient.
fn bicubic<const N: usize>(outside: &[[f64; N]], [first, last]: [[f64; N]; 2]) -> Bicubic<N> {
    let edge = |edge: usize, from_end: usize, k: usize| {
        let mut p = outside[at(edge, 0, k)];
        add_scaled(&mut p, -(from_end as f64) / 3.0, outside[at(edge, 1, k)]);
        p
    };
    let mut net = [[0.0; N]; 16];
    for (i, j) in pairs(4, 4) {
        net[4 * i + j] = match (i >= 2, j >= 2) {
            (true, true) => scale(0.5, add(edge(0, 3 - i, j), edge(1, 3 - j, i))),
            (true, false) => edge(0, 3 - i, j),
            (false, true) => edge(1, 3 - j, i),
            (false, false) => [0.0; N],
        };
    }
    (net[4], net[1]) = (scale(1.0 / 3.0, first), scale(1.0 / 3.0, last));
    let mut inner = [0.0; N];
    for (k, w) in [(9, 3.0), (13, -1.0), (1, 1.0), (6, 3.0), (7, -1.0), (4, 1.0)] {
        add_scaled(&mut inner, w / 6.0, net[k]);
    }
    net[5] = inner;
    net
}

/// Steps of a power iteration. They give eigenvectors to half their digits at least, which is
/// enough for a length.
const POWER_STEPS: usize = 60;

/// The tangents of all lines as parabolas, for the right eigenvector on which a left one is 1.
fn line_ends_of_eigenvector(
    row: &Row,
    rules: &Rules,
    limit: &FanLimit,
    border: &Border,
    lines: FanLines,
) -> Vec<f64> {
    // The left eigenvector is a net with the same symmetry; a part of it is the right eigenvector.
    let mut net = vec![[0.0]; rules.num_nodes()];
    for &(k, w) in row {
        // The vertex is the last node of the row, but no node of the net.
        if let Some(p) = net.get_mut(k) {
            p[0] = w;
        }
    }
    for _ in 0..POWER_STEPS {
        net = rules.refine(&net);
        let size = net.iter().fold(0.0, |size: f64, p| size.max(p[0].abs()));
        net.iter_mut().for_each(|p| p[0] /= size);
    }
    let with_vertex = limit.with_vertex(&net);
    let value: f64 = row.iter().map(|&(k, w)| w * with_vertex[k][0]).sum();
    let refined = rules.refine(&net);
    let outside: Vec<Vec<[f64; 1]>> = (0..lines.sectors)
        .map(|s| {
            let patch = |which| rules.patch(s, which, &net, &refined);
            border.data(&(0..rules.patches_per_sector()).map(patch).collect::<Vec<_>>())
        })
        .collect();
    let end = |line: usize| LineEnd::of(&outside, lines, line).tangent(false)[0] / value;
    (0..lines.count()).map(end).collect()
}
