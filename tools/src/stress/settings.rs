//! Settings of methods by chance: each option has many values, and a bug may need two of them at once.

use super::{Random, Subject};
use culling::auto::ALLOW_ERROR_OPTION;
use culling::queries::MIN_PIXELS_OPTION;
use culling::world::DETAIL_OPTION;
use culling::OptionInfo;

/// The same method with every option at a value by chance: one of those listed, or, of a range, one near its ends or the
/// default. Options of another kind keep theirs.
pub fn by_chance(subject: &Subject, random: &mut Random) -> Subject {
    let mut subject = subject.clone();
    for option in subject.options.known().iter().filter(|option| !asks_for_errors(option)) {
        let values = choices(option.values, option.default);
        // Values come from the option's own list; one that it refuses all the same leaves the default.
        let _ = subject.options.set(option.name, &values[random.below(values.len())]);
    }
    subject
}

/// Whoever leaves out details, or allows errors, asks for errors.
fn asks_for_errors(option: &OptionInfo) -> bool {
    [DETAIL_OPTION, MIN_PIXELS_OPTION, ALLOW_ERROR_OPTION].contains(option)
}

/// Values worth trying, at least one.
fn choices(values: &str, default: &str) -> Vec<String> {
    let Some((low, high)) = values.split_once("..=") else {
        return values.split('|').map(str::to_owned).collect();
    };
    match (low.parse::<u64>(), high.parse::<u64>()) {
        (Ok(low), Ok(high)) => {
            let near =
                [low, low + 1, low + 6].into_iter().filter(|value| *value <= high).map(|value| value.to_string());
            near.chain([default.to_owned()]).collect()
        }
        _ => vec![default.to_owned()],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_option_of_every_method_is_tried() {
        for entry in culling::METHODS {
            let plain = Subject { options: entry.default_options(), make: entry.make };
            let mut seen = std::collections::BTreeMap::<String, std::collections::BTreeSet<String>>::new();
            let mut random = Random::new(3);
            for _ in 0..200 {
                for (name, value) in by_chance(&plain, &mut random).options.all() {
                    seen.entry(name).or_default().insert(value);
                }
            }
            for option in entry.options.iter().filter(|option| !asks_for_errors(option)) {
                let tried = &seen[option.name];
                assert!(tried.len() >= 2, "{}.{}: only {tried:?}", entry.id, option.name);
                let mut fresh = entry.default_options();
                tried.iter().for_each(|value| fresh.set(option.name, value).unwrap());
            }
        }
    }
}
