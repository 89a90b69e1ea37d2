//! What a surface can be asked for: position, derivatives, normal and curvature.

use super::jet::{FirstJet, Jet, Shape, SurfacePoint};
use crate::point::Point;

/// What is wanted at a place of a surface; nothing is computed that the type does not hold.
///
/// | type | |
/// | --- | --- |
/// | [`Point`] | position |
/// | [`FirstJet`] | and first derivatives |
/// | [`Jet`] | and second derivatives |
/// | [`SurfacePoint`] | and unit normal and curvature |
///
/// The numbers that two of them have in common are the same bits. There are no other
/// implementations.
pub trait Answer: Copy + Send + Sync + Parts {
    /// NaN everywhere: the answer where there is no surface.
    const NAN: Self;
}

/// How an answer is made; not to be named outside.
pub trait Parts {
    /// The highest order of derivatives that it holds.
    const ORDER: usize;

    /// From derivatives up to that order, and the shape if it is wanted.
    fn from_parts(jet: Jet, shape: impl FnOnce(&Jet) -> Shape) -> Self;

    /// The answer in other parameters: `change` knows what they do to derivatives.
    fn in_parameters(self, change: impl FnOnce(&Jet) -> Jet) -> Self;
}

const NAN: Point = [f64::NAN; 3];

impl Answer for Point {
    const NAN: Self = NAN;
}

impl Parts for Point {
    const ORDER: usize = 0;

    #[inline(always)]
    fn from_parts(jet: Jet, _: impl FnOnce(&Jet) -> Shape) -> Self {
        jet.p
    }

    #[inline(always)]
    fn in_parameters(self, _: impl FnOnce(&Jet) -> Jet) -> Self {
        self
    }
}

impl Answer for FirstJet {
    const NAN: Self = Self { p: NAN, du: NAN, dv: NAN };
}

impl Parts for FirstJet {
    const ORDER: usize = 1;

    #[inline(always)]
    fn from_parts(jet: Jet, _: impl FnOnce(&Jet) -> Shape) -> Self {
        Self { p: jet.p, du: jet.du, dv: jet.dv }
    }

    #[inline(always)]
    fn in_parameters(self, change: impl FnOnce(&Jet) -> Jet) -> Self {
        let jet = change(&Jet { p: self.p, du: self.du, dv: self.dv, ..Jet::default() });
        Self { p: jet.p, du: jet.du, dv: jet.dv }
    }
}

impl Answer for Jet {
    const NAN: Self = Self { p: NAN, du: NAN, dv: NAN, duu: NAN, duv: NAN, dvv: NAN };
}

impl Parts for Jet {
    const ORDER: usize = 2;

    #[inline(always)]
    fn from_parts(jet: Jet, _: impl FnOnce(&Jet) -> Shape) -> Self {
        jet
    }

    #[inline(always)]
    fn in_parameters(self, change: impl FnOnce(&Jet) -> Jet) -> Self {
        change(&self)
    }
}

impl Answer for SurfacePoint {
    const NAN: Self =
        Self { jet: <Jet as Answer>::NAN, normal: NAN, gauss: f64::NAN, mean: f64::NAN };
}

impl Parts for SurfacePoint {
    const ORDER: usize = 2;

    #[inline(always)]
    fn from_parts(jet: Jet, shape: impl FnOnce(&Jet) -> Shape) -> Self {
        let Shape { normal, gauss, mean } = shape(&jet);
        Self { jet, normal, gauss, mean }
    }

    #[inline(always)]
    fn in_parameters(self, change: impl FnOnce(&Jet) -> Jet) -> Self {
        Self { jet: change(&self.jet), ..self }
    }
}
