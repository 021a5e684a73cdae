//! `--set` reaches every field, and its faults cite the argument.
#![allow(clippy::unwrap_used, reason = "a failed step fails the test")]

use glam::DVec3;
use pliant_scene::{MethodName, Override, Scene, SceneError};

const TEXT: &str = r#"(
    method: constrained,
    tool: (shape: rod(length: 0.1, width: 0.006, height: 0.006)),
    objects: [
        (name: "box", shape: cuboid(size: (1, 1, 1)), pose: (position: (0, 0, 0))),
        (name: "m", shape: mesh(path: "a.obj", unit: mm)),
    ],
    trajectory: (path: "a.csv"),
)"#;

fn set(settings: &[&str]) -> Result<Scene, SceneError> {
    let settings: Result<Vec<Override>, _> = settings.iter().map(|s| Override::parse(s)).collect();
    Scene::from_str(TEXT, "s.ron")
        .unwrap()
        .with_overrides(&settings?)
}

#[test]
fn fields_are_replaced_added_and_nested() {
    let scene = set(&[
        "objects[0].pose.position=(0, 0, 0.1)",
        "objects[1].pose.position=[0.2, 0, 0]",
        "objects[0].pose.position[1]=0.5",
        "method=paper",
        "coupling.linear_stiffness=500",
        "paper.detection_interval=2",
        "objects[0].name=two words",
        "trajectory.path=other.csv",
        "objects[1].shape.convex_hull=true",
        "tool.shape=pin(length: 0.05, radius: 0.001)",
        "seconds = 2",
    ])
    .unwrap();
    let description = scene.description();
    assert_eq!(
        description.objects[0].pose.position.0,
        DVec3::new(0.0, 0.5, 0.1)
    );
    assert_eq!(
        description.objects[1].pose.position.0,
        DVec3::new(0.2, 0.0, 0.0)
    );
    assert_eq!(description.method, MethodName::Paper);
    assert!((description.coupling.linear_stiffness.get() - 500.0).abs() < 1e-12);
    assert_eq!(description.paper.detection_interval.get(), 2);
    assert_eq!(description.objects[0].name, "two words");
    assert_eq!(description.trajectory.path, "other.csv");
    assert!(matches!(
        &description.objects[1].shape,
        pliant_scene::ShapeDescription::Mesh(file) if file.convex_hull
    ));
    assert!((description.seconds.unwrap().get() - 2.0).abs() < 1e-12);
}

#[test]
fn faults_cite_the_argument_and_list_what_there_is() {
    for (setting, part) in [
        (
            "coupling.linear_stifness=5",
            "unknown field `linear_stifness` in `coupling`; expected one of linear_stiffness",
        ),
        (
            "colour=red",
            "unknown field `colour` in `Scene`; expected one of description, rate_hz",
        ),
        ("coupling.linear_stiffness=-5", "-5 is out of range"),
        ("coupling.linear_stiffness=stiff", "expected a number"),
        (
            "method=planes",
            "unknown method `planes`; expected one of constrained, paper",
        ),
        (
            "objects[2].name=x",
            "`objects` has items 0 to 1, there is no item 2",
        ),
        (
            "objects.name=x",
            "`objects` is a list; write the item's number before `name`",
        ),
        (
            "method.kind=x",
            "`method` is a plain value and has no field `kind`",
        ),
        ("tool[0]=x", "`tool` is not a list"),
        ("objects[x].name=y", "`objects[x].name` is not a path"),
        ("rate_hz", "expected path.to.field=value"),
        ("=5", "expected path.to.field=value"),
        ("rate_hz=1), (2", "expected a number"),
    ] {
        let message = set(&[setting]).unwrap_err().to_string();
        assert!(
            message.starts_with(&format!("--set {setting}: ")),
            "{message}"
        );
        assert!(message.contains(part), "{setting}: {message}");
    }
}

#[test]
fn overrides_say_the_same_as_the_file() {
    let place = "(1, 1, 1)";
    for word in ["2cm", "nan", "NaN", "-1", "1e300", "\"2\""] {
        let file = Scene::from_str(&TEXT.replace(place, &format!("({word}, 1, 1)")), "s.ron");
        let file = file.unwrap_err().fault.to_string();
        let setting = format!("objects[0].shape.size[0]={word}");
        let message = set(&[&setting]).unwrap_err().to_string();
        assert_eq!(message, format!("--set {setting}: {file}"));
    }
}

#[test]
fn names_are_compared_after_all_overrides() {
    set(&["objects[0].name=m", "objects[1].name=box"]).unwrap();
    let message = set(&["objects[0].name=m"]).unwrap_err().to_string();
    assert!(
        message.starts_with(
            "s.ron:6:16: another object is named \"m\" too, at --set objects[0].name=m"
        ),
        "{message}"
    );
    let message = set(&["objects[1].name=\"\""]).unwrap_err().to_string();
    assert!(
        message.starts_with("--set objects[1].name=\"\": the name is empty"),
        "{message}"
    );
}

#[test]
fn later_faults_of_the_file_keep_their_place_in_the_file() {
    let scene = set(&["rate_hz=2000", "coupling.linear_stiffness=700"]).unwrap();
    let error = scene
        .build(&pliant_scene::MemoryFiles::default())
        .unwrap_err();
    assert!(
        error
            .to_string()
            .starts_with("s.ron:6:39: cannot read `a.obj`"),
        "{error}"
    );
    let scene = set(&["objects[1].shape.path=gone.stl"]).unwrap();
    let error = scene
        .build(&pliant_scene::MemoryFiles::default())
        .unwrap_err();
    let start = "--set objects[1].shape.path=gone.stl: cannot read `gone.stl`";
    assert!(error.to_string().starts_with(start), "{error}");
}

#[test]
fn comments_in_a_value_hide_nothing_of_the_scene() {
    // Written into one line, all that follows would be part of the comment.
    let text = TEXT.replace('\n', " ");
    let scene = Scene::from_str(&text, "s.ron").unwrap();
    for value in ["paper // faithful", "/* a */ paper /* b */", "paper//"] {
        let setting = Override::parse(&format!("method={value}")).unwrap();
        let set = scene.clone().with_overrides(&[setting]).unwrap();
        assert_eq!(set.description().method, MethodName::Paper, "{value}");
        assert_eq!(set.description().objects.len(), 2, "{value}");
    }
}
