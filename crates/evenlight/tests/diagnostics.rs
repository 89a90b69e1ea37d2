//! Faults as data: the word of their kind, the line of the file, and what to mark, for every
//! kind of fault that a file can have.

#![allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]

use evenlight::io::load::Format;
use evenlight::io::{Diagnostic, FileError, Severity, read_cage};
use evenlight::mesh::Marks;
use evenlight::{FaceId, VertexId};

/// Four vertices on lines 1 to 4, of which faces can be made.
const VERTICES: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

fn faults(text: &str) -> Vec<Diagnostic> {
    Format::Obj.read_cage(text.as_bytes()).unwrap_err().diagnostics()
}

fn of(vertices: &[u32], edges: &[[u32; 2]], faces: &[u32]) -> Marks {
    Marks {
        vertices: vertices.iter().copied().map(VertexId).collect(),
        edges: edges.iter().map(|edge| edge.map(VertexId)).collect(),
        faces: faces.iter().copied().map(FaceId).collect(),
    }
}

#[test]
fn every_fault_of_a_mesh_has_its_line_and_its_marks() {
    let square = "f 1 2 3 4\n";
    for (faces, kind, line, marks) in [
        ("", "no-faces", None, of(&[], &[], &[])),
        ("f 1 2\n", "too-few-corners", Some(5), of(&[], &[], &[0])),
        ("f 1 2 2\n", "repeated-vertex", Some(5), of(&[1], &[], &[0])),
        ("f 1 2 3 4\nf 1 2 3\n", "inconsistent-orientation", Some(5), of(&[], &[[0, 1]], &[0, 1])),
        (
            "v 0 0 1\nf 1 2 3\nf 2 1 4\nf 1 2 5\n",
            "edge-with-many-faces",
            Some(6),
            of(&[], &[[0, 1]], &[0, 1, 2]),
        ),
        ("v 0 0 1\nv 0 1 1\nf 1 2 3\nf 1 5 6\n", "vertex-not-a-fan", Some(1), of(&[0], &[], &[])),
        (
            &format!("{square}t crease 2/1/0 0 2 1\n"),
            "unknown-tag",
            Some(6),
            of(&[], &[[0, 2]], &[]),
        ),
    ] {
        let found = faults(&format!("{VERTICES}{faces}"));
        let same = |fault: &&Diagnostic| fault.kind == kind && fault.marks == marks;
        let fault = found.iter().find(same).unwrap_or_else(|| panic!("{kind}: {found:?}"));
        assert_eq!((fault.line, fault.severity), (line, Severity::Error), "{fault:?}");
        assert_eq!(fault.to_string(), fault.message);
    }
}

#[test]
fn faults_of_lines_mark_what_the_line_describes() {
    let found = faults("v 0 0 0\nv 1 zero 0\nv 0 1 0\nf 1 2 9\nf 1 2 x\n");
    let found: Vec<_> = found.iter().map(|fault| (fault.kind, fault.line)).collect();
    assert_eq!(
        found,
        [("not-a-number", Some(2)), ("index-too-large", Some(4)), ("not-a-corner", Some(5))]
    );
    assert_eq!(faults("v 0 0 0\nv 1 zero 0\n")[0].marks, of(&[1], &[], &[]));
}

#[test]
fn lines_beyond_those_that_are_listed_are_counted() {
    let found = faults(&"v x 0 0\n".repeat(25));
    assert_eq!(found.len(), 21);
    assert_eq!((found[20].kind, found[20].line), ("more-lines", None));
}

#[test]
fn other_formats_tell_the_line_of_their_fault() {
    let ply = b"ply\nformat ascii 1.0\nelement vertex one\n";
    let fault = &Format::Ply.read(ply, None).unwrap_err().diagnostics()[0];
    assert_eq!((fault.kind, fault.line), ("unreadable", Some(3)));
    let usd = b"#usda 1.0\ndef Mesh \"Cage\" {\n  point3f[] points = [(0, 0, x)]\n}\n";
    let fault = &Format::Usda.read(usd, None).unwrap_err().diagnostics()[0];
    assert_eq!((fault.kind, fault.line), ("unreadable", Some(3)));
}

#[test]
fn meshes_of_text_files_that_count_from_zero_have_lines_too() {
    let ply = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n\
               property float z\nelement face 1\nproperty list uchar int vertex_indices\n\
               end_header\n0 0 0\n1 0 0\n0 1 .5\n3 0 1 1\n";
    let error = Format::Ply.read(ply.as_bytes(), None).unwrap().check().unwrap_err();
    let fault = &error.diagnostics()[0];
    assert_eq!((fault.kind, fault.line), ("repeated-vertex", Some(13)));
    assert_eq!(fault.marks, of(&[1], &[], &[0]));
}

#[test]
fn notices_are_data_too() {
    let text = format!("v 9 9 9\n{VERTICES}g part\nwarp 1\nf 2 3 4 5\n");
    let (_, notices) = Format::Obj.read_cage(text.as_bytes()).unwrap();
    let found: Vec<Diagnostic> = notices.iter().map(|notice| notice.diagnostic()).collect();
    let kinds: Vec<_> = found.iter().map(|notice| (notice.kind, notice.line)).collect();
    assert_eq!(
        kinds,
        [("not-kept", Some(6)), ("unsupported-tag", Some(7)), ("unused-vertices", Some(1))]
    );
    assert!(found.iter().all(|notice| notice.severity == Severity::Warning));
    assert_eq!(found[2].marks, of(&[0], &[], &[]));
}

#[test]
fn a_file_that_is_not_there_is_named() {
    let error = read_cage("no such folder/cage.obj").unwrap_err();
    assert!(matches!(error, FileError::Open { .. }));
    assert!(error.to_string().starts_with("no such folder/cage.obj: "));
    assert_eq!(error.diagnostics()[0].kind, "unreadable");
}

#[test]
fn a_file_is_read_by_its_ending_or_else_by_its_beginning() {
    let folder = std::env::temp_dir().join(format!("evenlight-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let square = format!("{VERTICES}f 1 2 3 4\n");
    for (name, text, expected) in [
        ("a.obj", square.as_str(), Ok(1)),
        ("b.OBJ", &square, Ok(1)),
        ("c", &square, Ok(1)),
        ("d", "ply\nformat ascii 2.0\n", Err("line 2: ")),
        ("e.obj", "ply\nformat ascii 1.0\n", Err("note: it is read as OBJ because of its name")),
        ("f", "nothing\n", Err("neither its name nor its beginning tells what it is")),
        ("g.ply", &square, Err("it looks like OBJ")),
    ] {
        let path = folder.join(name);
        std::fs::write(&path, text).unwrap();
        match (read_cage(&path), expected) {
            (Ok((cage, _)), Ok(faces)) => assert_eq!(cage.num_faces(), faces, "{name}"),
            (Err(error), Err(part)) => {
                let error = error.to_string();
                assert!(error.starts_with(&format!("{}: ", path.display())), "{error}");
                assert!(error.contains(part), "{name}: {error}");
            }
            (found, _) => panic!("{name}: {found:?}"),
        }
    }
    std::fs::remove_dir_all(&folder).unwrap();
}
