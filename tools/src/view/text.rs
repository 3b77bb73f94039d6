//! Text as pixels: lines in a font of 8x8 dots, light on dark.

use font8x8::legacy::BASIC_LEGACY;

/// Dots of a letter's side.
const DOTS: usize = 8;
/// Pixels between lines, and around the text, at scale 1.
const GAP: usize = 3;

const PAPER: [u8; 4] = [16, 18, 24, 255];
const INK: [u8; 4] = [225, 230, 235, 255];

/// A rectangle of text.
pub struct Text {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Row by row from the top.
    pub pixels: Vec<[u8; 4]>,
}

impl Text {
    /// Lines of text, each dot of a letter `scale` pixels large; none for no lines. What the font lacks is shown as `?`.
    pub fn of(lines: &[String], scale: u32) -> Option<Text> {
        let scale = scale.max(1) as usize;
        let letters = lines.iter().map(|line| line.chars().count()).max().filter(|letters| *letters > 0)?;
        let width = scale * (letters * DOTS + 2 * GAP);
        let height = scale * (lines.len() * (DOTS + GAP) + GAP);
        let mut text = Text { size: [width as u32, height as u32], pixels: vec![PAPER; width * height] };
        for (row, line) in lines.iter().enumerate() {
            for (column, letter) in line.chars().enumerate() {
                text.write(letter, [GAP + column * DOTS, GAP + row * (DOTS + GAP)], scale);
            }
        }
        Some(text)
    }

    /// How many letters stand side by side in so many pixels.
    pub fn letters(width: u32, scale: u32) -> usize {
        ((width / scale.max(1)) as usize).saturating_sub(2 * GAP) / DOTS
    }

    fn write(&mut self, letter: char, [left, top]: [usize; 2], scale: usize) {
        let glyph = BASIC_LEGACY.get(letter as usize).unwrap_or(&BASIC_LEGACY[b'?' as usize]);
        let width = self.size[0] as usize;
        for (y, x) in (0..DOTS * scale).flat_map(|y| (0..DOTS * scale).map(move |x| (y, x))) {
            if glyph[y / scale] >> (x / scale) & 1 == 1 {
                self.pixels[(top * scale + y) * width + left * scale + x] = INK;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ink(text: &Text) -> usize {
        text.pixels.iter().filter(|pixel| **pixel == INK).count()
    }

    #[test]
    fn letters_have_their_dots_at_every_scale() {
        let of = |line: &str, scale| Text::of(&[line.to_owned()], scale).unwrap();
        let dots = BASIC_LEGACY[b'A' as usize].iter().map(|row| row.count_ones() as usize).sum::<usize>();
        assert!(dots > 10);
        assert_eq!(ink(&of("A", 1)), dots);
        assert_eq!(ink(&of("AA", 3)), 2 * 9 * dots);
        assert_eq!(ink(&of(" ", 1)), 0);
        assert_eq!(ink(&of("\u{1f600}", 1)), ink(&of("?", 1)), "what the font lacks");
        assert_eq!(of("AB", 2).size, [2 * (16 + 6), 2 * (8 + 6)]);
    }

    #[test]
    fn as_many_letters_as_fit_do_fit() {
        for (width, scale) in [(640, 1), (633, 2), (9, 3)] {
            let letters = Text::letters(width, scale);
            let text = |letters: usize| Text::of(&["x".repeat(letters)], scale);
            assert!(text(letters).is_none_or(|text| text.size[0] <= width));
            assert!(text(letters + 1).unwrap().size[0] > width);
        }
    }

    #[test]
    fn no_lines_make_no_panel() {
        assert!(Text::of(&[], 1).is_none());
        assert!(Text::of(&[String::new()], 1).is_none());
    }
}
