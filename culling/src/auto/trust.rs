//! How far `auto` may trust a method that misses objects (`allow-error`). Nobody knows the truth while frames run; but what such a method
//! left out can be tested once more against the depth of what it drew, as `woc-exact` does: what then comes up holds all that was missed,
//! and more. So some of its frames are checked so. Those between are not: that is why `auto` calls itself approximate then.

/// One in so many frames in a row is checked, and the first `FIRST`.
pub const EVERY: u32 = 16;
/// Frames that are checked when it begins. The first of them is not judged: its last frame is long ago.
const FIRST: u32 = 2;
/// Frames for which it is not used after it erred by more than is allowed.
const BARRED: u32 = 240;

/// Counts frames and judges checks. Plain code: no device.
#[derive(Clone, Debug)]
pub struct Trust {
    allowed_percent: f64,
    in_row: u32,
    barred: u32,
}

impl Trust {
    /// Errors of up to so many percent of what is drawn are allowed.
    pub fn new(allowed_percent: f64) -> Self {
        Trust { allowed_percent, in_row: 0, barred: 0 }
    }

    /// A frame begins. True if it is one of the method's and is to be checked.
    pub fn begin(&mut self, used: bool) -> bool {
        self.barred = self.barred.saturating_sub(1);
        self.in_row = if used { self.in_row + 1 } else { 0 };
        used && (self.in_row <= FIRST || self.in_row.is_multiple_of(EVERY))
    }

    /// What a checked frame would have missed, percent; none: that cannot be told.
    pub fn judge(&mut self, percent: Option<f64>) {
        let is_fine = percent.is_some_and(|percent| percent <= self.allowed_percent);
        if self.in_row > 1 && !is_fine {
            self.barred = BARRED;
        }
    }

    /// It may be used.
    pub fn allows(&self) -> bool {
        self.barred == 0
    }

    /// The next frame is the first.
    pub fn forget(&mut self) {
        self.in_row = 0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_frames_and_one_in_sixteen_are_checked() {
        let mut trust = Trust::new(1.0);
        let checked: Vec<u32> = (1..=48).filter(|_| trust.begin(true)).collect();
        assert_eq!(checked, [1, 2, 16, 32, 48]);
        assert!(!trust.begin(false) && trust.begin(true), "after others it begins anew");
    }

    #[test]
    fn who_errs_is_barred_for_a_while_but_not_for_what_its_first_frame_says() {
        let mut trust = Trust::new(0.5);
        trust.begin(true);
        trust.judge(Some(80.0));
        assert!(trust.allows());
        trust.begin(true);
        trust.judge(Some(0.5));
        assert!(trust.allows(), "as much is allowed");
        for unfit in [Some(0.51), None, Some(f64::NAN)] {
            let mut trust = trust.clone();
            trust.judge(unfit);
            let mut barred = 0;
            while !trust.allows() {
                trust.begin(false);
                barred += 1;
            }
            assert_eq!(barred, BARRED, "{unfit:?}");
        }
    }
}
