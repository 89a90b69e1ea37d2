//! The polynomials of edges: one set of coefficients for all patches that meet there.

use super::{EdgeUse, PatchComplex, PatchEdgeId, PatchId};
use crate::patch::{MAX_DEGREE, Patch};
use crate::point::{add_scaled, scale};
use crate::surface::Surface;

/// A polynomial curve in Bernstein-Bezier form, its parameter running from 0 to 1.
#[derive(Clone, Debug, PartialEq)]
pub struct Border<const N: usize = 3> {
    coefs: Vec<[f64; N]>,
}

impl<const N: usize> Border<N> {
    /// The degree.
    pub fn degree(&self) -> usize {
        self.coefs.len() - 1
    }

    /// The BB coefficients, the first at the start.
    pub fn coefs(&self) -> &[[f64; N]] {
        &self.coefs
    }

    /// The point at `t`, by de Casteljau's algorithm.
    pub fn point(&self, t: f64) -> [f64; N] {
        let mut coefs = self.coefs.clone();
        for len in (1..coefs.len()).rev() {
            for k in 0..len {
                coefs[k] = mix(coefs[k], coefs[k + 1], t);
            }
        }
        coefs[0]
    }

    /// The same curve in Bernstein-Bezier form of a higher degree; of its own if `degree` is lower.
    /// `None` if `degree` is above [`MAX_DEGREE`].
    pub fn raised(&self, degree: usize) -> Option<Self> {
        if degree > MAX_DEGREE {
            return None;
        }
        let mut coefs = self.coefs.clone();
        while coefs.len() <= degree {
            let n = coefs.len();
            let inner = (1..n).map(|k| mix(coefs[k], coefs[k - 1], k as f64 / n as f64));
            let raised = [coefs[0]].into_iter().chain(inner).chain([coefs[n - 1]]).collect();
            coefs = raised;
        }
        Some(Self { coefs })
    }

    /// The border of a patch along a side, counter-clockwise.
    fn of_side(patch: &Patch<N>, side: u8) -> Self {
        let [du, dv] = patch.degree();
        let coefs = match side {
            0 => (0..=du).map(|i| patch.at(i, 0)).collect(),
            1 => (0..=dv).map(|j| patch.at(du, j)).collect(),
            2 => (0..=du).rev().map(|i| patch.at(i, dv)).collect(),
            _ => (0..=dv).rev().map(|j| patch.at(0, j)).collect(),
        };
        Self { coefs }
    }

    /// The part over an interval, with a parameter of its own.
    fn part(mut self, [from, to]: [f64; 2]) -> Self {
        if from > 0.0 {
            self.cut(from, true);
        }
        if to < 1.0 {
            self.cut((to - from) / (1.0 - from), false);
        }
        self
    }

    /// Keeps what is behind `t`, or before it.
    fn cut(&mut self, t: f64, keep_end: bool) {
        let n = self.coefs.len();
        for step in 1..n {
            if keep_end {
                for k in 0..n - step {
                    self.coefs[k] = mix(self.coefs[k], self.coefs[k + 1], t);
                }
            } else {
                for k in (step..n).rev() {
                    self.coefs[k] = mix(self.coefs[k - 1], self.coefs[k], t);
                }
            }
        }
    }
}

fn mix<const N: usize>(a: [f64; N], b: [f64; N], t: f64) -> [f64; N] {
    let mut p = scale(1.0 - t, a);
    add_scaled(&mut p, t, b);
    p
}

impl PatchComplex {
    /// The curve of an edge, from its first to its second vertex: the border of its first use,
    /// which stands for all. `None` if there is no such edge, or if the surface has another layout
    /// or no such caps.
    pub fn border<const N: usize>(
        &self,
        surface: &Surface<N>,
        edge: PatchEdgeId,
    ) -> Option<Border<N>> {
        self.border_of_use(surface, edge, 0)
    }

    /// The curve of an edge from its use number `which`, for whoever wants to see that all uses
    /// have one: in exact arithmetic they are the same polynomial, up to its degree.
    pub fn border_of_use<const N: usize>(
        &self,
        surface: &Surface<N>,
        edge: PatchEdgeId,
        which: usize,
    ) -> Option<Border<N>> {
        let EdgeUse { patch, side, interval, is_forward } = *self.edge(edge)?.uses().get(which)?;
        let patch = self.patch(surface, patch)?;
        let mut border = Border::of_side(&patch, side).part(interval);
        if !is_forward {
            border.coefs.reverse();
        }
        Some(border)
    }

    /// The polynomial of a patch, by its own parameters; `None` as of [`PatchComplex::border`].
    pub fn patch<const N: usize>(&self, surface: &Surface<N>, patch: PatchId) -> Option<Patch<N>> {
        let is_same = surface.layout().fingerprint() == self.layout.fingerprint();
        surface.patch(self.place(patch)?).filter(|_| is_same)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::point::Point;

    fn cubic() -> Border {
        let coefs = vec![[0.0, 1.0, 0.5], [1.0, -1.0, 2.0], [2.0, 0.5, 0.0], [1.5, 0.0, 1.0]];
        Border { coefs }
    }

    fn assert_near(p: Point, q: Point) {
        assert!((0..3).all(|k| (p[k] - q[k]).abs() < 1e-15), "{p:?} {q:?}");
    }

    #[test]
    fn a_part_is_the_curve_over_its_interval() {
        for interval in [[0.0, 1.0], [0.25, 1.0], [0.0, 0.375], [0.25, 0.5]] {
            let part = cubic().part(interval);
            for t in [0.0, 0.3, 1.0] {
                let at = interval[0] + t * (interval[1] - interval[0]);
                assert_near(part.point(t), cubic().point(at));
            }
        }
    }

    #[test]
    fn a_raised_curve_is_the_same() {
        let raised = cubic().raised(6).expect("the degree is low enough");
        assert_eq!(raised.degree(), 6);
        for t in [0.0, 0.2, 0.7, 1.0] {
            assert_near(raised.point(t), cubic().point(t));
        }
        assert_eq!(cubic().raised(2), Some(cubic()));
        assert_eq!(cubic().raised(usize::MAX), None);
    }

    #[test]
    fn sides_run_counter_clockwise() {
        let coefs = [[0., 0., 0.], [0., 1., 0.], [1., 0., 0.], [1., 1., 0.]];
        let square = Patch::of([1, 1], coefs.to_vec());
        let corners = [[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.]];
        for side in 0..4 {
            let border = Border::of_side(&square, side as u8);
            assert_eq!(border.coefs(), [corners[side], corners[(side + 1) % 4]]);
        }
    }
}
