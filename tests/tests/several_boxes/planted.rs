//! Several boxes with one defect: the harness must say so.

use culling::boxes::BoxShape;
use culling::roc::twin::selection;
use culling::{DrawList, Method, Setup, View, World};
use engine::{Buffer, Frame, IndexedIndirect, OcclusionQueries, Placement, Queried, Target};
use glam::{DVec3, Vec3};
use harness::laws::{self, Make};
use harness::worlds::Maker;
use harness::{gpu, worlds, Case};
use scenes::{CameraPath, SceneOptions, Topology};
use shaders::queries;
use shaders::types::{Bounds, DrawCommand, SELECT_SHOWN, SELECT_TESTED};

/// What is wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Defect {
    Nothing,
    /// All boxes of an object but its last are asked about.
    LastBoxForgotten,
    ShrunkBoxes,
    /// Boxes stay where they were made.
    BoxesStayBehind,
    /// An object whose first box is out of view counts as out of view.
    PlaceOfFirstBox,
}

/// Pairs of posts, the left ones behind a wall; then the camera looks at the right ones alone.
fn posts() -> Case {
    let mut maker = Maker::new("posts");
    let wall = maker.mesh(worlds::cube());
    maker.place(wall, worlds::sized(DVec3::new(-5.0, 0.0, 2.0), DVec3::new(8.0, 12.0, 0.1)));
    let (left, right) = (worlds::cube(), worlds::cube());
    let moved = |cube: &scenes::Mesh, x: f32| cube.positions.iter().map(|at| *at + Vec3::X * x).collect::<Vec<_>>();
    let positions = [moved(&left, -4.0), moved(&right, 4.0)].concat();
    let indices = left.indices.iter().copied().chain(right.indices.iter().map(|index| index + 8)).collect();
    let pair = maker.mesh(worlds::mesh("posts", Topology::Triangles, positions, indices));
    for row in 0..5 {
        maker.place(pair, worlds::sized(DVec3::new(0.0, f64::from(row) * 1.5 - 3.0, 0.0), DVec3::ONE));
    }
    let shot = |at: DVec3, to: DVec3| worlds::shot(at, to, worlds::PERSPECTIVE);
    let ahead = shot(DVec3::new(0.0, 0.0, 14.0), DVec3::ZERO);
    let aside = shot(DVec3::new(4.0, 0.0, 8.0), DVec3::new(5.0, 0.0, 0.0));
    Case::new("posts", maker.scene, vec![ahead, aside])
}

/// Things that move, in twelve frames: of four, one box that stays behind lost something, and where boxes reach farther (a vertex grid of 1/16
/// pixel) none.
fn moving() -> Case {
    let scene = scenes::open("moving-boxes", &SceneOptions { scale: 0.5, ..SceneOptions::default() }).unwrap();
    let path = CameraPath::named(&scene, Some("rotate"), 1.0).unwrap().whole();
    let shots = (0..12).map(|frame| path.sample(frame, 12)).collect();
    Case::new("moving", scene, shots)
}

/// The object with the largest box.
fn largest(world: &World) -> usize {
    let size = |object: &usize| world.host_bounds()[*object].half_extent().length();
    (0..world.len()).max_by(|one, other| size(one).total_cmp(&size(other))).unwrap_or(0)
}

/// Draws the largest object, asks about the boxes of the rest, and draws what shows.
struct Broken {
    defect: Defect,
    shape: BoxShape,
    meshes: culling::world::BoxesOfMeshes,
    boxes: Option<Vec<Vec<Bounds>>>,
    tested: Buffer<Bounds>,
    listed: Buffer<u32>,
    commands: Buffer<DrawCommand>,
    queries: OcclusionQueries,
    flags: [Buffer<u32>; 2],
    lists: [DrawList; 2],
}

fn broken(setup: &Setup<'_>, defect: Defect) -> culling::Result<Box<dyn Method>> {
    let (gpu, world) = (setup.gpu, setup.world);
    let room = 8 * world.len();
    let flags = |name: &str| Buffer::new(gpu, name, world.len(), Placement::Upload);
    Ok(Box::new(Broken {
        defect,
        shape: BoxShape::new(gpu, "broken", 1)?,
        meshes: world.boxes_of_meshes(8)?,
        boxes: None,
        tested: Buffer::new(gpu, "broken.bounds", room, Placement::Upload)?,
        listed: Buffer::new(gpu, "broken.listed", room, Placement::Upload)?,
        commands: Buffer::new(gpu, "broken.commands", world.len(), Placement::Upload)?,
        queries: OcclusionQueries::new(gpu, "broken.queries", world.len() as u32)?,
        flags: [flags("broken.first")?, flags("broken.rest")?],
        lists: [DrawList::new(gpu, "broken.early", world)?, DrawList::new(gpu, "broken.late", world)?],
    }))
}

impl Broken {
    fn boxes(&mut self, world: &World) -> Vec<Vec<Bounds>> {
        let of = |object| world.gpu_boxes_of_object(object, &self.meshes).collect::<Vec<Bounds>>();
        let mut boxes: Vec<_> = (0..world.len() as u32).map(of).collect();
        for several in &mut boxes {
            match self.defect {
                Defect::LastBoxForgotten if several.len() > 1 => _ = several.pop(),
                Defect::ShrunkBoxes => {
                    several.iter_mut().for_each(|bound| bound.half_extent = bound.half_extent.map(|half| 0.3 * half));
                }
                _ => (),
            }
        }
        match self.defect {
            Defect::BoxesStayBehind => self.boxes.get_or_insert(boxes).clone(),
            _ => boxes,
        }
    }

    fn place(&self, boxes: &[Bounds], view: &View) -> u32 {
        let places: Vec<u32> = boxes.iter().map(|bound| selection(bound, 0, &view.cull())).collect();
        match self.defect {
            Defect::PlaceOfFirstBox => places[0],
            _ if places.contains(&SELECT_SHOWN) => SELECT_SHOWN,
            _ => *places.iter().max_by_key(|place| **place == SELECT_TESTED).unwrap_or(&places[0]),
        }
    }

    fn ask(&mut self, f: &mut Frame, asked: &[&Vec<Bounds>], target: &Target) -> culling::Result<Vec<u64>> {
        let all: Vec<Bounds> = asked.iter().flat_map(|boxes| boxes.iter().copied()).collect();
        let mut first = 0;
        let command = |boxes: &&Vec<Bounds>| {
            let command = DrawCommand { instance_count: boxes.len() as u32, ..BoxShape::no_boxes(first) };
            first += boxes.len() as u32;
            command
        };
        self.commands.write(&asked.iter().map(command).collect::<Vec<_>>())?;
        self.tested.write(&all)?;
        self.listed.write(&(0..all.len() as u32).collect::<Vec<_>>())?;
        let count = asked.len() as u32;
        let draw = IndexedIndirect { count: None, ..self.shape.draw(self.commands.all(), count) };
        let stage =
            queries::TestObjects { bounds: self.tested.all(), listed: self.listed.all(), views: self.shape.view() };
        f.query_boxes(stage, draw, Queried { queries: &self.queries, first: 0 }, &target.test_only());
        Ok(f.wait_for_queries(&self.queries, 0..count)?)
    }
}

impl Method for Broken {
    fn frame(&mut self, f: &mut Frame, world: &World, view: &View, target: &Target) -> culling::Result<()> {
        world.update(f);
        f.clear(target);
        self.shape.look(view)?;
        let boxes = self.boxes(world);
        let wall = largest(world);
        let first: Vec<u32> = (0..world.len()).map(|object| u32::from(object == wall)).collect();
        self.flags[0].write(&first)?;
        self.lists[0].pack(f, world, self.flags[0].all());
        world.draw(f, &self.lists[0], view, target);
        f.submit_and_wait()?;
        let places: Vec<u32> = boxes.iter().map(|boxes| self.place(boxes, view)).collect();
        let asked: Vec<usize> =
            (0..world.len()).filter(|object| first[*object] == 0 && places[*object] == SELECT_TESTED).collect();
        let samples = self.ask(f, &asked.iter().map(|object| &boxes[*object]).collect::<Vec<_>>(), target)?;
        let shown = |(first, place): (&u32, &u32)| u32::from(*first == 0 && *place == SELECT_SHOWN);
        let mut late: Vec<u32> = first.iter().zip(&places).map(shown).collect();
        asked.iter().zip(&samples).for_each(|(object, samples)| late[*object] = u32::from(*samples > 0));
        self.flags[1].write(&late)?;
        self.lists[1].pack(f, world, self.flags[1].all());
        world.draw(f, &self.lists[1], view, target);
        Ok(())
    }
}

fn caught(wrong: Make, case: &Case) {
    laws::a_defect_alone_loses_objects(&gpu(), |setup| broken(setup, Defect::Nothing), wrong, case);
}

#[test]
fn a_forgotten_box_is_caught() {
    caught(|setup| broken(setup, Defect::LastBoxForgotten), &posts());
}

#[test]
fn shrunk_boxes_are_caught() {
    caught(|setup| broken(setup, Defect::ShrunkBoxes), &worlds::walled(100));
}

#[test]
fn boxes_that_stay_behind_are_caught() {
    caught(|setup| broken(setup, Defect::BoxesStayBehind), &moving());
}

#[test]
fn the_place_of_one_box_alone_is_caught() {
    caught(|setup| broken(setup, Defect::PlaceOfFirstBox), &posts());
}
