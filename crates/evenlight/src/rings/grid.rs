//! Rings on grids of parameters: what the places on one line share is computed once.
//!
//! A sector is cut like its rings. Lines of constant a either belong to the current ring or go on
//! inwards; so do lines of constant b:
//!
//! ```text
//!  b ^      inner | outer
//!    +-------------------+
//!    |   square 2 |  0   |  outer     a square: where lines of constant a meet lines of
//!    +------------+------+            constant b; it may have several patches
//!    | next ring  |  1   |  inner
//!    +------------+------+--> a
//! ```

use super::Rings;
use super::depth::OUT_OF_THE_DENORMALS;
use crate::patch::Answer;
use crate::patch::kernel::{Line, patch_grid};

impl<const N: usize> Rings<N> {
    /// [`Rings::eval_as`] where lines of constant a meet lines of constant b, all from 0 to 1.
    /// `put` gets the numbers of both lines and the answer, with the same bits as one at a time.
    pub(crate) fn eval_grid<A: Answer<N>>(
        &self,
        s: usize,
        mut a: Vec<Line>,
        mut b: Vec<Line>,
        put: &mut dyn FnMut(usize, usize, A),
    ) {
        let sigma = self.sigma();
        // Scaled up like in `ring_of` and `scaled_up`.
        a.iter_mut().chain(&mut b).for_each(|line| line.at *= OUT_OF_THE_DENORMALS);
        for ring in 0.. {
            if a.iter().chain(&b).all(|line| line.at == 0.0) {
                return for_each_pair(&a, &b, |a, b| put(a.number, b.number, self.at_center()));
            }
            let is_outer = |line: &Line| line.at > sigma * OUT_OF_THE_DENORMALS;
            let (outer_a, inner_a): (Vec<Line>, Vec<Line>) = a.into_iter().partition(is_outer);
            let (outer_b, inner_b): (Vec<Line>, Vec<Line>) = b.into_iter().partition(is_outer);
            self.eval_square(ring, s, 0, [&outer_a, &outer_b], put);
            self.eval_square(ring, s, 1, [&outer_a, &inner_b], put);
            self.eval_square(ring, s, 2, [&inner_a, &outer_b], put);
            if inner_a.is_empty() || inner_b.is_empty() {
                return;
            }
            let factor = 1.0 / sigma;
            let inwards = |line: Line| Line { at: factor * line.at, ..line };
            a = inner_a.into_iter().map(inwards).collect();
            b = inner_b.into_iter().map(inwards).collect();
        }
    }

    /// One of the three squares of a sector of a ring.
    fn eval_square<A: Answer<N>>(
        &self,
        ring: usize,
        s: usize,
        square: usize,
        [a, b]: [&[Line]; 2],
        put: &mut dyn FnMut(usize, usize, A),
    ) {
        if a.is_empty() || b.is_empty() {
            return;
        }
        let rules = &self.rules.rules;
        let (a, b) = (self.parts(square, 0, a), self.parts(square, 1, b));
        for (i, a) in a.iter().enumerate() {
            for (j, b) in b.iter().enumerate() {
                if a.lines.is_empty() || b.lines.is_empty() {
                    continue;
                }
                let which = rules.patch_of([i, j], square);
                let mut deep = None;
                let (scale, coefs) = self.scale_and_coefs(ring, s, which, &mut deep);
                let lines = [&a.lines[..], &b.lines[..]];
                patch_grid(A::ORDER, rules.degree, coefs, lines, |i, j, jet| {
                    put(i, j, self.placed(scale, [a.size, b.size], jet));
                });
            }
        }
    }

    /// The lines of a square, sorted by the patches that they cross, in the patches' own
    /// parameters.
    fn parts(&self, square: usize, k: usize, lines: &[Line]) -> Vec<Part> {
        let rules = &self.rules.rules;
        let empty = || Part { size: 1.0, lines: Vec::new() };
        let mut parts: Vec<Part> = std::iter::repeat_with(empty).take(rules.split).collect();
        for line in lines {
            let place = rules.locate_along(square, k, line.at / OUT_OF_THE_DENORMALS);
            let part = &mut parts[place.part];
            part.size = place.size;
            part.lines.push(Line { at: place.at, ..*line });
        }
        parts
    }
}

/// The lines that cross patches of one size.
struct Part {
    size: f64,
    lines: Vec<Line>,
}

/// Calls `f` wherever two lines meet.
pub(crate) fn for_each_pair(a: &[Line], b: &[Line], mut f: impl FnMut(&Line, &Line)) {
    for a in a {
        b.iter().for_each(|b| f(a, b));
    }
}
