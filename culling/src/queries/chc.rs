//! `chc`: coherent hierarchical culling (Bittner et al. 2004, as in Zachmann 2008). The hierarchy is walked near to far. What the
//! last frame saw is opened, or drawn, at once; of what it did not see, and of all visible leaves, the box is queried, and
//! traversal goes on elsewhere meanwhile. A node whose box shows is opened.
//!
//! No frame is left out before a still camera: which nodes are open may change from frame to frame though no picture does, and decides
//! in which order the next view is drawn, and so which of two objects at one depth is seen.
//!
//! [`super::nohc`] walks in the same way and asks where it pays.

use super::hierarchy::Hierarchy;
use super::place::Place;
use super::policy::Policy;
use super::recording::{Asking, Recording};
use super::several::BOXES_OPTION;
use super::{MIN_PIXELS_OPTION, WINDOW_OPTION};
use crate::tree::SPLIT_OPTION;
use crate::{Method, OptionInfo, Result, Setup, TestedBoxes, View, Work, World};
use engine::{Frame, Target};

/// Queries under way at once, and the hierarchy's split.
pub const OPTIONS: &[OptionInfo] =
    &[crate::world::DETAIL_OPTION, MIN_PIXELS_OPTION, BOXES_OPTION, WINDOW_OPTION, SPLIT_OPTION];

struct Chc {
    on: Asking,
    walk: Walk,
    window: usize,
}

/// Makes the method.
pub fn make(setup: &Setup<'_>) -> Result<Box<dyn Method>> {
    walking(setup, "chc", Policy::Always)
}

/// A method that walks like this and asks by a policy.
pub(super) fn walking(setup: &Setup<'_>, name: &'static str, policy: Policy) -> Result<Box<dyn Method>> {
    Ok(Box::new(Chc {
        on: Asking::new(setup, name)?,
        walk: Walk { nodes: Hierarchy::new(setup)?, policy, waiting: Vec::new() },
        window: setup.options.number("window") as usize,
    }))
}

impl Method for Chc {
    fn frame(&mut self, f: &mut Frame, world: &World, view: &View, target: &Target) -> Result<()> {
        world.update(f);
        f.clear(target);
        let Chc { on, walk, window, .. } = self;
        if !walk.nodes.begin(world, view)? {
            walk.policy.rebuilt(&walk.nodes, world);
        }
        let mut frame = on.begin(f, (world, view), target, walk.nodes.numbered(world))?;
        walk.nodes.unbounded().iter().try_for_each(|object| frame.draw(*object))?;
        loop {
            // 1. Near to far: open, draw, ask.
            while walk.waiting.len() < *window {
                let Some(node) = walk.nodes.pop() else { break };
                walk.visit(node, &mut frame)?;
            }
            if walk.waiting.is_empty() {
                break;
            }
            // 2. What was asked is answered: what shows is opened, or drawn.
            let answers = frame.wait()?;
            for ((node, was_visible), visible) in std::mem::take(&mut walk.waiting).into_iter().zip(answers) {
                walk.answered(node, was_visible, visible, &mut frame)?;
            }
        }
        frame.end()
    }

    fn work(&self) -> Result<Work> {
        Ok(Work { refits: self.walk.nodes.tree.refitted(), ..self.on.work() })
    }

    fn tested_boxes(&self, _world: &World) -> Result<Option<TestedBoxes>> {
        Ok(Some(self.walk.nodes.shown(self.on.tested())))
    }

    fn choices(&self) -> Vec<String> {
        self.walk.policy.lines()
    }

    fn forget(&mut self) -> Result<()> {
        self.walk.nodes.forget();
        Ok(())
    }
}

/// The walk down the hierarchy.
struct Walk {
    nodes: Hierarchy,
    policy: Policy,
    /// Nodes that were asked about, and whether the last frame saw them.
    waiting: Vec<(u32, bool)>,
}

impl Walk {
    fn visit(&mut self, node: u32, frame: &mut Recording<'_>) -> Result<()> {
        let place = self.nodes.place(node);
        if place == Place::Outside {
            return Ok(());
        }
        let was_visible = self.nodes.was_visible(node);
        let is_leaf = self.nodes.children(node).is_none();
        let ends_here = is_leaf || was_visible && self.nodes.state(node).whole;
        self.nodes.visit(node);
        if place == Place::Near {
            self.nodes.pull_up(node);
            return self.nodes.open(node, frame);
        }
        if was_visible && !ends_here {
            return self.nodes.open(node, frame);
        }
        if !self.policy.asks(&mut self.nodes, node, was_visible) {
            self.nodes.pull_up(node);
            self.nodes.state_mut(node).whole = !is_leaf;
            return self.draw_all(node, frame);
        }
        frame.ask(self.nodes.asked(node))?;
        self.waiting.push((node, was_visible));
        // What was visible is drawn whatever the answer, which is for the next frame.
        if was_visible {
            self.draw_all(node, frame)?;
        }
        Ok(())
    }

    fn answered(&mut self, node: u32, was_visible: bool, visible: bool, frame: &mut Recording<'_>) -> Result<()> {
        if !visible {
            self.nodes.state_mut(node).whole = false;
            return Ok(());
        }
        self.nodes.pull_up(node);
        if !was_visible {
            self.nodes.state_mut(node).whole = false;
            self.nodes.open(node, frame)?;
        }
        Ok(())
    }

    /// Draws all in view below a node.
    fn draw_all(&mut self, node: u32, frame: &mut Recording<'_>) -> Result<()> {
        let mut below = vec![node];
        while let Some(node) = below.pop() {
            if self.nodes.place(node) == Place::Outside {
                continue;
            }
            match self.nodes.children(node) {
                Some([first, second]) => below.extend([second, first]),
                None => self.nodes.object(node).into_iter().try_for_each(|object| frame.draw(object))?,
            }
        }
        Ok(())
    }
}
