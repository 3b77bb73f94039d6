//! Counts what a method does over the frames of a short run.

use culling::{draw_lists, drawn_by, Entry, VisibleSets};
use engine::Gpu;
use harness::sessions;
use sightline::run::session::Session;
use sightline::run::truth::RunTruth;
use sightline::run::{Contender, Watched};
use std::collections::BTreeMap;
use std::ops::Index;
use std::sync::Arc;

/// Frames of each run.
const FRAMES: usize = 8;

/// Draw lists of a frame whose objects are counted apart.
const PASSES: usize = 3;

/// Scene, scale and path of a run, as in [`sessions::RUNS`].
pub type Run = (&'static str, f64, &'static str);

/// Sums over the frames of a run, by name: the fields of [`culling::Work`], drawn objects and triangles, objects of each of the first draw lists, submissions, uploads,
/// stages, and of each stage the number of times that it ran.
#[derive(Clone, Default)]
pub struct Counts(BTreeMap<String, u64>);

impl Counts {
    fn add(&mut self, name: &str, count: u64) {
        *self.0.entry(name.to_owned()).or_default() += count;
    }

    /// The counts that are not 0, with the number of times each stage ran left out.
    pub fn line(&self) -> String {
        let plain = self.0.iter().filter(|(name, count)| !name.contains('/') && **count > 0);
        plain.map(|(name, count)| format!(" {name} {count}")).collect()
    }
}

impl Index<&str> for Counts {
    type Output = u64;

    fn index(&self, name: &str) -> &u64 {
        self.0.get(name).unwrap_or(&0)
    }
}

/// Runs methods. Each session is opened once, and each run of a method with its settings is counted once.
pub struct Counter<'a> {
    gpu: &'a Gpu,
    sessions: BTreeMap<String, (Session, Arc<VisibleSets>)>,
    known: BTreeMap<String, Counts>,
}

impl<'a> Counter<'a> {
    /// A counter that has run nothing.
    pub fn new(gpu: &'a Gpu) -> Self {
        Counter { gpu, sessions: BTreeMap::new(), known: BTreeMap::new() }
    }

    /// What a method does with these settings.
    ///
    /// # Panics
    /// If the device or its validation layer objects, or if an option or scene is unknown.
    pub fn count(&mut self, entry: &'static Entry, settings: &[(&str, &str)], run: Run) -> Counts {
        let key = format!("{} {settings:?} {run:?}", entry.id);
        if let Some(counts) = self.known.get(&key) {
            return counts.clone();
        }
        let (session, sets) = self.sessions.entry(format!("{run:?}")).or_insert_with(|| {
            let mut session = sessions::open_at_speed_one(self.gpu, run, FRAMES);
            let sets = RunTruth::draw(&mut session, || ()).unwrap().sets;
            (session, sets)
        });
        let counts = counts_of(session, sets, entry, settings);
        self.known.insert(key, counts.clone());
        counts
    }
}

fn counts_of(
    session: &mut Session,
    sets: &Arc<VisibleSets>,
    entry: &'static Entry,
    settings: &[(&str, &str)],
) -> Counts {
    let mut options = entry.default_options();
    for (name, value) in settings {
        options.set(name, value).unwrap();
    }
    let mut contender = Contender::new(session, entry, options, &Some(sets.clone())).unwrap();
    contender.method.count_work(true);
    let mut counts = Counts::default();
    for frame in 0..FRAMES {
        let view = session.look(frame).unwrap();
        let report = contender.run(session, &view, Watched::Stages).unwrap();
        let work = contender.method.work().unwrap();
        let lists = draw_lists(&session.gpu, &report).unwrap();
        let drawn = drawn_by(&session.world, &report, &lists);
        for (name, count) in [
            ("queries", work.queries),
            ("plane_tests", work.plane_tests),
            ("state_changes", work.state_changes),
            ("waits", work.waits),
            ("boxes", work.boxes),
            ("rays", work.rays),
            ("node_visits", work.node_visits),
            ("early_stops", work.early_stops),
            ("refits", work.refits),
            ("drawn", drawn.objects.iter().filter(|drawn| **drawn).count() as u64),
            ("triangles", drawn.triangles),
            ("submissions", u64::from(report.submissions)),
            ("uploads", report.uploads),
            ("stages", report.stages.len() as u64),
        ] {
            counts.add(name, count);
        }
        for (pass, list) in lists.iter().enumerate().take(PASSES) {
            let drawn = list.iter().filter(|command| command.instance_count > 0).count();
            counts.add(&format!("pass_{}", pass + 1), drawn as u64);
        }
        for stage in &report.stages {
            counts.add(stage.label.split(':').next().unwrap_or_default(), 1);
        }
    }
    counts
}
