//! Flat faces in several pieces: as heavy as a level of detail asks for.

use super::Parts;
use glam::Vec3;

impl Parts {
    /// Adds a flat or nearly flat face, each edge in as many pieces as the level of detail has.
    pub(super) fn cut_face(&mut self, corners: &[Vec3], normal: Vec3) {
        let cuts = self.detail.cuts();
        match corners {
            [a, b, c, d] => {
                let point = |i: f32, j: f32| a.lerp(*b, i).lerp(d.lerp(*c, i), j);
                self.cut_quad(cuts, normal, point);
            }
            _ => (2..corners.len())
                .for_each(|corner| self.cut_triangle(cuts, normal, [corners[0], corners[corner - 1], corners[corner]])),
        }
    }

    fn cut_quad(&mut self, cuts: usize, normal: Vec3, point: impl Fn(f32, f32) -> Vec3) {
        let first = self.positions.len() as u32;
        let across = cuts as u32 + 1;
        for row in 0..=cuts {
            for column in 0..=cuts {
                self.positions.push(point(column as f32 / cuts as f32, row as f32 / cuts as f32));
                self.normals.push(normal);
            }
        }
        for row in 0..cuts as u32 {
            for column in 0..cuts as u32 {
                let a = first + row * across + column;
                self.indices.extend([a, a + 1, a + across + 1, a, a + across + 1, a + across]);
            }
        }
    }

    fn cut_triangle(&mut self, cuts: usize, normal: Vec3, [a, b, c]: [Vec3; 3]) {
        let first = self.positions.len() as u32;
        // Row r has r + 1 points, from the edge ab to the edge ac.
        let at = |row: usize, column: usize| first + (row * (row + 1) / 2 + column) as u32;
        for row in 0..=cuts {
            for column in 0..=row {
                let (down, along) = (row as f32 / cuts as f32, column as f32 / row.max(1) as f32);
                self.positions.push(a.lerp(b, down).lerp(a.lerp(c, down), along));
                self.normals.push(normal);
            }
        }
        for row in 0..cuts {
            for column in 0..=row {
                self.indices.extend([at(row, column), at(row + 1, column), at(row + 1, column + 1)]);
                if column < row {
                    self.indices.extend([at(row, column), at(row + 1, column + 1), at(row, column + 1)]);
                }
            }
        }
    }
}
