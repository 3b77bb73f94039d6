//! `sightline shot`: one frame as a PNG.

use super::say;
use crate::cli::{ShotArgs, Show};
use crate::pictures::boxes_view;
use crate::pictures::png_out::{DepthScale, Picture};
use crate::pictures::warp_view::{self, Warped};
use crate::results::files::{check_file, check_folder};
use crate::run::capture::{self, CaptureOrder};
use crate::run::methods::parse_methods;
use crate::run::session::{cache_folder, Session};
use crate::run::truth::RunTruth;
use crate::run::{fragment_counts, Contender, Watched};
use anyhow::{bail, Context, Result};
use culling::warp::{Settings, OPTIONS};
use culling::{Options, TestedBoxes};
use std::path::Path;

/// Frames that a method runs before the one shown, so that it has a past.
const LEAD_FRAMES: usize = 2;

/// What settings of the warp begin with.
const WARP_PREFIX: &str = "warp.";

/// Renders and writes the picture.
pub fn run(arguments: &ShotArgs) -> Result<()> {
    let (warp_sets, method_sets): (Vec<_>, Vec<_>) =
        arguments.set.iter().cloned().partition(|set| set.starts_with(WARP_PREFIX));
    let warp = warp_settings(&warp_sets)?;
    let mut methods = parse_methods(&arguments.method, &method_sets)?;
    let (Some((entry, options)), true) = (methods.pop(), methods.is_empty()) else {
        bail!("--method {}: a shot shows one method", arguments.method);
    };
    if arguments.frame >= arguments.scene.frames as usize {
        bail!("--frame {}: the run has only {} frames, counted from 0", arguments.frame, arguments.scene.frames);
    }
    if arguments.samples.samples > 1 && warp_shown(arguments.view).is_some() {
        bail!(
            "--samples {}: this view warps depths of one sample a pixel; leave --samples out",
            arguments.samples.samples
        );
    }
    let opened = arguments.flares.of(arguments.samples.of(arguments.scene.session()?));
    let mut order = order(arguments)?;
    let mut session = Session::open(&arguments.device.gpu(), opened)?;
    let visible = match entry.id {
        "ref" => Some(RunTruth::visible_sets(&mut session, cache_folder().as_deref(), || ())?),
        _ => None,
    };
    let mut contender = Contender::new(&session, entry, options, &visible)?;
    // Before anything is drawn.
    folder(arguments)?;
    check_file(&arguments.out)?;
    let label = contender.label();
    for frame in arguments.frame.saturating_sub(LEAD_FRAMES)..arguments.frame {
        let gpu = session.gpu.clone();
        capture::around(&mut order, &gpu, (frame, &label), || contender.timed(&mut session, frame))?;
    }
    let gpu = session.gpu.clone();
    let (picture, caption) =
        capture::around(&mut order, &gpu, (arguments.frame, &label), || match warp_shown(arguments.view) {
            Some(shown) => warp_picture(&mut session, &mut contender, arguments.frame, warp, shown),
            None => picture(&mut session, &mut contender, arguments),
        })?;
    picture.write(&arguments.out)?;
    say(&format!("{}{caption}", arguments.out.display()))
}

/// The folder of the picture, which is made if it is not there.
fn folder(arguments: &ShotArgs) -> Result<&Path> {
    let folder = arguments.out.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    if !folder.is_dir() {
        check_folder(folder)?;
    }
    std::fs::create_dir_all(folder).with_context(|| format!("{}: cannot make this folder", folder.display()))?;
    Ok(folder)
}

fn order(arguments: &ShotArgs) -> Result<Option<CaptureOrder>> {
    let Some(frame) = arguments.capture else { return Ok(None) };
    let runs = arguments.frame.saturating_sub(LEAD_FRAMES)..=arguments.frame;
    if !runs.contains(&frame) {
        bail!("--capture {frame}: of --frame {} only frames {} to {} run", arguments.frame, runs.start(), runs.end());
    }
    Ok(Some(CaptureOrder::new(frame, folder(arguments)?)?))
}

/// The picture, and what to say of it behind the file's name.
fn picture(session: &mut Session, contender: &mut Contender, arguments: &ShotArgs) -> Result<(Picture, String)> {
    let view = session.look(arguments.frame)?;
    let report = contender.run(session, &view, Watched::Items)?;
    let images = match arguments.view {
        // Of several samples a pixel, each: twice as wide and high.
        Show::Depth | Show::Items => session.targets.read_frame(&session.world, &view, &report)?,
        _ => session.targets.read()?,
    };
    let picture = match arguments.view {
        Show::Colour => Picture::colour(&images),
        Show::Depth => Picture::depth(&images, DepthScale::of(&images.depth)),
        Show::Items => Picture::items(&images),
        Show::Overdraw => {
            let counts = fragment_counts(session, &view, &report)?;
            Picture::overdraw(images.width, images.height, &counts)
        }
        _ => {
            let boxes = tested_boxes(session, contender)?;
            let caption = format!(": {}", boxes_view::caption(&boxes));
            let picture = match arguments.view {
                Show::Boxes => boxes_view::from_above(session, &view, &boxes)?,
                _ => boxes_view::first_person(&Picture::colour(&images), &view, &boxes),
            };
            return Ok((picture, caption));
        }
    };
    Ok((picture, flare_caption(contender)?))
}

/// What the lens flare over the picture says of its light, if there is one.
fn flare_caption(contender: &Contender) -> Result<String> {
    let Some(flare) = contender.method.work()?.flare else { return Ok(String::new()) };
    let shows = |samples: u64| format!("{:.1} %", 100.0 * flare.fraction(samples));
    Ok(match flare.asked {
        None => ": the flare's light is not on the screen".to_owned(),
        Some(asked) => format!(": {} of the flare's light shows; it is drawn by {}", shows(asked), shows(flare.used)),
    })
}

/// What `--set warp.OPTION=VALUE` says.
fn warp_settings(sets: &[String]) -> Result<Settings> {
    let mut options = Options::new("warp", OPTIONS);
    for set in sets {
        let setting = set.strip_prefix(WARP_PREFIX).and_then(|setting| setting.split_once('='));
        let (name, value) = setting.with_context(|| format!("'{set}' is no setting; write warp.OPTION=VALUE"))?;
        options.set(name, value).with_context(|| format!("--set {set}"))?;
    }
    Ok(Settings::of(&options))
}

/// The picture of a warp that a view asks for, if it does.
fn warp_shown(view: Show) -> Option<fn(&Warped) -> Picture> {
    match view {
        Show::Motion => Some(Warped::motion),
        Show::Warp => Some(Warped::picture),
        Show::Holes => Some(Warped::holes),
        Show::WarpError => Some(Warped::error),
        _ => None,
    }
}

/// A picture of the warp from the frame before, and its errors in words.
fn warp_picture(
    session: &mut Session,
    contender: &mut Contender,
    frame: usize,
    settings: Settings,
    shown: fn(&Warped) -> Picture,
) -> Result<(Picture, String)> {
    let warped = warp_view::warp(session, contender, frame, settings)?;
    Ok((shown(&warped), format!(": {}", warped.caption()?)))
}

fn tested_boxes(session: &Session, contender: &Contender) -> Result<TestedBoxes> {
    let boxes = contender.method.tested_boxes(&session.world)?;
    boxes.with_context(|| {
        format!(
            "--view boxes: method '{}' rasterises no boxes; choose one that does, such as roc or eovc",
            contender.label()
        )
    })
}
