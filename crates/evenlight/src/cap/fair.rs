//! Caps behind fair rings beside a crease: 2 x 2 patches per sector.
//!
//! ```text
//!   line s+1
//!   1 +-----+-----+      Between 1/2 and 1 (x) the net behind the last ring is a bi-3 spline, with
//!     |  x  |  x  |      the node of the crease in the place of the centre. There the surface
//!     +-----+-----+      is C2 like the rings. What is left is a hole with one cubic along each
//!     |  o  |  x  |      outer edge, as behind Catmull-Clark's rings, and o, a plain cap.
//!     +-----+-----+ 1
//!      line s
//! ```

use super::CapKind;
use super::plain::{FanLines, LineEnd, PlainCap};
use super::spline::Space;
use crate::angle::{cosine, sine};
use crate::patch::Patch;
use crate::point::{Vector, add_scaled, scale, sub};
use crate::rings::{Rings, ValenceRules};
use crate::scheme::FanLimit;

/// The rules of the caps behind the fair rings of one number of faces.
#[derive(Clone, Debug)]
pub(crate) struct FairCap {
    lines: FanLines,
    inside: PlainCap,
    /// The length of the tangents of lines across the crease; the length of y is 1.
    across: f64,
}

/// The patches of a sector that do not touch the centre, as in [`FanLimit::cells`].
type Cells<const N: usize> = [Vec<[f64; N]>; 3];

impl FairCap {
    /// Bi-3 if that is asked for, else bi-4.
    pub(super) fn new(rules: &ValenceRules, limit: &FanLimit, kind: CapKind) -> Self {
        let lines = FanLines::of(rules);
        let cells = limit.cells(&rules.subdominant().characteristic_net());
        let outside: Vec<Vec<Vector>> = cells.iter().map(outside).collect();
        let end = |line: usize| LineEnd::of(&outside, lines, line).tangent(false)[1];
        let [_, across] = lines.waves(&(0..lines.count()).map(end).collect::<Vec<_>>());
        Self { lines, inside: PlainCap::inside(rules, kind), across }
    }

    pub(super) fn space(&self) -> Space {
        Space { pieces: 2, ..self.inside.space() }
    }

    /// The patches of all sectors for the hole behind `count` rings, in the frame of the rings.
    pub(super) fn patches<const N: usize>(
        &self,
        rings: &Rings<N>,
        limit: &FanLimit,
        count: usize,
    ) -> Vec<Patch<N>> {
        let net = rings.net(count);
        let cells = limit.cells(&net);
        let outside: Vec<Vec<[f64; N]>> = cells.iter().map(outside).collect();
        let tangents = self.tangents_of_lines(rings, &net, &outside);
        let inner = self.inside.patches_within(&outside, &tangents);
        let degree = self.inside.space().degree;
        let raised = |coefs: &Vec<[f64; N]>| {
            let cubic = std::array::from_fn(|k| coefs[k]);
            Patch::of([degree; 2], self.inside.raised(&cubic))
        };
        let sectors = inner.into_iter().zip(&cells);
        sectors
            .flat_map(|(inner, cells)| std::iter::once(inner).chain(cells.iter().map(raised)))
            .collect()
    }

    /// Creases have the tangent of their cubic; other lines have cos(s theta) times this tangent
    /// and sin(s theta) across.
    fn tangents_of_lines<const N: usize>(
        &self,
        rings: &Rings<N>,
        net: &[[f64; N]],
        outside: &[Vec<[f64; N]>],
    ) -> Vec<[f64; N]> {
        let lines = self.lines;
        let [_, y] = rings.rules().subdominant().tangential(net);
        let crease = |line: usize| LineEnd::of(outside, lines, line).tangent(true);
        let along = crease(0);
        let tangent = |line: usize| {
            if lines.is_crease(line) {
                return crease(line);
            }
            let angle = line as f64 * lines.angle();
            let mut sum = scale(cosine(angle), along);
            add_scaled(&mut sum, sine(angle) * self.across, y);
            sum
        };
        (0..lines.count()).map(tangent).collect()
    }
}

/// Position and first and second derivative on the outer edges of the inner hole, as [`Border`] has
/// them: a = 1/2, then b = 1/2.
///
/// [`Border`]: super::border::Border
fn outside<const N: usize>([above, right, _]: &Cells<N>) -> Vec<[f64; N]> {
    let layers = |row: &dyn Fn(usize, usize) -> [f64; N]| -> Vec<[f64; N]> {
        let edge = |layer: usize| {
            (0..4).map(move |k| {
                let (p, q, r) = (row(0, k), row(1, k), row(2, k));
                match layer {
                    0 => p,
                    1 => scale(3.0, sub(q, p)),
                    _ => scale(6.0, sub(sub(r, q), sub(q, p))),
                }
            })
        };
        (0..3).flat_map(edge).collect()
    };
    let mut data = layers(&|i, k| right[4 * i + k]);
    data.extend(layers(&|i, k| above[4 * k + i]));
    data
}
