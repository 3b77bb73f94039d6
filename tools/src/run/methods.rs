//! How methods and their options are written on the command line.

use anyhow::{bail, Context, Result};
use culling::{refusal, Entry, Options, METHODS, PARTICULAR};
use scenes::Scene;

/// Methods with their settings.
pub type Chosen = Vec<(&'static Entry, Options)>;

/// Reads `a,b[option=value,…],c` or `all`, and applies `--set`. Each method may come several times with other options.
pub fn parse_methods(list: &str, sets: &[String]) -> Result<Chosen> {
    let specs =
        if list == "all" { METHODS.iter().map(|entry| entry.id.to_owned()).collect() } else { split_methods(list)? };
    let mut chosen = Vec::new();
    for spec in &specs {
        let (name, inside) = match spec.split_once('[') {
            Some((name, rest)) => (name, rest.trim_end_matches(']')),
            None => (spec.as_str(), ""),
        };
        let entry = culling::find(name)?;
        let mut options = entry.default_options();
        for set in sets {
            let (method, option, value) = parse_setting(set)?;
            if method == name {
                options.set(option, value)?;
            }
        }
        for setting in inside.split(',').filter(|setting| !setting.is_empty()) {
            apply(&mut options, setting).with_context(|| format!("--method {spec}"))?;
        }
        chosen.push((entry, options));
    }
    check_unique(&chosen)?;
    Ok(chosen)
}

/// What `all` means for a scene beside [`parse_methods`]: methods that not every scene can have, with `--set` applied, and a line for each
/// that this one cannot have.
pub fn particular_methods(scene: &Scene, sets: &[String]) -> Result<(Chosen, Vec<String>)> {
    let (mut taken, mut left_out) = (Vec::new(), Vec::new());
    for entry in PARTICULAR {
        match refusal(entry, scene) {
            None => taken.extend(parse_methods(entry.id, sets)?),
            Some(refusal) => left_out.push(format!("left out: {refusal}")),
        }
    }
    Ok((taken, left_out))
}

/// Method, option and value of `METHOD.OPTION=VALUE`; there must be such a method, option and value, whether the run has the method or not.
pub fn parse_setting(set: &str) -> Result<(&str, &str, &str)> {
    let (method, setting) = set.split_once('.').with_context(|| bad_setting(set))?;
    let (option, value) = setting.split_once('=').with_context(|| bad_setting(set))?;
    culling::find(method)?.default_options().set(option, value).with_context(|| format!("--set {set}"))?;
    Ok((method, option, value))
}

fn apply(options: &mut Options, setting: &str) -> Result<()> {
    let (name, value) = setting.split_once('=').with_context(|| bad_setting(setting))?;
    Ok(options.set(name, value)?)
}

fn bad_setting(setting: &str) -> String {
    format!("'{setting}' is no setting; write METHOD.OPTION=VALUE, as in hzb.texels=8")
}

fn split_methods(list: &str) -> Result<Vec<String>> {
    let (mut specs, mut open) = (vec![String::new()], false);
    for letter in list.chars() {
        match letter {
            '[' if open => bail!("--method {list}: '[' inside '['"),
            '[' => open = true,
            ']' => open = false,
            _ => {}
        }
        match (letter, specs.last_mut()) {
            (',', _) if !open => specs.push(String::new()),
            (letter, Some(last)) => last.push(letter),
            _ => {}
        }
    }
    if open {
        bail!("--method {list}: a '[' is not closed");
    }
    specs.iter_mut().for_each(|spec| *spec = spec.trim().to_owned());
    specs.retain(|spec| !spec.is_empty());
    if specs.is_empty() {
        bail!("--method names no method; write for example --method none,hzb, or all");
    }
    Ok(specs)
}

fn check_unique(chosen: &[(&'static Entry, Options)]) -> Result<()> {
    for (index, (_, options)) in chosen.iter().enumerate() {
        if chosen[..index].iter().any(|(_, earlier)| earlier.label() == options.label()) {
            bail!("method '{}' is there twice; give it other options, or name it once", options.label());
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn methods_carry_their_options() {
        let sets = ["hzb.skip=false".to_owned()];
        let labels: Vec<_> = parse_methods("none,hzb,hzb[texels=8,skip=true]", &sets)
            .unwrap()
            .iter()
            .map(|(_, options)| options.label())
            .collect();
        assert_eq!(labels, ["none", "hzb[skip=false]", "hzb[texels=8]"]);
        assert_eq!(parse_methods("all", &[]).unwrap().len(), METHODS.len());
    }

    #[test]
    fn all_means_what_the_scene_can_have() {
        let options = scenes::SceneOptions { scale: 0.01, ..Default::default() };
        let methods = |scene: &str| {
            let scene = scenes::open(scene, &options).unwrap();
            let (taken, left_out) = particular_methods(&scene, &["horizon.skip=false".to_owned()]).unwrap();
            (taken.iter().map(|(_, options)| options.label()).collect::<Vec<_>>().join(" "), left_out.join("\n"))
        };
        let (taken, left_out) = methods("city-block");
        assert_eq!(taken, "horizon[skip=false]");
        assert!(left_out.contains("method 'portals' needs cells") && !left_out.contains("horizon"), "{left_out}");
        let (taken, left_out) = methods("boxes");
        assert!(taken.is_empty() && left_out.contains("method 'horizon' needs a city"), "{taken}, {left_out}");
        assert_eq!(methods("rooms").0, "portals");
    }

    #[test]
    fn faulty_methods_are_refused_by_name() {
        let fault = |list: &str, set: &str| {
            let sets: Vec<String> = [set.to_owned()].into_iter().filter(|set| !set.is_empty()).collect();
            format!("{:#}", parse_methods(list, &sets).unwrap_err())
        };
        assert!(fault("nine", "").contains("no method 'nine'"));
        assert!(fault("hzb,hzb", "").contains("'hzb' is there twice"));
        assert!(fault("hzb[texels=8", "").contains("not closed"));
        assert!(fault("hzb", "hzb.texels").contains("is no setting"));
        assert!(fault("hzb", "hxb.texels=4").contains("no method 'hxb'"));
        // Of a method that is not in the run.
        assert!(fault("none", "hzb.texels=many").contains("--set hzb.texels=many"));
        assert!(fault("none", "hzb.texel=8").contains("--set hzb.texel=8"));
        assert!(fault(",", "").contains("names no method"));
    }
}
