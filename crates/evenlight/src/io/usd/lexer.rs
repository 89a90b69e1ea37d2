//! The words of the text form of USD.

use super::UsdError;
use crate::io::excerpt::excerpt;

/// A word.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Token<'a> {
    /// A name or keyword, with colons and dots.
    Name(&'a str),
    /// A number.
    Number(f64),
    /// A string without its quotes.
    Text(String),
    /// What is between `@` and `@`, or `<` and `>`: a file or a path of a prim.
    Link(&'a str),
    /// One of `( ) [ ] { } = , : ;`.
    Sign(char),
    /// The end of the file.
    End,
}

/// A walk over the words of a file.
pub(super) struct Lexer<'a> {
    text: &'a str,
    at: usize,
    line: usize,
}

impl<'a> Lexer<'a> {
    /// Stands at the beginning of `text`.
    pub fn new(text: &'a str) -> Self {
        Self { text, at: 0, line: 1 }
    }

    /// The line that was reached.
    pub fn line(&self) -> usize {
        self.line
    }

    /// A fault here.
    pub fn fault(&self, message: impl Into<String>) -> UsdError {
        UsdError { line: self.line, message: message.into() }
    }

    /// The next word.
    pub fn next(&mut self) -> Result<Token<'a>, UsdError> {
        self.skip_blanks()?;
        let rest = &self.text[self.at..];
        match rest.as_bytes() {
            [] => Ok(Token::End),
            [b'(' | b')' | b'[' | b']' | b'{' | b'}' | b'=' | b',' | b':' | b';', ..] => {
                Ok(Token::Sign(char::from(self.take(1).as_bytes()[0])))
            }
            [b'"' | b'\'', ..] => self.string(),
            [b'@', ..] => self.asset(),
            [b'<', ..] => self.link("<", ">"),
            [b'0'..=b'9' | b'+' | b'-' | b'.', ..] => self.number(),
            _ => self.name(),
        }
    }

    /// The next `len` bytes.
    fn take(&mut self, len: usize) -> &'a str {
        let taken = &self.text[self.at..self.at + len];
        self.at += len;
        taken
    }

    /// Goes over blanks and comments: `# ...`, `// ...`, `/* ... */`.
    fn skip_blanks(&mut self) -> Result<(), UsdError> {
        loop {
            let rest = &self.text[self.at..];
            match rest.as_bytes() {
                [b'\n', ..] => {
                    self.line += 1;
                    self.at += 1;
                }
                [b' ' | b'\t' | b'\r', ..] => self.at += 1,
                [b'#', ..] | [b'/', b'/', ..] => self.at += rest.find('\n').unwrap_or(rest.len()),
                [b'/', b'*', ..] => {
                    let end = rest[2..]
                        .find("*/")
                        .ok_or_else(|| self.fault("the comment has no end: close it by `*/`"))?;
                    let comment = self.take(end + 4);
                    self.line += comment.matches('\n').count();
                }
                _ => return Ok(()),
            }
        }
    }

    fn number(&mut self) -> Result<Token<'a>, UsdError> {
        let rest = &self.text[self.at..];
        let part = |c: char| c.is_ascii_alphanumeric() || matches!(c, '+' | '-' | '.');
        let word = &rest[..rest.find(|c| !part(c)).unwrap_or(rest.len())];
        // The standard library's `+inf` and `-nan` are USD's too.
        let value = word.parse().map_err(|_| {
            self.fault(format!("`{}` is not a number: correct it", excerpt(word.as_bytes())))
        })?;
        self.take(word.len());
        Ok(Token::Number(value))
    }

    fn name(&mut self) -> Result<Token<'a>, UsdError> {
        let rest = &self.text[self.at..];
        let part = |c: char| c.is_alphanumeric() || matches!(c, '_' | ':' | '.' | '|' | '!');
        let len = rest.find(|c| !part(c)).unwrap_or(rest.len());
        if len == 0 {
            let word = rest.chars().next().map(String::from).unwrap_or_default();
            let message = format!("`{}` has no meaning here", excerpt(word.as_bytes()));
            return Err(self.fault(message));
        }
        Ok(Token::Name(self.take(len)))
    }

    fn asset(&mut self) -> Result<Token<'a>, UsdError> {
        let is_triple = self.text[self.at..].starts_with("@@@");
        let quote = if is_triple { "@@@" } else { "@" };
        self.link(quote, quote)
    }

    fn link(&mut self, open: &str, close: &str) -> Result<Token<'a>, UsdError> {
        let inside = &self.text[self.at + open.len()..];
        let len = inside
            .find(close)
            .ok_or_else(|| self.fault(format!("the `{open}` has no end: close it by `{close}`")))?;
        self.line += inside[..len].matches('\n').count();
        self.at += open.len() + len + close.len();
        Ok(Token::Link(&inside[..len]))
    }

    /// A string in single or double quotes, or in three of them, which may go over lines.
    fn string(&mut self) -> Result<Token<'a>, UsdError> {
        let rest = &self.text[self.at..];
        let quote = &rest[..1];
        let triple = quote.repeat(3);
        let (quote, is_long) =
            if rest.starts_with(&triple) { (triple.as_str(), true) } else { (quote, false) };
        let mut at = quote.len();
        while !rest[at..].starts_with(quote) {
            at += match rest[at..].chars().next() {
                Some('\\') => 1 + rest[at + 1..].chars().next().map_or(0, char::len_utf8),
                Some('\n') if !is_long => at_end(self, quote)?,
                Some(c) => c.len_utf8(),
                None => at_end(self, quote)?,
            };
        }
        let inside = &rest[quote.len()..at];
        self.line += inside.matches('\n').count();
        self.at += at + quote.len();
        Ok(Token::Text(unescape(inside)))
    }
}

fn at_end(lexer: &Lexer, quote: &str) -> Result<usize, UsdError> {
    Err(lexer.fault(format!("the string has no end: close it by {quote}")))
}

/// The string that is meant by `text`, in which `\` takes the next character as it is or as one
/// of the usual names.
fn unescape(text: &str) -> String {
    let mut result = String::with_capacity(text.len());
    let mut chars = text.chars();
    while let Some(c) = chars.next() {
        match c {
            '\\' => match chars.next() {
                Some('n') => result.push('\n'),
                Some('t') => result.push('\t'),
                Some('r') => result.push('\r'),
                Some(c) => result.push(c),
                None => {}
            },
            c => result.push(c),
        }
    }
    result
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tokens(text: &str) -> Vec<Token<'_>> {
        let mut lexer = Lexer::new(text);
        let mut tokens = Vec::new();
        loop {
            match lexer.next().unwrap() {
                Token::End => return tokens,
                token => tokens.push(token),
            }
        }
    }

    #[test]
    fn words_of_all_kinds() {
        let text = "point3f[] a:b.c = (-1.5e3, .5) # x\n@a b@ <../x> /* \n */ 'q\\'' // z";
        let expected = [
            Token::Name("point3f"),
            Token::Sign('['),
            Token::Sign(']'),
            Token::Name("a:b.c"),
            Token::Sign('='),
            Token::Sign('('),
            Token::Number(-1500.0),
            Token::Sign(','),
            Token::Number(0.5),
            Token::Sign(')'),
            Token::Link("a b"),
            Token::Link("../x"),
            Token::Text("q'".to_owned()),
        ];
        assert_eq!(tokens(text), expected);
    }

    #[test]
    fn strings_may_be_long_and_have_quotes_in_them() {
        assert_eq!(tokens("\"\"\"a\n\"b\" \\\\\"\"\""), [Token::Text("a\n\"b\" \\".to_owned())]);
        assert_eq!(tokens("\"\" 'a\\nb'"), [Token::Text("".into()), Token::Text("a\nb".into())]);
        for text in ["\"abc", "'a\n'", "'''a'", "@a", "@@@a@", "<a", "/* a", "\"\\", "`", "1x"] {
            let mut lexer = Lexer::new(text);
            assert!(lexer.next().is_err(), "{text}");
        }
    }

    #[test]
    fn lines_are_counted_everywhere() {
        let mut lexer = Lexer::new("\n/*\n\n*/ '''\n''' # \n @\n@ a");
        while lexer.next() != Ok(Token::Name("a")) {}
        assert_eq!(lexer.line(), 7);
    }
}
