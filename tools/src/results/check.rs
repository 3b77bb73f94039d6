//! What the contract's types do not say: the schema, unique labels, lengths of arrays, and numbers that are numbers.

use super::{Fault, Frames, Method, Results, SCHEMA};

impl Results {
    /// The first field that breaks the contract.
    pub(super) fn check(&self) -> Result<(), Fault> {
        let fault = |field: String, fault: String| Err(Fault { field, fault });
        if self.schema != SCHEMA {
            let reads = format!("is {}, but this program reads {SCHEMA}", self.schema);
            return fault("schema".into(), reads);
        }
        if !self.speed.is_finite() {
            return fault("speed".into(), "is not a finite number".into());
        }
        for (index, method) in self.methods.iter().enumerate() {
            let at = |field: &str| format!("methods[{index}].{field}");
            if method.label.is_empty() {
                return fault(at("label"), "is empty".into());
            }
            let mut earlier = self.methods[..index].iter();
            if earlier.any(|other| other.label == method.label) {
                let twice = format!("`{}` is there twice; labels are unique", method.label);
                return fault(at("label"), twice);
            }
            for (name, length) in method.frames.lengths() {
                if length != 0 && length != self.frames as usize {
                    let wrong = format!("has {length} entries for {} frames", self.frames);
                    return fault(at(&format!("frames.{name}")), wrong);
                }
            }
            if let Some(name) = method.first_not_finite() {
                return fault(at(&name), "is not a finite number".into());
            }
        }
        Ok(())
    }
}

impl Frames {
    /// Name and length of every array.
    fn lengths(&self) -> Vec<(String, usize)> {
        let plain = [
            ("frame_ms", self.frame_ms.len()),
            ("drawn", self.drawn.len()),
            ("ref_visible", self.ref_visible.len()),
            ("false_negatives", self.false_negatives.len()),
            ("differing_pixels", self.differing_pixels.len()),
            ("tied_pixels", self.tied_pixels.len()),
            ("thin_pixels", self.thin_pixels.len()),
            ("psnr_db", self.psnr_db.len()),
            ("ssim", self.ssim.len()),
            ("triangles", self.triangles.len()),
            ("draws", self.draws.len()),
            ("overdraw", self.overdraw.len()),
            ("queries", self.queries.len()),
            ("rays", self.rays.len()),
            ("boxes", self.boxes.len()),
            ("node_visits", self.node_visits.len()),
            ("flare_by_query", self.flare_by_query.len()),
            ("flare_by_oracle", self.flare_by_oracle.len()),
            ("staged_frame_ms", self.staged_frame_ms.len()),
        ];
        let plain = plain.map(|(name, length)| (name.to_owned(), length));
        let stages = self.stages.iter().map(|(name, ms)| (format!("stages.{name}"), ms.len()));
        plain.into_iter().chain(stages).collect()
    }
}

impl Method {
    /// JSON has no NaN and no infinity: serde writes `null`, which would read as "identical", "did not run" or not at all.
    fn first_not_finite(&self) -> Option<String> {
        let flare = self.flare.as_ref();
        let scalars = [
            ("frame_ms.median", Some(self.frame_ms.median)),
            ("frame_ms.p95", Some(self.frame_ms.p95)),
            ("frame_ms.mean", Some(self.frame_ms.mean)),
            ("host_ms", self.host_ms),
            ("ratio_to_ref", self.ratio_to_ref),
            ("object_error_percent", Some(self.object_error_percent)),
            ("differing_pixels_mean", Some(self.differing_pixels_mean)),
            ("tied_pixels_mean", Some(self.tied_pixels_mean)),
            ("thin_pixels_mean", Some(self.thin_pixels_mean)),
            ("psnr_mean_db", self.psnr_mean_db),
            ("psnr_worst_db", self.psnr_worst_db),
            ("ssim_mean", Some(self.ssim_mean)),
            ("drawn_mean", Some(self.drawn_mean)),
            ("culled_over_total", Some(self.culled_over_total)),
            ("culled_over_ref", Some(self.culled_over_ref)),
            ("triangles_mean", Some(self.triangles_mean)),
            ("draws_mean", Some(self.draws_mean)),
            ("overdraw_mean", self.overdraw_mean),
            ("queries_mean", Some(self.queries_mean)),
            ("state_changes_mean", Some(self.state_changes_mean)),
            ("waits_mean", Some(self.waits_mean)),
            ("plane_tests_mean", Some(self.plane_tests_mean)),
            ("rays_mean", Some(self.rays_mean)),
            ("boxes_mean", Some(self.boxes_mean)),
            ("bounds_brought_mean", Some(self.bounds_brought_mean)),
            ("refits_mean", Some(self.refits_mean)),
            ("node_visits_mean", Some(self.node_visits_mean)),
            ("device_memory_mib", Some(self.device_memory_mib)),
            ("flare.shows_mean", flare.and_then(|flare| flare.shows_mean)),
            ("flare.error_mean", flare.and_then(|flare| flare.error_mean)),
            ("flare.error_max", flare.and_then(|flare| flare.error_max)),
        ];
        let scalars = scalars.map(|(name, value)| (name.to_string(), value));
        let stages = self.stages.iter().enumerate().flat_map(|(index, stage)| {
            let at = |field: &str| format!("stages[{index}].{field}");
            [
                (at("median_ms"), Some(stage.median_ms)),
                (at("share"), Some(stage.share)),
                (at("saved_ms"), stage.saved_ms),
            ]
        });
        let between = self.psnr_between_db.iter().map(|(label, psnr)| (format!("psnr_between_db.{label}"), *psnr));
        let mut all = scalars.into_iter().chain(stages).chain(between).chain(self.frames.numbers());
        all.find(|(_, value)| value.is_some_and(|v| !v.is_finite())).map(|(name, _)| name)
    }
}

impl Frames {
    /// Name and value of everything that is not a whole number.
    fn numbers(&self) -> impl Iterator<Item = (String, Option<f64>)> + '_ {
        let times = [("frame_ms", &self.frame_ms), ("staged_frame_ms", &self.staged_frame_ms)];
        let plain = times.into_iter().chain([("ssim", &self.ssim), ("overdraw", &self.overdraw)]);
        let flares = [("flare_by_query", &self.flare_by_query), ("flare_by_oracle", &self.flare_by_oracle)];
        let plain = plain.chain(flares).flat_map(|(name, values)| {
            let at = move |(frame, &value)| (format!("frames.{name}[{frame}]"), Some(value));
            values.iter().enumerate().map(at)
        });
        let stages = self.stages.iter().map(|(name, ms)| (format!("stages.{name}"), ms));
        let optional = stages.chain([("psnr_db".to_owned(), &self.psnr_db)]).flat_map(|(name, values)| {
            let at = move |(frame, &value)| (format!("frames.{name}[{frame}]"), value);
            values.iter().enumerate().map(at)
        });
        plain.chain(optional)
    }
}
