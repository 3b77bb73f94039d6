//! What queries and drawings take on a device: the cost model of `nohc`, fitted to measured times.

use crate::boxes::BoxShape;
use crate::{Result, View};
use engine::{Buffer, Format, Gpu, Image, IndexedIndirect, OcclusionQueries, Placement, Queried, Target};
use glam::{DQuat, DVec3};
use scenes::{Pose, Projection, Shot};
use shaders::queries;
use shaders::types::{Bounds, DrawCommand};
use std::collections::BTreeMap;
use std::fmt;
use std::sync::{Mutex, PoisonError};

/// Milliseconds, by what there is of each.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Costs {
    /// Of a query.
    pub query: f64,
    /// Of a pixel that its boxes cover.
    pub pixel: f64,
    /// Of a draw command.
    pub command: f64,
    /// Of a triangle.
    pub triangle: f64,
}

impl fmt::Display for Costs {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Costs { query, pixel, command, triangle } = self;
        let [query, command, triangle] = [query, command, triangle].map(|ms| 1e3 * ms);
        write!(
            out,
            "a query {query:.2} us and {:.3} ns a pixel, a draw command {command:.2} us and {triangle:.3} us a triangle",
            1e6 * pixel
        )
    }
}

/// Fitted once a device in a program's run, so that all methods of a run decide alike.
static FITTED: Mutex<BTreeMap<String, Costs>> = Mutex::new(BTreeMap::new());

/// Queries, or draws, of a measurement.
const REPEATS: u32 = 256;

/// Side of the picture that is measured in.
const SIDE_PX: u32 = 256;

/// Times that each measurement is taken; the median counts.
const TAKES: usize = 5;

/// Triangles of a box: three faces.
const BOX_TRIANGLES: f64 = 6.0;

impl Costs {
    /// Of a device; measured when first asked for.
    pub fn of(gpu: &Gpu) -> Result<Costs> {
        let device = name_of(gpu);
        let mut fitted = FITTED.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(costs) = fitted.get(&device) {
            return Ok(*costs);
        }
        let costs = fit(gpu)?;
        fitted.insert(device, costs);
        Ok(costs)
    }

    /// Takes these for the device's from now on, instead of measuring: what decides by them is then the same however busy the machine is.
    pub fn assume(self, gpu: &Gpu) {
        FITTED.lock().unwrap_or_else(PoisonError::into_inner).insert(name_of(gpu), self);
    }

    /// A query whose boxes cover so many pixels.
    pub fn query_ms(&self, pixels: f64) -> f64 {
        self.query + self.pixel * pixels
    }

    /// Drawing so many objects with so many triangles. Their pixels are left out: they are the same, queried or not.
    pub fn draw_ms(&self, objects: f64, triangles: f64) -> f64 {
        self.command * objects + self.triangle * triangles
    }
}

fn name_of(gpu: &Gpu) -> String {
    gpu.info().map(|info| info.name.clone()).unwrap_or_default()
}

/// Two sizes of box give the cost of a query and of a pixel; one command of many boxes and many of one box, that of a command
/// and of a triangle.
fn fit(gpu: &Gpu) -> Result<Costs> {
    let mut bench = Bench::new(gpu)?;
    let idle = bench.median(Kind::Nothing)?;
    let each = |ms: f64| (ms - idle).max(0.0) / f64::from(REPEATS);
    let [small, large] = [each(bench.median(Kind::Queries(SMALL))?), each(bench.median(Kind::Queries(LARGE))?)];
    let [split, together] = [each(bench.median(Kind::Commands)?), each(bench.median(Kind::Instances)?)];
    let pixel = ((large - small) / (bench.pixels(LARGE) - bench.pixels(SMALL))).max(0.0);
    Ok(Costs {
        query: (small - pixel * bench.pixels(SMALL)).max(0.0),
        pixel,
        command: (split - together).max(0.0),
        triangle: together / BOX_TRIANGLES,
    })
}

/// The boxes of the measurement, by number, and what part of the picture's side they take.
const SMALL: u32 = 0;
const LARGE: u32 = 1;
const SIDES: [f64; 2] = [1.0 / 64.0, 0.75];

#[derive(Clone, Copy)]
enum Kind {
    Nothing,
    Queries(u32),
    Commands,
    Instances,
}

struct Bench {
    gpu: Gpu,
    _depth: Image,
    target: Target,
    shape: BoxShape,
    bounds: Buffer<Bounds>,
    listed: Buffer<u32>,
    commands: Buffer<DrawCommand>,
    queries: OcclusionQueries,
}

impl Bench {
    fn new(gpu: &Gpu) -> Result<Self> {
        let depth = Image::new(gpu, "nohc.depth", Format::Depth, [SIDE_PX; 2])?;
        let mut shape = BoxShape::new(gpu, "nohc", 1)?;
        let projection = Projection::Perspective { fov_y: std::f64::consts::FRAC_PI_2, near: 0.5, far: Some(100.0) };
        let pose = Pose { position: DVec3::ZERO, rotation: DQuat::IDENTITY };
        shape.look(&View::new(&Shot { pose, projection, seconds: 0.0 }, [SIDE_PX; 2], 0, gpu.snap_px()))?;
        // At a distance of 10 a view of 90 degrees is 20 wide.
        let cube = |side: f64| Bounds {
            centre_high: [0.0, 0.0, -10.0 - 10.0 * side as f32],
            half_extent: [10.0 * side as f32; 3],
            ..Bounds::default()
        };
        Ok(Bench {
            gpu: gpu.clone(),
            target: Target {
                size: [SIDE_PX; 2],
                colour: None,
                item: None,
                depth: depth.view(),
                depth_read_only: false,
                strictly_nearer: false,
                samples: None,
            },
            _depth: depth,
            shape,
            bounds: Buffer::with_data(gpu, "nohc.bounds", &SIDES.map(cube), Placement::Storage)?,
            listed: Buffer::new(gpu, "nohc.listed", REPEATS as usize, Placement::Upload)?,
            commands: Buffer::new(gpu, "nohc.commands", REPEATS as usize, Placement::Upload)?,
            queries: OcclusionQueries::new(gpu, "nohc.queries", REPEATS)?,
        })
    }

    fn pixels(&self, size: u32) -> f64 {
        (SIDES[size as usize] * f64::from(SIDE_PX)).powi(2)
    }

    fn median(&mut self, kind: Kind) -> Result<f64> {
        let mut times = (0..=TAKES).map(|_| self.take(kind)).collect::<Result<Vec<f64>>>()?;
        // The first one may have had to make pipelines.
        times.remove(0);
        times.sort_by(f64::total_cmp);
        Ok(times[TAKES / 2])
    }

    fn take(&mut self, kind: Kind) -> Result<f64> {
        let size = if let Kind::Queries(size) = kind { size } else { SMALL };
        self.listed.write(&[size; REPEATS as usize])?;
        let command = |index| DrawCommand { instance_count: 1, ..BoxShape::no_boxes(index) };
        let mut commands: Vec<DrawCommand> = (0..REPEATS).map(command).collect();
        if let Kind::Instances = kind {
            commands.truncate(1);
            commands[0].instance_count = REPEATS;
        }
        self.commands.write(&commands)?;
        let draw = IndexedIndirect { count: None, ..self.shape.draw(self.commands.all(), commands.len() as u32) };
        let stage =
            queries::TestObjects { bounds: self.bounds.all(), listed: self.listed.all(), views: self.shape.view() };
        let mut f = self.gpu.frame();
        f.without_stage_times();
        f.clear(&self.target);
        match kind {
            Kind::Nothing => (),
            Kind::Queries(_) => {
                let queried = Queried { queries: &self.queries, first: 0 };
                f.query_boxes(stage, draw, queried, &self.target.test_only());
            }
            Kind::Commands | Kind::Instances => f.test_boxes(stage, draw, &self.target.test_only()),
        }
        Ok(f.finish()?.frame_ms)
    }
}
