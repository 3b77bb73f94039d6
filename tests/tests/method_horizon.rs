//! The laws of `horizon`, on cities: its worlds are its own, as it refuses those of the other methods.

#[path = "method_horizon/planted.rs"]
mod planted;
#[path = "method_horizon/rays.rs"]
mod rays;

use glam::{DQuat, DVec3};
use harness::{assert_none, gpu, laws, sessions, worlds, Case, Random, Subject};
use scenes::animation::Orbit;
use scenes::{Aabb, Building, Motion, Pose, Projection, SceneOptions, Shot};

/// A city from its street, rolled, up and down its walls, from above, from within a house, through a wall and without perspective.
pub fn city(name: &str, scale: f64) -> Case {
    let scene = scenes::open(name, &SceneOptions { scale, ..Default::default() }).unwrap();
    let walk = scene.walk.clone().unwrap();
    let (eye, ahead) = (walk.points[0], walk.points[1]);
    let projection = scene.cameras[0].projection;
    let look = |eye: DVec3, target: DVec3| worlds::shot(eye, target, projection);
    let rolled = |shot: Shot, by: f64| Shot {
        pose: Pose { rotation: shot.pose.rotation * DQuat::from_rotation_z(by), ..shot.pose },
        ..shot
    };
    let up = |metres: f64| eye + DVec3::Y * metres;
    let building = scene.buildings[scene.buildings.len() / 2];
    let place = scene.objects[building.object as usize].world_from_object;
    let house = place.transform_point3(building.solid.centre());
    let front = place.transform_point3(building.solid.centre() + DVec3::Z * 1.02 * building.solid.half_extent());
    let parallel = Projection::Orthographic { half_height: 30.0, near: 0.1, far: 2000.0 };
    let side = eye + (ahead - eye).any_orthogonal_vector();
    let shots = vec![
        look(eye, ahead),
        look(eye, ahead),
        rolled(look(eye, ahead), 0.7),
        look(eye, side),
        look(eye, ahead + DVec3::Y * 40.0),
        look(up(14.0), ahead),
        look(up(45.0), ahead),
        rolled(look(up(150.0), ahead - DVec3::Y * 60.0), 2.0),
        look(up(200.0), eye + DVec3::X * 1e-3),
        look(house, ahead),
        look(front, house),
        worlds::shot(up(30.0), ahead, parallel),
        look(eye - DVec3::Y * 3.0, ahead),
        look(eye, ahead),
    ];
    Case::new(name, scene, shots)
}

/// Blocks that hang over the ground, and things before, behind, above and below them, some of which move.
pub fn gate() -> Case {
    let mut maker = worlds::Maker::new("gate");
    let mut random = Random::new(13);
    let cube = maker.mesh(worlds::cube());
    for block in 0..4 {
        let at = DVec3::new(-9.0 + 6.5 * f64::from(block), 4.5, f64::from(block % 2) * 3.0);
        maker.place(cube, worlds::sized(at, DVec3::new(6.0, 5.0, 2.0)));
        let solid = Aabb { min: DVec3::splat(-0.5), max: DVec3::splat(0.5) };
        maker.scene.buildings.push(Building { object: block, solid });
    }
    for _ in 0..300 {
        let at = DVec3::new(random.range(-14.0, 14.0), random.range(-1.0, 10.0), random.range(-14.0, 9.0));
        let place = worlds::turned(&mut random, at, DVec3::splat(0.4));
        maker.place(cube, place);
    }
    let mut scene = maker.scene;
    let orbit = |object: usize| Orbit {
        object: object as u32,
        base: scene.objects[object].world_from_object,
        centre: DVec3::ZERO,
        axis: DVec3::Y,
        radians_per_s: 0.6,
        bob: DVec3::ZERO,
        bob_period_s: 0.0,
    };
    let orbits: Vec<Orbit> = (4..scene.objects.len()).step_by(5).map(orbit).collect();
    orbits.iter().for_each(|orbit| scene.objects[orbit.object as usize].dynamic = true);
    scene.motion = Motion::Orbits(orbits);
    let shots = worlds::wander(DVec3::new(1.0, 1.6, 12.0), DVec3::new(0.0, 3.0, 0.0), worlds::PERSPECTIVE);
    let shots = shots.into_iter().enumerate().map(|(frame, shot)| Shot { seconds: 0.5 * frame as f64, ..shot });
    Case::new("gate", scene, shots.collect())
}

/// The cities that there are.
pub fn cities() -> Vec<Case> {
    vec![city("city-block", 0.02), city("radial-city", 0.02), gate()]
}

fn all(law: fn(&engine::Gpu, &Subject, &Case) -> Vec<String>) {
    let gpu = gpu();
    let subject = Subject::named("horizon");
    assert_none(&cities().iter().flat_map(|case| law(&gpu, &subject, case)).collect::<Vec<_>>());
}

const RUNS: [(&str, f64, &str); 6] = [
    ("city-block", 0.03, "walk"),
    ("city-block", 0.03, "rotate"),
    ("city-block", 0.03, "closing-in"),
    ("radial-city", 0.03, "walk"),
    ("radial-city", 0.03, "closing-in"),
    ("radial-city", 0.03, "cuts"),
];

#[test]
fn no_visible_object_is_culled() {
    all(laws::no_visible_object_is_culled);
}

#[test]
fn no_visible_object_is_culled_on_any_path() {
    let gpu = gpu();
    for set in [&[][..], &[("skip", "false")]] {
        let faults = RUNS.iter().flat_map(|run| sessions::faults(&mut sessions::open(&gpu, *run, 8), "horizon", set));
        assert_none(&faults.collect::<Vec<_>>());
    }
}

#[test]
fn any_size_is_exact() {
    let case = city("city-block", 0.02);
    let case = case.filmed(case.shots.iter().step_by(3).copied().collect());
    let gpu = gpu();
    for size in [[1, 1], [1, 257], [641, 359]] {
        assert_none(&laws::no_visible_object_is_culled(&gpu, &Subject::named("horizon"), &case.sized(size)));
    }
}

#[test]
fn the_order_of_objects_does_not_matter() {
    let (gpu, case) = (gpu(), city("radial-city", 0.02));
    assert_none(&laws::the_order_of_objects_does_not_matter(&gpu, &Subject::named("horizon"), &case));
}

#[test]
fn a_resize_hides_nothing() {
    all(laws::a_resize_hides_nothing);
}

#[test]
fn a_camera_cut_hides_nothing() {
    all(laws::a_camera_cut_hides_nothing);
}

#[test]
fn two_runs_give_the_same_bytes() {
    all(laws::two_runs_give_the_same_bytes);
}

#[test]
fn decisions_do_not_depend_on_the_pass() {
    all(laws::decisions_do_not_depend_on_the_pass);
}

#[test]
fn a_still_camera_shows_one_picture() {
    all(laws::a_still_camera_shows_one_picture);
}

#[test]
fn skipping_changes_no_pixel() {
    let gpu = gpu();
    assert_none(&laws::skipping_changes_no_pixel(&gpu, &Subject::named("horizon"), &city("city-block", 0.02)));
}

#[test]
fn what_is_no_city_is_refused_in_one_line() {
    let gpu = gpu();
    let case = worlds::walled(5);
    let lab = sightline::stress::lab::Lab::new(&gpu, &case).unwrap();
    let refused = lab.make(&Subject::named("horizon"), &Default::default()).err().expect("refused");
    let line = format!("{refused:#}");
    assert!(line.contains("method 'horizon' needs a city") && !line.contains('\n'), "{line}");
}

/// From the street most of what `frustum` draws is behind houses or in them.
#[test]
fn it_draws_a_small_part_of_what_is_in_view() {
    let gpu = gpu();
    for (run, share) in [(("city-block", 0.1, "walk"), 0.3), (("radial-city", 0.1, "walk"), 0.7)] {
        let drawn = ["frustum", "horizon", "ref"].map(|id| {
            let mut session = sessions::open(&gpu, run, 6);
            let truth = sightline::run::truth::RunTruth::draw(&mut session, || ()).unwrap();
            let entry = culling::find(id).unwrap();
            let visible = Some(truth.sets.clone());
            let mut contender =
                sightline::run::Contender::new(&session, entry, entry.default_options(), &visible).unwrap();
            let drawn = |frame| {
                let truth = truth.frame(&mut session, frame).unwrap();
                let measured = contender.measured(&mut session, frame, &truth).unwrap();
                measured.drawn.objects.iter().filter(|drawn| **drawn).count()
            };
            (0..6).map(drawn).sum::<usize>()
        });
        println!("{run:?}: frustum, horizon and ref draw {drawn:?}");
        assert!((drawn[1] as f64) < share * drawn[0] as f64, "{run:?}: {drawn:?}");
    }
}
