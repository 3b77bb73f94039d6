//! The farthest-depth pyramid on the GPU, right at every size.

use crate::Result;
use engine::{Buffer, Frame, Gpu, Placement, Target};
use shaders::types::{PyramidLevel, REDUCED_LEVELS};
use shaders::{hzb, BufferRef, Stage};

/// Farthest depths by level, from level 1 (2x2 pixels a texel) to the one that has a single texel.
pub struct Pyramid {
    size: [u32; 2],
    standard_depth: bool,
    layout: Vec<PyramidLevel>,
    levels: Buffer<PyramidLevel>,
    texels: Buffer<f32>,
    coarsest: u32,
    finest: u32,
}

/// Where each level of a pyramid lies, by level (level 0, the depth buffer itself, is empty), and its coarsest level.
/// There are whole reductions of levels; those past the coarsest have one texel each.
pub fn layout(size: [u32; 2]) -> (Vec<PyramidLevel>, u32) {
    let coarsest = (1..32u32).find(|level| size.iter().all(|side| side.div_ceil(1 << level) == 1)).unwrap_or(31);
    let mut levels = vec![PyramidLevel { first: 0, width: 0, height: 0 }];
    let mut first = 0;
    for level in 1..=coarsest.next_multiple_of(REDUCED_LEVELS) {
        let [width, height] = size.map(|side| side.div_ceil(1 << level));
        levels.push(PyramidLevel { first, width, height });
        first += width * height;
    }
    (levels, coarsest)
}

impl Pyramid {
    /// A pyramid for pictures of `size` pixels.
    pub fn new(gpu: &Gpu, size: [u32; 2]) -> Result<Self> {
        let (layout, coarsest) = layout(size);
        let texels = layout.iter().map(|level| level.width * level.height).sum::<u32>();
        Ok(Pyramid {
            size,
            standard_depth: gpu.depth().is_standard(),
            levels: Buffer::with_data(gpu, "pyramid.levels", &layout, Placement::Storage)?,
            texels: Buffer::new(gpu, "pyramid.texels", texels as usize, Placement::Storage)?,
            layout,
            coarsest,
            finest: 1,
        })
    }

    /// The same without levels finer than `level`, 1 to 3: less to write, coarser tests.
    pub fn from_level(self, level: u32) -> Self {
        Pyramid { finest: level.clamp(1, REDUCED_LEVELS), ..self }
    }

    /// The same up to the first level that tests of footprints of so many texels a side need: it has no more in all.
    pub fn for_footprints(self, texels: u32) -> Self {
        let fits = |level: &u32| self.tiles_at(*level).iter().all(|side| *side <= texels);
        let coarsest = (self.finest..self.coarsest).find(fits).unwrap_or(self.coarsest);
        Pyramid { coarsest, ..self }
    }

    /// The finest level that is kept.
    pub fn finest_level(&self) -> u32 {
        self.finest
    }

    /// The pyramid in `slot` if it has the size asked for, otherwise a new one, kept from level `finest` on, for tests of footprints of
    /// `texels` a side.
    pub fn sized<'a>(
        slot: &'a mut Option<Pyramid>,
        gpu: &Gpu,
        size: [u32; 2],
        finest: u32,
        texels: u32,
    ) -> Result<&'a Pyramid> {
        let fitting = slot.take().filter(|pyramid| pyramid.size == size);
        Ok(slot.insert(match fitting {
            Some(pyramid) => pyramid,
            None => Pyramid::new(gpu, size)?.from_level(finest).for_footprints(texels),
        }))
    }

    /// Reduces the target's depth, three levels a dispatch.
    pub fn reduce(&self, f: &mut Frame, target: &Target) {
        let tiles = self.tiles_at(REDUCED_LEVELS);
        f.dispatch(self.first(target), tiles[0] * tiles[1]);
        for source_level in self.source_levels() {
            let tiles = self.tiles_at(source_level + REDUCED_LEVELS);
            f.dispatch(self.next(source_level), tiles[0] * tiles[1]);
        }
    }

    /// The same over grids on the GPU, three words a reduction: as [`Pyramid::grids`] has them, or without work groups.
    pub fn reduce_if(&self, f: &mut Frame, target: &Target, grids: BufferRef<u32>) {
        f.dispatch_indirect(self.first(target), grids);
        for (reduction, source_level) in self.source_levels().enumerate() {
            f.dispatch_indirect(self.next(source_level), grids.from(3 * (reduction + 1)));
        }
    }

    /// The grid of each reduction, three words each.
    pub fn grids(&self) -> Vec<u32> {
        let levels = [0].into_iter().chain(self.source_levels());
        let grid = |source_level: u32| {
            let [width, height] = self.tiles_at(source_level + REDUCED_LEVELS);
            let [x, y] = engine::folded((width * height).div_ceil(hzb::ReduceDepth::INFO.local_size[0]));
            [x, y, 1]
        };
        levels.flat_map(grid).collect()
    }

    /// From which levels coarser ones are made, after the depth buffer itself.
    fn source_levels(&self) -> impl Iterator<Item = u32> {
        (REDUCED_LEVELS..self.coarsest).step_by(REDUCED_LEVELS as usize)
    }

    fn tiles_at(&self, level: u32) -> [u32; 2] {
        let PyramidLevel { width, height, .. } = self.layout[level as usize];
        [width, height]
    }

    fn first(&self, target: &Target) -> hzb::ReduceDepth {
        hzb::ReduceDepth {
            depth: target.depth,
            levels: self.levels.all(),
            pyramid: self.texels.all(),
            size_px: self.size,
            tiles: self.tiles_at(REDUCED_LEVELS),
            constants: hzb::ReduceDepthConstants { standard_depth: self.standard_depth, finest_level: self.finest },
        }
    }

    fn next(&self, source_level: u32) -> hzb::ReduceLevels {
        let tiles = self.tiles_at(source_level + REDUCED_LEVELS);
        let constants = hzb::ReduceLevelsConstants { finest_level: self.finest };
        hzb::ReduceLevels { levels: self.levels.all(), pyramid: self.texels.all(), source_level, tiles, constants }
    }

    /// Notes that the pyramid is not needed.
    pub fn skip(f: &mut Frame, reason: &'static str) {
        f.skip(hzb::ReduceDepth::INFO.name, reason);
        f.skip(hzb::ReduceLevels::INFO.name, reason);
    }

    /// Where the levels lie.
    pub fn levels(&self) -> BufferRef<PyramidLevel> {
        self.levels.all()
    }

    /// All texels.
    pub fn texels(&self) -> BufferRef<f32> {
        self.texels.all()
    }

    /// The last level that is made: one texel, or as many as a footprint may touch.
    pub fn coarsest_level(&self) -> u32 {
        self.coarsest
    }

    /// All texels, read back; for tests.
    pub fn read(&self) -> Result<Vec<f32>> {
        Ok(self.texels.read()?)
    }
}
