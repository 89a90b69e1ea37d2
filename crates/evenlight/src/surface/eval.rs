//! Evaluation at any (quad, u, v): finding the piece, and asking it what is wanted.
//!
//! What is computed follows from the type of the answer ([`Answer`]). Of the instructions that
//! everything with curvature takes, a position takes .4, first derivatives too .6, second ones .8.

use super::arrays::check_length;
use super::place::{from_sector, quadrant, to_sector};
use super::{ArrayError, QuadId, Surface};
use crate::mesh::isolation::{CORNERS, Piece};
use crate::patch::{Answer, FirstJet, Jet, Parts};
use crate::task::for_each_chunk;

impl<const N: usize> Surface<N> {
    /// [`Surface::eval`] of what is wanted alone, which is told by the type: position, first
    /// derivatives, second derivatives, or all with normal and curvature.
    ///
    /// ```
    /// use evenlight::patch::FirstJet;
    /// use evenlight::{Cage, Mesh, QuadId, Surface, SurfaceOptions};
    ///
    /// let square = vec![[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.]];
    /// let cage = Cage::new(Mesh::new(square, [[0, 1, 2, 3]]))?;
    /// let surface = Surface::build(cage, SurfaceOptions::default())?;
    /// let at: FirstJet = surface.eval_as(QuadId(0), 0.5, 0.5).expect("there is a surface");
    /// assert!((at.p[0] - 0.5).abs() < 1e-15 && (at.p[1] - 0.5).abs() < 1e-15);
    /// assert_eq!(at.normal(), [0.0, 0.0, 1.0]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[inline]
    pub fn eval_as<A: Answer<N>>(&self, quad: QuadId, u: f64, v: f64) -> Option<A> {
        if u.is_nan() || v.is_nan() {
            return None;
        }
        let plan = &self.layout.plan;
        let mut piece = *plan.pieces[..self.num_quads()].get(quad.0 as usize)?;
        let (mut at, mut zoom) = ([u.clamp(0.0, 1.0), v.clamp(0.0, 1.0)], 1.0);
        loop {
            match piece {
                Piece::Omitted => return None,
                Piece::Regular(net) => {
                    let jet =
                        self.regular_jet(<A as Parts<N>>::ORDER, net, at).scaled_parameters(zoom);
                    return Some(A::from_parts(jet, Jet::shape));
                }
                Piece::Sector { point, sector, corner } => {
                    let at = to_sector(corner, at);
                    let found: A = self.eval_around(point as usize, sector as usize, at);
                    let change = |jet: &Jet<N>| from_sector(corner, jet).scaled_parameters(zoom);
                    return Some(found.in_parameters(change));
                }
                Piece::Split(first) => {
                    let k = quadrant(at);
                    piece = plan.pieces[first as usize + k];
                    at = [2.0 * at[0] - CORNERS[k][0], 2.0 * at[1] - CORNERS[k][1]];
                    zoom *= 2.0;
                }
            }
        }
    }

    /// A sector of an extraordinary point at its own parameters.
    #[inline]
    pub(super) fn eval_around<A: Answer<N>>(&self, point: usize, sector: usize, at: [f64; 2]) -> A {
        let rings = self.rings_at(point);
        if let Some(cap) = self.cap(point) {
            let in_hole = rings.in_hole(cap.rings(), at);
            if in_hole[0].max(in_hole[1]) <= 1.0 {
                return cap.eval_as(rings, sector, in_hole);
            }
        }
        rings.eval_as(sector, at[0], at[1])
    }

    /// The position at (u,v) of `quad`, as [`Surface::eval`] gives it; of a primvar the value.
    pub fn eval_position(&self, quad: QuadId, u: f64, v: f64) -> Option<[f64; N]> {
        self.eval_as(quad, u, v)
    }

    /// Position and first derivatives at (u,v) of `quad`, as [`Surface::eval`] gives them.
    pub fn eval_first(&self, quad: QuadId, u: f64, v: f64) -> Option<FirstJet<N>> {
        self.eval_as(quad, u, v)
    }

    /// Position, first and second derivatives at (u,v) of `quad`, as [`Surface::eval`] gives them.
    pub fn eval_second(&self, quad: QuadId, u: f64, v: f64) -> Option<Jet<N>> {
        self.eval_as(quad, u, v)
    }

    /// Evaluates at many places (quad, u, v), with feature `parallel` on all threads. Answer k
    /// belongs to place k and has the same bits as from [`Surface::eval_as`]. It is NaN where there
    /// is no surface.
    ///
    /// On a large surface most of the time goes into fetching control points; therefore places are
    /// taken in the order of their quads.
    ///
    /// # Errors
    ///
    /// [`ArrayError::Length`] if there are not as many answers as places.
    ///
    /// ```
    /// use evenlight::{Cage, Mesh, QuadId, Surface, SurfaceOptions};
    ///
    /// let square = vec![[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.]];
    /// let cage = Cage::new(Mesh::new(square, [[0, 1, 2, 3]]))?;
    /// let surface = Surface::build(cage, SurfaceOptions::default())?;
    /// let mut points = [[0.0; 3]; 2];
    /// surface.eval_each(&[(QuadId(0), 0.0, 0.0), (QuadId(0), 0.5, 0.5)], &mut points)?;
    /// assert_eq!(points[0], [0.0, 0.0, 0.0]);
    /// assert!((points[1][0] - 0.5).abs() < 1e-15 && (points[1][1] - 0.5).abs() < 1e-15);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn eval_each<A: Answer<N>>(
        &self,
        places: &[(QuadId, f64, f64)],
        answers: &mut [A],
    ) -> Result<(), ArrayError> {
        check_length("the array of answers", answers.len(), places.len())?;
        /// Fewer quads stay in a cache whatever the order.
        const LARGE: usize = 1 << 15;
        // Enough for a thread at a time, or for places that are near each other.
        let is_large = self.num_quads() >= LARGE;
        let chunk = if is_large { 1 << 18 } else { 1 << 12 };
        for_each_chunk(answers, chunk, |first, answers| {
            let places = &places[first..first + answers.len()];
            let mut answer = |k: usize| {
                let (quad, u, v) = places[k];
                answers[k] = self.eval_as(quad, u, v).unwrap_or(A::NAN);
            };
            if is_large {
                order_of_quads(places, self.num_quads())
                    .into_iter()
                    .for_each(|k| answer(k as usize));
            } else {
                (0..places.len()).for_each(answer);
            }
        });
        Ok(())
    }
}

/// The numbers of the places, in an order that keeps neighbouring quads together.
fn order_of_quads(places: &[(QuadId, f64, f64)], num_quads: usize) -> Vec<u32> {
    /// So many quads count as neighbours.
    const NEAR: usize = 64;
    let bucket = |&(quad, ..): &(QuadId, f64, f64)| (quad.0 as usize).min(num_quads) / NEAR;
    let mut starts = vec![0_u32; num_quads / NEAR + 2];
    places.iter().for_each(|place| starts[bucket(place) + 1] += 1);
    for k in 1..starts.len() {
        starts[k] += starts[k - 1];
    }
    let mut order = vec![0; places.len()];
    for (place, k) in places.iter().zip(0..) {
        let slot = &mut starts[bucket(place)];
        order[*slot as usize] = k;
        *slot += 1;
    }
    order
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_ordered_by_buckets_and_none_is_lost() {
        let quads = [700, 3, u32::MAX, 64, 0, 65, 700, 699, 128];
        let places = quads.map(|quad| (QuadId(quad), 0.0, 0.0));
        let order = order_of_quads(&places, 700);
        assert_eq!(order, [1, 4, 3, 5, 8, 0, 2, 6, 7]);
    }
}
