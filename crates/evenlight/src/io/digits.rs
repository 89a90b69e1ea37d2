//! Numbers in text files.

use std::fmt;

/// A number with the fewest digits from which the same `f64` is read again; with an exponent
/// only where it would otherwise be long. What does not exist (NaN) is written as 0, since
/// most readers know no word for it.
pub(super) struct Digits(pub f64);

impl fmt::Display for Digits {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let size = self.0.abs();
        if self.0.is_nan() {
            f.write_str("0")
        } else if size == 0.0 || (1e-5..1e16).contains(&size) {
            write!(f, "{}", self.0)
        } else {
            write!(f, "{:e}", self.0)
        }
    }
}

/// Three numbers, separated by spaces.
pub(super) struct Triple(pub [f64; 3]);

impl fmt::Display for Triple {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let [x, y, z] = self.0.map(Digits);
        write!(f, "{x} {y} {z}")
    }
}

/// A number in JSON: the fewest digits from which the same `f64` is read again, always with a point
/// or an exponent; `null` if it is NaN or infinite. Of two such numbers that are equally near it is
/// the one whose last digit is even.
pub(super) struct JsonNumber(pub f64);

impl fmt::Display for JsonNumber {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (x, size) = (self.0, self.0.abs());
        let is_plain = size == 0.0 || (1e-5..1e16).contains(&size);
        if !x.is_finite() {
            f.write_str("null")
        } else if !is_plain {
            f.write_str(&even_digits(x).replace('e', "e+").replace("e+-", "e-"))
        } else if x.fract() == 0.0 {
            write!(f, "{x:.1}")
        } else if may_be_halfway(x) {
            f.write_str(&plain(&even_digits(x)))
        } else {
            write!(f, "{x}")
        }
    }
}

/// Whether a decimal number may lie exactly halfway between two that are read as `x`: it has 18
/// digits at most, hence `x` at most 25 binary ones after the point.
fn may_be_halfway(x: f64) -> bool {
    let scaled = x * f64::from(1 << 25);
    scaled.fract() == 0.0
}

/// The fewest digits of `x`, the even ones of two that are equally near, as `-1.25e-7`.
fn even_digits(x: f64) -> String {
    /// More digits than numbers have that lie halfway.
    const ALL: usize = 60;
    let shortest = format!("{x:e}");
    let Some((digits, exponent)) = shortest.split_once('e') else { return shortest };
    let all = format!("{x:.ALL$e}");
    let Some((below, rest)) = all.split_at_checked(digits.len()) else { return shortest };
    let rest = rest.split('e').next().unwrap_or_default();
    let is_halfway = rest.starts_with('5') && rest[1..].bytes().all(|digit| digit == b'0');
    let is_even = below.bytes().last().is_some_and(|digit| digit % 2 == 0);
    let even = format!("{below}e{exponent}");
    if is_halfway && is_even && even.parse() == Ok(x) { even } else { shortest }
}

/// `-1.25e-3` as `-0.00125`; the exponent is not so large that zeros would have to follow.
fn plain(number: &str) -> String {
    let (digits, exponent) = number.split_once('e').unwrap_or((number, "0"));
    let exponent: i32 = exponent.parse().unwrap_or_default();
    let sign = if digits.starts_with('-') { "-" } else { "" };
    let digits: String = digits.chars().filter(char::is_ascii_digit).collect();
    match usize::try_from(exponent) {
        Ok(before) => {
            let (whole, fraction) = digits.split_at((before + 1).min(digits.len()));
            format!("{sign}{whole}.{fraction}")
        }
        Err(_) => format!("{sign}0.{}{digits}", "0".repeat(exponent.unsigned_abs() as usize - 1)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn json_numbers_are_those_of_serde(bits in any::<u64>(), exponent in -8..20) {
            let near_one = (bits % 1_000_000) as f64 * 10_f64.powi(exponent);
            let dyadic = (bits >> 12) as f64 / 2_f64.powi(exponent + 20);
            for x in [f64::from_bits(bits), near_one, -near_one, near_one / 7.0, dyadic, -dyadic] {
                prop_assert_eq!(JsonNumber(x).to_string(), serde_json::to_string(&x).unwrap());
            }
        }
    }

    #[test]
    fn json_numbers_are_those_of_serde_halfway_between_two() {
        for k in 0..60 {
            for odd in (1..1 << 12).step_by(2) {
                let x = f64::from(odd) / 2_f64.powi(k);
                assert_eq!(JsonNumber(x).to_string(), serde_json::to_string(&x).unwrap());
                let x = (1_u64 << 53) as f64 * f64::from(odd) * 2_f64.powi(k - 40);
                assert_eq!(JsonNumber(x).to_string(), serde_json::to_string(&x).unwrap());
            }
        }
    }

    #[test]
    fn json_numbers_at_the_ends_of_the_plain_form() {
        for x in [0.0, -0.0, 1e-5, 9.999e-6, 1e15, 1e16, 1.5e16, 1e17, 5e-324, f64::MAX, f64::NAN] {
            assert_eq!(JsonNumber(x).to_string(), serde_json::to_string(&x).unwrap());
        }
    }

    #[test]
    fn short_numbers_are_short() {
        let written =
            [0.0, 1.0, -0.5, 0.1, 1e-5, 1e-6, 1e16, f64::NAN].map(|x| Digits(x).to_string());
        assert_eq!(written, ["0", "1", "-0.5", "0.1", "0.00001", "1e-6", "1e16", "0"]);
    }

    #[test]
    fn the_same_number_is_read_again() {
        let mut x = 1.0 / 3.0;
        for _ in 0..200 {
            assert_eq!(Digits(x).to_string().parse(), Ok(x));
            x *= -0.037;
        }
    }
}
