//! `frustum.test`: spheres, oriented boxes, and spheres before boxes, against twin, oracle and laws.

use crate::stage::{all_blocks, boxes, list_of, BOXES};
use culling::frustum::twin::{self, Shape};
use culling::{DrawList, Method, Setup, View, World};
use engine::{Buffer, Frame, Gpu, Placement, Target};
use harness::worlds::{self, special_projections};
use harness::{assert_caught, assert_none, gpu, guarded, laws, sessions, Random, Subject};
use scenes::{Pose, Shot};
use shaders::frustum::{CountPlanes, CountPlanesConstants, TestShapes, TestShapesConstants};
use shaders::types::*;

const SHAPES: [(&str, u32); 3] = [("sphere", SHAPE_SPHERE), ("obb", SHAPE_ORIENTED), ("sphere-box", SHAPE_SPHERE_BOX)];

/// What there is to test.
struct Bodies {
    bounds: Vec<Bounds>,
    objects: Vec<Object>,
    locals: Vec<LocalBox>,
}

impl Bodies {
    fn shapes(&self) -> Vec<Shape<'_>> {
        let parts = self.bounds.iter().zip(&self.objects).zip(&self.locals);
        parts.map(|((bounds, object), local)| Shape { bounds, object, local }).collect()
    }
}

/// Which bodies are kept, and against how many planes they are tested.
fn run(gpu: &Gpu, bodies: &Bodies, shape: u32, view: CullView) -> (Vec<u32>, u32) {
    let bounds = Buffer::with_data(gpu, "test.bounds", &bodies.bounds, Placement::Storage).unwrap();
    let objects = Buffer::with_data(gpu, "test.objects", &bodies.objects, Placement::Storage).unwrap();
    let locals = Buffer::with_data(gpu, "test.locals", &bodies.locals, Placement::Storage).unwrap();
    let meshes: Vec<u32> = (0..bodies.bounds.len() as u32).collect();
    let meshes = Buffer::with_data(gpu, "test.meshes", &meshes, Placement::Storage).unwrap();
    let kept = guarded::words(gpu, bodies.bounds.len());
    let list = Buffer::with_data(gpu, "test.blocks", &list_of(&all_blocks()), Placement::Storage).unwrap();
    let planes = Buffer::with_data(gpu, "test.planes", &[0u32], Placement::Storage).unwrap();
    let (object_count, blocks) = (bodies.bounds.len() as u32, list.all());
    let test = TestShapes {
        bounds: bounds.all(),
        kept: kept.all(),
        blocks,
        objects: objects.all(),
        object_meshes: meshes.all(),
        local_boxes: locals.all(),
        view,
        object_count,
        constants: TestShapesConstants { shape },
    };
    let count = CountPlanes {
        bounds: bounds.all(),
        blocks,
        objects: objects.all(),
        object_meshes: meshes.all(),
        local_boxes: locals.all(),
        planes: planes.all(),
        view,
        count: object_count,
        constants: CountPlanesConstants { shape, all: false },
    };
    let mut f = gpu.frame();
    f.dispatch_indirect(test, blocks);
    f.dispatch_indirect(count, blocks);
    f.finish().unwrap();
    (guarded::read(&kept), planes.read().unwrap()[0])
}

/// Bodies around a camera; every second one is moved until what is tested of it touches a plane.
fn bodies(random: &mut Random, shape: u32, shot: &Shot, view: &View) -> Bodies {
    let bounds = boxes(random, shot, view);
    let mut bodies = Bodies { bounds: Vec::new(), objects: Vec::new(), locals: Vec::new() };
    for (index, mut bounds) in bounds.into_iter().enumerate() {
        let half = glam::Vec3::from(bounds.half_extent);
        let turn = glam::Mat3::from_quat(random.turn().as_quat()) * glam::Mat3::from_diagonal(2.0 * half);
        let local = LocalBox {
            centre: (random.vector() * 0.3).as_vec3().to_array(),
            half_extent: (random.vector().abs() * 0.5).as_vec3().to_array(),
        };
        let mut object = Object {
            column_x: turn.x_axis.to_array(),
            column_y: turn.y_axis.to_array(),
            column_z: turn.z_axis.to_array(),
            origin_high: bounds.centre_high,
            origin_low: bounds.centre_low,
            colour: 0,
        };
        if index % 2 == 0 {
            let clip = view.clip_from_relative();
            let plane = twin::planes([1.0, 1.0])[random.below(6)].as_dvec4();
            let row = glam::DVec3::new(plane.dot(clip.x_axis), plane.dot(clip.y_axis), plane.dot(clip.z_axis));
            let value = touching(shape, &Shape { bounds: &bounds, object: &object, local: &local }, row)
                + plane.dot(clip.w_axis)
                - row.dot(shot.pose.position);
            if row.length_squared() > 0.0 {
                let at =
                    glam::Vec3::from(bounds.centre_high).as_dvec3() + glam::Vec3::from(bounds.centre_low).as_dvec3();
                let (high, low) = culling::world::split(at - row * (value / row.length_squared()));
                (bounds.centre_high, bounds.centre_low) = (high, low);
                (object.origin_high, object.origin_low) = (high, low);
            }
        }
        bodies.bounds.push(bounds);
        bodies.objects.push(object);
        bodies.locals.push(local);
    }
    bodies
}

/// How far what is tested of a body reaches along a row of the matrix.
fn touching(shape: u32, of: &Shape<'_>, row: glam::DVec3) -> f64 {
    let vector = |parts: [f32; 3]| glam::Vec3::from(parts).as_dvec3();
    let at = vector(of.bounds.centre_high) + vector(of.bounds.centre_low);
    let half = vector(of.bounds.half_extent);
    match shape {
        SHAPE_SPHERE => row.dot(at) + half.length() * row.length(),
        SHAPE_ORIENTED => {
            let columns = [of.object.column_x, of.object.column_y, of.object.column_z].map(vector);
            let along = |axis: usize| row.dot(columns[axis]);
            let centre: f64 = (0..3).map(|axis| along(axis) * f64::from(of.local.centre[axis])).sum();
            let reach: f64 = (0..3).map(|axis| along(axis).abs() * f64::from(of.local.half_extent[axis])).sum();
            row.dot(at) + centre + reach
        }
        _ => row.dot(at) + row.abs().dot(half),
    }
}

#[test]
fn shapes_are_kept_as_twin_and_oracle_say() {
    let gpu = gpu();
    let mut random = Random::new(31);
    for (shape_name, shape) in SHAPES {
        let (mut near_ties, mut kept_outside, mut culled, mut all) = (0, 0, 0, 0);
        for (name, projection) in special_projections() {
            for away in [0.0, 1e6] {
                let pose = Pose { position: random.vector() * away, rotation: random.turn() };
                let shot = Shot { pose, projection, seconds: 0.0 };
                let view = View::new(&shot, [161, 97], 0, gpu.snap_px());
                let bodies = bodies(&mut random, shape, &shot, &view);
                let (kept, planes) = run(&gpu, &bodies, shape, view.cull());
                let shapes = bodies.shapes();
                let twin = twin::test_shapes(shape, &shapes, &all_blocks(), &view.cull());
                let twin_planes = twin::count_planes(shape, &shapes, &all_blocks(), &view.cull());
                let apart = planes.abs_diff(twin_planes) as usize;
                assert!(apart < BOXES / 50, "{shape_name}, {name}: {planes} plane tests, twin {twin_planes}");
                for (index, of) in shapes.iter().enumerate() {
                    let margin = twin::shape_margin(shape, of, &view.cull());
                    let place = format!("{shape_name}, {name}, {away} m out, body {index}, margin {margin:e}");
                    all += 1;
                    near_ties += usize::from(kept[index] != twin[index]);
                    kept_outside += usize::from(margin < 0.0 && kept[index] == 1);
                    culled += usize::from(kept[index] == 0);
                    assert!(margin < -twin::SHAPE_KEPT_BAND || kept[index] == 1, "{place} is inside but was culled");
                    assert!(margin >= -twin::SHAPE_ROUNDING_BAND || kept[index] == 0, "{place} was kept");
                }
            }
        }
        assert!(culled > all / 10, "{shape_name}: hardly any body is outside: {culled} of {all}");
        assert!(kept_outside > all / 1000, "{shape_name}: hardly any body lies near a plane: {kept_outside} of {all}");
        assert!(near_ties < all / 100, "{shape_name}: stage and twin differ in {near_ties} of {all}");
    }
}

#[test]
fn no_visible_object_is_culled_by_any_shape() {
    let gpu = gpu();
    for (shape, _) in SHAPES {
        let subject = Subject::named("frustum").with("test", shape);
        for case in worlds::special() {
            assert_none(&laws::no_visible_object_is_culled(&gpu, &subject, &case));
        }
        assert_none(&laws::skipping_changes_no_pixel(&gpu, &subject, &worlds::walled(80)));
        for run in [("boxes", 1.0, "pan"), ("moving-boxes", 1.0, "rotate"), ("rooms", 0.1, "walk")] {
            assert_none(&sessions::faults(&mut sessions::open(&gpu, run, 8), "frustum", &[("test", shape)]));
        }
    }
}

/// Spheres are looser than boxes, oriented boxes keep what the eye can see, and a sphere before the box decides nothing: it only
/// spares plane tests where objects are small.
#[test]
fn a_sphere_before_the_box_keeps_what_the_box_keeps() {
    let gpu = gpu();
    for run in [("city-block", 0.05, "walk"), ("boxes", 1.0, "pan")] {
        let mut drawn = Vec::new();
        for shape in ["box", "sphere", "obb", "sphere-box"] {
            let mut session = sessions::open(&gpu, run, 6);
            let (mut count, mut tests) = (0, 0);
            let entry = culling::find("frustum").unwrap();
            let options = Subject::named("frustum").with("test", shape).options;
            let mut contender = sightline::run::Contender::new(&session, entry, options, &None).unwrap();
            let truth = sightline::run::truth::RunTruth::draw(&mut session, || ()).unwrap();
            for frame in 0..session.frames() {
                let truth = truth.frame(&mut session, frame).unwrap();
                let measured = contender.measured(&mut session, frame, &truth).unwrap();
                count += measured.drawn.objects.iter().filter(|drawn| **drawn).count();
                tests += measured.work.plane_tests;
            }
            println!("{run:?}, {shape}: {count} objects drawn, {tests} plane tests");
            assert!(tests > 0, "{shape}: plane tests are not counted");
            drawn.push(count);
        }
        let [by_box, by_sphere, by_obb, by_both] = drawn[..] else { panic!("four tests") };
        assert!(by_sphere > by_box && by_both == by_box, "{drawn:?}");
        assert!(by_obb <= by_sphere, "{drawn:?}");
    }
}

/// `frustum` by a shape that is made smaller or not.
struct Shrunk {
    shape: u32,
    bounds: Buffer<Bounds>,
    locals: Buffer<LocalBox>,
    kept: Buffer<u32>,
    list: DrawList,
}

fn shrunk(setup: &Setup<'_>, shape: u32, by: f32) -> culling::Result<Box<dyn Method>> {
    let (gpu, world) = (setup.gpu, setup.world);
    let (mut bounds, mut locals) = (world.read_bounds()?, world.local_boxes());
    bounds.iter_mut().for_each(|bounds| bounds.half_extent = bounds.half_extent.map(|half| by * half));
    locals.iter_mut().for_each(|local| local.half_extent = local.half_extent.map(|half| by * half));
    Ok(Box::new(Shrunk {
        shape,
        bounds: Buffer::with_data(gpu, "shrunk.bounds", &bounds, Placement::Storage)?,
        locals: Buffer::with_data(gpu, "shrunk.locals", &locals, Placement::Storage)?,
        kept: Buffer::new(gpu, "shrunk.kept", world.len(), Placement::Storage)?,
        list: DrawList::new(gpu, "shrunk.list", world)?,
    }))
}

impl Method for Shrunk {
    fn frame(&mut self, f: &mut Frame, world: &World, view: &View, target: &Target) -> culling::Result<()> {
        world.update(f);
        f.clear(target);
        let blocks = world.blocks_in_view(f, view);
        f.fill("frustum/clear_kept", &self.kept, 0);
        let test = TestShapes {
            bounds: self.bounds.all(),
            kept: self.kept.all(),
            blocks,
            objects: world.objects(),
            object_meshes: world.object_meshes(),
            local_boxes: self.locals.all(),
            view: view.cull(),
            object_count: world.len() as u32,
            constants: TestShapesConstants { shape: self.shape },
        };
        f.dispatch_indirect(test, blocks);
        self.list.pack(f, world, self.kept.all());
        world.draw(f, &self.list, view, target);
        Ok(())
    }
}

/// Each shape made smaller than what it holds loses objects, and the law says so.
#[test]
fn shapes_that_are_too_small_are_noticed() {
    let gpu = gpu();
    let case = worlds::walled(300);
    let faults = |make: fn(&Setup<'_>) -> culling::Result<Box<dyn Method>>| {
        let subject = Subject { options: culling::find("frustum").unwrap().default_options(), make };
        laws::no_visible_object_is_culled(&gpu, &subject, &case)
    };
    assert_none(&faults(|setup| shrunk(setup, SHAPE_SPHERE, 1.0)));
    assert_none(&faults(|setup| shrunk(setup, SHAPE_ORIENTED, 1.0)));
    assert_none(&faults(|setup| shrunk(setup, SHAPE_SPHERE_BOX, 1.0)));
    assert_caught(&faults(|setup| shrunk(setup, SHAPE_SPHERE, 0.1)), "differing pixels");
    assert_caught(&faults(|setup| shrunk(setup, SHAPE_ORIENTED, 0.1)), "differing pixels");
    assert_caught(&faults(|setup| shrunk(setup, SHAPE_SPHERE_BOX, 0.1)), "differing pixels");
}
