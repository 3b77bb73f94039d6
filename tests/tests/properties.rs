//! Properties of bounds, footprints, farthest-depth maps and packing over any input, by proptest, which makes what fails small. They
//! are of the twins, and the stages equal their twins (`tests/stages`, `tests/method_hom`, `tests/method_hzb`). Groups are in
//! `scenes/tests/bvh_groups.rs`.

use culling::farthest::twin::{fill_from_depth, Map};
use culling::farthest::{layout, MapKind, Structure};
use culling::frustum::twin::clip_from_bounds;
use culling::hzb::twin::{footprint_of, Footprint};
use culling::pack::twin::{count_flags, scan_counts, write_commands};
use culling::world::gpu_bounds;
use culling::View;
use glam::{DAffine3, DMat3, DQuat, DVec2, DVec3};
use harness::worlds::shot;
use proptest::prelude::*;
use scenes::{Aabb, Projection};
use shaders::types::{Bounds, MeshRange};

const SIZE: [u32; 2] = [320, 180];

fn vector(reach: f64) -> impl Strategy<Value = DVec3> {
    (-reach..reach, -reach..reach, -reach..reach).prop_map(|(x, y, z)| DVec3::new(x, y, z))
}

fn projection() -> impl Strategy<Value = Projection> {
    let perspective = (0.02f64..3.1, -5.0f64..0.0, prop::option::of(2.0f64..7.0));
    prop_oneof![
        perspective.prop_map(|(fov_y, near, far)| Projection::Perspective {
            fov_y,
            near: 10f64.powf(near),
            far: far.map(|far| 10f64.powf(far))
        }),
        (0.1f64..50.0, -20.0f64..1.0).prop_map(|(half_height, near)| Projection::Orthographic {
            half_height,
            near,
            far: near + 120.0
        }),
    ]
}

/// A box at some scale, seen from some place, all of it somewhere far from the origin; and points of the box, as parts of its sides.
fn seen_box() -> impl Strategy<Value = (Bounds, View, Vec<DVec3>)> {
    let place = (vector(1.0), vector(1.0), -6.0f64..6.0, vector(1.0), 0.0f64..9.0);
    let parts = prop::collection::vec(vector(1.0), 24);
    (place, projection(), vector(1.0), parts, prop::array::uniform3(-4.0f64..0.5)).prop_map(
        |((at, eye, decade, away, distance), projection, target, parts, sides)| {
            let scale = 10f64.powf(decade);
            let away = away * 10f64.powf(distance);
            let half = DVec3::from(sides.map(|side| 10f64.powf(side))) * scale;
            let centre = away + at * 3.0 * scale;
            let shot = shot(away + (eye * 6.0 + DVec3::Z * 4.0) * scale, away + target * scale, projection);
            let aabb = Aabb { min: centre - half, max: centre + half };
            let bounds = gpu_bounds(&aabb, &DAffine3::from_translation(centre), 0);
            let points = parts.into_iter().map(|part| aabb.centre() + part * 0.5 * (aabb.max - aabb.min)).collect();
            (bounds, View::new(&shot, SIZE, 0, 1.0 / 256.0), points)
        },
    )
}

/// Where a point is on the screen, in pixels, and its depth, in f64; none if it is not between the planes.
fn projected(view: &View, point: DVec3) -> Option<(DVec2, f64)> {
    let clip = view.clip_from_relative() * (point - view.pose.position).extend(1.0);
    let depth = clip.z / clip.w;
    let size = DVec2::new(f64::from(SIZE[0]), f64::from(SIZE[1]));
    (clip.w > 0.0 && (0.0..=1.0).contains(&depth))
        .then(|| ((DVec2::new(clip.x, clip.y) / clip.w * 0.5 + 0.5) * size, depth))
}

/// A point lies in the pixels of a footprint, or outside the picture. A footprint is of pixels whose centres are covered, so half a
/// pixel is left on each side, and one that covers no centre may be empty.
fn holds(print: &Footprint, (place, depth): (DVec2, f64)) -> bool {
    let size = DVec2::new(f64::from(SIZE[0]), f64::from(SIZE[1]));
    let shows = place.cmpge(DVec2::ZERO).all() && place.cmplt(size).all();
    let first = DVec2::new(f64::from(print.first[0]), f64::from(print.first[1]));
    let last = DVec2::new(f64::from(print.last[0]), f64::from(print.last[1]));
    let inside = place.cmpge(first - 0.5).all() && place.cmple(last + 1.5).all();
    !shows || print.empty || (inside && depth <= f64::from(print.nearest))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn a_footprint_holds_every_point_of_its_box((bounds, view, points) in seen_box()) {
        let print = footprint_of(&clip_from_bounds(&bounds, &view.cull()), &view.cull(), bounds.flags);
        if !print.crosses_near {
            for point in points {
                let Some(seen) = projected(&view, point) else { continue };
                prop_assert!(holds(&print, seen), "{point} at {seen:?}: {print:?}");
            }
        }
    }

    #[test]
    fn bounds_hold_what_they_are_of(at in vector(1.0), decade in -9.0f64..9.0, turn in vector(3.0), sides in vector(2.0)) {
        let centre = at * 10f64.powf(decade);
        let turned = DMat3::from_quat(DQuat::from_euler(glam::EulerRot::XYZ, turn.x, turn.y, turn.z));
        let place = DAffine3 { matrix3: turned * DMat3::from_diagonal(sides), translation: centre };
        let corners: Vec<DVec3> = (0..8).map(|corner| {
            place.transform_point3(DVec3::new(f64::from(corner & 1), f64::from(corner >> 1 & 1), f64::from(corner >> 2)) - 0.5)
        }).collect();
        let aabb = corners.iter().fold(Aabb { min: corners[0], max: corners[0] }, |all, corner| {
            Aabb { min: all.min.min(*corner), max: all.max.max(*corner) }
        });
        let bounds = gpu_bounds(&aabb, &place, 0);
        let wide = |part: [f32; 3]| DVec3::from(part.map(f64::from));
        let centre = wide(bounds.centre_high) + wide(bounds.centre_low);
        let half = wide(bounds.half_extent);
        for corner in corners {
            prop_assert!((corner - centre).abs().cmple(half).all(), "{corner}: {bounds:?}");
        }
    }

    #[test]
    fn a_map_never_hides_more_than_its_depths(
        (size, depth) in (1u32..70, 1u32..70).prop_flat_map(|(width, height)| {
            (Just([width, height]), prop::collection::vec(0.0f32..1.0, (width * height) as usize))
        }),
        ends in prop::array::uniform4(0.0f64..1.0),
        structure in prop_oneof![Just(Structure::NBuffer), Just(Structure::YMap(2)), Just(Structure::YMap(1)), Just(Structure::Mip)],
        reduction in 0u32..3,
    ) {
        let kind = MapKind { structure, reduction };
        let map = Map::over(&fill_from_depth(&depth, size, reduction), layout(size, kind));
        let side = |axis: usize| {
            let [a, b] = [ends[axis], ends[axis + 2]].map(|part| (part * f64::from(size[axis])) as u32);
            [a.min(b), a.max(b)]
        };
        let ([left, right], [top, bottom]) = (side(0), side(1));
        let within = (top..=bottom).flat_map(|y| (left..=right).map(move |x| (y * size[0] + x) as usize));
        let farthest = within.map(|pixel| depth[pixel]).fold(f32::INFINITY, f32::min);
        let found = map.farthest_within([left, top], [right, bottom]);
        prop_assert!(found <= farthest, "{kind:?}: {found} is nearer than {farthest}");
        if kind == (MapKind { structure: Structure::NBuffer, reduction: 0 }) {
            prop_assert_eq!(found, farthest, "an N-buffer is exact");
        }
    }

    #[test]
    fn packing_keeps_every_flagged_object_once_and_in_order(
        objects in prop::collection::vec((0u32..3, 0usize..5), 0..3000),
    ) {
        let meshes: Vec<MeshRange> = (0..5).map(|mesh| MeshRange { first_index: mesh * 7, index_count: mesh + 1, vertex_offset: mesh as i32 }).collect();
        let flags: Vec<u32> = objects.iter().map(|(flag, _)| *flag).collect();
        let of: Vec<u32> = objects.iter().map(|(_, mesh)| *mesh as u32).collect();
        let commands = write_commands(&flags, &of, &meshes);
        let flagged: Vec<u32> = (0..).zip(&flags).filter(|(_, flag)| **flag != 0).map(|(object, _)| object).collect();
        prop_assert_eq!(commands.iter().map(|command| command.first_instance).collect::<Vec<_>>(), flagged.clone());
        for command in &commands {
            let mesh = meshes[of[command.first_instance as usize] as usize];
            prop_assert_eq!((command.index_count, command.first_index, command.instance_count), (mesh.index_count, mesh.first_index, 1));
        }
        // The prefix sum that the stages write by.
        let (starts, total) = scan_counts(&count_flags(&flags));
        prop_assert_eq!(total as usize, flagged.len());
        prop_assert!(starts.windows(2).all(|pair| pair[0] <= pair[1]));
    }
}

/// The first property can fail: a box three hundredths smaller loses its corners.
#[test]
fn a_footprint_of_a_smaller_box_does_not_hold_it() {
    let aabb = Aabb { min: DVec3::splat(-1.0), max: DVec3::splat(1.0) };
    let view = View::new(
        &shot(DVec3::Z * 4.0, DVec3::ZERO, Projection::Perspective { fov_y: 1.0, near: 0.1, far: None }),
        SIZE,
        0,
        1.0 / 256.0,
    );
    let mut bounds = gpu_bounds(&aabb, &DAffine3::IDENTITY, 0);
    let corner = projected(&view, DVec3::ONE).unwrap();
    let print = |bounds: &Bounds| footprint_of(&clip_from_bounds(bounds, &view.cull()), &view.cull(), 0);
    assert!(holds(&print(&bounds), corner));
    bounds.half_extent = bounds.half_extent.map(|half| 0.97 * half);
    assert!(!holds(&print(&bounds), corner));
}
