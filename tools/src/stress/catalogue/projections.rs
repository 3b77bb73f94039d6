//! Cameras that divide badly.

use super::{before_the_wall, crowd, filmed, through, Drill};
use crate::stress::worlds::{self, cube, mesh, shot, sized, turned, wander, Case, Maker, PERSPECTIVE};
use crate::stress::Random;
use glam::{DVec3, Vec3};
use scenes::{Projection, Topology};

/// A near plane in the middle of the bodies.
pub fn near_plane(random: &mut Random, bodies: usize) -> Drill {
    let maker = crowd(random, bodies);
    let near =
        |random: &mut Random| Projection::Perspective { fov_y: 1.2, near: random.range(0.5, 7.0), far: Some(60.0) };
    let projections: Vec<Projection> = (0..3).map(|_| near(random)).collect();
    through(filmed(random, maker), &projections).into()
}

/// Corners of boxes in the plane through the eye, exactly and by a hair.
pub fn w_near_zero(random: &mut Random, bodies: usize) -> Drill {
    let mut maker = Maker::new("w");
    let cube = maker.mesh(cube());
    let eye = DVec3::new(0.5, 0.25, 2.0);
    for body in 0..bodies {
        let size = DVec3::new(random.range(0.1, 2.0), random.range(0.1, 2.0), random.range(0.1, 2.0));
        let hair = [0.0, 1e-12, -1e-12, 1e-7, -1e-7, 1e-3][body % 6];
        // Its far or its near face lies in the plane.
        let side = if body % 2 == 0 { 0.5 } else { -0.5 };
        let at = DVec3::new(random.range(-4.0, 4.0), random.range(-3.0, 3.0), eye.z + side * size.z + hair);
        let at = if body % 5 == 0 { at - DVec3::Z * random.range(1.0, 6.0) } else { at };
        maker.place(cube, sized(at, size));
    }
    let ahead = |eye: DVec3| shot(eye, eye - DVec3::Z, Projection::Perspective { near: 1e-4, fov_y: 1.4, far: None });
    let eyes = [eye, eye, eye + DVec3::X * 0.01, eye + DVec3::Z * 1e-7, eye - DVec3::Z, eye];
    Case::new("", maker.scene, eyes.map(ahead).to_vec()).into()
}

/// The eye stands in boxes of which little is there, and within bodies.
pub fn eye_inside(random: &mut Random, bodies: usize) -> Drill {
    let mut maker = crowd(random, bodies);
    let shell = maker.mesh(corner_pieces());
    let eye = before_the_wall(random);
    for _ in 0..bodies / 4 + 1 {
        let at = eye + random.vector() * 2.0;
        let size = DVec3::splat(random.decade(2.0, 30.0));
        let place = turned(random, at, size);
        maker.place(shell, place);
    }
    maker.place(0, sized(eye, DVec3::splat(1.0)));
    Case::new("", maker.scene, wander(eye, DVec3::ZERO, PERSPECTIVE)).into()
}

/// Two small triangles at opposite corners of a box that is empty otherwise.
fn corner_pieces() -> scenes::Mesh {
    let far = [Vec3::splat(0.5), Vec3::new(0.45, 0.5, 0.5), Vec3::new(0.5, 0.45, 0.5)];
    let positions = far.into_iter().chain(far.map(|corner| -corner)).collect();
    mesh("corners", Topology::Triangles, positions, vec![0, 1, 2, 3, 5, 4])
}

/// Parallel projections, with planes before and behind the eye.
pub fn parallel(random: &mut Random, bodies: usize) -> Drill {
    let maker = crowd(random, bodies);
    let parallel = |random: &mut Random| {
        let half_height = random.decade(0.2, 20.0);
        Projection::Orthographic { half_height, near: random.range(-5.0, 5.0), far: random.range(8.0, 60.0) }
    };
    let projections: Vec<Projection> = (0..3).map(|_| parallel(random)).collect();
    through(filmed(random, maker), &projections).into()
}

/// Off-centre, with planes of equal depth that lean.
pub fn oblique(random: &mut Random, bodies: usize) -> Drill {
    let maker = crowd(random, bodies);
    through(filmed(random, maker), &[worlds::oblique()]).into()
}

/// From 1 degree to 179.
pub fn field_of_view(random: &mut Random, bodies: usize) -> Drill {
    let maker = crowd(random, bodies);
    let wide = |degrees: f64| Projection::Perspective { fov_y: degrees.to_radians(), near: 0.1, far: Some(200.0) };
    let projections = [1.0, 179.0, random.range(1.0, 20.0), random.range(120.0, 179.0)].map(wide);
    through(filmed(random, maker), &projections).into()
}

/// Near planes at a thousandth of a millimetre, far planes at ten thousand kilometres, with bodies at all distances.
pub fn planes(random: &mut Random, bodies: usize) -> Drill {
    let mut maker = Maker::new("planes");
    let cube = maker.mesh(cube());
    for _ in 0..bodies {
        let distance = random.decade(1e-5, 1e6);
        let direction = (random.vector() * DVec3::new(0.7, 0.5, 0.2) - DVec3::Z).normalize();
        let size = DVec3::splat(distance * random.range(0.02, 0.4));
        let place = turned(random, direction * distance, size);
        maker.place(cube, place);
    }
    let perspective = |near, far| Projection::Perspective { fov_y: 1.0, near, far };
    let projections =
        [perspective(1e-6, Some(1e7)), perspective(1e-6, None), perspective(random.decade(1e-6, 1.0), Some(1e7))];
    let stops = [0.0, 0.0, 2e-5, 0.1, 5.0, 3e3, 0.0];
    let shots = stops.map(|back| shot(DVec3::Z * back, DVec3::NEG_Z * 10.0, PERSPECTIVE));
    through(Case::new("", maker.scene, shots.to_vec()), &projections).into()
}
