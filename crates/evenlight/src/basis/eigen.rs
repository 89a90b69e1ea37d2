//! Eigenfunctions: guided subdivision multiplies each by a power of lambda in every ring.

use std::sync::OnceLock;

use super::guide::{HomogeneousGuide, MAX_TOTAL_DEGREE};
use super::{jet_of_patch, value_alone};
use crate::net::{CNET_NODES, CNet};
use crate::patch::Jet;
use crate::rings::{MAX_RINGS, power, ring_of, scaled_up};
use crate::scheme::{Contraction, Rules, SchemeKind, guide_monomials};

/// The eigenfunctions of a guided scheme at one valence \[KP18-Guided, Section 5\].
///
/// Function k follows a homogeneous guide of degree s. On ring l = 0, 1, 2, ... it is lambda^(s l)
/// times what it is on ring 0:
///
/// ```text
///   f(a/2, b/2) = lambda^s f(a,b),    in each sector.
/// ```
///
/// (For contractions other than Catmull-Clark's sigma takes the place of 1/2.) So all rings follow
/// from the first one. The functions are C2 everywhere except at the centre. From ring 1 on every
/// guided surface is a sum of eigenfunctions; ring 0 has the border of the surrounding surface.
/// Function 0 is the constant 1. Functions 1 and 2 are the characteristic map; the even one is
/// along the diagonal of sector 0.
///
/// ```
/// use evenlight::SchemeKind;
/// use evenlight::basis::Eigenfunctions;
///
/// let f = Eigenfunctions::new(SchemeKind::Guided5, 5).ok_or("guided5 has rules for n = 5")?;
/// assert_eq!(f.len(), 17 * 5 + 5 + 6);
/// let cubic = f.of_degree(3).start;
/// let outer = f.eval(cubic, 2, 0.75, 0.3).ok_or("there is a sector 2")?;
/// let inner = f.eval(cubic, 2, 0.375, 0.15).ok_or("there is a sector 2")?;
/// assert!((inner.p[0] - f.lambda().powi(3) * outer.p[0]).abs() < 1e-15);
/// # Ok::<(), &str>(())
/// ```
#[derive(Debug)]
pub struct Eigenfunctions {
    kind: SchemeKind,
    rules: Rules,
    lambda: f64,
    guides: Vec<HomogeneousGuide>,
    /// The coefficients of ring 0 of every function, patch by patch.
    rings: Vec<OnceLock<Vec<f64>>>,
}

impl Eigenfunctions {
    /// The eigenfunctions of `guided3` to `guided6` at `valence`; `None` for other schemes and
    /// valences without rules.
    pub fn new(kind: SchemeKind, valence: usize) -> Option<Self> {
        Self::with_contraction(kind, Contraction::CatmullClark, valence)
    }

    /// The eigenfunctions of another contraction, with its lambda, and with sigma in the place of
    /// 1/2. `None` also if the scheme has no such contraction.
    pub fn with_contraction(
        kind: SchemeKind,
        contraction: Contraction,
        valence: usize,
    ) -> Option<Self> {
        kind.guided_degree()?;
        let rules = kind.rules(contraction, valence)?;
        let lambda = rules.guide.as_ref()?.lambda;
        let of_degree = |degree| HomogeneousGuide::all_of(valence, degree);
        let guides: Vec<_> = (0..=MAX_TOTAL_DEGREE).flat_map(of_degree).collect();
        let rings = guides.iter().map(|_| OnceLock::new()).collect();
        Some(Self { kind, rules, lambda, guides, rings })
    }

    /// The valence.
    pub fn valence(&self) -> usize {
        self.rules.valence
    }

    /// The subdominant eigenvalue.
    pub fn lambda(&self) -> f64 {
        self.lambda
    }

    /// The factor by which the parameters of the rings shrink: 1/2 with Catmull-Clark's
    /// contraction, else sigma.
    pub fn sigma(&self) -> f64 {
        self.rules.sigma()
    }

    /// The number of functions, 17n + n* + 6.
    pub fn len(&self) -> usize {
        self.guides.len()
    }

    /// Always false, since the constant is a function.
    pub fn is_empty(&self) -> bool {
        self.guides.is_empty()
    }

    /// The guide that function `k` follows: its degree s, mode and parity. `None` if `k` is not
    /// below [`Eigenfunctions::len`], as in all methods that take a `k`.
    pub fn guide(&self, k: usize) -> Option<&HomogeneousGuide> {
        self.guides.get(k)
    }

    /// The guides of all functions.
    pub(super) fn guides(&self) -> &[HomogeneousGuide] {
        &self.guides
    }

    /// The functions of eigenvalue lambda^`degree`.
    pub fn of_degree(&self, degree: usize) -> std::ops::Range<usize> {
        let below = |degree: usize| self.guides.partition_point(|g| g.degree() < degree);
        below(degree)..below(degree.saturating_add(1))
    }

    /// The eigenvalue of function `k`, lambda^s.
    pub fn eigenvalue(&self, k: usize) -> Option<f64> {
        (k < self.len()).then(|| self.eigenvalue_of(k))
    }

    /// The eigenvalue of a function that is known to exist.
    pub(super) fn eigenvalue_of(&self, k: usize) -> f64 {
        power(self.lambda, self.guides[k].degree())
    }

    /// The factor of a function from ring 0 to ring `ring`.
    fn factor(&self, k: usize, ring: usize) -> f64 {
        power(self.eigenvalue_of(k), ring)
    }

    /// The bi-degree of the patches.
    pub fn degree(&self) -> usize {
        self.rules.degree
    }

    /// The number of patches in each sector of a ring.
    pub fn patches_per_sector(&self) -> usize {
        self.rules.patches_per_sector()
    }

    /// The part [[a0, a1], [b0, b1]] of a sector that patch `which` of ring 0 covers; as in
    /// [`Rings::patch_domain`](crate::rings::Rings::patch_domain). `None` if there is no such
    /// patch.
    pub fn patch_domain(&self, which: usize) -> Option<[[f64; 2]; 2]> {
        (which < self.patches_per_sector()).then(|| self.domain(which))
    }

    /// [`Eigenfunctions::patch_domain`] of a patch that is known to exist.
    pub(super) fn domain(&self, which: usize) -> [[f64; 2]; 2] {
        self.rules.patch_domain(which)
    }

    /// The BB coefficients of function `k` on a patch, index along b fastest; `None` if there is no
    /// such function, sector or patch, or the ring is not below [`MAX_RINGS`].
    pub fn coefs(&self, k: usize, ring: usize, sector: usize, which: usize) -> Option<Vec<f64>> {
        let is_known = k < self.len() && self.has_patch(ring, sector, which);
        is_known.then(|| self.coefs_on(k, ring, sector, which))
    }

    /// Whether there is such a patch.
    fn has_patch(&self, ring: usize, sector: usize, which: usize) -> bool {
        ring < MAX_RINGS && sector < self.valence() && which < self.patches_per_sector()
    }

    /// The BB coefficients of a function on a patch that is known to exist.
    pub(crate) fn coefs_on(&self, k: usize, ring: usize, sector: usize, which: usize) -> Vec<f64> {
        let factor = self.factor(k, ring);
        self.first_ring(k, sector, which).iter().map(|c| factor * c).collect()
    }

    /// The coefficients on a patch of ring 0.
    fn first_ring(&self, k: usize, sector: usize, which: usize) -> &[f64] {
        let per_sector = self.patches_per_sector();
        let size = (self.degree() + 1) * (self.degree() + 1);
        let first = (sector * per_sector + which) * size;
        &self.rings[k].get_or_init(|| self.ring_of_function(k))[first..first + size]
    }

    /// Value and derivatives by a and b of function `k` at (a,b) of sector `sector`. At the centre
    /// (0,0) derivatives exist for the constant only; for other functions they are NaN. `None` if
    /// there is no such function or sector, or a, b are not from 0 to 1.
    pub fn eval(&self, k: usize, sector: usize, a: f64, b: f64) -> Option<Jet<1>> {
        let is_inside = [a, b].iter().all(|x| (0.0..=1.0).contains(x));
        if k >= self.len() || sector >= self.valence() || !is_inside {
            return None;
        }
        if a.max(b) == 0.0 {
            return Some(at_center(self.guides[k].degree()));
        }
        let sigma = self.rules.sigma();
        let ring = ring_of(a.max(b), sigma);
        let which = self.rules.patch_at([a, b].map(|x| scaled_up(x, ring, sigma)));
        self.eval_on(k, ring, sector, which, [a, b])
    }

    /// Like [`Eigenfunctions::eval`], but from a given patch; the polynomial is extrapolated if
    /// (a,b) is not in the patch. `None` if there is no such function or patch.
    pub fn eval_on(
        &self,
        k: usize,
        ring: usize,
        sector: usize,
        which: usize,
        [a, b]: [f64; 2],
    ) -> Option<Jet<1>> {
        if k >= self.len() || !self.has_patch(ring, sector, which) {
            return None;
        }
        let (corner, size) = self.rules.patch_square(which);
        let sigma = self.rules.sigma();
        let own = |x: f64, k: usize| (scaled_up(x, ring, sigma) - corner[k]) / size[k];
        let coefs = self.first_ring(k, sector, which);
        let jet = jet_of_patch(self.degree(), coefs, [own(a, 0), own(b, 1)]);
        let speed = power(1.0 / sigma, ring);
        Some(jet.scaled(self.factor(k, ring), size.map(|size| speed / size)))
    }

    /// The patch of the outermost ring that contains (a,b).
    pub(super) fn patch_at(&self, place: [f64; 2]) -> usize {
        self.rules.patch_at(place)
    }

    /// Coefficient number `at` of a patch of sector 0 as weights of nodes. Coefficients next to the
    /// outer border depend on nodes of the border only.
    pub(super) fn border_row(&self, which: usize, at: usize) -> &[(usize, f64)] {
        &self.rules.patches[which].old[at]
    }

    /// The limit point if node `node` of a c-net is 1 and the others 0, and the nodes of all
    /// sectors relative to it.
    pub(super) fn net_of_node(&self, node: usize) -> (f64, Vec<f64>) {
        let sectors = vec![[[0.0]; CNET_NODES]; self.valence()];
        let mut cnet = CNet { center: [0.0], sectors };
        match cnet.sectors.get_mut(node / CNET_NODES) {
            Some(sector) => sector[node % CNET_NODES] = [1.0],
            None => cnet.center = [1.0],
        }
        let limit = self.kind.limit_point(&cnet);
        let net = self.rules.guided_net(&cnet.relative_to(limit)).unwrap_or_default();
        (limit[0], net.into_flattened())
    }

    /// The nodes of function `k` in front of ring 0. For the constant all are zero, as nets are
    /// relative to the limit point.
    pub(super) fn net(&self, k: usize) -> Vec<[f64; 1]> {
        let (rules, guide) = (&self.rules, &self.guides[k]);
        let monomials = guide_monomials();
        let border = rules.control_nodes_per_sector();
        let mut net = Vec::with_capacity(rules.num_nodes());
        for sector in 0..rules.valence {
            net.extend(std::iter::repeat_n([0.0], border));
            let coef = |&(i, j): &(usize, usize)| [guide.coefficient(sector, i, j)];
            net.extend(monomials.iter().map(coef));
        }
        // The guide determines the border of the next ring, which the eigenvector has already.
        let next = rules.refine(&net);
        let eigenvalue = self.eigenvalue_of(k);
        let border_nodes = (0..net.len()).filter(|at| at % rules.nodes_per_sector < border);
        border_nodes.for_each(|at| net[at][0] = next[at][0] / eigenvalue);
        net
    }

    fn ring_of_function(&self, k: usize) -> Vec<f64> {
        let (rules, per_sector) = (&self.rules, self.patches_per_sector());
        let constant = f64::from(u8::from(self.guides[k].degree() == 0));
        let net = self.net(k);
        let refined = rules.refine(&net);
        let patches = 0..per_sector * rules.valence;
        let coefs =
            patches.flat_map(|at| rules.patch(at / per_sector, at % per_sector, &net, &refined));
        coefs.map(|c| c[0] + constant).collect()
    }
}

/// The value at the centre of an eigenfunction of degree s.
fn at_center(degree: usize) -> Jet<1> {
    if degree == 0 { Jet { p: [1.0], ..Jet::default() } } else { value_alone(0.0) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The subdivision matrix itself, not its closed form, multiplies the nets of the functions.
    #[test]
    fn nets_are_eigenvectors_of_the_subdivision_matrix() {
        for kind in SchemeKind::ALL.into_iter().filter(|kind| kind.guided_degree().is_some()) {
            for n in [3, 5, 6, 7, 8, 9, 10, 16] {
                let functions = Eigenfunctions::new(kind, n).unwrap();
                for k in 1..functions.len() {
                    let net = functions.net(k);
                    let refined = functions.rules.refine(&net);
                    let largest = net.iter().map(|p| p[0].abs()).fold(0.0, f64::max);
                    let eigenvalue = functions.eigenvalue_of(k);
                    for (old, new) in net.iter().zip(&refined) {
                        let error = (new[0] / eigenvalue - old[0]).abs();
                        assert!(error < 1e-13 * largest, "{} n = {n}, {k}", kind.name());
                    }
                }
            }
        }
    }
}
