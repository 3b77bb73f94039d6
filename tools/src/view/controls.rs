//! What is switched on, and what each key changes about it: plain data, without window or device.

use super::camera::{Course, FlyCamera};
use super::keys::{Input, Key};
use glam::DVec2;
use std::collections::HashSet;

/// What the window shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Show {
    /// The picture.
    #[default]
    Colour,
    /// Depth as grey.
    Depth,
    /// A level of the farthest-depth map.
    Farthest,
    /// One colour an object.
    Items,
    /// How often each pixel was shaded.
    Overdraw,
    /// Where the last frame's pixels go.
    Motion,
    /// Where depth warped from the last frame is wrong.
    WarpError,
    /// The boxes of groups that the method tested.
    Groups,
    /// All boxes that it tested.
    Boxes,
    /// What was drawn without being visible, and what was lost.
    FalsePositives,
}

impl Show {
    /// All views, in the order of the key.
    pub const ALL: [Show; 10] = [
        Show::Colour,
        Show::Depth,
        Show::Farthest,
        Show::Items,
        Show::Overdraw,
        Show::Motion,
        Show::WarpError,
        Show::Groups,
        Show::Boxes,
        Show::FalsePositives,
    ];

    /// What it is called on the screen.
    pub fn name(self) -> &'static str {
        match self {
            Show::Colour => "colour",
            Show::Depth => "depth",
            Show::Farthest => "farthest depth",
            Show::Items => "item buffer",
            Show::Overdraw => "overdraw",
            Show::Motion => "motion",
            Show::WarpError => "warp error",
            Show::Groups => "occludee groups",
            Show::Boxes => "tested boxes",
            Show::FalsePositives => "false positives",
        }
    }

    fn after(self) -> Show {
        let place = Self::ALL.iter().position(|show| *show == self).unwrap_or(0);
        Self::ALL[(place + 1) % Self::ALL.len()]
    }
}

/// What a key asks of the program beyond a switch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Command {
    /// Save the camera as a path of one frame.
    SaveCamera,
    /// Save the path that was recorded.
    SaveRecording,
    /// Save what the window shows.
    Screenshot,
    /// Run with shaders as their sources are now.
    ReloadShaders,
    /// Go on with the next device.
    NextDevice,
    /// Close the window.
    Quit,
}

/// All switches.
#[derive(Clone, Debug)]
pub struct Controls {
    /// The camera that keys and mouse move.
    pub camera: FlyCamera,
    /// Which of the methods runs.
    pub method: usize,
    /// How many there are.
    methods: usize,
    /// Off: everything is drawn.
    pub culling: bool,
    /// The lists stay as they are; the camera does not.
    pub frozen: bool,
    /// What is shown.
    pub show: Show,
    /// Which level of the farthest-depth map, counted on without end.
    pub level: u32,
    /// Compare each frame with the truth.
    pub truth: bool,
    /// The path leads the camera.
    pub playing: bool,
    /// Each frame's camera is kept.
    pub recording: bool,
    /// The keys are told on the screen.
    pub help: bool,
    held: HashSet<Key>,
}

impl Controls {
    /// The first of so many methods, with culling, and the keys told.
    pub fn new(camera: FlyCamera, methods: usize) -> Self {
        Controls {
            camera,
            method: 0,
            methods,
            culling: true,
            frozen: false,
            show: Show::default(),
            level: 0,
            truth: false,
            playing: false,
            recording: false,
            help: true,
            held: HashSet::new(),
        }
    }

    /// Does what an input asks for, and says what the program has to do.
    pub fn handle(&mut self, input: Input) -> Option<Command> {
        match input {
            Input::Down(key) if self.held.insert(key) => return self.press(key),
            // A key that is held repeats; once is enough.
            Input::Down(_) => {}
            Input::Up(key) => {
                self.held.remove(&key);
            }
            Input::Look(right, down) => {
                self.playing = false;
                self.camera.turn(DVec2::new(right, down));
            }
            Input::Wheel(notches) => self.camera.change_speed(notches),
        }
        None
    }

    /// No key is held any more: the window lost the keyboard.
    pub fn let_go(&mut self) {
        self.held.clear();
    }

    /// Moves the camera for so many seconds. Who flies leaves the path.
    pub fn fly(&mut self, seconds: f64) {
        let course = self.course();
        if course != (Course { hurry: course.hurry, ..Course::default() }) {
            self.playing = false;
            self.camera.fly(course, seconds);
        }
    }

    fn course(&self) -> Course {
        let axis = |ahead: Key, back: Key| {
            f64::from(u8::from(self.held.contains(&ahead))) - f64::from(u8::from(self.held.contains(&back)))
        };
        Course {
            right: axis(Key::D, Key::A),
            up: axis(Key::E, Key::Q),
            forward: axis(Key::W, Key::S),
            hurry: self.held.contains(&Key::Shift),
        }
    }

    fn press(&mut self, key: Key) -> Option<Command> {
        match key {
            Key::W | Key::A | Key::S | Key::D | Key::Q | Key::E | Key::Shift => {}
            Key::Space => self.playing = !self.playing,
            Key::Tab => self.method = (self.method + 1) % self.methods.max(1),
            Key::C => self.culling = !self.culling,
            Key::F => self.frozen = !self.frozen,
            Key::V => self.show = self.show.after(),
            Key::L => self.level += 1,
            Key::T => self.truth = !self.truth,
            Key::H => self.help = !self.help,
            Key::B => {
                self.recording = !self.recording;
                return (!self.recording).then_some(Command::SaveRecording);
            }
            Key::P => return Some(Command::SaveCamera),
            Key::R => return Some(Command::ReloadShaders),
            Key::G => return Some(Command::NextDevice),
            Key::F12 => return Some(Command::Screenshot),
            Key::Escape => return Some(Command::Quit),
        }
        // Another method has other lists: what was frozen is gone.
        if matches!(key, Key::Tab | Key::C) {
            self.frozen = false;
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::keys::KEYS;
    use scenes::{Pose, Scene};

    fn controls() -> Controls {
        let pose = Pose { position: glam::DVec3::ZERO, rotation: glam::DQuat::IDENTITY };
        Controls::new(FlyCamera::new(&Scene::default(), &pose), 3)
    }

    fn press(controls: &mut Controls, key: Key) -> Option<Command> {
        let command = controls.handle(Input::Down(key));
        assert_eq!(controls.handle(Input::Up(key)), None);
        command
    }

    #[test]
    fn every_key_changes_something() {
        for (key, name, _) in KEYS {
            let flies = matches!(key, Key::W | Key::A | Key::S | Key::D | Key::Q | Key::E | Key::Shift);
            let after = |pressed: bool| {
                let mut controls = controls();
                if key != Key::W {
                    controls.handle(Input::Down(Key::W));
                }
                let command = if pressed { controls.handle(Input::Down(key)) } else { None };
                if flies {
                    controls.fly(1.0);
                }
                controls.let_go();
                (command, format!("{controls:?}"))
            };
            assert_ne!(after(true), after(false), "{name}");
        }
    }

    #[test]
    fn methods_and_views_come_around() {
        let mut controls = controls();
        let methods: Vec<usize> = (0..4).map(|_| (press(&mut controls, Key::Tab), controls.method).1).collect();
        assert_eq!(methods, [1, 2, 0, 1]);
        for expected in Show::ALL.into_iter().cycle().skip(1).take(11) {
            press(&mut controls, Key::V);
            assert_eq!(controls.show, expected);
        }
    }

    #[test]
    fn a_held_key_is_pressed_once_and_flies_on() {
        let mut controls = controls();
        (0..3).for_each(|_| assert_eq!(controls.handle(Input::Down(Key::Tab)), None));
        assert_eq!(controls.method, 1);
        controls.handle(Input::Down(Key::D));
        let before = controls.camera.pose().position;
        controls.fly(1.0);
        assert!(controls.camera.pose().position.x > before.x);
        controls.let_go();
        let after = controls.camera.pose();
        controls.fly(1.0);
        assert_eq!(controls.camera.pose(), after);
    }

    #[test]
    fn another_method_thaws_and_flying_leaves_the_path() {
        let mut controls = controls();
        press(&mut controls, Key::F);
        assert!(controls.frozen);
        press(&mut controls, Key::Tab);
        assert!(!controls.frozen);
        press(&mut controls, Key::Space);
        controls.fly(1.0);
        assert!(controls.playing);
        controls.handle(Input::Down(Key::Shift));
        controls.fly(1.0);
        assert!(controls.playing, "Shift alone goes nowhere");
        controls.handle(Input::Down(Key::W));
        controls.fly(1.0);
        assert!(!controls.playing);
    }

    #[test]
    fn a_recording_is_saved_when_it_ends() {
        let mut controls = controls();
        assert_eq!(press(&mut controls, Key::B), None);
        assert!(controls.recording);
        assert_eq!(press(&mut controls, Key::B), Some(Command::SaveRecording));
        assert!(!controls.recording);
    }
}
