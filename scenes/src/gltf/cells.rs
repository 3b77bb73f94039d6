//! Cells and portals, which a file names in the extras of its scene under [`KEY`]; scenes/README.md says how.

use super::document::Document;
use super::fault::{Fault, Outcome};
use crate::model::{Aabb, Cell, Cells, Portal};
use glam::DVec3;
use serde::{Deserialize, Serialize};
use serde_json::{json, Value};

const KEY: &str = "sightline_cells";

#[derive(Deserialize, Serialize)]
struct Written {
    half_wall: f64,
    reach: f64,
    cells: Vec<WrittenCell>,
    portals: Vec<WrittenPortal>,
}

#[derive(Deserialize, Serialize)]
struct WrittenCell {
    #[serde(default)]
    name: String,
    min: [f64; 3],
    max: [f64; 3],
}

#[derive(Deserialize, Serialize)]
struct WrittenPortal {
    /// `null`: outside.
    cells: [Option<u32>; 2],
    corners: Vec<[f64; 3]>,
}

/// The cells of the scene that is shown; none if it names none.
pub(super) fn read(document: &Document<'_>) -> Outcome<Option<Cells>> {
    let root = &document.root;
    let shown = root.scenes.get(root.scene.map_or(0, |scene| scene.value()));
    let Some(extras) = shown.and_then(|scene| scene.extras.as_ref()) else { return Ok(None) };
    let extras: Value = serde_json::from_str(extras.get()).unwrap_or_default();
    let Some(named) = extras.get(KEY) else { return Ok(None) };
    let fault = |error: serde_json::Error| Fault::Broken(format!("extras of its scene, '{KEY}': {error}"));
    let written = Written::deserialize(named).map_err(fault)?;
    let cell = |(index, cell): (usize, WrittenCell)| Cell {
        name: if cell.name.is_empty() { format!("cell {index}") } else { cell.name },
        bounds: Aabb { min: cell.min.into(), max: cell.max.into() },
    };
    let portal = |portal: WrittenPortal| Portal {
        cells: portal.cells,
        corners: portal.corners.into_iter().map(DVec3::from).collect(),
    };
    Ok(Some(Cells {
        half_wall: written.half_wall,
        reach: written.reach,
        cells: written.cells.into_iter().enumerate().map(cell).collect(),
        portals: written.portals.into_iter().map(portal).collect(),
    }))
}

/// What [`read`] reads, as the extras of a scene.
pub(crate) fn extras(cells: &Cells) -> Value {
    let cell = |cell: &Cell| WrittenCell {
        name: cell.name.clone(),
        min: cell.bounds.min.to_array(),
        max: cell.bounds.max.to_array(),
    };
    let portal = |portal: &Portal| WrittenPortal {
        cells: portal.cells,
        corners: portal.corners.iter().map(|corner| corner.to_array()).collect(),
    };
    let written = Written {
        half_wall: cells.half_wall,
        reach: cells.reach,
        cells: cells.cells.iter().map(cell).collect(),
        portals: cells.portals.iter().map(portal).collect(),
    };
    json!({ KEY: json!(written) })
}
