//! Boxes as one instanced draw: what raster occlusion culling tests instead of objects.
//!
//! Only the three faces that can face the eye are drawn, from eight corners made in the vertex shader
//! (`include/box.glsl`). Boxes are grown there so that they cover all that their contents can.

pub mod twin;

use crate::world::{View, World};
use crate::Result;
use engine::{Buffer, Extra, Faces, Frame, Gpu, IndexedIndirect, Placement, Primitives, Surface};
use glam::{DMat4, DVec3};
use shaders::types::{BoxView, DrawCommand, PACK_CHUNK};
use shaders::{pack, BufferRef, Stage};

/// Corners of the three near faces, as triangles.
const NEAR_FACES: [u32; 18] = [0, 2, 6, 0, 6, 4, 0, 1, 5, 0, 5, 4, 0, 1, 3, 0, 3, 2];

/// What boxes are drawn with: the corners of one box, and the frame's view.
pub struct BoxShape {
    corners: Buffer<u32>,
    view: Buffer<BoxView>,
    /// A count that never changes, because draws with and without one must not be mixed (see [`IndexedIndirect`]); none where no draw
    /// has one.
    draws: Option<Buffer<u32>>,
}

impl BoxShape {
    /// For multi-draws of `draws` commands, each of instances of one box.
    pub fn new(gpu: &Gpu, name: &str, draws: u32) -> Result<Self> {
        Ok(BoxShape {
            corners: Buffer::with_data(gpu, "boxes.corners", &NEAR_FACES, Placement::Geometry)?,
            view: Buffer::new(gpu, &format!("{name}.view"), 1, Placement::Upload)?,
            draws: gpu
                .has(Extra::DrawIndirectCount)
                .then(|| Buffer::with_data(gpu, "boxes.draws", &[draws], Placement::Storage))
                .transpose()?,
        })
    }

    /// The command of a draw without boxes, the first of which is instance `first_instance`.
    pub fn no_boxes(first_instance: u32) -> DrawCommand {
        DrawCommand { index_count: NEAR_FACES.len() as u32, first_instance, ..DrawCommand::default() }
    }

    /// Gives the boxes' shaders the frame's view.
    pub fn look(&mut self, view: &View) -> Result<()> {
        Ok(self.view.write(&[box_view(view)])?)
    }

    /// The frame's view.
    pub fn view(&self) -> BufferRef<BoxView> {
        self.view.all()
    }

    /// The multi-draw of the first commands of a range.
    pub fn draw(&self, commands: BufferRef<DrawCommand>, draws: u32) -> IndexedIndirect {
        IndexedIndirect {
            vertices: self.corners.all().into(),
            instances: self.corners.all().into(),
            indices: self.corners.all().into(),
            commands: commands.into(),
            count: self.draws.as_ref().map(Buffer::all),
            max_draws: draws,
            primitives: Primitives::Triangles,
            faces: Faces::Both,
            surface: Surface::Opaque,
        }
    }
}

/// A list of things with boxes, drawn as instances of one box.
pub struct BoxList {
    listed: Buffer<u32>,
    command: Buffer<DrawCommand>,
    shape: BoxShape,
    counts: Buffer<u32>,
    starts: Buffer<u32>,
    total: Buffer<u32>,
    /// Drawn by an exact command, without a count on the GPU.
    without_count: bool,
    subgroup_size: u32,
}

impl BoxList {
    /// A list with room for `len` boxes.
    pub fn new(gpu: &Gpu, name: &str, len: usize) -> Result<Self> {
        let chunks = len.div_ceil(PACK_CHUNK as usize);
        let storage = Placement::Storage;
        Ok(BoxList {
            listed: Buffer::new(gpu, &format!("{name}.listed"), len, storage)?,
            command: Buffer::with_data(gpu, &format!("{name}.command"), &[BoxShape::no_boxes(0)], storage)?,
            shape: BoxShape::new(gpu, name, 1)?,
            counts: Buffer::new(gpu, &format!("{name}.counts"), chunks, storage)?,
            starts: Buffer::new(gpu, &format!("{name}.starts"), chunks, storage)?,
            total: Buffer::new(gpu, &format!("{name}.total"), 1, storage)?,
            without_count: false,
            subgroup_size: gpu.subgroup_size(),
        })
    }

    /// Gives the boxes' shaders the frame's view.
    pub fn look(&mut self, view: &View) -> Result<()> {
        self.shape.look(view)
    }

    /// Lists every object whose flag is not 0, in order.
    pub fn pack(&self, f: &mut Frame, world: &World, flags: BufferRef<u32>) {
        let object_count = world.len() as u32;
        let chunks = object_count.div_ceil(PACK_CHUNK);
        let (counts, starts, total) = (self.counts.all(), self.starts.all(), self.total.all());
        f.dispatch(pack::CountFlags { flags, counts, first_object: 0, object_count }, chunks);
        let constants = pack::ScanCountsConstants { subgroup_size: self.subgroup_size };
        f.dispatch_groups(pack::ScanCounts { counts, starts, total, chunk_count: chunks, constants }, 1);
        let (listed, command) = (self.listed.all(), self.command.all());
        f.dispatch(pack::WriteIndices { flags, starts, total, listed, command, object_count }, chunks);
    }

    /// Notes that packing is not needed.
    pub fn skip_packing(f: &mut Frame, reason: &'static str) {
        for stage in [pack::CountFlags::INFO, pack::ScanCounts::INFO, pack::WriteIndices::INFO] {
            f.skip(stage.name, reason);
        }
    }

    /// Empties the list before stages append to it.
    pub fn clear(&self, f: &mut Frame, label: &str, empty: &Buffer<DrawCommand>) {
        f.copy(label, empty.all(), self.command.all());
    }

    /// What [`BoxList::clear`] copies from.
    pub fn empty_command(gpu: &Gpu) -> Result<Buffer<DrawCommand>> {
        Ok(Buffer::with_data(gpu, "boxes.empty", &[BoxShape::no_boxes(0)], Placement::Storage)?)
    }

    /// What is listed.
    pub fn listed(&self) -> BufferRef<u32> {
        self.listed.all()
    }

    /// The draw, whose instances are the list's length.
    pub fn command(&self) -> BufferRef<DrawCommand> {
        self.command.all()
    }

    /// The frame's view.
    pub fn view(&self) -> BufferRef<BoxView> {
        self.shape.view()
    }

    /// A list for frames that read counters back: its draw has no count on the GPU, as draws with and without one must not be
    /// mixed (see [`IndexedIndirect`]).
    pub fn without_count(self) -> Self {
        BoxList { without_count: true, ..self }
    }

    /// Waits for the frame so far and reads how many boxes there are: counter read-back (EOVC thesis III.6.1).
    pub fn read_back(&self, f: &mut Frame) -> Result<u32> {
        Ok(f.read(&self.command)?.first().map_or(0, |command| command.instance_count))
    }

    /// The instanced draw of all boxes.
    pub fn draw(&self) -> IndexedIndirect {
        let draw = self.shape.draw(self.command.all(), 1);
        IndexedIndirect { count: draw.count.filter(|_| !self.without_count), ..draw }
    }

    /// How many boxes the last frame listed.
    pub fn read_len(&self) -> Result<u32> {
        Ok(self.command.read()?.first().map_or(0, |command| command.instance_count))
    }

    /// What the last frame listed, in the order of the list.
    pub fn read_listed(&self) -> Result<Vec<u32>> {
        let mut listed = self.listed.read()?;
        listed.truncate(self.read_len()? as usize);
        Ok(listed)
    }
}

/// The frame's view with its eye and its rays, in f64 from the matrix alone, so that any projection will do.
///
/// The eye is where x, y and w of the clip position vanish: the point that all pixels' rays share, at infinity for a
/// parallel projection. A ray's points are those whose x/w and y/w are the pixel's.
pub fn box_view(view: &View) -> BoxView {
    let matrix = view.clip_from_relative();
    let eye = eye_of(&matrix);
    let (origin, direction) = if eye.w != 0.0 { pinhole_rays(&matrix, eye) } else { parallel_rays(&matrix, eye) };
    let floats = |vectors: [DVec3; 3]| vectors.map(|vector| vector.as_vec3().to_array());
    BoxView { view: view.cull(), eye: eye.as_vec4().to_array(), origin: floats(origin), direction: floats(direction) }
}

/// Where all rays start: a point (w is 1), or, for parallel projections, the direction that they come from (w is 0).
pub(crate) fn eye_of(matrix: &DMat4) -> glam::DVec4 {
    let [x, y, w] = [matrix.row(0), matrix.row(1), matrix.row(3)];
    let minor = |skip: usize| {
        let part = |row: glam::DVec4| {
            let mut kept = (0..4).filter(|column| *column != skip).map(|column| row[column]);
            DVec3::new(kept.next().unwrap_or(0.0), kept.next().unwrap_or(0.0), kept.next().unwrap_or(0.0))
        };
        part(x).dot(part(y).cross(part(w))) * if skip.is_multiple_of(2) { 1.0 } else { -1.0 }
    };
    let eye = glam::DVec4::new(minor(0), minor(1), minor(2), minor(3));
    // A parallel projection's fourth minor is 0 but for rounding.
    let size = eye.truncate().length();
    if eye.w.abs() > size * 1e-12 && eye.w != 0.0 {
        return (eye.truncate() / eye.w).extend(1.0);
    }
    // Its direction points to where depth grows: towards the near plane, which is where the eye would be.
    let direction = eye.truncate() / size;
    let nearer = matrix.row(2).truncate().dot(direction);
    (direction * nearer.signum()).extend(0.0)
}

/// All rays start at the eye; a distance of 1 is where w is 1 more than at the eye.
fn pinhole_rays(matrix: &DMat4, eye: glam::DVec4) -> ([DVec3; 3], [DVec3; 3]) {
    let rows = [matrix.row(0), matrix.row(1), matrix.row(3)].map(|row| row.truncate());
    let inverse = glam::DMat3::from_cols(rows[0], rows[1], rows[2]).transpose().inverse();
    ([eye.truncate(), DVec3::ZERO, DVec3::ZERO], [inverse.z_axis, inverse.x_axis, inverse.y_axis])
}

/// All rays go away from the eye; each starts where its depth is nearest.
fn parallel_rays(matrix: &DMat4, eye: glam::DVec4) -> ([DVec3; 3], [DVec3; 3]) {
    let inverse = matrix.inverse();
    let near = |x: f64, y: f64| inverse.project_point3(DVec3::new(x, y, 1.0));
    let middle = near(0.0, 0.0);
    ([middle, near(1.0, 0.0) - middle, near(0.0, 1.0) - middle], [-eye.truncate(), DVec3::ZERO, DVec3::ZERO])
}
