//! The grammar of the text form of USD: from words to a tree of prims.
//!
//! ```text
//! layer     = "#usda 1.0" [metadata] { prim }
//! prim      = ("def" | "over" | "class") [TYPE] STRING [metadata] "{" { statement } "}"
//! statement = prim | "variantSet" ... | "reorder" ... | property
//! property  = { QUALIFIER } TYPE ["[]"] NAME ["=" value] [metadata]
//! metadata  = "(" { STRING | { QUALIFIER } NAME "=" value } ")"
//! value     = NUMBER | STRING | NAME | LINK [metadata] | "(" values ")" | "[" values "]"
//!           | "{" { [TYPE ["[]"]] (NAME | STRING) "=" value | NUMBER ":" value } "}"
//! ```
//!
//! Statements may be separated by `;`, values by `,`. What is not understood is read all the same,
//! so that a fault is found where it is.

use super::UsdError;
use super::lexer::{Lexer, Token};
use crate::io::excerpt::excerpt;
use crate::io::kind::{Format, Kind};

/// What is at the top of a file.
#[derive(Debug)]
pub(super) struct Layer {
    /// The prims without parent.
    pub prims: Vec<Prim>,
    /// The number of lines.
    pub num_lines: usize,
}

/// A prim with what is below it.
#[derive(Debug, Default)]
pub(super) struct Prim {
    /// Whether it is `def`, not only `over` or `class`.
    pub is_defined: bool,
    /// As in `Mesh`; empty if there is none.
    pub type_name: String,
    pub name: String,
    /// The line that begins it.
    pub line: usize,
    /// Whether the metadata `active` is not false.
    pub is_active: bool,
    /// Words for composition that is not followed.
    pub arcs: Vec<String>,
    pub attributes: Vec<Attribute>,
    pub children: Vec<Prim>,
}

/// A value under a name.
#[derive(Debug)]
pub(super) struct Attribute {
    /// With namespaces, and with `.timeSamples` for values over time.
    pub name: String,
    pub line: usize,
    pub value: Value,
    /// The metadata of this name.
    pub interpolation: Option<String>,
}

/// A value.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Value {
    /// Numbers in tuples of `width`, each of a list with its line, or single ones.
    Numbers { values: Vec<f64>, width: usize, lines: Vec<u32> },
    /// Strings or tokens.
    Texts(Vec<String>),
    /// `None`, or nothing.
    None,
    /// Anything that is not understood.
    Other,
}

/// How deep brackets and prims may be nested; real files have a dozen.
const MAX_DEPTH: usize = 100;

/// Reads a whole file.
pub(super) fn read(bytes: &[u8]) -> Result<Layer, UsdError> {
    let fault = |line, message: &str| UsdError { line, message: message.to_owned() };
    if bytes.starts_with(b"PXR-USDC") || bytes.starts_with(b"PK") {
        let message = "this is binary USD, which is not read: convert it by \
                       `usdcat --flatten IN -o OUT.usda`";
        return Err(fault(1, message));
    }
    let text = std::str::from_utf8(bytes).map_err(|error| {
        let line = 1 + bytes[..error.valid_up_to()].iter().filter(|&&b| b == b'\n').count();
        fault(line, "the text is not UTF-8: convert it")
    })?;
    if !text.starts_with("#usda 1.") {
        let advice = Kind::advice(bytes, Format::Usda);
        return Err(fault(1, &format!("the file does not begin with `#usda 1.0`: {advice}")));
    }
    Parser::new(text)?.layer()
}

/// Words with one of look-ahead.
struct Parser<'a> {
    lexer: Lexer<'a>,
    next: Token<'a>,
    /// The line of `next`.
    line: usize,
    depth: usize,
}

impl<'a> Parser<'a> {
    fn new(text: &'a str) -> Result<Self, UsdError> {
        let mut lexer = Lexer::new(text);
        let next = lexer.next()?;
        let line = lexer.line();
        Ok(Self { lexer, next, line, depth: 0 })
    }

    fn layer(mut self) -> Result<Layer, UsdError> {
        if self.next == Token::Sign('(') {
            self.metadata()?;
        }
        let mut prims = Vec::new();
        while self.next != Token::End {
            match self.next {
                Token::Sign(';') => drop(self.advance()?),
                Token::Name("reorder") => drop(self.property()?),
                _ => prims.push(self.prim()?),
            }
        }
        Ok(Layer { prims, num_lines: self.line })
    }

    /// Steps to the next word; the one before it.
    fn advance(&mut self) -> Result<Token<'a>, UsdError> {
        let next = self.lexer.next()?;
        self.line = self.lexer.line();
        Ok(std::mem::replace(&mut self.next, next))
    }

    fn eat(&mut self, sign: char) -> Result<bool, UsdError> {
        let is_it = self.next == Token::Sign(sign);
        if is_it {
            self.advance()?;
        }
        Ok(is_it)
    }

    fn expect(&mut self, sign: char) -> Result<(), UsdError> {
        if self.eat(sign)? { Ok(()) } else { Err(self.unexpected(&format!("`{sign}`"))) }
    }

    fn name(&mut self) -> Result<&'a str, UsdError> {
        match self.next {
            Token::Name(name) => {
                self.advance()?;
                Ok(name)
            }
            _ => Err(self.unexpected("a name")),
        }
    }

    fn text(&mut self) -> Result<String, UsdError> {
        match self.next {
            Token::Text(_) => match self.advance()? {
                Token::Text(text) => Ok(text),
                _ => Ok(String::new()),
            },
            _ => Err(self.unexpected("a string")),
        }
    }

    fn unexpected(&self, expected: &str) -> UsdError {
        let found = match &self.next {
            Token::Name(name) => format!("`{}`", excerpt(name.as_bytes())),
            Token::Number(x) => format!("`{x}`"),
            Token::Text(text) => format!("the string `{}`", excerpt(text.as_bytes())),
            Token::Link(link) => format!("the path `{}`", excerpt(link.as_bytes())),
            Token::Sign(sign) => format!("`{sign}`"),
            Token::End => "the end of the file".to_owned(),
        };
        UsdError { line: self.line, message: format!("{expected} is expected, not {found}") }
    }

    /// Goes one level deeper for `inside`.
    fn nested<T>(
        &mut self,
        inside: impl FnOnce(&mut Self) -> Result<T, UsdError>,
    ) -> Result<T, UsdError> {
        self.depth += 1;
        if self.depth > MAX_DEPTH {
            let message = format!("there are more than {MAX_DEPTH} brackets in each other");
            return Err(UsdError { line: self.line, message });
        }
        let result = inside(self);
        self.depth -= 1;
        result
    }

    fn prim(&mut self) -> Result<Prim, UsdError> {
        let line = self.line;
        let is_defined = match self.next {
            Token::Name("def") => true,
            Token::Name("over" | "class") => false,
            _ => return Err(self.unexpected("`def`, `over` or `class`")),
        };
        self.advance()?;
        let type_name = match self.next {
            Token::Name(_) => self.name()?.to_owned(),
            _ => String::new(),
        };
        let name = self.text()?;
        let mut prim =
            Prim { is_defined, type_name, name, line, is_active: true, ..Prim::default() };
        if self.next == Token::Sign('(') {
            for (key, value) in self.metadata()? {
                prim.is_active &= key != "active" || value != Value::Texts(vec!["false".into()]);
                if COMPOSITION.contains(&key) {
                    prim.arcs.push(key.to_owned());
                }
            }
        }
        self.expect('{')?;
        self.nested(|parser| parser.statements(&mut prim))?;
        Ok(prim)
    }

    fn statements(&mut self, prim: &mut Prim) -> Result<(), UsdError> {
        while !self.eat('}')? {
            match self.next {
                Token::Sign(';') => drop(self.advance()?),
                Token::Name("def" | "over" | "class") => prim.children.push(self.prim()?),
                Token::Name("variantSet") => {
                    prim.arcs.push("variantSet".to_owned());
                    self.variant_set()?;
                }
                Token::Name(_) => prim.attributes.extend(self.property()?),
                _ => return Err(self.unexpected("a property, a prim or `}`")),
            }
        }
        Ok(())
    }

    /// `variantSet "name" = { "variant" [metadata] { statements } ... }`, not kept.
    fn variant_set(&mut self) -> Result<(), UsdError> {
        self.advance()?;
        self.text()?;
        self.expect('=')?;
        self.expect('{')?;
        while !self.eat('}')? {
            self.text()?;
            if self.next == Token::Sign('(') {
                self.metadata()?;
            }
            self.expect('{')?;
            self.nested(|parser| parser.statements(&mut Prim::default()))?;
        }
        Ok(())
    }

    /// A property; `None` if it is no attribute.
    fn property(&mut self) -> Result<Option<Attribute>, UsdError> {
        let line = self.line;
        let mut word = self.name()?;
        let mut is_attribute = true;
        while QUALIFIERS.contains(&word) {
            word = self.name()?;
        }
        if matches!(word, "rel" | "properties" | "nameChildren" | "rootPrims") {
            is_attribute = false;
        }
        if self.eat('[')? {
            self.expect(']')?;
        }
        // `reorder properties = [...]` has no name beside the word.
        let name = match self.next {
            Token::Sign('=') if !is_attribute => word,
            _ => self.name()?,
        };
        let value = if self.eat('=')? { self.value()? } else { Value::None };
        let mut interpolation = None;
        if self.next == Token::Sign('(') {
            for (key, value) in self.metadata()? {
                match value {
                    Value::Texts(texts) if key == "interpolation" => {
                        interpolation = texts.into_iter().next();
                    }
                    _ => {}
                }
            }
        }
        let attribute = Attribute { name: name.to_owned(), line, value, interpolation };
        Ok(is_attribute.then_some(attribute))
    }

    fn metadata(&mut self) -> Result<Vec<(&'a str, Value)>, UsdError> {
        self.expect('(')?;
        self.nested(|parser| {
            let mut entries = Vec::new();
            while !parser.eat(')')? {
                match parser.next {
                    Token::Text(_) | Token::Sign(';' | ',') => drop(parser.advance()?),
                    _ => {
                        let mut key = parser.name()?;
                        while QUALIFIERS.contains(&key) {
                            key = parser.name()?;
                        }
                        parser.expect('=')?;
                        entries.push((key, parser.value()?));
                    }
                }
            }
            Ok(entries)
        })
    }

    fn value(&mut self) -> Result<Value, UsdError> {
        match self.next {
            Token::Sign('[') => self.nested(Self::list),
            Token::Sign('(') => {
                let mut values = Vec::new();
                let width = self.tuple(&mut values)?;
                let lines = Vec::new();
                Ok(width.map_or(Value::Other, |width| Value::Numbers { values, width, lines }))
            }
            Token::Sign('{') => self.nested(Self::dictionary),
            Token::Name("None") => self.advance().map(|_| Value::None),
            _ => {
                let mut list = Collected::default();
                self.single(&mut list)?;
                Ok(list.finish())
            }
        }
    }

    /// `[` values `]`.
    fn list(&mut self) -> Result<Value, UsdError> {
        self.expect('[')?;
        let mut list = Collected::default();
        while !self.eat(']')? {
            match self.next {
                Token::Sign('(') => {
                    list.lines.push(u32::try_from(self.line).unwrap_or(u32::MAX));
                    let width = self.tuple(&mut list.numbers)?;
                    list.add_width(width);
                }
                Token::Sign('[' | '{') => {
                    self.value()?;
                    list.add_width(None);
                }
                _ => self.single(&mut list)?,
            }
            if self.next != Token::Sign(']') && !self.eat(',')? {
                return Err(self.unexpected("after a value of a list, `,` or `]`"));
            }
        }
        Ok(list.finish())
    }

    /// A value without brackets.
    fn single(&mut self, list: &mut Collected) -> Result<(), UsdError> {
        match self.next {
            Token::Number(x) => {
                self.advance()?;
                list.numbers.push(x);
                list.add_width(Some(1));
            }
            Token::Name(name) => {
                self.advance()?;
                match name {
                    "inf" | "nan" => {
                        list.numbers.push(if name == "inf" { f64::INFINITY } else { f64::NAN });
                        list.add_width(Some(1));
                    }
                    "None" => list.add_width(None),
                    _ => list.texts.push(name.to_owned()),
                }
            }
            Token::Text(_) => list.texts.push(self.text()?),
            Token::Link(_) => {
                while matches!(self.next, Token::Link(_)) {
                    self.advance()?;
                }
                if self.next == Token::Sign('(') {
                    self.metadata()?;
                }
                list.add_width(None);
            }
            _ => return Err(self.unexpected("a value")),
        }
        Ok(())
    }

    /// `(` values `)`: adds the numbers, also those of tuples inside; how many there are, or
    /// `None` if there is something else.
    fn tuple(&mut self, numbers: &mut Vec<f64>) -> Result<Option<usize>, UsdError> {
        self.expect('(')?;
        self.nested(|parser| {
            let mut count = Some(0);
            while !parser.eat(')')? {
                let added = if parser.next == Token::Sign('(') {
                    parser.tuple(numbers)?
                } else {
                    let mut single = Collected::default();
                    parser.single(&mut single)?;
                    numbers.extend(&single.numbers);
                    (single.numbers.len() == 1).then_some(1)
                };
                count = count.zip(added).map(|(a, b)| a + b);
                if parser.next != Token::Sign(')') && !parser.eat(',')? {
                    return Err(parser.unexpected("after a number of a tuple, `,` or `)`"));
                }
            }
            Ok(count)
        })
    }

    /// `{` entries `}`: the value of the first time if the keys are times.
    fn dictionary(&mut self) -> Result<Value, UsdError> {
        self.expect('{')?;
        let mut first: Option<(f64, Value)> = None;
        while !self.eat('}')? {
            match self.next {
                Token::Number(time) => {
                    self.advance()?;
                    self.expect(':')?;
                    let value = self.value()?;
                    if first.as_ref().is_none_or(|(other, _)| time < *other) {
                        first = Some((time, value));
                    }
                }
                Token::Sign(',' | ';') => drop(self.advance()?),
                _ => self.dictionary_entry()?,
            }
        }
        Ok(first.map_or(Value::Other, |(_, value)| value))
    }

    fn dictionary_entry(&mut self) -> Result<(), UsdError> {
        while matches!(self.next, Token::Name(_)) {
            self.advance()?;
            if self.eat('[')? {
                self.expect(']')?;
            }
        }
        if matches!(self.next, Token::Text(_)) {
            self.advance()?;
        }
        self.expect('=')?;
        self.value().map(drop)
    }
}

/// Words that may stand before a type or a key.
const QUALIFIERS: [&str; 9] =
    ["custom", "uniform", "varying", "config", "prepend", "append", "add", "delete", "reorder"];

/// Metadata that brings in what is elsewhere.
const COMPOSITION: [&str; 5] = ["references", "payload", "inherits", "specializes", "variants"];

/// The values of a list so far.
#[derive(Default)]
struct Collected {
    numbers: Vec<f64>,
    texts: Vec<String>,
    /// The line of every tuple.
    lines: Vec<u32>,
    /// The numbers in every tuple.
    width: Option<usize>,
    is_other: bool,
}

impl Collected {
    /// Takes note of `width` numbers that were added, or of something else.
    fn add_width(&mut self, width: Option<usize>) {
        match width {
            Some(width) if width > 0 && self.width.is_none_or(|w| w == width) => {
                self.width = Some(width);
            }
            _ => self.is_other = true,
        }
    }

    fn finish(self) -> Value {
        match (self.numbers.is_empty(), self.texts.is_empty()) {
            _ if self.is_other => Value::Other,
            (false, false) => Value::Other,
            (true, false) => Value::Texts(self.texts),
            _ => {
                let Self { numbers: values, lines, width, .. } = self;
                Value::Numbers { values, width: width.unwrap_or(1), lines }
            }
        }
    }
}
