//! Goals of a table of ours: what a method's times should be beside those of others in the same run, and whether they are.

use super::{Place, Plan, Ran, Table};
use crate::compare::{ratio, Bootstrap};
use crate::results::grid::Grid;
use crate::results::Method;

/// What a method's times should be. All are judged for each scene and row.
#[derive(Clone, Copy, Debug)]
pub struct Goals {
    /// Head of the column that they are for.
    pub of: &'static str,
    /// Head of the column that nothing can be faster than.
    pub limit: &'static str,
    /// By variant: median over the limit's, at most.
    pub over_limit: &'static [f64],
    /// Where the limit's median takes less than this, milliseconds count instead of a ratio.
    pub quick_ms: f64,
    /// There: median less the limit's, at most.
    pub over_quick_ms: f64,
    /// p95 over median, over the limit's p95 over median, at most.
    pub over_spread: f64,
    /// Head of the column that does the least.
    pub base: &'static str,
    /// Median over that of the best column between base and limit, at most; and over that of the base, where none of them is
    /// faster than the base by more than this.
    pub over_best: f64,
}

/// How a figure stands to its goal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Verdict {
    Met,
    /// Above the goal, but the figure's 95 % interval holds it.
    Unsure,
    Missed,
}

/// A figure and its goal.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Judged {
    pub figure: f64,
    pub goal: f64,
    pub verdict: Verdict,
    /// What it is over, or its unit.
    pub of: String,
}

/// How sure a ratio of medians is: few resamples, as only the interval's lower end is looked at.
const BOOTSTRAP: Bootstrap = Bootstrap { resamples: 1000, seed: 1 };

/// What `goals_text` calls its columns.
const HEADS: [&str; 4] = ["over ref", "spread over ref's", "over best fixed", "over frustum"];

impl Goals {
    /// The goals of one row: over the limit, spread, over the best of the others, over the base. None where one is not for
    /// this row or something did not run.
    pub(super) fn judge(
        &self,
        variant: usize,
        method: impl Fn(&str) -> Option<Method>,
        heads: &[&str],
    ) -> [Option<Judged>; 4] {
        let (Some(of), limit, base) = (method(self.of), method(self.limit), method(self.base)) else {
            return [None, None, None, None];
        };
        let fixed = heads.iter().filter(|head| **head != self.of && **head != self.limit);
        let fixed: Vec<(&str, Method)> = fixed.filter_map(|head| Some((*head, method(head)?))).collect();
        let faster = |a: &&(&str, Method), b: &&(&str, Method)| a.1.frame_ms.median.total_cmp(&b.1.frame_ms.median);
        let best = fixed.iter().min_by(faster);
        let over_base = base.as_ref().filter(|base| {
            let others = fixed.iter().filter(|(head, _)| *head != self.base);
            others.map(|(_, other)| other.frame_ms.median).fold(f64::INFINITY, f64::min) * self.over_best
                >= base.frame_ms.median
        });
        [
            limit.as_ref().and_then(|limit| self.over_limit(variant, &of, limit)),
            limit.as_ref().and_then(|limit| self.spread(&of, limit)),
            best.and_then(|(head, best)| over(&of, best, self.over_best, head)),
            over_base.and_then(|base| over(&of, base, self.over_best, "")),
        ]
    }

    fn over_limit(&self, variant: usize, of: &Method, limit: &Method) -> Option<Judged> {
        let goal = *self.over_limit.get(variant)?;
        let (median, least) = (of.frame_ms.median, limit.frame_ms.median);
        if least >= self.quick_ms {
            return over(of, limit, goal, "");
        }
        let (figure, goal) = (median - least, self.over_quick_ms);
        // The same interval as elsewhere, as milliseconds over the limit's median.
        let low = ratio(&limit.frames.frame_ms, &of.frames.frame_ms, true, BOOTSTRAP).map_or(median, |r| r.low * least);
        Some(Judged { figure, goal, verdict: verdict(figure, low - least, goal), of: "ms".into() })
    }

    fn spread(&self, of: &Method, limit: &Method) -> Option<Judged> {
        let spread = |method: &Method| {
            let (p95, median) = (method.frame_ms.p95, method.frame_ms.median);
            (median > 0.0).then_some(p95 / median)
        };
        let (figure, goal) = (spread(of)? / spread(limit)?, self.over_spread);
        Some(Judged { figure, goal, verdict: verdict(figure, figure, goal), of: String::new() })
    }
}

/// Median over median, with its interval over frames.
fn over(method: &Method, base: &Method, goal: f64, of: &str) -> Option<Judged> {
    let found = ratio(&base.frames.frame_ms, &method.frames.frame_ms, true, BOOTSTRAP)?;
    Some(Judged { figure: found.ratio, goal, verdict: verdict(found.ratio, found.low, goal), of: of.to_owned() })
}

fn verdict(figure: f64, low: f64, goal: f64) -> Verdict {
    match figure {
        figure if figure <= goal => Verdict::Met,
        _ if low <= goal => Verdict::Unsure,
        _ => Verdict::Missed,
    }
}

impl Judged {
    /// As a cell: `1.20 <= 1.25`, `1.07 ? 1.05 eovc`, `1.40 > 1.25`.
    fn cell(&self) -> String {
        let sign = match self.verdict {
            Verdict::Met => "<=",
            Verdict::Unsure => "?",
            Verdict::Missed => ">",
        };
        format!("{:.2} {sign} {:.2} {}", self.figure, self.goal, self.of).trim_end().to_owned()
    }
}

/// Each row's figures beside their goals, what was met, and what the signs mean. Empty without goals.
pub(super) fn goals_text(table: &Table, plan: &Plan, scenes: &[Vec<Ran>]) -> Vec<String> {
    let Some(goals) = table.goals else { return Vec::new() };
    let heads: Vec<&str> = table.columns.iter().map(|column| column.head).collect();
    let mut grid = Grid::new(HEADS.to_vec(), 0);
    let mut verdicts = Vec::new();
    for runs in scenes {
        for (index, variant) in table.variants.iter().enumerate() {
            let places = &plan.places[index * heads.len()..];
            let method = |head: &str| {
                let column = heads.iter().position(|other| *other == head)?;
                let Place { run, label, .. } = places[column].as_ref()?;
                runs.get(*run)?.results.method(label).cloned()
            };
            let judged = goals.judge(index, method, &heads);
            verdicts.extend(judged.iter().flatten().map(|judged| judged.verdict));
            let name = runs.first().map_or("", |run| run.results.scene.name.as_str());
            let cells = judged.iter().map(|judged| judged.as_ref().map_or("-".to_owned(), Judged::cell)).collect();
            grid.rows.push((format!("{name} {}", variant.name), cells));
        }
    }
    grid.fill_width();
    let count = |of: Verdict| verdicts.iter().filter(|verdict| **verdict == of).count();
    let (met, unsure, missed) = (count(Verdict::Met), count(Verdict::Unsure), count(Verdict::Missed));
    let mut lines = vec![String::new(), format!("goals of {}", goals.of)];
    lines.extend(grid.lines("figure, sign, goal"));
    lines.push(String::new());
    lines
        .push(format!("{} goals: {met} met (<=), {unsure} not surely missed (?), {missed} missed (>)", verdicts.len()));
    lines.extend(what_they_are(&goals));
    lines
}

fn what_they_are(goals: &Goals) -> Vec<String> {
    let Goals { of, limit, base, quick_ms, over_best, .. } = goals;
    let slack = 100.0 * (over_best - 1.0);
    vec![
        format!("over {limit}: median of {of} over that of {limit}; in ms, {of} less {limit}, where {limit} takes less than {quick_ms} ms."),
        format!("spread: p95 over median, over the same of {limit}, as frames of a path differ in what they show."),
        format!("best fixed: the one of the methods between that has the least median in this run. over {base}: only where none"),
        format!("is faster than {base} by {slack:.0} %, so that culling does not pay. ?: above the goal, but the goal is in the ratio's"),
        "95 % interval (bootstrap over frames, in pairs).".to_owned(),
    ]
}
