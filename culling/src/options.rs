//! Options of methods: `--set method.option=value`.

use crate::{Error, Result};
use std::collections::BTreeMap;

/// An option that a method has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OptionInfo {
    /// Its name.
    pub name: &'static str,
    /// Its default, as text.
    pub default: &'static str,
    /// The values it may have, separated by `|`, or "A..=B" for whole numbers.
    pub values: &'static str,
    /// What it does, in one line.
    pub help: &'static str,
}

/// The values of one method's options. What is not set has its default.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Options {
    method: &'static str,
    known: &'static [OptionInfo],
    set: BTreeMap<&'static str, String>,
}

impl Options {
    /// All defaults.
    pub fn new(method: &'static str, known: &'static [OptionInfo]) -> Self {
        Options { method, known, set: BTreeMap::new() }
    }

    /// The options that there are.
    pub fn known(&self) -> &'static [OptionInfo] {
        self.known
    }

    /// The method's id.
    pub fn method(&self) -> &'static str {
        self.method
    }

    /// Sets one option, after checking its name and value.
    pub fn set(&mut self, name: &str, value: &str) -> Result<()> {
        let Some(info) = self.known.iter().find(|info| info.name == name) else {
            let names: Vec<_> = self.known.iter().map(|info| info.name).collect();
            let choices = if names.is_empty() { "none".to_owned() } else { names.join(", ") };
            return Err(Error::UnknownOption { method: self.method.to_owned(), option: name.to_owned(), choices });
        };
        if !allowed(info.values, value) {
            return Err(Error::BadOption {
                method: self.method.to_owned(),
                option: name.to_owned(),
                value: value.to_owned(),
                expected: format!("it may be {}", info.values),
            });
        }
        self.set.insert(info.name, value.to_owned());
        Ok(())
    }

    /// The value of an option, as text. The name must be one the method declares.
    pub fn text(&self, name: &str) -> &str {
        match self.set.get(name) {
            Some(value) => value,
            None => self.known.iter().find(|info| info.name == name).map_or("", |info| info.default),
        }
    }

    /// The value of a yes-or-no option.
    pub fn flag(&self, name: &str) -> bool {
        self.text(name) == "true"
    }

    /// The value of a whole-number option; 0 if it is none, which `set` does not let through.
    pub fn number(&self, name: &str) -> u32 {
        self.text(name).parse().unwrap_or(0)
    }

    /// Every option with its value.
    pub fn all(&self) -> BTreeMap<String, String> {
        self.known.iter().map(|info| (info.name.to_owned(), self.text(info.name).to_owned())).collect()
    }

    /// The method's id, with `[option=value,…]` for what differs from its defaults.
    pub fn label(&self) -> String {
        let differs = |info: &&OptionInfo| self.text(info.name) != info.default;
        let parts: Vec<_> =
            self.known.iter().filter(differs).map(|info| format!("{}={}", info.name, self.text(info.name))).collect();
        if parts.is_empty() {
            self.method.to_owned()
        } else {
            format!("{}[{}]", self.method, parts.join(","))
        }
    }
}

fn allowed(values: &str, value: &str) -> bool {
    match values.split_once("..=") {
        Some((low, high)) => match (low.parse::<u32>(), high.parse::<u32>(), value.parse::<u32>()) {
            (Ok(low), Ok(high), Ok(value)) => (low..=high).contains(&value),
            _ => false,
        },
        None => values.split('|').any(|choice| choice == value),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const KNOWN: &[OptionInfo] = &[
        OptionInfo { name: "skip", default: "true", values: "true|false", help: "" },
        OptionInfo { name: "texels", default: "4", values: "2..=16", help: "" },
    ];

    #[test]
    fn a_label_names_only_what_differs() {
        let mut options = Options::new("hzb", KNOWN);
        assert_eq!(options.label(), "hzb");
        options.set("texels", "8").unwrap();
        options.set("skip", "true").unwrap();
        assert_eq!(options.label(), "hzb[texels=8]");
        assert_eq!(options.number("texels"), 8);
    }

    #[test]
    fn unknown_options_and_values_are_refused_by_name() {
        let mut options = Options::new("hzb", KNOWN);
        assert!(options.set("texel", "8").unwrap_err().to_string().contains("it has: skip, texels"));
        assert!(options.set("texels", "17").unwrap_err().to_string().contains("'hzb.texels' cannot be '17'"));
        assert!(options.set("skip", "yes").is_err());
    }
}
