//! Power plant (PP): a steel frame full of pipes, girders, gratings and vessels, after the scene `powerplants` in Kim 2015, V:
//! 8,868 objects of 153 million triangles, "high geometric complexity and irregularity" and "very thin geometries".
//!
//! Level of detail 4 has about the paper's triangles. Hardly anything here is a large occluder: one looks through gratings and
//! between pipes, so that the middle of the frame shows in crumbs through many layers.

mod meshes;

use super::detail::Detail;
use super::random::Random;
use super::{camera, count, posed, shade, sized, standing, turned, Assembly, SceneOptions};
use crate::model::{Scene, Walk};
use glam::DVec3;
use meshes::Meshes;
use std::f64::consts::{FRAC_PI_2, TAU};

/// Objects at scale 1.
const OBJECTS: usize = 8_868;
const LEAST_OBJECTS: usize = 150;
/// About how many objects a bay has.
const OBJECTS_A_BAY: f64 = 8.4;
/// A bay of the frame, in metres; the meshes are made for it.
pub(super) const BAY: DVec3 = DVec3::new(6.0, 5.0, 6.0);
const EYE: f64 = 1.7;
/// How far the walk goes at speed 1, in metres.
const WALK: f64 = 30.0;

const STEEL: [[f32; 3]; 3] = [[0.36, 0.38, 0.4], [0.42, 0.3, 0.22], [0.3, 0.36, 0.34]];
const PAINT: [[f32; 3]; 6] =
    [[0.7, 0.68, 0.62], [0.6, 0.2, 0.14], [0.2, 0.42, 0.3], [0.2, 0.34, 0.56], [0.72, 0.56, 0.14], [0.5, 0.5, 0.5]];

struct Builder {
    assembly: Assembly,
    meshes: Meshes,
    random: Random,
    /// Bays along x, y and z.
    bays: [usize; 3],
}

pub(super) fn make(options: &SceneOptions) -> Scene {
    let target = count(OBJECTS, options.scale, LEAST_OBJECTS);
    let bays = target as f64 / OBJECTS_A_BAY;
    // As broad as 12 by 8 by 10.
    let unit = (bays / 960.0).cbrt();
    let [x, y] = [12.0, 8.0].map(|standard: f64| ((standard * unit).round() as usize).max(2));
    // What is over fills the yard.
    let z = ((0.97 * bays / (x * y) as f64) as usize).max(1);
    let mut assembly = Assembly::new("powerplant");
    let meshes = Meshes::new(&mut assembly, Detail::new(options.detail));
    let random = Random::new(options.seed, 0);
    let mut builder = Builder { assembly, meshes, random, bays: [x, y, z] };
    builder.assembly.scene.objects.reserve(target + 64);
    builder.ground();
    builder.chimneys();
    for bay in 0..x * y * z {
        builder.random = Random::new(options.seed, 1 + bay as u64);
        builder.bay([bay % x, bay / (x * z), bay / x % z]);
    }
    builder.random = Random::new(options.seed, 0x7a9d);
    while builder.assembly.len() < target {
        builder.yard();
    }
    let walk = builder.walk();
    let mut scene = builder.assembly.scene;
    scene.objects.truncate(target);
    scene.cameras = vec![camera("gangway", &walk, 0.1, 1500.0)];
    scene.walk = Some(walk);
    scene
}

impl Builder {
    /// The lower corner of a bay.
    fn corner(&self, [x, y, z]: [usize; 3]) -> DVec3 {
        let half = DVec3::new(0.5 * self.bays[0] as f64, 0.0, 0.5 * self.bays[2] as f64);
        (DVec3::new(x as f64, y as f64, z as f64) - half) * BAY
    }

    fn size(&self) -> DVec3 {
        DVec3::new(self.bays[0] as f64, self.bays[1] as f64, self.bays[2] as f64) * BAY
    }

    /// The row of bays along z that the gangway leads through, and its floor.
    fn gangway(&self) -> [usize; 2] {
        [self.bays[1] / 2, self.bays[2] / 2]
    }

    fn steel(&mut self, mesh: u32, at: DVec3, turns: i32) {
        let colour = self.random.pick(&STEEL);
        let colour = shade(&mut self.random, colour, 0.2);
        self.assembly.place(mesh, colour, standing(at, turns));
    }

    fn painted(&mut self, mesh: u32, place: glam::DAffine3) {
        let colour = self.random.pick(&PAINT);
        let colour = shade(&mut self.random, colour, 0.25);
        self.assembly.place(mesh, colour, place);
    }

    fn ground(&mut self) {
        let size = self.size() + DVec3::new(150.0, 0.0, 130.0);
        let slab = DVec3::new(size.x, 0.6, size.z);
        self.assembly.place(self.meshes.slab, [0.34, 0.34, 0.32], sized(DVec3::new(0.0, -0.7, 0.0), slab));
    }

    /// Two chimneys and two cooling towers behind the frame.
    fn chimneys(&mut self) {
        let half = 0.5 * self.size();
        let tall = 2.2 * self.size().y + 20.0;
        for (index, x) in [-0.3, 0.3].into_iter().enumerate() {
            let at = DVec3::new(2.0 * x * half.x, -0.2, -half.z - 14.0);
            let size = DVec3::new(1.0, tall * (1.0 - 0.08 * index as f64), 1.0);
            self.assembly.place(self.meshes.chimney, [0.6, 0.56, 0.52], posed(at, 0.3, size));
            let tower = DVec3::new(x.signum() * (half.x + 30.0), -0.2, -half.z - 20.0 - 9.0 * index as f64);
            self.assembly.place(self.meshes.cooling_tower, [0.66, 0.65, 0.62], turned(tower, x));
        }
    }

    /// The frame of a bay, its floor and what it holds.
    fn bay(&mut self, bay: [usize; 3]) {
        let at = self.corner(bay);
        let [x, y, z] = bay;
        let on_gangway = z == self.bays[2] / 2;
        let is_shaft = x % 4 == 2 && z % 3 == 1 && !on_gangway;
        self.steel(self.meshes.column, at, 0);
        self.steel(self.meshes.girder, at + DVec3::new(0.0, BAY.y - 0.1, 0.0), 0);
        self.steel(self.meshes.girder, at + DVec3::new(0.0, BAY.y - 0.12, 0.0), -1);
        if self.random.chance(0.35) {
            let turns = -(self.random.below(2) as i32);
            self.steel(self.meshes.brace, at, turns);
        }
        if is_shaft {
            return self.vessel(at, y);
        }
        self.steel(self.meshes.grating, at, 0);
        if self.random.chance(0.8) {
            self.steel(self.meshes.railing, at + DVec3::new(0.0, 0.0, 0.35), 0);
        }
        self.overhead(at);
        if !on_gangway {
            self.machines(at);
        }
        // The ends of the gangway stay open.
        if z + 1 == self.bays[2] || (x == 0 && !on_gangway) {
            self.cladding(at, x == 0);
        }
    }

    /// A piece of a boiler as high as a floor, with pipes around it.
    fn vessel(&mut self, at: DVec3, floor: usize) {
        let middle = at + DVec3::new(0.5 * BAY.x, 0.0, 0.5 * BAY.z);
        let angle = self.random.range(0.0, TAU);
        let colour = shade(&mut self.random, [0.58, 0.56, 0.5], 0.2);
        self.assembly.place(self.meshes.vessel, colour, turned(middle, angle));
        for pipe in 0..3 {
            let mesh = self.random.pick(&self.meshes.risers);
            let angle = (pipe as f64 + 0.3 * self.random.unit()) * TAU / 3.0 + floor as f64;
            self.painted(mesh, turned(middle, angle));
        }
    }

    /// Pipes and trays under the next floor, above the head.
    fn overhead(&mut self, at: DVec3) {
        for lane in 0..1 + self.random.below(2) {
            let mesh = self.random.pick(&self.meshes.runs);
            let along_x = self.random.chance(0.5);
            let height = BAY.y - 0.75 - 0.45 * lane as f64 - 0.2 * self.random.unit();
            let place = self.across(at, along_x, height);
            self.painted(mesh, place);
        }
        if self.random.chance(0.6) {
            let along_x = self.random.chance(0.5);
            let height = BAY.y - 1.75 - 0.1 * self.random.unit();
            let place = self.across(at, along_x, height);
            self.steel_at(self.meshes.tray, place);
        }
    }

    fn steel_at(&mut self, mesh: u32, place: glam::DAffine3) {
        let colour = shade(&mut self.random, STEEL[0], 0.3);
        self.assembly.place(mesh, colour, place);
    }

    /// From one side of a bay to the other at a height: along x, or along z.
    fn across(&mut self, at: DVec3, along_x: bool, height: f64) -> glam::DAffine3 {
        let aside = self.random.range(1.2, 4.8);
        match along_x {
            true => turned(at + DVec3::new(0.0, height, aside), 0.0),
            false => turned(at + DVec3::new(aside, height, 0.0), -FRAC_PI_2),
        }
    }

    fn machines(&mut self, at: DVec3) {
        for (x, z) in [(1.6, 1.7), (4.3, 4.2)] {
            if self.random.chance(0.4) {
                continue;
            }
            let mesh = self.random.pick(&self.meshes.machines);
            let place = at + DVec3::new(x, 0.06, z);
            let angle = FRAC_PI_2 * self.random.below(4) as f64 + self.random.range(-0.1, 0.1);
            self.painted(mesh, turned(place, angle));
        }
        let mesh = self.random.pick(&self.meshes.tangles);
        let turns = self.random.below(4) as f64;
        self.painted(mesh, turned(at + DVec3::new(0.5 * BAY.x, 0.06, 0.5 * BAY.z), turns * FRAC_PI_2));
    }

    /// Corrugated sheet on the outside, here and there.
    fn cladding(&mut self, at: DVec3, faces_x: bool) {
        if self.random.chance(0.55) {
            let place = match faces_x {
                true => turned(at + DVec3::new(-0.4, 0.0, 0.0), -FRAC_PI_2),
                false => turned(at + DVec3::new(0.0, 0.0, BAY.z + 0.4), 0.0),
            };
            let colour = shade(&mut self.random, [0.45, 0.52, 0.56], 0.25);
            self.assembly.place(self.meshes.sheet, colour, place);
        }
    }

    /// One thing on the ground beside the frame: a tank, a machine, or a stack of pipes.
    fn yard(&mut self) {
        let half = 0.5 * self.size();
        let angle = self.random.range(0.0, TAU);
        let out = DVec3::new(angle.cos(), 0.0, angle.sin());
        let edge = (half.x / out.x.abs().max(1e-9)).min(half.z / out.z.abs().max(1e-9));
        let at = out * (edge * 1.05 + self.random.range(8.0, 40.0)) - DVec3::Y * 0.02;
        let mesh = match self.random.below(8) {
            0 => self.meshes.tank,
            1 | 2 => self.random.pick(&self.meshes.machines),
            3..=5 => self.random.pick(&self.meshes.tangles),
            _ => self.random.pick(&self.meshes.risers),
        };
        let turn = self.random.range(0.0, TAU);
        self.painted(mesh, turned(at, turn));
    }

    /// Along the gangway through the middle of the frame, back and forth.
    fn walk(&self) -> Walk {
        let [floor, row] = self.gangway();
        let eye = DVec3::new(0.0, EYE, 0.5 * BAY.z + 0.2);
        let from = self.corner([0, floor, row]) + eye + DVec3::new(1.0, 0.0, 0.0);
        let to = self.corner([self.bays[0], floor, row]) + eye;
        Walk { points: vec![from, to], length: WALK, clearance: 0.5 }
    }
}
