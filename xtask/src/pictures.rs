//! `cargo xtask pictures`: the pictures of the README and the docs, all made by the library.
//!
//! They are written to `crates/evenlight/docs/pictures`. `--check` tells only whether all are
//! there: the bytes of a picture may differ in the last bit of a colour where sine and power
//! functions round differently.

use std::error::Error;
use std::fs;
use std::sync::Arc;

use evenlight::basis::{Eigenfunctions, Parity};
use evenlight::io::load::Format;
use evenlight::net::Quadratic;
use evenlight::picture::{
    self, GraphOptions, Picture, RenderOptions, Style, View, compare, render,
};
use evenlight::point::{add, scale};
use evenlight::rings::Rings;
use evenlight::{Cage, SchemeKind, Surface, SurfaceOptions};

type Result<T> = std::result::Result<T, Box<dyn Error>>;

/// What makes a picture.
type Make = fn() -> Result<Picture>;

/// The pictures.
const PICTURES: [(&str, Make); 7] = [
    ("chair.png", chair),
    ("pinch.png", pinch),
    ("family.png", family),
    ("quadratic.png", quadratic),
    ("patches.png", patches),
    ("fair.png", fair),
    ("eigenfunctions.png", eigenfunctions),
];

/// Draw the pictures of the README and the docs.
#[derive(clap::Args)]
pub struct Arguments {
    /// Only check that all pictures are there
    #[arg(long)]
    check: bool,
}

/// Draws or checks all pictures.
pub fn run(arguments: &Arguments) -> Result<()> {
    let folder = super::workspace("crates/evenlight/docs/pictures");
    for (name, make) in PICTURES {
        let path = folder.join(name);
        if arguments.check {
            let bytes =
                fs::read(&path).map_err(|e| format!("{name}: {e}; run cargo xtask pictures"))?;
            if !bytes.starts_with(b"\x89PNG") {
                return Err(format!("{name} is no picture; run cargo xtask pictures").into());
            }
        } else {
            let mut bytes = Vec::new();
            make()?.write_png(&mut bytes)?;
            println!("{name}: {} kB", bytes.len() / 1000);
            fs::write(&path, bytes)?;
        }
    }
    Ok(())
}

fn cage(path: &str) -> Result<Arc<Cage>> {
    let (cage, _) = Format::Obj.read_cage(&fs::read(super::workspace(path))?)?;
    Ok(Arc::new(cage))
}

fn surface(cage: &Arc<Cage>, scheme: SchemeKind) -> Result<Surface> {
    Ok(Surface::build(cage.clone(), SurfaceOptions { scheme, ..SurfaceOptions::default() })?)
}

/// The demo object, as the first thing of the README.
fn chair() -> Result<Picture> {
    let surface = surface(&cage("crates/evenlight-cli/assets/demo.obj")?, SchemeKind::Qas4)?;
    let view = View { azimuth: -30.0, elevation: 28.0, ..View::default() };
    let options = RenderOptions { size: [1000, 800], view, ..RenderOptions::default() };
    Ok(render(&surface, &options)?)
}

/// Highlight lines over the extraordinary point of a saddle of valence 8, near it.
fn pinch() -> Result<Picture> {
    highlight_lines(
        "data/meshes/obstacle/saddle_n8.obj",
        &[SchemeKind::CatmullClark, SchemeKind::EvolvingGuide, SchemeKind::Qas4],
        5.0,
    )
}

/// The schemes of the family on one cage.
fn family() -> Result<Picture> {
    highlight_lines(
        "data/meshes/obstacle/ridges_n7.obj",
        &[SchemeKind::EvolvingGuide, SchemeKind::Qas4, SchemeKind::Fair4, SchemeKind::Guided5],
        2.5,
    )
}

fn highlight_lines(path: &str, schemes: &[SchemeKind], zoom: f64) -> Result<Picture> {
    near_the_point(path, schemes, Style::Highlight, zoom)
}

/// Several schemes over one cage, seen from above its first point.
fn near_the_point(path: &str, schemes: &[SchemeKind], style: Style, zoom: f64) -> Result<Picture> {
    let cage = cage(path)?;
    let surfaces: Vec<Surface> =
        schemes.iter().map(|&scheme| surface(&cage, scheme)).collect::<Result<_>>()?;
    let panels: Vec<(&str, &Surface)> =
        surfaces.iter().map(|s| (s.options().scheme.name(), s)).collect();
    let view = View::toward(&surfaces[0], 0).ok_or("the first point has no normal")?;
    let options = RenderOptions {
        style,
        size: [400 * schemes.len(), 400],
        view: View { zoom: zoom * view.zoom, ..view },
        ..RenderOptions::default()
    };
    Ok(compare(&panels, &options)?)
}

/// Mean curvature near the extraordinary point of a saddle of valence 8.
fn fair() -> Result<Picture> {
    let schemes = [
        SchemeKind::EvolvingGuide,
        SchemeKind::Qas4,
        SchemeKind::Fair4,
        SchemeKind::Fair4d,
        SchemeKind::Guided5,
    ];
    near_the_point("data/meshes/obstacle/saddle_n8.obj", &schemes, Style::Mean, 5.0)
}

/// A monkey saddle with its default quadratic and with three others: lifted, tilted, and bent.
fn quadratic() -> Result<Picture> {
    let cage = cage("data/meshes/obstacle/monkey_n6.obj")?;
    let default = surface(&cage, SchemeKind::Qas4)?;
    let q = *default.rings(0).and_then(Rings::quadratic).ok_or("qas4 has a quadratic")?;
    let normal = default.rings(0).map_or([0.0; 3], Rings::normal);
    let identity = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let lifted = q.transformed(identity, scale(0.25, normal));
    let about_center = |matrix: [[f64; 3]; 3]| {
        let image = q.transformed(matrix, [0.0; 3]).center();
        let back = [0, 1, 2].map(|k| q.center()[k] - image[k]);
        q.transformed(matrix, back)
    };
    let tilted = about_center([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.35, 0.0, 1.0]]);
    let mut bent = q;
    for k in [2, 5] {
        bent.coefs[k] = add(bent.coefs[k], scale(0.06, normal));
    }
    let with = |q: &Quadratic| -> Result<Surface> {
        let mut surface = surface(&cage, SchemeKind::Qas4)?;
        surface.set_quadratic(0, q);
        Ok(surface)
    };
    let others = [("lifted", with(&lifted)?), ("tilted", with(&tilted)?), ("bent", with(&bent)?)];
    let mut panels = vec![("default q", &default)];
    panels.extend(others.iter().map(|(name, surface)| (*name, surface)));
    let view = View { azimuth: 20.0, elevation: 40.0, zoom: 1.6, target: Some(q.center()) };
    let options = RenderOptions {
        style: Style::Highlight,
        size: [1400, 350],
        view,
        stripes: 16,
        ..RenderOptions::default()
    };
    Ok(compare(&panels, &options)?)
}

/// The layout of patches in the three degrees and splittings.
fn patches() -> Result<Picture> {
    let cage = cage("data/meshes/obstacle/saddle_n6.obj")?;
    let surfaces: Vec<Surface> = [SchemeKind::CatmullClark, SchemeKind::Qas4, SchemeKind::Qas3]
        .into_iter()
        .map(|scheme| surface(&cage, scheme))
        .collect::<Result<_>>()?;
    let panels: Vec<(&str, &Surface)> =
        surfaces.iter().map(|s| (s.options().scheme.name(), s)).collect();
    let view = View { azimuth: 30.0, elevation: 50.0, ..View::default() };
    let options = RenderOptions {
        style: Style::Patches,
        size: [1200, 400],
        view,
        ..RenderOptions::default()
    };
    Ok(compare(&panels, &options)?)
}

/// Eigenfunctions of guided5 at valence 5: the even ones of eigenvalues lambda^2 to lambda^4.
fn eigenfunctions() -> Result<Picture> {
    let functions = Eigenfunctions::new(SchemeKind::Guided5, 5).ok_or("guided5 has valence 5")?;
    let is_even =
        |&k: &usize| functions.guide(k).is_some_and(|guide| guide.parity() == Parity::Even);
    let from_degree_2 = functions.of_degree(2).start..functions.len();
    let which: Vec<usize> = from_degree_2.filter(is_even).take(10).collect();
    let options = GraphOptions { size: [1400, 560], ..GraphOptions::default() };
    Ok(picture::eigenfunctions(&functions, &which, &options)?)
}
