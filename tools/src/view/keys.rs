//! The keys that `view` knows, by name and by what they do: one list for the handler, the help on the screen, and `--keys`.

use anyhow::{bail, Context, Result};

/// A key, whatever window system it comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[expect(missing_docs, reason = "each is the key of that name; `KEYS` says what it does")]
pub enum Key {
    W,
    A,
    S,
    D,
    Q,
    E,
    Shift,
    Space,
    Tab,
    C,
    F,
    V,
    L,
    T,
    B,
    P,
    R,
    G,
    H,
    F12,
    Escape,
}

/// Each key, its name, and what it does; what has no words is told with the key before it.
pub const KEYS: [(Key, &str, &str); 21] = [
    (Key::W, "W", "W A S D  fly; drag the mouse to look, wheel for speed"),
    (Key::A, "A", ""),
    (Key::S, "S", ""),
    (Key::D, "D", ""),
    (Key::Q, "Q", "Q E      down, up"),
    (Key::E, "E", ""),
    (Key::Shift, "Shift", "Shift    five times as fast"),
    (Key::Space, "Space", "Space    play the path, or stop"),
    (Key::Tab, "Tab", "Tab      next method"),
    (Key::C, "C", "C        culling on, off"),
    (Key::F, "F", "F        freeze culling; the eye stays free"),
    (Key::V, "V", "V        next view"),
    (Key::L, "L", "L        next level of the depth pyramid"),
    (Key::T, "T", "T        compare with the truth"),
    (Key::B, "B", "B        record a path, or end and save it"),
    (Key::P, "P", "P        save the camera"),
    (Key::R, "R", "R        reload shaders"),
    (Key::G, "G", "G        next device"),
    (Key::H, "H", "H        show the keys, or hide them"),
    (Key::F12, "F12", "F12      screenshot"),
    (Key::Escape, "Esc", "Esc      quit"),
];

impl Key {
    /// The key of a name, in letters of any size.
    pub fn named(name: &str) -> Option<Key> {
        KEYS.iter().find(|(_, known, _)| known.eq_ignore_ascii_case(name)).map(|(key, ..)| *key)
    }
}

/// Something that a person did at keyboard or mouse.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Input {
    /// A key went down.
    Down(Key),
    /// A key came up.
    Up(Key),
    /// The mouse went so many pixels right and down, dragging.
    Look(f64, f64),
    /// The wheel turned by so many notches, away.
    Wheel(f64),
}

/// One step of `--keys`, a frame each.
#[derive(Clone, Debug, PartialEq)]
pub enum Step {
    /// What a person would do.
    Inputs(Vec<Input>),
    /// Frames in which nothing happens.
    Wait(u32),
    /// The window is made another size, in pixels.
    Resize([u32; 2]),
    /// The window is minimised, or brought back.
    Minimise(bool),
    /// The window's surface is made anew, as after the window system took it.
    Surface,
    /// A screenshot under a name.
    Screenshot(String),
}

/// What `--keys` may hold, for its help and errors.
pub const STEPS_HELP: &str = "key names (press and release), +KEY (hold), -KEY (release), N (wait so many frames), \
    look=DX:DY, wheel=N, size=WxH, minimise, restore, surface, shot=FILE";

/// Reads `--keys`.
///
/// # Errors
/// A step that is none, by its name.
pub fn parse_steps(text: &str) -> Result<Vec<Step>> {
    let steps: Vec<&str> = text.split(',').map(str::trim).filter(|step| !step.is_empty()).collect();
    if steps.is_empty() {
        bail!("--keys names no step; write {STEPS_HELP}");
    }
    steps
        .into_iter()
        .map(|step| parse_step(step).with_context(|| format!("--keys: '{step}' is no step; write {STEPS_HELP}")))
        .collect()
}

/// Farther than any mouse goes, and near enough for a camera's numbers to stay finite.
const LONGEST_WAY: f64 = 1e6;

fn way_of(number: &str) -> Result<f64> {
    let number: f64 = number.parse()?;
    (number.abs() <= LONGEST_WAY).then_some(number).context("a number from -1000000 to 1000000 is needed")
}

fn parse_step(step: &str) -> Result<Step> {
    if let Some(key) = Key::named(step) {
        return Ok(Step::Inputs(vec![Input::Down(key), Input::Up(key)]));
    }
    if let Ok(frames) = step.parse() {
        return Ok(Step::Wait(frames));
    }
    if let Some((way, name)) = step.split_at_checked(1).filter(|(way, _)| ["+", "-"].contains(way)) {
        let key = Key::named(name).context("no such key")?;
        return Ok(Step::Inputs(vec![if way == "+" { Input::Down(key) } else { Input::Up(key) }]));
    }
    match step.split_once('=') {
        None if step == "minimise" => Ok(Step::Minimise(true)),
        None if step == "restore" => Ok(Step::Minimise(false)),
        None if step == "surface" => Ok(Step::Surface),
        Some(("look", way)) => {
            let (right, down) = way.split_once(':').context("two numbers are needed")?;
            Ok(Step::Inputs(vec![Input::Look(way_of(right)?, way_of(down)?)]))
        }
        Some(("wheel", notches)) => Ok(Step::Inputs(vec![Input::Wheel(way_of(notches)?)])),
        Some(("size", size)) => {
            let (width, height) = size.split_once('x').context("a width and a height are needed")?;
            let size = [width.parse()?, height.parse()?];
            super::check_size(size)?;
            Ok(Step::Resize(size))
        }
        Some(("shot", file)) if !file.is_empty() => Ok(Step::Screenshot(file.to_owned())),
        _ => bail!("there is no such key or step"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_key_has_a_name_and_the_help_tells_of_each() {
        for (key, name, _) in KEYS {
            assert_eq!(Key::named(&name.to_lowercase()), Some(key));
            assert!(KEYS.iter().any(|(.., help)| help.split(' ').any(|word| word == name)), "{name} is in no help");
        }
    }

    #[test]
    fn steps_are_read_or_refused_by_name() {
        let steps = parse_steps("Tab, +w,12,-W,look=30:-4.5,wheel=-2,size=640x360,minimise,restore,surface,shot=a.png")
            .unwrap();
        let press = |key| Step::Inputs(vec![Input::Down(key), Input::Up(key)]);
        assert_eq!(steps[0], press(Key::Tab));
        assert_eq!(
            steps[1..4],
            [Step::Inputs(vec![Input::Down(Key::W)]), Step::Wait(12), Step::Inputs(vec![Input::Up(Key::W)])]
        );
        assert_eq!(steps[4..6], [Step::Inputs(vec![Input::Look(30.0, -4.5)]), Step::Inputs(vec![Input::Wheel(-2.0)])]);
        assert_eq!(steps[6..9], [Step::Resize([640, 360]), Step::Minimise(true), Step::Minimise(false)]);
        assert_eq!(steps[9..], [Step::Surface, Step::Screenshot("a.png".to_owned())]);
        for bad in [
            "Z",
            "+",
            "+X",
            "look=3",
            "look=1:inf",
            "wheel=nan",
            "wheel=1e300",
            "size=3",
            "size=0x9",
            "size=100000x10",
            "shot=",
            "shut=a",
        ] {
            let error = format!("{:#}", parse_steps(bad).unwrap_err());
            assert!(parse_steps(" , ").unwrap_err().to_string().contains("names no step"));
            assert!(error.contains(&format!("'{bad}' is no step; write key names")), "{error}");
        }
    }
}
