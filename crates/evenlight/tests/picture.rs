//! Pictures of surfaces over cages from files: what must be seen in them.

#![cfg(feature = "picture")]

use std::path::Path;

use evenlight::mesh::BoundaryRule;
use evenlight::picture::{Picture, PictureError, RenderOptions, Style, View, compare, render};
use evenlight::{Cage, Mesh, SchemeKind, Surface, SurfaceOptions, io};

fn load(name: &str, scheme: SchemeKind) -> Surface {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/meshes/obstacle").join(name);
    let bytes = std::fs::read(path).expect("the cage is in data/meshes");
    let (cage, _) = io::load::Format::Obj.read_cage(&bytes).expect("the cage is in order");
    let options = SurfaceOptions { scheme, ..SurfaceOptions::default() };
    Surface::build(cage, options).expect("there are rules for valences up to 16")
}

/// Small pictures of `style` from above, without the colour bar (they are too small for it).
fn from_above(style: Style) -> RenderOptions {
    let view = View { azimuth: 0.0, elevation: 90.0, ..View::default() };
    RenderOptions { style, view, size: [240, 240], samples: 2, ..RenderOptions::default() }
}

/// The picture that shows only the background.
fn background(surface: &Surface, options: &RenderOptions) -> Picture {
    let view = View { target: Some([1e6; 3]), ..options.view };
    let range = Some(1.0);
    render(surface, &RenderOptions { view, range, ..options.clone() }).expect("valid options")
}

/// The pixels of `picture` that differ from the background. (That has a note in the middle,
/// which the surface must cover.)
fn covered(picture: &Picture, background: &Picture) -> Vec<[u8; 3]> {
    let pairs = picture.pixels().iter().zip(background.pixels());
    pairs.filter(|(a, b)| a != b).map(|(a, _)| *a).collect()
}

#[test]
fn a_plane_has_one_colour_and_no_curvature() {
    for scheme in SchemeKind::ALL {
        let plane = load("flat_n5.obj", scheme);
        for style in [Style::Shaded, Style::Highlight, Style::Gauss, Style::Mean] {
            // One sample per pixel: the outline is not mixed with the background.
            let options = RenderOptions { samples: 1, ..from_above(style) };
            let picture = render(&plane, &options).unwrap();
            let center = picture.pixel(120, 60).unwrap();
            let off = covered(&picture, &background(&plane, &options));
            let others = off.iter().filter(|&&p| p != center).count();
            assert!(off.len() > 20_000 && others == 0, "{style:?}: {others} of {}", off.len());
            if matches!(style, Style::Gauss | Style::Mean) {
                assert!(center[0].abs_diff(center[2]) <= 1, "no blue, no red: {center:?}");
            }
        }
    }
}

/// `pillow_n8` has the symmetries of a regular octagon, one of its mirrors being x = 0.
#[test]
fn a_symmetric_cage_has_a_symmetric_picture() {
    for scheme in SchemeKind::ALL {
        let surface = load("pillow_n8.obj", scheme);
        for style in [Style::Highlight, Style::Gauss, Style::Mean] {
            let options = RenderOptions { stripe_direction: 0.0, ..from_above(style) };
            let picture = render(&surface, &options).unwrap();
            let different = (0..240 * 240).filter(|i| {
                let (x, y) = (i % 240, i / 240);
                let (a, b) = (picture.pixel(x, y).unwrap(), picture.pixel(239 - x, y).unwrap());
                (0..3).any(|k| a[k].abs_diff(b[k]) > 8)
            });
            let different = different.count();
            assert!(different < 200, "{scheme:?} {style:?}: {different} pixels differ");
        }
    }
}

#[test]
fn equal_pictures_are_equal_files_of_the_right_size() {
    let surface = load("saddle_n5.obj", SchemeKind::CatmullClark);
    let options =
        RenderOptions { style: Style::Mean, size: [401, 203], ..RenderOptions::default() };
    let file = || {
        let mut file = Vec::new();
        render(&surface, &options).unwrap().write_png(&mut file).unwrap();
        file
    };
    let (first, second) = (file(), file());
    assert_eq!(first, second);
    // The header chunk of a PNG file begins at byte 8: length, name, width, height.
    assert_eq!(&first[..8], b"\x89PNG\r\n\x1a\n");
    assert_eq!(&first[12..16], b"IHDR");
    assert_eq!(first[16..24], [0, 0, 1, 145, 0, 0, 0, 203]);
}

#[test]
fn panels_of_the_same_surface_are_the_same() {
    let surface = load("saddle_n6.obj", SchemeKind::CatmullClark);
    let options =
        RenderOptions { style: Style::Gauss, size: [200, 100], ..RenderOptions::default() };
    let picture = compare(&[("a", &surface), ("a", &surface)], &options).unwrap();
    // The first column of the second panel is the line between them.
    for (x, y) in (1..100).flat_map(|x| (0..100).map(move |y| (x, y))) {
        assert_eq!(picture.pixel(x, y), picture.pixel(100 + x, y), "at {x}, {y}");
    }
}

/// All panels are coloured by one range: the picture is that of the range given explicitly.
#[test]
fn the_range_is_shared_and_explicit_ranges_are_kept() {
    let [cc, eg, ..] = SchemeKind::ALL.map(|scheme| load("saddle_n8.obj", scheme));
    let both = |range| {
        let options = RenderOptions { range, ..from_above(Style::Mean) };
        compare(&[("", &cc), ("", &eg)], &options).unwrap()
    };
    let same = compare(
        &[("", &cc), ("", &cc)],
        &RenderOptions { range: Some(0.3), ..from_above(Style::Mean) },
    );
    let left = |picture: &Picture| (0..119).map(|x| picture.pixel(x, 120)).collect::<Vec<_>>();
    assert_eq!(left(&both(Some(0.3))), left(&same.unwrap()));
    assert_ne!(both(Some(0.3)), both(Some(3.0)));
}

#[test]
fn extraordinary_points_can_be_looked_at() {
    let surface = load("pillow_n5.obj", SchemeKind::CatmullClark);
    for number in 0..surface.extraordinary_points().len() {
        let rings = surface.rings(number).unwrap();
        let view = View::toward(&surface, number).unwrap();
        let (azimuth, elevation) = (view.azimuth.to_radians(), view.elevation.to_radians());
        let flat = elevation.cos();
        let eye = [flat * azimuth.sin(), -flat * azimuth.cos(), elevation.sin()];
        assert!((0..3).all(|k| (eye[k] - rings.normal()[k]).abs() < 1e-6), "{eye:?}");
        assert_eq!(view.target, Some(rings.center()));
    }
    assert_eq!(View::toward(&surface, usize::MAX), None);
}

#[test]
fn without_a_surface_there_is_a_note() {
    let square = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    // Its only face is left out.
    let cage = Cage::new(Mesh::new(square.to_vec(), [[0, 1, 2, 3]])).unwrap();
    let options =
        SurfaceOptions { boundary: Some(BoundaryRule::None), ..SurfaceOptions::default() };
    let surface = Surface::build(cage, options).unwrap();
    for style in Style::ALL {
        let options = RenderOptions { style, size: [420, 160], ..RenderOptions::default() };
        let picture = render(&surface, &options).unwrap();
        let ink = [44, 52, 62];
        assert!(picture.pixels().contains(&ink), "{style:?}: no text");
    }
}

#[test]
fn the_smallest_pictures_can_be_drawn() {
    let surface = load("saddle_n5.obj", SchemeKind::CatmullClark);
    for (size, style) in [[1, 1], [1, 300], [500, 1], [33, 31]]
        .iter()
        .flat_map(|s| Style::ALL.map(|style| (*s, style)))
    {
        let options = RenderOptions { size, style, label: true, ..RenderOptions::default() };
        let picture = render(&surface, &options).unwrap();
        assert_eq!([picture.width(), picture.height()], size);
    }
    let options = RenderOptions { size: [1, 1], ..RenderOptions::default() };
    let narrow = compare(&[("", &surface), ("", &surface)], &options);
    assert_eq!(narrow, Err(PictureError::Panels { panels: 2, width: 1 }));
}
