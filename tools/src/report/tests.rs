//! A report is well formed, holds all that was run with every name escaped, and says what it cannot show.

mod marks;

use super::*;
use crate::results::files::tests::Folder;
use crate::results::tests::results;
use std::collections::BTreeMap;

/// A label as only a malicious file could give it.
const NASTY: &str = "woc[<script>alert(\"1\")</script>&'x'=\u{1}ü]";

fn nasty() -> Results {
    let mut results = results();
    results.methods[1].label = NASTY.into();
    results.scene.name = "a<b>&\"c\".glb".into();
    results.command = "sightline bench --scene 'a<b>&\"c\".glb'".into();
    for method in &mut results.methods {
        method.frames.drawn = vec![5; 2];
    }
    results
}

fn gallery() -> Gallery {
    let error = crate::measures::metrics::compare(
        &crate::measures::metrics::Truth::new(one_pixel(), 1).unwrap(),
        &one_pixel(),
        &[true],
    );
    let uri = |name: &str| format!("data:image/png;base64,{name}");
    let worst = WorstFrame { frame: 1, error: error.unwrap(), pictures: ["t", "m", "d"].map(uri) };
    let faulty = MethodPictures { worst: Some(worst), buffers: Some(["o", "i"].map(uri)) };
    let of_method = BTreeMap::from([(NASTY.to_owned(), faulty), ("none".to_owned(), MethodPictures::default())]);
    let mut gallery = Gallery::new(2, []);
    gallery.of_method = of_method;
    gallery
}

fn one_pixel() -> crate::measures::metrics::FrameImages {
    crate::measures::metrics::FrameImages {
        width: 1,
        height: 1,
        colour: vec![[9; 4]],
        depth: vec![0.5],
        items: vec![0],
        seen_through: vec![],
    }
}

/// Parses a report as XML, which is stricter than HTML: every tag closed, every attribute quoted, every letter allowed.
fn parsed(text: &str) -> roxmltree::Document<'_> {
    let options = roxmltree::ParsingOptions { allow_dtd: true, ..Default::default() };
    roxmltree::Document::parse_with_options(text, options).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// All text that a reader can see or hear.
fn words(document: &roxmltree::Document<'_>) -> String {
    let texts = document.descendants().filter_map(|node| node.text());
    let attributes = document.descendants().flat_map(|node| node.attributes()).map(|attribute| attribute.value());
    texts.chain(attributes).collect::<Vec<_>>().join("\n")
}

#[test]
fn names_are_escaped_and_all_there() {
    let text = html(&nasty(), Some(&gallery())).unwrap();
    assert!(!text.contains("<script"), "a label became a tag");
    let document = parsed(&text);
    let words = words(&document);
    for method in &nasty().methods {
        let label = method.label.replace('\u{1}', "\u{fffd}");
        let rows = document.descendants().filter(|node| node.has_tag_name("th") && node.text() == Some(&label)).count();
        assert!(rows >= 3, "{label}: {rows} rows");
    }
    for said in
        ["a<b>&\"c\".glb", "camera and objects unchanged", "no rapid objects", "llvmpipe", "1.3.230", "walk at speed 4"]
    {
        assert!(words.contains(said), "{said}");
    }
}

#[test]
fn a_report_needs_no_other_file_and_no_script() {
    let text = html(&nasty(), Some(&gallery())).unwrap();
    let document = parsed(&text);
    for node in document.descendants() {
        for attribute in node.attributes() {
            let refers = matches!(attribute.name(), "src" | "href" | "srcset" | "data" | "action");
            assert!(!refers || attribute.value().starts_with("data:"), "{}", attribute.value());
            assert!(!attribute.name().starts_with("on"), "{}", attribute.name());
        }
        assert!(!["script", "link", "iframe", "object"].contains(&node.tag_name().name()));
    }
    assert!(!text.contains("url(") && !text.contains("@import"));
}

#[test]
fn every_picture_and_plot_has_words_for_who_cannot_see_it() {
    let text = html(&nasty(), Some(&gallery())).unwrap();
    let document = parsed(&text);
    let of = |tag: &'static str| document.descendants().filter(move |node| node.has_tag_name(tag));
    assert_eq!(of("img").count(), 5);
    assert!(of("img").all(|image| image.attribute("alt").is_some_and(|alt| alt.len() > 10)));
    assert_eq!(of("svg").count(), 5, "plane, curves, stages twice, culled");
    assert!(of("svg").all(|plot| plot.attribute("aria-label").is_some_and(|alt| alt.len() > 10)));
}

#[test]
fn no_number_of_a_plot_is_broken() {
    let mut one = nasty();
    one.frames = 1;
    for method in &mut one.methods {
        method.frames.frame_ms.truncate(1);
        method.frames.stages.clear();
    }
    let mut zero = nasty();
    zero.methods.iter_mut().for_each(|method| {
        method.frame_ms = Default::default();
        method.frames.frame_ms = vec![0.0; 2];
    });
    let empty = Results { methods: Vec::new(), ..nasty() };
    for results in [nasty(), one, zero, empty] {
        let text = html(&results, None).unwrap();
        parsed(&text);
        let plots: Vec<&str> = text.split("<svg").skip(1).filter_map(|rest| rest.split("</svg>").next()).collect();
        assert!(plots.iter().all(|plot| !plot.contains("NaN") && !plot.contains("inf\"")), "{plots:?}");
    }
}

#[test]
fn what_was_not_measured_is_said() {
    let with = html(&nasty(), Some(&gallery())).unwrap();
    let made_from_file = html(&nasty(), None).unwrap();
    let mut unmeasured = nasty();
    unmeasured.methods.iter_mut().for_each(|method| method.frames.drawn.clear());
    let unmeasured = html(&unmeasured, None).unwrap();
    let says =
        |text: &str, said: &str| parsed(text).descendants().any(|node| node.text().is_some_and(|t| t.contains(said)));
    for (text, plane, errors, pictures) in
        [(&with, true, true, true), (&made_from_file, true, true, false), (&unmeasured, false, false, false)]
    {
        assert_eq!(says(text, "Each point is a method"), plane);
        assert_eq!(says(text, "Errors against the truth"), errors);
        assert_eq!(says(text, "Worst frames"), pictures);
        assert_eq!(says(text, "Errors were not measured"), !errors);
    }
    assert!(says(&made_from_file, "There are no pictures"));
}

#[test]
fn the_front_leaves_the_ideal_aside() {
    let mut results = nasty();
    results.methods[1].object_error_percent = 0.5;
    // 1000 ms without error, 12.5 ms with some; ref, at 10 ms without error, would beat both.
    assert_eq!(front(&results), [1, 0]);
    let text = html(&results, None).unwrap();
    let document = parsed(&text);
    let marks = |class: &str| {
        let has = |node: &roxmltree::Node<'_, '_>| node.attribute("class").is_some_and(|all| all.contains(class));
        document.descendants().filter(has).count()
    };
    assert_eq!((marks("ring"), marks("hollow")), (2, 1));
}

#[test]
fn sixty_settings_stay_readable() {
    let mut results = nasty();
    let woc = results.methods[1].clone();
    for place in 0..57u32 {
        let mut more = woc.clone();
        more.label = format!("woc[seeds={place}]");
        more.frame_ms.median = 20.0 + f64::from(place % 7);
        more.object_error_percent = 0.1 + f64::from(place % 5);
        results.methods.push(more);
    }
    let text = html(&results, None).unwrap();
    let plane = text.split("<svg").nth(1).unwrap().split("</svg>").next().unwrap();
    let labels = results.methods.iter().filter(|method| plane.contains(&format!(">{}</text>", method.label))).count();
    assert!(labels <= 3, "{labels} labels");
    assert_eq!(plane.matches("<title>").count(), 60, "each point says what it is");
}

#[test]
fn a_report_that_cannot_be_written_names_its_file_and_leaves_the_results() {
    let folder = Folder::new("report-unwritable");
    let results_file = folder.0.join("results.json");
    nasty().write_json(&results_file).unwrap();
    // A folder where the report should be: the rename fails, whoever runs the test.
    std::fs::create_dir(folder.0.join("report.html")).unwrap();
    std::fs::write(folder.0.join("report.html/kept"), "").unwrap();
    let message = format!("{:#}", write(&nasty(), None, &folder.0.join("report.html")).unwrap_err());
    assert!(message.contains("report.html: cannot write it") && !message.contains('\n'), "{message}");
    assert_eq!(folder.names(), ["report.html", "results.json"]);
    assert_eq!(Results::read_json(&results_file).unwrap(), nasty());
}
