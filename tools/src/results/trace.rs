//! `trace.json`: the timed frames in the Chrome trace event format, which ui.perfetto.dev opens. One track a method; in it the
//! frames, and in each frame its stages.
//!
//! Only lengths are measured. Methods ran by turns, on one device; here frame k begins at one moment on all tracks, so that the same
//! frame can be compared across methods, and a frame's stages follow each other without gaps, in the order in which they were recorded.
//! What is left at a frame's end is what no stage accounts for: submitting, and waiting for read-backs. A stage that ran several
//! times in a frame is one event with the sum.

use crate::results::files::{write_atomically, WriteError};
use crate::results::{Method, Results};
use serde_json::{json, Value};
use std::path::Path;

/// All tracks lie in one process, which Perfetto shows as their group.
const PROCESS: u32 = 1;

/// Writes the trace, whole or not at all. The error names the file.
pub fn write(results: &Results, path: &Path) -> Result<(), WriteError> {
    let trace = trace(results);
    write_atomically(path, |to| Ok(serde_json::to_writer(to, &trace)?))
}

/// The trace as JSON: `traceEvents` with times in microseconds.
pub fn trace(results: &Results) -> Value {
    let group = format!("{} on {}", results.scene.name, results.device.name);
    let mut events = vec![metadata("process_name", 0, json!({ "name": group }))];
    for (place, method) in results.methods.iter().enumerate() {
        let track = track_of(place);
        events.push(metadata("thread_name", track, json!({ "name": method.label })));
        events.push(metadata("thread_sort_index", track, json!({ "sort_index": track })));
    }
    let mut begin = 0;
    for frame in 0..results.frames as usize {
        let ends = results.methods.iter().enumerate().map(|(place, method)| {
            let made = frame_events(method, frame, track_of(place), begin);
            events.extend(made.events);
            made.end
        });
        begin = ends.fold(begin, u64::max);
    }
    json!({
        "displayTimeUnit": "ms",
        "otherData": { "command": results.command, "device": results.device.name, "version": results.sightline_version },
        "traceEvents": events,
    })
}

fn track_of(place: usize) -> u32 {
    place as u32 + 1
}

fn metadata(name: &str, track: u32, args: Value) -> Value {
    json!({ "ph": "M", "name": name, "pid": PROCESS, "tid": track, "args": args })
}

struct FrameEvents {
    events: Vec<Value>,
    /// Nanoseconds.
    end: u64,
}

/// A frame that was not timed has no events. `begin` is in nanoseconds: whole numbers, so that events never overlap by rounding.
fn frame_events(method: &Method, frame: usize, track: u32, begin: u64) -> FrameEvents {
    let Some(&frame_ms) = method.frames.staged_ms().get(frame) else {
        return FrameEvents { events: Vec::new(), end: begin };
    };
    let mut events = Vec::new();
    let mut at = begin;
    for stage in &method.stages {
        let of_stage = method.frames.stages.get(&stage.name).and_then(|ms| ms.get(frame).copied().flatten());
        if let Some(ms) = of_stage {
            let length = nanoseconds(ms);
            events.push(event(&stage.name, "stage", track, at, length, json!({ "ms": ms })));
            at += length;
        }
    }
    // Two timestamps may round to more than the time around them: the frame then ends with its last stage.
    let end = at.max(begin + nanoseconds(frame_ms));
    let name = format!("frame {frame}");
    events.insert(0, event(&name, "frame", track, begin, end - begin, json!({ "frame_ms": frame_ms })));
    FrameEvents { events, end }
}

/// Negative times, which a timer may give by rounding, count as none.
fn nanoseconds(ms: f64) -> u64 {
    (ms * 1e6).round() as u64
}

fn event(name: &str, category: &str, track: u32, begin: u64, length: u64, args: Value) -> Value {
    let microseconds = |nanoseconds: u64| nanoseconds as f64 / 1e3;
    json!({
        "ph": "X", "name": name, "cat": category, "pid": PROCESS, "tid": track,
        "ts": microseconds(begin), "dur": microseconds(length), "args": args,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::files::tests::Folder;
    use crate::results::tests::results;

    /// Begin and end of a track's complete events of one kind, in nanoseconds, in the order of the file.
    fn spans(trace: &Value, track: u32, category: &str) -> Vec<(u64, u64)> {
        let events = trace["traceEvents"].as_array().unwrap().iter();
        let of_track = events.filter(|event| event["ph"] == "X" && event["tid"] == track && event["cat"] == category);
        let nanoseconds = |value: &Value| (value.as_f64().unwrap() * 1e3).round() as u64;
        of_track
            .map(|event| (nanoseconds(&event["ts"]), nanoseconds(&event["ts"]) + nanoseconds(&event["dur"])))
            .collect()
    }

    #[test]
    fn events_nest_and_do_not_overlap_on_a_track() {
        let mut results = results();
        // Stages that took longer than their frame, and one that a rounding timer made negative.
        results.methods[2].frames.frame_ms = vec![0.1, 0.2];
        results.methods[2].frames.stages = [("draw/all".to_owned(), vec![Some(3.000_000_4), Some(-1e-7)])].into();
        let folder = Folder::new("trace");
        let path = folder.0.join("trace.json");
        write(&results, &path).unwrap();
        let trace: Value = serde_json::from_str(&std::fs::read_to_string(&path).unwrap()).unwrap();
        for track in 1..=3 {
            let (frames, stages) = (spans(&trace, track, "frame"), spans(&trace, track, "stage"));
            assert_eq!(frames.len(), 2, "track {track}");
            for spans in [&frames, &stages] {
                assert!(spans.windows(2).all(|pair| pair[0].1 <= pair[1].0), "track {track}: {spans:?}");
            }
            let inside = |stage: &(u64, u64)| frames.iter().any(|frame| frame.0 <= stage.0 && stage.1 <= frame.1);
            assert!(stages.iter().all(inside), "track {track}: {stages:?} in {frames:?}");
        }
        // `none` names no time of its stages, `woc` ran two in one frame and three in all.
        assert_eq!([1, 2, 3].map(|track| spans(&trace, track, "stage").len()), [0, 3, 2]);
    }

    #[test]
    fn lengths_are_the_measured_ones_and_frames_begin_together() {
        let trace = trace(&results());
        let slowest = spans(&trace, 1, "frame");
        assert_eq!(slowest, [(0, 1_000_000_000), (1_000_000_000, 2_000_000_000)]);
        let woc = spans(&trace, 2, "frame");
        assert_eq!(woc, [(0, 12_500_000), (1_000_000_000, 1_012_500_000)]);
        let stages = spans(&trace, 2, "stage");
        assert_eq!(stages[1..], [(1_000_000_000, 1_000_500_000), (1_000_500_000, 1_012_000_000)]);
    }

    #[test]
    fn each_track_has_its_methods_name() {
        let trace = trace(&results());
        let names = trace["traceEvents"].as_array().unwrap().iter().filter(|event| event["name"] == "thread_name");
        let names: Vec<_> = names.map(|event| event["args"]["name"].as_str().unwrap()).collect();
        assert_eq!(names, ["none", "woc[search.seeds=8]", "ref"]);
    }

    /// Frames with stage timers are other frames than those of the medians: the trace shows the former, of which the stages are parts.
    #[test]
    fn each_field_of_an_event_is_its_own() {
        let mut results = results();
        results.frames = 2;
        (results.command, results.sightline_version) = ("a command".into(), "9.8.7".into());
        results.methods.remove(0);
        let frames = &mut results.methods[0].frames;
        (frames.frame_ms, frames.staged_frame_ms) = (vec![70.0, 80.0], vec![13.0, 14.5]);
        results.methods[1].frames.staged_frame_ms = vec![20.0, 21.0];
        let found = trace(&results);
        assert_eq!(found["displayTimeUnit"], "ms");
        assert_eq!(found["otherData"], json!({ "command": "a command", "device": "llvmpipe", "version": "9.8.7" }));
        let metadata = |name: &str, track: u32, args: Value| json!({ "ph": "M", "name": name, "pid": 1, "tid": track, "args": args });
        let event = |name: &str, kind: &str, track: u32, [ts, dur]: [f64; 2], args: Value| json!({ "ph": "X", "name": name, "cat": kind, "pid": 1, "tid": track, "ts": ts, "dur": dur, "args": args });
        let expected = [
            metadata("process_name", 0, json!({ "name": "city on llvmpipe" })),
            metadata("thread_name", 1, json!({ "name": "woc[search.seeds=8]" })),
            metadata("thread_sort_index", 1, json!({ "sort_index": 1 })),
            metadata("thread_name", 2, json!({ "name": "ref" })),
            metadata("thread_sort_index", 2, json!({ "sort_index": 2 })),
            event("frame 0", "frame", 1, [0.0, 13e3], json!({ "frame_ms": 13.0 })),
            event("draw/all", "stage", 1, [0.0, 12e3], json!({ "ms": 12.0 })),
            event("frame 0", "frame", 2, [0.0, 20e3], json!({ "frame_ms": 20.0 })),
            // The next frame begins where the slowest of all tracks ends.
            event("frame 1", "frame", 1, [20e3, 14.5e3], json!({ "frame_ms": 14.5 })),
            event("warp/search", "stage", 1, [20e3, 500.0], json!({ "ms": 0.5 })),
            event("draw/all", "stage", 1, [20.5e3, 11.5e3], json!({ "ms": 11.5 })),
            event("frame 1", "frame", 2, [20e3, 21e3], json!({ "frame_ms": 21.0 })),
        ];
        assert_eq!(found["traceEvents"].as_array().unwrap(), &expected);
    }
}
