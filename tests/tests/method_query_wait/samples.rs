//! Occlusion queries count what they should: the pixels of the item buffer.

use super::{gpu, worlds, Subject};
use culling::world::SKIP_OPTION;
use culling::{Method, Options, Setup, View, World};
use engine::{
    Buffer, Extra, Frame, Gpu, GpuOptions, IndexedIndirect, OcclusionQueries, Placement, Queried, Target, TimerMode,
};
use harness::{options, Lab};
use shaders::types::DrawCommand;
use shaders::{draw, BufferRef};

/// Draws every object, each counted by a query, in the order of the world.
struct Counting {
    queries: OcclusionQueries,
    commands: Buffer<DrawCommand>,
}

fn make(setup: &Setup<'_>) -> culling::Result<Box<dyn Method>> {
    Ok(Box::new(counting(setup.gpu, setup.world)))
}

fn counting(gpu: &Gpu, world: &World) -> Counting {
    Counting {
        queries: OcclusionQueries::new(gpu, "test.queries", world.len() as u32).unwrap(),
        commands: Buffer::with_data(gpu, "test.commands", &world.commands(), Placement::Upload).unwrap(),
    }
}

impl Method for Counting {
    fn frame(&mut self, f: &mut Frame, world: &World, view: &View, target: &Target) -> culling::Result<()> {
        world.update(f);
        f.clear(target);
        for range in world.ranges() {
            let commands = self.commands.all().from(range.first as usize);
            let draw = IndexedIndirect {
                vertices: world.vertices().into(),
                instances: world.objects().into(),
                indices: world.indices().into(),
                commands: BufferRef { size: u64::from(range.count) * 20, ..commands }.into(),
                count: None,
                max_draws: range.count,
                primitives: range.primitives,
                faces: range.faces,
                surface: range.surface,
            };
            let queried = Queried { queries: &self.queries, first: range.first };
            f.query_objects(draw::ObjectsAndItems { view: view.gpu() }, draw, queried, target);
        }
        Ok(())
    }
}

/// Of objects that are drawn, later ones over earlier: the sum of an object's own pixels is at most what its query counted, the
/// last one's is just that, and where an object was drawn alone all counts are its pixels.
#[test]
fn a_query_counts_the_pixels_that_pass() {
    let gpu = gpu();
    for case in [worlds::walled(20), worlds::special::topologies()] {
        let mut lab = Lab::new(&gpu, &case);
        let mut method = counting(&gpu, &lab.world);
        let shot = case.shots[0];
        let take = lab.take(&mut method, &shot, 0);
        let samples = method.queries.read(0..lab.world.len() as u32).unwrap();
        let owned = |object: usize| take.images.items.iter().filter(|item| **item == object as u32).count() as u64;
        for (object, samples) in samples.iter().enumerate() {
            assert!(owned(object) <= *samples, "{}, object {object}: {} of {samples}", case.name, owned(object));
        }
        let last = samples.len() - 1;
        assert_eq!(samples[last], owned(last), "{}: nothing is drawn over the last object", case.name);
        assert!(samples.iter().any(|samples| *samples > 1), "{}: no query counted anything", case.name);
        assert!(take.drawn.objects.iter().all(|drawn| *drawn), "{}: queried draws are draws", case.name);
    }
}

#[test]
fn samples_are_not_counted_on_a_device_that_cannot() {
    let mut without = GpuOptions { timer: Some(TimerMode::Split), ..options() };
    without.without.push(Extra::OcclusionQueryPrecise.name().to_owned());
    let gpu = Gpu::open(&without).unwrap();
    let case = worlds::walled(100);
    for id in ["query-wait", "query-lag", "chc", "chc++", "nohc"] {
        let lab = Lab::new(&gpu, &case);
        let subject = Subject::named(id).with("min-pixels", "5");
        let setup = Setup { gpu: &gpu, world: &lab.world, options: &subject.options, visible: None };
        let error = (subject.make)(&setup).err().expect("refused").to_string();
        assert!(error.contains("occlusionQueryPrecise") && error.contains("min-pixels"), "{error}");
        if id != "query-lag" {
            harness::assert_none(&harness::laws::no_visible_object_is_culled(&gpu, &Subject::named(id), &case));
        }
    }
}

/// The errors of `min-pixels` are those it was asked for: what it leaves out shows by fewer pixels.
#[test]
fn what_min_pixels_leaves_out_hardly_shows() {
    let gpu = gpu();
    let case = worlds::walled(400);
    let mut lab = Lab::new(&gpu, &case);
    let (truths, sets) = lab.truths(&case.shots);
    let mut drawn = [0usize; 2];
    for (setting, least) in [1u64, 40].into_iter().enumerate() {
        let mut method = lab.make(&Subject::named("query-wait").with("min-pixels", &least.to_string()), &sets);
        for (frame, (shot, truth)) in case.shots.iter().zip(&truths).enumerate() {
            let take = lab.take(&mut *method, shot, frame);
            drawn[setting] += take.drawn.objects.iter().filter(|drawn| **drawn).count();
            for (object, was_drawn) in take.drawn.objects.iter().enumerate() {
                let items = &truth.images().items;
                let pixels = items.iter().filter(|item| **item == object as u32).count() as u64;
                assert!(*was_drawn || pixels < least, "object {object} shows by {pixels} pixels of {least}");
            }
        }
    }
    assert!(drawn[1] < drawn[0], "{drawn:?}: nothing was left out");
}

/// Without it these tests would run on a method that nobody can make.
#[test]
fn the_counting_method_is_exact() {
    let subject = Subject { options: Options::new("counting", &[SKIP_OPTION]), make };
    harness::assert_none(&harness::laws::no_visible_object_is_culled(&gpu(), &subject, &worlds::walled(50)));
}
