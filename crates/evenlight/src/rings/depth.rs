//! Which ring a place lies in, and how numbers are scaled there.

/// The ring of a place (a,b) of a sector other than its centre, and the place in it, as if it were
/// ring 0.
#[inline]
pub(crate) fn in_ring([a, b]: [f64; 2], sigma: f64) -> (usize, [f64; 2]) {
    let largest = a.max(b);
    if sigma != 0.5 || largest < f64::MIN_POSITIVE {
        let ring = ring_of(largest, sigma);
        return (ring, [a, b].map(|x| scaled_up(x, ring, sigma)));
    }
    // largest = mantissa 2^-k, 1 <= mantissa < 2: ring k if it is a power of 2, else the one
    // before.
    let bits = largest.to_bits();
    let is_power = bits & ((1 << MANTISSA) - 1) == 0;
    let ring = EXPONENT_OF_ONE - (bits >> MANTISSA) - u64::from(!is_power);
    let up = f64::from_bits((EXPONENT_OF_ONE + ring) << MANTISSA);
    (ring as usize, [up * a, up * b])
}

/// The number of bits of the mantissa of an `f64`.
const MANTISSA: u32 = f64::MANTISSA_DIGITS - 1;
/// The bits of the exponent of 1.
const EXPONENT_OF_ONE: u64 = f64::MAX_EXP as u64 - 1;

/// The ring l with sigma^(l+1) < x <= sigma^l, for 0 < x <= 1.
pub(crate) fn ring_of(x: f64, sigma: f64) -> usize {
    let factor = 1.0 / sigma;
    let (mut ring, mut x) = (0, x * OUT_OF_THE_DENORMALS);
    while x <= sigma * OUT_OF_THE_DENORMALS {
        x *= factor;
        ring += 1;
    }
    ring
}

/// x / sigma^ring, the same product as in [`ring_of`]; exact if sigma is 1/2 (2^ring itself may be
/// out of range when x is denormal).
pub(crate) fn scaled_up(x: f64, ring: usize, sigma: f64) -> f64 {
    let factor = 1.0 / sigma;
    (0..ring).fold(x * OUT_OF_THE_DENORMALS, |x, _| factor * x) / OUT_OF_THE_DENORMALS
}

/// 2^200. It lifts denormal numbers, where multiplication by a factor below 3/2 may change nothing.
pub(super) const OUT_OF_THE_DENORMALS: f64 = (1_u128 << 100) as f64 * (1_u128 << 100) as f64;

/// x^k by repeated squaring, in a fixed order of rounding.
pub(crate) fn power(x: f64, k: usize) -> f64 {
    let (mut result, mut square, mut k) = (1.0, x, k);
    while k > 0 {
        if k & 1 == 1 {
            result *= square;
        }
        square *= square;
        k >>= 1;
    }
    result
}
