//! Evaluation on a grid of parameters of one quad.
//!
//! A piece is asked for all the places that it has at once: what those on one line have in common,
//! basis functions and the sums over one index of the control points, is computed once.
//! The bits are the same as place by place.

use super::arrays::check_length;
use super::place::{from_sector, to_sector};
use super::{ArrayError, QuadId, Surface};
use crate::mesh::isolation::{CORNERS, Piece};
use crate::patch::basis::cubic_b_spline;
use crate::patch::kernel::{Line, square, tensor_grid};
use crate::patch::{Answer, Jet, Parts};
use crate::rings::for_each_pair;

impl<const N: usize> Surface<N> {
    /// Evaluates at all pairs of the parameters `us` and `vs` of a quad. The answer at `us[i]`,
    /// `vs[j]` is number i * `vs.len()` + j, the v index fastest as in patches; the same bits as
    /// from [`Surface::eval_as`]; NaN where there is no surface.
    ///
    /// # Errors
    ///
    /// [`ArrayError::Length`] if there are not as many answers as pairs.
    ///
    /// ```
    /// use evenlight::{Cage, Mesh, QuadId, Surface, SurfaceOptions};
    ///
    /// let square = vec![[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.]];
    /// let cage = Cage::new(Mesh::new(square, [[0, 1, 2, 3]]))?;
    /// let surface = Surface::build(cage, SurfaceOptions::default())?;
    /// let mut points = [[0.0; 3]; 4];
    /// surface.eval_grid(QuadId(0), &[0.0, 0.5], &[0.5, 1.0], &mut points)?;
    /// assert!((points[2][0] - 0.5).abs() < 1e-15 && (points[2][1] - 0.5).abs() < 1e-15);
    /// assert_eq!(Some(points[1]), surface.eval_position(QuadId(0), 0.0, 1.0));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn eval_grid<A: Answer<N>>(
        &self,
        quad: QuadId,
        us: &[f64],
        vs: &[f64],
        answers: &mut [A],
    ) -> Result<(), ArrayError> {
        check_length("the array of answers", answers.len(), us.len() * vs.len())?;
        answers.fill(A::NAN);
        let Some(&piece) = self.layout.plan.pieces[..self.num_quads()].get(quad.0 as usize) else {
            return Ok(());
        };
        let lines = |parameters: &[f64]| -> Vec<Line> {
            let lines = parameters.iter().enumerate().filter(|(_, at)| !at.is_nan());
            lines.map(|(number, at)| Line { number, at: at.clamp(0.0, 1.0) }).collect()
        };
        let mut put = |i: usize, j: usize, answer: A| answers[i * vs.len() + j] = answer;
        self.eval_piece(piece, lines(us), lines(vs), 1.0, &mut put);
        Ok(())
    }

    /// A piece that is `zoom` times as small as its quad, at its own parameters.
    fn eval_piece<A: Answer<N>>(
        &self,
        piece: Piece,
        us: Vec<Line>,
        vs: Vec<Line>,
        zoom: f64,
        put: &mut dyn FnMut(usize, usize, A),
    ) {
        if us.is_empty() || vs.is_empty() {
            return;
        }
        match piece {
            Piece::Omitted => {}
            Piece::Regular(net) => {
                let points = self.net_points(net);
                let lines = [&us[..], &vs[..]];
                tensor_grid(
                    <A as Parts<N>>::ORDER,
                    cubic_b_spline,
                    square(&points),
                    lines,
                    |i, j, jet| {
                        put(i, j, A::from_parts(jet.scaled_parameters(zoom), Jet::shape));
                    },
                );
            }
            Piece::Sector { point, sector, corner } => {
                let change = |jet: &Jet<N>| from_sector(corner, jet).scaled_parameters(zoom);
                let put =
                    &mut |i: usize, j: usize, found: A| put(i, j, found.in_parameters(change));
                self.eval_sector(point as usize, sector as usize, corner, [us, vs], put);
            }
            Piece::Split(first) => {
                let (us, vs) = (halves(&us), halves(&vs));
                for (k, [u, v]) in CORNERS.into_iter().enumerate() {
                    let (us, vs) = (us[u as usize].clone(), vs[v as usize].clone());
                    let child = self.layout.plan.pieces[first as usize + k];
                    self.eval_piece(child, us, vs, 2.0 * zoom, put);
                }
            }
        }
    }

    /// A sector, whose answers are in its own parameters (a,b), on lines of the square that it
    /// covers.
    fn eval_sector<A: Answer<N>>(
        &self,
        point: usize,
        sector: usize,
        corner: u8,
        [us, vs]: [Vec<Line>; 2],
        put: &mut dyn FnMut(usize, usize, A),
    ) {
        if self.cap(point).is_some() {
            return for_each_pair(&us, &vs, |u, v| {
                let at = to_sector(corner, [u.at, v.at]);
                put(u.number, v.number, self.eval_around(point, sector, at));
            });
        }
        let turned = |lines: Vec<Line>| -> Vec<Line> {
            lines.into_iter().map(|line| Line { at: 1.0 - line.at, ..line }).collect()
        };
        let rings = self.rings_at(point);
        // As in `to_sector`.
        match corner {
            0 => rings.eval_grid(sector, us, vs, put),
            1 => rings.eval_grid(sector, vs, turned(us), &mut |j, i, found| put(i, j, found)),
            2 => rings.eval_grid(sector, turned(us), turned(vs), put),
            _ => rings.eval_grid(sector, turned(vs), us, &mut |j, i, found| put(i, j, found)),
        }
    }
}

/// The lines of the lower and of the upper half of a square, with the parameters of the halves.
fn halves(lines: &[Line]) -> [Vec<Line>; 2] {
    let half = |upper: bool| {
        let own = lines.iter().filter(|line| (line.at > 0.5) == upper);
        own.map(|line| Line { at: 2.0 * line.at - f64::from(u8::from(upper)), ..*line }).collect()
    };
    [half(false), half(true)]
}
