//! The lines of text over the picture.

use super::controls::Controls;
use super::keys::KEYS;
use super::lab::Lab;
use crate::measures::stats::by_label;

/// Letters of the longest line, and of the shortest that lines are cut to in a narrow window.
const LINE: usize = 92;
const SHORTEST_LINE: usize = 16;
/// Stages that are listed, the longest first to stay.
const STAGES: usize = 12;

/// What runs, how fast, and what it draws, in lines of so many letters.
pub fn state(lab: &Lab, controls: &Controls, told: &str, letters: usize) -> Vec<String> {
    let session = &lab.session;
    let [width, height] = session.options().size;
    let device = session.gpu.info().map_or("", |info| info.name.as_str());
    let objects = session.world.total();
    let known = &lab.known;
    let mut lines = vec![format!("{}  {objects} objects  {width}x{height}  {device}", session.scene.name)];
    let guarantee = lab.contender().map_or(String::new(), |contender| contender.guarantee().to_string());
    let culling = match (controls.culling, controls.frozen) {
        (false, _) => "   CULLING OFF",
        (true, true) => "   FROZEN",
        (true, false) => "",
    };
    lines.push(format!("{}  ({guarantee}){culling}", lab.label()));
    let frame = match known.frame_ms {
        Some((ms, true)) => format!("frame {ms:.1} ms"),
        Some((ms, false)) => format!("frame {ms:.1} ms (watched)"),
        None => "frame -".to_owned(),
    };
    let drawn = known.drawn.map_or("drawn -".to_owned(), |drawn| {
        let culled = objects - drawn.min(objects);
        format!("drawn {drawn}  culled {culled} ({:.1} %)", 100.0 * culled as f64 / objects.max(1) as f64)
    });
    lines.push(format!("{frame}  {drawn}"));
    lines.push(match &known.error {
        Some(error) => format!(
            "visible {}  lost objects {}  lost pixels {}  {}",
            error.ref_visible,
            error.false_negatives,
            error.differing_pixels,
            error.psnr_db.map_or("identical".to_owned(), |psnr| format!("PSNR {psnr:.1} dB"))
        ),
        None if controls.truth && controls.frozen => "truth: not while culling is frozen".to_owned(),
        None => "visible -  (T compares with the truth)".to_owned(),
    });
    let modes = [(controls.playing, "  PLAYING"), (controls.recording, "  RECORDING")];
    let modes: String = modes.iter().filter(|(on, _)| *on).map(|(_, word)| *word).collect();
    lines.push(format!("view: {}  speed {:.2} m/s{modes}", controls.show.name(), controls.camera.speed()));
    lines.extend([lab.caption(), told].into_iter().flat_map(str::lines).map(str::to_owned));
    let letters = letters.clamp(SHORTEST_LINE, LINE);
    lines.iter().flat_map(|line| wrapped(line, letters)).collect()
}

/// Each stage and its time, in the frame's order, summed over its runs; of many, those that took longest.
pub fn stages(lab: &Lab) -> Vec<String> {
    let all = by_label(&lab.known.stages);
    let mut times: Vec<f64> = all.iter().map(|(_, ms)| *ms).collect();
    times.sort_unstable_by(|a, b| b.total_cmp(a));
    let least = times.get(STAGES - 1).copied().unwrap_or(0.0);
    let shown = all.iter().filter(|(_, ms)| *ms >= least).take(STAGES);
    shown.map(|(label, ms)| format!("{ms:8.2} ms  {label}")).collect()
}

/// What the keys do.
pub fn help() -> Vec<String> {
    KEYS.iter().filter(|(.., help)| !help.is_empty()).map(|(.., help)| (*help).to_owned()).collect()
}

/// A line cut at blanks into lines of so many letters; a longer word is left whole.
fn wrapped(line: &str, letters: usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in line.split(' ') {
        match lines.last_mut() {
            Some(last) if last.len() + word.len() < letters => {
                if !last.is_empty() {
                    last.push(' ');
                }
                last.push_str(word);
            }
            _ => lines.push(format!("  {word}")),
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_lines_are_cut_at_blanks_and_nothing_is_lost() {
        let line: String = (0..60).map(|word| format!("word{word} ")).collect();
        let lines = wrapped(line.trim(), LINE);
        assert!(lines.len() > 4 && lines.iter().all(|line| line.len() <= LINE));
        let words = |text: &str| text.split_whitespace().map(str::to_owned).collect::<Vec<_>>();
        assert_eq!(words(&lines.join(" ")), words(&line));
        assert_eq!(wrapped("short", LINE), ["short"]);
    }

    #[test]
    fn the_help_fits_the_font_and_a_small_window() {
        assert!(help().iter().all(|line| line.is_ascii() && line.len() < 64));
    }
}
