//! Materials on the GPU, for scenes that are drawn with them: texture coordinates and colours beside each vertex, a material for each
//! object, and all textures as one buffer of texels, which every device can read (not every device indexes textures).

mod texels;

use super::draws::{record, MaybeQueried};
use super::upload::Flat;
use super::View;
use crate::Result;
use engine::{Buffer, Frame, Gpu, IndexedIndirect, Placement, Surface, Target};
use scenes::{Mesh, Scene, Wrap};
use shaders::draw::{MaskedVertex, ObjectsVertex};
use shaders::types::{Material, WRAP_BITS, WRAP_CLAMP, WRAP_MIRROR, WRAP_REPEAT};
use shaders::{draw, BufferRef};
use std::collections::HashMap;
use texels::Texels;

/// What textured stages read beside what all read.
pub(super) struct Detail {
    vertices: Buffer<MaskedVertex>,
    object_materials: Buffer<u32>,
    materials: Buffer<Material>,
    texels: Buffer<u32>,
}

impl Detail {
    /// Beside the vertices and objects of a world.
    pub(super) fn new(gpu: &Gpu, scene: &Scene, flat: &Flat) -> Result<Self> {
        let texels = Texels::new(scene);
        let (object_materials, materials) = materials(scene, &texels, &flat.scene_object);
        let vertices = vertices(scene, &flat.vertices, &flat.mesh_order);
        let storage = Placement::Storage;
        Ok(Detail {
            vertices: Buffer::with_data(gpu, "world.textured_vertices", &vertices, Placement::Geometry)?,
            object_materials: Buffer::with_data(gpu, "world.object_materials", &object_materials, storage)?,
            materials: Buffer::with_data(gpu, "world.materials", &materials, storage)?,
            texels: Buffer::with_data(gpu, "world.texels", &texels.all, storage)?,
        })
    }

    /// Positions and normals are those of all of the world's vertices, and change with them.
    pub(super) fn vertices(&self) -> BufferRef<MaskedVertex> {
        self.vertices.all()
    }

    fn dressed(&self, draw: IndexedIndirect) -> IndexedIndirect {
        IndexedIndirect { vertices: self.vertices.all().into(), ..draw }
    }

    fn parts(&self) -> (BufferRef<u32>, BufferRef<Material>, BufferRef<u32>) {
        (self.object_materials.all(), self.materials.all(), self.texels.all())
    }

    pub(super) fn draw(&self, f: &mut Frame, (draw, queried): MaybeQueried<'_>, view: &View, target: &Target) {
        let (object_materials, materials, texels) = self.parts();
        let (view, is_cut) = (view.gpu(), draw.surface == Surface::Masked);
        let draw = (self.dressed(draw), queried);
        match (is_cut, target.item.is_some()) {
            (false, false) => record(f, draw::Textured { object_materials, materials, texels, view }, draw, target),
            (false, true) => {
                record(f, draw::TexturedAndItems { object_materials, materials, texels, view }, draw, target)
            }
            (true, false) => record(f, draw::Masked { object_materials, materials, texels, view }, draw, target),
            (true, true) => record(f, draw::MaskedAndItems { object_materials, materials, texels, view }, draw, target),
        }
    }

    pub(super) fn draw_flagged(
        &self,
        f: &mut Frame,
        draw: IndexedIndirect,
        visible: BufferRef<u32>,
        view: &View,
        target: &Target,
    ) {
        let (object_materials, materials, texels) = self.parts();
        if draw.surface == Surface::Masked {
            // Colour and depth first, then who of them shows: see draw/masked_flags.
            self.draw(f, (draw, None), view, target);
            let stage = draw::MaskedFlags { object_materials, materials, texels, visible, view: view.gpu() };
            let test = Target { strictly_nearer: false, ..target.test_only() };
            f.draw_unshown(stage, self.dressed(draw), &test);
            return;
        }
        let (view, draw) = (view.gpu(), self.dressed(draw));
        if target.item.is_some() {
            let stage = draw::TexturedItemsAndFlags { object_materials, materials, texels, visible, view };
            f.draw(stage, draw, target);
        } else {
            f.draw(draw::TexturedAndFlags { object_materials, materials, texels, visible, view }, draw, target);
        }
    }

    /// Masked objects on a target that holds counts.
    pub(super) fn draw_counted(&self, f: &mut Frame, (draw, queried): MaybeQueried<'_>, view: &View, target: &Target) {
        let (object_materials, materials, texels) = self.parts();
        let stage = draw::MaskedOverdraw { object_materials, materials, texels, view: view.gpu() };
        record(f, stage, (self.dressed(draw), queried), target);
    }
}

fn vertices(scene: &Scene, plain: &[ObjectsVertex], mesh_order: &[usize]) -> Vec<MaskedVertex> {
    let byte = |channel: f32| (channel * 255.0).round() as u8;
    let extras = mesh_order.iter().map(|mesh| &scene.meshes[*mesh]).flat_map(|mesh| {
        (0..mesh.positions.len()).map(move |vertex| {
            let at = mesh.texture_coordinates.get(vertex).map_or([0.0; 2], |at| at.to_array());
            (at, mesh.colours.get(vertex).copied().unwrap_or([1.0; 4]))
        })
    });
    let dressed = |(plain, (coordinates, colour)): (&ObjectsVertex, ([f32; 2], [f32; 4]))| MaskedVertex {
        position: plain.position,
        normal_snorm16: plain.normal_snorm16,
        coordinates,
        tint: u32::from_le_bytes(colour.map(byte)),
        alpha: colour[3],
    };
    plain.iter().zip(extras).map(dressed).collect()
}

/// Each object's material, and all of them.
fn materials(scene: &Scene, texels: &Texels, scene_object: &[u32]) -> (Vec<u32>, Vec<Material>) {
    let mut materials = Vec::new();
    let mut known = HashMap::new();
    let of_meshes: Vec<VertexAlpha> = scene.meshes.iter().map(VertexAlpha::of).collect();
    let of_object = scene_object.iter().map(|object| {
        let object = &scene.objects[*object as usize];
        let (mesh, of_mesh) = (&scene.meshes[object.mesh as usize], of_meshes[object.mesh as usize]);
        // Without coordinates there is nothing to look up.
        let texture = object.surface.texture.filter(|_| !mesh.texture_coordinates.is_empty());
        let alpha = (f64::from(object.colour[3]) * f64::from(of_mesh.common)) as f32;
        let look = (texture, alpha.to_bits(), of_mesh.varies, object.surface.cutoff.to_bits());
        *known.entry(look).or_insert_with(|| {
            let (alpha_varies, cutoff) =
                (u32::from(of_mesh.varies), test_cutoff(object.surface.cutoff, of_mesh.varies));
            let plain = Material { alpha, alpha_varies, cutoff, ..Material::default() };
            let placed = texture.map(|texture| (texels.places[texture as usize], &scene.textures[texture as usize]));
            materials.push(placed.map_or(plain, |(place, texture)| {
                let [x, y] = texture.wrap.map(wrap_mode);
                let [width, height] = place.size;
                let (first_texel, levels) = (place.first, place.levels);
                Material { first_texel, width, height, levels, wrap: x | y << WRAP_BITS, ..plain }
            }));
            (materials.len() - 1) as u32
        })
    });
    (of_object.collect(), materials)
}

/// The alpha of a mesh's vertices.
#[derive(Clone, Copy)]
struct VertexAlpha {
    /// The alpha of all vertices where it is the same, else 1.
    common: f32,
    /// Vertices differ in alpha.
    varies: bool,
}

impl VertexAlpha {
    fn of(mesh: &Mesh) -> Self {
        let first = mesh.colours.first().map_or(1.0, |colour| colour[3]);
        let varies = mesh.colours.iter().any(|colour| colour[3] != first);
        VertexAlpha { common: if varies { 1.0 } else { first }, varies }
    }
}

/// Returns the alpha from which on a fragment is there. The device rounds alpha, so its test must allow for the error: a surface must
/// be there where its exact alpha is at least the cutoff.
///
/// Alpha is the product of a factor, of the vertices' alpha and of a texel, all at most 1. With u = 2^-24, half a step of `f32` at 1:
/// - The file's cutoff and factor, the vertices' alpha and their product with the factor are each rounded once: 4 u.
/// - A texel is n / 255 within 2.5 steps, 5 u (Vulkan's precision of a division). Bilinear interpolation rounds three times in each of
///   two directions, and the second direction takes over the error of the first: 5 u + 3 u + 3 u = 11 u. Texels that are equal stay so.
/// - Two products on the device: 2 u.
///
/// Together 17 u, less than 2^-19. The device interpolates vertices of different alpha, and Vulkan states no precision for that.
/// Devices evaluate planes of alpha / w and 1 / w over the triangle: each rounds by a few u of its largest value in the triangle, which
/// may be w_max / w_min times the value at the fragment. 2^-10, a quarter of a step of 8 bits, allows 8 u for a triangle whose farthest
/// corner is 2,048 times as far as its nearest.
///
/// A cutoff below the error would cut nothing. Half of it is kept, so that alpha 0 stays a hole.
fn test_cutoff(cutoff: f32, varies: bool) -> f32 {
    const ROUNDING: f32 = 1.0 / (1u32 << 19) as f32;
    const INTERPOLATION: f32 = 1.0 / (1u32 << 10) as f32;
    let error = if varies { INTERPOLATION } else { ROUNDING };
    (cutoff - error).max(0.5 * cutoff)
}

fn wrap_mode(wrap: Wrap) -> u32 {
    match wrap {
        Wrap::Repeat => WRAP_REPEAT,
        Wrap::Mirror => WRAP_MIRROR,
        Wrap::Clamp => WRAP_CLAMP,
    }
}
