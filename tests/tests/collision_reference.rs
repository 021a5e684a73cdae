//! Judges `closest_points` by the 333 reference pairs of `reference/collision-open.json`: touching, parallel, coincident,
//! needle-shaped, flat, 1e-6 m and 1e4 m wide, each with an exhaustively computed signed distance.

use std::collections::BTreeMap;
use std::path::Path;

use pliant_collision::SimplexCache;
use pliant_tests::collision::reference::{Reference, parse, read};
use pliant_tests::collision::shape::Body;
use pliant_tests::collision::verdict::judge;

fn open_reference() -> Reference {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("reference/collision-open.json");
    read(&path).expect("the reference file is part of the project")
}

fn faults(reference: &Reference) -> Vec<String> {
    let mut caches: BTreeMap<[usize; 2], SimplexCache> = BTreeMap::new();
    let mut faults = Vec::new();
    for case in &reference.cases {
        let verdict = judge(reference, case, caches.entry(case.shapes).or_default());
        let named = |fault| format!("{} {}: {fault}", case.family, case.id);
        faults.extend(verdict.faults.into_iter().map(named));
    }
    faults
}

fn assert_no_faults(reference: &Reference) {
    assert_eq!(reference.cases.len(), 333);
    let faults = faults(reference);
    assert!(faults.is_empty(), "{faults:#?}");
}

#[test]
fn all_reference_pairs_pass_on_convex_meshes() {
    let reference = open_reference();
    let is_mesh = |body: &Body| matches!(body, Body::Mesh(_));
    let meshes = reference.shapes.iter().filter(|shape| is_mesh(&shape.body));
    assert!(meshes.count() > 10);
    assert_no_faults(&reference);
}

#[test]
fn all_reference_pairs_pass_on_bare_points() {
    let mut reference = open_reference();
    for shape in &mut reference.shapes {
        if let Body::Mesh(mesh) = &shape.body {
            shape.body = Body::Points(mesh.positions().to_vec());
        }
    }
    assert_no_faults(&reference);
}

/// A unit box beside another, 1 m apart along x, as the text of a file.
fn two_boxes() -> String {
    r#"{"format":"convex-pairs-1","shapes":[{"kind":"box","half":[0.5,0.5,0.5]}],"pairs":[{"id":7,"family":"f","a":0,"b":0,
"ra":[1,0,0,0,1,0,0,0,1],"ta":[0,0,0],"rb":[1,0,0,0,1,0,0,0,1],"tb":[2,0,0],"signed_distance":1.0,"normal":[1,0,0],
"tol":1e-9,"normal_tol_rad":1e-9}]}"#
        .to_owned()
}

#[test]
fn wrong_truths_are_told_from_right_ones() {
    assert!(faults(&parse(&two_boxes()).unwrap()).is_empty());
    let off = two_boxes().replace("\"signed_distance\":1.0", "\"signed_distance\":1.00000001");
    assert!(faults(&parse(&off).unwrap())[0].contains("separation"));
    let flipped = two_boxes().replace("\"normal\":[1,0,0]", "\"normal\":[-1,0,0]");
    assert!(faults(&parse(&flipped).unwrap())[0].contains("normal off by 3.14"));
    // Both placements turned by 90° about z: the normal turns along.
    let quarter = "[0,-1,0,1,0,0,0,0,1]";
    let turned = two_boxes()
        .replace("[1,0,0,0,1,0,0,0,1]", quarter)
        .replace("\"tb\":[2,0,0]", "\"tb\":[0,2,0]");
    assert!(!faults(&parse(&turned).unwrap()).is_empty());
    let turned = turned.replace("\"normal\":[1,0,0]", "\"normal\":[0,1,0]");
    assert!(faults(&parse(&turned).unwrap()).is_empty());
}

#[test]
fn malformed_files_are_refused_with_the_place() {
    let said = |from: &str, to: &str| {
        let text = two_boxes();
        assert!(text.contains(from), "{from}");
        match parse(&text.replacen(from, to, 1)) {
            Ok(_) => panic!("accepted {to}"),
            Err(error) => format!("{error:#}"),
        }
    };
    assert!(said("convex-pairs-1", "convex-pairs-2").contains("convex-pairs-2"));
    assert!(said("\"b\":0", "\"b\":1").contains("pairs[0] (id 7): b names shape 1 of 1"));
    assert!(said("\"ra\":[1,", "\"ra\":[2,").contains("ra: the matrix is no rotation"));
    assert!(said("\"tb\":[2,0,0]", "\"tb\":[2,0]").contains("line 2 column"));
    assert!(said("\"box\"", "\"cube\"").contains("cube"));
    assert!(said("[0.5,0.5,0.5]", "[0.5,-0.5,0.5]").contains("shapes[0]"));
    let hull = r#""kind":"hull","vertices":[[0,0,0],[1,0,0],[0,1,0]],"faces":[[0,1,3]]"#;
    let fault = said(r#""kind":"box","half":[0.5,0.5,0.5]"#, hull);
    assert!(
        fault.contains("shapes[0]: faces[0] names vertex 3 of 3"),
        "{fault}"
    );
    let ellipsoid = r#""kind":"latlong","slices":4000000000,"stacks":9,"radii":[1,1,1]"#;
    assert!(said(r#""kind":"box","half":[0.5,0.5,0.5]"#, ellipsoid).contains("4000000000 slices"));
}

#[test]
fn awkward_hulls_are_judged_all_the_same() {
    // The same box as a hull: quadrilateral faces; vertices twice and faces none; wound inward.
    let corners = "[-0.5,-0.5,-0.5],[0.5,-0.5,-0.5],[-0.5,0.5,-0.5],[0.5,0.5,-0.5],
[-0.5,-0.5,0.5],[0.5,-0.5,0.5],[-0.5,0.5,0.5],[0.5,0.5,0.5]";
    let quadrilaterals = "[[0,2,3,1],[4,5,7,6],[0,1,5,4],[2,6,7,3],[0,4,6,2],[1,3,7,5]]".to_owned();
    for (vertices, faces) in [
        (corners.to_owned(), format!(",\"faces\":{quadrilaterals}")),
        (format!("{corners},{corners}"), String::new()),
    ] {
        let hull = format!("\"kind\":\"hull\",\"vertices\":[{vertices}]{faces}");
        let text = two_boxes().replace(r#""kind":"box","half":[0.5,0.5,0.5]"#, &hull);
        let reference = parse(&text).unwrap();
        let faults = faults(&reference);
        assert!(faults.is_empty(), "{faults:#?}");
    }
}
