//! The border of a hole: the data that the patches just outside have along it.
//!
//! The data come from the ring that would be next: it joins what is outside with second
//! derivatives, and it is in the coordinates of the hole. So a hole in front of the first ring is
//! no special case.

use super::sector::LAYERS;
use super::spline::Space;
use crate::dense::Matrix;
use crate::point::add_scaled;

/// How border data follow from the patches of a sector of a ring.
#[derive(Clone, Debug)]
pub(super) struct Border {
    degree: usize,
    /// For the edges a = 1 and b = 1 the patches along it and their width across.
    edges: [Vec<(usize, f64)>; 2],
    /// The spline coefficients along an edge from the BB coefficients of its patches.
    along: [Matrix; 2],
}

impl Border {
    /// The rules for patches of bi-`degree` that cover the parts `domains` of a sector.
    pub(super) fn new(degree: usize, domains: &[[[f64; 2]; 2]], space: Space) -> Self {
        const NEAR: f64 = 1e-9;
        let edge = |across: usize| {
            let mut at: Vec<usize> =
                (0..domains.len()).filter(|&k| domains[k][across][1] > 1.0 - NEAR).collect();
            at.sort_by(|&j, &k| domains[j][1 - across][0].total_cmp(&domains[k][1 - across][0]));
            at
        };
        let edges = [edge(0), edge(1)];
        let along = [0, 1].map(|across| {
            let ends = edges[across].iter().map(|&k| domains[k][1 - across][1]);
            let knots: Vec<f64> = [0.0].into_iter().chain(ends).collect();
            space.through_pieces(&knots, degree)
        });
        let with_width = |across: usize| {
            let width = |&k: &usize| (k, domains[k][across][1] - domains[k][across][0]);
            edges[across].iter().map(width).collect()
        };
        Self { degree, edges: [with_width(0), with_width(1)], along }
    }

    /// The data of a sector from its patches' coefficients: edge a = 1, then b = 1, layer by layer.
    pub(super) fn data<const N: usize>(&self, patches: &[Vec<[f64; N]>]) -> Vec<[f64; N]> {
        let (d, order) = (self.degree, self.degree + 1);
        let mut data = Vec::new();
        for (across, along) in self.along.iter().enumerate() {
            for layer in 0..LAYERS {
                let mut bb = Vec::new();
                for (&(which, width), k) in
                    self.edges[across].iter().flat_map(|p| (0..order).map(move |k| (p, k)))
                {
                    let from_outside = |r: usize| {
                        let at = if across == 0 { (d - r) * order + k } else { k * order + d - r };
                        patches[which][at]
                    };
                    bb.push(derivative(d, width, layer, from_outside));
                }
                data.extend((0..along.num_rows()).map(|i| {
                    let mut sum = [0.0; N];
                    along.row(i).iter().zip(&bb).for_each(|(&w, &p)| add_scaled(&mut sum, w, p));
                    sum
                }));
            }
        }
        data
    }
}

/// The derivative of order 0, 1 or 2 at the end of BB coefficients counted from that end.
fn derivative<const N: usize>(
    d: usize,
    width: f64,
    order: usize,
    coef: impl Fn(usize) -> [f64; N],
) -> [f64; N] {
    let (d1, d2) = (d as f64 / width, (d * (d - 1)) as f64 / (width * width));
    let terms: &[f64] = match order {
        0 => &[1.0],
        1 => &[d1, -d1],
        _ => &[d2, -2.0 * d2, d2],
    };
    let mut sum = [0.0; N];
    terms.iter().enumerate().for_each(|(r, &w)| add_scaled(&mut sum, w, coef(r)));
    sum
}
