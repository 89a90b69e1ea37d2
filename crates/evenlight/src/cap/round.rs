//! Caps of points that are smooth all around: which data they get, and from which scheme.

use super::border::Border;
use super::rules::{self, CapRules, Shape, pieces};
use super::sector::Complex;
use super::spline::Space;
use super::{CapError, CapKind, domains};
use crate::angle::{cosine, sine};
use crate::patch::Patch;
use crate::point::{Vector, add_scaled, scale};
use crate::rings::{Rings, ValenceRules};
use crate::scheme::{Rules, guide_monomials};

/// The rules of the caps of a scheme at one valence.
#[derive(Clone, Debug)]
pub(crate) struct RoundCap {
    border: Border,
    cap: CapRules,
    /// chi over the coordinate of the plane: chi = kappa zeta.
    kappa: Complex,
}

impl RoundCap {
    pub(super) fn new(rules: &ValenceRules, kind: CapKind) -> Result<Self, CapError> {
        let (scheme, rules, subdominant) = (rules.kind(), rules.rules(), rules.subdominant());
        let valence = rules.valence;
        kind.check(scheme)?;
        let space = kind.space(scheme, rules.split);
        if rules.cuts().is_some() && rules.split > 1 {
            return Err(CapError::Contraction { scheme });
        }
        if !cuts_fit(rules, space) {
            return Err(CapError::Cuts { scheme, split: rules.split });
        }
        let net = subdominant.characteristic_net();
        let refined = rules.refine(&net);
        let ring: Vec<Vec<Vector>> = (0..rules.patches_per_sector())
            .map(|which| rules.patch(0, which, &net, &refined))
            .collect();
        let kappa = kappa(rules, &ring);
        let size = kappa[0] * kappa[0] + kappa[1] * kappa[1];
        let zeta = |[x, y, _]: Vector| {
            [(x * kappa[0] + y * kappa[1]) / size, (y * kappa[0] - x * kappa[1]) / size]
        };
        let border = |space: Space| Border::new(rules.degree, &domains(rules), space);
        let chi = |space: Space| border(space).data(&ring).into_iter().map(zeta).collect();
        let shape = match (&rules.guide, &rules.quadratic) {
            (Some(_), _) => Shape::Guide(size.sqrt()),
            (_, Some(_)) => Shape::Quadratic,
            _ => Shape::Fair,
        };
        let cap = CapRules::new(valence, space, shape, chi);
        Ok(Self { border: border(space), cap, kappa })
    }

    pub(super) fn space(&self) -> Space {
        self.cap.sector.space
    }

    /// The patches of all sectors for the hole behind `count` rings, in the frame of the rings.
    pub(super) fn patches<const N: usize>(&self, rings: &Rings<N>, count: usize) -> Vec<Patch<N>> {
        let net = rings.net(count);
        let data = self.data(rings, count, &net);
        let center = self.center(rings, &net);
        let of_sector = |s: usize| pieces(&self.cap.sector, &self.cap.coefs(s, &data, &center));
        let degree = self.space().degree;
        let coefs = (0..rings.valence()).flat_map(of_sector);
        coefs.map(|coefs| Patch::of([degree; 2], coefs)).collect()
    }

    /// The data of all sectors for a hole behind `count` rings.
    fn data<const N: usize>(
        &self,
        rings: &Rings<N>,
        count: usize,
        net: &[[f64; N]],
    ) -> Vec<[f64; N]> {
        let rules = rings.rules().rules();
        let ring = rings.frame_patches(count);
        let nodes = net.chunks(rules.nodes_per_sector);
        let sectors = ring.chunks(rules.patches_per_sector()).zip(nodes);
        let mut data = Vec::new();
        for (patches, nodes) in sectors {
            let coefs: Vec<Vec<[f64; N]>> = patches.iter().map(|p| p.coefs().to_vec()).collect();
            data.extend(self.border.data(&coefs));
            if rules.guide.is_some() {
                let first = rules.control_nodes_per_sector();
                data.extend(&nodes[first..first + guide_monomials().len()]);
            }
        }
        data
    }

    /// The data at the centre, as weights of x, y, x^2 + y^2, Re (x + iy)^2, Im (x + iy)^2.
    fn center<const N: usize>(
        &self,
        rings: &Rings<N>,
        net: &[[f64; N]],
    ) -> [[f64; N]; rules::PLANE_FUNCTIONS] {
        let (rules, subdominant) = (rings.rules().rules(), rings.rules().subdominant());
        let [along_x, along_y] = subdominant.tangential(net);
        let [x, y] = self.kappa;
        let sum = |v: f64, w: f64| {
            let mut sum = scale(v, along_x);
            add_scaled(&mut sum, w, along_y);
            sum
        };
        let (linear, zero) = ([sum(x, y), sum(-y, x)], [0.0; N]);
        let [radius, real, imaginary] = if rules.lambda_of_linear_terms().is_some() {
            let first = rules.control_nodes_per_sector() + 2;
            let terms = [net[first], net[first + 1], net[first + 2]];
            second_order(rules.valence, x * x + y * y, terms)
        } else {
            [zero; 3]
        };
        [linear[0], linear[1], radius, real, imaginary]
    }
}

/// Whether a cap has joints wherever the inner border of a ring has joints.
fn cuts_fit(rules: &Rules, space: Space) -> bool {
    let fits = |[_, [b0, b1]]: [[f64; 2]; 2]| {
        let at = b0 / rules.sigma() * space.pieces as f64;
        b1 > rules.sigma() + 1e-9 || (at - at.round()).abs() < 1e-9
    };
    domains(rules).into_iter().all(fits)
}

/// chi(1,0) turned by half a sector: chi over a coordinate whose real axis is the bisectrix of
/// sector 0 and in which chi(1,0) has distance 1. `ring` is sector 0 of the characteristic ring.
fn kappa(rules: &Rules, ring: &[Vec<Vector>]) -> Complex {
    let at_corner = domains(rules).iter().position(|[a, b]| a[1] > 1.0 - 1e-9 && b[0] == 0.0);
    let which = at_corner.expect("a ring reaches to a = 1 on its line");
    let [x, y, _] = ring[which][rules.degree * (rules.degree + 1)];
    let half = std::f64::consts::PI / rules.valence as f64;
    let (c, s) = (cosine(half), sine(half));
    [x * c - y * s, x * s + y * c]
}

/// gamma u^2 + delta u v + epsilon v^2 in sector 0, whose lines have unit length in coordinates
/// `size` = |kappa|^2 of ours, as weights of x^2 + y^2, Re (x + iy)^2, Im (x + iy)^2.
fn second_order<const N: usize>(
    n: usize,
    size: f64,
    [gamma, delta, epsilon]: [[f64; N]; 3],
) -> [[f64; N]; 3] {
    let half = std::f64::consts::PI / n as f64;
    // u = x / (2c) - y / (2s), v = x / (2c) + y / (2s)
    let (c, s) = (cosine(half), sine(half));
    let xx = size / (4.0 * c * c);
    let yy = size / (4.0 * s * s);
    let xy = size / (2.0 * c * s);
    std::array::from_fn(|k| {
        let combination = |k: usize, at: usize| {
            let (outer, inner) = (gamma[at] + epsilon[at], delta[at]);
            let (p, r) = (xx * (outer + inner), yy * (outer - inner));
            match k {
                0 => 0.5 * (p + r),
                1 => 0.5 * (p - r),
                _ => 0.5 * xy * (epsilon[at] - gamma[at]),
            }
        };
        std::array::from_fn(|at| combination(k, at))
    })
}
