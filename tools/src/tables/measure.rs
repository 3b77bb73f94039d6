//! What stands in a table's cells: a number of a method's results or of a warp's errors, and how it is written.

use super::{Place, Ran};
use crate::measures::metrics::DepthErrors;
use crate::measures::stats;
use crate::results::grid::milliseconds;
use crate::results::Method;
use shaders::Stage;

/// What a cell holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// Mean frame time in milliseconds.
    FrameMs,
    /// Median frame time in milliseconds.
    MedianMs,
    /// 95th percentile of frame times in milliseconds.
    P95Ms,
    /// Mean time of some of a frame's stages in milliseconds.
    StagesMs(Stages),
    /// Occlusion queries a frame.
    Queries,
    /// Occlusion queries over the time of all frames in seconds, in thousands.
    ThousandQueriesASecond,
    /// Changes a frame between drawing and asking.
    StateChanges,
    /// Times a frame that the host waits for answers.
    Waits,
    /// Objects drawn a frame.
    Drawn,
    /// Triangles drawn a frame, in millions.
    MillionTriangles,
    /// Triangles drawn, in percent of the scene's.
    TrianglesPercent,
    /// Of what was hidden for so many frames and visible before, the share that is hidden in the next frame too, p(t).
    HiddenAgain(usize),
    /// Objects culled over all, C/N.
    CulledOverTotal,
    /// Objects culled over those that ideal culling culls, C/R.
    CulledOverRef,
    /// The same in percent, CR.
    CulledOverRefPercent,
    /// Visible objects that were not drawn, in percent of the visible ones.
    ObjectErrorPercent,
    /// Mean number of pixels whose depth is not the truth's.
    DifferingPixels,
    /// PSNR against the truth in dB, mean of the frames that differ; infinite if none does.
    PsnrMean,
    /// The same of the worst frame.
    PsnrWorst,
    /// PSNR between the pictures of the column's method and of the one it stands against, mean of the frames that differ.
    PsnrBetween,
    /// Mean SSIM of a warped depth less that of the warp it stands against.
    SsimGain,
    /// Mean PSNR in dB of a warped depth less that of the warp it stands against, over the frames in which both have errors.
    PsnrGain,
}

/// Stages of warping-based culling, as TOG 2018, table 6, sums them up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stages {
    /// The motion buffer.
    Motion,
    /// The rest of the warp: bounds, search, erosion, and the copy of the depth for the next frame.
    Warping,
    /// Frustum, occlusion map, tests, and packing.
    Culling,
    /// These three.
    All,
}

impl Stages {
    /// True if a stage of that name is one of these. Drawing, clearing and moving objects are none.
    fn has(self, stage: &str) -> bool {
        let family = stage.split_once('/').map_or(stage, |(family, _)| family);
        let of = match family {
            "draw" | "target" | "world" => return false,
            "warp" if stage == shaders::warp::MeasureMotion::INFO.name => Stages::Motion,
            "warp" => Stages::Warping,
            _ => Stages::Culling,
        };
        self == of || self == Stages::All
    }

    /// Mean milliseconds of a frame; a stage that did not run in one took no time there. None without times.
    fn mean_ms(self, method: &Method) -> Option<f64> {
        let ours = method.frames.stages.iter().filter(|(stage, _)| self.has(stage));
        let sum: f64 = ours.flat_map(|(_, ms)| ms.iter().flatten()).sum();
        let frames = method.frames.frame_ms.len();
        (frames > 0).then(|| sum / frames as f64)
    }
}

impl Measure {
    /// True of times, which ratios can be taken of.
    pub(super) fn is_time(self) -> bool {
        matches!(self, Measure::FrameMs | Measure::MedianMs | Measure::P95Ms | Measure::StagesMs(_))
    }

    /// True if it needs the comparison with the truth.
    pub(super) fn needs_truth(self) -> bool {
        !self.is_time()
    }

    /// What a run says; none if it does not.
    pub(super) fn of(self, ran: &Ran, place: &Place) -> Option<f64> {
        if matches!(self, Measure::SsimGain | Measure::PsnrGain) {
            return self.gain(ran.warps.get(&place.label)?, ran.warps.get(place.against.as_ref()?)?);
        }
        if let Measure::HiddenAgain(frames) = self {
            return ran.hidden.as_ref()?.hidden_again(frames);
        }
        let method = ran.results.method(&place.label)?;
        match self {
            Measure::Queries => Some(method.queries_mean),
            Measure::ThousandQueriesASecond => Some(method.queries_mean / method.frame_ms.mean),
            Measure::StateChanges => Some(method.state_changes_mean),
            Measure::Waits => Some(method.waits_mean),
            Measure::Drawn => Some(method.drawn_mean),
            Measure::MillionTriangles => Some(method.triangles_mean / 1e6),
            Measure::TrianglesPercent => {
                Some(100.0 * method.triangles_mean / ran.results.scene.triangles.max(1) as f64)
            }
            Measure::FrameMs => Some(method.frame_ms.mean),
            Measure::MedianMs => Some(method.frame_ms.median),
            Measure::P95Ms => Some(method.frame_ms.p95),
            Measure::StagesMs(stages) => stages.mean_ms(method),
            Measure::CulledOverTotal => Some(method.culled_over_total),
            Measure::CulledOverRef => Some(method.culled_over_ref),
            Measure::CulledOverRefPercent => Some(100.0 * method.culled_over_ref),
            Measure::ObjectErrorPercent => Some(method.object_error_percent),
            Measure::DifferingPixels => Some(method.differing_pixels_mean),
            Measure::PsnrMean => Some(method.psnr_mean_db.unwrap_or(f64::INFINITY)),
            Measure::PsnrWorst => Some(method.psnr_worst_db.unwrap_or(f64::INFINITY)),
            Measure::PsnrBetween => Some(method.psnr_between_db.get(place.against.as_ref()?)?.unwrap_or(f64::INFINITY)),
            Measure::SsimGain | Measure::PsnrGain | Measure::HiddenAgain(_) => None,
        }
    }

    fn gain(self, warped: &[DepthErrors], other: &[DepthErrors]) -> Option<f64> {
        let gains = warped.iter().zip(other).filter_map(|(warped, other)| match self {
            Measure::SsimGain => Some(warped.ssim - other.ssim),
            _ => Some(warped.psnr_db? - other.psnr_db?),
        });
        stats::mean(&gains.collect::<Vec<_>>())
    }

    /// Ours with what digits it deserves. Shares are cut, not rounded: 1.000 is said only of all; what is little is not said
    /// to be nothing.
    pub(super) fn shown(self, value: f64) -> String {
        let cut = |decimals: usize| {
            let unit = 10f64.powi(decimals as i32);
            format!("{:.decimals$}", (value * unit).floor() / unit)
        };
        let small = |decimals: usize| {
            let least = 10f64.powi(-(decimals as i32));
            if value > 0.0 && value < least {
                format!("<{least}")
            } else {
                format!("{value:.decimals$}")
            }
        };
        match self {
            _ if self.is_time() => milliseconds(value),
            Measure::CulledOverTotal | Measure::CulledOverRef => cut(3),
            Measure::CulledOverRefPercent => cut(2),
            Measure::ObjectErrorPercent => small(3),
            Measure::DifferingPixels => small(2),
            Measure::PsnrMean | Measure::PsnrWorst | Measure::PsnrBetween => decimal(value, 1),
            Measure::SsimGain | Measure::HiddenAgain(_) => format!("{value:.3}"),
            Measure::Queries | Measure::Drawn => format!("{value:.0}"),
            Measure::StateChanges | Measure::Waits | Measure::ThousandQueriesASecond => format!("{value:.1}"),
            _ => format!("{value:.2}"),
        }
    }
}

/// A number with so many decimals; what is infinite has its sign.
pub(super) fn decimal(value: f64, decimals: usize) -> String {
    if value == f64::INFINITY {
        return "∞".to_owned();
    }
    format!("{value:.decimals$}")
}
