//! Fairness-optimal subdivision: the refinement rules as a linear-quadratic regulator.
//!
//! This is our own; no paper has it. Take the nets of Quadratic-Attraction subdivision and its
//! regular rules; the six inner nodes of each sector are free. Which rules for them make the
//! *whole* infinite sequence of rings as fair as it can be? Let the old net d be the state of a
//! linear system and the new inner nodes u its control. Then refinement is d' = A d + B u, and
//! fairness is a quadratic form of d and u. This is the problem of a regulator, and its solution is
//! linear.
//!
//! ```text
//!   d ---> p, q      e = d - p - D q     what the net has beyond its quadratic
//!   |                e' = A e + B v      A: regular refinement,  B: the six inner nodes
//!   v                v  = K e            least  sum over rings l of  lambda^(-4l) E(e_l, v_l)
//!   d' = p + D S q + e'                  S: q shrunk by lambda
//! ```
//!
//! 1. **D, the nets of the quadratics** ([`eigennets`]). For each quadratic in the coordinates of
//!    the characteristic map chi there are nets that refinement multiplies by lambda^2 exactly; D q
//!    is the net whose ring is nearest to the quadratic itself. If q shrinks by S, the surface of
//!    D q has bounded curvature, whatever else the rules do.
//! 2. **E, the energy of a ring** ([`energy`]). The integrals over the ring of the squared third
//!    and second derivatives with respect to chi, and a little of e itself. The factor lambda^(-4l)
//!    puts ring l in the scale where its quadratic does not shrink. If the sum is finite, e dies
//!    faster than lambda^2.
//! 3. **K** ([`regulator`]). The optimum solves a Riccati equation. Turning a sector and mirrors
//!    leave everything alike, so a discrete Fourier transform over the sectors cuts the problem
//!    into blocks of 12 nodes and 6 controls, real in coordinates that the mirror suggests
//!    ([`block`]).
//! 4. **K that is local** ([`local`]). The optimal K reaches all sectors, with small weights.
//!    Iteration finds the best K on the nodes that Quadratic-Attraction rules use; it costs .1 % of
//!    J.
//! 5. **q** ([`rules`]). The quadratic of a net is the one with the least cost: it minimises
//!    e^T P e, where P is the cost-to-go of e.
//!
//! Three schemes follow. **fair4** has the local K and q as part of the state, in the layout of
//! Quadratic-Attraction rules. **fair4d** has the optimal K and finds q anew in each step, in the
//! layout of Evolving-Guide rules. **fair3** is like fair4, for bi-3 splines on the half-step grid.
//!
//! The regulator with a discount and a cross term: B. D. O. Anderson, J. B. Moore, Optimal Control:
//! Linear Quadratic Methods, Prentice-Hall 1990. The doubling of the Riccati equation: E. K.-W.
//! Chu, H.-Y. Fan, W.-W. Lin, C.-S. Wang, Structure-preserving algorithms for periodic
//! discrete-time algebraic Riccati equations, Int. J. Control 77, 2004. The iteration for K of a
//! given structure: W. S. Levine, M. Athans, On the determination of the optimal constant output
//! feedback gains, IEEE Trans. Automatic Control 15, 1970, in the form of D. Moerder, A. Calise,
//! ibid. 30, 1985.

pub mod block;
pub mod eigennets;
pub mod energy;
pub mod local;
pub mod nets;
pub mod regulator;
pub mod rules;
