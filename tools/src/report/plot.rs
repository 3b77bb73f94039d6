//! What all plots share: axes, colours, marks, and numbers as text.

use serde::Serialize;

/// Colours that the style sheet has, as classes `c0` and so on.
pub const COLOURS: usize = 10;

/// Pixels from the left to the right edge of each plot.
pub const WIDTH: f64 = 900.0;

/// How values are spread over an axis.
#[derive(Clone, Copy)]
pub enum Scale {
    /// Evenly.
    Linear,
    /// By their ratios; for values above 0.
    Log,
    /// Evenly up to about this value, by their ratios beyond it: 0 has a place.
    Symlog(f64),
}

/// Values from `values[0]` to `values[1]`, drawn from `pixels[0]` to `pixels[1]`.
pub struct Axis {
    /// How the values are spread.
    pub scale: Scale,
    /// The ends, different from each other.
    pub values: [f64; 2],
    /// Where the ends are.
    pub pixels: [f64; 2],
}

/// A mark on an axis.
#[derive(Serialize)]
pub struct Tick {
    /// Pixels.
    pub at: f64,
    /// The value.
    pub label: String,
}

impl Axis {
    /// Where a value is, in tenths of a pixel.
    pub fn place(&self, value: f64) -> f64 {
        let [low, high] = self.values.map(|end| self.stretched(end));
        let share = (self.stretched(value) - low) / (high - low);
        px(self.pixels[0] + share * (self.pixels[1] - self.pixels[0]))
    }

    fn stretched(&self, value: f64) -> f64 {
        match self.scale {
            Scale::Linear => value,
            Scale::Log => value.ln(),
            Scale::Symlog(linear_to) => (value / linear_to).ln_1p(),
        }
    }

    /// Marks at round values between the ends.
    pub fn ticks(&self) -> Vec<Tick> {
        let round = match self.scale {
            Scale::Linear => self.even(),
            Scale::Log => self.decades(&[1.0, 2.0, 5.0], self.values[0]),
            Scale::Symlog(linear_to) => [vec![0.0], self.decades(&[1.0], linear_to)].concat(),
        };
        let inside = round.into_iter().filter(|value| *value >= self.values[0] && *value <= self.values[1]);
        inside.map(|value| Tick { at: self.place(value), label: number(value) }).collect()
    }

    /// About six steps of 1, 2 or 5 times a power of ten.
    fn even(&self) -> Vec<f64> {
        const STEPS: f64 = 6.0;
        let wide = (self.values[1] - self.values[0]) / STEPS;
        let power = 10f64.powf(wide.log10().floor());
        let step = [1.0, 2.0, 5.0, 10.0].into_iter().map(|factor| factor * power).find(|step| *step >= wide);
        let step = step.unwrap_or(10.0 * power);
        let first = (self.values[0] / step).ceil() as i64;
        let last = (self.values[1] / step).floor() as i64;
        (first..=last).map(|count| count as f64 * step).collect()
    }

    fn decades(&self, factors: &[f64], from: f64) -> Vec<f64> {
        let powers = from.log10().floor() as i32..=self.values[1].log10().ceil() as i32;
        let all = powers.flat_map(|power| factors.iter().map(move |factor| factor * 10f64.powi(power)));
        all.filter(|value| *value >= from * 0.999).collect()
    }
}

/// Rounded to tenths, to keep the file small.
pub fn px(value: f64) -> f64 {
    (value * 10.0).round() / 10.0
}

/// The style sheet's class of the method at this place in the list of ids.
pub fn colour(place: usize) -> String {
    format!("c{}", place % COLOURS)
}

/// The outline of a mark: another shape whenever the colours are used up, which also helps who cannot tell colours apart.
pub fn mark(place: usize, x: f64, y: f64) -> String {
    const R: f64 = 5.0;
    let polygon = |corners: &[(f64, f64)]| {
        let corners: Vec<String> =
            corners.iter().map(|(dx, dy)| format!("{},{}", px(x + R * dx), px(y + R * dy))).collect();
        format!("M{}Z", corners.join("L"))
    };
    match place / COLOURS % 3 {
        0 => format!("M{},{}a{R},{R} 0 1 0 {},0a{R},{R} 0 1 0 -{},0Z", px(x - R), px(y), 2.0 * R, 2.0 * R),
        1 => polygon(&[(-0.9, -0.9), (0.9, -0.9), (0.9, 0.9), (-0.9, 0.9)]),
        _ => polygon(&[(0.0, -1.3), (1.2, 0.8), (-1.2, 0.8)]),
    }
}

/// About how wide a text of the plots is, pixels: letters of 12 px in a sans-serif face.
pub fn text_width(text: &str) -> f64 {
    const LETTER: f64 = 6.6;
    LETTER * text.chars().count() as f64
}

/// A text that fits into so many pixels, its end cut off if it must be.
pub fn fitted(text: &str, width: f64) -> String {
    if text_width(text) <= width {
        return text.to_owned();
    }
    let fitting = (width / text_width("m")) as usize;
    text.chars().take(fitting.saturating_sub(1)).chain(['…']).collect()
}

/// Three digits, or all of a whole number, without zeros at the end.
pub fn number(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 {
        return "0".to_owned();
    }
    if !(1e-6..1e15).contains(&size) {
        return format!("{value:.2e}");
    }
    let digits = (2.0 - size.log10().floor()).max(0.0) as usize;
    let text = format!("{value:.digits$}");
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        thousands(&text)
    }
}

/// Digits in groups of three, a thin space between them.
fn thousands(digits: &str) -> String {
    let mut text = String::new();
    for (place, letter) in digits.chars().enumerate() {
        let left = digits.len() - place;
        if place > 0 && left.is_multiple_of(3) && letter.is_ascii_digit() && !text.ends_with('-') {
            text.push('\u{202f}');
        }
        text.push(letter);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(scale: Scale, values: [f64; 2]) -> Vec<String> {
        let axis = Axis { scale, values, pixels: [0.0, 100.0] };
        let ticks = axis.ticks();
        assert!(ticks.windows(2).all(|pair| pair[0].at < pair[1].at), "{values:?}");
        assert!(ticks.iter().all(|tick| (0.0..=100.0).contains(&tick.at)), "{values:?}");
        ticks.into_iter().map(|tick| tick.label).collect()
    }

    #[test]
    fn ticks_are_round_and_inside() {
        assert_eq!(labels(Scale::Linear, [0.0, 10.0]), ["0", "2", "4", "6", "8", "10"]);
        assert_eq!(labels(Scale::Linear, [0.0, 0.7]), ["0", "0.2", "0.4", "0.6"]);
        assert_eq!(labels(Scale::Log, [0.9, 34.0]), ["1", "2", "5", "10", "20"]);
        assert_eq!(labels(Scale::Symlog(0.01), [0.0, 12.0]), ["0", "0.01", "0.1", "1", "10"]);
        assert_eq!(labels(Scale::Linear, [0.0, 1.0]).len(), 6);
    }

    #[test]
    fn the_ends_of_an_axis_are_where_they_belong() {
        for scale in [Scale::Linear, Scale::Log, Scale::Symlog(0.1)] {
            let axis = Axis { scale, values: [0.5, 80.0], pixels: [300.0, 20.0] };
            assert_eq!([axis.place(0.5), axis.place(80.0)], [300.0, 20.0]);
            assert!(axis.place(5.0) < 300.0 && axis.place(5.0) > axis.place(6.0));
        }
    }

    #[test]
    fn numbers_are_short_and_true() {
        let shown = [0.0, -0.0, 1.0, 0.012_34, 5.678, 99.96, 1234.4, 1_234_567.0, 0.5, 1e-9, -20.0].map(number);
        let expected = "0,0,1,0.0123,5.68,100,1\u{202f}234,1\u{202f}234\u{202f}567,0.5,1.00e-9,-20";
        assert_eq!(shown.join(","), expected);
    }

    #[test]
    fn a_text_too_long_is_cut_at_its_end() {
        assert_eq!(fitted("hzb", 100.0), "hzb");
        let cut = fitted("hzb[size=512,texels=8]", 80.0);
        assert!(cut.starts_with("hzb[size") && cut.ends_with('…') && text_width(&cut) <= 80.0, "{cut}");
    }
}
