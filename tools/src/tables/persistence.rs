//! How long what is hidden stays hidden: the plot of visibility persistence in Zachmann's lecture (2008), from true visible sets.

use culling::VisibleSets;

/// Objects of a run that came to be hidden: how long they stayed so.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct HiddenRuns {
    /// By a number of frames, less one: how often an object had been hidden for so many, with a next frame to look at.
    hidden: Vec<u64>,
    /// The same, of those that were hidden in the next frame too.
    again: Vec<u64>,
}

impl HiddenRuns {
    /// Of a run's visible sets. What was hidden in the first frame is left out until it shows: nobody knows since when it was hidden.
    pub fn of(sets: &VisibleSets) -> Self {
        let frames = sets.len();
        let mut runs = HiddenRuns { hidden: vec![0; frames], again: vec![0; frames] };
        for object in 0..sets.objects() {
            let mut hidden_for: Option<usize> = None;
            for frame in 0..frames {
                let visible = sets.frame(frame).is_some_and(|set| set.contains(object));
                if let Some(frames) = hidden_for.filter(|frames| *frames > 0) {
                    runs.hidden[frames - 1] += 1;
                    runs.again[frames - 1] += u64::from(!visible);
                }
                hidden_for = if visible { Some(0) } else { hidden_for.map(|frames| frames + 1) };
            }
        }
        runs
    }

    /// Of what had been hidden for so many frames, the share that was hidden in the next too; none if nothing had been.
    pub fn hidden_again(&self, frames: usize) -> Option<f64> {
        let at = frames.checked_sub(1)?;
        let hidden = self.hidden.get(at).filter(|hidden| **hidden > 0)?;
        Some(self.again[at] as f64 / *hidden as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The visible objects of each frame.
    fn sets(frames: &[&[u32]]) -> VisibleSets {
        let mut sets = VisibleSets::new(4);
        frames.iter().for_each(|items| sets.push_items(items));
        sets
    }

    #[test]
    fn what_is_hidden_counts_from_when_it_was_last_seen() {
        // 0 hides for three frames and shows again, 1 hides at the end, 2 is seen always, 3 never.
        let runs = HiddenRuns::of(&sets(&[&[0, 1, 2], &[1, 2], &[1, 2], &[2], &[0, 2]]));
        assert_eq!(runs.hidden[..3], [2, 1, 1]);
        assert_eq!(runs.again[..3], [2, 1, 0]);
        assert_eq!([1, 2, 3].map(|frames| runs.hidden_again(frames)), [Some(1.0), Some(1.0), Some(0.0)]);
        assert_eq!([0, 4, 99].map(|frames| runs.hidden_again(frames)), [None; 3]);
    }

    #[test]
    fn the_last_frame_says_nothing_of_what_it_hides() {
        let runs = HiddenRuns::of(&sets(&[&[0], &[]]));
        assert_eq!(runs.hidden_again(1), None);
        assert_eq!(HiddenRuns::of(&sets(&[])), HiddenRuns::default());
    }
}
