//! What the horizon hides, against rays: a twin that knows nothing of slopes and columns.

use super::cities;
use culling::horizon::{eye, prisms, sweep, Sight};
use culling::world::Solid;
use glam::DVec3;
use harness::{gpu, Lab, Random};

/// How far along a ray the solid begins, 1 being the ray's end; none if it does not meet it.
fn meets(solid: &Solid, from: DVec3, along: DVec3) -> Option<f64> {
    let (mut enters, mut leaves) = (f64::NEG_INFINITY, f64::INFINITY);
    for axis in solid.axes {
        let size = axis.length_squared();
        let (at, by) = ((from - solid.centre).dot(axis) / size, along.dot(axis) / size);
        let ends = [(-1.0 - at) / by, (1.0 - at) / by];
        enters = enters.max(ends[0].min(ends[1]));
        leaves = leaves.min(ends[0].max(ends[1]));
    }
    (enters <= leaves && leaves > 0.0).then_some(enters)
}

#[test]
fn whatever_is_hidden_is_behind_something_solid() {
    let gpu = gpu();
    let mut random = Random::new(41);
    let (mut hidden, mut seen_through) = (0, 0);
    for case in cities() {
        let mut lab = Lab::new(&gpu, &case);
        for (frame, shot) in case.shots.iter().enumerate() {
            let view = lab.look(shot, frame);
            let Some(eye) = eye(&view) else { continue };
            let world = &lab.world;
            let mut flags = vec![1; world.len()];
            let prisms = prisms(world, &flags, &view.cull(), eye);
            let (wide, unbounded) = (vec![false; flags.len()], vec![0; flags.len()]);
            sweep(world, &view, &Sight { eye, prisms: &prisms, wide: &wide, unbounded: &unbounded }, &mut flags);
            let clip = view.clip_from_relative();
            for object in (0..world.len()).filter(|object| flags[*object] == 0) {
                hidden += 1;
                let bounds = world.host_bounds()[object];
                for _ in 0..8 {
                    let along = DVec3::from([random.unit(), random.unit(), random.unit()].map(f64::from));
                    let along = bounds.min + (bounds.max - bounds.min) * along - eye;
                    let at = clip * (along + eye - view.pose.position).extend(1.0);
                    if at.w <= 0.0 || at.x.abs().max(at.y.abs()) > at.w {
                        continue;
                    }
                    let blocked = |solid: &Solid| {
                        meets(solid, eye, along).is_some_and(|enters| (0.0..=1.0 + 1e-9).contains(&enters))
                    };
                    seen_through += usize::from(!world.solids().iter().any(blocked));
                }
            }
        }
    }
    assert!(hidden > 5_000, "{hidden} objects are hidden: too few to show anything");
    assert_eq!(seen_through, 0, "rays to {hidden} hidden objects meet nothing solid");
}
