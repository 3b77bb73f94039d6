//! Warping-based culling made of its parts with one defect: the laws of methods that may miss objects, or those of exact ones,
//! must say so.

use culling::farthest::{FarthestMap, MapKind, Structure};
use culling::warp::{Refinement, Settings, Warp};
use culling::{DrawList, Method, OptionInfo, Options, Setup, View, World};
use engine::{Buffer, Frame, Gpu, Placement, Target};
use harness::{approximate, assert_caught, assert_none, gpu, laws, worlds, Subject};
use shaders::frustum;

/// What is wrong with a method.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Defect {
    Nothing,
    /// The depth that is kept is that of the first frame.
    OldDepth,
    /// What the last frame did not see is nearest.
    NearHoles,
    /// The map of the first frame stays.
    OldMap,
    /// The objects tested are those that were drawn the last time.
    NothingComesBack,
}

const KIND: MapKind = MapKind { structure: Structure::YMap(2), reduction: 0 };
const OPTIONS: &[OptionInfo] = &[];

struct Broken {
    defect: Defect,
    gpu: Gpu,
    kept: Buffer<u32>,
    visible: Buffer<u32>,
    list: DrawList,
    parts: Option<(Warp, Buffer<f32>, FarthestMap)>,
    frames: u32,
}

fn make(setup: &Setup<'_>, defect: Defect) -> culling::Result<Box<dyn Method>> {
    let (gpu, world) = (setup.gpu, setup.world);
    let flags = |name| Buffer::new(gpu, name, world.len(), Placement::Storage);
    Ok(Box::new(Broken {
        defect,
        gpu: gpu.clone(),
        kept: flags("broken.kept")?,
        visible: flags("broken.visible")?,
        list: DrawList::new(gpu, "broken.list", world)?,
        parts: None,
        frames: 0,
    }))
}

impl Method for Broken {
    fn frame(&mut self, f: &mut Frame, world: &World, view: &View, target: &Target) -> culling::Result<()> {
        let parts = match self.parts.take().filter(|(warp, ..)| warp.texels() == target.size) {
            Some(parts) => parts,
            None => {
                let warp = Warp::new(&self.gpu, world, target.size, Settings::default())?;
                let texels = target.size.iter().product::<u32>() as usize;
                let warped = Buffer::new(&self.gpu, "broken.warped", texels, Placement::Storage)?;
                (warp, warped, FarthestMap::new(&self.gpu, target.size, KIND)?)
            }
        };
        let (warp, warped, map) = self.parts.insert(parts);
        let (kept, visible, object_count) = (self.kept.all(), self.visible.all(), world.len() as u32);
        world.update(f);
        f.clear(target);
        let (bounds, blocks) = (world.bounds(), world.blocks_in_view(f, view));
        if self.defect == Defect::NothingComesBack && self.frames > 1 {
            f.copy("broken/seen", visible, kept);
        } else {
            f.fill("frustum/clear_kept", kept, 0);
            f.dispatch_indirect(frustum::TestBounds { bounds, blocks, kept, view: view.cull(), object_count }, blocks);
        }
        let seen = warp.has_last();
        if seen && (self.defect != Defect::OldMap || self.frames == 1) {
            warp.frame(f, world, view, warped.all())?;
            let refinement = Refinement { erode: true, close: true, drawn: None };
            if self.defect == Defect::NearHoles {
                // The bits of 1.0: no hole is far, nor is anything else.
                f.fill("broken/near", &*warped, 0x3f80_0000);
            }
            warp.refine(f, warped.all(), map.base(), refinement);
            map.build(f);
        }
        if seen {
            map.test(f, world, view, (kept, blocks), visible);
        }
        self.list.pack(f, world, if seen { visible } else { kept });
        world.draw(f, &self.list, view, target);
        if self.defect != Defect::OldDepth || self.frames == 0 {
            warp.keep(f, world, view, target);
        }
        self.frames += 1;
        Ok(())
    }
}

fn faults(make: fn(&Setup<'_>) -> culling::Result<Box<dyn Method>>) -> Vec<String> {
    let subject = Subject { options: Options::new("broken", OPTIONS), make };
    let gpu = gpu();
    let cases = worlds::special().into_iter();
    cases.flat_map(|case| approximate::a_still_camera_is_exact(&gpu, &subject, &case)).collect()
}

#[test]
fn woc_of_its_parts_is_exact_before_a_still_camera() {
    assert_none(&faults(|setup| make(setup, Defect::Nothing)));
}

/// Without the repair objects are missed, where the other refinements are left out as well; with it none is.
#[test]
fn woc_unrepaired_is_not_exact() {
    let gpu = gpu();
    let faults = |id: &str| -> Vec<String> {
        let subject = Subject::named(id).with("size", "4").with("rapid", "0").with("erode", "none");
        let cases = worlds::special().into_iter();
        cases.flat_map(|case| laws::no_visible_object_is_culled(&gpu, &subject, &case)).collect()
    };
    assert_caught(&faults("woc"), "false negatives");
    assert_none(&faults("woc-exact"));
}

#[test]
fn depth_of_an_older_frame_is_noticed() {
    // The view that it is kept with is older too, so that it is warped rightly; what it did not see stays a hole. Only what
    // came to hide something since is missing, which is no fault of the picture: culling less is what must be noticed.
    let subject = Subject { options: Options::new("broken", OPTIONS), make: |setup| make(setup, Defect::OldDepth) };
    let case = worlds::walled(400);
    let away = case.filmed([3, 0, 0, 0].map(|shot| case.shots[shot]).to_vec());
    let drawn = |subject: &Subject| {
        let gpu = gpu();
        let mut lab = harness::Lab::new(&gpu, &away);
        let mut method = lab.make(subject, &Default::default());
        lab.film(&mut *method, &away.shots).pop().map_or(0, |take| take.drawn.draws)
    };
    let whole = Subject { make: |setup| make(setup, Defect::Nothing), ..subject.clone() };
    let (old, new) = (drawn(&subject), drawn(&whole));
    assert!(old > 2 * new, "{old} objects drawn by old depth, {new} by the last frame's");
}

#[test]
fn near_holes_are_noticed() {
    assert_caught(&faults(|setup| make(setup, Defect::NearHoles)), "false negatives");
}

#[test]
fn an_old_map_is_noticed() {
    assert_caught(&faults(|setup| make(setup, Defect::OldMap)), "false negatives");
}

#[test]
fn objects_that_never_come_back_are_noticed() {
    assert_caught(&faults(|setup| make(setup, Defect::NothingComesBack)), "false negatives");
}
