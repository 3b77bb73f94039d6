//! What materials hide and what they let through, and that the laws notice a method that has it wrong. That every exact method has it
//! right is in each method's own laws, which run the worlds of `worlds::materials` too.

use culling::{Shading, View, VisibleSets, World};
use engine::{Buffer, Gpu, Placement};
use glam::{DVec3, Vec2, Vec3};
use harness::lab::error_of;
use harness::worlds::materials::{back_faces, behind, glass_wall, masked_wall};
use harness::worlds::{shot, sized, square, Case, Maker};
use harness::{gpu, laws, Lab, Random, Subject};
use scenes::{Projection, Scene, Surface, Texture, Wrap};
use shaders::translucent;
use shaders::types::{DrawCommand, MeshRange};
use sightline::measures::metrics::Truth;
use std::sync::Arc;

const WALL: usize = 0;
const BODY: usize = 1;

fn masked(scene: &mut Scene) {
    scene.objects[WALL].masked = true;
    scene.objects[WALL].surface.texture = Some(0);
}

fn glass(scene: &mut Scene) {
    scene.objects[WALL].translucent = true;
    scene.objects[WALL].colour = [1.0, 0.0, 0.0, 0.5];
}

/// By object of the scene: it is visible.
fn visible(lab: &Lab, truth: &Truth) -> Vec<bool> {
    let mut visible = vec![false; lab.world.total()];
    (0..visible.len()).for_each(|object| visible[lab.world.scene_object(object)] = truth.is_visible(object));
    visible
}

/// Whether wall and body of a case are visible in its first shot.
fn seen(gpu: &Gpu, case: &Case) -> [bool; 2] {
    let mut lab = Lab::new(gpu, case);
    let truth = lab.truth(&case.shots[0]);
    let visible = visible(&lab, &truth);
    [visible[WALL], visible[BODY]]
}

#[test]
fn what_lies_behind_a_hole_is_visible_and_behind_what_is_solid_not() {
    let gpu = gpu();
    assert_eq!(seen(&gpu, &behind(|_| ())), [true, false], "a plain wall hides it");
    assert_eq!(seen(&gpu, &behind(masked)), [true, true], "holes do not");
    let textured = |scene: &mut Scene| scene.objects[WALL].surface.texture = Some(0);
    assert_eq!(seen(&gpu, &behind(textured)), [true, false], "alpha means nothing to what is not masked");
    let never = |scene: &mut Scene| {
        masked(scene);
        scene.objects[WALL].surface.cutoff = 1.5;
    };
    assert_eq!(seen(&gpu, &behind(never)), [false, true], "all of it is cut");
    let faint = |alpha: f32| {
        move |scene: &mut Scene| {
            scene.objects[WALL].masked = true;
            scene.objects[WALL].colour[3] = alpha;
        }
    };
    assert_eq!(seen(&gpu, &behind(faint(0.4))), [false, true], "one alpha, below the cutoff");
    assert_eq!(seen(&gpu, &behind(faint(0.5))), [true, false], "one alpha, not below it");
    let tint = |scene: &mut Scene| {
        scene.meshes[0].colours = vec![[1.0, 1.0, 1.0, 0.04]; 4];
        scene.objects[WALL].masked = true;
    };
    assert_eq!(seen(&gpu, &behind(tint)), [false, true], "colours of vertices have alpha too");
}

#[test]
fn glass_hides_nothing_and_is_visible_before_what_hides() {
    let gpu = gpu();
    let case = behind(glass);
    assert_eq!(seen(&gpu, &case), [true, true]);
    let mut lab = Lab::new(&gpu, &case);
    let truth = lab.truth(&case.shots[0]);
    assert_eq!((lab.world.len(), lab.world.total()), (1, 2));
    let world_wall = (0..2).find(|object| lab.world.scene_object(*object) == WALL).unwrap() as u32;
    assert!(truth.images().items.iter().all(|item| *item != world_wall), "it owns no pixel");
    let body_behind = |scene: &mut Scene| {
        scene.objects[BODY].translucent = true;
        scene.objects[BODY].colour[3] = 0.5;
    };
    assert_eq!(seen(&gpu, &behind(body_behind)), [true, false], "glass behind a wall");
    // Blended: half of the red wall over what was there before.
    let plain = behind(|scene| drop(scene.objects.remove(WALL)));
    let mut without = Lab::new(&gpu, &plain);
    let without = without.truth(&plain.shots[0]);
    let middle = truth.images().items.len() / 2;
    let (over, under) = (truth.images().colour[middle], without.images().colour[middle]);
    assert!(over[1].abs_diff(under[1] / 2) <= 1 && over[0] > under[0] / 2, "{over:?} over {under:?}");
}

#[test]
fn glass_is_blended_back_to_front() {
    let gpu = gpu();
    let case = behind(|scene| {
        let pane = |z: f64, colour: [f32; 4]| scenes::Object {
            world_from_object: sized(DVec3::new(0.0, 0.0, z), DVec3::new(12.0, 12.0, 1.0)),
            translucent: true,
            colour,
            ..scene.objects[WALL].clone()
        };
        // The nearest is listed first.
        scene.objects = vec![pane(1.0, [1.0, 0.0, 0.0, 0.75]), pane(0.0, [0.0, 1.0, 0.0, 0.75])];
    });
    let mut lab = Lab::new(&gpu, &case);
    let truth = lab.truth(&case.shots[0]);
    let middle = truth.images().colour[truth.images().colour.len() / 2];
    assert!(middle[0] > 2 * middle[1] && middle[1] > 0, "red before green: {middle:?}");
}

#[test]
fn a_wall_that_turns_its_back_hides_nothing() {
    let gpu = gpu();
    let one_sided = |scene: &mut Scene| scene.objects[WALL].surface.single_sided = true;
    assert_eq!(seen(&gpu, &behind(one_sided)), [true, false], "its front");
    let turned = |scene: &mut Scene| {
        one_sided(scene);
        scene.objects[WALL].world_from_object.matrix3 *= glam::DMat3::from_rotation_y(std::f64::consts::PI);
    };
    assert_eq!(seen(&gpu, &behind(turned)), [false, true], "its back");
    let mirrored = |scene: &mut Scene| {
        one_sided(scene);
        scene.objects[WALL].world_from_object.matrix3.x_axis *= -1.0;
    };
    assert_eq!(seen(&gpu, &behind(mirrored)), [true, false], "mirrored, it still faces the eye");
    let both_sides = |scene: &mut Scene| {
        turned(scene);
        scene.objects[WALL].surface.single_sided = false;
    };
    assert_eq!(seen(&gpu, &behind(both_sides)), [true, false], "two sides");
}

/// The visible sets of a case, by what its scene would show if `change` were true.
fn wrong_sets(lab: &Lab, case: &Case, change: impl FnOnce(&mut Scene)) -> Arc<VisibleSets> {
    let mut wrong = case.clone();
    change(&mut wrong.scene);
    let mut wrong_lab = Lab::new(&lab.gpu, &wrong);
    let mut sets = VisibleSets::new(lab.world.total());
    for shot in &case.shots {
        let truth = wrong_lab.truth(shot);
        let by_scene = visible(&wrong_lab, &truth);
        let objects = 0..lab.world.total() as u32;
        let items: Vec<u32> = objects.filter(|object| by_scene[lab.world.scene_object(*object as usize)]).collect();
        sets.push_items(&items);
    }
    sets.into()
}

/// How many visible objects a method misses that culls as if `change` were true.
fn missed(gpu: &Gpu, case: &Case, change: impl FnOnce(&mut Scene)) -> usize {
    let mut lab = Lab::new(gpu, case);
    let (truths, _) = lab.truths(&case.shots);
    let sets = wrong_sets(&lab, case, change);
    let mut method = lab.make(&Subject::named("ref"), &sets);
    let takes = lab.film(&mut *method, &case.shots);
    truths.iter().zip(&takes).map(|(truth, take)| error_of(truth, take).false_negatives).sum()
}

#[test]
fn taking_holes_glass_or_backs_for_occluders_is_caught() {
    let gpu = gpu();
    let each = |scene: &mut Scene, change: fn(&mut scenes::Object)| scene.objects.iter_mut().for_each(change);
    let solid = |scene: &mut Scene| each(scene, |object| object.masked = false);
    let opaque = |scene: &mut Scene| each(scene, |object| object.translucent = false);
    let two_sided = |scene: &mut Scene| each(scene, |object| object.surface.single_sided = false);
    assert!(missed(&gpu, &masked_wall(), solid) > 10, "a masked object hides by its triangles");
    assert!(missed(&gpu, &glass_wall(), opaque) > 10, "a translucent object hides");
    assert!(missed(&gpu, &back_faces(), two_sided) > 10, "a back face hides");
    for case in [masked_wall(), glass_wall(), back_faces()] {
        assert_eq!(missed(&gpu, &case, |_| ()), 0, "{}: without an error, nothing is missed", case.name);
    }
}

#[test]
fn glass_is_culled() {
    let case = glass_wall();
    let case = case.filmed(vec![case.shots[0]; 4]);
    let gpu = gpu();
    let mut lab = Lab::new(&gpu, &case);
    let (truths, sets) = lab.truths(&case.shots);
    let solid = lab.world.len();
    let mut glass_drawn = |id: &str| {
        let mut method = lab.make(&Subject::named(id), &sets);
        let takes = lab.film(&mut *method, &case.shots);
        takes[3].drawn.objects[solid..].iter().filter(|drawn| **drawn).count()
    };
    let [none, frustum, hzb, ideal] = ["none", "frustum", "hzb", "ref"].map(&mut glass_drawn);
    let visible = (solid..lab.world.total()).filter(|object| truths[3].is_visible(*object)).count();
    assert_eq!((none, ideal), (lab.world.total() - solid, visible));
    assert!(hzb < frustum && frustum <= none && visible <= hzb, "{none} {frustum} {hzb} {visible}");
}

#[test]
fn lambert_shading_is_exact_too_and_draws_no_textures() {
    let gpu = gpu();
    for case in [masked_wall(), glass_wall()] {
        let mut case = case;
        // What --shading lambert makes of it: the world has no detail, so that the scene need not.
        case.scene.textures.clear();
        case.scene.objects.iter_mut().for_each(|object| object.surface.texture = None);
        case.scene.meshes.iter_mut().for_each(|mesh| mesh.colours.clear());
        let plain = World::new(&gpu, &case.scene).unwrap();
        let lambert = World::shaded(&gpu, &masked_wall().scene, Shading::Lambert).unwrap();
        assert!(lambert.ranges().iter().chain(plain.ranges()).all(|range| range.surface == engine::Surface::Opaque));
        harness::assert_none(&laws::no_visible_object_is_culled(&gpu, &Subject::named("hzb"), &case));
    }
}

/// A square of as many pixels as the texture has texels a side, times `repeats`, that faces a camera and is lit in full.
fn poster(texture: Texture, repeats: u32) -> Case {
    let mut maker = Maker::new("poster");
    let lit = Vec3::new(0.40, 0.82, 0.41).normalize();
    let reach = repeats as f32;
    let mut mesh = square();
    mesh.normals = vec![lit; 4];
    // From one texture before the first to one after it; v goes down.
    let first = if repeats == 1 { 0.0 } else { -1.0 };
    mesh.texture_coordinates =
        mesh.positions.iter().map(|at| Vec2::new(first + reach * (at.x + 0.5), first + reach * (0.5 - at.y))).collect();
    let mesh = maker.mesh(mesh);
    // Evenly scaled, so that the normal stays.
    maker.place(mesh, sized(DVec3::ZERO, DVec3::splat(2.0)));
    maker.scene.objects[0].colour = [1.0; 4];
    maker.scene.objects[0].surface = Surface { texture: Some(0), ..Surface::default() };
    let size = texture.size.map(|side| side * repeats);
    maker.scene.textures.push(texture);
    let camera = Projection::Orthographic { half_height: 1.0, near: -1.0, far: 20.0 };
    Case::new("poster", maker.scene, vec![shot(DVec3::Z * 5.0, DVec3::ZERO, camera)]).sized(size)
}

#[test]
fn a_pixel_for_a_texel_shows_the_texel_however_the_texture_goes_on() {
    let mut random = Random::new(4);
    let texels: Vec<[u8; 4]> =
        (0..64).map(|_| [0, 1, 2].map(|_| random.below(256) as u8)).map(|[r, g, b]| [r, g, b, 255]).collect();
    let gpu = gpu();
    for (mode, repeats) in [(Wrap::Repeat, 1), (Wrap::Repeat, 3), (Wrap::Mirror, 3), (Wrap::Clamp, 3)] {
        let texture =
            Texture { name: "noise".into(), size: [8, 8], texels: texels.clone(), wrap: [mode, Wrap::Repeat] };
        let case = poster(texture, repeats);
        let picture = Lab::new(&gpu, &case).truth(&case.shots[0]).images().clone();
        let first = if repeats == 1 { 0 } else { -8 };
        for pixel in 0..picture.colour.len() as u32 {
            let [x, y] = [pixel % picture.width, pixel / picture.width].map(|at| at as i32 + first);
            let across = match mode {
                Wrap::Repeat => x.rem_euclid(8),
                Wrap::Clamp => x.clamp(0, 7),
                Wrap::Mirror if x.div_euclid(8) % 2 == 0 => x.rem_euclid(8),
                Wrap::Mirror => 7 - x.rem_euclid(8),
            };
            let expected = texels[(y.rem_euclid(8) * 8 + across) as usize];
            let shown = picture.colour[pixel as usize];
            // Light and coordinates are rounded.
            let off = (0..3).map(|channel| shown[channel].abs_diff(expected[channel])).max();
            assert!(off <= Some(2), "{mode:?} x {repeats} at {x}, {y}: {shown:?}, not {expected:?}");
        }
    }
}

#[test]
fn glass_whose_bounds_say_nothing_breaks_no_method() {
    let gpu = gpu();
    let mut case = glass_wall();
    // So far away that its bounds are no use, and it is always kept: once a panic of every method that has a hierarchy.
    case.scene.objects[WALL].world_from_object.translation.x = 3e18;
    let case = case.filmed(case.shots[..2].to_vec());
    let exact = culling::METHODS.iter().filter(|entry| entry.guarantee == culling::Guarantee::Exact);
    for entry in exact {
        harness::assert_none(&laws::no_visible_object_is_culled(&gpu, &Subject::named(entry.id), &case));
    }
}

#[test]
fn the_stages_of_translucent_objects_equal_their_twins() {
    let gpu = gpu();
    let case = glass_wall();
    let world = World::new(&gpu, &case.scene).unwrap();
    let stored = |data: &[u32]| Buffer::with_data(&gpu, "test.words", data, Placement::Storage).unwrap();
    for (frame, test_boxes) in (0..case.shots.len()).flat_map(|frame| [(frame, true), (frame, false)]) {
        let view = View::new(&case.shots[frame], case.size, frame, gpu.snap_px());
        let bounds = world.read_all_bounds().unwrap();
        let (total, first) = (world.total(), world.len());
        let (shown, listed) = (stored(&vec![7; total]), stored(&vec![7; total]));
        let boxes = Buffer::with_data(&gpu, "test.boxes", &[DrawCommand::default()], Placement::Storage).unwrap();
        let stage = translucent::SelectBoxes {
            bounds: world.all_bounds(),
            shown: shown.all(),
            listed: listed.all(),
            boxes: boxes.all(),
            view: view.cull(),
            first_object: first as u32,
            object_count: (total - first) as u32,
            constants: translucent::SelectBoxesConstants { test_boxes },
        };
        let mut f = gpu.frame();
        f.dispatch(stage, (total - first) as u32);
        f.finish().unwrap();
        let twin = culling::translucent::twin::select_boxes(&bounds[first..], &view.cull(), test_boxes);
        assert_eq!(shown.read().unwrap()[..first], vec![7; first], "other objects are left alone");
        assert_eq!(shown.read().unwrap()[first..], twin.0);
        let mut found = listed.read().unwrap()[..boxes.read().unwrap()[0].instance_count as usize].to_vec();
        found.sort_unstable();
        assert_eq!(found, twin.1.iter().map(|object| object + first as u32).collect::<Vec<_>>());
        assert!(frame > 0 || !test_boxes || !found.is_empty(), "the case must have boxes to test");
    }
    let mut random = Random::new(9);
    let mut order: Vec<u32> = (0..100).collect();
    random.shuffle(&mut order);
    let flags: Vec<u32> = (0..100).map(|_| random.below(2) as u32).collect();
    let object_meshes: Vec<u32> = (0..100).map(|_| random.below(5) as u32).collect();
    let meshes: Vec<MeshRange> = (0..5)
        .map(|mesh| MeshRange { first_index: 3 * mesh, index_count: 6 + mesh, vertex_offset: mesh as i32 })
        .collect();
    let meshes_gpu = Buffer::with_data(&gpu, "test.meshes", &meshes, Placement::Storage).unwrap();
    let commands = Buffer::<DrawCommand>::new(&gpu, "test.commands", 100, Placement::Storage).unwrap();
    let (shown, order_gpu, of_object) = (stored(&flags), stored(&order), stored(&object_meshes));
    let stage = translucent::WriteCommands {
        shown: shown.all(),
        order: order_gpu.all(),
        object_meshes: of_object.all(),
        meshes: meshes_gpu.all(),
        commands: commands.all(),
        object_count: 100,
    };
    let mut f = gpu.frame();
    f.dispatch(stage, 100);
    f.finish().unwrap();
    let twin = culling::translucent::twin::write_commands(&order, &flags, &object_meshes, &meshes);
    assert_eq!(commands.read().unwrap(), twin);
}
