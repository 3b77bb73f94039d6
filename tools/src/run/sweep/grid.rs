//! Which settings a sweep has.

use anyhow::{bail, Context, Result};
use culling::{Entry, Options};

/// Most settings of all sweeps together: more is a slip of the hand.
pub const MOST_SETTINGS: usize = 10_000;

/// One option and the values it takes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Sweep {
    /// The method's id.
    pub method: String,
    /// The option.
    pub option: String,
    /// Its values, as text, in the order given.
    pub values: Vec<String>,
}

impl Sweep {
    /// Reads `woc.seeds=1,2,4` or `woc.iterations=1..4` (both ends are run), and checks each value.
    ///
    /// # Errors
    /// Another form, an unknown method, option or value: named, with what there is.
    pub fn parse(text: &str) -> Result<Self> {
        let form = || {
            format!(
                "--sweep {text}: write METHOD.OPTION=VALUE,VALUE or METHOD.OPTION=FIRST..LAST, as in woc.seeds=1,2,4"
            )
        };
        let (method, rest) = text.split_once('.').with_context(form)?;
        let (option, values) = rest.split_once('=').with_context(form)?;
        let entry = culling::find(method).with_context(|| format!("--sweep {text}"))?;
        let mut expanded = Vec::new();
        for value in values.split(',').map(str::trim).filter(|value| !value.is_empty()) {
            match value.split_once("..") {
                Some((first, last)) => expanded.extend(range(first, last.trim_start_matches('='), text)?),
                None => expanded.push(value.to_owned()),
            }
        }
        if expanded.is_empty() {
            bail!(form());
        }
        let mut options = entry.default_options();
        for (index, value) in expanded.iter().enumerate() {
            options.set(option, value).with_context(|| format!("--sweep {text}"))?;
            if expanded[..index].contains(value) {
                bail!("--sweep {text}: '{value}' is there twice");
            }
        }
        Ok(Sweep { method: method.to_owned(), option: option.to_owned(), values: expanded })
    }

    /// All combinations of the sweeps of each method, on top of the settings that `base` gives the method.
    ///
    /// # Errors
    /// An option swept twice, or more than [`MOST_SETTINGS`].
    pub fn settings(
        sweeps: &[Sweep],
        base: &dyn Fn(&Entry) -> Result<Options>,
    ) -> Result<Vec<(&'static Entry, Options)>> {
        let mut all: Vec<(&'static Entry, Options)> = Vec::new();
        let mut done: Vec<&str> = Vec::new();
        for sweep in sweeps {
            if done.contains(&sweep.method.as_str()) {
                continue;
            }
            done.push(&sweep.method);
            let entry = culling::find(&sweep.method)?;
            let mut settings = vec![base(entry)?];
            let mut swept: Vec<&str> = Vec::new();
            for Sweep { option, values, .. } in sweeps.iter().filter(|other| other.method == sweep.method) {
                if swept.contains(&option.as_str()) {
                    bail!("--sweep: {}.{option} is swept twice; give all its values at once", sweep.method);
                }
                swept.push(option);
                if settings.len() * values.len() + all.len() > MOST_SETTINGS {
                    bail!("--sweep: more than {MOST_SETTINGS} settings; sweep fewer options or values");
                }
                settings = combined(&settings, option, values)?;
            }
            all.extend(settings.into_iter().map(|options| (entry, options)));
        }
        Ok(all)
    }
}

fn combined(settings: &[Options], option: &str, values: &[String]) -> Result<Vec<Options>> {
    let mut all = Vec::new();
    for before in settings {
        for value in values {
            let mut options = before.clone();
            options.set(option, value)?;
            all.push(options);
        }
    }
    Ok(all)
}

fn range(first: &str, last: &str, text: &str) -> Result<Vec<String>> {
    let number = |part: &str| {
        part.trim()
            .parse::<u32>()
            .with_context(|| format!("--sweep {text}: '{part}' is no whole number; ranges are FIRST..LAST"))
    };
    let (first, last) = (number(first)?, number(last)?);
    if first > last || (last - first) as usize >= MOST_SETTINGS {
        bail!("--sweep {text}: the range {first}..{last} must rise, and have fewer than {MOST_SETTINGS} values");
    }
    Ok((first..=last).map(|value| value.to_string()).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(sweeps: &[&str]) -> Result<Vec<String>> {
        let sweeps = sweeps.iter().map(|text| Sweep::parse(text)).collect::<Result<Vec<_>>>()?;
        let settings = Sweep::settings(&sweeps, &|entry| Ok(entry.default_options()))?;
        Ok(settings.iter().map(|(_, options)| options.label()).collect())
    }

    #[test]
    fn a_grid_has_every_combination_once() {
        let grid = labels(&["woc.seeds=1,2", "hzb.texels=2,4", "woc.iterations=3..5"]).unwrap();
        assert_eq!(grid.len(), 2 * 3 + 2);
        let unique: std::collections::BTreeSet<&String> = grid.iter().collect();
        assert_eq!(unique.len(), grid.len(), "{grid:?}");
        assert!(grid.contains(&"woc[seeds=2,iterations=3]".to_owned()), "{grid:?}");
    }

    #[test]
    fn what_is_wrong_with_a_sweep_is_said() {
        for (sweeps, expected) in [
            (&["woc"][..], "write METHOD.OPTION=VALUE"),
            (&["woc.seeds="], "write METHOD.OPTION=VALUE"),
            (&["wok.seeds=1"], "wok"),
            (&["woc.seed=1"], "seeds"),
            (&["woc.seeds=1,x"], "'x'"),
            (&["woc.seeds=4..1"], "must rise"),
            (&["woc.seeds=1..z"], "no whole number"),
            (&["woc.seeds=1,2,1"], "'1' is there twice"),
            (&["woc.seeds=1", "woc.seeds=2"], "swept twice"),
            (
                &["eovc.every=1..64", "woc.seeds=1..64", "woc.iterations=1..16", "woc.steps=0..8", "woc.tile=1,2"],
                "more than 10000",
            ),
        ] {
            let error = format!("{:#}", labels(sweeps).unwrap_err());
            assert!(error.contains(expected), "{sweeps:?}: {error}");
        }
    }
}
