//! Lens flares, and where their light is.

use crate::run::session::SessionOptions;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::Args;
use culling::flares::{Light, Settings, When};
use glam::DVec3;

/// Whether there is a lens flare.
#[derive(Args, Clone, Copy, Debug, Default)]
pub struct FlareChoice {
    /// Draws a lens flare over each frame, as bright as an occlusion query of 16x16 pixels says that its light shows (GPU Gems 29.8): by
    /// the answer of the frame before (next, if nothing is said), or by its own, which it waits for (same). `bench` tells how far that is
    /// from what the depth buffer shows
    #[arg(long, value_name = "next|same", num_args = 0..=1, require_equals = true, default_missing_value = When::Next.name(),
        value_parser = when_names())]
    pub flares: Option<When>,
    /// The flare's light is infinitely far away in this direction; if left out, where surfaces are lit from (0.4,0.82,0.41)
    #[arg(long, value_name = "X,Y,Z", requires = "flares", allow_hyphen_values = true, value_parser = parse_direction)]
    pub light: Option<DVec3>,
    /// The flare's light is at this place in the scene, in metres
    #[arg(long, value_name = "X,Y,Z", requires = "flares", conflicts_with = "light", allow_hyphen_values = true,
        value_parser = parse_place)]
    pub light_at: Option<DVec3>,
}

impl FlareChoice {
    /// A session with such flares.
    pub fn of(self, session: SessionOptions) -> SessionOptions {
        SessionOptions { flares: self.settings(), ..session }
    }

    fn settings(self) -> Option<Settings> {
        let light = match (self.light_at, self.light) {
            (Some(place), _) => Light::At(place),
            (None, Some(direction)) => Light::Towards(direction),
            (None, None) => Light::default(),
        };
        self.flares.map(|when| Settings { when, light })
    }
}

fn when_names() -> impl TypedValueParser<Value = When> {
    let named = |name: String| When::ALL.into_iter().find(|when| when.name() == name).unwrap_or_default();
    PossibleValuesParser::new(When::ALL.map(When::name)).map(named)
}

fn parse_place(text: &str) -> Result<DVec3, String> {
    let parts: Option<Vec<f64>> = text.split(',').map(|part| part.trim().parse().ok()).collect();
    match parts.as_deref() {
        Some(&[x, y, z]) if [x, y, z].iter().all(|part| part.is_finite()) => Ok(DVec3::new(x, y, z)),
        _ => Err("give three numbers, as in 0.4,0.82,0.41".to_owned()),
    }
}

fn parse_direction(text: &str) -> Result<DVec3, String> {
    let direction = parse_place(text)?;
    let size = direction.length();
    if size > 0.0 && size.is_finite() {
        Ok(direction)
    } else {
        Err("it is no direction: give one that is longer than 0".to_owned())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::{Cli, Command};
    use clap::Parser;

    fn read(line: &str) -> Result<Option<Settings>, String> {
        let cli = Cli::try_parse_from(line.split(' ')).map_err(|error| error.to_string())?;
        Ok(match cli.command {
            Command::Bench(arguments) => arguments.flares.of(SessionOptions::default()).flares,
            Command::Shot(arguments) => arguments.flares.of(SessionOptions::default()).flares,
            Command::View(arguments) => arguments.flares.of(SessionOptions::default()).flares,
            other => panic!("{other:?}"),
        })
    }

    #[test]
    fn flares_are_off_unless_asked_for_and_late_unless_told_to_wait() {
        let settings = |when, light| Some(Settings { when, light });
        for command in ["bench", "shot", "view"] {
            assert_eq!(read(&format!("sightline {command}")).unwrap(), None);
            let late = read(&format!("sightline {command} --flares --scene rooms")).unwrap();
            assert_eq!(late, settings(When::Next, Light::default()));
            let waits = read(&format!("sightline {command} --flares=same --light -1,0.5,2e-1")).unwrap();
            assert_eq!(waits, settings(When::Same, Light::Towards(DVec3::new(-1.0, 0.5, 0.2))));
        }
        let lamp = read("sightline shot --flares=next --light-at 1,2,-3").unwrap();
        assert_eq!(lamp, settings(When::Next, Light::At(DVec3::new(1.0, 2.0, -3.0))));
    }

    #[test]
    fn what_makes_no_sense_is_refused_with_the_flag() {
        for (line, said) in [
            ("bench --flares=later", "--flares"),
            ("bench --light 1,0,0", "--flares"),
            ("bench --flares --light 1,0", "three numbers"),
            ("bench --flares --light 0,0,0", "no direction"),
            ("bench --flares --light-at 1,inf,0", "three numbers"),
            ("bench --flares --light 1,0,0 --light-at 1,0,0", "--light-at"),
            ("bench --flares --table lean", "--table"),
            ("bench --flares --sweep woc.size=1,2", "--sweep"),
        ] {
            let error = read(&format!("sightline {line}")).unwrap_err();
            assert!(error.contains(said), "{line}: {error}");
        }
    }
}
