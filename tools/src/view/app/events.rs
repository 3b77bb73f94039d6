//! Events of the window system become inputs and frames.

use super::{App, TAKEN_AWAY};
use crate::view::controls::Controls;
use crate::view::keys::{Input, Key};
use anyhow::anyhow;
use std::time::{Duration, Instant};
use winit::application::ApplicationHandler;
use winit::event::{DeviceEvent, DeviceId, ElementState, KeyEvent, MouseScrollDelta, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow};
use winit::keyboard::{Key as Letter, KeyCode, PhysicalKey};
use winit::window::{CursorGrabMode, WindowId};

/// How long to rest when the window had no image to give.
const REST: Duration = Duration::from_millis(50);
/// How long to rest while the window is covered or minimised.
const OUT_OF_SIGHT: Duration = Duration::from_millis(250);
/// Pixels of a wheel's notch where it reports pixels.
const NOTCH_PX: f64 = 40.0;

impl ApplicationHandler for App {
    fn resumed(&mut self, event_loop: &ActiveEventLoop) {
        if self.window.is_none() {
            let opened = self.open(event_loop);
            self.settle(opened, event_loop);
        }
    }

    fn window_event(&mut self, event_loop: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        let done = match event {
            WindowEvent::CloseRequested => {
                event_loop.exit();
                Ok(())
            }
            WindowEvent::Destroyed => Err(anyhow!(TAKEN_AWAY)),
            WindowEvent::RedrawRequested => self.frame(event_loop),
            WindowEvent::Resized(size) => {
                self.inner_size = size.into();
                Ok(())
            }
            WindowEvent::Occluded(out_of_sight) => {
                self.out_of_sight = out_of_sight;
                Ok(())
            }
            WindowEvent::Focused(false) => {
                self.drag(false);
                self.controls.iter_mut().for_each(Controls::let_go);
                Ok(())
            }
            WindowEvent::KeyboardInput { event, is_synthetic: false, .. } => match (key_of(&event), event.state) {
                (None, _) => Ok(()),
                (Some(key), ElementState::Pressed) => self.input(Input::Down(key), event_loop),
                (Some(key), ElementState::Released) => self.input(Input::Up(key), event_loop),
            },
            WindowEvent::MouseInput { state, .. } => {
                self.drag(state == ElementState::Pressed);
                Ok(())
            }
            WindowEvent::MouseWheel { delta, .. } => {
                let notches = match delta {
                    MouseScrollDelta::LineDelta(_, lines) => f64::from(lines),
                    MouseScrollDelta::PixelDelta(way) => way.y / NOTCH_PX,
                };
                self.input(Input::Wheel(notches), event_loop)
            }
            _ => Ok(()),
        };
        self.settle(done, event_loop);
    }

    fn device_event(&mut self, event_loop: &ActiveEventLoop, _: DeviceId, event: DeviceEvent) {
        if let (DeviceEvent::MouseMotion { delta: (right, down) }, true) = (event, self.dragging) {
            let done = self.input(Input::Look(right, down), event_loop);
            self.settle(done, event_loop);
        }
    }

    fn about_to_wait(&mut self, event_loop: &ActiveEventLoop) {
        let Some(window) = &self.window else { return };
        let minimised = || window.is_minimized() == Some(true);
        if !self.wish.is_scripted() && (self.out_of_sight || minimised()) {
            // Nobody sees it: the next event wakes us, or a look now and then, as not every window system tells of the end.
            self.last = None;
            event_loop.set_control_flow(ControlFlow::WaitUntil(Instant::now() + OUT_OF_SIGHT));
            return;
        }
        if self.rests {
            std::thread::sleep(REST);
        }
        event_loop.set_control_flow(ControlFlow::Poll);
        window.request_redraw();
    }
}

impl App {
    /// The mouse looks around as long as a button is held.
    fn drag(&mut self, on: bool) {
        let Some(window) = self.window.as_ref().filter(|_| self.dragging != on) else { return };
        self.dragging = on;
        window.set_cursor_visible(!on);
        // Where the pointer cannot be held it ends at the window's edge.
        let mode = if on { CursorGrabMode::Confined } else { CursorGrabMode::None };
        let _ = window.set_cursor_grab(mode);
    }
}

/// Flying goes by where keys lie, everything else by their letters.
fn key_of(event: &KeyEvent) -> Option<Key> {
    let by_place = match event.physical_key {
        PhysicalKey::Code(KeyCode::KeyW) => Some(Key::W),
        PhysicalKey::Code(KeyCode::KeyA) => Some(Key::A),
        PhysicalKey::Code(KeyCode::KeyS) => Some(Key::S),
        PhysicalKey::Code(KeyCode::KeyD) => Some(Key::D),
        PhysicalKey::Code(KeyCode::KeyQ) => Some(Key::Q),
        PhysicalKey::Code(KeyCode::KeyE) => Some(Key::E),
        PhysicalKey::Code(KeyCode::ShiftLeft | KeyCode::ShiftRight) => Some(Key::Shift),
        PhysicalKey::Code(KeyCode::Space) => Some(Key::Space),
        PhysicalKey::Code(KeyCode::Tab) => Some(Key::Tab),
        PhysicalKey::Code(KeyCode::F12) => Some(Key::F12),
        PhysicalKey::Code(KeyCode::Escape) => Some(Key::Escape),
        _ => None,
    };
    let flies = |key: &Key| matches!(key, Key::W | Key::A | Key::S | Key::D | Key::Q | Key::E);
    by_place.or_else(|| match &event.logical_key {
        Letter::Character(letter) => Key::named(letter).filter(|key| !flies(key)),
        _ => None,
    })
}
