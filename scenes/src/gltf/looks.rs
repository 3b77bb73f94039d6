//! Materials of extensions, rewritten as core materials before they are read: base colour, its texture, alpha.

use gltf::json::extensions::material::Material as Extensions;
use gltf::json::material::{AlphaMode, Material, PbrBaseColorFactor};
use gltf::json::texture::Info;
use gltf::json::validation::Checked::Valid;
use serde::Deserialize;
use serde_json::Value;

/// The part of KHR_materials_pbrSpecularGlossiness that decides base colour and holes.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct SpecularGlossiness {
    #[serde(default = "white")]
    diffuse_factor: [f32; 4],
    diffuse_texture: Option<Info>,
}

fn white() -> [f32; 4] {
    [1.0; 4]
}

/// The factor that KHR_materials_transmission and ADOBE_materials_thin_transparency share.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Transmission {
    #[serde(default)]
    transmission_factor: f32,
}

/// Reads the extensions of each material. An extension with broken data is ignored with a warning.
pub(super) fn settle(materials: &mut [Material]) {
    for (index, material) in materials.iter_mut().enumerate() {
        let Some(extensions) = material.extensions.take() else { continue };
        if let Some(specular) = read::<SpecularGlossiness>(index, &extensions, "KHR_materials_pbrSpecularGlossiness") {
            let pbr = &mut material.pbr_metallic_roughness;
            pbr.base_color_factor = PbrBaseColorFactor(specular.diffuse_factor);
            pbr.base_color_texture = specular.diffuse_texture;
        }
        for name in ["KHR_materials_transmission", "ADOBE_materials_thin_transparency"] {
            if let Some(transmission) = read::<Transmission>(index, &extensions, name) {
                transmit(material, transmission.transmission_factor);
            }
        }
        material.extensions = Some(extensions);
    }
}

fn read<T: for<'a> Deserialize<'a>>(index: usize, extensions: &Extensions, name: &str) -> Option<T> {
    let value = extensions.others.get(name).filter(|value| **value != Value::Null)?;
    let warn = |error: serde_json::Error| tracing::warn!("material {index} is drawn without its {name}: {error}");
    T::deserialize(value).map_err(warn).ok()
}

/// Blends a surface that transmits light, as it hides nothing. Light from behind passes it times factor and base colour. Blending has
/// one alpha for all channels, so the mean of the channels passes: clear glass is not there, black glass is opaque.
///
/// A transmission texture is not read: all of the surface is blended.
fn transmit(material: &mut Material, factor: f32) {
    // A NaN factor counts as 0.
    let transmits = factor > 0.0;
    if !transmits || material.alpha_mode == Valid(AlphaMode::Mask) {
        return;
    }
    let PbrBaseColorFactor(colour) = &mut material.pbr_metallic_roughness.base_color_factor;
    let mean = colour[..3].iter().map(|channel| channel.clamp(0.0, 1.0)).sum::<f32>() / 3.0;
    // Alpha means nothing in opaque materials.
    let coverage = if material.alpha_mode == Valid(AlphaMode::Opaque) { 1.0 } else { colour[3] };
    colour[3] = coverage * (1.0 - factor.min(1.0) * mean);
    material.alpha_mode = Valid(AlphaMode::Blend);
}
