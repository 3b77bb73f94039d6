//! Bounds of what moves, had in four ways (GPU Gems 29.5.2): for each frame anew, for all of the motion at once, for each animation of it,
//! or "in place". Each holds every vertex at every time, where the GPU puts it.
//!
//! **Derivation.** A time is cut at all keys that move an object, and between them, into spans ([`Span`]). At a span's middle the object's
//! bounds are those of [`WorldBounds`]. A point p of it is elsewhere at other times of the span: going up from the object, with x the
//! point at the middle and e how far it can be from there, each node (see [`Spread`]) makes of e at most
//! `turn (scale e + scale_off |x|) + turn_off |scaled x| + shift_off`, and a matrix that does not move makes of it e times its norm. |x| is
//! convex in p, so the corners of the mesh's box have the largest. The bounds of the middle, that much wider, hold the span; the union over
//! spans holds the motion.
//!
//! Orbits never end, and need no spans: a point z, seen from the centre, goes round the axis a on a circle, whose box is
//! `(a·z) a ± sqrt((z - (a·z) a)² + (a × z)²)`, component by component. Its sides are largest values of functions that are linear in z, so
//! convex: the corners of the mesh's box have the largest again.
//!
//! A skinned mesh has the bounds of all its joints together, each of which carries some of the vertices: see [`bent`]. Where morph
//! targets displace vertices, each part reaches as far as its vertices can within the span: see [`morphed`]. A file with many keys and
//! vertices could take hours that way. Objects beyond a limit of work get the reach for all weights of the animation in every span.

mod bent;
mod carried;
mod morphed;
mod spread;

pub(crate) use bent::always;

use crate::animation::{Attachment, Motion, NodeAnimation, Orbit};
use crate::bounds::{Reach, WorldBounds};
use crate::model::{Aabb, Scene};
use crate::morph::Shapes;
use bent::Body;
use carried::{chain, Hung};
use glam::{DAffine3, DVec3};
use spread::{stretch, Span};
use std::sync::Arc;

/// How the bounds of moving objects are had.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MovingBounds {
    /// Those of where the object is, in each frame anew (29.5.2, 1).
    #[default]
    PerFrame,
    /// One box for each animation that moves the object, while it plays (29.5.2, 3). Where several play at once, it is the box of
    /// all they do together. An orbit is one animation.
    PerAnimation,
    /// One box for all that the object ever does (29.5.2, 2).
    Union,
    /// One box for all turns and scales of the object, at rest; it is moved with the object's middle in each frame (29.5.2, 2, "in place").
    InPlace,
}

impl MovingBounds {
    /// All of them.
    pub const ALL: [MovingBounds; 4] =
        [MovingBounds::PerFrame, MovingBounds::PerAnimation, MovingBounds::Union, MovingBounds::InPlace];

    /// Its name on the command line and in results.
    pub fn name(self) -> &'static str {
        match self {
            MovingBounds::PerFrame => "per-frame",
            MovingBounds::PerAnimation => "per-animation",
            MovingBounds::Union => "union",
            MovingBounds::InPlace => "in-place",
        }
    }
}

/// Spans that a motion is cut into, at least: a choice. More make smaller boxes, and take longer to load.
const SPANS: usize = 64;

/// Most displacements of vertices that are looked at, counted once a span, for all boxes of a scene. It takes about a second. Beyond that,
/// weights of morph targets may have any of their values in each span: the boxes still hold all vertices, but are larger.
const MOST_STEPS: u64 = 1 << 25;

/// What summing up the way from an object to the world may round, as a part of the largest coordinate, for each node on it.
const ROUNDING: f64 = 1.0 / (1u64 << 46) as f64;

/// The bounds of a scene's moving objects, in the order of [`Motion::transforms_at`].
#[derive(Clone, Debug)]
pub struct MovingBoxes {
    mode: MovingBounds,
    sweeps: Vec<Sweep>,
    /// The body of each moving object whose mesh is deformed; empty if there is none.
    bodies: Vec<Option<Arc<Body>>>,
}

/// What is known of one object's motion before it begins.
#[derive(Clone, Debug)]
struct Sweep {
    /// Times at which the box changes, ascending: box n is that of before time n and from the time before it on.
    cuts: Vec<f64>,
    boxes: Vec<Aabb>,
    /// Of "in place": the middle of the mesh, that the box is moved with.
    middle: DVec3,
    /// No coordinate of the object's origin, or of what of it is drawn, is ever larger.
    farthest: f64,
}

impl MovingBoxes {
    /// Looks through the whole motion, unless bounds are had for each frame.
    pub fn new(scene: &Scene, bounds: &WorldBounds, mode: MovingBounds) -> Self {
        let shape = |object: u32| Shape::new(bounds, scene.objects[object as usize].mesh, mode);
        let bodies = bent::bodies(scene);
        let sweeps = match &scene.motion {
            _ if mode == MovingBounds::PerFrame => Vec::new(),
            Motion::Still => Vec::new(),
            Motion::Nodes(nodes) => {
                let mut left = MOST_STEPS;
                let sweep = |(place, attachment): (usize, &Attachment)| match bodies.get(place).and_then(Option::as_ref)
                {
                    Some(body) => body.on_nodes(nodes, &scene.skins, attachment, (mode, &mut left)),
                    None => shape(attachment.object).on_nodes(nodes, attachment),
                };
                nodes.objects().iter().enumerate().map(sweep).collect()
            }
            Motion::Orbits(orbits) => {
                let mut sorted: Vec<&Orbit> = orbits.iter().collect();
                sorted.sort_by_key(|orbit| orbit.object);
                sorted.into_iter().map(|orbit| shape(orbit.object).in_orbit(orbit)).collect()
            }
        };
        MovingBoxes { mode, sweeps, bodies }
    }

    /// How they are had.
    pub fn mode(&self) -> MovingBounds {
        self.mode
    }

    /// Bounds at a time of one of the moving objects, by its place in the order, which then has this transform; `bounds` and `mesh`
    /// are those of `new`, and shapes are of that time. Not valid if the motion is not finite.
    pub fn at(
        &self,
        moving: usize,
        seconds: f64,
        bounds: &WorldBounds,
        (mesh, world_from_object): (u32, &DAffine3),
        shapes: &Shapes,
    ) -> Aabb {
        let Some(sweep) = self.sweeps.get(moving) else {
            return match self.bodies.get(moving).and_then(Option::as_ref) {
                Some(body) => body.bounds(world_from_object, shapes),
                None => bounds.of(mesh, world_from_object),
            };
        };
        let box_ = sweep.boxes[sweep.cuts.partition_point(|cut| *cut <= seconds)];
        if self.mode != MovingBounds::InPlace {
            return box_;
        }
        let at = world_from_object.transform_point3(sweep.middle);
        Aabb { min: box_.min + at, max: box_.max + at }
    }

    /// No coordinate of the object's place is ever larger than this; none if nothing is known before it is there.
    pub fn farthest(&self, moving: usize) -> Option<f64> {
        self.sweeps.get(moving).map(|sweep| sweep.farthest)
    }
}

/// What moves as a whole.
struct Shape<'a> {
    reach: &'a Reach,
    mode: MovingBounds,
    corners: [DVec3; 8],
    middle: DVec3,
}

/// Where something can be while a span passes.
struct Swept {
    bounds: Aabb,
    farthest: f64,
}

/// Times at which the weights of an object change: of all keys, and of each track's first and last key.
#[derive(Clone, Debug, Default)]
struct WeightTimes {
    keys: Vec<f64>,
    ends: Vec<f64>,
}

/// Computes the sweep of an object of several parts, each of which hangs on nodes. `swept` takes the index of a part and a span.
fn sweep(
    parts: &[Hung<'_>],
    (weights, mode): (&WeightTimes, MovingBounds),
    middle: DVec3,
    swept: impl Fn(usize, Span) -> Swept,
) -> Sweep {
    let sorted = |mut times: Vec<f64>| {
        times.sort_by(f64::total_cmp);
        times.dedup();
        times
    };
    let cuts = match mode {
        MovingBounds::PerAnimation => {
            let nodes = parts.iter().flat_map(|part| &part.chain);
            nodes.flat_map(|node| node.track_ends()).chain(weights.ends.iter().copied()).collect()
        }
        _ => Vec::new(),
    };
    let cuts = sorted(cuts);
    let keys = parts.iter().map(|part| {
        let nodes = part.chain.iter().flat_map(|node| node.key_times());
        sorted(nodes.chain(weights.keys.iter().copied()).collect())
    });
    let keys: Vec<Vec<f64>> = keys.collect();
    let starts = std::iter::once(f64::NEG_INFINITY).chain(cuts.iter().copied());
    let ends = cuts.iter().copied().chain([f64::INFINITY]);
    let mut farthest = 0.0f64;
    let boxes = starts.zip(ends).map(|(from, until)| {
        let spans = keys
            .iter()
            .enumerate()
            .flat_map(|(part, keys)| spans(keys, from, until).into_iter().map(move |span| (part, span)));
        union(spans.map(|(part, span)| {
            let swept = swept(part, span);
            farthest = farthest.max(swept.farthest);
            swept.bounds
        }))
    });
    let boxes = boxes.collect();
    Sweep { cuts, boxes, middle, farthest }
}

impl<'a> Shape<'a> {
    fn new(bounds: &'a WorldBounds, mesh: u32, mode: MovingBounds) -> Self {
        let local = bounds.in_object_space(mesh);
        Shape { reach: bounds.reach(mesh), mode, corners: local.corners(), middle: local.centre() }
    }

    fn in_place(&self) -> bool {
        self.mode == MovingBounds::InPlace
    }

    /// The largest distance of its vertices, and its origin, from the origin.
    fn size(&self) -> f64 {
        longest(&self.corners)
    }

    fn on_nodes(&self, nodes: &NodeAnimation, attachment: &Attachment) -> Sweep {
        let whole = Hung {
            node_from_part: attachment.node_from_object,
            chain: chain(nodes, attachment.node),
            carrier: 0,
            world_from_tree: attachment.world_from_tree,
        };
        let middle = self.in_place().then_some(self.middle);
        let swept = |span| swept_whole(self.reach, &whole, span, middle);
        sweep(std::slice::from_ref(&whole), (&WeightTimes::default(), self.mode), self.middle, |_, span| swept(span))
    }

    fn in_orbit(&self, orbit: &Orbit) -> Sweep {
        let base = orbit.base;
        let longer = stretch(&base.matrix3);
        let bob = if orbit.bob_period_s > 0.0 { orbit.bob.abs() } else { DVec3::ZERO };
        let arm = base.translation - orbit.centre;
        let farthest = orbit.centre.length() + arm.length() + bob.length() + longer * self.size();
        let turned = orbit.axis.try_normalize().filter(|_| orbit.radians_per_s != 0.0);
        let (centre, arm, bob) = match self.in_place() {
            true => (DVec3::ZERO, -(base.matrix3 * self.middle), DVec3::ZERO),
            false => (orbit.centre, arm, bob),
        };
        let rounding = 4.0 * ROUNDING * farthest;
        let bounds = match turned {
            None => widened(self.reach, &DAffine3 { translation: centre + arm, ..base }, rounding, longer),
            Some(axis) => {
                let by = rounding + self.reach.most_padding(longer);
                let round = round(axis, &self.corners.map(|corner| base.matrix3 * corner + arm));
                Aabb { min: round.min + centre, max: round.max + centre }.widened(DVec3::splat(by))
            }
        };
        let boxes = vec![union([bounds.widened(bob)].into_iter())];
        Sweep { cuts: Vec::new(), boxes, middle: self.middle, farthest: farthest + rounding }
    }
}

/// Computes where an object of one part can be within a span; see the head of this file. With a `middle` the object turns about that
/// point, and does not move.
fn swept_whole(reach: &Reach, whole: &Hung<'_>, span: Span, middle: Option<DVec3>) -> Swept {
    let (from, turned) = (middle.unwrap_or(DVec3::ZERO), middle.is_some());
    let mut carried = whole.begin(reach, from, turned);
    carried.up(&whole.chain, span, turned);
    carried.up_to_world(whole, turned);
    let rounding = ROUNDING * (whole.chain.len() + 2) as f64 * carried.farthest;
    let place = DAffine3 { translation: carried.place.translation - carried.place.matrix3 * from, ..carried.place };
    let bounds = widened(reach, &place, carried.off + rounding, carried.longer);
    Swept { bounds, farthest: carried.farthest + rounding }
}

/// Computes bounds at a place, widened by `by`, and by the rounding of an object that is stretched by up to `longer`.
fn widened(reach: &Reach, place: &DAffine3, by: f64, longer: f64) -> Aabb {
    let by = by + reach.most_padding(longer);
    reach.transformed(place).widened(DVec3::splat(by))
}

/// The box of all that points pass as they go round an axis through the origin.
fn round(axis: DVec3, points: &[DVec3; 8]) -> Aabb {
    let ring = |point: &DVec3| {
        let along = axis * axis.dot(*point);
        let (one, other) = (*point - along, axis.cross(*point));
        let half = (one * one + other * other).map(f64::sqrt);
        Aabb { min: along - half, max: along + half }
    };
    union(points.iter().map(ring))
}

fn longest(vectors: &[DVec3; 8]) -> f64 {
    vectors.iter().map(|vector| vector.length()).fold(0.0, f64::max)
}

/// From one time on until before another, cut at all keys between, and into [`SPANS`] or more if there are keys.
fn spans(keys: &[f64], from: f64, until: f64) -> Vec<Span> {
    let inside = keys.iter().copied().filter(|key| from < *key && *key < until);
    let times: Vec<f64> = std::iter::once(from).chain(inside).chain([until]).collect();
    let each = SPANS.div_ceil(times.len() - 1).max(1);
    let cut = |pair: &[f64]| {
        let (from, until) = (pair[0], pair[1]);
        let each = if from.is_finite() && until.is_finite() { each } else { 1 };
        let at = move |cut: usize| if cut == each { until } else { from + (until - from) * (cut as f64 / each as f64) };
        let at = move |cut: usize| if cut == 0 { from } else { at(cut).clamp(from, until) };
        (0..each).map(move |cut| Span { from: at(cut), until: at(cut + 1) }).filter(|span| span.from < span.until)
    };
    times.windows(2).flat_map(cut).collect()
}

/// The box around boxes; not valid if one is not.
fn union(boxes: impl Iterator<Item = Aabb>) -> Aabb {
    let mut all = Aabb::EMPTY;
    for box_ in boxes {
        if !box_.is_valid() {
            return Aabb { min: DVec3::NAN, max: DVec3::NAN };
        }
        all = all.union(box_);
    }
    all
}
