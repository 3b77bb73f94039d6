//! What is in a hall: rows of machines with what belongs to them, shelves, a crane and lamps.

use super::{Builder, HALL, PAINT, PANEL, PANELS, STEEL, WALL, WOOD};
use glam::DVec3;

/// Rows of machines, and machines in a row.
const ROWS: usize = 3;
const PLACES: usize = 8;

impl Builder {
    /// Fills a hall from its corner. Its floor is 5 cm above the streets.
    pub(super) fn inside(&mut self, at: DVec3) {
        let at = at + DVec3::Y * 0.05;
        for row in 0..ROWS {
            let z = 6.5 + 8.0 * row as f64;
            for place in 0..PLACES {
                self.workplace(at + DVec3::new(4.0 + 5.6 * place as f64, 0.0, z));
            }
        }
        self.frame(at);
        self.shelves(at);
        for piece in 1..PANELS[0] {
            let x = piece as f64 * PANEL;
            let pipes = self.random.pick(&self.meshes.rack_pipes);
            self.painted(pipes, at + DVec3::new(x, 5.6, 1.4), 0);
            let pipes = self.random.pick(&self.meshes.rack_pipes);
            self.painted(pipes, at + DVec3::new(x, 5.2, HALL[1] - 1.4), 0);
        }
    }

    /// A machine with a piece of conveyor, a cabinet, a pipe to the ceiling, and barrels or crates.
    fn workplace(&mut self, at: DVec3) {
        let machine = self.random.pick(&self.meshes.machines);
        let turns = 2 * self.random.below(2) as i32;
        self.painted(machine, at, turns);
        let conveyor = self.meshes.conveyor;
        self.put(conveyor, STEEL, at + DVec3::new(0.0, -0.01, 2.2), 0);
        let cabinet = self.meshes.cabinet;
        self.put(cabinet, [0.5, 0.52, 0.48], at + DVec3::new(2.1, -0.01, -0.6), 0);
        let drop = self.meshes.drop_pipe;
        let aside = self.random.range(-0.8, 0.8);
        self.painted(drop, at + DVec3::new(aside, 1.0, -0.4), 0);
        if self.random.chance(0.75) {
            let load = self.random.pick(&self.meshes.loads);
            let along = self.random.range(-1.6, 1.6);
            self.put(load, WOOD, at + DVec3::new(along, 0.84, 2.2), 0);
        }
        for side in [-1.0, 1.0] {
            let place = DVec3::new(1.3 * side + self.random.range(-0.2, 0.2), -0.02, -2.6);
            self.heap(at + place);
        }
    }

    /// Columns, trusses below the roof, a crane and lamps.
    fn frame(&mut self, at: DVec3) {
        for piece in 1..PANELS[0] {
            let x = piece as f64 * PANEL;
            for z in [0.5, HALL[1] - 0.5] {
                let column = self.meshes.column;
                self.put(column, STEEL, at + DVec3::new(x, -0.02, z), 0);
            }
            let truss = self.meshes.truss;
            self.put(truss, STEEL, at + DVec3::new(x + 0.2, WALL - 0.5, 0.5 * HALL[1]), 0);
            for lamp in 0..3 {
                let z = 7.0 + 8.0 * f64::from(lamp);
                let mesh = self.meshes.lamp;
                self.put(mesh, [0.85, 0.83, 0.7], at + DVec3::new(x - 3.0, WALL - 2.0, z), 0);
            }
        }
        let (crane, along) = (self.meshes.crane, self.random.range(8.0, 40.0));
        self.put(crane, PAINT[2], at + DVec3::new(along, WALL - 1.6, 0.5 * HALL[1]), 0);
    }

    /// Shelves with boxes along the two short walls.
    fn shelves(&mut self, at: DVec3) {
        for (x, turns) in [(1.0, 1), (HALL[0] - 1.0, 3)] {
            for shelf in 0..6 {
                let place = at + DVec3::new(x, -0.02, 4.5 + 4.0 * f64::from(shelf));
                let mesh = self.meshes.shelf;
                self.put(mesh, STEEL, place, turns);
                for board in 0..3 {
                    let load = self.random.pick(&self.meshes.loads);
                    let aside = self.random.range(-1.0, 1.0);
                    self.put(load, WOOD, place + DVec3::new(0.0, 0.12 + 0.9 * f64::from(board), aside), turns);
                }
            }
        }
    }
}
