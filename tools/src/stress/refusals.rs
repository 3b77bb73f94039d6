//! What has no meaning is refused, by the name of its object, before it reaches a method (rule 6).

use super::worlds::{cube, sized, Maker};
use glam::DVec3;
use scenes::Scene;

/// A scene that must be refused, and how it is broken.
type Broken = (&'static str, fn(&mut Scene));

const BROKEN: [Broken; 8] = [
    ("a NaN place", |scene| scene.objects[1].world_from_object.translation.y = f64::NAN),
    ("an infinite place", |scene| scene.objects[1].world_from_object.translation.x = f64::INFINITY),
    ("a NaN axis", |scene| scene.objects[1].world_from_object.matrix3.x_axis.x = f64::NAN),
    ("an infinite size", |scene| scene.objects[1].world_from_object.matrix3.z_axis.z = f64::NEG_INFINITY),
    ("a size beyond f32", |scene| scene.objects[1].world_from_object.matrix3.y_axis.y = 1e60),
    ("a place beyond f32", |scene| scene.objects[1].world_from_object.translation.z = -1e60),
    ("a NaN vertex", |scene| scene.meshes[1].positions[3].x = f32::NAN),
    ("an infinite vertex", |scene| scene.meshes[1].positions[3].z = f32::INFINITY),
];

/// Tries each; returns those that were accepted, or refused without naming the object.
pub fn refusal_faults() -> (usize, Vec<String>) {
    let mut faults = Vec::new();
    for (what, break_it) in BROKEN {
        let mut maker = Maker::new("refused");
        let kinds = [maker.mesh(cube()), maker.mesh(cube())];
        kinds.into_iter().for_each(|kind| maker.place(kind, sized(DVec3::ZERO, DVec3::ONE)));
        maker.scene.objects[1].name = "the bad one".into();
        break_it(&mut maker.scene);
        match maker.scene.check() {
            Ok(()) => faults.push(format!("{what}: accepted")),
            Err(error) if !error.to_string().contains("the bad one") => {
                faults.push(format!("{what}: refused without the object's name: {error}"));
            }
            Err(_) => {}
        }
    }
    (BROKEN.len(), faults)
}

#[cfg(test)]
mod tests {
    #[test]
    fn what_has_no_meaning_is_refused_by_name() {
        assert_eq!(super::refusal_faults(), (super::BROKEN.len(), Vec::new()));
    }
}
