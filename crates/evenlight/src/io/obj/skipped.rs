//! What an OBJ file says beyond a cage: counted, to be told in one sentence.

use std::fmt;

/// Every word that begins such a line, with the name of what it says.
const KINDS: [(&str, &str); 7] = [
    ("o", "objects"),
    ("g", "groups"),
    ("s", "smoothing groups"),
    ("usemtl", "materials"),
    ("mtllib", "materials"),
    ("vn", "normals"),
    ("v", "further numbers of vertices"),
];

/// The lines of groups, materials, normals and the like, which are read over.
///
/// ```text
/// line 3 and 41 more: groups, materials and normals (g, usemtl, vn) are not kept
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Skipped {
    /// The first of the lines, from 1.
    pub first_line: u32,
    /// How many lines there are.
    pub num_lines: usize,
    /// The words that begin them: `o`, `g`, `s`, `usemtl`, `mtllib`, `vn`, and `v` for vertices
    /// with five numbers, or with seven or more.
    pub words: Vec<&'static str>,
}

impl Skipped {
    /// Adds a line that begins with `word` to those `so_far`; whether it is such a word.
    pub(super) fn count(so_far: &mut Option<Self>, word: &[u8], line: u32) -> bool {
        let Some((word, _)) = KINDS.iter().find(|(known, _)| known.as_bytes() == word) else {
            return false;
        };
        let skipped =
            so_far.get_or_insert(Self { first_line: line, num_lines: 0, words: Vec::new() });
        skipped.num_lines += 1;
        if !skipped.words.contains(word) {
            skipped.words.push(word);
        }
        true
    }
}

impl fmt::Display for Skipped {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let has = |word: &&str| self.words.contains(word);
        let mut kinds: Vec<&str> =
            KINDS.iter().filter(|(word, _)| has(word)).map(|&(_, kind)| kind).collect();
        kinds.dedup();
        write!(f, "line {}", self.first_line)?;
        if self.num_lines > 1 {
            write!(f, " and {} more", self.num_lines - 1)?;
        }
        let words: Vec<&str> = KINDS.iter().map(|&(word, _)| word).filter(has).collect();
        write!(f, ": {} ({}) are not kept", joined(&kinds), words.join(", "))
    }
}

/// `a`, `a and b`, `a, b and c`.
fn joined(words: &[&str]) -> String {
    match words {
        [first @ .., before_last, last] => {
            let first: String = first.iter().map(|word| format!("{word}, ")).collect();
            format!("{first}{before_last} and {last}")
        }
        _ => words.concat(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn skipped(lines: &[(&str, u32)]) -> Option<String> {
        let mut skipped = None;
        for (word, line) in lines {
            Skipped::count(&mut skipped, word.as_bytes(), *line);
        }
        skipped.map(|skipped| skipped.to_string())
    }

    #[test]
    fn one_sentence_tells_all() {
        assert_eq!(skipped(&[("f", 1), ("vt", 2)]), None);
        let expected = "line 3: groups (g) are not kept";
        assert_eq!(skipped(&[("g", 3)]).as_deref(), Some(expected));
        let expected = "line 2 and 1 more: materials (usemtl, mtllib) are not kept";
        assert_eq!(skipped(&[("mtllib", 2), ("usemtl", 5)]).as_deref(), Some(expected));
        let many = [("vn", 3), ("vn", 4), ("g", 6), ("usemtl", 7), ("g", 8)];
        let expected =
            "line 3 and 4 more: groups, materials and normals (g, usemtl, vn) are not kept";
        assert_eq!(skipped(&many).as_deref(), Some(expected));
    }
}
