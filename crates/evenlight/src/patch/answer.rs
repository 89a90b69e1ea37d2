//! What a surface can be asked for: position, derivatives, normal and curvature.

use super::jet::{FirstJet, Jet, Shape, SurfacePoint};

/// The answer for a place of a surface. Only the numbers that the type holds are computed.
///
/// | type | |
/// | --- | --- |
/// | `[f64; N]` | position, or value |
/// | [`FirstJet`] | and first derivatives |
/// | [`Jet`] | and second derivatives |
/// | [`SurfacePoint`] | and unit normal and curvature, N = 3 only |
///
/// A number that two of these types hold has the same bits in both. There are no other
/// implementations.
pub trait Answer<const N: usize = 3>: Copy + Send + Sync + Parts<N> {
    /// NaN everywhere: the answer where there is no surface.
    const NAN: Self;
}

/// How an answer is made. Users of the library cannot name this trait.
pub trait Parts<const N: usize = 3> {
    /// The highest order of derivatives that it holds.
    const ORDER: usize;

    /// The answer from derivatives up to that order, and from the shape if the answer holds it.
    fn from_parts(jet: Jet<N>, shape: impl FnOnce(&Jet<N>) -> Shape) -> Self;

    /// The answer in other parameters: `change` knows what they do to derivatives.
    fn in_parameters(self, change: impl FnOnce(&Jet<N>) -> Jet<N>) -> Self;
}

impl<const N: usize> Answer<N> for [f64; N] {
    const NAN: Self = [f64::NAN; N];
}

impl<const N: usize> Parts<N> for [f64; N] {
    const ORDER: usize = 0;

    #[inline(always)]
    fn from_parts(jet: Jet<N>, _: impl FnOnce(&Jet<N>) -> Shape) -> Self {
        jet.p
    }

    #[inline(always)]
    fn in_parameters(self, _: impl FnOnce(&Jet<N>) -> Jet<N>) -> Self {
        self
    }
}

impl<const N: usize> Answer<N> for FirstJet<N> {
    const NAN: Self = Self { p: [f64::NAN; N], du: [f64::NAN; N], dv: [f64::NAN; N] };
}

impl<const N: usize> Parts<N> for FirstJet<N> {
    const ORDER: usize = 1;

    #[inline(always)]
    fn from_parts(jet: Jet<N>, _: impl FnOnce(&Jet<N>) -> Shape) -> Self {
        Self { p: jet.p, du: jet.du, dv: jet.dv }
    }

    #[inline(always)]
    fn in_parameters(self, change: impl FnOnce(&Jet<N>) -> Jet<N>) -> Self {
        let jet = change(&Jet { p: self.p, du: self.du, dv: self.dv, ..Jet::default() });
        Self { p: jet.p, du: jet.du, dv: jet.dv }
    }
}

impl<const N: usize> Answer<N> for Jet<N> {
    const NAN: Self = {
        let nan = [f64::NAN; N];
        Self { p: nan, du: nan, dv: nan, duu: nan, duv: nan, dvv: nan }
    };
}

impl<const N: usize> Parts<N> for Jet<N> {
    const ORDER: usize = 2;

    #[inline(always)]
    fn from_parts(jet: Jet<N>, _: impl FnOnce(&Jet<N>) -> Shape) -> Self {
        jet
    }

    #[inline(always)]
    fn in_parameters(self, change: impl FnOnce(&Jet<N>) -> Jet<N>) -> Self {
        change(&self)
    }
}

impl Answer for SurfacePoint {
    const NAN: Self =
        Self { jet: <Jet as Answer>::NAN, normal: [f64::NAN; 3], gauss: f64::NAN, mean: f64::NAN };
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
