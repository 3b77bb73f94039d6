//! Gates: sentences such as `woc.ratio>1.1` that must not be true of a run, for continuous integration.

use super::fields::{delta, fields, names, Fields};
use super::Comparison;
use crate::results::{Method, Results};
use anyhow::{bail, Result};
use serde::Serialize;
use std::str::FromStr;

/// How a figure may stand to a number. Of two that begin alike, the longer comes first.
const OPERATORS: [(&str, Holds); 6] = [
    (">=", |figure, number| figure >= number),
    ("<=", |figure, number| figure <= number),
    ("==", |figure, number| figure == number),
    ("!=", |figure, number| figure != number),
    (">", |figure, number| figure > number),
    ("<", |figure, number| figure < number),
];

/// The figures that only a comparison has.
const RATIOS: [&str; 3] = ["ratio", "ratio_low", "ratio_high"];

/// Behind the name of a field: B's less A's.
const DELTA: &str = "_delta";

/// The name that stands for every method.
const ANY: &str = "any";

type Holds = fn(f64, f64) -> bool;

/// `METHOD.FIELD OP NUMBER`: fails if it is true.
#[derive(Clone, Debug)]
pub struct Gate {
    /// As it was typed.
    pub text: String,
    /// A label, an id (all labels of that method), or `any`.
    pub method: String,
    /// A field of the method's row in `results.json`, the same with `_delta`, or a ratio.
    pub field: String,
    holds: Holds,
    number: f64,
}

/// A method's figure.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Figure {
    /// The method.
    pub label: String,
    /// Its figure; `null` in JSON stands for infinity, as of the PSNR of identical pictures.
    pub figure: f64,
}

/// What a gate found.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Outcome {
    /// The gate as it was typed.
    pub gate: String,
    /// Whether it is true of any method, which must not be.
    pub failed: bool,
    /// The methods of which it is true.
    pub fails: Vec<Figure>,
    /// The methods of which it is not.
    pub passes: Vec<Figure>,
    /// Methods meant that have no such figure: one that is only in B has no ratio. Never all of them.
    pub without: Vec<String>,
}

impl FromStr for Gate {
    type Err = String;

    /// Reads `woc[search.seeds=8].ratio > 1.1`. The method ends at the first dot outside of brackets, the field at the last
    /// operator.
    fn from_str(text: &str) -> Result<Self, String> {
        let form = "write METHOD.FIELD OP NUMBER with OP one of > >= < <= == !=, as in 'eovc.false_negatives>0'";
        let end = text.rfind(['<', '>', '=', '!']).ok_or(form)?;
        // An operator of two signs begins one before its last.
        let ends_here = |(sign, _): &&(&str, Holds)| text[..=end].ends_with(sign);
        let Some((sign, holds)) = OPERATORS.iter().find(ends_here) else { return Err(form.to_owned()) };
        let (subject, number) = (&text[..end + 1 - sign.len()], text[end + 1..].trim());
        let dot = first_dot(subject).ok_or(form)?;
        let (method, field) = (subject[..dot].trim(), subject[dot + 1..].trim());
        if method.is_empty() || field.is_empty() || number.is_empty() {
            return Err(form.to_owned());
        }
        let number: f64 = number.parse().map_err(|_| format!("'{number}' is no number; {form}"))?;
        if number.is_nan() {
            return Err("nothing stands in any relation to NaN".to_owned());
        }
        Ok(Gate { text: text.to_owned(), method: method.to_owned(), field: field.to_owned(), holds: *holds, number })
    }
}

/// Labels have dots in their brackets.
fn first_dot(subject: &str) -> Option<usize> {
    let mut depth = 0;
    subject.char_indices().find_map(|(at, letter)| {
        match letter {
            '[' => depth += 1,
            ']' => depth -= 1,
            _ => {}
        }
        (letter == '.' && depth == 0).then_some(at)
    })
}

impl Gate {
    /// Looks at the methods of B that are meant; `a` and the comparison are `None` if B is alone.
    ///
    /// # Errors
    /// A method or field that is not there, with those that are; a figure that needs two files; a figure that none of the
    /// methods meant has, because it was not measured: a gate that nothing was asked of must not pass.
    pub fn check(&self, a: Option<&Results>, b: &Results, comparison: Option<&Comparison>) -> Result<Outcome> {
        let two_files = RATIOS.contains(&self.field.as_str()) || self.field.ends_with(DELTA);
        if two_files && comparison.is_none() {
            bail!("--fail-if '{}': {} needs two files, A and B", self.text, self.field);
        }
        let mut outcome = Outcome {
            gate: self.text.clone(),
            failed: false,
            fails: Vec::new(),
            passes: Vec::new(),
            without: Vec::new(),
        };
        let meant = self.meant(b)?;
        let rows = meant.iter().map(|method| fields(method)).collect::<Result<Vec<_>>>()?;
        self.check_field(&rows)?;
        for (method, row) in meant.iter().zip(&rows) {
            let label = method.label.clone();
            match self.figure(&label, row, a, comparison)? {
                Some(figure) if (self.holds)(figure, self.number) => outcome.fails.push(Figure { label, figure }),
                Some(figure) => outcome.passes.push(Figure { label, figure }),
                None => outcome.without.push(label),
            }
        }
        if outcome.fails.is_empty() && outcome.passes.is_empty() {
            let why = if two_files { "is in both files and has it measured" } else { "has it measured" };
            bail!("--fail-if '{}': no figure; none of {} {why}", self.text, outcome.without.join(", "));
        }
        outcome.failed = !outcome.fails.is_empty();
        Ok(outcome)
    }

    /// An id means all labels of its method, also where one of them is the id itself.
    fn meant<'a>(&self, b: &'a Results) -> Result<Vec<&'a Method>> {
        let is_meant =
            |method: &&Method| self.method == ANY || self.method == method.label || self.method == method.method;
        let meant: Vec<&Method> = b.methods.iter().filter(is_meant).collect();
        if meant.is_empty() {
            let labels: Vec<&str> = b.methods.iter().map(|method| method.label.as_str()).collect();
            bail!("--fail-if '{}': B has no method '{}'; it has {}", self.text, self.method, labels.join(", "));
        }
        Ok(meant)
    }

    fn check_field(&self, rows: &[Fields]) -> Result<()> {
        let known = |name: &str| rows.iter().any(|row| row.contains_key(name));
        let bare = self.field.strip_suffix(DELTA).unwrap_or(&self.field);
        if RATIOS.contains(&self.field.as_str()) || known(&self.field) || known(bare) {
            return Ok(());
        }
        let all = rows.iter().flatten().map(|(name, figure)| (name.clone(), *figure)).collect();
        bail!(
            "--fail-if '{}': there is no field '{}'; there are {}, each also with {DELTA} (B less A), and {}",
            self.text,
            self.field,
            names(&all).join(", "),
            RATIOS.join(", ")
        )
    }

    fn figure(
        &self,
        label: &str,
        row: &Fields,
        a: Option<&Results>,
        comparison: Option<&Comparison>,
    ) -> Result<Option<f64>> {
        if RATIOS.contains(&self.field.as_str()) {
            let pair = comparison.and_then(|both| both.methods.iter().find(|pair| pair.label == label));
            let ratio = pair.and_then(|pair| pair.frame.ratio);
            return Ok(ratio.map(|ratio| match self.field.as_str() {
                "ratio_low" => ratio.low,
                "ratio_high" => ratio.high,
                _ => ratio.ratio,
            }));
        }
        let number = |row: &Fields, name: &str| row.get(name).copied().flatten();
        let Some(bare) = self.field.strip_suffix(DELTA) else { return Ok(number(row, &self.field)) };
        let Some(method) = a.and_then(|a| a.method(label)) else { return Ok(None) };
        let before = number(&fields(method)?, bare);
        Ok(before.zip(number(row, bare)).map(|(a, b)| delta(a, b)))
    }
}
