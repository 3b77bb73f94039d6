//! What a scene is: meshes, objects that place them, and their world bounds.

use crate::animation::Motion;
use crate::camera::Camera;
use crate::morph::Deformed;
use crate::skin::Skin;
use crate::texture::Texture;
use glam::{DAffine3, DVec3, Vec2, Vec3};

/// How a mesh's indices form primitives. Strips, fans and loops are rewritten to these on import.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Topology {
    /// Three indices a triangle.
    #[default]
    Triangles,
    /// Two indices a line, one pixel wide.
    Lines,
    /// One index a point, one pixel large.
    Points,
}

/// Geometry in object space. Indices are always within `positions`, which are always finite.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Name from the file, or of the generator.
    pub name: String,
    /// How `indices` form primitives.
    pub topology: Topology,
    /// Object-space positions.
    pub positions: Vec<Vec3>,
    /// Unit normals, one a position.
    pub normals: Vec<Vec3>,
    /// Indices into `positions`; a multiple of 3, 2 or 1 by `topology`.
    pub indices: Vec<u32>,
    /// The box that its maker says it lies in, in object space. Honoured if it holds every position, else ignored.
    pub declared_bounds: Option<Aabb>,
    /// Where each position lies on the texture, (1, 1) being its lower right corner; empty if there is no texture.
    pub texture_coordinates: Vec<Vec2>,
    /// Factors of the colour at each position: linear RGBA, each in 0..=1; empty for no colours. They are not cut to 8 bits, as alpha
    /// may have to equal a cutoff.
    pub colours: Vec<[f32; 4]>,
}

/// What of a surface decides where it leaves fragments, beside its colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// Of masked objects: what has less alpha is not there.
    pub cutoff: f32,
    /// Index into [`Scene::textures`] of the base colour's texture.
    pub texture: Option<u32>,
    /// Triangles are seen from the front alone, where their corners go round counter-clockwise. Means nothing for lines and points.
    pub single_sided: bool,
}

impl Default for Surface {
    fn default() -> Self {
        // The cutoff of glTF.
        Surface { cutoff: 0.5, texture: None, single_sided: false }
    }
}

/// One mesh primitive in the world: the unit of culling.
#[derive(Clone, Debug, PartialEq)]
pub struct Object {
    /// Name used in errors and reports; not unique.
    pub name: String,
    /// Index into [`Scene::meshes`].
    pub mesh: u32,
    /// World from object, at time 0.
    pub world_from_object: DAffine3,
    /// Linear base colour, alpha last, each in 0..=1.
    pub colour: [f32; 4],
    /// Moves during the scene's animation.
    pub dynamic: bool,
    /// Blended after all others, back to front; hides nothing.
    pub translucent: bool,
    /// Is not there where its alpha is less than its surface's cutoff.
    pub masked: bool,
    /// What else decides where it leaves fragments.
    pub surface: Surface,
}

/// An axis-aligned box, `min <= max` in each axis when it holds something.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// Smallest corner.
    pub min: DVec3,
    /// Largest corner.
    pub max: DVec3,
}

/// Everything there is to draw, and where to look at it from.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// Name on the command line and in results.
    pub name: String,
    /// Meshes, shared by objects.
    pub meshes: Vec<Mesh>,
    /// Objects, in drawing order.
    pub objects: Vec<Object>,
    /// Textures of surfaces.
    pub textures: Vec<Texture>,
    /// Cameras supplied with the scene, the default one first. May be empty: then one is made from the bounds.
    pub cameras: Vec<Camera>,
    /// How dynamic objects move.
    pub motion: Motion,
    /// Skeletons.
    pub skins: Vec<Skin>,
    /// Meshes that skeletons or morph targets deform, by ascending mesh. See [`Scene::deform`].
    pub deformed: Vec<Deformed>,
    /// Where one can walk, if the generator knows.
    pub walk: Option<Walk>,
    /// What is solid of a city; empty for scenes that are none.
    pub buildings: Vec<Building>,
    /// Its rooms and the openings between them, if it has such.
    pub cells: Option<Cells>,
}

/// A building of a city. Its object's mesh is closed and encloses the box: who looks at any point of the box from outside the mesh sees the
/// mesh, not the point. The object is opaque and stays upright where it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Building {
    /// Index into [`Scene::objects`].
    pub object: u32,
    /// The box, in object space.
    pub solid: Aabb,
}

/// The cells of a scene, and what joins them.
///
/// They promise: cells do not overlap. Every face of a cell is closed, but for its portals, by opaque closed meshes that stay where they are,
/// are no farther than `reach` from the face and reach at least `half_wall` to both sides of it. So whoever is in a cell sees what is beyond only
/// through portals. Faces of neighbours lie in one plane: the middle of the wall.
#[derive(Clone, Debug, PartialEq)]
pub struct Cells {
    /// How thick what closes a face is, to each side, at least; metres.
    pub half_wall: f64,
    /// How far what closes a face reaches to each side, at most; metres.
    pub reach: f64,
    /// The cells.
    pub cells: Vec<Cell>,
    /// The openings.
    pub portals: Vec<Portal>,
}

/// A room.
#[derive(Clone, Debug, PartialEq)]
pub struct Cell {
    /// Its name.
    pub name: String,
    /// The box that it is.
    pub bounds: Aabb,
}

/// An opening in the faces between two cells, or to what is outside of all.
#[derive(Clone, Debug, PartialEq)]
pub struct Portal {
    /// The cells that it joins; none is what is outside of all cells.
    pub cells: [Option<u32>; 2],
    /// A flat convex polygon around the opening.
    pub corners: Vec<DVec3>,
}

/// A way along the ground that meets no obstacle.
#[derive(Clone, Debug, PartialEq)]
pub struct Walk {
    /// Eye positions in the world, in metres. If the last equals the first, the way is a loop.
    pub points: Vec<DVec3>,
    /// How far a path of speed 1 goes, in metres, > 0.
    pub length: f64,
    /// How far the eye can leave the way to either side, in metres.
    pub clearance: f64,
}
