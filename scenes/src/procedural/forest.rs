//! Forest: trees, bushes and ferns whose leaves are textures with holes, stones and mushrooms below them, and crystals of glass. Ours, no
//! paper's: what hides is full of holes, and what is drawn is mostly masked.

use super::detail::Detail;
use super::nature::{Nature, CAPS, GLASS, STONE};
use super::random::Random;
use super::terrain::{Terrain, TILE};
use super::{camera, count, lane, posed, shade, Assembly, SceneOptions};
use crate::model::{Mesh, Object, Scene, Surface, Walk};
use crate::texture::{Texture, Wrap};
use glam::{DVec3, Mat3, Vec2, Vec3};
use std::f64::consts::TAU;

/// Objects at scale 1.
const OBJECTS: usize = 12_000;
const LEAST_OBJECTS: usize = 60;
/// Ground for an object, in square metres.
const ROOM: f64 = 3.2;
const EYE: f64 = 1.7;
/// How far the walk goes at speed 1, in metres.
const WALK: f64 = 60.0;
/// Edge of a leaf texture in texels.
const TEXELS: u32 = 128;
const BARK: [[f32; 3]; 3] = [[0.32, 0.24, 0.17], [0.4, 0.33, 0.26], [0.26, 0.22, 0.2]];
/// What leaf textures, which are bright, are multiplied by.
const LEAVES: [[f32; 3]; 4] = [[0.42, 0.75, 0.3], [0.55, 0.8, 0.32], [0.3, 0.62, 0.34], [0.85, 0.7, 0.25]];

/// Textures by index.
const BROAD: u32 = 0;
const FROND: u32 = 1;

struct Builder {
    assembly: Assembly,
    random: Random,
    terrain: Terrain,
    way: Vec<DVec3>,
    nature: Nature,
    trunk: u32,
    crowns: [u32; 3],
    bush: u32,
    fern: u32,
    /// Half the edge of the land in metres.
    half: f64,
}

pub(super) fn make(options: &SceneOptions) -> Scene {
    let target = count(OBJECTS, options.scale, LEAST_OBJECTS);
    let mut random = Random::new(options.seed, 0);
    let tiles = ((target as f64 * ROOM).sqrt() / TILE).round().max(2.0) as usize;
    let half = 0.5 * tiles as f64 * TILE;
    let terrain = Terrain::new(&mut random, 7.0, [0.0, 0.0]);
    let way = lane::ring(DVec3::ZERO, 0.5 * half, random.range(0.0, TAU), |at| terrain.height(at.x, at.z) + EYE);
    let mut assembly = Assembly::new("forest");
    assembly.scene.textures = vec![leaves(&mut random), fronds()];
    let detail = Detail::default();
    let nature = Nature::new(&mut assembly, detail, 6);
    let trunk = assembly.built("trunk", detail, |parts| {
        parts.lathe([0.0, -0.5, 0.0], &[[0.0, 0.0], [0.34, 0.0], [0.2, 1.2], [0.14, 6.0], [0.0, 6.5]], 7);
    });
    let crowns = [0, 1, 2].map(|_| {
        let cards = crown(&mut random, 22, Vec3::new(2.3, 1.9, 2.3), Vec3::Y * 5.6, 1.9);
        assembly.mesh(cards)
    });
    let bush = assembly
        .mesh(Mesh { name: "bush".into(), ..crown(&mut random, 9, Vec3::new(0.6, 0.4, 0.6), Vec3::Y * 0.5, 1.0) });
    let fern = assembly.mesh(fern());
    terrain.place(&mut assembly, &mut random, detail, tiles, [0.3, 0.33, 0.16]);
    let mut builder = Builder { assembly, random, terrain, way, nature, trunk, crowns, bush, fern, half };
    while builder.assembly.len() < target {
        builder.grow();
    }
    let walk = Walk { points: builder.way, length: WALK, clearance: 0.5 };
    let mut scene = builder.assembly.scene;
    scene.objects.truncate(target);
    scene.cameras = vec![camera("path", &walk, 0.1, 4.0 * half + 100.0)];
    scene.walk = Some(walk);
    scene
}

impl Builder {
    /// One thing, or a tree of two, somewhere on the land and off the way.
    fn grow(&mut self) {
        let most = self.half - 3.0;
        let (x, z) = (self.random.range(-most, most), self.random.range(-most, most));
        let at = self.terrain.on(x, z);
        let (kind, size, angle) = (self.random.below(12), self.random.range(0.7, 1.4), self.random.range(0.0, TAU));
        let radius = match kind {
            0..=3 => 4.6,
            4..=5 => 1.6,
            _ => 1.3,
        };
        if lane::level_distance(&self.way, at) <= radius * size + 0.8 {
            return;
        }
        let place = posed(at - DVec3::Y * 0.05 * size, angle, DVec3::splat(size));
        let mut pick = |palette: &[[f32; 3]]| {
            let colour = self.random.pick(palette);
            shade(&mut self.random, colour, 0.3)
        };
        match kind {
            0..=3 => {
                let (bark, leaf) = (pick(&BARK), pick(&LEAVES));
                let crown = self.random.pick(&self.crowns);
                self.assembly.place(self.trunk, bark, place);
                self.leafy(crown, leaf, BROAD, place);
            }
            4..=5 => {
                let leaf = pick(&LEAVES);
                self.leafy(self.bush, leaf, BROAD, place);
            }
            6..=8 => {
                let leaf = pick(&LEAVES);
                self.leafy(self.fern, leaf, FROND, place);
            }
            9 => {
                let stone = pick(&STONE);
                let mesh = self.random.pick(&self.nature.stones);
                self.assembly.place(mesh, stone, posed(at, angle, DVec3::splat(0.5 * size)));
            }
            10 => {
                let cap = pick(&CAPS);
                self.assembly.place(self.nature.mushroom, cap, posed(at, angle, DVec3::splat(0.6 * size)));
            }
            _ => {
                let glass = pick(&GLASS);
                self.assembly.place(self.nature.crystal, glass, posed(at, angle, DVec3::splat(0.8 * size)));
                if let Some(crystal) = self.assembly.scene.objects.last_mut() {
                    (crystal.translucent, crystal.colour[3]) = (true, 0.55);
                }
            }
        }
    }

    fn leafy(&mut self, mesh: u32, colour: [f32; 3], texture: u32, place: glam::DAffine3) {
        self.assembly.place(mesh, colour, place);
        if let Some(Object { masked, surface, .. }) = self.assembly.scene.objects.last_mut() {
            (*masked, *surface) = (true, Surface { texture: Some(texture), ..Surface::default() });
        }
    }
}

/// A mesh of square cards with a texture each.
#[derive(Default)]
struct Cards(Mesh);

impl Cards {
    /// A card about a middle, its sides `2 right` and `2 up` long.
    fn card(&mut self, middle: Vec3, right: Vec3, up: Vec3) {
        let Cards(mesh) = self;
        let first = mesh.positions.len() as u32;
        let normal = right.cross(up).normalize_or(Vec3::Y);
        for [x, y] in [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]] {
            mesh.positions.push(middle + right * x + up * y);
            mesh.normals.push(normal);
            mesh.texture_coordinates.push(Vec2::new(0.5 + 0.5 * x, 0.5 - 0.5 * y));
        }
        mesh.indices.extend([0, 1, 2, 0, 2, 3].map(|corner| first + corner));
    }
}

/// Cards by chance in an ellipsoid, each turned outward by and large.
fn crown(random: &mut Random, cards: usize, radii: Vec3, middle: Vec3, size: f32) -> Mesh {
    let mut made = Cards::default();
    made.0.name = "crown".into();
    for card in 0..cards {
        // A spiral from bottom to top, and chance.
        let height = 2.0 * (card as f32 + 0.5) / cards as f32 - 1.0;
        let angle = 2.4 * card as f32 + random.range(-0.4, 0.4) as f32;
        let across = (1.0 - height * height).sqrt();
        let out = Vec3::new(across * angle.cos(), height, across * angle.sin());
        let tilt = Mat3::from_rotation_y(random.range(-0.7, 0.7) as f32);
        let facing = (tilt * out + Vec3::Y * 0.2).normalize_or(Vec3::Y);
        let right = facing.cross(Vec3::Y).normalize_or(Vec3::X);
        let half = 0.5 * size * random.range(0.8, 1.2) as f32;
        made.card(middle + radii * out * 0.75, right * half, right.cross(facing) * half);
    }
    made.0
}

/// Three cards that stand across one another and lean out.
fn fern() -> Mesh {
    let mut made = Cards::default();
    made.0.name = "fern".into();
    for card in 0..5 {
        let angle = card as f32 * 1.2566;
        let out = Vec3::new(angle.cos(), 0.0, angle.sin());
        let right = out.cross(Vec3::Y) * 0.35;
        made.card(out * 0.35 + Vec3::Y * 0.38, right, (out * 0.5 + Vec3::Y * 0.7).normalize() * 0.45);
    }
    made.0
}

fn texture(name: &str, texel: impl Fn(f32, f32) -> [u8; 4]) -> Texture {
    let at = |texel: u32| (texel as f32 + 0.5) / TEXELS as f32 * 2.0 - 1.0;
    let texels = (0..TEXELS * TEXELS).map(|index| texel(at(index % TEXELS), at(index / TEXELS)));
    Texture { name: name.into(), size: [TEXELS; 2], texels: texels.collect(), wrap: [Wrap::Clamp; 2] }
}

/// Many pointed leaves by chance within a circle.
fn leaves(random: &mut Random) -> Texture {
    let leaf: Vec<[f32; 5]> = (0..70)
        .map(|_| {
            let (angle, distance) = (random.range(0.0, TAU), 0.82 * random.unit().sqrt());
            let (x, y) = (distance * angle.cos(), distance * angle.sin());
            let turn = random.range(0.0, TAU);
            [x, y, turn.cos(), turn.sin(), random.range(0.55, 1.0)].map(|part| part as f32)
        })
        .collect();
    texture("leaves", |x, y| {
        // Leaves that come later lie over those before.
        let top = leaf.iter().rev().find_map(|[at_x, at_y, cos, sin, bright]| {
            let (dx, dy) = (x - at_x, y - at_y);
            let (along, across) = ((dx * cos + dy * sin) / 0.17, (dy * cos - dx * sin).abs() / 0.075);
            let inside = along.abs() < 1.0 && across < 1.0 - along * along;
            inside.then_some(if across < 0.12 { 0.75 * bright } else { *bright })
        });
        let shade = |bright: f32| (bright * 255.0) as u8;
        top.map_or([90, 110, 80, 0], |bright| [shade(bright * 0.95), shade(bright), shade(bright * 0.85), 255])
    })
}

/// One frond: a stem with leaflets to both sides.
fn fronds() -> Texture {
    texture("fronds", |x, y| {
        let up = 0.5 - 0.5 * y;
        let reach = 0.95 * (1.0 - up).powf(0.7) * (0.35 + up).min(1.0);
        let leaflet = (up * 16.0 + x.abs() * 3.0).fract();
        let inside = x.abs() < 0.03 || (x.abs() < reach && leaflet < 0.62);
        let bright = (150.0 + 90.0 * leaflet) as u8;
        [bright, (bright as f32 * 1.05) as u8, bright / 2 + 60, if inside { 255 } else { 0 }]
    })
}
