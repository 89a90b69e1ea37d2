//! Pieces of files in messages.

/// `bytes` as text for a message: 40 characters at most, none of which could upset a terminal.
pub(super) fn excerpt(bytes: &[u8]) -> String {
    const MAX_CHARS: usize = 40;
    // A character has up to four bytes; more of them tell that something was left out.
    let head = &bytes[..bytes.len().min(4 * (MAX_CHARS + 1))];
    let text = String::from_utf8_lossy(head);
    let mut shown: String = text.chars().take(MAX_CHARS).map(printable).collect();
    if text.chars().nth(MAX_CHARS).is_some() {
        shown += "...";
    }
    shown
}

fn printable(c: char) -> char {
    match c {
        '\t' | '\n' | '\r' => ' ',
        // Without width, or turning the direction of writing.
        '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{206f}' => {
            char::REPLACEMENT_CHARACTER
        }
        c if c.is_control() => char::REPLACEMENT_CHARACTER,
        c => c,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn excerpts_are_short_and_harmless() {
        assert_eq!(excerpt(b"v 1\t2"), "v 1 2");
        assert_eq!(excerpt(b"\x1b[31m\xff"), "\u{fffd}[31m\u{fffd}");
        assert_eq!(excerpt("\u{202e}a".as_bytes()), "\u{fffd}a");
        assert_eq!(excerpt(&[b'x'; 40]), "x".repeat(40));
        assert_eq!(excerpt(&[b'x'; 41]), "x".repeat(40) + "...");
        assert_eq!(excerpt("\u{1f600}".repeat(50).as_bytes()), "\u{1f600}".repeat(40) + "...");
    }
}
