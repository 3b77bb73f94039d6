//! The few boxes of a mesh hold all of every triangle, on each scene and by chance, where the GPU puts it; and they are worth having.

use glam::{DAffine3, DMat3, DVec3, Vec3};
use proptest::prelude::*;
use scenes::procedural::SCENES;
use scenes::{Aabb, Mesh, MeshBoxes, SceneOptions, Topology, WorldBounds, MOST_BOXES};

/// What of a convex polygon lies outside of a box: convex polygons. Each plane of the box cuts off what is beyond it.
fn outside_of(polygon: Vec<DVec3>, box_: &Aabb) -> Vec<Vec<DVec3>> {
    let (mut rest, mut outside) = (polygon, Vec::new());
    for axis in 0..3 {
        for (sign, limit) in [(1.0, box_.max[axis]), (-1.0, -box_.min[axis])] {
            let beyond = |point: &DVec3| sign * point[axis] - limit;
            let (mut inner, mut outer) = (Vec::new(), Vec::new());
            for (at, from) in rest.iter().enumerate() {
                let to = &rest[(at + 1) % rest.len()];
                let (start, end) = (beyond(from), beyond(to));
                if start <= 0.0 {
                    inner.push(*from)
                } else {
                    outer.push(*from)
                }
                if (start <= 0.0) != (end <= 0.0) {
                    let crossing = *from + (*to - *from) * (start / (start - end));
                    inner.push(crossing);
                    outer.push(crossing);
                }
            }
            outside.extend((!outer.is_empty()).then_some(outer));
            rest = inner;
        }
    }
    outside
}

/// Twice the area of a convex polygon, and the length of its edges.
fn extent(polygon: &[DVec3]) -> (f64, f64) {
    let area = (1..polygon.len().saturating_sub(1))
        .map(|at| (polygon[at] - polygon[0]).cross(polygon[at + 1] - polygon[0]))
        .sum::<DVec3>()
        .length();
    let edges = (0..polygon.len()).map(|at| polygon[at].distance(polygon[(at + 1) % polygon.len()])).sum();
    (area, edges)
}

/// Triangles of which some part is in none of the boxes. Cutting a polygon in f64 moves each new corner by a few times 2^-53 of the coordinates, so
/// the boxes are taken larger by 2^-46 of them: the part of a needle beside such a corner is thin, but as long as the needle.
fn not_held(corners: impl Iterator<Item = [DVec3; 3]>, boxes: &[Aabb]) -> usize {
    let whole = boxes.iter().copied().fold(Aabb::EMPTY, Aabb::union);
    let size = whole.min.abs().max(whole.max.abs()).max_element();
    let room = DVec3::splat(size * 2f64.powi(-46));
    let boxes: Vec<Aabb> = boxes.iter().map(|box_| Aabb { min: box_.min - room, max: box_.max + room }).collect();
    let is_out = |corners: &[DVec3; 3]| {
        let (area, _) = extent(corners);
        let parts = boxes.iter().fold(vec![corners.to_vec()], |parts, box_| {
            parts.into_iter().flat_map(|part| outside_of(part, box_)).collect()
        });
        parts.iter().any(|part| {
            let (out, edges) = extent(part);
            // What has no area is out by its length.
            if area > 0.0 {
                out > 1e-10 * area
            } else {
                edges > 1e-10 * size || boxes.is_empty()
            }
        })
    };
    corners.filter(is_out).count()
}

fn local(mesh: &Mesh) -> impl Iterator<Item = [DVec3; 3]> + Clone + '_ {
    let all: Vec<_> = mesh.primitives().map(|corners| corners.map(|corner| corner.as_dvec3())).collect();
    all.into_iter()
}

fn boxes(mesh: &Mesh, most: u32) -> MeshBoxes {
    MeshBoxes::around(mesh.primitives(), most)
}

/// The faults of one mesh's boxes; `spoil` plants errors.
fn faults(mesh: &Mesh, most: u32, spoil: impl Fn(&mut Vec<Aabb>)) -> Vec<String> {
    let found = boxes(mesh, most);
    let mut local_boxes: Vec<Aabb> = found.in_object_space().collect();
    spoil(&mut local_boxes);
    let mut faults = Vec::new();
    if local_boxes.is_empty() || local_boxes.len() > most as usize {
        faults.push(format!("{}: {} boxes of {most}", mesh.name, local_boxes.len()));
    }
    let lost = not_held(local(mesh), &local_boxes);
    faults.extend((lost > 0).then(|| format!("{}, {most} boxes: {lost} triangles are not held", mesh.name)));
    faults
}

/// Each of few boxes is a union of some of many, so that what is in one of many is in one of few.
fn nested(mesh: &Mesh) -> Vec<String> {
    let mut faults = Vec::new();
    let of = |most: u32| boxes(mesh, most).in_object_space().collect::<Vec<_>>();
    let mut fewer = of(1);
    assert!(mesh.indices.is_empty() || fewer.len() == 1);
    for most in 2..=MOST_BOXES {
        let more = of(most);
        let apart = more.iter().filter(|box_| !fewer.iter().any(|outer| outer.union(**box_) == *outer)).count();
        faults.extend((apart > 0).then(|| format!("{}: {apart} of {most} boxes are in none of fewer", mesh.name)));
        fewer = more;
    }
    faults
}

fn mesh(topology: Topology, positions: Vec<Vec3>) -> Mesh {
    let corners = [3, 2, 1][topology as usize];
    let indices = (0..(positions.len() / corners * corners) as u32).collect();
    Mesh {
        name: "mesh".into(),
        topology,
        indices,
        normals: vec![Vec3::Y; positions.len()],
        positions,
        ..Mesh::default()
    }
}

/// A pyramid of six triangles, as in figure 29-2: its base is the square from -1 to 1, its height 2.
fn pyramid() -> Mesh {
    let base = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[x, z]| Vec3::new(x, 0.0, z));
    let apex = Vec3::new(0.0, 2.0, 0.0);
    let sides = (0..4).flat_map(|side| [base[side], base[(side + 1) % 4], apex]);
    let floor = [base[0], base[1], base[2], base[0], base[2], base[3]];
    mesh(Topology::Triangles, sides.chain(floor).collect())
}

/// The twelve triangles of a box.
fn crate_(min: Vec3, max: Vec3) -> Vec<Vec3> {
    let corner = |index: usize| {
        Vec3::from(std::array::from_fn(|axis| if index >> axis & 1 == 0 { min[axis] } else { max[axis] }))
    };
    let face = |axis: usize, side: usize| {
        let (u, v) = (1 << ((axis + 1) % 3), 1 << ((axis + 2) % 3));
        let at = side << axis;
        [at, at | u, at | u | v, at, at | u | v, at | v]
    };
    (0..3).flat_map(|axis| [face(axis, 0), face(axis, 1)]).flatten().map(corner).collect()
}

/// A top one wide and a tenth thick, on four legs.
fn table() -> Mesh {
    let mut positions = crate_(Vec3::new(0.0, 0.9, 0.0), Vec3::ONE);
    for [x, z] in [[0.0, 0.0], [0.9, 0.0], [0.0, 0.9], [0.9, 0.9]] {
        positions.extend(crate_(Vec3::new(x, 0.0, z), Vec3::new(x + 0.1, 0.9, z + 0.1)));
    }
    mesh(Topology::Triangles, positions)
}

/// Eight crates at the corners of a larger one.
fn crates_apart() -> Mesh {
    let corner = |index: usize| Vec3::from(std::array::from_fn(|axis| (4 * (index >> axis & 1)) as f32));
    let crates = (0..8).flat_map(|index| crate_(corner(index), corner(index) + Vec3::ONE));
    mesh(Topology::Triangles, crates.collect())
}

fn volume(box_: &Aabb) -> f64 {
    (box_.max - box_.min).element_product()
}

fn any_mesh() -> impl Strategy<Value = Mesh> {
    let number = prop_oneof![-1.0..1.0f32, Just(0.0f32), Just(1.0f32), -1e4..1e4f32, Just(1e-40f32)];
    let points = prop::collection::vec(prop::array::uniform3(number).prop_map(Vec3::from), 3..60);
    let topology = prop_oneof![Just(Topology::Triangles), Just(Topology::Lines), Just(Topology::Points)];
    (topology, points).prop_map(|(topology, points)| mesh(topology, points))
}

fn any_transform() -> impl Strategy<Value = DAffine3> {
    let number = prop_oneof![-2.0..2.0f64, Just(0.0), Just(1.0), -1e5..1e5f64];
    (prop::array::uniform9(number), prop::array::uniform3(-2e6..2e6f64))
        .prop_map(|(linear, at)| DAffine3 { matrix3: DMat3::from_cols_array(&linear), translation: at.into() })
}

/// Where the GPU puts a point of a triangle: the corners rounded as in shaders/glsl/include/transform.glsl, and between them what is between.
fn gpu_corner(transform: &DAffine3, corner: DVec3) -> DVec3 {
    let (columns, corner) = (transform.matrix3.as_mat3(), corner.as_vec3());
    let turned = columns.x_axis * corner.x + columns.y_axis * corner.y + columns.z_axis * corner.z;
    turned.as_dvec3() + transform.translation
}

/// Found by chance: a needle of 10^4 metres by 10^-40, of which the checker lost a part by its own rounding.
#[test]
fn needles_are_held() {
    let mut positions = vec![Vec3::ZERO; 33];
    for (at, position) in [
        (3, [0.0, -8934.215, 0.0]),
        (8, [0.0, 1e-40, 0.0]),
        (15, [0.232_528_34, 0.492_803_87, -5858.493]),
        (16, [0.0, 1053.1989, 1e-40]),
        (17, [1.0, -889.984_25, 1e-40]),
        (18, [0.0, 1.0, 0.0]),
        (19, [2995.1975, 9514.356, 0.0]),
        (20, [1e-40, 1.0, 1e-40]),
        (21, [0.0, -5189.748, 0.0]),
        (25, [0.0, 0.0, 9980.985]),
        (28, [9617.602, 0.0, 0.0]),
    ] {
        positions[at] = Vec3::from(position);
    }
    let needles = mesh(Topology::Triangles, positions);
    for most in 1..=MOST_BOXES {
        assert_eq!(faults(&needles, most, |_| ()), Vec::<String>::new());
    }
}

proptest! {
    #[test]
    fn all_of_every_triangle_is_held(mesh in any_mesh(), most in 1..=MOST_BOXES) {
        let faults = faults(&mesh, most, |_| ());
        prop_assert!(faults.is_empty(), "{faults:?}");
        prop_assert!(nested(&mesh).is_empty(), "{:?}", nested(&mesh));
    }

    #[test]
    fn all_of_every_triangle_is_held_where_the_gpu_puts_it(
        mesh in any_mesh(), transform in any_transform(), parts in prop::collection::vec((0.0..1.0f64, 0.0..1.0f64), 20)
    ) {
        let boxes: Vec<Aabb> = boxes(&mesh, MOST_BOXES).in_world(transform).collect();
        // What weighing corners rounds, in this test alone.
        let rounding = DVec3::splat(8.0 * f64::EPSILON * boxes.iter().map(|box_| box_.min.abs().max(box_.max.abs()).max_element()).fold(0.0, f64::max));
        for corners in local(&mesh) {
            let [a, b, c] = corners.map(|corner| gpu_corner(&transform, corner));
            let between = parts.iter().map(|(u, v)| {
                let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (*u, *v) };
                (1.0 - u - v) * a + u * b + v * c
            });
            for point in between.chain([a, b, c, 0.5 * a + 0.5 * b]) {
                prop_assert!(boxes.iter().any(|box_| box_.widened(rounding).contains(point)), "{point} is in none of {boxes:?}");
            }
        }
    }
}

#[test]
fn the_meshes_of_all_scenes_are_held() {
    // Some scenes share meshes.
    let mut known: Vec<Mesh> = Vec::new();
    for entry in SCENES {
        let scene = (entry.make)(&SceneOptions { scale: 0.01, ..SceneOptions::default() });
        let whole = WorldBounds::new(&scene);
        let (mut several, mut looked_at) = (0, 0);
        for (index, mesh) in scene.meshes.iter().enumerate().filter(|(_, mesh)| mesh.indices.len() < 1500) {
            looked_at += 1;
            if !known.contains(mesh) {
                known.push(mesh.clone());
                for most in [1, 4, 8] {
                    assert_eq!(faults(mesh, most, |_| ()), Vec::<String>::new(), "{}", entry.name);
                }
                assert_eq!(nested(mesh), Vec::<String>::new(), "{}", entry.name);
            }
            let eight = boxes(mesh, 8);
            several += usize::from(eight.len() > 1);
            let own = whole.in_object_space(index as u32);
            assert!(
                eight.in_object_space().all(|box_| own.union(box_) == own),
                "{}: beyond the mesh's own box",
                mesh.name
            );
        }
        println!("{}: {several} of {looked_at} meshes ({} in all) have several boxes", entry.name, scene.meshes.len());
    }
}

/// Figure 29-2: several boxes are the smaller ones. A crate has nothing to gain, and keeps one.
#[test]
fn a_pyramid_and_a_table_gain_and_a_crate_does_not() {
    let filled = |mesh: &Mesh, most| boxes(mesh, most).in_object_space().map(|box_| volume(&box_)).sum::<f64>();
    assert_eq!(filled(&pyramid(), 1), 8.0);
    assert!(filled(&pyramid(), 4) < 6.5, "{}", filled(&pyramid(), 4));
    // The table's own parts fill 0.136 of its box; the grid's cells do not end where its legs do.
    let [one, eight] = [1, 8].map(|most| filled(&table(), most));
    assert!(one > 0.99 && eight < 0.35, "{one} and {eight}");
    let crate_ = mesh(Topology::Triangles, crate_(Vec3::NEG_ONE, Vec3::ONE));
    assert_eq!(boxes(&crate_, 8).len(), 1);
}

/// A part in the middle of a triangle is as uncertain on the GPU as the triangle's corners, however near the origin it lies.
#[test]
fn boxes_are_rounded_as_the_whole_mesh_is() {
    let far = 1e6f32;
    let wide = mesh(Topology::Triangles, [[-far, 0.0, 0.0], [far, 0.0, 0.0], [0.0, 0.0, far]].map(Vec3::from).to_vec());
    let found = boxes(&wide, 8);
    assert!(found.len() > 1);
    // Four roundings by 2^-24 of 10^6.
    let least = 0.9 * 4.0 * 1e6 / f64::from(1 << 24);
    for (local, world) in found.in_object_space().zip(found.in_world(DAffine3::IDENTITY)) {
        assert!(world.min.x < local.min.x - least && world.max.x > local.max.x + least, "{local:?} and {world:?}");
    }
}

#[test]
fn meshes_of_nothing_and_of_no_size_have_one_box() {
    let nothing = Mesh::default();
    assert_eq!(boxes(&nothing, 8).in_object_space().collect::<Vec<_>>(), [Aabb { min: DVec3::ZERO, max: DVec3::ZERO }]);
    let point = mesh(Topology::Points, vec![Vec3::new(1.0, 2.0, 3.0)]);
    assert_eq!(boxes(&point, 8).len(), 1);
    assert_eq!(faults(&point, 8, |_| ()), Vec::<String>::new());
}

#[test]
fn shrunk_boxes_forgotten_triangles_and_boxes_of_corners_alone_are_caught() {
    for at in 0..8 {
        assert_eq!(boxes(&crates_apart(), 8).len(), 8);
        let shrunk = faults(&crates_apart(), 8, |boxes| boxes[at].max = boxes[at].min.lerp(boxes[at].max, 0.9));
        assert!(!shrunk.is_empty(), "box {at}");
    }
    // Boxes of all triangles but the last, which sticks out.
    let mut spiked = table();
    let first = spiked.positions.len() as u32;
    spiked.positions.extend([[0.5, 0.95, 0.5], [0.6, 0.95, 0.5], [0.5, 1.3, 0.5]].map(Vec3::from));
    spiked.indices.extend(first..first + 3);
    assert_eq!(faults(&spiked, 8, |_| ()), Vec::<String>::new());
    let forgotten = faults(&spiked, 8, |found| *found = boxes(&table(), 8).in_object_space().collect());
    assert!(forgotten.iter().any(|fault| fault.contains("1 triangles are not held")), "{forgotten:?}");
    for mesh in [pyramid(), table(), crates_apart()] {
        // A box around each corner holds all corners, and no triangle.
        let corners = |boxes: &mut Vec<Aabb>| {
            *boxes = mesh.positions.iter().map(|corner| Aabb::from_points([corner.as_dvec3()])).collect();
        };
        assert!(faults(&mesh, 100, corners).iter().any(|fault| fault.contains("not held")));
    }
}
