//! What the fuzz tests share: random numbers, spoiled files, the loop over the cases.

#![allow(dead_code, reason = "each test file uses a part of it")]

use std::panic::{self, RefUnwindSafe};

/// A small generator of pseudo-random numbers (SplitMix64): every case has its own seed.
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ self.0 >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ z >> 31
    }

    /// A number from 0 to `end - 1`.
    pub fn below(&mut self, end: usize) -> usize {
        (self.next() % end as u64) as usize
    }

    pub fn one_in(&mut self, n: usize) -> bool {
        self.below(n) == 0
    }

    pub fn pick<T: Copy>(&mut self, from: &[T]) -> T {
        from[self.below(from.len())]
    }
}

/// Bytes without any order.
pub fn noise(random: &mut Random) -> Vec<u8> {
    (0..random.below(300)).map(|_| random.next() as u8).collect()
}

/// A file with a few bytes or pieces changed, mostly to `usual` bytes.
pub fn mutated(text: &[u8], usual: &[u8], random: &mut Random) -> Vec<u8> {
    let mut text = text.to_vec();
    for _ in 0..1 + random.below(3) {
        let at = random.below(text.len().max(1)).min(text.len());
        let end = (at + random.below(40)).min(text.len());
        match random.below(12) {
            0 if at < text.len() => text[at] = random.next() as u8,
            1 if at < text.len() => text[at] = random.pick(usual),
            2 => drop(text.drain(at..end)),
            3 => text.insert(at, random.pick(usual)),
            4 => {
                let piece = text[at..end].to_vec();
                let to = random.below(text.len() + 1);
                text.splice(to..to, piece);
            }
            5 => text.truncate(text.len() - random.below(40).min(text.len())),
            // Another coordinate, more often than another corner.
            _ if text.get(at).is_some_and(u8::is_ascii_digit) => {
                text[at] = random.pick(b"0123456789");
            }
            _ => {}
        }
    }
    text
}

/// Asserts that a message of errors names a place, lists few faults and shows on any terminal.
pub fn assert_readable(message: &str) {
    assert!(message.contains(": ") && message.lines().count() <= 24, "{message}");
    assert!(!message.chars().any(|c| c.is_control() && c != '\n'), "{message}");
}

/// Runs the cases with seeds 0 to `count - 1`; how many `hold` found good. A case that panics is
/// shown.
pub fn run(
    count: u64,
    case: impl Fn(u64) -> Vec<u8>,
    hold: impl Fn(&[u8]) -> bool + RefUnwindSafe,
) -> usize {
    let mut good = 0;
    for seed in 0..count {
        let bytes = case(seed);
        match panic::catch_unwind(|| hold(&bytes)) {
            Ok(is_good) => good += usize::from(is_good),
            Err(panic) => {
                eprintln!("seed {seed}: {}", bytes.escape_ascii());
                panic::resume_unwind(panic);
            }
        }
    }
    good
}
