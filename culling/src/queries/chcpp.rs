//! `chc++` (Zachmann 2008; Mattausch et al. 2008): `chc` with fewer queries and state changes.
//!
//! - Nodes that were hidden wait in the *i-queue* until there are `b`, and are then asked about in one run, those that have long
//!   been hidden together ([`super::multi`]).
//! - Leaves that were visible are taken for visible for `n_av` frames, the first of which are cut short by chance so that not all
//!   come due at once; then they wait in the *v-queue*. The paper asks about them while it waits for answers. Here waiting ends
//!   with a submission, which they would only make longer: they are asked about at the end of the frame, and answered in the next.
//! - A node is asked about by the boxes of the nodes below it, as far as those have at most `s_max` times its surface.
//!
//! No frame is left out before a still camera: visible leaves come due while nothing else changes, and which frames ran decides what the
//! next view begins with.

use super::hierarchy::Hierarchy;
use super::multi;
use super::place::Place;
use super::recording::{Asking, Recording};
use super::several::BOXES_OPTION;
use super::{MIN_PIXELS_OPTION, WINDOW_OPTION};
use crate::tree::SPLIT_OPTION;
use crate::{Method, OptionInfo, Result, Setup, TestedBoxes, View, Work, World};
use engine::{Frame, Target};
use scenes::bvh::Bvh;
use scenes::Aabb;

/// The parameters of the paper, at its values.
pub const OPTIONS: &[OptionInfo] = &[
    crate::world::DETAIL_OPTION,
    MIN_PIXELS_OPTION,
    BOXES_OPTION,
    WINDOW_OPTION,
    SPLIT_OPTION,
    OptionInfo {
        name: "n_av",
        default: "10",
        values: "1..=1000",
        help: "frames for which a visible leaf is taken for visible without a query",
    },
    OptionInfo {
        name: "b",
        default: "50",
        values: "1..=1000",
        help: "hidden nodes that wait to be queried in one run",
    },
    OptionInfo {
        name: "d_max",
        default: "3",
        values: "0..=6",
        help: "tight bounds: levels below a node whose boxes may stand for its own; 0 asks about its own",
    },
    OptionInfo {
        name: "s_max",
        default: "1.4",
        values: "1|1.2|1.4|1.6|2|3|10",
        help: "tight bounds: their surface at most, as a multiple of the node's",
    },
    OptionInfo {
        name: "multi",
        default: "true",
        values: "true|false",
        help: "ask about several nodes at once where all are likely to be hidden",
    },
];

struct ChcPlusPlus {
    on: Asking,
    walk: Walk,
    /// Leaves that the last frame asked about at its end.
    left: Vec<u32>,
    window: usize,
}

/// Makes the method.
pub fn make(setup: &Setup<'_>) -> Result<Box<dyn Method>> {
    let options = setup.options;
    Ok(Box::new(ChcPlusPlus {
        on: Asking::new(setup, "chc++")?,
        walk: Walk {
            nodes: Hierarchy::new(setup)?,
            i_queue: Vec::new(),
            v_queue: Vec::new(),
            waiting: Vec::new(),
            batch: options.number("b") as usize,
            assumed_frames: u64::from(options.number("n_av")),
            levels: options.number("d_max"),
            surface: options.text("s_max").parse().unwrap_or(1.0),
            multiqueries: options.flag("multi"),
        },
        left: Vec::new(),
        window: options.number("window") as usize,
    }))
}

impl Method for ChcPlusPlus {
    fn frame(&mut self, f: &mut Frame, world: &World, view: &View, target: &Target) -> Result<()> {
        world.update(f);
        f.clear(target);
        self.check_last_answers()?; // 1. leaves that the last frame asked about
        let ChcPlusPlus { on, walk, window, left, .. } = self;
        walk.nodes.begin(world, view)?;
        let mut frame = on.begin(f, (world, view), target, walk.nodes.numbered(world))?;
        walk.nodes.unbounded().iter().try_for_each(|object| frame.draw(*object))?;
        loop {
            while walk.waiting.len() < *window {
                let Some(node) = walk.nodes.pop() else { break };
                walk.visit(node, &mut frame)?; // 2. near to far: open, draw, queue
            }
            walk.issue_multiqueries(&mut frame)?; // 3. nothing is left to visit, or enough is under way
            if walk.waiting.is_empty() {
                break;
            }
            let answers = frame.wait()?;
            for (nodes, visible) in std::mem::take(&mut walk.waiting).into_iter().zip(answers) {
                if visible {
                    walk.shows(&nodes, &mut frame)?; // 4. what shows is opened, or asked about one by one
                }
            }
        }
        *left = std::mem::take(&mut walk.v_queue);
        left.iter().try_for_each(|node| walk.ask(&[*node], &mut frame))?; // 5. the rest of the v-queue
        frame.end()
    }

    fn work(&self) -> Result<Work> {
        Ok(Work { refits: self.walk.nodes.tree.refitted(), ..self.on.work() })
    }

    fn tested_boxes(&self, _world: &World) -> Result<Option<TestedBoxes>> {
        Ok(Some(self.walk.nodes.shown(self.on.tested())))
    }

    fn forget(&mut self) -> Result<()> {
        self.walk.nodes.forget();
        self.left.clear();
        self.on.last_answers()?;
        Ok(())
    }
}

impl ChcPlusPlus {
    /// A visible leaf whose box no longer shows is hidden from now on. (If the tree is then built anew, all is forgotten anyway.)
    fn check_last_answers(&mut self) -> Result<()> {
        let answers = self.on.last_answers()?;
        for (leaf, visible) in self.left.drain(..).zip(answers) {
            let frame = self.walk.nodes.frame;
            let state = self.walk.nodes.state_mut(leaf);
            state.visible &= visible;
            state.hidden_since = frame;
        }
        Ok(())
    }
}

/// The walk down the hierarchy, and its queues.
struct Walk {
    nodes: Hierarchy,
    i_queue: Vec<u32>,
    v_queue: Vec<u32>,
    /// The nodes of each query under way.
    waiting: Vec<Vec<u32>>,
    batch: usize,
    assumed_frames: u64,
    levels: u32,
    surface: f64,
    multiqueries: bool,
}

impl Walk {
    fn visit(&mut self, node: u32, frame: &mut Recording<'_>) -> Result<()> {
        let place = self.nodes.place(node);
        if place == Place::Outside {
            return Ok(());
        }
        let was_visible = self.nodes.was_visible(node);
        self.nodes.visit(node);
        if place == Place::Near {
            self.nodes.pull_up(node);
            return self.nodes.open(node, frame);
        }
        if !was_visible {
            self.i_queue.push(node);
            return if self.i_queue.len() >= self.batch { self.issue_multiqueries(frame) } else { Ok(()) };
        }
        if self.nodes.children(node).is_none() {
            self.nodes.pull_up(node);
            let now = self.nodes.frame;
            if now >= self.nodes.state(node).test {
                self.nodes.state_mut(node).test = now + self.assumed_frames;
                self.v_queue.push(node);
            }
        }
        self.nodes.open(node, frame)
    }

    /// Asks about all in the i-queue.
    fn issue_multiqueries(&mut self, frame: &mut Recording<'_>) -> Result<()> {
        let hidden = std::mem::take(&mut self.i_queue);
        let groups = if self.multiqueries {
            multi::group(hidden.into_iter().map(|node| (node, self.nodes.hidden_for(node))).collect())
        } else {
            hidden.into_iter().map(|node| vec![node]).collect()
        };
        for nodes in groups {
            self.ask(&nodes, frame)?;
            self.waiting.push(nodes);
        }
        Ok(())
    }

    /// Some node of a query shows.
    fn shows(&mut self, nodes: &[u32], frame: &mut Recording<'_>) -> Result<()> {
        if let [node] = *nodes {
            self.nodes.pull_up(node);
            self.nodes.state_mut(node).test = first_test(node, self.nodes.frame, self.assumed_frames);
            return self.nodes.open(node, frame);
        }
        for node in nodes {
            self.ask(&[*node], frame)?;
            self.waiting.push(vec![*node]);
        }
        Ok(())
    }

    fn ask(&self, nodes: &[u32], frame: &mut Recording<'_>) -> Result<()> {
        let tight = |node: &u32| tight_bounds(self.nodes.tree.host(), *node, self.levels, self.surface);
        let boxes: Vec<u32> = nodes.iter().flat_map(tight).flat_map(|node| self.nodes.asked(node)).collect();
        frame.ask(boxes.into_iter())
    }
}

/// The frame of the first test of a leaf that a frame found visible: one of the next `assumed_frames`, by chance, so that leaves that come
/// into view together are not tested together.
fn first_test(node: u32, frame: u64, assumed_frames: u64) -> u64 {
    frame + 1 + chance(node, frame) % assumed_frames
}

/// A number by chance, always the same for a node and frame (SplitMix64).
fn chance(node: u32, frame: u64) -> u64 {
    let mixed = (u64::from(node) ^ frame << 32).wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    mixed ^ (mixed >> 31)
}

/// The nodes whose boxes stand for a node's own: those at most `levels` below it, as deep as all of them together have no more than
/// `surface` times its surface.
pub fn tight_bounds(bvh: &Bvh, node: u32, levels: u32, surface: f64) -> Vec<u32> {
    let most = surface * area(&bvh.nodes()[node as usize].bounds);
    let mut tight = vec![node];
    for _ in 0..levels {
        let below = |node: &u32| match bvh.nodes()[*node as usize].children() {
            Some(children) => children.to_vec(),
            None => vec![*node],
        };
        let finer: Vec<u32> = tight.iter().flat_map(below).collect();
        let sum: f64 = finer.iter().map(|node| area(&bvh.nodes()[*node as usize].bounds)).sum();
        if finer.len() == tight.len() || sum > most {
            break;
        }
        tight = finer;
    }
    tight
}

/// An eighth of a box's surface.
fn area(bounds: &Aabb) -> f64 {
    let half = bounds.half_extent();
    half.x * half.y + half.y * half.z + half.z * half.x
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use scenes::bvh::Split;

    fn boxes_apart() -> Bvh {
        let cube = |x: f64| Aabb { min: DVec3::new(x, 0.0, 0.0), max: DVec3::new(x + 1.0, 1.0, 1.0) };
        Bvh::build(&(0..32).map(|index| cube(100.0 * f64::from(index))).collect::<Vec<_>>(), Split::Sah).unwrap()
    }

    #[test]
    fn leaves_that_are_shown_together_fall_due_apart() {
        for (frame, assumed) in [(1, 10), (7, 10), (7, 4), (1_000_000, 10)] {
            let mut due = vec![0; assumed as usize];
            for node in 0..1_000 {
                due[(first_test(node, frame, assumed) - frame - 1) as usize] += 1;
            }
            // A fair share of 1,000 leaves, give or take four standard deviations of a binomial distribution.
            let (share, chance) = (1e3 / assumed as f64, 1.0 / assumed as f64);
            let spread = 4.0 * (share * (1.0 - chance)).sqrt();
            assert!(due.iter().all(|due| (f64::from(*due) - share).abs() < spread), "frame {frame}: {due:?}");
        }
        assert_eq!(first_test(3, 7, 1), 8, "of one frame there is no choice");
        assert_eq!(first_test(3, 7, 10), first_test(3, 7, 10));
        let in_a_row: std::collections::BTreeSet<u64> =
            (0..100).map(|frame| first_test(3, frame, 10) - frame).collect();
        assert_eq!(in_a_row.len(), 10, "the same leaf is not always tested as soon after it shows");
    }

    #[test]
    fn tight_bounds_hold_the_same_objects_and_keep_to_their_surface() {
        let bvh = boxes_apart();
        for levels in 0..6 {
            for surface in [1.0, 1.4, 10.0] {
                let tight = tight_bounds(&bvh, 0, levels, surface);
                let below: u32 = tight.iter().map(|node| bvh.nodes()[*node as usize].objects_below).sum();
                assert_eq!(below, 32, "{tight:?}");
                assert!(tight.len() <= 1 << levels);
                let sum: f64 = tight.iter().map(|node| area(&bvh.nodes()[*node as usize].bounds)).sum();
                assert!(tight.len() == 1 || sum <= surface * area(&bvh.nodes()[0].bounds));
            }
        }
        assert_eq!(tight_bounds(&bvh, 0, 3, 1.4).len(), 8, "boxes with gaps between them have less surface apart");
    }
}
