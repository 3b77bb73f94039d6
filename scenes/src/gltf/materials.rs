//! Materials: what of them decides colours, and where a surface leaves fragments. Pictures are decoded by the `image` crate.
//!
//! A texture that cannot be read costs no more than itself: a warning says why, and the surface has its plain colour.

use super::accessor::{Accessors, Allowed};
use super::buffers;
use super::document::Document;
use super::fault::{broken, element, label, one_line, Outcome};
use super::pictures;
use crate::model::{Mesh, Surface};
use crate::texture::{Texture, Wrap};
use glam::{Mat2, Vec2};
use gltf::json::image::Image;
use gltf::json::material::{AlphaMode, Material};
use gltf::json::mesh::{Primitive, Semantic};
use gltf::json::texture::{Info, Sampler, Texture as FileTexture, WrappingMode};
use gltf::json::validation::Checked;
use gltf::json::Index;
use std::collections::{HashMap, HashSet};
use std::path::Path;

/// Most bytes of all decoded textures together: what every Vulkan device can bind as one buffer is a quarter of that, and what is
/// larger is halved there.
const MOST_TEXELS: usize = 1 << 27;

/// What a primitive's material says.
#[derive(Clone, Copy)]
pub(super) struct Look {
    pub colour: [f32; 4],
    pub translucent: bool,
    pub masked: bool,
    pub surface: Surface,
}

/// Reads materials, and the textures that they need, once each.
pub(super) struct Materials<'a> {
    document: &'a Document<'a>,
    accessors: &'a Accessors<'a>,
    folder: &'a Path,
    /// What has been read so far.
    pub textures: Vec<Texture>,
    /// What became of each texture of the file; of one with alpha of 16 bits for each alpha from which on a surface is there, as bits.
    texture_of: HashMap<(Index<FileTexture>, Option<u64>), Option<u32>>,
    /// Textures of the file whose alpha has 16 bits.
    fine: HashSet<Index<FileTexture>>,
    texels: usize,
}

impl<'a> Materials<'a> {
    pub(super) fn new(document: &'a Document, accessors: &'a Accessors<'a>, folder: &'a Path) -> Self {
        let (texture_of, fine) = (HashMap::new(), HashSet::new());
        Materials { document, accessors, folder, textures: Vec::new(), texture_of, fine, texels: 0 }
    }

    /// The look of a primitive whose mesh has been read; gives the mesh what its material needs.
    pub(super) fn apply(&mut self, primitive: &Primitive, mesh: &mut Mesh) -> Outcome<Look> {
        let surface = Surface { single_sided: true, ..Surface::default() };
        let mut look = Look { colour: [1.0; 4], translucent: false, masked: false, surface };
        mesh.colours = self.vertex_colours(primitive, mesh);
        let Some(index) = primitive.material else { return Ok(look) };
        let material = element(&self.document.root, index, "material")?;
        look.colour = material.pbr_metallic_roughness.base_color_factor.0.map(|channel| channel.clamp(0.0, 1.0));
        look.surface.single_sided = !material.double_sided;
        (look.translucent, look.masked) = self.alpha_mode(index, material)?;
        if let Some(cutoff) = material.alpha_cutoff.filter(|cutoff| cutoff.0.is_finite()) {
            look.surface.cutoff = cutoff.0;
        }
        if let Some(info) = &material.pbr_metallic_roughness.base_color_texture {
            // Coordinates first: without them there is no use for the texture.
            look.surface.texture = self.coordinates(primitive, info, mesh).and_then(|coordinates| {
                let least = look.masked.then(|| least_alpha(&look, mesh));
                let texture = self.texture(info.index, least)?;
                mesh.texture_coordinates = coordinates;
                Some(texture)
            });
        }
        Ok(look)
    }

    fn alpha_mode(&self, index: Index<Material>, material: &Material) -> Outcome<(bool, bool)> {
        match material.alpha_mode {
            Checked::Valid(AlphaMode::Opaque) => Ok((false, false)),
            Checked::Valid(AlphaMode::Blend) => Ok((true, false)),
            Checked::Valid(AlphaMode::Mask) => Ok((false, true)),
            Checked::Invalid => {
                let other = self.document.said(&format!("/materials/{index}/alphaMode"));
                let material = label("material", index.value(), material.name.as_deref());
                broken(format!("{material}: its alphaMode '{other}' is none of OPAQUE, MASK and BLEND"))
            }
        }
    }

    fn vertex_colours(&self, primitive: &Primitive, mesh: &Mesh) -> Vec<[f32; 4]> {
        let Some(&index) = primitive.attributes.get(&Checked::Valid(Semantic::Colors(0))) else { return Vec::new() };
        let read = self.accessors.vectors::<4>(index, Allowed::Normalized).or_else(|_| {
            let opaque = |[red, green, blue]: [f32; 3]| [red, green, blue, 1.0];
            Ok(self.accessors.vectors::<3>(index, Allowed::Normalized)?.into_iter().map(opaque).collect())
        });
        // A channel that is not a number is 0.
        let within = |channel: f32| if channel > 0.0 { channel.min(1.0) } else { 0.0 };
        usable(read.map(|colours| colours.into_iter().map(|all| all.map(within)).collect()), mesh, "COLOR_0")
    }

    /// Texture coordinates as the texture is stored: KHR_texture_transform is done here.
    fn coordinates(&self, primitive: &Primitive, info: &Info, mesh: &Mesh) -> Option<Vec<Vec2>> {
        let transform = info.extensions.as_ref().and_then(|extensions| extensions.texture_transform.as_ref());
        let set = transform.and_then(|transform| transform.tex_coord).unwrap_or(info.tex_coord);
        let index = *primitive.attributes.get(&Checked::Valid(Semantic::TexCoords(set)))?;
        let transformed = |at: [f32; 2]| match transform {
            None => Vec2::from(at),
            Some(transform) => {
                let (sin, cos) = transform.rotation.0.sin_cos();
                let turn = Mat2::from_cols(Vec2::new(cos, -sin), Vec2::new(sin, cos));
                turn * (Vec2::from(at) * Vec2::from(transform.scale.0)) + Vec2::from(transform.offset.0)
            }
        };
        let read = self.accessors.vectors::<2>(index, Allowed::Quantized).and_then(|coordinates| {
            let coordinates: Vec<Vec2> = coordinates.into_iter().map(transformed).collect();
            match coordinates.iter().all(|at| at.is_finite()) {
                true => Ok(coordinates),
                false => broken("not all of them are finite"),
            }
        });
        Some(usable(read, mesh, &format!("TEXCOORD_{set}"))).filter(|coordinates| !coordinates.is_empty())
    }

    /// A texture for surfaces that are there from a texel's alpha of `least` on; none for surfaces without an alpha test.
    fn texture(&mut self, index: Index<FileTexture>, least: Option<f64>) -> Option<u32> {
        let bits = |fine: bool| least.filter(|_| fine).map(f64::to_bits);
        if let Some(known) = self.texture_of.get(&(index, bits(self.fine.contains(&index)))) {
            return *known;
        }
        let read =
            self.read_texture(index, least).map_err(|fault| tracing::warn!("texture {index} is not drawn: {fault}"));
        let is_fine = read.as_ref().is_ok_and(|(_, is_fine)| *is_fine);
        let texture = read.ok().map(|(texture, _)| {
            self.textures.push(texture);
            // At most one for each texture of the file and each of its materials.
            (self.textures.len() - 1) as u32
        });
        if is_fine {
            self.fine.insert(index);
        }
        self.texture_of.insert((index, bits(is_fine)), texture);
        texture
    }

    /// Reads the first readable image of a texture. The fault is that of the first image.
    fn read_texture(&mut self, index: Index<FileTexture>, least: Option<f64>) -> Result<(Texture, bool), String> {
        let root = &self.document.root;
        let texture = element(root, index, "texture").map_err(|fault| fault.to_line())?;
        let mut first_fault = None;
        for source in pictures::sources(texture)? {
            match self.picture(texture, source, least) {
                Ok((mut read, is_fine)) => {
                    let sampler = texture.sampler.and_then(|index| element(root, index, "sampler").ok());
                    read.wrap = sampler.map_or_else(Default::default, wrap);
                    return Ok((read, is_fine));
                }
                Err(fault) => first_fault.get_or_insert(fault),
            };
        }
        Err(first_fault.unwrap_or_default())
    }

    fn picture(
        &mut self,
        texture: &FileTexture,
        source: Index<Image>,
        least: Option<f64>,
    ) -> Result<(Texture, bool), String> {
        let image = element(&self.document.root, source, "image").map_err(|fault| fault.to_line())?;
        let bytes = match (&image.uri, image.buffer_view) {
            (Some(uri), _) => buffers::fetch(uri, LARGEST_PICTURE, self.folder).map_err(|fault| fault.to_line())?,
            (None, Some(view)) => self.accessors.view(view).map_err(|fault| fault.to_line())?.to_vec(),
            (None, None) => return Err("its image has no data".into()),
        };
        let name = image.name.as_deref().or(texture.name.as_deref()).map(|name| one_line(name, 200));
        if let Some(format) = pictures::unread(&bytes) {
            return Err(format!("its format, {format}, is not read; export the scene with PNG, JPEG or WebP textures"));
        }
        // Texels are counted before decoding: a picture that is broken near its end costs as much time as a whole one.
        self.texels = self.texels.saturating_add(Texture::texels_of(&bytes)?);
        if self.texels > MOST_TEXELS {
            return Err(format!("the file has more than {MOST_TEXELS} texels"));
        }
        Texture::decode_for(name.unwrap_or_else(|| format!("image {source}")), &bytes, least)
    }
}

/// The alpha of a texel from which on a masked surface is there, where the alpha of its vertices is the same for all.
fn least_alpha(look: &Look, mesh: &Mesh) -> f64 {
    let vertices = mesh.colours.first().map_or(1.0, |colour| colour[3]);
    let vertices = if mesh.colours.iter().all(|colour| colour[3] == vertices) { vertices } else { 1.0 };
    f64::from(look.surface.cutoff) / (f64::from(look.colour[3]) * f64::from(vertices))
}

/// Longest file of a picture, in bytes.
const LARGEST_PICTURE: u64 = 1 << 28;

fn wrap(sampler: &Sampler) -> [Wrap; 2] {
    [&sampler.wrap_s, &sampler.wrap_t].map(|mode| match mode {
        Checked::Valid(WrappingMode::ClampToEdge) => Wrap::Clamp,
        Checked::Valid(WrappingMode::MirroredRepeat) => Wrap::Mirror,
        Checked::Valid(WrappingMode::Repeat) | Checked::Invalid => Wrap::Repeat,
    })
}

/// An attribute that the mesh can do without, if it is broken: a warning says so.
fn usable<T>(read: Outcome<Vec<T>>, mesh: &Mesh, attribute: &str) -> Vec<T> {
    let fault = match read {
        Ok(values) if values.len() == mesh.positions.len() => return values,
        Ok(values) => format!("it has {} elements, but there are {} positions", values.len(), mesh.positions.len()),
        Err(fault) => fault.to_line(),
    };
    tracing::warn!("mesh '{}' is drawn without its {attribute}: {fault}", mesh.name);
    Vec::new()
}
