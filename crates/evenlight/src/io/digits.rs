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
/// or an exponent; `null` if it is NaN or infinite.
pub(super) struct JsonNumber(pub f64);

impl fmt::Display for JsonNumber {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let size = self.0.abs();
        if !self.0.is_finite() {
            f.write_str("null")
        } else if size == 0.0 || (1e-5..1e16).contains(&size) {
            write!(f, "{:?}", self.0)
        } else {
            write!(f, "{:e}", self.0)
        }
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
            for x in [f64::from_bits(bits), near_one, -near_one, near_one / 7.0] {
                prop_assert_eq!(JsonNumber(x).to_string(), serde_json::to_string(&x).unwrap());
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
