//! Laws of camera paths.

use glam::{DQuat, DVec3};
use scenes::{open, record, CameraPath, PathKind, Projection, Scene, SceneOptions, Shot};
use std::path::PathBuf;

const FRAMES: usize = 61;

fn scenes() -> Vec<Scene> {
    let make = |name| {
        open(name, &SceneOptions { scale: 0.05, seed: 1, ..Default::default() }).expect("a procedural scene opens")
    };
    let mut without_camera = make("boxes");
    without_camera.cameras.clear();
    let mut tower = without_camera.clone();
    for object in &mut tower.objects {
        object.world_from_object.translation.y *= 20.0;
    }
    vec![make("city-block"), make("rooms"), make("moving-boxes"), without_camera, tower, Scene::default()]
}

fn named(scene: &Scene, name: &str, speed: f64) -> CameraPath {
    CameraPath::named(scene, Some(name), speed).map(CameraPath::whole).expect("the path exists")
}

fn shots(path: &CameraPath) -> Vec<Shot> {
    (0..FRAMES).map(|frame| path.sample(frame, FRAMES)).collect()
}

fn fov_y(shot: &Shot) -> f64 {
    match shot.projection {
        Projection::Perspective { fov_y, .. } => fov_y,
        _ => panic!("these scenes have perspective cameras"),
    }
}

#[test]
fn every_shot_is_a_legal_camera() {
    for scene in scenes() {
        for kind in PathKind::EVERYWHERE {
            for speed in [0.3, 1.0, 16.0] {
                let path = named(&scene, kind.name(), speed);
                assert_eq!((path.kind(), path.name(), path.speed()), (kind, kind.name(), speed));
                for shot in shots(&path) {
                    assert!(shot.pose.position.is_finite(), "{} {}", scene.name, path.describe());
                    assert!((shot.pose.rotation.length() - 1.0).abs() < 1e-9, "{} {}", scene.name, path.describe());
                    let Projection::Perspective { fov_y, near, far } = shot.projection else { panic!("a perspective") };
                    assert!(fov_y > 0.0 && near > 0.0 && far.is_none_or(|far| far > near));
                }
            }
        }
    }
}

#[test]
fn all_paths_but_still_move_and_still_does_not() {
    for scene in scenes() {
        for kind in PathKind::EVERYWHERE {
            let shots = shots(&named(&scene, kind.name(), 1.0));
            let moves =
                shots.windows(2).all(|pair| (pair[0].pose, pair[0].projection) != (pair[1].pose, pair[1].projection));
            assert_eq!(moves, kind != PathKind::Still, "{} {}", scene.name, kind.name());
        }
    }
}

#[test]
fn no_path_jumps() {
    for scene in scenes() {
        let radius = if scene.objects.is_empty() { 2.0 } else { scene.bounds().half_extent().length() };
        for kind in PathKind::EVERYWHERE {
            let path = named(&scene, kind.name(), 2.0);
            for pair in (0..2000).map(|frame| path.sample(frame, 2000)).collect::<Vec<_>>().windows(2) {
                let step = pair[0].pose.position.distance(pair[1].pose.position);
                assert!(step < 0.05 * radius, "{} {}: {step} of {radius}", scene.name, kind.name());
                let turn = pair[0].pose.rotation.angle_between(pair[1].pose.rotation);
                assert!(turn < 0.2, "{} {}: {turn}", scene.name, kind.name());
            }
        }
    }
}

#[test]
fn cuts_are_somewhere_else_in_each_frame_of_the_walk() {
    for scene in scenes() {
        let at = |path: &CameraPath, frame: usize| path.sample(frame, FRAMES);
        let cuts = CameraPath::named(&scene, Some("cuts"), 1.0).expect("every scene has it");
        assert_eq!((cuts.kind(), cuts.describe().as_str()), (PathKind::Cuts, "cuts speed=1.0"));
        // Finely enough that each cut lies near one of its places.
        let walk = named(&scene, "walk", 1.0);
        let walked: Vec<DVec3> = (0..2000).map(|frame| walk.sample(frame, 2000).pose.position).collect();
        let span = walked.iter().map(|place| place.distance(walked[0])).fold(0.0, f64::max);
        let shots: Vec<Shot> = (0..100).map(|frame| at(&cuts, frame)).collect();
        for (frame, shot) in shots.iter().enumerate() {
            let (name, place) = (&scene.name, shot.pose.position);
            let off = walked.iter().map(|at| at.distance(place)).fold(f64::INFINITY, f64::min);
            assert!(off < 0.01 * span, "{name}, frame {frame}: {off} m off the walk");
            let turn = |other: &Shot| shot.pose.rotation.angle_between(other.pose.rotation);
            let is_other =
                |other: &Shot, far: f64| place.distance(other.pose.position) > far * span || turn(other) > 0.2;
            assert!(frame == 0 || is_other(&shots[frame - 1], 0.2), "{name}, frame {frame} is near the one before");
            assert!(shots[..frame].iter().all(|other| is_other(other, 1e-4)), "{name}, frame {frame} was there before");
            // Neither the run's length nor another run moves it.
            assert_eq!((cuts.sample(frame, 7), cuts.clone().whole().sample(frame, FRAMES)), (*shot, *shot));
        }
    }
}

#[test]
fn speed_makes_the_way_longer_and_nothing_else() {
    for scene in scenes() {
        for kind in PathKind::EVERYWHERE {
            let (slow, fast) = (named(&scene, kind.name(), 1.0), named(&scene, kind.name(), 4.0));
            for frame in 0..15 {
                let (a, b) = (slow.sample(4 * frame, FRAMES), fast.sample(frame, FRAMES));
                assert!(a.pose.position.distance(b.pose.position) < 1e-6, "{} {}", scene.name, kind.name());
                assert!((fov_y(&a) - fov_y(&b)).abs() < 1e-9 && (a.seconds - b.seconds).abs() < 1e-9);
            }
        }
    }
}

#[test]
fn zoom_narrows_to_a_quarter_and_widens_again() {
    let scene = &scenes()[0];
    let shots = shots(&named(scene, "zoom", 1.0));
    let wide = fov_y(&shots[0]);
    assert!((fov_y(&shots[30]) - 0.25 * wide).abs() < 1e-9 && (fov_y(&shots[60]) - wide).abs() < 1e-9);
    assert!(shots.iter().all(|shot| shot.pose == shots[0].pose));
}

#[test]
fn closing_in_ends_where_the_camera_stands() {
    for scene in scenes() {
        let path = named(&scene, "closing-in", 1.0);
        let (first, last) = (path.sample(0, FRAMES), path.sample(FRAMES - 1, FRAMES));
        let still = named(&scene, "still", 1.0).sample(0, 1);
        assert_eq!(last.pose.rotation, still.pose.rotation);
        assert!(last.pose.position.distance(still.pose.position) < 1e-9);
        if scene.bounds().is_valid() {
            assert!(!scene.bounds().contains(first.pose.position), "{} starts inside", scene.name);
        }
    }
}

#[test]
fn a_walk_in_the_city_turns_at_a_corner() {
    let scene = &scenes()[0];
    let shots = shots(&named(scene, "walk", 1.0));
    let turn = shots[0].pose.forward().dot(shots[28].pose.forward());
    assert!(turn.abs() < 0.1, "{turn}");
    assert!(shots.iter().all(|shot| (shot.pose.position.y - 1.7).abs() < 1e-9));
}

#[test]
fn derived_cameras_see_the_whole_scene() {
    for scene in scenes().iter().filter(|scene| scene.cameras.is_empty() && !scene.objects.is_empty()) {
        let shot = named(scene, "still", 1.0).sample(0, 1);
        let bounds = scene.bounds();
        let clip_from_view = shot.projection.clip_from_view(4.0 / 3.0);
        for corner in 0..8 {
            let pick = |axis: usize| if corner >> axis & 1 == 0 { bounds.min[axis] } else { bounds.max[axis] };
            let in_view = shot.pose.rotation.inverse() * (DVec3::new(pick(0), pick(1), pick(2)) - shot.pose.position);
            let clip = clip_from_view * in_view.extend(1.0);
            assert!(clip.x.abs() <= clip.w && clip.y.abs() <= clip.w && (0.0..=clip.w).contains(&clip.z), "{clip}");
        }
    }
}

#[test]
fn bad_names_and_speeds_are_refused() {
    let scene = &scenes()[2];
    for speed in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(CameraPath::named(scene, None, speed).is_err(), "{speed}");
    }
    let message = CameraPath::named(scene, Some("fly"), 1.0).expect_err("no such path").to_string();
    assert!(message.contains("no camera path 'fly'") && message.contains("walk, pan, zoom"), "{message}");
    // Only scenes with an animated camera have the path of that name.
    assert!(CameraPath::named(scene, Some("camera"), 1.0).is_err());
    assert_eq!(CameraPath::named(scene, None, 1.0).expect("a default").name(), "walk");
}

/// A file that is gone when the test ends.
struct Temporary(PathBuf);

impl Temporary {
    fn new(name: &str, text: &str) -> Self {
        let path = std::env::temp_dir().join(format!("sightline-{}-{name}.json", std::process::id()));
        std::fs::write(&path, text).expect("the file can be written");
        Temporary(path)
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        let _ = std::fs::remove_file(&self.0);
    }
}

#[test]
fn recorded_paths_play_as_they_were() {
    let path = named(&scenes()[0], "walk", 3.0);
    let file = Temporary::new("walk", &record(&path, FRAMES).expect("a perspective"));
    let played = CameraPath::from_file(&file.0, 1.0).expect("a recording");
    assert_eq!(played.kind(), PathKind::Recorded);
    for frame in 0..FRAMES {
        let (a, b) = (path.sample(frame, FRAMES), played.sample(frame, FRAMES));
        assert_eq!((a.pose, a.seconds), (b.pose, b.seconds));
        assert!((fov_y(&a) - fov_y(&b)).abs() < 1e-12);
    }
    let between = played.sample(1, 2 * FRAMES - 1).pose.position;
    let (from, to) = (played.sample(0, FRAMES).pose.position, played.sample(1, FRAMES).pose.position);
    assert!(between.distance(from.lerp(to, 0.5)) < 1e-9);
}

#[test]
fn descriptions_differ_where_paths_do() {
    let scene = &scenes()[0];
    let one = Temporary::new(
        "one",
        r#"{"schema":1,"frames":[{"position":[0,0,0],"rotation":[0,0,0,1],"fov_y_deg":60,"near":0.1}]}"#,
    );
    let before = CameraPath::from_file(&one.0, 1.0).expect("a recording").describe();
    std::fs::write(
        &one.0,
        r#"{"schema":1,"frames":[{"position":[1,0,0],"rotation":[0,0,0,1],"fov_y_deg":60,"near":0.1}]}"#,
    )
    .expect("the file can be written");
    let after = CameraPath::from_file(&one.0, 1.0).expect("a recording").describe();
    assert_ne!(before, after);
    assert_eq!(named(scene, "walk", 2.0).describe(), "walk speed=2.0 whole");
    assert_ne!(named(scene, "walk", 2.0).describe(), named(scene, "pan", 2.0).describe());
}

#[test]
fn broken_recordings_say_what_is_wrong() {
    let frame = |fields: &str| format!(r#"{{"schema":1,"frames":[{{{fields}}}]}}"#);
    let cases = [
        ("{".into(), "not JSON"),
        ("{}".into(), "`schema` is missing"),
        (r#"{"schema":2}"#.into(), "schema is 2"),
        (r#"{"schema":1}"#.into(), "`frames` is missing"),
        (r#"{"schema":1,"frames":[]}"#.into(), "`frames` is empty"),
        (frame(""), "frame 0: `position` must be a list of 3 numbers"),
        (frame(r#""position":[1,2]"#), "frame 0: `position`"),
        (frame(r#""position":[1,2,3],"rotation":[0,0,0,0]"#), "`rotation` has length 0"),
        (frame(r#""position":[1,2,3],"rotation":[0,0,0,1],"fov_y_deg":180,"near":1"#), "`fov_y_deg` is 180"),
        (frame(r#""position":[1,2,3],"rotation":[0,0,0,1],"fov_y_deg":60,"near":0"#), "`near` must be above 0"),
        (frame(r#""position":[1,2,3],"rotation":[0,0,0,1],"fov_y_deg":60,"near":2,"far":1"#), "`far` above `near`"),
    ];
    for (index, (text, expected)) in cases.iter().enumerate() {
        let file = Temporary::new(&format!("broken-{index}"), text);
        let message = CameraPath::from_file(&file.0, 1.0).expect_err(expected).to_string();
        assert!(message.contains(expected), "{message}");
        assert!(message.contains(&*file.0.to_string_lossy()), "{message}");
    }
    assert!(CameraPath::from_file(&PathBuf::from("/no/such.json"), 1.0).is_err());
    let good = Temporary::new("good", &frame(r#""position":[1,2,3],"rotation":[0,0,0,1],"fov_y_deg":60,"near":1"#));
    assert!(CameraPath::from_file(&good.0, f64::NAN).is_err());
    let shot = CameraPath::from_file(&good.0, 1.0).expect("a recording").sample(5, 10);
    assert_eq!((shot.pose.position, shot.pose.rotation), (DVec3::new(1.0, 2.0, 3.0), DQuat::IDENTITY));
}
