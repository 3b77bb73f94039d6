//! Rays that tell of what stands in front: the device's against the host's, and what they are for.

use super::setting;
use culling::seeds::{Seeds, RAYS_OPTION};
use culling::{Options, World};
use engine::{Buffer, Gpu, Placement};
use glam::DVec3;
use harness::{assert_none, gpu, laws, worlds, Subject};
use scenes::{Pose, Projection, Shot};

fn seeds(gpu: &Gpu, world: &World, rays: &str) -> Seeds {
    let mut options = Options::new("hzb-iterative", &[RAYS_OPTION]);
    options.set(RAYS_OPTION.name, rays).unwrap();
    Seeds::new(gpu, world, &options).unwrap().expect("there is something to meet")
}

/// Who counts as seen once rays were cast, by object, of objects of which some were seen before.
fn met(gpu: &Gpu, world: &World, seeds: &mut Seeds, shot: &Shot, seen_before: &[u32]) -> Vec<bool> {
    let seen = Buffer::with_data(gpu, "test.seen", seen_before, Placement::Storage).unwrap();
    let view = culling::View::new(shot, [322, 194], 0, gpu.snap_px());
    let mut f = gpu.frame();
    world.update(&mut f);
    seeds.cast(&mut f, world, &view, seen.all()).unwrap();
    f.finish().unwrap();
    seen.read().unwrap().iter().map(|seen| *seen != 0).collect()
}

#[test]
fn the_device_meets_what_the_host_meets() {
    let gpu = gpu();
    let case = worlds::walled(400);
    let world = World::new(&gpu, &case.scene).unwrap();
    let [mut on_host, mut on_device] = ["host", "device"].map(|rays| seeds(&gpu, &world, rays));
    let perspective = case.shots[0].projection;
    let parallel = Projection::Orthographic { half_height: 3.0, near: -50.0, far: 50.0 };
    let (mut all, mut differ) = (0, 0);
    for projection in [perspective, parallel, worlds::oblique()] {
        for (x, y) in [(0.7, 0.8), (-9.0, 6.0), (3.0, 14.0), (0.1, 2.0)] {
            let pose = Pose::looking_at(DVec3::new(x, y, 7.0), DVec3::ZERO);
            let shot = Shot { pose, projection, seconds: 0.0 };
            let [host, device] =
                [&mut on_host, &mut on_device].map(|seeds| met(&gpu, &world, seeds, &shot, &vec![0; world.len()]));
            all += host.iter().filter(|met| **met).count();
            // Roundings decide where a ray grazes.
            differ += host.iter().zip(&device).filter(|(host, device)| host != device).count();
        }
    }
    assert!(all > 200, "{all} objects met prove little");
    assert!(differ <= all / 50, "{differ} of {all} differ");
}

#[test]
fn the_device_leaves_what_was_seen_before() {
    let gpu = gpu();
    let case = worlds::walled(400);
    let world = World::new(&gpu, &case.scene).unwrap();
    let seen: Vec<u32> = (0..world.len() as u32).map(|object| u32::from(object % 3 == 0)).collect();
    for rays in ["host", "device"] {
        let met = met(&gpu, &world, &mut seeds(&gpu, &world, rays), &case.shots[0], &seen);
        assert!(seen.iter().zip(&met).all(|(seen, met)| *seen == 0 || *met), "{rays}: what was seen is forgotten");
        assert!(seen.iter().zip(&met).any(|(seen, met)| *seen == 0 && *met), "{rays}: nothing is met");
    }
}

#[test]
fn a_cut_draws_little() {
    let gpu = gpu();
    let law = |subject: &Subject| laws::what_a_wall_hides_after_a_cut_is_culled(&gpu, subject, &worlds::walled(400));
    for rays in ["auto", "host", "device"] {
        assert_none(&law(&setting(&[("rays", rays)])));
    }
    let without = setting(&[("rays", "off"), ("ranges", "1")]);
    assert!(!law(&without).is_empty(), "nothing tells what stands in front, and the law does not notice");
}

/// The host's rays are part of what a frame costs: else a cut would look cheaper than it is.
#[test]
fn the_hosts_rays_are_a_row_of_the_frame() {
    let gpu = gpu();
    let case = worlds::walled(200);
    for (rays, expected) in [("host", 1), ("device", 0)] {
        let mut lab = harness::Lab::new(&gpu, &case);
        let (_, sets) = lab.truths(&case.shots);
        let mut method = lab.make(&setting(&[("rays", rays)]), &sets);
        let takes = lab.film(&mut *method, &case.shots[..1]);
        let report = &takes[0].report;
        let rows: Vec<_> = report.stages.iter().filter(|stage| stage.label == "frame/cast_rays").collect();
        assert_eq!(rows.len(), expected, "{rays}: {:?}", report.stages);
        assert!(rows.iter().all(|row| row.ms > 0.0 && row.ms <= report.frame_ms));
    }
}

#[test]
fn rays_follow_what_moves() {
    let gpu = gpu();
    let options = scenes::SceneOptions { scale: 0.3, seed: 2, ..Default::default() };
    let scene = scenes::open("moving-boxes", &options).unwrap();
    let shot = scenes::CameraPath::named(&scene, None, 1.0).unwrap().sample(0, 2);
    for rays in ["host", "device"] {
        let mut world = World::new(&gpu, &scene).unwrap();
        let none = vec![0; world.len()];
        let mut early = seeds(&gpu, &world, rays);
        let before = met(&gpu, &world, &mut early, &shot, &none);
        world.set_time(&scene, 3.7).unwrap();
        let moved = met(&gpu, &world, &mut early, &shot, &none);
        let afresh = met(&gpu, &world, &mut seeds(&gpu, &world, rays), &shot, &none);
        assert_eq!(moved, afresh, "{rays}");
        assert_ne!(moved, before, "{rays}: what moved shows nowhere, so this proves nothing");
    }
}
