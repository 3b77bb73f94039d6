//! A name is one world, in every version: a failure that names `near-plane/3` can be run again. One line a family, in `golden.txt`.

use super::{worlds, Drill, DrillId, CHANCE, FAMILIES};
use glam::DAffine3;
use scenes::{Mesh, Motion, Object, Scene, Shot};
use std::fmt::Write;

/// FNV-1a over the numbers of a world. They are rounded to `f32`, as sines may differ in their last bits from library to library.
struct Sum(u64);

impl Sum {
    fn add(&mut self, bits: u64) {
        for byte in bits.to_le_bytes() {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }

    fn numbers(&mut self, numbers: impl IntoIterator<Item = f64>) {
        numbers.into_iter().for_each(|number| self.add(u64::from((number as f32).to_bits())));
    }

    fn floats(&mut self, numbers: impl IntoIterator<Item = f32>) {
        self.numbers(numbers.into_iter().map(f64::from));
    }

    fn text(&mut self, text: &str) {
        text.bytes().for_each(|byte| self.add(u64::from(byte)));
    }

    fn place(&mut self, place: &DAffine3) {
        self.numbers(place.to_cols_array());
    }

    fn object(&mut self, object: &Object) {
        self.text(&object.name);
        self.place(&object.world_from_object);
        self.floats(object.colour);
        let flags = [object.dynamic, object.translucent, object.masked, object.surface.single_sided];
        flags.into_iter().for_each(|flag| self.add(u64::from(flag)));
        self.add(u64::from(object.mesh));
        self.add(object.surface.texture.map_or(u64::MAX, u64::from));
        self.floats([object.surface.cutoff]);
    }

    fn mesh(&mut self, mesh: &Mesh) {
        self.text(&format!("{} {:?}", mesh.name, mesh.topology));
        mesh.positions.iter().chain(&mesh.normals).for_each(|place| self.floats(place.to_array()));
        mesh.indices.iter().for_each(|index| self.add(u64::from(*index)));
        if let Some(bounds) = mesh.declared_bounds {
            self.text(&format!("{bounds:?}"));
        }
        mesh.texture_coordinates.iter().for_each(|place| self.floats(place.to_array()));
        mesh.colours.iter().for_each(|colour| self.floats(*colour));
    }

    fn scene(&mut self, scene: &Scene) {
        scene.objects.iter().for_each(|object| self.object(object));
        scene.meshes.iter().for_each(|mesh| self.mesh(mesh));
        for texture in &scene.textures {
            self.text(&format!("{:?} {:?}", texture.size, texture.wrap));
            texture.texels.iter().flatten().for_each(|byte| self.add(u64::from(*byte)));
        }
        if let Motion::Orbits(orbits) = &scene.motion {
            for orbit in orbits {
                self.add(u64::from(orbit.object));
                self.place(&orbit.base);
                [orbit.centre, orbit.axis, orbit.bob].iter().for_each(|vector| self.numbers(vector.to_array()));
                self.numbers([orbit.radians_per_s, orbit.bob_period_s]);
            }
        }
    }

    fn shot(&mut self, shot: &Shot) {
        self.numbers(shot.pose.position.to_array());
        self.numbers(shot.pose.rotation.to_array());
        self.numbers(shot.projection.clip_from_view(1.5).to_cols_array());
        self.numbers([shot.seconds]);
    }

    fn drill(&mut self, drill: &Drill) {
        // Bodies that bend come from the generators of `scenes`, which are that room's.
        if drill.case.scene.deformed.is_empty() {
            self.scene(&drill.case.scene);
        }
        drill.case.shots.iter().for_each(|shot| self.shot(shot));
        drill.sizes.iter().chain([&drill.case.size]).flatten().for_each(|side| self.add(u64::from(*side)));
        drill.forgets.iter().for_each(|frame| self.add(*frame as u64));
    }
}

fn line(text: &mut String, name: &str, drills: &[Drill]) {
    let mut sum = Sum(0xcbf2_9ce4_8422_2325);
    drills.iter().for_each(|drill| sum.drill(drill));
    let (objects, frames) = drills.iter().fold((0, 0), |(objects, frames), drill| {
        (objects + drill.case.scene.objects.len(), frames + drill.case.shots.len())
    });
    // Writing to a string does not fail.
    let _ =
        writeln!(text, "{name:<28} {:>3} worlds {objects:>5} objects {frames:>4} frames {:016x}", drills.len(), sum.0);
}

fn all() -> String {
    let mut text = String::new();
    for (family, entry) in FAMILIES.iter().enumerate() {
        // Enough seeds that each choice is made each way.
        let seeds = if entry.name == CHANCE { 60 } else { 8 };
        let drills: Vec<_> = (0..seeds).map(|seed| DrillId { family, seed }.make(30)).collect();
        line(&mut text, entry.name, &drills);
    }
    let mut cases = worlds::special();
    cases.extend([worlds::walled(20), worlds::materials::behind(|_| ())]);
    for case in cases {
        let name = format!("world: {}", case.name);
        line(&mut text, &name, &[case.into()]);
    }
    text
}

/// A change here gives old names new worlds: take it over (`tools/src/stress/catalogue/golden.txt`) only with a reason in the commit.
#[test]
fn every_name_is_the_world_that_it_was() {
    let (found, expected) = (all(), include_str!("golden.txt"));
    let changed: Vec<_> = found.lines().filter(|line| !expected.lines().any(|known| known == *line)).collect();
    assert!(found == expected, "worlds that are not as they were:\n{}", changed.join("\n"));
}
