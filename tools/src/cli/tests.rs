//! The command line: what its flags come to, and what it refuses.

use super::*;
use crate::run::methods::parse_methods;
use clap::CommandFactory;

#[test]
fn the_command_line_is_consistent() {
    Cli::command().debug_assert();
}

#[test]
fn one_command_takes_one_scene_and_a_table_several() {
    let bench = |line: &str| match Cli::try_parse_from(line.split(' ')).map(|cli| cli.command) {
        Ok(Command::Bench(arguments)) => Ok(arguments),
        other => Err(format!("{other:?}")),
    };
    assert_eq!(bench("sightline bench").unwrap().scene.one_scene().unwrap(), Path::new("city-block"));
    let two = bench("sightline bench --scene rooms,boxes --scene city-block --table eovc-2").unwrap();
    assert_eq!(two.scene.scenes().unwrap(), ["rooms", "boxes", "city-block"].map(PathBuf::from));
    assert!(two.scene.one_scene().unwrap_err().to_string().contains("give one scene"));
    for refused in ["--table eovc-1", "--table eovc-2 --method none", "--table eovc-2 --json"] {
        assert!(bench(&format!("sightline bench {refused}")).is_err(), "{refused}");
    }
}

#[test]
fn a_file_whose_name_holds_a_comma_is_taken_whole_where_it_is_there() {
    let folder = std::env::temp_dir().join(format!("sightline-commas-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let file = folder.join("red, green.glb");
    let given = |file: &Path| -> Vec<String> {
        let line = ["sightline", "shot", "--scene", file.to_str().unwrap(), "--scene", "rooms,boxes"];
        match Cli::parse_from(line).command {
            Command::Shot(arguments) => {
                arguments.scene.scenes().unwrap().iter().map(|scene| scene.to_string_lossy().into_owned()).collect()
            }
            other => panic!("{other:?}"),
        }
    };
    let parts: Vec<String> = file.to_str().unwrap().split(',').map(|part| part.trim().to_owned()).collect();
    assert_eq!(given(&file), [parts[0].as_str(), "green.glb", "rooms", "boxes"]);
    std::fs::write(&file, "").unwrap();
    let found = given(&file);
    std::fs::remove_dir_all(&folder).unwrap();
    assert_eq!(found, [file.to_str().unwrap(), "rooms", "boxes"]);
}

/// Each of these values ran the default scene.
#[test]
fn a_scene_that_names_none_is_refused() {
    for none in [",", " ", ",,", " , "] {
        match Cli::parse_from(["sightline", "shot", "--scene", none]).command {
            Command::Shot(arguments) => {
                let error = arguments.scene.session().unwrap_err().to_string();
                assert!(error.contains("names no scene"), "{error}");
            }
            other => panic!("{other:?}"),
        }
    }
    assert!(Cli::try_parse_from(["sightline", "shot", "--scene", ""]).is_err());
    assert!(Cli::try_parse_from(["sightline", "bench", "--scene=", "--table", "eovc-2"]).is_err());
}

#[test]
fn no_skip_reaches_every_method_that_can_skip_and_no_other() {
    let labels = |line: &str| match Cli::parse_from(line.split(' ')).command {
        Command::Bench(arguments) => {
            let methods = parse_methods(&arguments.methods.method, &arguments.methods.sets()).unwrap();
            methods.iter().map(|(_, options)| options.label()).collect::<Vec<_>>()
        }
        other => panic!("{other:?}"),
    };
    assert_eq!(labels("sightline bench --method none,hzb,ref"), ["none", "hzb", "ref"]);
    let all = labels("sightline bench --method all --no-skip");
    for (entry, label) in METHODS.iter().zip(all) {
        let skips = entry.options.contains(&SKIP_OPTION);
        assert_eq!(label.contains("skip=false"), skips, "{label}");
    }
    assert_eq!(labels("sightline bench --method hzb,auto --allow-error 0.5"), ["hzb", "auto[allow-error=0.5]"]);
    assert!(
        Cli::try_parse_from("sightline bench --allow-error 7".split(' ')).is_err(),
        "a percentage that is not offered"
    );
    // What is set by hand comes later, and holds.
    assert_eq!(labels("sightline bench --method hzb --no-skip --set hzb.skip=true"), ["hzb"]);
}

#[test]
fn a_level_of_detail_reaches_the_session() {
    let level = |line: &str| match Cli::parse_from(line.split(' ')).command {
        Command::Shot(arguments) => arguments.scene.session().unwrap().detail,
        other => panic!("{other:?}"),
    };
    assert_eq!(level("sightline shot"), SceneOptions::default().detail);
    assert_eq!(level("sightline shot --scene powerplant --detail-level 3"), 3);
}

#[test]
fn a_shading_reaches_the_session() {
    let shading = |line: &str| match Cli::parse_from(line.split(' ')).command {
        Command::Shot(arguments) => arguments.scene.session().unwrap().shading,
        other => panic!("{other:?}"),
    };
    assert_eq!(shading("sightline shot"), None, "what the scene has");
    assert_eq!(shading("sightline shot --shading lambert"), Some(Shading::Lambert));
    assert_eq!(shading("sightline shot --shading textured"), Some(Shading::Textured));
    assert!(Cli::try_parse_from("sightline shot --shading flat".split(' ')).is_err());
}

#[test]
fn auto_is_the_default_choice_and_a_warm_up_the_tables() {
    let bench = |line: &str| match Cli::parse_from(line.split(' ')).command {
        Command::Bench(arguments) => arguments,
        other => panic!("{other:?}"),
    };
    let usual = bench("sightline bench");
    assert_eq!(usual.methods.method, "none,frustum,auto,ref");
    assert_eq!((usual.warmup(None), usual.warmup(Some(12))), (3, 12));
    assert_eq!(bench("sightline bench --warmup 5").warmup(Some(12)), 5);
    match Cli::parse_from(["sightline", "shot"]).command {
        Command::Shot(arguments) => assert_eq!(arguments.method, culling::default_method().id),
        other => panic!("{other:?}"),
    }
}

#[test]
fn sizes_are_read_or_refused() {
    assert_eq!(parse_size("1280x720"), Ok([1280, 720]));
    for bad in ["0x5", "12", "axb", "-1x5", "1x2x3"] {
        assert!(parse_size(bad).is_err(), "{bad}");
    }
}
