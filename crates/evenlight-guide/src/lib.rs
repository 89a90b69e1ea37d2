//! The derivation of Evenlight's refinement rules.
//!
//! Evolving-Guide subdivision, EG [KP23-EG], and Quadratic-Attraction subdivision, QAS [KP23-QAS],
//! refine the d-net around an extraordinary point by tabulated weights. This crate computes the
//! weights of any valence from their definition and writes the tables that the library `evenlight`
//! reads. `cargo xtask tables` runs it; at run time the library needs it only for guided rules that
//! are in no table (its feature `derive`).
//!
//! # The derivation in one page
//!
//! A *d-net* of valence n holds 12n spline nodes around a point p, twelve in each of n sectors
//! ([`nets`]). They determine a C2 ring of bi-4 patches, with position, first and second
//! derivatives along its inner border ([`spline`], [`border`]). Refining means to find a smaller
//! ring inside. The rules say: *continue the border by a guide that is polynomial in each sector,
//! and sample the guide further in*.
//!
//! ```text
//!    d-net --> border of the sectors --> guide g, bi-5 --> g sampled at scale lambda --> new d-net
//!      '------> q, by least F_k(g) ---------^                    ^
//!               (EG: always; QAS: once)     characteristic map chi
//! ```
//!
//! 1. **Where.** chi is the characteristic map of Catmull-Clark subdivision, lambda its eigenvalue;
//!    lambda chi continues chi by one ring. In coordinates along the two lines of a sector chi is
//!    chi^T = L^-1 chi, a parametrisation of the border in the unit square ([`characteristic`]).
//! 2. **What.** Along each of the n lines the guide is given by a quintic and its cross
//!    derivative; at the centre all n pieces share one quadratic q ([`quadratic`]). Inside, the
//!    2-jets of g(chi^T) at the three corners of the border, averaged where they overlap, agree
//!    with the net ([`guide`], [`jet`]).
//! 3. **Next.** The same jets of g(lambda chi^T), turned into spline nodes, are the new net; nodes
//!    on a line are averaged over both sides. The weights are kappa on the nodes near by and tau
//!    on q ([`rules`]).
//! 4. **The quadratic.** q_1 = p; the other five coefficients minimise F_k, the integral of the
//!    squared k-th derivatives, over the sectors of the guide ([`rules::Step::quadratic`]).
//!    Everything is linear, so q is a fixed combination of d and p.
//!    - QAS, k = 5: q is determined from the first net, by weights mu, and then only restricted to
//!      smaller domains ([`quadratic_attraction`]).
//!    - EG, k = 4: q is determined anew in each step; substituting it leaves rules in d and p alone
//!      ([`evolving_guide`]).
//! 5. **The table.** Averaged with their mirror images and rounded to 18 digits ([`emit`]).
//!
//! All of it is computed with some 31 digits ([`real`], [`linear`]). By the symmetries and the
//! partition of unity the weights are exact to 1e-28 at every valence up to 16.
//!
//! ```
//! use evenlight_guide::evolving_guide::{EG_ORDER, evolving_guide};
//!
//! // The weight of d_22 of the own sector in the rule of d_11, valence 5: printed as .61638.
//! let rules = evolving_guide(5, EG_ORDER);
//! let weight = rules[0].on_net[10].to_f64();
//! assert_eq!((weight * 1e5).trunc(), 61638.0);
//! ```
//!
//! # Sources
//!
//! - \[KP23-EG\] K. Karciauskas, J. Peters: Evolving Guide Subdivision. Computer Graphics Forum 42,
//!   2023. The scheme; its tables, truncated to 5 digits, for valences up to 10.
//! - \[KP23-QAS\] K. Karciauskas, J. Peters: Quadratic-Attraction Subdivision. Computer Graphics
//!   Forum 42, 2023. The step (d, q) -> d, the functional F_k and the rules of q; tables likewise.
//!
//! The papers leave parts of the guide to figures and to earlier work. The construction here is
//! complete, and is confirmed by the printed tables: all the numbers that we could read come out.

pub mod border;
pub mod characteristic;
pub mod emit;
pub mod evolving_guide;
pub mod guide;
pub mod guided;
pub mod jet;
pub mod linear;
pub mod nets;
pub mod optimal;
pub mod quadratic;
pub mod quadratic_attraction;
pub mod real;
pub mod rules;
pub mod spline;
