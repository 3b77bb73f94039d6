//! What `--explain` says of skipped stages, and what `--no-skip` (the option `skip=false`) makes of them, on a device.

use culling::world::Still;
use harness::{gpu, sessions};
use sightline::results::{stages_table, Results};
use sightline::run::bench::{bench, BenchOptions};

const METHODS: [&str; 4] = ["frustum", "hzb", "eovc", "auto"];

/// A still camera: whatever can be skipped is skipped in every measured frame.
fn still(skip: &str) -> Results {
    let gpu = gpu();
    let mut session = sessions::open(&gpu, ("rooms", 0.1, "still"), 3);
    let chosen = METHODS.map(|id| {
        let entry = culling::find(id).unwrap();
        let mut options = entry.default_options();
        options.set("skip", skip).unwrap();
        (entry, options)
    });
    let options = BenchOptions {
        methods: chosen.into(),
        warmup: 12,
        metrics: false,
        pairs: Vec::new(),
        capture: None,
        cache: None,
        command: String::new(),
    };
    bench(&mut session, options, &mut |_, _, _| ()).unwrap()
}

fn is_still(reason: &Option<String>) -> bool {
    reason.as_deref().is_some_and(|reason| reason.contains(Still::REASON))
}

#[test]
fn what_is_skipped_says_why_and_what_it_saves_and_without_skipping_nothing_is() {
    let skipping = still("true");
    for method in &skipping.methods {
        let skipped: Vec<_> = method.stages.iter().filter(|stage| is_still(&stage.reason)).collect();
        assert!(!skipped.is_empty(), "{}: nothing was skipped", method.label);
        // The warm-up ran them, so that is known.
        assert!(skipped.iter().any(|stage| stage.saved_ms.is_some_and(|ms| ms > 0.0)), "{}: {skipped:?}", method.label);
        assert!(skipped.iter().all(|stage| stage.skipped > 0 && stage.skipped <= 3));
        assert!(stages_table(&skipping, method).contains(Still::REASON));
    }
    for method in &still("false").methods {
        let skipped: Vec<_> = method.stages.iter().filter(|stage| is_still(&stage.reason)).collect();
        assert!(skipped.is_empty(), "{}: {skipped:?}", method.label);
    }
}
