//! A virtual display for the tests that open windows.

use std::io::{BufRead, BufReader};
use std::process::{Child, Command, Stdio};

/// An X server without a screen, which ends when this is dropped.
///
/// `xvfb-run` chose a free number first and then gave its server three seconds to start, so that two at a time could choose the same one, and
/// a busy machine had no server yet. Here the server chooses a free number and says it once it takes connections.
pub struct Display {
    server: Child,
    name: String,
}

impl Display {
    /// Starts a server with a screen of `size`, `WIDTHxHEIGHT`, and waits until it takes connections.
    pub fn open(size: &str) -> Self {
        let mut xvfb = Command::new("Xvfb");
        xvfb.args(["-displayfd", "1", "-nolisten", "tcp", "-screen", "0", &format!("{size}x24")]);
        let mut server = xvfb
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("Xvfb starts (tools/setup.sh --windows installs it)");
        let mut number = String::new();
        BufReader::new(server.stdout.take().unwrap()).read_line(&mut number).unwrap();
        assert!(!number.trim().is_empty(), "Xvfb ended before it took connections: {:?}", server.wait());
        Display { server, name: format!(":{}", number.trim()) }
    }

    /// A command whose windows open on this display.
    pub fn command(&self, program: &str) -> Command {
        let mut command = Command::new(program);
        command.env("DISPLAY", &self.name).env_remove("WAYLAND_DISPLAY").env_remove("XDG_RUNTIME_DIR");
        command.env_remove("XAUTHORITY");
        command
    }
}

impl Drop for Display {
    fn drop(&mut self) {
        let _ = self.server.kill();
        let _ = self.server.wait();
    }
}
