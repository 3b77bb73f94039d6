//! What lens flares knew of their light, from the frames whose work was counted.

use crate::measures::stats;
use crate::results;
use culling::flares::Settings;
use culling::{Flare, Work};

/// Puts what flares knew, and how far that is from what shows, in a method's results.
pub(super) fn put(method: &mut results::Method, settings: Option<&Settings>, work: &[Work]) {
    let Some(Settings { when, light }) = settings else { return };
    let flares: Vec<Flare> = work.iter().filter_map(|work| work.flare).collect();
    let by_query: Vec<f64> = flares.iter().map(|flare| flare.fraction(flare.used)).collect();
    let by_oracle: Vec<f64> =
        flares.iter().filter_map(|flare| flare.visible.map(|visible| flare.fraction(visible))).collect();
    let errors: Vec<f64> = by_query.iter().zip(&by_oracle).map(|(query, oracle)| (query - oracle).abs()).collect();
    method.flare = Some(results::FlareErrors {
        when: when.name().to_owned(),
        light: light.to_string(),
        frames_on_screen: flares.iter().filter(|flare| flare.asked.is_some()).count() as u32,
        shows_mean: stats::mean(&by_oracle),
        error_mean: stats::mean(&errors),
        error_max: errors.iter().copied().reduce(f64::max),
    });
    (method.frames.flare_by_query, method.frames.flare_by_oracle) = (by_query, by_oracle);
}

#[cfg(test)]
mod tests {
    use super::*;
    use culling::flares::{Light, When};

    #[test]
    fn errors_are_between_what_was_used_and_what_shows() {
        let flare = |used, asked, visible| Work {
            flare: Some(Flare { used, asked, visible: Some(visible), of: 256 }),
            ..Work::default()
        };
        let work = [flare(0, Some(64), 64), flare(64, Some(128), 128), flare(0, None, 0), flare(0, Some(16), 0)];
        let mut method = results::Method::default();
        put(&mut method, None, &work);
        assert_eq!(method, results::Method::default(), "without flares nothing is said of them");
        let settings = Settings { when: When::Next, light: Light::default() };
        put(&mut method, Some(&settings), &work);
        let found = method.flare.unwrap();
        assert_eq!((found.error_mean, found.error_max, found.shows_mean), (Some(0.125), Some(0.25), Some(0.1875)));
        assert_eq!((found.frames_on_screen, found.when.as_str()), (3, "next"));
        assert_eq!(method.frames.flare_by_query, [0.0, 0.25, 0.0, 0.0]);
        assert_eq!(method.frames.flare_by_oracle, [0.25, 0.5, 0.0, 0.0]);
    }

    #[test]
    fn what_was_not_measured_is_not_said_to_be_right() {
        let mut method = results::Method::default();
        put(&mut method, Some(&Settings { when: When::Same, light: Light::default() }), &[]);
        let found = method.flare.unwrap();
        assert_eq!((found.error_mean, found.error_max, found.shows_mean), (None, None, None));
    }
}
