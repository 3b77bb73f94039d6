//! Farthest-depth maps and the image-space occlusion test of warping-based culling (Kim 2015, III.2; Lee et al. 2018, 5.2).
//! Where the depth comes from is not their business: [`hom`] takes this frame's own.

pub mod hom;
pub mod twin;

use crate::{Result, View, World};
use engine::{Buffer, Frame, Gpu, Placement, Target};
use shaders::types::{FarthestShape, PyramidLevel, FARTHEST_LOOKUPS, FARTHEST_STRIP, REDUCED_LEVELS};
use shaders::{farthest, hzb, BufferRef, Stage};

/// How farthest depths of large regions are kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Structure {
    /// All levels at the base's resolution: the exact farthest depth of every region (Decoret 2005).
    NBuffer,
    /// So many mip levels after the base, then an N-buffer of the last (Schwarz & Stamminger 2008).
    YMap(u32),
    /// A pyramid down to a single texel.
    Mip,
}

/// What a farthest-depth map is made of: how its levels are kept, and how much smaller its base is than the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MapKind {
    /// How farthest depths of large regions are kept.
    pub structure: Structure,
    /// The base has a texel for 2^this x 2^this pixels: 0, 1 or 2 for the papers' sizes 1, 1/2 and 1/4.
    pub reduction: u32,
}

/// A farthest-depth map on the GPU. Something fills the base; then the map is built, and tested against.
pub struct FarthestMap {
    size_px: [u32; 2],
    standard_depth: bool,
    kind: MapKind,
    shape: FarthestShape,
    layout: Vec<PyramidLevel>,
    levels: Buffer<PyramidLevel>,
    texels: Buffer<f32>,
}

/// Where each level of a map lies: the base, mip levels, empty entries up to whole reductions, square levels; and its shape.
/// `size_px` is the picture's.
pub fn layout(size_px: [u32; 2], kind: MapKind) -> (Vec<PyramidLevel>, FarthestShape) {
    let halved = |size: [u32; 2], times: u32| size.map(|side| side.div_ceil(1 << times));
    let base = halved(size_px, kind.reduction);
    let coarsest = (0..31).find(|level| halved(base, *level) == [1, 1]).unwrap_or(31);
    let mip_levels = match kind.structure {
        Structure::NBuffer => 0,
        Structure::YMap(levels) => levels.min(coarsest),
        Structure::Mip => coarsest,
    };
    let squares_after = mip_levels.next_multiple_of(REDUCED_LEVELS);
    let mips = (0..=squares_after).map(|level| if level <= mip_levels { halved(base, level) } else { [0, 0] });
    let last_mip = halved(base, mip_levels);
    let covers = |n: u32| last_mip.iter().map(|side| side.div_ceil(1 << n)).product::<u32>() <= FARTHEST_LOOKUPS;
    let widest = last_mip[0].min(last_mip[1]).ilog2();
    let coarsest_square = (0..widest).find(|n| covers(*n)).unwrap_or(widest);
    let squares = (1..=coarsest_square).map(|n| last_mip.map(|side| side + 1 - (1 << n)));
    let mut first = 0;
    let place = |[width, height]: [u32; 2]| {
        let level = PyramidLevel { first, width, height };
        first += width * height;
        level
    };
    let levels = mips.chain(squares).map(place).collect();
    (levels, FarthestShape { reduction: kind.reduction, mip_levels, squares_after, coarsest_square })
}

impl FarthestMap {
    /// A map for pictures of `size_px`.
    ///
    /// # Errors
    /// A device without room for it.
    pub fn new(gpu: &Gpu, size_px: [u32; 2], kind: MapKind) -> Result<Self> {
        let (layout, shape) = layout(size_px, kind);
        let texels = layout.iter().map(|level| level.width * level.height).sum::<u32>();
        Ok(FarthestMap {
            size_px,
            standard_depth: gpu.depth().is_standard(),
            kind,
            shape,
            levels: Buffer::with_data(gpu, "farthest.levels", &layout, Placement::Storage)?,
            texels: Buffer::new(gpu, "farthest.texels", texels as usize, Placement::Storage)?,
            layout,
        })
    }

    /// The map in `slot` if it is what is asked for, otherwise a new one.
    pub fn sized<'a>(slot: &'a mut Option<Self>, gpu: &Gpu, size_px: [u32; 2], kind: MapKind) -> Result<&'a Self> {
        let fitting = slot.take().filter(|map| map.size_px == size_px && map.kind == kind);
        Ok(slot.insert(match fitting {
            Some(map) => map,
            None => FarthestMap::new(gpu, size_px, kind)?,
        }))
    }

    /// The base, row by row, for stages that fill it themselves: each texel must hold the farthest depth of its pixels, or
    /// less.
    pub fn base(&self) -> BufferRef<f32> {
        self.texels.all()
    }

    /// Width and height of the base in texels.
    pub fn base_size(&self) -> [u32; 2] {
        [self.layout[0].width, self.layout[0].height]
    }

    /// Fills the base from the target's depth.
    pub fn fill_from_depth(&self, f: &mut Frame, target: &Target) {
        let [width, height] = self.base_size();
        let stage = farthest::FillFromDepth {
            depth: target.depth,
            base: self.base(),
            size_px: self.size_px,
            base_size: [width, height],
            constants: farthest::FillFromDepthConstants {
                reduction: self.shape.reduction,
                standard_depth: self.standard_depth,
            },
        };
        f.dispatch(stage, width.div_ceil(FARTHEST_STRIP) * height);
    }

    /// Makes all other levels from the base.
    pub fn build(&self, f: &mut Frame) {
        let texels = self.texels.all();
        for source_level in (0..self.shape.mip_levels).step_by(REDUCED_LEVELS as usize) {
            let last_level = source_level + REDUCED_LEVELS;
            let tiles = self.base_size().map(|side| side.div_ceil(1 << last_level));
            let reduce = hzb::ReduceLevels {
                levels: self.levels.all(),
                pyramid: texels,
                source_level,
                tiles,
                constants: Default::default(),
            };
            f.dispatch(reduce, tiles[0] * tiles[1]);
        }
        let mut source = self.layout[self.shape.mip_levels as usize];
        for (n, doubled) in self.layout[self.shape.squares_after as usize + 1..].iter().enumerate() {
            let double = farthest::DoubleSquares { texels, source, doubled: *doubled, side: 1 << n };
            f.dispatch(double, doubled.width.div_ceil(FARTHEST_STRIP) * doubled.height);
            source = *doubled;
        }
    }

    /// Flags the objects whose `kept` is not 0 and which the map does not hide, of the `blocks` in view. `view` is that of the
    /// picture, whatever the size of the base.
    pub fn test(
        &self,
        f: &mut Frame,
        world: &World,
        view: &View,
        (kept, blocks): (BufferRef<u32>, BufferRef<u32>),
        visible: BufferRef<u32>,
    ) {
        f.fill("farthest/clear_visible", visible, 0);
        let test = farthest::TestBounds {
            bounds: world.bounds(),
            kept,
            levels: self.levels.all(),
            texels: self.texels.all(),
            blocks,
            visible,
            view: view.cull(),
            shape: self.shape,
            object_count: world.len() as u32,
        };
        f.dispatch_indirect(test, blocks);
    }

    /// Notes that building and testing are not needed.
    pub fn skip(f: &mut Frame, kind: MapKind, reason: &'static str) {
        let mips = !matches!(kind.structure, Structure::NBuffer | Structure::YMap(0));
        let squares = kind.structure != Structure::Mip;
        let used = [(mips, hzb::ReduceLevels::INFO), (squares, farthest::DoubleSquares::INFO)];
        used.iter().filter(|(used, _)| *used).for_each(|(_, stage)| f.skip(stage.name, reason));
        f.skip(farthest::TestBounds::INFO.name, reason);
    }

    /// All texels, read back; for tests.
    pub fn read(&self) -> Result<Vec<f32>> {
        Ok(self.texels.read()?)
    }
}
