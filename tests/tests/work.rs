//! The law of work: an option that decides how often, how much or how closely a method looks changes the work of a frame as it promises. Laws
//! of exactness cannot see this: a method that asks twice as often as it has to is as exact as before.
//!
//! `work/table.rs` has a row for each such option of each method, and a reason for each option that has none. `golden/work.txt` records
//! the work of every method; it changes only with a reason in the commit.

#[path = "work/count.rs"]
mod count;
#[path = "work/table.rs"]
mod table;

use count::Counter;
use culling::{Entry, METHODS, PARTICULAR};
use engine::Gpu;
use harness::{assert_caught, assert_none, golden, gpu};
use std::collections::BTreeSet;
use table::{More, Row, NO_WORK, ROWS};

/// Every method, those of special scenes too.
fn entries() -> impl Iterator<Item = &'static Entry> {
    METHODS.iter().chain(PARTICULAR)
}

/// The runs of one row, as faults.
fn faults_of(counter: &mut Counter, row: &Row) -> Vec<String> {
    let has = |entry: &&Entry| row.methods.is_empty() || row.methods.contains(&entry.id);
    let with_option = |entry: &&Entry| entry.options.iter().any(|option| option.name == row.option);
    let check = |entry: &'static Entry| {
        let run = row.run_of(entry.id);
        let mut counted = |value| {
            let settings = [row.base, &[(row.option, value)]].concat();
            counter.count(entry, &settings, run)[row.counted]
        };
        let (less, more) = (counted(row.less), counted(row.more));
        let holds = match row.by {
            More::Strictly => less < more,
            More::Times(times) => less > 0 && less * times == more,
        };
        let name = format!("{}.{}", entry.id, row.option);
        (!holds).then(|| format!("{name}: {} {} at {}, {more} at {}", less, row.counted, row.less, row.more))
    };
    entries().filter(has).filter(with_option).filter_map(check).collect()
}

fn faults_of_rows(rows: impl Iterator<Item = &'static Row>) -> Vec<String> {
    let gpu = gpu();
    let mut counter = Counter::new(&gpu);
    rows.flat_map(|row| faults_of(&mut counter, row)).collect()
}

#[test]
fn each_option_changes_the_work_as_it_promises() {
    assert_none(&faults_of_rows(ROWS.iter()));
}

/// The same row, with the two values exchanged, must fail.
#[test]
fn an_option_that_does_the_opposite_is_caught() {
    let gpu = gpu();
    let row = ROWS.iter().find(|row| row.methods == ["query-lag"]).unwrap();
    let turned = Row { less: row.more, more: row.less, ..*row };
    assert_caught(&faults_of(&mut Counter::new(&gpu), &turned), "query-lag.every");
}

/// An option of a method without a row and without a reason is a fault, and so is a row or reason of no option.
#[test]
fn every_option_of_every_method_has_a_row_or_a_reason() {
    let all: BTreeSet<(&str, &str)> =
        entries().flat_map(|entry| entry.options.iter().map(|option| (entry.id, option.name))).collect();
    let of = |methods: &[&'static str], option: &str| {
        let named =
            |(method, name): &&(&str, &str)| *name == option && (methods.is_empty() || methods.contains(method));
        all.iter().filter(named).copied().collect::<Vec<_>>()
    };
    let rows = ROWS.iter().map(|row| (of(row.methods, row.option), format!("row of {:?}.{}", row.methods, row.option)));
    let reasons = NO_WORK.iter().map(|(methods, option, _)| (of(methods, option), format!("{methods:?}.{option}")));
    let mut covered = BTreeSet::new();
    let mut faults = Vec::new();
    for (options, name) in rows.chain(reasons) {
        if options.is_empty() {
            faults.push(format!("{name}: there is no such option"));
        }
        covered.extend(options);
    }
    let missing =
        all.difference(&covered).map(|(method, option)| format!("{method}.{option} has no row and no reason"));
    faults.extend(missing);
    assert_none(&faults);
}

/// Work of every method with its defaults, summed over the frames of a run; counts that are 0 are left out.
fn record(gpu: &Gpu) -> String {
    let mut counter = Counter::new(gpu);
    let mut text = String::from("Work of each method with its defaults, summed over 8 frames (tests/tests/work.rs).\n");
    let all = entries().map(|entry| (entry, table::recorded_run(entry.id)));
    let moving = METHODS.iter().map(|entry| (entry, table::MOVING));
    // `nohc` asks where its measured times say that it pays.
    for (entry, run) in all.chain(moving).filter(|(entry, _)| entry.id != "nohc") {
        let counts = counter.count(entry, table::recorded_settings(entry.id), run);
        text.push_str(&format!("{} in {} ({}):{}\n", entry.id, run.0, run.2, counts.line()));
    }
    text
}

/// The record is lavapipe's: devices round depths in other ways, and then count otherwise. Elsewhere two runs must do the same work.
#[test]
fn the_work_of_every_method_is_as_recorded() {
    let gpu = gpu();
    let text = record(&gpu);
    if gpu.info().is_some_and(|info| info.name.contains("llvmpipe")) {
        golden::compare("work", &text);
    } else {
        assert_eq!(text, record(&gpu));
    }
}
