//! Gates: `METHOD.FIELD OP NUMBER`, which must not be true.

use super::{Comparison, Row};
use crate::results::{Method, Results};
use anyhow::{bail, Context, Result};
use serde_json::Value;

type Holds = fn(f64, f64) -> bool;

/// How two numbers may stand to each other.
const OPERATORS: [(&str, Holds); 5] =
    [(">=", |a, b| a >= b), ("<=", |a, b| a <= b), ("==", |a, b| a == b), (">", |a, b| a > b), ("<", |a, b| a < b)];

/// Fields that only a comparison has.
const RATIOS: [&str; 3] = ["ratio", "ratio_low", "ratio_high"];

/// What ends the name of a field that is B's less A's.
const DELTA: &str = "_delta";

/// A sentence that must not be true.
#[derive(Clone, Debug)]
pub struct Gate {
    text: String,
    /// A label, a method's id for all its labels, or `any`.
    method: String,
    field: String,
    operator: Holds,
    bound: f64,
}

/// A gate that was true.
#[derive(Clone, Debug, PartialEq)]
pub struct Fact {
    /// The gate, as written.
    pub gate: String,
    /// Of which label.
    pub label: String,
    /// The number found.
    pub found: f64,
}

impl Gate {
    /// Reads `eovc.false_negatives>0`. The field comes behind the last dot before the operator that is not in brackets.
    ///
    /// # Errors
    /// Another form; says which part.
    pub fn parse(text: &str) -> Result<Self> {
        let form = || format!("--fail-if '{text}': write METHOD.FIELD>NUMBER, as in eovc.false_negatives>0");
        // Behind the label's brackets, which hold '=' themselves.
        let settings_end = text.rfind(']').map_or(0, |at| at + 1);
        let signs = OPERATORS.iter().filter_map(|(sign, holds)| Some((text[settings_end..].find(sign)?, sign, holds)));
        // The first sign, and of two at one place the longer, which comes first in the list.
        let (at, sign, operator) = signs.min_by_key(|(at, ..)| *at).with_context(form)?;
        let (left, right) = (&text[..settings_end + at], &text[settings_end + at + sign.len()..]);
        let dot = left[settings_end..].rfind('.').with_context(form)? + settings_end;
        let bound =
            right.trim().parse().with_context(|| format!("--fail-if '{text}': '{}' is no number", right.trim()))?;
        let (method, field) = (left[..dot].trim().to_owned(), left[dot + 1..].trim().to_owned());
        if method.is_empty() || field.is_empty() {
            bail!(form());
        }
        Ok(Gate { text: text.to_owned(), method, field, operator: *operator, bound })
    }

    /// Where the gate is true: of B alone, or of its comparison with A.
    ///
    /// # Errors
    /// A label or a field that is not there, with those that are; a field that needs two files.
    pub fn broken(&self, a: Option<&Results>, b: &Results, comparison: Option<&Comparison>) -> Result<Vec<Fact>> {
        let meant: Vec<&Method> = b.methods.iter().filter(|method| self.means(method)).collect();
        if meant.is_empty() {
            let labels: Vec<&str> = b.methods.iter().map(|method| method.label.as_str()).collect();
            bail!(
                "--fail-if '{}': no method is called '{}'; there are {}, or any",
                self.text,
                self.method,
                labels.join(", ")
            );
        }
        let mut facts = Vec::new();
        for method in meant {
            let found = self.value(method, a, comparison)?;
            if found.is_some_and(|found| (self.operator)(found, self.bound)) {
                let found = found.unwrap_or(f64::NAN);
                facts.push(Fact { gate: self.text.clone(), label: method.label.clone(), found });
            }
        }
        Ok(facts)
    }

    fn means(&self, method: &Method) -> bool {
        self.method == "any" || self.method == method.label || self.method == method.method
    }

    /// The number; none where the method is only in B and A is asked about.
    fn value(&self, method: &Method, a: Option<&Results>, comparison: Option<&Comparison>) -> Result<Option<f64>> {
        let two_files = || format!("--fail-if '{}': '{}' needs two files", self.text, self.field);
        if RATIOS.contains(&self.field.as_str()) {
            let rows = &comparison.with_context(two_files)?.rows;
            return Ok(rows.iter().find(|row| row.label == method.label).and_then(|row| self.ratio(row)));
        }
        let Some(field) = self.field.strip_suffix(DELTA) else {
            return Ok(Some(self.number(method, &self.field)?));
        };
        let old = a.with_context(two_files)?.method(&method.label);
        let new = self.number(method, field)?;
        old.map(|old| Ok(difference(new, self.number(old, field)?))).transpose()
    }

    fn ratio(&self, row: &Row) -> Option<f64> {
        match self.field.as_str() {
            "ratio_low" => row.ratio.low,
            "ratio_high" => row.ratio.high,
            _ => row.ratio.ratio,
        }
    }

    /// A field of a method as a number: `frame_ms.median` looks into an object, and a PSNR of null is of identical pictures.
    fn number(&self, method: &Method, field: &str) -> Result<f64> {
        let all = serde_json::to_value(method)?;
        let at =
            if field == "frame_ms" { "/frame_ms/median".to_owned() } else { format!("/{}", field.replace('.', "/")) };
        match all.pointer(&at) {
            Some(Value::Number(number)) => Ok(number.as_f64().unwrap_or(f64::NAN)),
            Some(Value::Null) if field.starts_with("psnr") => Ok(f64::INFINITY),
            _ => {
                let fields = all.as_object().into_iter().flatten();
                let numbers =
                    fields.filter(|(name, value)| value.is_number() || name.starts_with("psnr_") && !value.is_object());
                let names: Vec<&str> = numbers.map(|(name, _)| name.as_str()).collect();
                bail!(
                    "--fail-if '{}': '{field}' is no number of a method; there are frame_ms, {}, each with {DELTA}, and {}",
                    self.text,
                    names.join(", "),
                    RATIOS.join(", ")
                )
            }
        }
    }
}

/// B's less A's, where identical pictures on both sides are no difference.
fn difference(new: f64, old: f64) -> f64 {
    if new == old {
        0.0
    } else {
        new - old
    }
}

#[cfg(test)]
mod tests {
    use super::super::compare;
    use super::*;
    use crate::results::tests::results as example;

    fn broken(gate: &str, change: impl FnOnce(&mut Method)) -> Result<Vec<Fact>> {
        let a = example();
        let mut b = example();
        change(&mut b.methods[0]);
        let comparison = compare(&a, &b, false)?;
        Gate::parse(gate)?.broken(Some(&a), &b, Some(&comparison))
    }

    type Change = fn(&mut Method);

    #[test]
    fn gates_fire_and_do_not_fire() {
        let id = example().methods[0].method.clone();
        let gate = |text: &str| text.replace("ID", &id);
        let fires: [(&str, Change); 6] = [
            ("ID.false_negatives>7000", |method| method.false_negatives = 7001),
            ("any.psnr_worst_db<9", |method| method.psnr_worst_db = Some(8.5)),
            ("ID.ratio>1.4", |method| method.frames.frame_ms.iter_mut().for_each(|ms| *ms *= 1.5)),
            ("ID.ratio_low >= 1.4", |method| method.frames.frame_ms.iter_mut().for_each(|ms| *ms *= 1.5)),
            ("ID.drawn_mean_delta>0.5", |method| method.drawn_mean += 1.0),
            ("ID.frame_ms>1e6", |method| method.frame_ms.median = 2e6),
        ];
        for (text, change) in fires {
            assert_eq!(broken(&gate(text), |_| ()).unwrap(), [], "{text}");
            assert!(!broken(&gate(text), change).unwrap().is_empty(), "{text}");
        }
        assert_eq!(broken("any.psnr_worst_db<9", |method| method.psnr_worst_db = None).unwrap(), []);
        assert!(broken("any.psnr_worst_db_delta!=0", |_| ()).is_err());
    }

    #[test]
    fn labels_with_settings_can_be_named() {
        let mut b = example();
        b.methods[0].label = "woc[threshold=0.5,size=1]".into();
        b.methods[0].false_negatives = 3;
        let facts =
            Gate::parse("woc[threshold=0.5,size=1].false_negatives>=3").unwrap().broken(None, &b, None).unwrap();
        assert_eq!(facts.len(), 1);
    }

    #[test]
    fn what_is_wrong_with_a_gate_is_said() {
        for (text, expected) in [
            ("eovc", "write METHOD.FIELD>NUMBER"),
            ("eovc.false_negatives", "write METHOD.FIELD>NUMBER"),
            (".x>1", "write METHOD.FIELD>NUMBER"),
            ("eovc.x>one", "'one' is no number"),
        ] {
            let error = format!("{:#}", Gate::parse(text).unwrap_err());
            assert!(error.contains(expected), "{error}");
        }
        let unknown = broken("nobody.false_negatives>0", |_| ()).unwrap_err().to_string();
        assert!(unknown.contains("no method is called 'nobody'; there are "), "{unknown}");
        let field = broken("any.speed>0", |_| ()).unwrap_err().to_string();
        assert!(field.contains("'speed' is no number of a method") && field.contains("false_negatives"), "{field}");
        let single = Gate::parse("any.ratio>1").unwrap().broken(None, &example(), None).unwrap_err().to_string();
        assert!(single.contains("needs two files"), "{single}");
    }
}
