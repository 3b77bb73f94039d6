//! Cells and portals (Zachmann 2008; Luebke & Georges 1995): which of them have a meaning.

use crate::error::SceneError;
use crate::model::{Cell, Cells, Portal, Scene};
use glam::DVec3;

impl Portal {
    /// The normal of its plane, of any length.
    pub fn normal(&self) -> DVec3 {
        let corners = &self.corners;
        let next = |index: usize| corners[(index + 1) % corners.len()];
        (0..corners.len()).map(|index| (corners[index] - corners[0]).cross(next(index) - corners[0])).sum()
    }
}

/// How far from flat a portal may be, as a share of its size: what `f32` may have made of it.
const FLAT: f64 = 1e-5;

impl Scene {
    pub(crate) fn check_cells(&self) -> Result<(), SceneError> {
        let Some(cells) = &self.cells else { return Ok(()) };
        match fault(cells) {
            None => Ok(()),
            Some((object, fault)) => Err(SceneError::BadObject { object, fault }),
        }
    }
}

/// What is wrong, and with which cell or portal.
fn fault(cells: &Cells) -> Option<(String, String)> {
    let told = |what: &str, fault: &str| Some((what.to_owned(), fault.to_owned()));
    let sizes = [cells.half_wall, cells.reach];
    if !sizes.iter().all(|size| size.is_finite() && *size > 0.0) || cells.half_wall > cells.reach {
        return told("cells", "half_wall must be above 0, and reach no less than it");
    }
    if cells.cells.is_empty() {
        return told("cells", "there is no cell");
    }
    for (index, cell) in cells.cells.iter().enumerate() {
        if !cell.bounds.is_valid() || cell.bounds.half_extent().min_element() <= cells.reach {
            return told(&cell.name, "as a cell it is no box, or thinner than its walls");
        }
        let overlaps = |other: &&Cell| {
            let (low, high) = (cell.bounds.min.max(other.bounds.min), cell.bounds.max.min(other.bounds.max));
            (high - low).min_element() > cells.half_wall
        };
        if let Some(other) = cells.cells[..index].iter().find(overlaps) {
            return told(&cell.name, &format!("as a cell it overlaps '{}'", other.name));
        }
    }
    let portal_fault = |(index, portal): (usize, &Portal)| {
        let strange = portal.cells.iter().flatten().any(|cell| *cell as usize >= cells.cells.len());
        let fault = match () {
            _ if portal.corners.len() < 3 || !portal.corners.iter().all(|corner| corner.is_finite()) => {
                "it has fewer than three corners, or one that is not finite"
            }
            _ if strange => "it joins a cell that is not there",
            _ if portal.cells[0] == portal.cells[1] => "it joins a cell with itself",
            _ if !is_flat_and_convex(portal) => "its corners are not those of a flat convex polygon",
            _ => return None,
        };
        Some((format!("portal {index}"), fault.to_owned()))
    };
    cells.portals.iter().enumerate().find_map(portal_fault)
}

fn is_flat_and_convex(portal: &Portal) -> bool {
    let (corners, normal) = (&portal.corners, portal.normal());
    let count = corners.len();
    let size = corners.iter().map(|corner| (*corner - corners[0]).length()).fold(0.0, f64::max);
    let turns = |index: usize| {
        let [a, b, c] = [0, 1, 2].map(|step| corners[(index + step) % count]);
        (b - a).cross(c - b).dot(normal) >= -FLAT * size * size * normal.length()
    };
    let flat = |corner: &DVec3| (*corner - corners[0]).dot(normal).abs() <= FLAT * size * normal.length();
    normal.length() > 0.0 && corners.iter().all(flat) && (0..count).all(turns)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Aabb;

    fn two_rooms() -> Cells {
        let cell = |name: &str, x: f64| Cell {
            name: name.into(),
            bounds: Aabb { min: DVec3::new(x, 0.0, 0.0), max: DVec3::new(x + 4.0, 3.0, 4.0) },
        };
        let corners = [(0.1, 1.0), (0.1, 2.0), (2.1, 2.0), (2.1, 1.0)].map(|(y, z)| DVec3::new(4.0, y, z));
        let portals = vec![Portal { cells: [Some(0), Some(1)], corners: corners.to_vec() }];
        Cells { half_wall: 0.05, reach: 0.1, cells: vec![cell("hall", 0.0), cell("bath", 4.0)], portals }
    }

    #[test]
    fn cells_without_a_meaning_are_refused_by_name() {
        let told = |change: fn(&mut Cells)| {
            let mut cells = two_rooms();
            change(&mut cells);
            let scene = Scene { cells: Some(cells), ..Scene::default() };
            scene.check().map_or_else(|error| error.to_string(), |()| "fine".into())
        };
        assert_eq!(told(|_| ()), "fine");
        assert!(told(|cells| cells.half_wall = 0.0).contains("half_wall"));
        assert!(told(|cells| cells.cells.clear()).contains("no cell"));
        assert!(told(|cells| cells.cells[1].bounds.min.x = 3.0).contains("'bath': as a cell it overlaps 'hall'"));
        assert!(told(|cells| cells.cells[1].bounds.max.x = f64::NAN).contains("'bath'"));
        assert!(told(|cells| cells.portals[0].cells[1] = Some(7)).contains("portal 0"));
        assert!(told(|cells| cells.portals[0].cells[1] = Some(0)).contains("with itself"));
        assert!(told(|cells| cells.portals[0].corners[2].x = 5.0).contains("flat convex"));
        assert!(told(|cells| cells.portals[0].corners.swap(0, 1)).contains("flat convex"));
        assert!(told(|cells| cells.portals[0].corners.truncate(2)).contains("three corners"));
    }
}
