//! Textures with their levels of detail, in one buffer.

use scenes::Scene;

/// Most texels of all textures and their levels together: 128 MiB, which Vulkan promises that a stage can bind as one buffer.
const MOST_TEXELS: usize = 1 << 25;

/// Where a texture lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Place {
    /// Its first texel; each level follows the one before.
    pub(super) first: u32,
    /// Of its finest level that is kept.
    pub(super) size: [u32; 2],
    /// Levels that are kept, > 0.
    pub(super) levels: u32,
}

/// All textures' texels.
pub(super) struct Texels {
    /// RGBA8 each.
    pub(super) all: Vec<u32>,
    /// By texture.
    pub(super) places: Vec<Place>,
}

impl Texels {
    pub(super) fn new(scene: &Scene) -> Self {
        let sizes: Vec<[u32; 2]> = scene.textures.iter().map(|texture| texture.size).collect();
        let left_out = left_out(&sizes, MOST_TEXELS);
        if left_out.iter().any(|levels| *levels > 0) {
            let name = &scene.name;
            tracing::warn!(
                "{name}: its textures do not fit into {MOST_TEXELS} texels; the largest are drawn at half size or less"
            );
        }
        let (mut all, mut places) = (Vec::new(), Vec::new());
        for (texture, left_out) in scene.textures.iter().zip(left_out) {
            let (mut size, mut level) = (texture.size, texture.texels.clone());
            for _ in 0..left_out {
                (level, size) = (halved(&level, size), half(size));
            }
            let mut place = Place { first: all.len() as u32, size, levels: 0 };
            loop {
                all.extend(level.iter().map(|texel| u32::from_le_bytes(*texel)));
                place.levels += 1;
                if size == [1, 1] {
                    break;
                }
                (level, size) = (halved(&level, size), half(size));
            }
            places.push(place);
        }
        Texels { all, places }
    }
}

fn half(size: [u32; 2]) -> [u32; 2] {
    size.map(|side| (side / 2).max(1))
}

/// Texels of a level and all after it.
fn texels_from(mut size: [u32; 2]) -> usize {
    let mut texels = size[0] as usize * size[1] as usize;
    while size != [1, 1] {
        size = half(size);
        texels += size[0] as usize * size[1] as usize;
    }
    texels
}

/// How many of each texture's finest levels must be left out for all to fit: of the largest first.
fn left_out(sizes: &[[u32; 2]], most: usize) -> Vec<u32> {
    let mut kept = sizes.to_vec();
    let mut left_out = vec![0; sizes.len()];
    while kept.iter().map(|size| texels_from(*size)).sum::<usize>() > most {
        let large = (0..kept.len()).filter(|texture| kept[*texture] != [1, 1]);
        let Some(largest) = large.max_by_key(|texture| texels_from(kept[*texture])) else { break };
        kept[largest] = half(kept[largest]);
        left_out[largest] += 1;
    }
    left_out
}

/// The next level: the mean of four texels each, colours weighted by alpha, so that what is not there lends no colour.
fn halved(level: &[[u8; 4]], [width, height]: [u32; 2]) -> Vec<[u8; 4]> {
    let [half_width, half_height] = half([width, height]);
    let texel = |x: u32, y: u32| level[(y.min(height - 1) * width + x.min(width - 1)) as usize].map(u32::from);
    let mean = |x: u32, y: u32| {
        let four = [texel(2 * x, 2 * y), texel(2 * x + 1, 2 * y), texel(2 * x, 2 * y + 1), texel(2 * x + 1, 2 * y + 1)];
        let alpha: u32 = four.iter().map(|texel| texel[3]).sum();
        let weight = |texel: &[u32; 4]| if alpha == 0 { 1 } else { texel[3] };
        let weights: u32 = four.iter().map(weight).sum();
        let colour = |channel: usize| {
            (four.iter().map(|texel| texel[channel] * weight(texel)).sum::<u32>() + weights / 2) / weights
        };
        [colour(0), colour(1), colour(2), (alpha + 2) / 4].map(|channel| channel as u8)
    };
    (0..half_height).flat_map(|y| (0..half_width).map(move |x| (x, y))).map(|(x, y)| mean(x, y)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use scenes::Texture;

    fn scene(sizes: &[[u32; 2]]) -> Scene {
        let texture = |size: &[u32; 2]| Texture {
            size: *size,
            texels: (0..size[0] * size[1]).map(|texel| [texel as u8, 0, 0, 255]).collect(),
            ..Texture::default()
        };
        Scene { textures: sizes.iter().map(texture).collect(), ..Scene::default() }
    }

    #[test]
    fn every_texture_has_all_its_levels_where_its_place_says() {
        let texels = Texels::new(&scene(&[[4, 2], [3, 5], [1, 1]]));
        // 8 + 2 + 1, 15 + 2 + 1, 1.
        assert_eq!(
            texels.places.iter().map(|place| (place.first, place.levels)).collect::<Vec<_>>(),
            [(0, 3), (11, 3), (29, 1)]
        );
        assert_eq!(texels.all.len(), 30);
        // The mean of 0, 1, 4 and 5.
        assert_eq!(texels.all[8] & 0xff, 3);
    }

    #[test]
    fn what_is_not_there_lends_no_colour() {
        let level = [[200, 100, 0, 255], [0, 0, 0, 0], [0, 0, 0, 0], [0, 0, 0, 0]];
        assert_eq!(halved(&level, [2, 2]), [[200, 100, 0, 64]]);
        assert_eq!(halved(&[[8, 4, 2, 0]; 4], [2, 2]), [[8, 4, 2, 0]]);
    }

    #[test]
    fn too_large_textures_lose_levels_until_they_fit() {
        let sizes = [[64, 64], [16, 16], [1, 1]];
        assert_eq!(left_out(&sizes, usize::MAX), [0, 0, 0]);
        let left = left_out(&sizes, 700);
        assert_eq!(left, [2, 0, 0], "the largest first");
        assert_eq!(left_out(&sizes, 0), [6, 4, 0], "one texel of each is always kept");
    }
}
