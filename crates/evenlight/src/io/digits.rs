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

#[cfg(test)]
mod tests {
    use super::*;

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
