//! The views of a frame beyond its picture: made of what the frame left, as `shot` makes them.

use super::controls::{Controls, Show};
use crate::measures::metrics::{FrameImages, Truth};
use crate::pictures::boxes_view::{self, dimmed};
use crate::pictures::lines::{corners, draw_edges, Pen};
use crate::pictures::png_out::{DepthScale, Picture};
use crate::pictures::warp_view::Warped;
use crate::run::session::Session;
use crate::run::{fragment_counts, Contender};
use anyhow::{Context, Result};
use culling::farthest::{self, hom, FarthestMap, MapKind, Structure};
use culling::warp::{Settings, Warp, OPTIONS};
use culling::{Drawn, Options, TestedBoxes, View};
use engine::{Buffer, FrameReport, Placement};
use shaders::types::PyramidLevel;

const IN_VAIN: Pen = Pen { colour: [255, 90, 60], cover: 0.6, width: 1 };
const LOST: Pen = Pen { colour: [255, 0, 255], cover: 1.0, width: 2 };

const NEAR_IS_BRIGHT: &str = "near is bright";

/// A warp that goes on from frame to frame.
pub(super) struct Warping {
    warp: Warp,
    settings: Settings,
    warped: Buffer<f32>,
}

/// What ran last, and what it drew.
pub(super) struct Ran {
    pub(super) view: View,
    pub(super) report: FrameReport,
    pub(super) drawn: Option<Drawn>,
}

/// What a frame left, of which views are made.
pub(super) struct Left<'a> {
    pub(super) session: &'a mut Session,
    pub(super) contender: Option<&'a Contender>,
    pub(super) ran: Option<&'a Ran>,
    pub(super) truth: Option<&'a Truth>,
    pub(super) warping: &'a mut Option<Warping>,
    /// What there is to say of the view.
    pub(super) caption: &'a mut String,
}

/// The picture that the controls ask for of a frame that was just drawn, and what there is to say of it.
pub(super) fn of(left: &mut Left<'_>, controls: &Controls, view: &View, images: &FrameImages) -> Result<Picture> {
    let warps = matches!(controls.show, Show::Motion | Show::WarpError);
    if !warps {
        *left.warping = None;
    }
    match controls.show {
        Show::Colour | Show::FalsePositives => Ok(Picture::colour(images)),
        Show::Depth => {
            *left.caption = format!("{NEAR_IS_BRIGHT}; black: nothing was drawn");
            Ok(Picture::depth(images, DepthScale::of(&images.depth)))
        }
        Show::Items => {
            *left.caption = "one colour an object".to_owned();
            Ok(Picture::items(images))
        }
        Show::Overdraw => overdraw(left, view, images),
        Show::Farthest => farthest_level(left, controls.level, images),
        Show::Groups | Show::Boxes => boxes(left, controls.show, view, images),
        Show::Motion | Show::WarpError if controls.frozen => {
            *left.caption = "not while culling is frozen: there is no frame before".to_owned();
            Ok(Picture::colour(images))
        }
        Show::Motion | Show::WarpError => warped(left, controls.show, view, images),
    }
}

fn overdraw(left: &mut Left<'_>, view: &View, images: &FrameImages) -> Result<Picture> {
    let ran = left.ran.context("nothing was drawn yet")?;
    let counts = fragment_counts(left.session, view, &ran.report)?;
    let most = counts.iter().max().copied().unwrap_or(0);
    *left.caption = format!("blue 1, green 4, yellow 8, red 16, white 32; most here {most}");
    Ok(Picture::overdraw(images.width, images.height, &counts))
}

/// The map that the method keeps, or a pyramid for one that keeps none, made of this frame's depth.
fn farthest_level(left: &mut Left<'_>, level: u32, images: &FrameImages) -> Result<Picture> {
    let size = [images.width, images.height];
    let options = left.contender.map(|contender| contender.options.clone());
    let has_map = |options: &Options| options.known().iter().any(|info| info.name == hom::STRUCTURE_OPTION.name);
    let kind = match options.filter(has_map) {
        Some(options) => hom::map_kind(&options),
        None => MapKind { structure: Structure::Mip, reduction: 0 },
    };
    let map = FarthestMap::new(&left.session.gpu, size, kind)?;
    let mut f = left.session.gpu.frame();
    map.fill_from_depth(&mut f, &left.session.targets.timed());
    map.build(&mut f);
    f.finish().context("building the farthest-depth map")?;
    let levels: Vec<PyramidLevel> =
        farthest::layout(size, kind).0.into_iter().filter(|level| level.width > 0 && level.height > 0).collect();
    let place = level as usize % levels.len().max(1);
    let PyramidLevel { first, width, height } = levels[place];
    *left.caption = format!(
        "{:?}, level {place} of {} (L): {width}x{height} texels, of this frame's depth; {NEAR_IS_BRIGHT}",
        kind.structure,
        levels.len()
    );
    let texels = &map.read()?[first as usize..(first + width * height) as usize];
    let scale = DepthScale::of(&images.depth);
    let texel = |x: u32, y: u32| {
        let [column, row] = [x * width / images.width, y * height / images.height];
        scale.grey(texels[(row * width + column) as usize])
    };
    let pixels = (0..images.height).flat_map(|y| (0..images.width).map(move |x| (x, y))).map(|(x, y)| texel(x, y));
    Ok(Picture { width: images.width, height: images.height, pixels: pixels.collect() })
}

fn boxes(left: &mut Left<'_>, show: Show, view: &View, images: &FrameImages) -> Result<Picture> {
    let picture = Picture::colour(images);
    let tested = match left.contender {
        Some(contender) => contender.method.tested_boxes(&left.session.world)?,
        None => None,
    };
    let Some(tested) = tested else {
        *left.caption = "this method keeps no list of tested boxes; roc, eovc and those that query do".to_owned();
        return Ok(picture);
    };
    let tested = match show {
        Show::Groups => TestedBoxes { singles: Vec::new(), ..tested },
        _ => tested,
    };
    *left.caption = boxes_view::caption(&tested);
    Ok(boxes_view::first_person(&picture, view, &tested))
}

/// Warps the frame before to this one, and keeps this one for the next.
fn warped(left: &mut Left<'_>, show: Show, view: &View, images: &FrameImages) -> Result<Picture> {
    let session = &*left.session;
    let mut warping = match left.warping.take() {
        Some(warping) => warping,
        None => {
            let settings = Settings { stored: true, ..Settings::of(&Options::new("warp", OPTIONS)) };
            let warp = Warp::new(&session.gpu, &session.world, view.size, settings).context("depth warping")?;
            let [width, height] = warp.texels();
            let warped = Buffer::new(&session.gpu, "view.warped", (width * height) as usize, Placement::Storage)?;
            Warping { warp, settings, warped }
        }
    };
    let mut picture = Picture::colour(images);
    *left.caption = "from the next frame on: a warp starts from the frame before".to_owned();
    if warping.warp.has_last() {
        let mut f = session.gpu.frame();
        warping.warp.frame(&mut f, &session.world, view, warping.warped.all())?;
        let stages = f.finish().context("depth warping")?.stages;
        let stages = stages.into_iter().map(|stage| (stage.label, stage.ms)).collect();
        let warped = Warped::of(&warping.warp, &warping.warped, warping.settings, images, stages)?;
        let legend;
        (picture, legend) = match show {
            Show::Motion => (warped.motion(), "where each pixel goes: direction as hue, length as brightness"),
            _ => (
                warped.error(),
                "red: nearer than real, may hide what shows; blue: farther, hides less; dark blue: a hole",
            ),
        };
        *left.caption = format!("{legend}\n{}", warped.caption()?);
    }
    let mut f = session.gpu.frame();
    warping.warp.keep(&mut f, &session.world, view, &session.targets.with_items());
    f.finish().context("keeping a frame's depth")?;
    *left.warping = Some(warping);
    Ok(picture)
}

/// The frame, dimmed, with the bounds of what was drawn but owns no pixel, and of what owns one but was not drawn.
pub(super) fn false_positives(left: &mut Left<'_>, view: &View, images: &FrameImages) -> Picture {
    let mut picture = dimmed(&Picture::colour(images));
    let drawn = left.ran.and_then(|ran| ran.drawn.as_ref());
    let (Some(truth), Some(drawn)) = (left.truth, drawn) else {
        *left.caption = "no truth of the frozen frame: choose this view, then freeze".to_owned();
        return picture;
    };
    let (mut in_vain, mut lost) = (0, 0);
    for (object, (box_, drawn)) in left.session.world.host_bounds().iter().zip(&drawn.objects).enumerate() {
        let pen = match (drawn, truth.is_visible(object)) {
            (true, false) => IN_VAIN,
            (false, true) => LOST,
            _ => continue,
        };
        in_vain += usize::from(*drawn);
        lost += usize::from(!drawn);
        draw_edges(&mut picture, view, &corners(box_), pen);
    }
    *left.caption = format!("{in_vain} drawn in vain (red), {lost} lost (magenta)");
    picture
}
