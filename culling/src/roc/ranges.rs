//! Objects sorted into depth ranges on the GPU, with the draw lists of each range.

use crate::boxes::BoxShape;
use crate::world::{Range, View, World};
use crate::{Options, Result};
use engine::{Buffer, Frame, Gpu, IndexedIndirect, Placement};
use glam::DVec4;
use shaders::types::{BoxView, DrawCommand, MOST_RANGES, PACK_CHUNK, PLACE_SELECTION_MASK, SELECT_TESTED};
use shaders::{pack, roc, BufferRef, ResourceId, Stage};

/// How the view is cut into depth ranges.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cuts {
    /// Ranges, 1..=[`MOST_RANGES`].
    pub ranges: u32,
    /// Where the last range ends, in metres of view depth, > 0; `None` for where the farthest object in view begins.
    pub outermost: Option<f32>,
    /// Where a range ends, as a share of where the next one does, in 0..1.
    pub share: f32,
    /// What begins past the last range is drawn without a test; otherwise it belongs to the last range.
    pub show_beyond: bool,
}

impl Cuts {
    /// From the options of `roc-iterative`.
    pub fn new(options: &Options) -> Self {
        let (ranges, factor) = (options.number("ranges").clamp(1, MOST_RANGES), options.number("factor").max(2));
        let first = options.number("first");
        let outermost = (first as f32) * (factor as f32).powi(ranges as i32 - 1);
        Cuts {
            ranges,
            outermost: (first > 0).then_some(outermost),
            share: 1.0 / factor as f32,
            show_beyond: options.text("beyond") == "visible",
        }
    }
}

/// The lists of one kind of primitive.
struct Kind {
    objects: Range,
    counts: Buffer<u32>,
    starts: Buffer<u32>,
    totals: Buffer<u32>,
}

/// Two draw lists a depth range: what the last frame saw in it, and all others in view, whose commands draw nothing until
/// their boxes are found open. Each has room for every object of the world, so that it cannot overflow: 40 bytes an object and
/// range, of which a device that binds 128 MiB at once takes a million objects in six ranges.
pub struct RangeLists {
    cuts: Cuts,
    selected: Buffer<u32>,
    depths: Buffer<f32>,
    farthest: Buffer<u32>,
    places: Buffer<u32>,
    kinds: Vec<Kind>,
    early: Buffer<DrawCommand>,
    late: Buffer<DrawCommand>,
    boxes: Buffer<DrawCommand>,
    shape: BoxShape,
    subgroup_size: u32,
    world: ResourceId,
    room: usize,
}

impl RangeLists {
    /// Empty lists with room for all objects of `world`.
    pub fn new(gpu: &Gpu, name: &str, world: &World, cuts: Cuts) -> Result<Self> {
        let (ranges, kind_count) = (cuts.ranges as usize, world.ranges().len());
        let words = |what: &str, len: usize| Buffer::new(gpu, &format!("{name}.{what}"), len, Placement::Storage);
        let commands =
            |what: &str| Buffer::new(gpu, &format!("{name}.{what}"), ranges * world.len(), Placement::Storage);
        let kind = |objects: &Range| {
            let chunks = objects.count.div_ceil(PACK_CHUNK) as usize;
            let (counts, starts) = (words("counts", 2 * ranges * chunks)?, words("starts", 2 * ranges * chunks)?);
            Ok(Kind { objects: *objects, counts, starts, totals: words("totals", 2 * ranges)? })
        };
        let first_boxes = (0..ranges).flat_map(|range| {
            let first = move |kind: &Range| BoxShape::no_boxes((range * world.len()) as u32 + kind.first);
            world.ranges().iter().map(first)
        });
        let boxes: Vec<DrawCommand> = first_boxes.collect();
        Ok(RangeLists {
            cuts,
            selected: words("selected", world.len())?,
            depths: Buffer::new(gpu, &format!("{name}.depths"), world.len(), Placement::Storage)?,
            farthest: words("farthest", 1)?,
            places: words("places", world.len())?,
            kinds: world.ranges().iter().map(kind).collect::<Result<_>>()?,
            early: commands("early")?,
            late: commands("late")?,
            boxes: Buffer::with_data(gpu, &format!("{name}.boxes"), &boxes, Placement::Storage)?,
            shape: BoxShape::new(gpu, name, kind_count as u32)?,
            subgroup_size: gpu.subgroup_size(),
            world: world.id(),
            room: world.len(),
        })
    }

    /// Gives the boxes' shaders the frame's view.
    pub fn look(&mut self, view: &View) -> Result<()> {
        self.shape.look(view)
    }

    /// The frame's view.
    pub fn box_view(&self) -> BufferRef<BoxView> {
        self.shape.view()
    }

    /// Each object's depth range and what becomes of it, see `roc/assign_ranges`.
    pub fn places(&self) -> BufferRef<u32> {
        self.places.all()
    }

    /// The commands of what is tested, where tests give instances to what shows.
    pub fn tested(&self) -> BufferRef<DrawCommand> {
        self.late.all()
    }

    /// Sorts all objects: what the last frame saw (its flag is not 0), what must be tested, and what is drawn without a test.
    ///
    /// # Panics
    /// If the lists were made for another world: they would not have the room.
    pub fn sort(&self, f: &mut Frame, world: &World, view: &View, seen: BufferRef<u32>) {
        self.assert_made_for(world);
        f.fill("roc/clear_farthest", &self.farthest, 0);
        let measure = roc::MeasureBoxes {
            bounds: world.bounds(),
            seen,
            selected: self.selected.all(),
            depths: self.depths.all(),
            farthest: self.farthest.all(),
            view: view.cull(),
            depth_plane: depth_plane(view),
            object_count: world.len() as u32,
        };
        f.dispatch(measure, world.len() as u32);
        for (index, kind) in self.kinds.iter().enumerate() {
            self.list(f, world, kind, index as u32);
        }
    }

    fn list(&self, f: &mut Frame, world: &World, kind: &Kind, index: u32) {
        let chunks = kind.objects.count.div_ceil(PACK_CHUNK);
        let Range { first: first_object, count: object_count, .. } = kind.objects;
        let Cuts { ranges: range_count, outermost, share, show_beyond } = self.cuts;
        let assign = roc::AssignRanges {
            selected: self.selected.all(),
            depths: self.depths.all(),
            farthest: self.farthest.all(),
            places: self.places.all(),
            counts: kind.counts.all(),
            first_object,
            object_count,
            range_count,
            outermost: outermost.unwrap_or(0.0),
            share,
            constants: roc::AssignRangesConstants { show_beyond },
        };
        f.dispatch(assign, chunks);
        let constants = pack::ScanCountsConstants { subgroup_size: self.subgroup_size };
        let (counts, starts, total) = (kind.counts.all(), kind.starts.all(), kind.totals.all());
        f.dispatch_groups(pack::ScanCounts { counts, starts, total, chunk_count: chunks, constants }, 2 * range_count);
        let list = roc::ListRanges {
            places: self.places.all(),
            starts: kind.starts.all(),
            totals: kind.totals.all(),
            object_meshes: world.object_meshes(),
            meshes: world.meshes(),
            early: self.early.all(),
            late: self.late.all(),
            boxes: self.boxes.all(),
            first_object,
            object_count,
            range_count,
            room: self.room as u32,
            kind: index,
            kind_count: self.kinds.len() as u32,
        };
        f.dispatch(list, chunks);
    }

    /// Notes that the lists are used as they are.
    pub fn skip_sorting(f: &mut Frame, reason: &'static str) {
        let stages = [roc::MeasureBoxes::INFO, roc::AssignRanges::INFO, pack::ScanCounts::INFO, roc::ListRanges::INFO];
        for stage in stages {
            f.skip(stage.name, reason);
        }
    }

    /// The ranges, near to far; none in a world without objects.
    pub fn ranges(&self) -> std::ops::Range<usize> {
        0..if self.kinds.is_empty() { 0 } else { self.cuts.ranges as usize }
    }

    /// The draws of what the last frame saw in a range, one a kind of primitive.
    pub fn early<'a>(&'a self, world: &'a World, range: usize) -> impl Iterator<Item = IndexedIndirect> + 'a {
        self.draws(world, &self.early, range, range)
    }

    /// The draws of what was not seen but shows in a range, one a kind of primitive.
    pub fn late<'a>(&'a self, world: &'a World, range: usize) -> impl Iterator<Item = IndexedIndirect> + 'a {
        self.draws(world, &self.late, range, self.cuts.ranges as usize + range)
    }

    fn draws<'a>(
        &'a self,
        world: &'a World,
        commands: &'a Buffer<DrawCommand>,
        range: usize,
        total: usize,
    ) -> impl Iterator<Item = IndexedIndirect> + 'a {
        self.assert_made_for(world);
        self.kinds.iter().map(move |kind| {
            let commands = commands.all().from(range * self.room + kind.objects.first as usize);
            world.multi_draw(&kind.objects, commands, Some(kind.totals.all().from(total)))
        })
    }

    /// The draw of a range's boxes: instance i stands for command i of [`RangeLists::tested`].
    pub fn boxes(&self, range: usize) -> IndexedIndirect {
        let kinds = self.kinds.len();
        self.shape.draw(self.boxes.all().from(range * kinds), kinds as u32)
    }

    /// The objects whose boxes the last frame tested.
    pub fn read_tested(&self) -> Result<Vec<usize>> {
        let places = self.places.read()?;
        Ok((0..places.len()).filter(|object| places[*object] & PLACE_SELECTION_MASK == SELECT_TESTED).collect())
    }

    fn assert_made_for(&self, world: &World) {
        assert_eq!(self.world, world.id(), "these lists were made for another world: make the method again");
    }
}

/// The plane from which view depth is measured, in metres along its normal: through the eye, and the near plane of a
/// parallel view. Its normal is where w, or reversed depth, changes.
pub fn depth_plane(view: &View) -> [f32; 4] {
    let matrix = view.clip_from_relative();
    let [depth, w] = [matrix.row(2), matrix.row(3)];
    // A parallel projection's w does not change, but for rounding.
    let is_parallel = w.truncate().length() <= 1e-12 * w.abs().max_element();
    let plane: DVec4 = if is_parallel { w - depth } else { w };
    (plane / plane.truncate().length()).as_vec4().to_array()
}
