//! The laws as `sightline bench` meets them: through sessions, truths and contenders.

use crate::laws::faults_of;
use crate::Subject;
use engine::Gpu;
use sightline::run::session::{Session, SessionOptions};
use sightline::run::truth::RunTruth;
use sightline::run::Contender;

/// Scene, scale and path of each run.
pub const RUNS: [(&str, f64, &str); 13] = [
    ("city-block", 0.02, "walk"),
    ("city-block", 0.02, "rotate"),
    ("rooms", 0.1, "walk"),
    ("bad-bounds", 0.1, "walk"),
    ("boxes", 1.0, "pan"),
    ("boxes", 1.0, "zoom"),
    ("boxes", 1.0, "closing-in"),
    ("boxes", 1.0, "still"),
    ("moving-boxes", 1.0, "rotate"),
    ("moving-boxes", 1.0, "still"),
    ("moving-boxes", 1.0, "walk"),
    ("moving-balloons", 0.02, "walk"),
    ("factory", 0.02, "walk"),
];

/// Opens one of the runs in a small size.
///
/// # Panics
/// If there is no such scene or path.
pub fn open(gpu: &Gpu, run: (&str, f64, &str), frames: usize) -> Session {
    opened(gpu, run, frames, true)
}

/// The same, but the camera moves at speed 1 as far as the frames reach.
///
/// # Panics
/// If there is no such scene or path.
pub fn open_at_speed_one(gpu: &Gpu, run: (&str, f64, &str), frames: usize) -> Session {
    opened(gpu, run, frames, false)
}

fn opened(gpu: &Gpu, (scene, scale, path): (&str, f64, &str), frames: usize, whole_path: bool) -> Session {
    let path = Some(path.into());
    let size = [320, 180];
    let options =
        SessionOptions { scene: scene.into(), scale, path, whole_path, frames, size, ..SessionOptions::default() };
    Session::on(gpu, options).unwrap_or_else(|error| panic!("{scene}: {error:#}"))
}

/// Runs a method through a session as the bench does, timed and measured, and returns its faults.
///
/// # Panics
/// If the device or its validation layer objects.
pub fn faults(session: &mut Session, id: &str, set: &[(&str, &str)]) -> Vec<String> {
    let entry = culling::find(id).unwrap();
    let subject = set.iter().fold(Subject::named(id), |subject, (option, value)| subject.with(option, value));
    let truth = RunTruth::draw(session, || ()).unwrap();
    let visible = Some(truth.sets.clone());
    let make = |session: &Session| Contender::new(session, entry, subject.options.clone(), &visible).unwrap();
    let (mut measured, mut timed) = (make(session), make(session));
    let mut faults = Vec::new();
    for frame in 0..session.frames() {
        let place = format!("{} in {} {}, frame {frame}", measured.label(), session.scene.name, session.path().name());
        let report = timed.staged(session, frame).unwrap();
        let timed = culling::drawn_objects(&session.gpu, &session.world, &report).unwrap();
        let truth = truth.frame(session, frame).unwrap();
        let found = measured.measured(session, frame, &truth).unwrap();
        faults.extend(faults_of(&place, &found.error));
        if timed != found.drawn {
            faults.push(format!("{place}: the timed frame drew other objects"));
        }
        if truth.visible_count() == 0 {
            faults.push(format!("{place}: shows nothing, so it proves nothing"));
        }
    }
    faults
}

/// All runs of [`RUNS`].
pub fn all_faults(gpu: &Gpu, id: &str, set: &[(&str, &str)]) -> Vec<String> {
    RUNS.iter().flat_map(|run| faults(&mut open(gpu, *run, 8), id, set)).collect()
}
