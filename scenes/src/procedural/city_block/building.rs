//! Houses: a closed shell, things on its fronts and roof, and furnished floors inside that nobody sees.

use super::street::{PAVEMENT, PAVEMENT_TOP};
use super::{Builder, BLOCK};
use crate::procedural::{quarter_turns, shade, sized, standing, turned};
use glam::{DAffine3, DVec3};

const LOTS: usize = 4;
const STOREY: f64 = 3.2;
const WALLS: [[f32; 3]; 7] = [
    [0.62, 0.35, 0.26],
    [0.72, 0.62, 0.48],
    [0.55, 0.52, 0.5],
    [0.78, 0.74, 0.66],
    [0.48, 0.28, 0.22],
    [0.6, 0.66, 0.68],
    [0.7, 0.55, 0.35],
];

/// One house. Its front is +z before it is turned.
struct House {
    /// The middle of its floor, at pavement height.
    at: DVec3,
    /// Quarter turns of its front from +z.
    turns: i32,
    width: f64,
    depth: f64,
    storeys: usize,
    /// What it is higher than its storeys need, in metres: else roofs and ledges of neighbours would lie in one plane.
    rise: f64,
    /// Has a ridged roof, otherwise a flat one.
    gabled: bool,
    walls: [f32; 3],
}

impl House {
    fn height(&self) -> f64 {
        self.storeys as f64 * STOREY + self.rise
    }

    /// World from a frame whose origin is at the foot of a side's middle, and whose +z leads out of it.
    fn side(&self, turns: i32) -> DAffine3 {
        let reach = if turns % 2 == 0 { self.depth } else { self.width };
        let out = quarter_turns(self.turns + turns) * DVec3::new(0.0, 0.0, 0.5 * reach);
        standing(self.at + out, self.turns + turns)
    }
}

impl Builder {
    /// The eight houses of a block back to back, and its courtyard.
    pub(super) fn houses(&mut self, at: DVec3) {
        let houses: Vec<House> = (0..2 * LOTS).map(|lot| self.house(at, lot % LOTS, lot / LOTS)).collect();
        for house in &houses {
            self.shell(house);
        }
        self.courtyard(at);
        for (lot, house) in houses.iter().enumerate() {
            self.fronts(house, lot);
            self.roof(house);
            for storey in 0..house.storeys {
                self.interior(house, storey);
            }
        }
    }

    fn house(&mut self, at: DVec3, lot: usize, row: usize) -> House {
        let lot_width = (BLOCK[0] - 2.0 * PAVEMENT) / LOTS as f64;
        // Neighbours reach into each other by 20 cm, so no gap is left, and stand back from the street by different
        // lengths, so no two fronts lie in one plane.
        let setback = self.random.range(0.0, 0.6);
        let depth = self.random.range(11.0, 12.5);
        let gabled = self.random.chance(0.2);
        let storeys = if gabled { 3 + self.random.below(2) } else { 4 + self.random.below(5) };
        let x = PAVEMENT + (lot as f64 + 0.5) * lot_width;
        let inward = PAVEMENT + setback + 0.5 * depth;
        let (z, turns) = if row == 0 { (inward, 2) } else { (BLOCK[1] - inward, 0) };
        let walls = self.random.pick(&WALLS);
        House {
            at: at + DVec3::new(x, PAVEMENT_TOP, z),
            turns,
            width: lot_width + 0.2,
            depth,
            storeys,
            rise: self.random.range(0.9, 1.5),
            gabled,
            walls: shade(&mut self.random, walls, 0.12),
        }
    }

    fn shell(&mut self, house: &House) {
        let (mesh, height) = if house.gabled {
            // The walls end at three quarters of this mesh's height.
            (self.meshes.house, house.height() / 0.75)
        } else {
            (self.random.pick(&self.meshes.shells), house.height())
        };
        let size = DVec3::new(house.width, height + 0.3, house.depth);
        let place = sized(house.at - DVec3::new(0.0, 0.3, 0.0), size);
        self.assembly.place(mesh, house.walls, place);
        self.assembly.solid([-0.5, 0.0, -0.5], [0.5, if house.gabled { 0.75 } else { 1.0 }, 0.5]);
    }

    /// Walls that close the gaps between the rows of houses, trees and railings.
    fn courtyard(&mut self, at: DVec3) {
        let ground = PAVEMENT_TOP - 0.04;
        for x in [PAVEMENT + 0.5, BLOCK[0] - PAVEMENT - 0.5] {
            let place = sized(at + DVec3::new(x, ground - 0.1, 0.5 * BLOCK[1]), DVec3::new(0.3, 3.6, 16.0));
            self.assembly.place(self.meshes.cube, [0.5, 0.42, 0.36], place);
        }
        for step in 0..6 {
            let x = 9.0 + 9.2 * step as f64 + self.random.range(-2.0, 2.0);
            let place = at + DVec3::new(x, ground, 0.5 * BLOCK[1] + self.random.range(-2.0, 2.0));
            let tree = self.random.pick(&self.meshes.trees);
            let colour = shade(&mut self.random, [0.14, 0.34, 0.1], 0.3);
            let angle = self.random.range(0.0, 6.0);
            self.assembly.place(tree, colour, turned(place, angle));
        }
        for step in 0..22 {
            let place = at + DVec3::new(6.5 + 2.4 * step as f64, ground, 0.5 * BLOCK[1] + 3.1);
            self.stand(self.meshes.fence, [0.2, 0.22, 0.2], place, 0);
        }
    }

    /// Windows and more on the street side, the court side, and a corner house's third side.
    fn fronts(&mut self, house: &House, lot: usize) {
        let window = self.random.pick(&self.meshes.windows);
        let frame = shade(&mut self.random, [0.75, 0.76, 0.78], 0.2);
        self.windows(house, 0, 1..house.storeys, 4, window, frame);
        self.windows(house, 2, 0..house.storeys, 3, window, frame);
        self.ground_floor(house, frame);
        // Lots count along +x; a house of the row that faces -z has +x to its left.
        let corner = match (lot % LOTS, house.turns) {
            (0, 0) | (3, 2) => Some(3),
            (0, 2) | (3, 0) => Some(1),
            _ => None,
        };
        if let Some(side) = corner {
            self.windows(house, side, 0..house.storeys, 3, window, frame);
        }
    }

    fn windows(
        &mut self,
        house: &House,
        side: i32,
        storeys: std::ops::Range<usize>,
        columns: usize,
        mesh: u32,
        frame: [f32; 3],
    ) {
        let wall = house.side(side);
        let width = if side % 2 == 0 { house.width } else { house.depth };
        for storey in storeys {
            for column in 0..columns {
                let along = ((column as f64 + 0.5) / columns as f64 - 0.5) * width;
                let height = storey as f64 * STOREY + 0.95;
                self.fix(&wall, mesh, frame, DVec3::new(along, height, 0.0));
                if storey > 0 && self.random.chance(0.08) {
                    self.fix(&wall, self.meshes.conditioner, [0.7, 0.7, 0.68], DVec3::new(along, height - 0.8, 0.0));
                } else if storey > 0 && side == 0 && self.random.chance(0.1) {
                    self.fix(&wall, self.meshes.balcony, [0.25, 0.26, 0.28], DVec3::new(along, height - 0.95, 0.0));
                }
            }
        }
    }

    fn ground_floor(&mut self, house: &House, frame: [f32; 3]) {
        let wall = house.side(0);
        let is_shop = self.random.chance(0.5);
        let door = shade(&mut self.random, [0.35, 0.2, 0.12], 0.4);
        self.fix(&wall, self.meshes.door, door, DVec3::new(0.0, 0.0, 0.0));
        let awning = shade(&mut self.random, [0.55, 0.15, 0.12], 0.5);
        for along in [-4.6, 4.6] {
            let mesh = if is_shop { self.meshes.shop_window } else { self.meshes.windows[0] };
            self.fix(&wall, mesh, frame, DVec3::new(along, if is_shop { 0.4 } else { 1.1 }, 0.0));
            if is_shop {
                self.fix(&wall, self.meshes.awning, awning, DVec3::new(along, 3.15, 0.02));
            }
        }
    }

    fn roof(&mut self, house: &House) {
        if house.gabled {
            let along = self.random.range(-4.0, 4.0);
            let ridge = house.at + DVec3::new(along, house.height() / 0.75 - 1.0, 1.4);
            self.stand(self.meshes.chimney, [0.4, 0.22, 0.18], ridge, 0);
            return;
        }
        let top = house.at + DVec3::new(0.0, house.height(), 0.0);
        if self.random.chance(0.3) {
            let size = DVec3::new(house.width, self.random.range(3.0, 7.0), house.depth);
            self.assembly.place(self.meshes.crown, house.walls, sized(top, size));
            return;
        }
        let choices = [self.meshes.roof_unit, self.meshes.water_tank, self.meshes.antenna, self.meshes.chimney];
        for x in [-4.5, -0.3, 3.9] {
            let mesh = self.random.pick(&choices);
            let shift = DVec3::new(x, 0.0, self.random.range(-2.5, 2.5));
            let colour = shade(&mut self.random, [0.5, 0.48, 0.45], 0.3);
            let turns = self.random.below(4) as i32;
            self.stand(mesh, colour, top + shift, turns);
        }
    }

    /// A floor, two partitions and one piece of furniture in most cells of a 4 by 3 grid.
    fn interior(&mut self, house: &House, storey: usize) {
        let floor = house.at + DVec3::new(0.0, storey as f64 * STOREY + 0.2, 0.0);
        let size = DVec3::new(house.width - 0.8, 0.2, house.depth - 0.8);
        self.assembly.place(self.meshes.cube, [0.45, 0.4, 0.35], sized(floor - DVec3::new(0.0, 0.2, 0.0), size));
        let lengthwise = DVec3::new(size.x - 0.1, STOREY - 0.4, 0.12);
        let crosswise = DVec3::new(0.12, STOREY - 0.44, size.z - 0.13);
        for (z, partition) in [(0.18, lengthwise), (0.0, crosswise)] {
            let place = sized(floor + DVec3::new(0.03, -0.05, z * house.depth), partition);
            self.assembly.place(self.meshes.cube, [0.7, 0.69, 0.66], place);
        }
        let furniture = &self.furniture;
        let pieces = [
            furniture.table,
            furniture.chair,
            furniture.shelf,
            furniture.sofa,
            furniture.bed,
            furniture.desk,
            furniture.plant,
            furniture.chair,
        ];
        let cell = DVec3::new(size.x / 4.0, 0.0, size.z / 3.0);
        for spot in 0..12 {
            if self.random.chance(0.3) {
                continue;
            }
            let (column, row) = ((spot % 4) as f64, (spot / 4) as f64);
            let at = floor + DVec3::new((column - 1.5) * cell.x, 0.005, (row - 1.0) * cell.z);
            let piece = self.random.pick(&pieces);
            let turns = self.random.below(4) as i32;
            self.furniture.place(&mut self.assembly, &mut self.random, piece, standing(at, turns));
        }
    }

    /// Fixes a mesh to a wall: `along` it, up, and out of it, in metres.
    fn fix(&mut self, wall: &DAffine3, mesh: u32, colour: [f32; 3], offset: DVec3) {
        let place = DAffine3 { matrix3: wall.matrix3, translation: wall.transform_point3(offset) };
        self.assembly.place(mesh, colour, place);
    }
}
