//! The untimed pass: every method's frames against the truth. One thread runs the device; all cores compare.

use super::pairs::Pair;
use super::{repeat, BenchOptions, Progress, Records, Seen, Watch};
use crate::measures::metrics::{FrameImages, MetricError, Truth};
use crate::run::ordered::on_all_cores;
use crate::run::raster::{is_promised, is_wrong, judged, Sight};
use crate::run::session::Session;
use crate::run::truth::RunTruth;
use crate::run::{Contender, Left, Measured};
use anyhow::{Context, Result};
use std::sync::Arc;

/// Most bytes of pictures that wait for a comparison. Large pictures therefore use fewer cores.
const WAITING_BYTES: usize = 2 << 30;
/// Bytes a pixel of a frame that waits: colour, depth, item, count, and the two pictures that the comparison makes.
const BYTES_A_PIXEL: usize = 4 + 4 + 4 + 4 + 2 * 3;

/// The callbacks of the untimed pass.
pub(super) struct Followers<'a> {
    pub(super) pairs: &'a mut [Pair],
    pub(super) progress: Progress<'a>,
    pub(super) watch: Watch<'a>,
}

/// A method's frame on its way through the pass.
struct Frame<T> {
    number: usize,
    /// Index of the method.
    place: usize,
    truth: Arc<Truth>,
    /// Present if the raster conditions may have to be checked.
    sight: Option<Arc<Sight>>,
    content: T,
}

/// A frame after its comparison.
type Compared = Frame<Result<Measured, MetricError>>;

/// Runs all frames once more, and compares them with the truth.
///
/// # Errors
/// An error of the device, the comparison or a callback.
pub(super) fn measure(
    session: &mut Session,
    contenders: &mut [Contender],
    records: &mut [Records],
    truth: &RunTruth,
    options: &BenchOptions,
    followers: Followers<'_>,
) -> Result<()> {
    repeat(session, contenders, options.warmup)?;
    let labels: Vec<String> = contenders.iter().map(Contender::label).collect();
    let mut pass = Pass { labels, records, followers, pictures: Vec::new(), frames: session.frames() };
    let [width, height] = session.options().size;
    let pixels = width as usize * height as usize * session.targets.samples() as usize;
    let compare = |frame: Frame<Left>| {
        let Frame { number, place, truth, sight, content } = frame;
        Frame { number, place, content: content.against(&truth), truth, sight }
    };
    on_all_cores((pixels * BYTES_A_PIXEL, WAITING_BYTES), compare, |line| {
        for number in 0..session.frames() {
            let truth = Arc::new(truth.frame(session, number)?);
            let mut sight = None;
            for (place, contender) in contenders.iter_mut().enumerate() {
                let content = contender.left(session, number)?;
                let sight = sight_of(session, &truth, &content, &mut sight, number)?;
                line.give(Frame { number, place, truth: truth.clone(), sight, content });
                while let Some(compared) = line.next_ready() {
                    pass.take(session, compared)?;
                }
            }
        }
        while let Some(compared) = line.next_of_all() {
            pass.take(session, compared)?;
        }
        Ok(())
    })
}

/// Reads the data for the raster conditions of a frame that has an error. The data are read once for all methods, while the world is at
/// the frame's time.
fn sight_of(
    session: &mut Session,
    truth: &Truth,
    left: &Left,
    known: &mut Option<Arc<Sight>>,
    frame: usize,
) -> Result<Option<Arc<Sight>>> {
    let promised = is_promised(session.targets.samples(), session.gpu.depth());
    if !promised || !is_wrong(truth, &left.images, &left.drawn.objects) {
        return Ok(None);
    }
    if known.is_none() {
        let (view, seconds) = (session.look(frame)?, session.shot(frame).seconds);
        *known = Some(Arc::new(Sight::of(&session.world, &view, seconds)?));
    }
    Ok(known.clone())
}

/// Takes compared frames in order, one method after the other.
struct Pass<'a, 'f> {
    labels: Vec<String>,
    records: &'a mut [Records],
    followers: Followers<'f>,
    /// Pictures of the current frame that pairs need.
    pictures: Vec<Option<FrameImages>>,
    frames: usize,
}

impl Pass<'_, '_> {
    fn take(&mut self, session: &Session, compared: Compared) -> Result<()> {
        let Frame { number, place, truth, sight, content } = compared;
        let label = &self.labels[place];
        let mut measured = content.with_context(|| format!("method '{label}', frame {number}"))?;
        let mut thin = 0;
        if let Some(sight) = sight {
            let taken = (&measured.images, &measured.drawn.objects[..]);
            (measured.error, thin) = judged(&session.scene, &sight, &truth, taken, measured.error);
        }
        let Followers { pairs, progress, watch } = &mut self.followers;
        watch(Seen { label, frame: number, truth: truth.images(), measured: &measured })?;
        let images = self.records[place].push((measured, thin));
        self.pictures.push(pairs.iter().any(|pair| pair.needs(place)).then_some(images));
        if place + 1 == self.labels.len() {
            pairs.iter_mut().try_for_each(|pair| pair.compare(&self.pictures))?;
            self.pictures.clear();
            progress("measuring errors", number + 1, self.frames);
        }
        Ok(())
    }
}
