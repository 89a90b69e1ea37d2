//! Gauss's quadrature on [0,1]: the integral of f is about the sum of w f(x) over nodes x with
//! weights w. With n nodes it is exact for polynomials up to degree 2n - 1.
//!
//! The nodes are the zeros of the Legendre polynomial P_n, moved from [-1,1] to [0,1]; the tests
//! compute them.

/// A node and its weight.
pub(crate) type Node = (f64, f64);

/// Four nodes; exact up to degree 7.
pub(crate) const GAUSS_4: [Node; 4] = [
    (0.069_431_844_202_973_71, 0.173_927_422_568_726_93),
    (0.330_009_478_207_571_87, 0.326_072_577_431_273_07),
    (0.669_990_521_792_428_1, 0.326_072_577_431_273_07),
    (0.930_568_155_797_026_3, 0.173_927_422_568_726_93),
];

/// Six nodes; exact up to degree 11.
pub(crate) const GAUSS_6: [Node; 6] = [
    (0.033_765_242_898_423_99, 0.085_662_246_189_585_17),
    (0.169_395_306_766_867_74, 0.180_380_786_524_069_3),
    (0.380_690_406_958_401_55, 0.233_956_967_286_345_52),
    (0.619_309_593_041_598_5, 0.233_956_967_286_345_52),
    (0.830_604_693_233_132_3, 0.180_380_786_524_069_3),
    (0.966_234_757_101_576, 0.085_662_246_189_585_17),
];

/// Seven nodes; exact up to degree 13.
pub(crate) const GAUSS_7: [Node; 7] = [
    (0.025_446_043_828_620_757, 0.064_742_483_084_434_84),
    (0.129_234_407_200_302_77, 0.139_852_695_744_638_35),
    (0.297_077_424_311_301_4, 0.190_915_025_252_559_52),
    (0.5, 0.208_979_591_836_734_7),
    (0.702_922_575_688_698_5, 0.190_915_025_252_559_52),
    (0.870_765_592_799_697_2, 0.139_852_695_744_638_35),
    (0.974_553_956_171_379_2, 0.064_742_483_084_434_84),
];

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [&[Node]; 3] = [&GAUSS_4, &GAUSS_6, &GAUSS_7];

    /// P_n(x) and its derivative.
    fn legendre(n: usize, x: f64) -> (f64, f64) {
        let (mut before, mut value) = (1.0, x);
        for k in (2..=n).map(|k| k as f64) {
            (before, value) = (value, ((2.0 * k - 1.0) * x * value - (k - 1.0) * before) / k);
        }
        (value, n as f64 * (x * value - before) / (x * x - 1.0))
    }

    #[test]
    fn nodes_are_zeros_of_legendre_polynomials() {
        for nodes in ALL {
            for &(x, w) in nodes {
                let x = 2.0 * x - 1.0;
                let (value, slope) = legendre(nodes.len(), x);
                assert!((value / slope).abs() < 1e-15, "{} nodes: {x}", nodes.len());
                assert!((w * (1.0 - x * x) * slope * slope - 1.0).abs() < 1e-14, "{x}");
            }
        }
    }

    #[test]
    fn polynomials_are_integrated_exactly() {
        for nodes in ALL {
            for k in 0..2 * nodes.len() as i32 {
                let sum: f64 = nodes.iter().map(|&(x, w)| w * x.powi(k)).sum();
                assert!((sum * f64::from(k + 1) - 1.0).abs() < 1e-14, "{} nodes: {k}", nodes.len());
            }
        }
    }
}
