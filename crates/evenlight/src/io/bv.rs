//! Patches in BezierView's text format `.bv`.
//!
//! Words separated by white space, read to the end of the file:
//!
//! ```text
//! file  := { group | patch }
//! group := ("Group" | "group") COLOR NAME [ #DEPTH ]     on one line; for what follows
//! patch := 4 d     (d+1)(d+1)   points                   degree d in both directions
//!        | 5 du dv (du+1)(dv+1) points                   the v index fastest
//! point := x y z
//! ```
//!
//! [`write`](fn@write) makes patches of kind 5 only, in the groups `regular`, `ring-1`,
//! `ring-2`, ..., one for each role. [`read`] reads them back; it knows no other kinds
//! (polyhedra, triangular and rational patches). BezierView itself reads the first 6499
//! patches and ten colors, after which colors repeat.

use std::collections::BTreeMap;
use std::io::{self, Write};

use super::digits::Triple;
use crate::patch::{MAX_DEGREE, Patch};
use crate::surface::{PlacedPatch, Role};

/// Writes `patches`, grouped by role; `regular` has color 0, ring k has color k, and `cap` one
/// more than the last ring.
///
/// Regular patches are written as they come; patches of rings and caps are held back until the end,
/// to have each group in one piece. Coordinates are in the units of the cage, with the fewest
/// digits from which the same `f64` is read again. Writes many small pieces: give it something with
/// a buffer.
pub fn write(
    patches: impl IntoIterator<Item = PlacedPatch>,
    out: &mut impl Write,
) -> io::Result<()> {
    // By their numbers from 1.
    let mut rings: BTreeMap<usize, Vec<Patch>> = BTreeMap::new();
    let mut caps: Vec<Patch> = Vec::new();
    let mut has_regular = false;
    for placed in patches {
        match placed.place.role {
            Role::Ring(k) => rings.entry(k + 1).or_default().push(placed.patch),
            Role::Cap => caps.push(placed.patch),
            Role::Regular => {
                if !has_regular {
                    writeln!(out, "Group 0 regular")?;
                }
                has_regular = true;
                write_patch(&placed.patch, out)?;
            }
        }
    }
    for (k, ring) in &rings {
        writeln!(out, "Group {k} ring-{k}")?;
        ring.iter().try_for_each(|patch| write_patch(patch, out))?;
    }
    if !caps.is_empty() {
        writeln!(out, "Group {} cap", rings.keys().last().map_or(1, |last| last + 1))?;
    }
    caps.iter().try_for_each(|patch| write_patch(patch, out))
}

fn write_patch(patch: &Patch, out: &mut impl Write) -> io::Result<()> {
    let [du, dv] = patch.degree();
    writeln!(out, "5 {du} {dv}")?;
    patch.coefs().iter().try_for_each(|&b| writeln!(out, "{}", Triple(b)))
}

/// Patches of a file under one name.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Group {
    /// The number of a color.
    pub color: i32,
    /// The name; empty for patches in front of the first group.
    pub name: String,
    /// The patches, in the order of the file.
    pub patches: Vec<Patch>,
}

/// Why a file is not read, and the line (from 1) at which that is clear.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("line {line}: {fault}")]
pub struct BvError {
    /// The line, counted from 1.
    pub line: usize,
    /// What is wrong there.
    pub fault: Fault,
}

/// What is wrong with a file.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Fault {
    /// The file ends inside a group line or a patch.
    #[error("the file ends where {expected} should be")]
    UnexpectedEnd {
        /// What should come next.
        expected: &'static str,
    },
    /// A word is not what it should be.
    #[error("expected {expected}, found \"{found}\"")]
    UnexpectedWord {
        /// What should stand here.
        expected: &'static str,
        /// What stands here.
        found: String,
    },
    /// A patch of a kind that is not read.
    #[error("patches of kind {0} are not read, only kinds 4 and 5")]
    UnknownKind(u32),
    /// A degree above [`MAX_DEGREE`].
    #[error("degree {0} is too high (at most {MAX_DEGREE})")]
    DegreeTooHigh(usize),
}

/// Reads all patches of kinds 4 and 5.
///
/// Patches of the same group name are one group, as in BezierView, with the last color; groups
/// are in the order in which their names appear.
///
/// # Errors
///
/// The first thing that is not of the grammar, or a coordinate that is not a finite number.
///
/// ```
/// use evenlight::io::bv;
///
/// let groups = bv::read("Group 2 roof\n5 1 1\n0 0 0  0 1 0\n1 0 0  1 1 1\n").unwrap();
/// assert_eq!((groups[0].name.as_str(), groups[0].color), ("roof", 2));
/// assert_eq!(groups[0].patches[0].coef(0, 1), Some([0.0, 1.0, 0.0]));
/// ```
pub fn read(text: &str) -> Result<Vec<Group>, BvError> {
    let mut words = Words::new(text);
    let mut groups: Vec<Group> = Vec::new();
    let mut current = None;
    while let Some(word) = words.next_word() {
        if word == "Group" || word == "group" {
            current = Some(read_group(&mut words, &mut groups)?);
        } else {
            let patch = read_patch(word, &mut words)?;
            let unnamed = || find_or_add(&mut groups, "");
            let group = *current.get_or_insert_with(unnamed);
            groups[group].patches.push(patch);
        }
    }
    Ok(groups)
}

/// Reads the rest of a group line; returns the index of the group.
fn read_group(words: &mut Words, groups: &mut Vec<Group>) -> Result<usize, BvError> {
    let color = words.parse("a color number")?;
    let name = words.expect("a group name")?;
    let group = find_or_add(groups, name);
    groups[group].color = color;
    if let Some(depth) = words.rest_of_line() {
        let is_depth = depth.strip_prefix('#').is_some_and(|d| d.trim().parse::<u32>().is_ok());
        if !is_depth {
            return Err(words.unexpected("# and a subdivision depth", depth));
        }
    }
    Ok(group)
}

fn find_or_add(groups: &mut Vec<Group>, name: &str) -> usize {
    groups.iter().position(|g| g.name == name).unwrap_or_else(|| {
        groups.push(Group { name: name.to_owned(), ..Group::default() });
        groups.len() - 1
    })
}

/// Reads a patch after the word that tells its kind.
fn read_patch(kind: &str, words: &mut Words) -> Result<Patch, BvError> {
    let degree = match kind.parse() {
        Ok(4) => [read_degree(words)?; 2],
        Ok(5) => [read_degree(words)?, read_degree(words)?],
        Ok(kind) => return Err(words.error(Fault::UnknownKind(kind))),
        Err(_) => return Err(words.unexpected("\"Group\" or the kind of a patch", kind)),
    };
    let num_points = (degree[0] + 1) * (degree[1] + 1);
    let coefs = (0..num_points).map(|_| read_point(words)).collect::<Result<_, _>>()?;
    Ok(Patch::of(degree, coefs))
}

fn read_degree(words: &mut Words) -> Result<usize, BvError> {
    let degree = words.parse("a degree")?;
    if degree > MAX_DEGREE { Err(words.error(Fault::DegreeTooHigh(degree))) } else { Ok(degree) }
}

fn read_point(words: &mut Words) -> Result<[f64; 3], BvError> {
    Ok([read_coordinate(words)?, read_coordinate(words)?, read_coordinate(words)?])
}

fn read_coordinate(words: &mut Words) -> Result<f64, BvError> {
    const EXPECTED: &str = "a finite coordinate";
    let word = words.expect(EXPECTED)?;
    let value = word.parse().ok().filter(|x: &f64| x.is_finite());
    value.ok_or_else(|| words.unexpected(EXPECTED, word))
}

/// The words of a text, and the line of the last one.
struct Words<'a> {
    line: usize,
    /// What is left of the current line.
    rest: &'a str,
    lines: std::str::Lines<'a>,
}

impl<'a> Words<'a> {
    fn new(text: &'a str) -> Self {
        Self { line: 0, rest: "", lines: text.lines() }
    }

    /// The next word, on this line or a later one.
    fn next_word(&mut self) -> Option<&'a str> {
        while self.rest.trim_start().is_empty() {
            self.rest = self.lines.next()?;
            self.line += 1;
        }
        let rest = self.rest.trim_start();
        let end = rest.find(char::is_whitespace).unwrap_or(rest.len());
        let (word, rest) = rest.split_at(end);
        self.rest = rest;
        Some(word)
    }

    /// Takes what is left of the current line, if that is anything.
    fn rest_of_line(&mut self) -> Option<&'a str> {
        let rest = std::mem::take(&mut self.rest).trim();
        (!rest.is_empty()).then_some(rest)
    }

    fn expect(&mut self, expected: &'static str) -> Result<&'a str, BvError> {
        self.next_word().ok_or_else(|| self.error(Fault::UnexpectedEnd { expected }))
    }

    fn parse<T: std::str::FromStr>(&mut self, expected: &'static str) -> Result<T, BvError> {
        let word = self.expect(expected)?;
        word.parse().map_err(|_| self.unexpected(expected, word))
    }

    fn unexpected(&self, expected: &'static str, found: &str) -> BvError {
        self.error(Fault::UnexpectedWord { expected, found: found.to_owned() })
    }

    fn error(&self, fault: Fault) -> BvError {
        BvError { line: self.line.max(1), fault }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BILINEAR: &str = "5 1 1\n0 0 0\n0 1 0\n1 0 0\n1 1 1\n";

    #[test]
    fn groups_go_on_under_their_name() {
        let text = format!(
            "{BILINEAR}Group 1 a #3\n{BILINEAR}group 2 b\n4 1 0 0 0 0 1 0 1 0 0 1 1 1\nGroup 5 a\n{BILINEAR}"
        );
        let groups = read(&text).unwrap();
        let summary: Vec<_> =
            groups.iter().map(|g| (&g.name[..], g.color, g.patches.len())).collect();
        assert_eq!(summary, [("", 0, 1), ("a", 5, 2), ("b", 2, 1)]);
        assert!(groups.iter().flat_map(|g| &g.patches).all(|p| *p == groups[0].patches[0]));
    }

    #[test]
    fn nothing_is_read_from_nothing() {
        assert_eq!(read(""), Ok(Vec::new()));
        assert_eq!(read(" \n\t\n"), Ok(Vec::new()));
    }

    #[test]
    fn faults_name_their_line() {
        for (text, message) in [
            ("5 1 1\n0 0 0\n0 1", "line 3: the file ends where a finite coordinate should be"),
            ("5 1 1\n0 0 zero", "line 2: expected a finite coordinate, found \"zero\""),
            ("5 1 1\n0 0 inf", "line 2: expected a finite coordinate, found \"inf\""),
            ("\n8 3 3", "line 2: patches of kind 8 are not read, only kinds 4 and 5"),
            ("4 40", "line 1: degree 40 is too high (at most 6)"),
            ("4 -1", "line 1: expected a degree, found \"-1\""),
            ("patch", "line 1: expected \"Group\" or the kind of a patch, found \"patch\""),
            ("Group 1\n", "line 1: the file ends where a group name should be"),
            ("Group red x\n", "line 1: expected a color number, found \"red\""),
            ("Group 1 x y\n", "line 1: expected # and a subdivision depth, found \"y\""),
        ] {
            assert_eq!(read(text).unwrap_err().to_string(), message, "{text:?}");
        }
    }

    #[test]
    fn every_beginning_of_a_file_is_read_or_refused() {
        let text = format!("Group 1 a #3\n{BILINEAR}");
        for end in 0..text.len() - 1 {
            if let Ok(groups) = read(&text[..end]) {
                assert!(groups.iter().all(|g| g.patches.is_empty()), "the patch is not complete");
            }
        }
    }
}
