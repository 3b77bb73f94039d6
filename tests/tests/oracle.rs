//! Pictures of `none` agree with an oracle outside the renderer: each pixel shows the object that its ray meets first. No other test
//! finds a picture that is wrong in every method alike.

#[path = "oracle/alpha.rs"]
mod alpha;
#[path = "oracle/cameras.rs"]
mod cameras;
#[path = "oracle/methods.rs"]
mod methods;
#[path = "oracle/turning.rs"]
mod turning;

use harness::oracle::{faults, random, Pixel, Rays, Surface, Wide};
use harness::{assert_caught, assert_none, gpu, Case, Lab};
use scenes::{import_bytes, Scene, Shot};
use std::path::Path;

const SIZE: [u32; 2] = [161, 97];

/// Imports a model that was written as a file.
fn imported(glb: &[u8]) -> Scene {
    import_bytes(Path::new("model.glb"), glb).expect("a legal file")
}

/// The object of the scene that each pixel of a shot shows on the device.
fn drawn(lab: &mut Lab, shot: &Shot) -> Vec<Option<u32>> {
    let truth = lab.truth(shot);
    let object = |item: &u32| (*item != u32::MAX).then(|| lab.world.scene_object(*item as usize) as u32);
    truth.images().items.iter().map(object).collect()
}

/// Returns the oracle's pixels for a shot of a lab's size and device.
fn pixels(lab: &Lab, shot: &Shot, surfaces: &[Surface]) -> Vec<Pixel> {
    let snap_px = f64::from(lab.targets.reach_px(&lab.gpu));
    Rays::new(shot.pose, shot.projection, lab.size, snap_px).cast(surfaces, &Wide::default())
}

/// The number of random models. SIGHTLINE_STRESS_CASES sets another number.
fn models() -> u64 {
    std::env::var("SIGHTLINE_STRESS_CASES").ok().and_then(|count| count.parse().ok()).unwrap_or(20)
}

#[test]
fn random_models_look_as_the_oracle_says() {
    const SHOTS: usize = 4;
    let gpu = gpu();
    let (mut found, mut clear) = (Vec::new(), 0);
    for seed in 0..models() {
        let model = random::model(seed);
        let shots = random::shots(seed, SHOTS);
        let name = format!("model {seed}");
        let mut lab = Lab::new(&gpu, &Case { name, scene: imported(&model.glb()), shots: shots.clone(), size: SIZE });
        for (number, shot) in shots.iter().enumerate() {
            let pixels = pixels(&lab, shot, &model.surfaces(shot.seconds));
            found.extend(faults(&format!("model {seed}, shot {number}"), &pixels, &drawn(&mut lab, shot), SIZE[0]));
            clear += pixels.iter().filter(|pixel| **pixel != Pixel::Open).count();
        }
    }
    assert_none(&found);
    let all = models() as usize * SHOTS * (SIZE[0] * SIZE[1]) as usize;
    assert!(clear > all * 9 / 10, "the oracle left out too much: only {clear} of {all} pixels were compared");
}

/// Planted: the picture of an instant later, and a picture without one of its objects.
#[test]
fn a_picture_of_another_time_or_without_an_object_is_caught() {
    let gpu = gpu();
    let (model, shots) = (random::model(3), random::shots(3, 2));
    let scene = imported(&model.glb());
    let mut lab = Lab::new(&gpu, &Case { name: "model 3".into(), scene, shots: shots.clone(), size: SIZE });
    let shot = shots[1];
    let said = pixels(&lab, &shot, &model.surfaces(shot.seconds));
    let later = drawn(&mut lab, &Shot { seconds: shot.seconds + 0.1, ..shot });
    assert_caught(&faults("later", &said, &later, SIZE[0]), "its ray meets Object");
    let mut lost = drawn(&mut lab, &shot);
    let largest = (0..20).max_by_key(|object| lost.iter().filter(|item| **item == Some(*object)).count()).unwrap();
    lost.iter_mut().filter(|item| **item == Some(largest)).for_each(|item| *item = None);
    assert_caught(&faults("lost", &said, &lost, SIZE[0]), "shows None");
}
