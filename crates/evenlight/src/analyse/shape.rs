//! The shape of a surface around its extraordinary points, in a few numbers.
//!
//! What a smooth surface should not do is change its curvature to and fro. With H the mean
//! curvature, every extraordinary point gets three measures of that, beside the ranges of K and H:
//!
//! ```text
//!  1 +-+-+-+-+-+-+-+-+   rays: a fixed direction (a : b), from the outer border inwards;
//!    |   .     |   . |         here the one through (1, 1/2)
//!    +-+-+-+-+ | .   |
//!    |  .    | +     |   curves: max(a,b) = 1 (the outer border of ring 1), then 3/4, 1/2,
//!    |-+-+ | + |     |           3/8, 1/4, ...: two for every ring, around all sectors
//!    |.  |.| | |     |
//!    +-+-+-+-+-+-+-+-+--> a, line s-1
//!    0  1/4 1/2     1
//! ```
//!
//! - **Oscillation along rays.** With V(f) the total variation of f,
//!   `(V(H) - |H(end) - H(start)|) / k`, the mean over all rays: 0 if H rises or falls all the
//!   way on every ray; a bump of height h adds 2 h / k.
//! - **Oscillation around rings.** `max(0, V(H on a curve) - V(H on the outer border)) / k`, the
//!   largest over all curves. A saddle or a monkey saddle has lobes of H around its centre that
//!   nobody wants to smooth away; they are there on the outer border too, which the cage
//!   determines (all schemes agree on it up to second derivatives). What a curve has more than
//!   the border was made by the scheme. The best a surface can do is 0: the H of least energy
//!   (below) for its border values is harmonic, and the variation of a harmonic function does not
//!   grow from a circle to a smaller one, its Poisson kernel being positive.
//! - **Shape energy.** `E = integral |grad H|^2 dA` over rings 1 to [`ENERGY_RINGS`], with the
//!   gradient and the area of the surface itself. In 1/unit^2; meant to be divided by that of
//!   another scheme over the same cage.
//!
//! k is the curvature scale of the point, the largest absolute principal curvature on the outer
//! border of ring 1, so that the oscillations depend neither on the unit nor on the scheme. Where
//! the border is flat (and with it all of the net: the border's second derivatives determine it)
//! both are 0.
//!
//! All measures are invariant under rigid motions and, but for the unit of E, under scaling.
//! Finite differences occur nowhere: H is exact at any depth ([`Rings::eval`]), and its gradient
//! comes from the third derivatives of the polynomials.

use super::curvature::{Range, RingCurvature, curvature_over};
use crate::patch::{Jet, Patch, SurfacePoint};
use crate::point::{Vector, add, cross, dot, norm, scale, sub};
use crate::quadrature::GAUSS_6;
use crate::rings::{MAX_RINGS, Rings};
use crate::surface::{ExtraordinaryPoint, PatchPlace, Role, Surface};
use crate::task::map_indexed;

/// The rings, counted from the outermost, over which the shape energy is taken.
///
/// Four of them hold all that can be seen. Further in, the energy of schemes with unbounded
/// curvature grows without end, and says more about their spectrum than about shape.
pub const ENERGY_RINGS: usize = 4;

/// Rays in each sector: the direction of line s-1, seven inside; line s belongs to the next.
const RAYS: usize = 8;

/// Samples of H per ring along a ray.
const RAY_STEPS: usize = 16;

/// Samples of H per side (two in each sector) along a curve.
const CURVE_STEPS: usize = 32;

/// A point counts as flat if its curvature scale times its extent is below this: planar cages
/// leave less than 1e-12 there, those read from files with 9 digits up to 1e-8, and H is noise
/// then.
const FLAT: f64 = 1e-7;

/// The measures of one extraordinary point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointShape {
    /// The index into [`Surface::extraordinary_points`].
    pub point: usize,
    /// The ranges of K and H over all rings asked for.
    pub curvature: RingCurvature,
    /// The curvature scale k: the largest absolute principal curvature on the outer border of
    /// ring 1, in 1/unit. The same for all schemes; 0 where the net is flat.
    pub scale: f64,
    /// Oscillation of H along rays over the rings asked for, as a multiple of `scale`; >= 0.
    pub along_rays: f64,
    /// Oscillation of H around the rings asked for, as a multiple of `scale`; >= 0.
    pub around_rings: f64,
    /// The shape energy E over the first [`ENERGY_RINGS`] rings, in 1/unit^2; >= 0.
    pub energy: f64,
}

/// Measures every extraordinary point over rings 1 to `rings` (the energy over its own number).
///
/// Only sectors with a surface count. Where a surface has no normal (a cusp, or derivatives that
/// are parallel) its curvature is passed over. Takes some 500 evaluations per sector and ring.
///
/// E is exact to about 1e-6 by its quadrature; the oscillations miss what lies between samples,
/// about 1 % of a bump.
///
/// ```
/// use evenlight::analyse::shape::shape;
/// use evenlight::{Cage, Mesh, SchemeKind, Surface, SurfaceOptions};
///
/// // The cube: eight points of valence 3, all alike.
/// let corner = |k: u32| [k & 1, k >> 1 & 1, k >> 2].map(|x| 2.0 * f64::from(x) - 1.0);
/// let faces: [[u32; 4]; 6] =
///     [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
/// let cube = Cage::new(Mesh::new((0..8).map(corner).collect(), faces)).unwrap();
/// let options = SurfaceOptions { scheme: SchemeKind::Qas4, ..SurfaceOptions::default() };
/// let points = shape(&Surface::build(cube, options).unwrap(), 6);
/// assert_eq!(points.len(), 8);
/// assert!(points[0].curvature.mean.max < 0.0, "convex everywhere");
/// assert!((points[0].energy / points[7].energy - 1.0).abs() < 1e-9);
/// ```
pub fn shape(surface: &Surface, rings: usize) -> Vec<PointShape> {
    let rings = rings.min(MAX_RINGS);
    let points = surface.extraordinary_points();
    let mut places: Vec<Vec<PatchPlace>> = vec![Vec::new(); points.len()];
    for place in surface.patch_places(rings.max(ENERGY_RINGS)) {
        if let Some(point) = place.point {
            places[point].push(place);
        }
    }
    map_indexed(points.len(), |point| {
        let around = Around { rings: surface.rings_at(point), point: &points[point] };
        let (scale, along_rays, around_rings) = around.oscillations(rings);
        let (curvature, energy) = over_patches(surface, &places[point], rings);
        PointShape { point, curvature, scale, along_rays, around_rings, energy }
    })
}

/// The curvature ranges over the first `rings` rings, and the shape energy.
fn over_patches(surface: &Surface, places: &[PatchPlace], rings: usize) -> (RingCurvature, f64) {
    let mut curvature = RingCurvature { gauss: Range::EMPTY, mean: Range::EMPTY };
    let mut energy = 0.0;
    for place in places {
        let Role::Ring(ring) = place.role else { continue };
        if ring < rings {
            let found = curvature_over(surface, place);
            curvature.gauss = curvature.gauss.union(found.gauss);
            curvature.mean = curvature.mean.union(found.mean);
        }
        if ring < ENERGY_RINGS {
            energy += shape_energy(&surface.patch_at(place));
        }
    }
    (curvature, energy)
}

/// The sectors with a surface around a point.
#[derive(Clone, Copy)]
struct Around<'a> {
    rings: &'a Rings,
    point: &'a ExtraordinaryPoint,
}

impl Around<'_> {
    fn eval(self, s: usize, a: f64, b: f64) -> SurfacePoint {
        self.rings.eval_as(s, a, b)
    }

    /// The curvature scale and the oscillations along rays and around rings.
    fn oscillations(self, rings: usize) -> (f64, f64, f64) {
        let (scale, extent) = self.scale_and_extent();
        let is_curved = scale * extent >= FLAT; // not if either is NaN
        if !is_curved {
            return (0.0, 0.0, 0.0);
        }
        let rays: Vec<f64> = self.rays(rings).map(|h| oscillation(&h)).collect();
        let along_rays = rays.iter().sum::<f64>() / rays.len() as f64;
        let on_border = self.variation_around(1.0);
        let sigma = self.rings.sigma();
        let radii = (0..2 * rings).map(|k| radius(sigma, k / 2, 0.5 * (k % 2 + 1) as f64));
        let largest = radii.map(|r| self.variation_around(r)).fold(on_border, f64::max);
        (scale, along_rays / scale, (largest - on_border) / scale)
    }

    /// The largest absolute principal curvature on the outer border, and the largest distance of
    /// the border from the limit point.
    fn scale_and_extent(self) -> (f64, f64) {
        let (mut largest, mut extent) = (0.0_f64, 0.0_f64);
        for p in self.arcs(1.0).flatten() {
            let [k1, k2] = p.principal_curvatures();
            largest = largest.max(k1.abs()).max(k2.abs());
            extent = extent.max(norm(sub(p.jet.p, self.rings.center())));
        }
        (largest, extent)
    }

    /// H along every ray, from the outer border inwards.
    fn rays(self, rings: usize) -> impl Iterator<Item = Vec<f64>> {
        let sectors = self.point.sectors.iter().map(|sector| sector.index);
        sectors.flat_map(|s| (0..RAYS).map(move |k| (s, k))).map(move |(s, k)| {
            let [a, b] = on_corner(k as f64 / RAYS as f64);
            let steps = (0..=rings * RAY_STEPS).map(|step| {
                let part = (step % RAY_STEPS) as f64 / RAY_STEPS as f64;
                radius(self.rings.sigma(), step / RAY_STEPS, part)
            });
            known(steps.map(|r| self.eval(s, r * a, r * b).mean))
        })
    }

    /// The total variation of H on the curve max(a,b) = r.
    fn variation_around(self, r: f64) -> f64 {
        self.arcs(r).map(|arc| variation(&known(arc.map(|p| p.mean)))).sum()
    }

    /// The surface along the curve max(a,b) = r, from line to line in every sector.
    fn arcs(self, r: f64) -> impl Iterator<Item = impl Iterator<Item = SurfacePoint>> {
        self.point.sectors.iter().map(move |sector| {
            (0..=2 * CURVE_STEPS).map(move |k| {
                let [a, b] = on_corner(k as f64 / (2 * CURVE_STEPS) as f64);
                self.eval(sector.index, r * a, r * b)
            })
        })
    }
}

/// The point at `t` in [0,1] of the way (1,0) - (1,1) - (0,1).
fn on_corner(t: f64) -> [f64; 2] {
    if t < 0.5 { [1.0, 2.0 * t] } else { [2.0 - 2.0 * t, 1.0] }
}

/// The radius at `part` in [0,1] of the way through a ring: (1 - part (1 - sigma)) sigma^ring.
fn radius(sigma: f64, ring: usize, part: f64) -> f64 {
    (0..ring).fold(1.0 - part * (1.0 - sigma), |r, _| sigma * r)
}

/// The values that are numbers.
fn known(values: impl Iterator<Item = f64>) -> Vec<f64> {
    values.filter(|value| value.is_finite()).collect()
}

/// The total variation of a sequence.
fn variation(values: &[f64]) -> f64 {
    values.windows(2).map(|pair| (pair[1] - pair[0]).abs()).sum()
}

/// How much more a sequence goes up and down than from its start to its end.
fn oscillation(values: &[f64]) -> f64 {
    match values {
        [first, .., last] => (variation(values) - (last - first).abs()).max(0.0),
        _ => 0.0,
    }
}

/// The integral of |grad H|^2 dA over a patch, in 1/unit^2, by 6 x 6 points of Gauss's quadrature;
/// points without a normal are left out.
///
/// Exact to about 1e-6 on the patches of rings (1e-5 where one patch bends as much as in the
/// example); rounding adds 1e-14 of the ratio of coordinates to the patch's size.
///
/// ```
/// use evenlight::analyse::shape::shape_energy;
/// use evenlight::patch::Patch;
///
/// // The parabolic cylinder (u, v, u^2), for 0 <= u <= 1/2: with sin t = 2 u / sqrt(1 + 4 u^2)
/// // the integral is that of 18 sin^2 t cos^7 t dt, so with s = sin t = 1/sqrt(2) at the end
/// let s = 0.5_f64.sqrt();
/// let exact = s.powi(3) * (6.0 - 54.0 / 10.0 + 27.0 / 14.0 - 0.25);
/// let rows = [[0.0, 0.0], [0.25, 0.0], [0.5, 0.25]];
/// let coefs = rows.iter().flat_map(|&[x, z]| [[x, 0.0, z], [x, 1.0, z]]);
/// let found = shape_energy(&Patch::new([2, 1], coefs.collect())?);
/// assert!((found / exact - 1.0).abs() < 1e-4);
/// # Ok::<(), evenlight::patch::PatchError>(())
/// ```
pub fn shape_energy(patch: &Patch) -> f64 {
    integral_of_squared_gradient(patch, mean_derivative)
}

/// The integral of |grad K|^2 dA over a patch, in 1/unit^4, likewise.
///
/// ```
/// use evenlight::analyse::shape::gauss_energy;
/// use evenlight::patch::Patch;
///
/// // A cylinder has K = 0.
/// let rows = [[0.0, 0.0], [0.25, 0.0], [0.5, 0.25]];
/// let coefs = rows.iter().flat_map(|&[x, z]| [[x, 0.0, z], [x, 1.0, z]]);
/// assert!(gauss_energy(&Patch::new([2, 1], coefs.collect())?) < 1e-25);
/// # Ok::<(), evenlight::patch::PatchError>(())
/// ```
pub fn gauss_energy(patch: &Patch) -> f64 {
    integral_of_squared_gradient(patch, gauss_derivative)
}

/// The derivative of a curvature in one parameter, from the jet of r and from the derivatives of
/// r_u, r_v and of r_uu, r_uv, r_vv in that parameter.
type CurvatureDerivative = fn(&Jet, [Vector; 2], [Vector; 3]) -> f64;

fn integral_of_squared_gradient(patch: &Patch, by: CurvatureDerivative) -> f64 {
    let derivatives = [0, 1].map(|parameter| derivative(patch, parameter));
    let mut sum = 0.0;
    for (u, wu) in GAUSS_6 {
        for (v, wv) in GAUSS_6 {
            let jets = derivatives.each_ref().map(|p| p.jet(u, v));
            let density = energy_density(&patch.jet(u, v), &jets, by);
            if density.is_finite() {
                sum += wu * wv * density;
            }
        }
    }
    sum
}

/// The derivative of a patch in parameter 0 or 1, which has differences of BB coefficients as
/// its coefficients.
fn derivative(patch: &Patch, parameter: usize) -> Patch {
    let mut degree = patch.degree();
    let factor = degree[parameter] as f64;
    if degree[parameter] == 0 {
        return Patch::of(degree, vec![[0.0; 3]; patch.coefs().len()]);
    }
    degree[parameter] -= 1;
    let step = [1 - parameter, parameter];
    let coef = |k: usize| {
        let (i, j) = (k / (degree[1] + 1), k % (degree[1] + 1));
        scale(factor, sub(patch.at(i + step[0], j + step[1]), patch.at(i, j)))
    };
    Patch::of(degree, (0..(degree[0] + 1) * (degree[1] + 1)).map(coef).collect())
}

/// |grad H|^2 |r_u x r_v|, or the same of K, from the jets of r and its derivatives [r_u, r_v].
///
/// With the gradient in coordinates, |grad H|^2 = (G H_u^2 - 2 F H_u H_v + E H_v^2) / w^2.
fn energy_density(r: &Jet, [ru, rv]: &[Jet; 2], by: CurvatureDerivative) -> f64 {
    let h_u = by(r, [r.duu, r.duv], [ru.duu, ru.duv, ru.dvv]);
    let h_v = by(r, [r.duv, r.dvv], [rv.duu, rv.duv, rv.dvv]);
    let (e, f, g) = (dot(r.du, r.du), dot(r.du, r.dv), dot(r.dv, r.dv));
    (g * h_u * h_u - 2.0 * f * h_u * h_v + e * h_v * h_v) / norm(cross(r.du, r.dv))
}

/// The derivative of H in one parameter, from those of r_u, r_v and of r_uu, r_uv, r_vv in it.
///
/// ```text
/// H = P / (2 w^3),   P = E D_vv - 2 F D_uv + G D_uu,   D_xy = a . r_xy,   a = r_u x r_v,  w = |a|,
/// H' = P' / (2 w^3) - 3 P (a . a') / (2 w^5).
/// ```
fn mean_derivative(r: &Jet, first: [Vector; 2], second: [Vector; 3]) -> f64 {
    let a = cross(r.du, r.dv);
    let a_ = add(cross(first[0], r.dv), cross(r.du, first[1]));
    let w2 = dot(a, a);
    let [e, f, g] = [dot(r.du, r.du), dot(r.du, r.dv), dot(r.dv, r.dv)];
    let e_ = 2.0 * dot(r.du, first[0]);
    let f_ = dot(first[0], r.dv) + dot(r.du, first[1]);
    let g_ = 2.0 * dot(r.dv, first[1]);
    let d = [r.duu, r.duv, r.dvv].map(|x| dot(a, x));
    let d_: [f64; 3] =
        std::array::from_fn(|k| dot(a_, [r.duu, r.duv, r.dvv][k]) + dot(a, second[k]));
    let p = e * d[2] - 2.0 * f * d[1] + g * d[0];
    let p_ = e_ * d[2] + e * d_[2] - 2.0 * (f_ * d[1] + f * d_[1]) + g_ * d[0] + g * d_[0];
    (p_ - 3.0 * p * dot(a, a_) / w2) / (2.0 * w2 * w2.sqrt())
}

/// The derivative of K likewise.
///
/// ```text
/// K = P / w^4,   P = D_uu D_vv - D_uv^2,   K' = P' / w^4 - 4 P (a . a') / w^6.
/// ```
fn gauss_derivative(r: &Jet, first: [Vector; 2], second: [Vector; 3]) -> f64 {
    let a = cross(r.du, r.dv);
    let a_ = add(cross(first[0], r.dv), cross(r.du, first[1]));
    let w2 = dot(a, a);
    let of_r = [r.duu, r.duv, r.dvv];
    let d = of_r.map(|x| dot(a, x));
    let d_: [f64; 3] = std::array::from_fn(|k| dot(a_, of_r[k]) + dot(a, second[k]));
    let p = d[0] * d[2] - d[1] * d[1];
    let p_ = d_[0] * d[2] + d[0] * d_[2] - 2.0 * d[1] * d_[1];
    (p_ - 4.0 * p * dot(a, a_) / w2) / (w2 * w2)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A doubly curved patch without any symmetry, its normals far from parallel.
    fn crooked() -> Patch {
        let coef = |k: usize| {
            let (i, j) = ((k / 5) as f64, (k % 5) as f64);
            let wave = |d: usize| (1.7 * k as f64 + 2.3 * d as f64).sin();
            [i + 0.3 * wave(0), j + 0.3 * wave(1), wave(2)]
        };
        Patch::of([4, 4], (0..25).map(coef).collect())
    }

    #[test]
    fn the_gradients_of_curvatures_are_their_difference_quotients() {
        let patch = crooked();
        let [ru, rv] = [0, 1].map(|parameter| derivative(&patch, parameter));
        let curvatures = |u: f64, v: f64| -> [f64; 2] { patch.jet(u, v).curvature().into() };
        let of: [CurvatureDerivative; 2] = [gauss_derivative, mean_derivative];
        let h = 1e-4;
        for (u, v) in [(0.1, 0.2), (0.5, 0.5), (0.9, 0.3), (0.25, 0.8)] {
            let (r, ru, rv) = (patch.jet(u, v), ru.jet(u, v), rv.jet(u, v));
            for (k, by) in of.into_iter().enumerate() {
                let by_u = by(&r, [r.duu, r.duv], [ru.duu, ru.duv, ru.dvv]);
                let by_v = by(&r, [r.duv, r.dvv], [rv.duu, rv.duv, rv.dvv]);
                let quotients = [
                    (curvatures(u + h, v)[k] - curvatures(u - h, v)[k]) / (2.0 * h),
                    (curvatures(u, v + h)[k] - curvatures(u, v - h)[k]) / (2.0 * h),
                ];
                for (exact, quotient) in [by_u, by_v].into_iter().zip(quotients) {
                    assert!((exact - quotient).abs() < 1e-5 * (1.0 + exact.abs()), "({u}, {v})");
                }
            }
        }
    }

    #[test]
    fn the_energy_does_not_depend_on_the_parameters() {
        let patch = crooked();
        let energy = shape_energy(&patch);
        let sheared = |k: usize| patch.at(4 - k % 5, k / 5); // u' = v, v' = 1 - u
        let turned = Patch::of([4, 4], (0..25).map(sheared).collect());
        assert!((shape_energy(&turned) / energy - 1.0).abs() < 1e-13);
        let larger = patch.coefs().iter().map(|&p| add(scale(3.0, p), [1.0, -2.0, 5.0]));
        let larger = Patch::of([4, 4], larger.collect());
        assert!((shape_energy(&larger) * 9.0 / energy - 1.0).abs() < 1e-11);
    }

    #[test]
    fn planes_and_degenerate_patches_have_no_energy() {
        let plane = |k: usize| [(k / 4) as f64, (k % 4) as f64, 0.5 * (k % 4) as f64];
        assert!(shape_energy(&Patch::of([3, 3], (0..16).map(plane).collect())) < 1e-25);
        assert_eq!(shape_energy(&Patch::of([3, 3], vec![[1.0, 2.0, 3.0]; 16])), 0.0);
    }

    #[test]
    fn monotone_sequences_do_not_oscillate_and_bumps_count_twice() {
        assert_eq!(oscillation(&[]), 0.0);
        assert_eq!(oscillation(&[3.0]), 0.0);
        assert_eq!(oscillation(&[3.0, 2.0, 2.0, -1.0]), 0.0);
        assert_eq!(oscillation(&[0.0, 1.0, 2.0, 1.5, 4.0]), 1.0);
        assert_eq!(variation(&[0.0, 2.0, 0.0]), 4.0);
    }

    #[test]
    fn rays_and_curves_are_laid_as_drawn() {
        assert_eq!(
            [0.0, 0.25, 0.5, 0.75, 1.0].map(on_corner),
            [[1.0, 0.0], [1.0, 0.5], [1.0, 1.0], [0.5, 1.0], [0.0, 1.0]]
        );
        let radii = [(0, 0.5), (0, 1.0), (1, 0.5), (1, 1.0)].map(|(k, x)| radius(0.5, k, x));
        assert_eq!(radii, [0.75, 0.5, 0.375, 0.25]);
        assert_eq!([(1, 0.0), (1, 1.0)].map(|(k, x)| radius(0.25, k, x)), [0.25, 0.0625]);
    }
}
