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
    Ok(fitted(&Medians {
        idle: bench.median(Kind::Nothing)?,
        small: bench.median(Kind::Queries(SMALL))?,
        large: bench.median(Kind::Queries(LARGE))?,
        split: bench.median(Kind::Commands)?,
        together: bench.median(Kind::Instances)?,
    }))
}

/// Median times of the measurement's frames, in milliseconds.
struct Medians {
    /// Of a frame that only clears.
    idle: f64,
    /// Of queries of the small box, and of the large one.
    small: f64,
    large: f64,
    /// Of small boxes with a command each, and of as many by one command.
    split: f64,
    together: f64,
}

fn fitted(medians: &Medians) -> Costs {
    let each = |ms: f64| (ms - medians.idle).max(0.0) / f64::from(REPEATS);
    let [small, large] = [each(medians.small), each(medians.large)];
    let [split, together] = [each(medians.split), each(medians.together)];
    let pixel = ((large - small) / (pixels(LARGE) - pixels(SMALL))).max(0.0);
    Costs {
        query: (small - pixel * pixels(SMALL)).max(0.0),
        pixel,
        command: (split - together).max(0.0),
        triangle: together / BOX_TRIANGLES,
    }
}

/// The boxes of the measurement, by number, and what part of the picture's side they take.
const SMALL: u32 = 0;
const LARGE: u32 = 1;
const SIDES: [f64; 2] = [1.0 / 64.0, 0.75];

/// Pixels that a box of the measurement covers.
fn pixels(size: u32) -> f64 {
    (SIDES[size as usize] * f64::from(SIDE_PX)).powi(2)
}

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

#[cfg(test)]
mod tests {
    use super::*;

    /// Medians of 256 repeats on a device of these costs. The small box covers 4 x 4 pixels, the large one 192 x 192.
    fn medians(costs: Costs) -> Medians {
        let idle = 0.5;
        let repeated = |ms: f64| idle + 256.0 * ms;
        let Costs { query, pixel, command, triangle } = costs;
        Medians {
            idle,
            small: repeated(query + 16.0 * pixel),
            large: repeated(query + 36_864.0 * pixel),
            split: repeated(command + 6.0 * triangle),
            together: repeated(6.0 * triangle),
        }
    }

    /// Sums and quotients of numbers below 1,000 are rounded by less than 1e-13 each; the fit makes fewer than ten of them.
    fn assert_near(one: Costs, other: Costs) {
        let all = |costs: Costs| [costs.query, costs.pixel, costs.command, costs.triangle];
        let far = all(one).iter().zip(all(other)).any(|(one, other)| (one - other).abs() > 1e-12);
        assert!(!far, "{one:?} is not {other:?}");
    }

    #[test]
    fn a_fit_of_given_medians_gives_the_costs_that_they_were_made_of() {
        let costs = Costs { query: 0.003, pixel: 2e-6, command: 0.001, triangle: 0.000_5 };
        assert_near(fitted(&medians(costs)), costs);
        let costs = Costs { query: 0.000_2, pixel: 7e-6, command: 0.03, triangle: 0.02 };
        assert_near(fitted(&medians(costs)), costs);
    }

    #[test]
    fn a_fit_of_noise_has_no_cost_below_zero() {
        let costs = Costs { query: 0.003, pixel: 2e-6, command: 0.001, triangle: 0.000_5 };
        let faster_than_idle = Medians { small: 0.1, large: 0.2, split: 0.3, together: 0.4, ..medians(costs) };
        let nothing = Costs { query: 0.0, pixel: 0.0, command: 0.0, triangle: 0.0 };
        assert_near(fitted(&faster_than_idle), nothing);
        let Medians { small, large, split, together, .. } = medians(costs);
        let turned = Medians { small: large, large: small, split: together, together: split, idle: 0.5 };
        let all_in_the_query = Costs { query: 0.003 + 36_864.0 * 2e-6, pixel: 0.0, command: 0.0, ..costs };
        assert_near(fitted(&turned), Costs { triangle: 0.000_5 + 0.001 / 6.0, ..all_in_the_query });
    }

    #[test]
    fn costs_add_up() {
        let costs = Costs { query: 2.0, pixel: 3.0, command: 5.0, triangle: 7.0 };
        assert_eq!(costs.query_ms(11.0), 35.0);
        assert_eq!(costs.draw_ms(11.0, 13.0), 146.0);
    }

    #[test]
    fn costs_are_printed_in_microseconds_and_pixels_in_nanoseconds() {
        let costs = Costs { query: 0.001_5, pixel: 2e-6, command: 0.000_25, triangle: 0.000_125 };
        let printed = "a query 1.50 us and 2.000 ns a pixel, a draw command 0.25 us and 0.125 us a triangle";
        assert_eq!(costs.to_string(), printed);
    }
}
