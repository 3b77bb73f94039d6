//! Monsters (MO): a scene as in a game, after the scene of the same name in Kim 2015, V ("many medium-sized and low-polygon
//! objects") and Lee et al. 2018, 4.1 ("of medium complexity, with around 6.3K objects").
//!
//! Wooded hills with herds of monsters and their huts and fires. Hills and trees hide some of it, but from most places much is
//! in sight: culling gains little here, as in Kim's figure 10.

mod meshes;

use super::detail::Detail;
use super::nature::{Nature, CAPS, GLASS, LEAVES, STONE};
use super::random::Random;
use super::terrain::{Terrain, TILE};
use super::{camera, count, lane, posed, shade, Assembly, SceneOptions};
use crate::model::{Scene, Walk};
use glam::DVec3;
use meshes::Meshes;
use std::f64::consts::TAU;

/// Objects at scale 1.
const OBJECTS: usize = 6_300;
const LEAST_OBJECTS: usize = 60;
/// Ground for an object, in square metres.
const ROOM: f64 = 36.0;
const EYE: f64 = 1.9;
/// How far the walk goes at speed 1, in metres.
const WALK: f64 = 70.0;
/// Sides of what is round, at level of detail 1.
const FINE: usize = 6;

const HIDES: [[f32; 3]; 6] =
    [[0.35, 0.45, 0.2], [0.5, 0.22, 0.2], [0.3, 0.3, 0.5], [0.55, 0.45, 0.2], [0.4, 0.25, 0.45], [0.25, 0.45, 0.45]];
const WOOD: [f32; 3] = [0.4, 0.29, 0.18];

struct Builder {
    assembly: Assembly,
    meshes: Meshes,
    nature: Nature,
    random: Random,
    terrain: Terrain,
    way: Vec<DVec3>,
    /// Half the edge of the land in metres.
    half: f64,
}

pub(super) fn make(options: &SceneOptions) -> Scene {
    let target = count(OBJECTS, options.scale, LEAST_OBJECTS);
    let detail = Detail::new(options.detail);
    let mut random = Random::new(options.seed, 0);
    let tiles = ((target as f64 * ROOM).sqrt() / TILE).round().max(2.0) as usize;
    let half = 0.5 * tiles as f64 * TILE;
    let terrain = Terrain::new(&mut random, 16.0, [0.0, 0.0]);
    let way = lane::ring(DVec3::ZERO, 0.4 * half, random.range(0.0, TAU), |at| terrain.height(at.x, at.z) + EYE);
    let mut assembly = Assembly::new("monsters");
    let meshes = Meshes::new(&mut assembly, detail, FINE);
    let nature = Nature::new(&mut assembly, detail, FINE);
    terrain.place(&mut assembly, &mut random, detail, tiles, [0.34, 0.42, 0.2]);
    let mut builder = Builder { assembly, meshes, nature, random, terrain, way, half };
    // Something to look at from the camera's first place.
    let ahead = builder.ahead();
    builder.camp(ahead);
    for _ in 0..3 {
        builder.herd(ahead);
    }
    while builder.assembly.len() < target {
        match builder.random.below(10) {
            0 => {
                let at = builder.anywhere();
                builder.camp(at);
            }
            1..=5 => {
                let at = builder.anywhere();
                builder.herd(at);
            }
            _ => builder.grove(),
        }
    }
    let walk = Walk { points: builder.way, length: WALK, clearance: 0.6 };
    let mut scene = builder.assembly.scene;
    scene.objects.truncate(target);
    scene.cameras = vec![camera("path", &walk, 0.1, 4.0 * half + 200.0)];
    scene.walk = Some(walk);
    scene
}

impl Builder {
    /// Somewhere on the land, a little inside its edge.
    fn anywhere(&mut self) -> DVec3 {
        let most = self.half - 6.0;
        let (x, z) = (self.random.range(-most, most), self.random.range(-most, most));
        self.terrain.on(x, z)
    }

    /// Before the camera, as far as two pieces of its way; nearer the middle of the land.
    fn ahead(&self) -> DVec3 {
        let at = 0.9 * (self.way[0] + 2.0 * (self.way[1] - self.way[0]));
        self.terrain.on(at.x, at.z)
    }

    /// Somewhere near a place, on the land.
    fn near(&mut self, middle: DVec3, reach: f64) -> DVec3 {
        let most = self.half - 3.0;
        let (x, z) = (self.random.range(-reach, reach), self.random.range(-reach, reach));
        self.terrain.on((middle.x + x).clamp(-most, most), (middle.z + z).clamp(-most, most))
    }

    /// Places a mesh a little sunk into the ground unless it would stand in the way.
    fn stand(&mut self, mesh: u32, palette: &[[f32; 3]], at: DVec3, size: f64, radius: f64) {
        let colour = self.random.pick(palette);
        let colour = shade(&mut self.random, colour, 0.3);
        let angle = self.random.range(0.0, TAU);
        if lane::level_distance(&self.way, at) > radius * size + 1.0 {
            self.assembly.place(mesh, colour, posed(at - DVec3::Y * 0.1 * size, angle, DVec3::splat(size)));
        }
    }

    /// Monsters of one kind, large and small.
    fn herd(&mut self, middle: DVec3) {
        let kind = self.random.pick(&self.meshes.monsters);
        let hide = self.random.pick(&HIDES);
        for _ in 0..4 + self.random.below(9) {
            let (at, size) = (self.near(middle, 12.0), self.random.range(0.6, 1.5));
            self.stand(kind, &[hide], at, size, 1.8);
        }
    }

    /// Huts around a fire, with a fence, totems and bones.
    fn camp(&mut self, middle: DVec3) {
        for hut in 0..3 {
            let angle = TAU * f64::from(hut) / 3.0 + 0.4 * self.random.unit();
            let at = self.terrain.on(middle.x + 8.0 * angle.cos(), middle.z + 8.0 * angle.sin());
            self.stand(self.meshes.hut, &[[0.5, 0.4, 0.22]], at, 1.0, 3.2);
        }
        self.stand(self.meshes.fire, &[[0.75, 0.35, 0.08]], middle, 1.0, 1.0);
        for (mesh, count) in [(self.meshes.totem, 2), (self.meshes.bones, 5), (self.meshes.palisade, 6)] {
            for _ in 0..count {
                let at = self.near(middle, 13.0);
                let colour = if mesh == self.meshes.bones { [0.75, 0.72, 0.6] } else { WOOD };
                self.stand(mesh, &[colour], at, 1.0, 1.6);
            }
        }
    }

    /// Trees, and what grows and lies below them.
    fn grove(&mut self) {
        let middle = self.anywhere();
        for _ in 0..8 {
            let (at, size) = (self.near(middle, 16.0), self.random.range(0.7, 1.4));
            match self.random.below(8) {
                0 => self.stand(self.nature.mushroom, &CAPS, at, 2.0 * size, 0.6),
                1 => self.stand(self.nature.bush, &LEAVES, at, size, 0.8),
                2 => {
                    let stone = self.random.pick(&self.nature.stones);
                    self.stand(stone, &STONE, at, size, 1.6);
                }
                3 => self.stand(self.nature.crystal, &GLASS, at, size, 1.0),
                _ => {
                    let tree = self.random.pick(&self.nature.trees);
                    self.stand(tree, &LEAVES, at, size, 2.8);
                }
            }
        }
    }
}
