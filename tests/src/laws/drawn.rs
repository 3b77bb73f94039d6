//! What must not be drawn. A method that draws too much passes every law of the picture; these are for it.

use super::Lab;
use crate::{Case, Subject};
use engine::Gpu;
use glam::DVec3;
use scenes::{Pose, Shot};

/// Before a still camera, what shows is known soon: of the hidden objects that the view volume alone leaves, less than a
/// quarter are drawn. A method that draws too much passes every law of the picture; this one is for it.
///
/// The quarter is a choice, not derived: far from what the methods reach in [`walled`](crate::worlds::walled) and from drawing all.
pub fn what_a_wall_hides_is_culled(gpu: &Gpu, subject: &Subject, case: &Case) -> Vec<String> {
    // The last frame: its predecessors, with all of the depth, have seen what there is to see.
    little_is_drawn_in(3, gpu, subject, case)
}

/// The same of a first frame, before which nothing is known: for methods that find out what stands in front before they draw all else.
pub fn what_a_wall_hides_after_a_cut_is_culled(gpu: &Gpu, subject: &Subject, case: &Case) -> Vec<String> {
    little_is_drawn_in(0, gpu, subject, case)
}

fn little_is_drawn_in(frame: usize, gpu: &Gpu, subject: &Subject, case: &Case) -> Vec<String> {
    let case = case.filmed(vec![case.shots[0]; frame + 1]);
    let mut lab = Lab::new(gpu, &case);
    let (truths, sets) = lab.truths(&case.shots);
    let hidden = [&Subject::named("frustum"), subject].map(|subject| {
        let mut method = lab.make(subject, &sets);
        let takes = lab.film(&mut *method, &case.shots);
        let drawn = takes[frame].drawn.objects.iter().filter(|drawn| **drawn).count();
        drawn.saturating_sub(truths[frame].visible_count())
    });
    let place = format!("{}, {}", subject.options.label(), case.name);
    match hidden {
        [in_view, drawn] if 4 * drawn < in_view => Vec::new(),
        [in_view, drawn] => vec![format!("{place}: {drawn} of {in_view} hidden objects drawn, too many")],
    }
}

/// What a camera that sinks behind a wall no longer sees is soon no longer drawn: of the hidden objects that the view volume alone leaves,
/// less than a quarter are. A method that never forgets what it saw loses nothing, and passes every other law.
pub fn what_is_no_longer_seen_is_no_longer_drawn(gpu: &Gpu, subject: &Subject, case: &Case) -> Vec<String> {
    // From above the wall down to where it hides most, and on for some frames by a hair, so that no frame is as the last.
    let height = |frame: usize| if frame < 24 { 14.0 - 0.55 * frame as f64 } else { 0.8 - 1e-4 * frame as f64 };
    let shot = |frame| {
        let pose = Pose::looking_at(DVec3::new(0.7, height(frame), 7.0), DVec3::ZERO);
        Shot { pose, ..case.shots[0] }
    };
    let case = case.filmed((0..32).map(shot).collect());
    let mut lab = Lab::new(gpu, &case);
    let (truths, sets) = lab.truths(&case.shots);
    let hidden = [&Subject::named("frustum"), subject].map(|subject| {
        let mut method = lab.make(subject, &sets);
        let takes = lab.film(&mut *method, &case.shots);
        let count = |frame: usize| takes[frame].drawn.objects.iter().filter(|drawn| **drawn).count();
        [0, 31].map(|frame| count(frame).saturating_sub(truths[frame].visible_count()))
    });
    let place = format!("{}, {}", subject.options.label(), case.name);
    let newly_hidden = truths[0].visible_count().saturating_sub(truths[31].visible_count());
    match hidden {
        _ if 4 * newly_hidden < case.scene.objects.len() => {
            vec![format!("{place}: only {newly_hidden} objects become hidden")]
        }
        [[_, in_view], [_, drawn]] if 4 * drawn < in_view => Vec::new(),
        [[_, in_view], [_, drawn]] => {
            vec![format!("{place}: {drawn} of {in_view} hidden objects still drawn, too many")]
        }
    }
}
