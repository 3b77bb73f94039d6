//! Exact methods lose nothing of random models, whichever way bounds of moving objects are computed.

use crate::{imported, models};
use harness::oracle::random;
use harness::sessions::faults;
use harness::{assert_none, gpu};
use scenes::MovingBounds;
use sightline::run::session::{Session, SessionOptions};

/// Every exact method that takes any scene, and options that use bounds in another way.
fn settings() -> Vec<(&'static str, &'static [(&'static str, &'static str)])> {
    let exact = culling::METHODS.iter().filter(|entry| entry.guarantee == culling::Guarantee::Exact);
    let others = [("frustum", &[("test", "obb")][..]), ("query-wait", &[("boxes", "8")][..])];
    exact.map(|entry| (entry.id, &[][..])).chain(others).collect()
}

#[test]
fn exact_methods_lose_nothing_of_random_models_in_four_ways_of_bounds() {
    // In a short run, each setting runs on one of four models in each way of bounds.
    let gpu = gpu();
    let all = std::env::var_os("SIGHTLINE_STRESS_CASES").is_some();
    let (count, settings) = (if all { models() } else { 4 }, settings());
    let mut found = Vec::new();
    for seed in 0..count {
        for (way, bounds) in MovingBounds::ALL.into_iter().enumerate() {
            let scene = imported(&random::model(seed).glb());
            let options = SessionOptions {
                path: Some(["rotate", "pan", "still", "walk"][(seed as usize + way) % 4].into()),
                whole_path: true,
                frames: 6,
                size: [160, 90],
                bounds,
                ..SessionOptions::default()
            };
            let mut session = Session::with_scene(&gpu, scene, options).unwrap();
            for (turn, (method, set)) in settings.iter().enumerate() {
                if all || (turn + way) % 4 == seed as usize % 4 {
                    let faults = faults(&mut session, method, set);
                    // A view of nothing proves nothing, but it is no fault of a method.
                    let real = faults.into_iter().filter(|fault| !fault.contains("shows nothing"));
                    found.extend(real.map(|fault| format!("model {seed}, {}: {fault}", bounds.name())));
                }
            }
        }
    }
    assert_none(&found);
}
