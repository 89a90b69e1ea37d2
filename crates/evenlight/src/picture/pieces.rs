//! Which polynomial patch a parameter belongs to.
//!
//! A sector of an extraordinary point at (a,b) = (0,0) is an infinite sequence of rings, each
//! half (in general: sigma times) as wide as the one before and cut in the same way:
//!
//! ```text
//!  b=1 +-------+-------+
//!      |       |       |
//!      | ring 1| ring 1|      ring k: 2^-k <= max(a,b) <= 2^(1-k)
//!      +---+---+-------+
//!      |   | 2 |       |
//!      +-+-+---+ ring 1|      (a,b) in ring k is patch (2^(k-1) a, 2^(k-1) b) of ring 1
//!      |.|3| 2 |       |
//!      +-+-+---+-------+ a=1
//! ```
//!
//! so that the patches of ring 1 tell all others. Caps come before rings.

use crate::surface::{Role, Sector, Surface};

/// Rings beyond this number are counted as this one.
const LAST_RING: usize = 60;

/// Slack for parameters on a border, far above rounding and far below a pixel.
const EPSILON: f64 = 1e-12;

/// A rectangle of parameters: [[u0, u1], [v0, v1]].
type Domain = [[f64; 2]; 2];

/// A patch: what it is part of, and its rectangle in the parametric quad.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Piece {
    pub role: Role,
    pub domain: Domain,
}

/// The patches of a surface by parametric quad.
#[derive(Debug)]
pub(super) struct Pieces {
    quads: Vec<QuadPieces>,
}

/// The patches of one parametric quad; sectors with the sigma of their rings.
#[derive(Clone, Debug, Default)]
struct QuadPieces {
    regular: Vec<Domain>,
    sectors: Vec<(Sector, f64)>,
    first_ring: Vec<Domain>,
    caps: Vec<Domain>,
}

impl Pieces {
    /// Collects the patches of `surface`.
    pub fn of(surface: &Surface) -> Self {
        let mut quads = vec![QuadPieces::default(); surface.num_quads()];
        let rings = surface.cap_options().map_or(1, |cap| cap.rings.max(1));
        for patch in surface.patch_places(rings) {
            let quad = &mut quads[patch.quad.0 as usize];
            match patch.role {
                Role::Regular => quad.regular.push(patch.domain),
                Role::Ring(1) => quad.first_ring.push(patch.domain),
                Role::Ring(_) => {}
                Role::Cap => quad.caps.push(patch.domain),
            }
        }
        for (k, point) in surface.extraordinary_points().iter().enumerate() {
            let sigma = surface.rings_at(k).sigma();
            for &sector in &point.sectors {
                quads[sector.quad.0 as usize].sectors.push((sector, sigma));
            }
        }
        Self { quads }
    }

    /// The patch of (u,v) in parametric quad number `quad`; one of them on a common border,
    /// `None` at an extraordinary point itself.
    pub fn at(&self, quad: u32, uv: [f64; 2]) -> Option<Piece> {
        let quad = &self.quads[quad as usize];
        let listed = |role: Role, domains: &[Domain]| {
            let found = domains.iter().find(|domain| contains(domain, uv));
            found.map(|&domain| Piece { role, domain })
        };
        let found = listed(Role::Regular, &quad.regular).or_else(|| listed(Role::Cap, &quad.caps));
        found.or_else(|| quad.ring_piece(uv))
    }
}

impl QuadPieces {
    /// The patch of a ring that `uv` is in.
    fn ring_piece(&self, uv: [f64; 2]) -> Option<Piece> {
        self.sectors.iter().find_map(|(sector, sigma)| {
            let ring = ring_number(sector, *sigma, uv)?;
            let factor = sigma.powi(1 - ring as i32);
            let scaled =
                |t: f64, k: usize, factor: f64| sector.center[k] + factor * (t - sector.center[k]);
            let in_first = [scaled(uv[0], 0, factor), scaled(uv[1], 1, factor)];
            let first = self.first_ring.iter().find(|domain| contains(domain, in_first))?;
            let domain = std::array::from_fn(|k| first[k].map(|t| scaled(t, k, 1.0 / factor)));
            Some(Piece { role: Role::Ring(ring), domain })
        })
    }
}

/// The ring of `sector` that `uv` is in; `None` outside the sector and at its centre.
fn ring_number(sector: &Sector, sigma: f64, uv: [f64; 2]) -> Option<usize> {
    let step = [uv[0] - sector.center[0], uv[1] - sector.center[1]];
    let [a, b] = sector.along.map(|line| {
        (step[0] * line[0] + step[1] * line[1]) / (line[0] * line[0] + line[1] * line[1])
    });
    let outside = a < -EPSILON || b < -EPSILON || a.max(b) > 1.0 + EPSILON;
    let mut largest = a.max(b);
    if outside || largest <= 0.0 {
        return None;
    }
    let mut ring = 1;
    while largest <= sigma && ring < LAST_RING {
        largest /= sigma;
        ring += 1;
    }
    Some(ring)
}

/// Whether `uv` is in `domain` or on its border.
fn contains(domain: &Domain, uv: [f64; 2]) -> bool {
    (0..2).all(|k| domain[k][0] - EPSILON <= uv[k] && uv[k] <= domain[k][1] + EPSILON)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::QuadId;

    /// A quad whose corner (1,0) is an extraordinary point with a sector of half its width; the
    /// other three quarters are regular.
    fn quad() -> Pieces {
        let (left, right, low, high) = ([0.0, 0.5], [0.5, 1.0], [0.0, 0.5], [0.5, 1.0]);
        let sector = Sector {
            quad: QuadId(0),
            index: 0,
            center: [1.0, 0.0],
            along: [[0.0, 0.5], [-0.5, 0.0]],
        };
        let (near, far) = ([0.75, 1.0], [0.5, 0.75]);
        let quad = QuadPieces {
            regular: vec![[left, low], [left, high], [right, high]],
            sectors: vec![(sector, 0.5)],
            first_ring: vec![[near, [0.25, 0.5]], [far, [0.25, 0.5]], [far, [0.0, 0.25]]],
            caps: Vec::new(),
        };
        Pieces { quads: vec![quad] }
    }

    #[test]
    fn every_parameter_is_in_the_piece_that_is_found_for_it() {
        for i in 0..=100 {
            for j in 0..=100 {
                let uv = [0.01 * f64::from(i), 0.01 * f64::from(j)];
                match quad().at(0, uv) {
                    Some(piece) => assert!(contains(&piece.domain, uv), "{piece:?} at {uv:?}"),
                    None => assert_eq!(uv, [1.0, 0.0]),
                }
            }
        }
    }

    #[test]
    fn rings_are_halved_copies_of_the_first() {
        let role = |u, v| quad().at(0, [u, v]).map(|piece| piece.role);
        assert_eq!(role(0.2, 0.2), Some(Role::Regular));
        assert_eq!(role(0.6, 0.1), Some(Role::Ring(1)));
        assert_eq!(role(0.9, 0.2), Some(Role::Ring(2)));
        assert_eq!(role(1.0 - 0.4 / 64.0, 0.0), Some(Role::Ring(7)));
        let piece = quad().at(0, [0.8, 0.1]).unwrap();
        assert_eq!(piece, Piece { role: Role::Ring(2), domain: [[0.75, 0.875], [0.0, 0.125]] });
    }
}
