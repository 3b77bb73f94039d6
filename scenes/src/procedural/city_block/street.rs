//! Roads, pavements and what stands on them.

use super::{Builder, BLOCK, STREET};
use crate::procedural::{shade, sized, standing, turned};
use glam::DVec3;

const ASPHALT: [f32; 3] = [0.2, 0.2, 0.21];
const PAVING: [f32; 3] = [0.5, 0.49, 0.47];
/// Width of the pavement around a block, and its height above the road.
pub(super) const PAVEMENT: f64 = 3.0;
pub(super) const PAVEMENT_TOP: f64 = 0.15;
const CAR_PAINTS: [[f32; 3]; 6] =
    [[0.6, 0.08, 0.08], [0.1, 0.2, 0.5], [0.8, 0.8, 0.8], [0.08, 0.08, 0.09], [0.55, 0.55, 0.5], [0.1, 0.35, 0.2]];

impl Builder {
    /// The streets behind a block at its larger x and z, those before it too at the city's edge, and its pavement.
    pub(super) fn streets(&mut self, at: DVec3, first_column: bool, first_row: bool) {
        let (x_ends, z_ends) = ((0.0, BLOCK[0]), (0.0, BLOCK[1]));
        let after = |ends: (f64, f64)| (ends.1, ends.1 + STREET);
        let before = (-STREET, 0.0);
        self.tiles(at, x_ends, after(z_ends), 0.0, ASPHALT);
        self.tiles(at, after(x_ends), z_ends, 0.0, ASPHALT);
        self.tiles(at, after(x_ends), after(z_ends), 0.0, ASPHALT);
        if first_column {
            self.tiles(at, before, z_ends, 0.0, ASPHALT);
            self.tiles(at, before, after(z_ends), 0.0, ASPHALT);
        }
        if first_row {
            self.tiles(at, x_ends, before, 0.0, ASPHALT);
            self.tiles(at, after(x_ends), before, 0.0, ASPHALT);
        }
        if first_row && first_column {
            self.tiles(at, before, before, 0.0, ASPHALT);
        }
        self.pavement(at);
        self.kerbs(at);
        self.street_furniture(at);
        self.parked_cars(at);
    }

    /// Ground over a rectangle, in tiles of at most 16 m.
    fn tiles(&mut self, at: DVec3, x: (f64, f64), z: (f64, f64), y: f64, colour: [f32; 3]) {
        let count = |ends: (f64, f64)| ((ends.1 - ends.0) / 16.0).ceil();
        let (columns, rows) = (count(x), count(z));
        let size = DVec3::new((x.1 - x.0) / columns, 0.28 + y, (z.1 - z.0) / rows);
        for tile in 0..(columns * rows) as usize {
            let (column, row) = ((tile % columns as usize) as f64, (tile / columns as usize) as f64);
            let centre = DVec3::new(x.0 + (column + 0.5) * size.x, y, z.0 + (row + 0.5) * size.z);
            let colour = shade(&mut self.random, colour, 0.05);
            self.assembly.place(self.meshes.tile, colour, sized(at + centre, size));
        }
    }

    fn pavement(&mut self, at: DVec3) {
        let ([width, depth], inner) = (BLOCK, PAVEMENT);
        for z in [(0.0, inner), (depth - inner, depth)] {
            self.tiles(at, (0.0, width), z, PAVEMENT_TOP, PAVING);
        }
        for x in [(0.0, inner), (width - inner, width)] {
            self.tiles(at, x, (inner, depth - inner), PAVEMENT_TOP, PAVING);
        }
        // The courtyard lies a little lower, and reaches under the houses.
        self.tiles(at, (inner, width - inner), (inner, depth - inner), PAVEMENT_TOP - 0.04, [0.3, 0.38, 0.22]);
    }

    /// Kerb stones of 8 m; those along z are lower by half a centimetre, as they cross the others at the corners.
    fn kerbs(&mut self, at: DVec3) {
        let ([width, depth], stone) = (BLOCK, 8.0);
        for piece in 0..(width / stone) as usize {
            for z in [0.0, depth] {
                let centre = DVec3::new((piece as f64 + 0.5) * stone, -0.05, z);
                let size = DVec3::new(stone, PAVEMENT_TOP + 0.07, 0.24);
                self.assembly.place(self.meshes.cube, [0.6, 0.6, 0.58], sized(at + centre, size));
            }
        }
        for piece in 0..(depth / stone) as usize {
            for x in [0.0, width] {
                let centre = DVec3::new(x, -0.05, (piece as f64 + 0.5) * stone);
                let size = DVec3::new(0.24, PAVEMENT_TOP + 0.065, stone);
                self.assembly.place(self.meshes.cube, [0.6, 0.6, 0.58], sized(at + centre, size));
            }
        }
    }

    fn street_furniture(&mut self, at: DVec3) {
        let [width, depth] = BLOCK;
        // Along both long sides; things face the road.
        for (z, turns) in [(0.6, 2), (depth - 0.6, 0)] {
            for x in [4.0, 24.0, 44.0, 61.0] {
                self.stand(self.meshes.lamp_post, [0.15, 0.16, 0.17], at + DVec3::new(x, PAVEMENT_TOP, z), turns);
            }
            for x in [14.0, 34.0, 54.0] {
                let tree = self.random.pick(&self.meshes.trees);
                let place = at + DVec3::new(x + self.random.range(-2.0, 2.0), PAVEMENT_TOP, z + 0.2);
                let colour = shade(&mut self.random, [0.16, 0.36, 0.12], 0.3);
                let angle = self.random.range(0.0, 6.0);
                self.assembly.place(tree, colour, turned(place, angle));
            }
            let small = [
                (self.meshes.bench, [0.4, 0.27, 0.15]),
                (self.meshes.hydrant, [0.65, 0.1, 0.08]),
                (self.meshes.bin, [0.2, 0.3, 0.22]),
            ];
            for (slot, (mesh, colour)) in small.into_iter().enumerate() {
                let x = 19.0 + 20.0 * slot as f64 + self.random.range(-2.0, 2.0);
                self.stand(mesh, colour, at + DVec3::new(x.min(width - 7.0), PAVEMENT_TOP, z), turns);
            }
        }
        for (x, z, turns) in
            [(1.0, depth - 1.0, 0), (width - 1.0, depth - 1.0, 1), (1.0, 1.0, 3), (width - 1.0, 1.0, 2)]
        {
            self.stand(self.meshes.traffic_light, [0.12, 0.14, 0.13], at + DVec3::new(x, PAVEMENT_TOP, z), turns);
        }
        let crossings = [(width - 3.0, depth + 0.5 * STREET, 1), (width + 0.5 * STREET, depth - 3.0, 0)];
        for (x, z, turns) in crossings {
            self.stand(self.meshes.crossing, [0.85, 0.85, 0.82], at + DVec3::new(x, 0.0, z), turns);
        }
    }

    fn parked_cars(&mut self, at: DVec3) {
        let [width, depth] = BLOCK;
        for slot in 0..8 {
            for (z, turns) in [(depth + 1.2, 2), (depth + STREET - 1.2, 0)] {
                if self.random.chance(0.6) {
                    let x = 6.0 + 6.6 * slot as f64 + self.random.range(-0.5, 0.5);
                    let place = DVec3::new(x, 0.0, z + self.random.range(-0.1, 0.1));
                    self.car(at + place, turns);
                }
            }
        }
        for slot in 0..4 {
            for (x, turns) in [(width + 1.2, 1), (width + STREET - 1.2, 3)] {
                if self.random.chance(0.5) {
                    self.car(at + DVec3::new(x, 0.0, 7.0 + 6.8 * slot as f64), turns);
                }
            }
        }
    }

    fn car(&mut self, at: DVec3, turns: i32) {
        let mesh = self.random.pick(&self.meshes.cars);
        let paint = self.random.pick(&CAR_PAINTS);
        let colour = shade(&mut self.random, paint, 0.2);
        self.stand(mesh, colour, at, turns);
    }

    /// Places a mesh on a spot, its front (+z) turned by quarter turns.
    pub(super) fn stand(&mut self, mesh: u32, colour: [f32; 3], at: DVec3, turns: i32) {
        self.assembly.place(mesh, colour, standing(at, turns));
    }
}
