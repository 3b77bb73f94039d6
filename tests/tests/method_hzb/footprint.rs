//! The property on which `hzb` rests: a footprint holds every pixel that its object covers, and nothing of the object is
//! nearer than it says. Random triangles, slivers among them, through the real rasteriser.

use glam::{DAffine3, DVec2, DVec3, DVec4, Vec3};
use harness::footprints::{covered, Covered};
use harness::worlds::{mesh, special_projections, Case, Maker};
use harness::{gpu, Lab, Random};
use scenes::{Pose, Projection, Scene, Shot, Topology};

const SIZE: [u32; 2] = [320, 180];
const TRIANGLES: usize = 1500;
const ROUNDS: usize = 6;

/// Small objects of one to four triangles where the camera sees them: from a hundredth of a pixel to the whole picture,
/// flat on the view or deep. Every third is a sliver, and every third is an edge that passes a pixel's centre by less than
/// the vertex grid and drops away behind it: the worst there is for depth.
fn triangles(random: &mut Random, shot: &Shot, topology: Topology, snap_px: f64) -> Scene {
    let mut maker = Maker::new("triangles");
    let size = DVec2::new(f64::from(SIZE[0]), f64::from(SIZE[1]));
    let relative_from_clip = (shot.projection.clip_from_view(size.x / size.y)
        * glam::DMat4::from_quat(shot.pose.rotation.conjugate()))
    .inverse();
    let unprojected = |px: DVec2, depth: f64| {
        let clip = px / size * 2.0 - 1.0;
        let point: DVec4 = relative_from_clip * DVec4::new(clip.x, clip.y, depth, 1.0);
        point.truncate() / point.w
    };
    for index in 0..TRIANGLES {
        let depth = depth_of(random, shot.projection);
        let corners_px = match (topology, index % 3) {
            (Topology::Triangles, 0) => falling_edge(random, size, snap_px),
            (Topology::Triangles, kind) => thrown(random, size, kind == 1, [3, 3, 12][index / 3 % 3]),
            (Topology::Lines, 0) => falling_line(random, size),
            (Topology::Lines, kind) => thrown(random, size, kind == 1, [2, 2, 6][index / 3 % 3]),
            (_, kind) => thrown(random, size, kind == 1, 6),
        };
        let corners: Vec<DVec3> =
            corners_px.iter().map(|(px, deeper)| unprojected(*px, depth * (1.0 - deeper))).collect();
        let centre = corners.iter().sum::<DVec3>() / corners.len() as f64;
        let positions: Vec<Vec3> = corners.iter().map(|corner| (*corner - centre).as_vec3()).collect();
        let indices = (0..corners.len() as u32).collect();
        let made = maker.mesh(mesh("triangles", topology, positions, indices));
        maker.place(made, DAffine3::from_translation(centre + shot.pose.position));
    }
    maker.scene
}

type Corner = (DVec2, f64);

/// Corners around somewhere in the picture, each with how much deeper it is, as a share.
fn thrown(random: &mut Random, size: DVec2, sliver: bool, count: usize) -> Vec<Corner> {
    let at = DVec2::new(random.unit(), random.unit()) * size;
    let extent_px = random.decade(0.01, 30.0);
    let (spread, along) = (random.decade(1e-5, 0.9), DVec2::from_angle(random.range(0.0, 6.3)));
    let corner = |random: &mut Random| {
        let offset = match sliver {
            true => along * random.range(-1.0, 1.0) * extent_px + random.vector().truncate() * random.decade(1e-3, 1.0),
            false => random.vector().truncate() * extent_px,
        };
        (at + offset, spread * random.unit())
    };
    (0..count).map(|_| corner(random)).collect()
}

/// A near edge that passes the centre of a pixel within the vertex grid, and a corner some way behind it.
fn falling_edge(random: &mut Random, size: DVec2, snap_px: f64) -> Vec<Corner> {
    let centre = (DVec2::new(random.unit(), random.unit()) * size).floor() + 0.5;
    let along = DVec2::from_angle(random.range(0.0, 6.3));
    let (length, height, spread) = (random.decade(0.1, 30.0), random.decade(2e-3, 3.0), random.decade(1e-3, 0.9));
    let edge = centre + along.perp() * random.range(-1.0, 1.0) * snap_px;
    let part = random.unit();
    let corner = edge + along.perp() * height + along * random.range(-0.5, 0.5) * length;
    vec![(edge - along * part * length, 0.0), (edge + along * (1.0 - part) * length, 0.0), (corner, spread)]
}

/// A reversed depth where things are, for each kind of camera.
fn depth_of(random: &mut Random, projection: Projection) -> f64 {
    match projection {
        Projection::Perspective { near, far, .. } => near / random.decade(near * 1.5, far.unwrap_or(1e4) * 0.5),
        Projection::Orthographic { .. } => random.range(0.05, 0.95),
        Projection::Custom(_) => random.decade(0.005, 0.9),
    }
}

fn seen(topology: Topology) -> Covered {
    let gpu = gpu();
    let mut random = Random::new(31);
    let mut all = Covered::default();
    for (name, projection) in special_projections() {
        for round in 0..ROUNDS {
            // Along the axes, so that boxes are tight; turned; and far from the origin.
            let rotation = if round % 3 == 0 { glam::DQuat::IDENTITY } else { random.turn() };
            let away = if round % 3 == 2 { 1e6 } else { 1.0 };
            let shot = Shot { pose: Pose { position: random.vector() * away, rotation }, projection, seconds: 0.0 };
            let scene = triangles(&mut random, &shot, topology, f64::from(gpu.snap_px()));
            let case = Case::new(name, scene, vec![shot]).sized(SIZE);
            let mut seen = covered(&mut Lab::new(&gpu, &case), &case, |_, _| ());
            seen.outside.iter_mut().for_each(|fault| *fault = format!("{name}, round {round}: {fault}"));
            all.join(seen);
        }
    }
    println!(
        "{topology:?}: {} objects, {} pixels; outside by at most {:.5} px; slack by height {:.2?}, by {:.3} grids at most; {} pixels too near",
        all.objects,
        all.pixels,
        all.worst_outside_px,
        all.worst_slack,
        all.worst_shift,
        all.too_near.len()
    );
    all
}

/// A short line that drops away from its near end.
fn falling_line(random: &mut Random, size: DVec2) -> Vec<Corner> {
    let at = DVec2::new(random.unit(), random.unit()) * size;
    let along = DVec2::from_angle(random.range(0.0, 6.3)) * random.decade(0.01, 10.0);
    vec![(at, 0.0), (at + along, random.decade(1e-3, 0.9))]
}

#[test]
fn footprints_hold_every_pixel_of_triangles() {
    let all = seen(Topology::Triangles);
    harness::assert_none(&all.outside);
    let high = all.too_near.iter().filter(|near| near.height_px >= 0.125).map(|near| near.text.clone());
    harness::assert_none(&high.collect::<Vec<_>>());
    // Thinner slivers are outside the raster conditions, but the derivation still bounds them: an edge moves by 1.42 vertex grids
    // against the plane of its depths at most.
    let unexplained =
        all.too_near.iter().filter(|near| near.slack > 1.45 / near.height_px).map(|near| near.text.clone());
    harness::assert_none(&unexplained.collect::<Vec<_>>());
    assert!(
        all.objects > 3000 && all.pixels > 50_000,
        "too little was seen: {} objects, {} pixels",
        all.objects,
        all.pixels
    );
}

#[test]
fn footprints_hold_every_pixel_of_lines_and_points() {
    for topology in [Topology::Lines, Topology::Points] {
        let all = seen(topology);
        harness::assert_none(&all.outside);
        harness::assert_none(&all.too_near.iter().map(|near| near.text.clone()).collect::<Vec<_>>());
        assert!(all.objects > 2000, "too little was seen: {} objects", all.objects);
    }
}
