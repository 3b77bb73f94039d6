//! The catalogue of numeric worst cases: rules 1 to 8 of the design, and the bugs that shipped in other engines.
//!
//! A family is one way of being hard, a drill one world of it, by seed: `near-plane/3`. All but those of `worlds::special` are
//! made by chance from the seed and from a number of bodies, so that the same family can be small in a test and large in a
//! long run.

#[cfg(test)]
mod golden;
mod projections;
mod sequences;
mod sizes;
mod surfaces;

use super::worlds::{self, cube, sized, turned, wander, Case, Maker, PERSPECTIVE};
use super::Random;
use anyhow::{bail, Context, Result};
use glam::DVec3;
use scenes::{Projection, Shot};

/// A world, what the camera does in it, and what happens around it.
#[derive(Clone, Debug)]
pub struct Drill {
    /// The scene, its shots and the size of the picture.
    pub case: Case,
    /// The picture's size in each frame, in turn; none: it never changes.
    pub sizes: Vec<[u32; 2]>,
    /// Frames before which the method is told to forget.
    pub forgets: Vec<usize>,
}

impl Drill {
    /// The picture's size in a frame.
    pub fn size(&self, frame: usize) -> [u32; 2] {
        if self.sizes.is_empty() {
            self.case.size
        } else {
            self.sizes[frame % self.sizes.len()]
        }
    }
}

impl Drill {
    /// True if neither the camera, the time nor the size has changed since the frame before, and nothing was forgotten.
    pub fn stands_still(&self, frame: usize) -> bool {
        let shots = &self.case.shots;
        frame > 0
            && shots[frame - 1] == shots[frame]
            && self.size(frame - 1) == self.size(frame)
            && !self.forgets.contains(&frame)
    }
}

impl From<Case> for Drill {
    fn from(case: Case) -> Self {
        Drill { case, sizes: Vec::new(), forgets: Vec::new() }
    }
}

/// One way of being hard.
pub struct Family {
    /// Its name: what an ID begins with.
    pub name: &'static str,
    /// The rule of DESIGN.md, or the bug of PITFALLS.md, that it is for.
    pub rule: &'static str,
    /// Makes a drill of about so many bodies.
    pub make: fn(&mut Random, usize) -> Drill,
}

/// The families, worlds by chance last.
pub const FAMILIES: &[Family] = &[
    Family { name: "near-plane", rule: "2: boxes across the near plane", make: projections::near_plane },
    Family { name: "w-near-zero", rule: "2: corners at w = 0", make: projections::w_near_zero },
    Family { name: "eye-inside", rule: "2: the eye in boxes and bodies", make: projections::eye_inside },
    Family { name: "parallel", rule: "2: orthographic cameras", make: projections::parallel },
    Family { name: "oblique", rule: "2: off-centre, leaning planes", make: projections::oblique },
    Family { name: "field-of-view", rule: "2: 1 to 179 degrees", make: projections::field_of_view },
    Family { name: "planes", rule: "7: near and far 1e-6 to 1e7", make: projections::planes },
    Family { name: "scaled", rule: "7: worlds of 1e-6 to 1e9 m", make: sizes::scaled },
    Family { name: "tiny-and-huge", rule: "7: bodies of 1e-6 to 1e9 m", make: sizes::tiny_and_huge },
    Family { name: "far-away", rule: "7: up to 1e9 m from the origin", make: sizes::far_away },
    Family { name: "denormal", rule: "6: sizes and places below 1e-38", make: sizes::denormal },
    Family { name: "sub-pixel", rule: "4: bodies and gaps below a pixel", make: sizes::sub_pixel },
    Family { name: "footprints", rule: "3: rectangles over 3x3 texels", make: sizes::footprints },
    Family { name: "thin-targets", rule: "3: 1xN, Nx1, powers of two +-1", make: sizes::thin_targets },
    Family { name: "coplanar", rule: "4: faces in one plane", make: surfaces::coplanar },
    Family { name: "own-box", rule: "4: bodies equal to their boxes", make: surfaces::own_box },
    Family { name: "sunk", rule: "4: bodies that just show", make: surfaces::sunk },
    Family { name: "slivers", rule: "4: thin diagonal triangles", make: surfaces::slivers },
    Family { name: "ties", rule: "5: equal depth", make: surfaces::ties },
    Family { name: "mirrored", rule: "6: mirrored, flat, needle and point", make: surfaces::mirrored },
    Family { name: "loose-bounds", rule: "6: declared boxes far too large", make: surfaces::loose_bounds },
    Family { name: "bad-bounds", rule: "6: NaN, inverted, empty, infinite", make: surfaces::bad_bounds },
    Family { name: "one-point", rule: "8: all bodies in one point", make: surfaces::one_point },
    Family { name: "long-lists", rule: "8: all shows: no draw dropped", make: surfaces::long_lists },
    Family { name: "lines-and-points", rule: "1: wide rasters", make: surfaces::lines_and_points },
    Family { name: "creeping", rule: "two phases: a pixel at a time", make: sequences::creeping },
    Family { name: "teleports", rule: "two phases: jumps of the eye", make: sequences::teleports },
    Family { name: "stepping", rule: "queries: eye from box to box", make: sequences::stepping },
    Family { name: "moving", rule: "two phases: moving bodies", make: sequences::moving },
    Family { name: "bending", rule: "two phases: bodies that bend", make: sequences::bending },
    Family { name: "morphing", rule: "two phases: bodies that morph", make: sequences::morphing },
    Family { name: "reuse", rule: "two phases: bodies swap places", make: sequences::reuse },
    Family { name: "resize", rule: "two phases: a new size each frame", make: sequences::resize },
    Family { name: "nothing", rule: "skips: no body, or none in view", make: sequences::nothing },
    Family { name: CHANCE, rule: "what nobody thought of", make: chance },
];

/// The family of worlds by chance.
pub const CHANCE: &str = "chance";

fn chance(random: &mut Random, _bodies: usize) -> Drill {
    worlds::chance(random.bits()).into()
}

/// A drill by its name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DrillId {
    /// The family's place in [`FAMILIES`].
    pub family: usize,
    /// Its seed.
    pub seed: u64,
}

impl DrillId {
    /// Reads `FAMILY/SEED`.
    ///
    /// # Errors
    /// Another form, or an unknown family: says which there are.
    pub fn parse(text: &str) -> Result<Self> {
        let (name, seed) = text.split_once('/').unwrap_or((text, "0"));
        let names = || FAMILIES.iter().map(|family| family.name).collect::<Vec<_>>().join(", ");
        let Some(family) = FAMILIES.iter().position(|family| family.name == name) else {
            bail!("--case {text}: there is no family '{name}'; there are {}", names());
        };
        let seed = seed.parse().with_context(|| format!("--case {text}: write FAMILY/SEED, as in near-plane/3"))?;
        Ok(DrillId { family, seed })
    }

    /// The family.
    pub fn family(&self) -> &'static Family {
        &FAMILIES[self.family]
    }

    /// Makes it, of about so many bodies.
    pub fn make(&self, bodies: usize) -> Drill {
        let mut random = Random::new(self.seed.wrapping_mul(0x2545_f491_4f6c_dd1d) ^ self.family as u64);
        let mut drill = (self.family().make)(&mut random, bodies);
        drill.case.name = self.to_string();
        drill
    }
}

impl std::fmt::Display for DrillId {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(out, "{}/{}", self.family().name, self.seed)
    }
}

/// A wall with bodies before, beside and behind it: some of it is hidden from everywhere.
fn crowd(random: &mut Random, bodies: usize) -> Maker {
    let mut maker = Maker::new("crowd");
    let cube = maker.mesh(cube());
    maker.place(cube, sized(DVec3::ZERO, DVec3::new(random.range(6.0, 10.0), random.range(4.0, 7.0), 0.4)));
    for body in 0..bodies {
        let depth = if body % 5 == 0 { random.range(0.5, 3.0) } else { random.range(-9.0, -0.5) };
        let at = DVec3::new(random.range(-7.0, 7.0), random.range(-4.0, 4.0), depth);
        let size = DVec3::splat(random.range(0.1, 0.9));
        let place = if body % 3 == 0 { sized(at, size) } else { turned(random, at, size) };
        maker.place(cube, place);
    }
    maker
}

/// Where the camera of a crowd stands: before the wall.
fn before_the_wall(random: &mut Random) -> DVec3 {
    DVec3::new(random.range(-1.0, 1.0), random.range(-1.0, 1.0), random.range(5.0, 8.0))
}

/// A case from what was made, with a camera that wanders.
fn filmed(random: &mut Random, maker: Maker) -> Case {
    Case::new("", maker.scene, wander(before_the_wall(random), DVec3::ZERO, PERSPECTIVE))
}

/// The same through other projections, one a frame in turn.
fn through(mut case: Case, projections: &[Projection]) -> Case {
    let shots = case.shots.iter().zip(projections.iter().cycle());
    case.shots = shots.map(|(shot, projection)| Shot { projection: *projection, ..*shot }).collect();
    case
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_unique_and_read_back() {
        for (index, family) in FAMILIES.iter().enumerate() {
            let id = DrillId { family: index, seed: 7 };
            assert_eq!(DrillId::parse(&id.to_string()).unwrap(), id, "{}", family.name);
        }
        let error = DrillId::parse("near-plan/1").unwrap_err().to_string();
        assert!(error.contains("near-plan") && error.contains("near-plane, w-near-zero"), "{error}");
        assert!(DrillId::parse("near-plane/x").is_err());
    }

    #[test]
    fn a_seed_gives_one_world_and_every_scene_is_a_good_one() {
        for family in 0..FAMILIES.len() {
            for seed in 0..6 {
                let id = DrillId { family, seed };
                let (one, two) = (id.make(40), id.make(40));
                assert_eq!(one.case.scene.objects, two.case.scene.objects, "{id}");
                assert_eq!(one.case.shots, two.case.shots, "{id}");
                assert!(one.case.shots.len() >= 2 && one.case.shots.len() <= 16, "{id}");
                one.case.scene.check().unwrap_or_else(|error| panic!("{id}: {error}"));
            }
        }
    }

    #[test]
    fn more_bodies_make_larger_worlds() {
        let crowd =
            FAMILIES.iter().filter(|family| !["stepping", "bad-bounds", "nothing", CHANCE].contains(&family.name));
        for family in crowd {
            let count = |bodies| (family.make)(&mut Random::new(1), bodies).case.scene.objects.len();
            assert!(count(400) > 3 * count(40), "{}: {} and {}", family.name, count(40), count(400));
        }
    }

    #[test]
    fn a_name_without_a_seed_is_that_of_seed_0() {
        assert_eq!(DrillId::parse("creeping").unwrap(), DrillId::parse("creeping/0").unwrap());
        assert_ne!(DrillId::parse("creeping/1").unwrap(), DrillId::parse("creeping/0").unwrap());
    }

    #[test]
    fn sizes_come_in_turn_and_a_camera_stands_still_while_nothing_changes() {
        let shots = DrillId::parse("ties/0").unwrap().make(4).case.shots;
        let [home, away] = [shots[0], shots[4]];
        let still = |sizes: &[[u32; 2]], forgets: &[usize]| {
            let case = Case::new("", Maker::new("none").scene, vec![home, home, home, away, away]);
            let drill = Drill { case, sizes: sizes.to_vec(), forgets: forgets.to_vec() };
            (0..5).filter(|frame| drill.stands_still(*frame)).collect::<Vec<_>>()
        };
        assert_eq!(still(&[], &[]), [1, 2, 4]);
        assert_eq!(still(&[], &[2, 3]), [1, 4]);
        // In turn: small, large, large, small, large.
        assert_eq!(still(&[[1, 2], [3, 4], [3, 4]], &[]), [2]);
        assert_eq!(still(&[[1, 2], [1, 2], [1, 3]], &[]), [1, 4]);
    }
}
