//! The words of a file, line by line.
//!
//! ```text
//!   v 1 2 \        line 1:  "v" "1" "2" "3"      "\" before the end of a line joins
//!   3 # f 4        line 3:  "f" "1"                  the next line to it
//!   f 1            "#" ends the words of a line
//! ```

/// A walk over the words of a file.
///
/// [`Iterator::next`] stays within a line, continued ones included, and is `None` at its end;
/// [`Words::next_line`] goes on to the next.
#[derive(Clone, Debug)]
pub(super) struct Words<'a> {
    bytes: &'a [u8],
    at: usize,
    line: usize,
}

impl<'a> Words<'a> {
    /// Stands before the first word of the first line.
    pub fn new(bytes: &'a [u8]) -> Self {
        const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";
        let at = if bytes.starts_with(BYTE_ORDER_MARK) { BYTE_ORDER_MARK.len() } else { 0 };
        Self { bytes, at, line: 1 }
    }

    /// Stands at `at`, where a word begins. Lines are counted from there.
    pub fn starting_at(bytes: &'a [u8], at: usize) -> Self {
        Self { bytes, at, line: 1 }
    }

    /// The number of the line that was reached, from 1; continued lines count.
    pub fn line(&self) -> usize {
        self.line
    }

    /// Where the latest word ends.
    pub fn position(&self) -> usize {
        self.at
    }

    /// Steps to the next line; `false` if the file ends.
    pub fn next_line(&mut self) -> bool {
        while self.next().is_some() {}
        while self.at < self.bytes.len() && self.line_end_at(self.at).is_none() {
            self.at += 1; // a comment
        }
        self.step_over(self.line_end_at(self.at))
    }

    fn step_over(&mut self, line_end: Option<usize>) -> bool {
        if let Some(next) = line_end {
            self.at = next;
            self.line += 1;
        }
        line_end.is_some()
    }

    /// The start of the next line, if the line ends at `at`.
    fn line_end_at(&self, at: usize) -> Option<usize> {
        match self.bytes.get(at..)? {
            [b'\r', b'\n', ..] => Some(at + 2),
            [b'\r' | b'\n', ..] => Some(at + 1),
            _ => None,
        }
    }

    /// The start of the next line, if there is a `\` at `at` that joins it to this one.
    fn continuation_at(&self, at: usize) -> Option<usize> {
        let rest = self.bytes.get(at..)?.strip_prefix(b"\\")?;
        let blanks = rest.iter().take_while(|&&b| is_blank(b)).count();
        let end = at + 1 + blanks;
        if end == self.bytes.len() { Some(end) } else { self.line_end_at(end) }
    }

    fn skip_blanks(&mut self) {
        loop {
            match self.bytes.get(self.at) {
                Some(&b) if is_blank(b) => self.at += 1,
                Some(b'\\') if self.step_over(self.continuation_at(self.at)) => {}
                _ => return,
            }
        }
    }

    fn in_word(&self) -> bool {
        match self.bytes.get(self.at) {
            None | Some(b'\n' | b'\r' | b'#') => false,
            Some(b'\\') => self.continuation_at(self.at).is_none(),
            Some(&b) => !is_blank(b),
        }
    }
}

impl<'a> Iterator for Words<'a> {
    type Item = &'a [u8];

    fn next(&mut self) -> Option<&'a [u8]> {
        self.skip_blanks();
        let start = self.at;
        while self.in_word() {
            self.at += 1;
        }
        (start < self.at).then(|| &self.bytes[start..self.at])
    }
}

fn is_blank(byte: u8) -> bool {
    matches!(byte, b' ' | b'\t' | 0x0b | 0x0c)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The words of every line that has some, with the number of the line they begin on.
    fn lines(text: &[u8]) -> Vec<(usize, Vec<String>)> {
        let mut words = Words::new(text);
        let mut lines = Vec::new();
        loop {
            if let Some(first) = words.next() {
                let line = words.line();
                let all = [first].into_iter().chain(&mut words);
                lines.push((line, all.map(|w| String::from_utf8_lossy(w).into()).collect()));
            }
            if !words.next_line() {
                return lines;
            }
        }
    }

    fn line(number: usize, words: &str) -> (usize, Vec<String>) {
        (number, words.split(' ').map(String::from).collect())
    }

    #[test]
    fn the_drawing_is_read_as_it_says() {
        assert_eq!(lines(b"v 1 2 \\\n3 # f 4\nf 1"), [line(1, "v 1 2 3"), line(3, "f 1")]);
    }

    #[test]
    fn all_line_ends_count_once() {
        for text in [&b"a\nb\n\nc"[..], b"a\r\nb\r\n\r\nc\r\n", b"a\rb\r\rc\r", b"a\r\nb\n\rc"] {
            assert_eq!(lines(text), [line(1, "a"), line(2, "b"), line(4, "c")]);
        }
    }

    #[test]
    fn a_line_is_joined_to_the_next_in_every_way_of_writing_it() {
        for text in
            [&b"a b\\\nc"[..], b"a b \\\n c", b"a\\\r\nb\\\r\nc", b"a b\\ \t\r\nc", b"a b c\\"]
        {
            assert_eq!(lines(text).len(), 1);
            assert_eq!(lines(text)[0].1, ["a", "b", "c"]);
        }
        assert_eq!(lines(b"a \\ b\nc\\d"), [line(1, "a \\ b"), line(2, "c\\d")]);
        assert_eq!(lines(b"a \\\n\\\n\nb"), [line(1, "a"), line(4, "b")]);
    }

    #[test]
    fn comments_end_with_their_line() {
        assert_eq!(lines(b"# C:\\dir\\\na b#c\\\nd"), [line(2, "a b"), line(3, "d")]);
        assert_eq!(lines(b"#"), []);
        assert_eq!(lines(b" \t\n\x0b\x0ca"), [line(2, "a")]);
    }

    #[test]
    fn a_byte_order_mark_is_no_word() {
        assert_eq!(lines(b"\xef\xbb\xbfa"), [line(1, "a")]);
        assert_eq!(lines(b"\xef\xbb\xbf"), []);
    }
}
