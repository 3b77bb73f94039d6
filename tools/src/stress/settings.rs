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

    #[test]
    fn choices_of_a_range_lie_at_its_beginning_and_at_the_default() {
        assert_eq!(choices("0..=10", "3"), ["0", "1", "6", "3"]);
        assert_eq!(choices("5..=6", "5"), ["5", "6", "5"]);
        assert_eq!(choices("2..=8", "4"), ["2", "3", "8", "4"]);
        assert_eq!(choices("7..=7", "7"), ["7", "7"]);
        assert_eq!(choices("a|b|c", "b"), ["a", "b", "c"]);
        assert_eq!(choices("0.0..=1.0", "0.5"), ["0.5"], "a range of fractions keeps its default");
    }

    /// A method that leaves out details, or is allowed errors, would fail for what it was asked to do.
    #[test]
    fn no_setting_by_chance_asks_for_errors() {
        let mut random = Random::new(5);
        let mut found = 0;
        for entry in culling::METHODS {
            let plain = Subject { options: entry.default_options(), make: entry.make };
            for option in entry.options.iter().filter(|option| asks_for_errors(option)) {
                found += 1;
                let default = &plain.options.all()[option.name];
                let tried = (0..50).map(|_| by_chance(&plain, &mut random).options.all()[option.name].clone());
                assert!(tried.into_iter().all(|value| value == *default), "{}.{}", entry.id, option.name);
            }
        }
        assert!(found > 3, "only {found} such options");
    }
}
