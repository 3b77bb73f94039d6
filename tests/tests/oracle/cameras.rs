//! A camera for a wide rectangle shows all of it in a narrower picture (glTF 2.0, 3.10.3: cameras should not crop).

use crate::{drawn, imported};
use glam::{DQuat, DVec3};
use harness::oracle::model::{Material, Mesh, Model, Node};
use harness::{gpu, Case, Lab};
use scenes::{Camera, CameraPath, Fit, Pose, Projection};
use sightline::run::session::{Session, SessionOptions};

/// Two small squares at the left and the right end of a rectangle of 8 x 2 metres, and one above its middle.
fn model() -> Model {
    let square = Mesh {
        positions: vec![[-0.3, -0.3, 0.0], [0.3, -0.3, 0.0], [0.3, 0.3, 0.0], [-0.3, 0.3, 0.0]],
        indices: vec![0, 1, 2, 0, 2, 3],
        material: Material { alpha: 1.0, ..Material::default() },
        ..Mesh::default()
    };
    let node = |at: DVec3| Node {
        parent: None,
        place: (at, DQuat::IDENTITY, DVec3::ONE),
        mesh: Some(0),
        skin: None,
        tracks: Vec::new(),
    };
    let places = [DVec3::new(-7.0, 0.0, 0.0), DVec3::new(7.0, 0.0, 0.0), DVec3::new(0.0, 3.0, 0.0)];
    Model { nodes: places.map(node).to_vec(), meshes: vec![square], skins: Vec::new() }
}

/// Which of the squares a camera of 8 x 2 metres at their distance sees, in a picture of a size.
fn seen(gpu: &engine::Gpu, projection: Projection, size: [u32; 2], fit: Fit) -> [bool; 3] {
    let mut scene = imported(&model().glb());
    let pose = Pose::looking_at(DVec3::Z * 10.0, DVec3::ZERO);
    scene.cameras = vec![Camera { name: "wide".into(), pose, projection, aspect: Some(4.0), node: None }];
    let aspect = f64::from(size[0]) / f64::from(size[1]);
    let path = CameraPath::named(&scene, Some("still"), 1.0).unwrap().fitted(aspect, fit);
    let shot = path.sample(0, 1);
    let mut lab = Lab::new(gpu, &Case { name: "wide".into(), scene, shots: vec![shot], size });
    let items = drawn(&mut lab, &shot);
    [0, 1, 2].map(|object| items.contains(&Some(object)))
}

#[test]
fn a_picture_shows_all_of_the_rectangle_that_its_camera_was_made_for() {
    let gpu = gpu();
    let perspective = Projection::Perspective { fov_y: 2.0 * 0.2f64.atan(), near: 0.1, far: None };
    let parallel = Projection::Orthographic { half_height: 2.0, near: 0.1, far: 20.0 };
    for projection in [perspective, parallel] {
        assert_eq!(seen(&gpu, projection, [320, 180], Fit::Inside), [true, true, true], "more above and below");
        assert_eq!(seen(&gpu, projection, [320, 180], Fit::Height), [false, false, false], "cropped");
        assert_eq!(seen(&gpu, projection, [320, 80], Fit::Inside), [true, true, false], "the same rectangle");
        // A wider picture shows more at the sides, whatever the fit.
        for fit in Fit::ALL {
            assert_eq!(seen(&gpu, projection, [500, 100], fit), [true, true, false]);
        }
    }
}

/// The keys of results and caches include the fit of the camera, and a new window size fits it again.
#[test]
fn sessions_fit_the_camera_and_say_so() {
    let gpu = gpu();
    let mut scene = imported(&model().glb());
    let projection = Projection::Orthographic { half_height: 2.0, near: 0.1, far: 20.0 };
    let pose = Pose::looking_at(DVec3::Z * 10.0, DVec3::ZERO);
    scene.cameras = vec![Camera { name: "wide".into(), pose, projection, aspect: Some(4.0), node: None }];
    let open = |fit| {
        let options = SessionOptions { path: Some("still".into()), size: [200, 100], fit, ..SessionOptions::default() };
        Session::with_scene(&gpu, scene.clone(), options).unwrap()
    };
    let (mut inside, height) = (open(Fit::Inside), open(Fit::Height));
    assert_eq!(height.shot(0).projection, projection);
    assert_eq!(inside.shot(0).projection, projection.widened(2.0));
    assert_ne!(inside.path().describe(), height.path().describe());
    assert_ne!(inside.key(), height.key());
    inside.resize([400, 100]).unwrap();
    assert_eq!(inside.shot(0).projection, projection);
}
