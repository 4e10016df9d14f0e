use super::*;

fn read_text(text: &str) -> Result<(Mesh, Vec<Vector>)> {
    read(text.as_bytes(), UpAxis::Z).map(|content| (content.mesh, content.positions))
}

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

#[test]
fn triangles_quads_and_polygons_are_read_in_the_order_of_the_file() {
    let text = format!("# made by hand\no flag\n{SQUARE}v 2 0.5 0\ns off\nf 1 2 3 4\nf 2 5 3\n");
    let (mesh, positions) = read_text(&text).expect("a good file");
    assert_eq!(mesh.faces().collect::<Vec<_>>(), [&[0, 1, 2, 3][..], &[1, 4, 2]]);
    assert_eq!(positions[4], Vector::new(2.0, 0.5, 0.0));
    let (mesh, _) = read_text(&format!("{SQUARE}v -1 0.5 0\nf 1 2 3 4 5")).expect("a pentagon");
    assert_eq!(mesh.face(0), [0, 1, 2, 3, 4]);
}

#[test]
fn every_form_of_a_corner_names_its_vertex() {
    for face in
        ["1 2 3 4", "-4 -3 -2 -1", "1/1 2/2 3/3 4/4", "1//1 2//1 3//1 4//1", "1/1/1 2/ 3// 4"]
    {
        let text = format!("{SQUARE}vt 0 0\nvn 0 0 1\nf {face}\n");
        assert_eq!(read_text(&text).expect(face).0.face(0), [0, 1, 2, 3], "{face}");
    }
}

#[test]
fn uv_coordinates_are_those_of_the_corners_and_none_where_one_is_missing() {
    let vt = "vt 0 0\nvt 0.5 0 0.3\nvt 0.5 1\nvt 0.25\n";
    let uvs = |face: &str| {
        let text = format!("{SQUARE}{vt}f {face}\n");
        read(text.as_bytes(), UpAxis::Z).expect(face).uvs
    };
    let all = vec![[0.0, 0.0], [0.5, 0.0], [0.5, 1.0], [0.25, 0.0]];
    assert_eq!(uvs("1/1 2/2 3/3 4/4"), Some(all.clone()));
    assert_eq!(uvs("1/-4 2/-3/1 3/-2/1 4/4/1"), Some(all.clone()));
    assert_eq!(uvs("4/1 3/4 2/3 1/1"), Some(vec![all[0], all[3], all[2], all[0]]));
    for face in ["1 2 3 4", "1/1 2/2 3/3 4", "1//1 2//1 3//1 4//1", "1/1 2/2 3/3 4/5"] {
        assert_eq!(uvs(face), None, "{face}");
    }
}

#[test]
fn lines_that_are_no_side_of_a_face_are_loose_edges() {
    let text = format!("l 1 3 2\n{SQUARE}f 1 2 3 4\nl -1 -2\nl 2 4\n");
    let (mesh, positions) = read_text(&text).expect("a good file");
    assert_eq!(mesh.loose_edges(), [[0, 2], [1, 3]]);
    let mut written = Vec::new();
    write(&mut written, &mesh, &positions).expect("there is room");
    assert_eq!(read(&written[..], UpAxis::Z).expect("what we wrote").mesh, mesh);
    for (line, expected) in [
        ("l 1", "line 6: a line with 1 vertices; accepted: 2 or more"),
        ("l 1 9", "line 6: the line names vertex 9; accepted: 1 to 4"),
    ] {
        let error = read_text(&format!("{SQUARE}f 1 2 3 4\n{line}\n")).expect_err(expected);
        assert_eq!(error.to_string(), expected);
    }
}

#[test]
fn a_backslash_continues_a_line_and_windows_line_ends_are_taken() {
    let text = format!("{SQUARE}f 1 2 \\\n3 4\n").replace('\n', "\r\n");
    assert_eq!(read_text(&text).expect("a good file").0.face(0), [0, 1, 2, 3]);
}

#[test]
fn vertex_colours_are_passed_over() {
    let (_, positions) =
        read_text("v 0 0 0 0.1 0.2 0.3\nv 1 0 0\nv 0 1 0 1.0\nf 1 2 3").expect("a good file");
    assert_eq!(positions[2], Vector::y());
}

#[test]
fn a_face_may_stand_before_its_vertices() {
    let (mesh, _) = read_text(&format!("f 1 2 3 4\n{SQUARE}")).expect("a good file");
    assert_eq!(mesh.face(0), [0, 1, 2, 3]);
}

#[test]
fn y_up_is_turned_to_z_up() {
    let text = "v 1 2 3\nv 0 0 0\nv 0 1 0\nf 1 2 3";
    let Content { positions, .. } = read(text.as_bytes(), UpAxis::Y).expect("a good file");
    assert_eq!(positions[0], Vector::new(1.0, -3.0, 2.0));
    assert_eq!(positions[2], Vector::z());
}

#[test]
fn what_is_written_reads_back_to_the_same_bits() {
    let text =
        "v 0.1 -2.5e-7 1e5\nv 0.333333333333333314 0 0\nv 7 1 0\nv 9 9 9\nf 4 1 2 3\nf 1 2 3";
    let (mesh, positions) = read_text(text).expect("a good file");
    let mut bytes = Vec::new();
    write(&mut bytes, &mesh, &positions).expect("memory has room");
    let again = read(bytes.as_slice(), UpAxis::Z).expect("our own file");
    assert_eq!((again.mesh, again.positions), (mesh, positions));
}

#[test]
fn what_is_wrong_is_refused_with_its_line() {
    let table = [
        ("", "no vertices"),
        (SQUARE, "no faces"),
        ("v 0 0\n", "line 1: a vertex with 2 coordinates"),
        ("v 0 0 x\n", "line 1: \"x\" is not a number"),
        ("v 0 0 nan\n", "line 1: coordinate nan"),
        ("v 0 0 inf\n", "line 1: coordinate inf"),
        ("v 0 0 1e300\n", "line 1: coordinate 1e300"),
        ("\nhello world\n", "line 2: \"hello\" is no OBJ statement"),
        ("v 0 0 0\nv 1 0 0\nf 1 2\n", "line 3: a face with 2 corners"),
        ("v 0 0 0\nv 1 0 0\nf 1 2 3\n", "line 3: the face names vertex 3; accepted: 1 to 2"),
        ("v 0 0 0\nv 1 0 0\nf 1 2 0\n", "line 3: corner \"0\""),
        ("v 0 0 0\nv 1 0 0\nf 1 2 -3\n", "line 3: corner \"-3\""),
        ("v 0 0 0\nv 1 0 0\nf 1 2 9223372036854775808\n", "line 3: corner"),
        ("v 0 0 0\nf 1 1.5 2\n", "line 2: corner \"1.5\""),
        ("v 0 0 0\nf 1/a 1 1\n", "line 2: corner \"1/a\""),
        ("vt 0 a\n", "line 1: \"a\" is not a number"),
        ("vt inf 0\n", "line 1: \"inf\" is not a number"),
        ("vt\n", "line 1: a vt with no numbers"),
        ("v 0 0 0\nf 1/1/1/1 1 1\n", "line 2: corner \"1/1/1/1\""),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 5 5 5\nf 1 2 3\n", "vertex 3 (from 0; line 4)"),
        (
            "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3 2\n",
            "line 4: the face passes through vertex 2 twice",
        ),
    ];
    for (text, expected) in table {
        let error = read_text(text).expect_err(expected).to_string();
        assert!(error.contains(expected), "{error} for {text:?}");
    }
}

#[test]
fn bytes_that_are_no_text_are_refused_with_their_line() {
    let error = read(&b"v 0 0 0\n\xff\xfe\n"[..], UpAxis::Z).expect_err("no UTF-8").to_string();
    assert!(error.contains("line 2 is not UTF-8"), "{error}");
    let endless = std::io::BufReader::new(std::io::repeat(b'v'));
    let error = read(endless, UpAxis::Z).expect_err("no end").to_string();
    assert!(error.contains("line 1 is too long"), "{error}");
}
