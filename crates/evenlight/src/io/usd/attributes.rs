//! Attributes by name and type.

use super::UsdError;
use super::parse::{Attribute, Prim, Value};
use crate::io::excerpt::excerpt;

/// The attributes of a prim, and what was remarkable about them.
pub(super) struct Attributes<'a> {
    prim: &'a Prim,
    /// The names of attributes whose first value over time was taken.
    pub animated: Vec<String>,
}

/// A value with its place.
pub(super) struct Found<'a, T: ?Sized> {
    pub value: &'a T,
    attribute: &'a Attribute,
}

/// Numbers of things, and where they stand.
pub(super) type Ids<'a> = (Vec<u32>, Found<'a, [f64]>);

impl<T: ?Sized> Found<'_, T> {
    /// The line of every tuple of a list; empty for other values.
    pub fn lines(&self) -> &[u32] {
        match &self.attribute.value {
            Value::Numbers { lines, .. } => lines,
            _ => &[],
        }
    }

    /// A fault of the attribute; `what` goes on after its name.
    pub fn fault(&self, what: &str) -> UsdError {
        fault(self.attribute, what)
    }
}

impl<'a> Attributes<'a> {
    /// Those of `prim`.
    pub fn new(prim: &'a Prim) -> Self {
        Self { prim, animated: Vec::new() }
    }

    /// The attribute of this name that has a value.
    pub fn find(&mut self, name: &str) -> Option<&'a Attribute> {
        let all = || self.prim.attributes.iter().filter(|a| a.value != Value::None);
        if let Some(found) = all().find(|a| a.name == name) {
            return Some(found);
        }
        let over_time = |a: &&Attribute| a.name.strip_suffix(".timeSamples") == Some(name);
        let found = all().find(over_time)?;
        if !self.animated.iter().any(|other| other == name) {
            self.animated.push(name.to_owned());
        }
        Some(found)
    }

    /// Numbers in tuples of `width`.
    pub fn numbers(
        &mut self,
        name: &str,
        width: usize,
    ) -> Result<Option<Found<'a, [f64]>>, UsdError> {
        let Some(attribute) = self.find(name) else { return Ok(None) };
        match &attribute.value {
            // An empty list has no width of its own.
            Value::Numbers { values, width: found, .. } if *found == width || values.is_empty() => {
                Ok(Some(Found { value: values, attribute }))
            }
            _ if width == 1 => Err(fault(attribute, "must be a list of numbers")),
            _ => Err(fault(attribute, &format!("must have tuples of {width} numbers"))),
        }
    }

    /// Numbers of things, from 0.
    pub fn ids(&mut self, name: &str) -> Result<Option<Ids<'a>>, UsdError> {
        let Some(found) = self.numbers(name, 1)? else { return Ok(None) };
        let id = |&x: &f64| {
            let is_id = x.fract() == 0.0 && (0.0..f64::from(u32::MAX)).contains(&x);
            let message = || found.fault(&format!("has {x}, which is not a whole number from 0"));
            if is_id { Ok(x as u32) } else { Err(message()) }
        };
        Ok(Some((found.value.iter().map(id).collect::<Result<_, _>>()?, found)))
    }

    /// The one of `choices` whose name is the value.
    pub fn choice<T: Copy>(
        &mut self,
        name: &str,
        choices: &[(&str, T)],
    ) -> Result<Option<T>, UsdError> {
        let Some(text) = self.text(name)? else { return Ok(None) };
        match choices.iter().find(|(name, _)| *name == text.value) {
            Some((_, choice)) => Ok(Some(*choice)),
            None => {
                let names: Vec<&str> = choices.iter().map(|(name, _)| *name).collect();
                let found = excerpt(text.value.as_bytes());
                Err(text.fault(&format!("is `{found}`, but can be {}", names.join(", "))))
            }
        }
    }

    /// A string or token.
    pub fn text(&mut self, name: &str) -> Result<Option<Found<'a, str>>, UsdError> {
        let Some(attribute) = self.find(name) else { return Ok(None) };
        match &attribute.value {
            Value::Texts(texts) if texts.len() == 1 => {
                Ok(Some(Found { value: &texts[0], attribute }))
            }
            _ => Err(fault(attribute, "must be one token, as in \"none\"")),
        }
    }
}

/// A fault of `attribute`; `what` goes on after its name.
pub(super) fn fault(attribute: &Attribute, what: &str) -> UsdError {
    let name = excerpt(attribute.name.as_bytes());
    UsdError { line: attribute.line, message: format!("`{name}` {what}: correct it") }
}
