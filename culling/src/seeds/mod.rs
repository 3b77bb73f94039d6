//! What stands in front, roughly, where no last frame tells: a ray through each tile of the picture, down a hierarchy of boxes to the cells
//! of meshes that hold triangles. What is met first is drawn first, and all else is tested against it, as the EOVC thesis finds by rays
//! what may show (III.4). Nothing depends on a ray but what is drawn early: who is met in vain is drawn in vain, who is missed is tested.
//!
//! A tile is quartered if what its ray meets had not been met by a larger one and, or a usual object so far away, is smaller than the tile:
//! rays are dense where many objects are seen, far down the street. Without both conditions there were three times as many rays, which met
//! little more.

mod device;
mod host;
pub mod shape;
pub mod twin;

use crate::world::{split, View, World};
use crate::{Error, OptionInfo, Options, Result};
use device::DeviceRays;
use engine::{DeviceKind, Frame, Gpu};
use glam::DVec3;
use host::HostRays;
use scenes::bvh::{BadBounds, Bvh, BvhOptions, Split, REBUILD_FACTOR};
use shaders::types::{SeedNode, SeedView};
use shaders::{seeds, BufferRef, Stage};
use shape::Shapes;

/// Who casts rays.
pub const RAYS_OPTION: OptionInfo = OptionInfo {
    name: "rays",
    default: "auto",
    values: "auto|host|device|off",
    help: "who looks for what stands in front when the last frame does not tell: the device if it is a GPU, else the host, which casts \
           more of them in the same time",
};

/// Tiles of the first level, pixels a side.
const COARSEST_PX: u32 = 32;
/// Tiles of the last.
const FINEST_PX: u32 = 4;
/// Levels of tiles.
const LEVELS: u32 = (COARSEST_PX / FINEST_PX).ilog2() + 1;

/// Rays over a world's objects.
pub struct Seeds {
    bvh: Bvh,
    /// What positions in the hierarchy's nodes are relative to.
    origin: DVec3,
    usual_size: f32,
    /// Bounds it was begun from, and those it was fitted to last.
    begun_at: u64,
    revision: u64,
    /// No ray was cast yet, or the past is forgotten: nothing may tell of where objects were before.
    is_new: bool,
    refitted: u64,
    rays: Rays,
}

enum Rays {
    Host(Box<HostRays>),
    Device(Box<DeviceRays>),
}

impl Seeds {
    /// A hierarchy over the objects as they are now, and the shapes of their meshes; none if rays are off or there is nothing to meet.
    ///
    /// # Errors
    /// A device without room for it.
    pub fn new(gpu: &Gpu, world: &World, options: &Options) -> Result<Option<Self>> {
        let on_host = match options.text(RAYS_OPTION.name) {
            "off" => return Ok(None),
            "host" => true,
            "device" => false,
            _ => gpu.info().is_none_or(|info| info.kind == DeviceKind::Cpu),
        };
        let bvh = build(world)?;
        let Some(origin) = origin_of(&bvh) else { return Ok(None) };
        let nodes = flatten(&bvh, origin);
        let (meshes, indices, vertices) = world.read_meshes()?;
        let shapes = Shapes::of(meshes, &vertices, indices);
        let rays = match on_host {
            true => Rays::Host(Box::new(HostRays::new(gpu, world, nodes, shapes)?)),
            false => Rays::Device(Box::new(DeviceRays::new(gpu, &nodes, &shapes, world.followed_placement())?)),
        };
        let (usual_size, revision) = (usual_size(world), world.bounds_revision());
        Ok(Some(Seeds { bvh, origin, usual_size, begun_at: revision, revision, is_new: true, refitted: 0, rays }))
    }

    /// Marks in `seen`, by object, what rays meet first.
    pub fn cast(&mut self, f: &mut Frame, world: &World, view: &View, seen: BufferRef<u32>) -> Result<()> {
        let revision = world.bounds_revision();
        self.refitted = 0;
        if self.is_new && self.begun_at != revision {
            self.begin(world)?;
        } else if self.revision != revision {
            self.follow(world)?;
        }
        (self.is_new, self.revision) = (false, revision);
        let view = view_of(view, self.origin, self.usual_size);
        match &mut self.rays {
            Rays::Host(rays) => rays.cast(f, world, &view, seen),
            Rays::Device(rays) => rays.cast(f, world, &view, seen),
        }
    }

    /// Nodes that were fitted to bounds that had changed, in the last frame.
    pub fn refitted(&self) -> u64 {
        self.refitted
    }

    /// Notes that rays need not be cast.
    pub fn skip(&mut self, f: &mut Frame, reason: &'static str) {
        self.refitted = 0;
        let stage = match self.rays {
            Rays::Host(_) => seeds::MarkMet::INFO,
            Rays::Device(_) => seeds::CastRays::INFO,
        };
        f.skip(stage.name, reason);
    }

    /// Nothing of frames before tells on those that come.
    pub fn forget(&mut self) {
        self.is_new = true;
    }

    /// Objects have moved since the hierarchy was made, and no ray was cast: as if it were made now.
    fn begin(&mut self, world: &World) -> Result<()> {
        self.build_anew(world)?;
        self.origin = origin_of(&self.bvh).unwrap_or(self.origin);
        self.usual_size = usual_size(world);
        self.begun_at = world.bounds_revision();
        self.hand_over()
    }

    /// Objects have moved: boxes follow, and the hierarchy is built anew once it has become too costly to go down.
    fn follow(&mut self, world: &World) -> Result<()> {
        if self.bvh.refit(world.host_bounds()).is_err() || self.bvh.needs_rebuild(REBUILD_FACTOR) {
            self.build_anew(world)?;
        }
        self.hand_over()
    }

    /// The same objects have bounds as before, or the tree would not fit its buffers and stays.
    fn build_anew(&mut self, world: &World) -> Result<()> {
        let bvh = build(world)?;
        if bvh.nodes().len() == self.bvh.nodes().len() {
            self.bvh = bvh;
        }
        Ok(())
    }

    fn hand_over(&mut self) -> Result<()> {
        self.refitted = self.bvh.nodes().len() as u64;
        let nodes = flatten(&self.bvh, self.origin);
        match &mut self.rays {
            Rays::Host(rays) => rays.follow(nodes),
            Rays::Device(rays) => rays.follow(&nodes)?,
        }
        Ok(())
    }
}

fn origin_of(bvh: &Bvh) -> Option<DVec3> {
    Some(bvh.nodes().first()?.bounds.centre())
}

/// A frame's view as rays take it; `origin`: what positions in the tree are relative to.
fn view_of(view: &View, origin: DVec3, usual_size: f32) -> SeedView {
    let rays = crate::boxes::box_view(view);
    let (camera_high, camera_low) = split(view.pose.position);
    let [width_px, height_px] = view.size;
    // From one edge of the picture to the other a ray's point at 1 goes along this twice.
    let across = |vectors: [[f32; 3]; 3]| glam::Vec3::from(vectors[1]).length();
    let half_width = across(rays.direction).max(across(rays.origin));
    SeedView {
        camera_high,
        camera_low,
        tree_from_camera: (view.pose.position - origin).as_vec3().to_array(),
        origin: rays.origin,
        direction: rays.direction,
        width_px,
        height_px,
        finest_px: FINEST_PX,
        usual_size,
        px_per_unit: 0.5 * width_px as f32 / half_width,
    }
}

fn build(world: &World) -> Result<Bvh> {
    let options = BvhOptions { split: Split::Sah, bad_bounds: BadBounds::SetAside };
    Bvh::build_with(world.host_bounds(), options).map_err(|error| Error::Missing {
        method: "hzb-iterative",
        needs: format!("bounds it can build a hierarchy over: {error}"),
    })
}

fn flatten(bvh: &Bvh, origin: DVec3) -> Vec<SeedNode> {
    let node = |node: &scenes::bvh::Node| SeedNode {
        low: (node.bounds.min - origin).as_vec3().to_array(),
        high: (node.bounds.max - origin).as_vec3().to_array(),
        first: node.first_child_or_object,
        is_leaf: u32::from(node.is_leaf()),
    };
    bvh.nodes().iter().map(node).collect()
}

/// How large objects are, metres: the median of the middle side of their boxes.
fn usual_size(world: &World) -> f32 {
    let middle_side = |bounds: &scenes::Aabb| {
        let mut sides = (bounds.max - bounds.min).to_array();
        sides.sort_by(f64::total_cmp);
        sides[1]
    };
    let mut sizes: Vec<f64> = world.host_bounds().iter().map(middle_side).filter(|size| size.is_finite()).collect();
    let middle = sizes.len() / 2;
    match sizes.is_empty() {
        true => 0.0,
        false => *sizes.select_nth_unstable_by(middle, f64::total_cmp).1 as f32,
    }
}
