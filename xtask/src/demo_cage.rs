//! `cargo xtask demo-cage`: the cage of `evenlight demo`, a lounge chair moulded in one piece.
//!
//! The chair is a shell. Its middle is one sheet of quads, which run along its rim everywhere:
//!
//! ```text
//!           .--- top ---.
//!           |  ( hole )  |         6: the back parts around a hole to grip
//!            `--- 6 ---'
//!               |   |
//!     3 3   ,5--+ B +--5.   3 3    5: the back B and the rear legs part
//!        `--'     |     `--'
//!    - side - - - 8 - - - side -   8: the middle of the seat, a saddle, where four legs,
//!        .--.     |     .--.          two sides, front and back meet
//!     3 3    `--front--'    3 3    3: two in every foot
//! ```
//!
//! No extraordinary vertex lies in another's neighbourhood: all are isolated at level 0.
//!
//! The sheet is sketched: seat and back along a profile, which bends up behind the seat and is
//! lifted towards the sides; the legs as tapering strips. Then it is made fair: it minimises the
//! sum of squares of its umbrella vectors (mean of the neighbours minus vertex), while springs
//! pull the nodes to the sketch. At last it gets its thickness, and the whole is made fair once
//! more. One unit is 10 cm; the feet stand near z = 0 and the seat looks along -y.

use std::collections::{BTreeMap, BTreeSet};
use std::error::Error;
use std::fmt::Write;
use std::fs;
use std::ops::Range;

use clap::Args;
use evenlight::point::{Point, Vector, add, add_scaled, cross, dot, lerp, norm, scale, sub, unit};

/// Model the cage of the demonstration and write it
#[derive(Args)]
pub struct Arguments {
    /// Write nothing; fail if the file on disk is not, byte for byte, the modelled cage
    #[arg(long)]
    check: bool,
}

const FILE: &str = "crates/evenlight-cli/assets/demo.obj";

const HEADER: &str = "\
# Evenlight's demo cage: a lounge chair moulded in one piece; closed, quads only, with
# extraordinary vertices of valence 3, 5, 6 and 8. One unit is 10 cm, z is up.
# Written by `cargo xtask demo-cage`; do not edit.
# Ours; licence: MIT OR Apache-2.0.
";

/// Writes or checks the cage.
pub fn run(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    let text = Cage::of_chair().to_obj();
    let path = crate::workspace(FILE);
    if fs::read(&path).is_ok_and(|bytes| bytes == text.as_bytes()) {
        println!("{FILE}: up to date");
    } else if arguments.check {
        return Err(format!("{FILE} differs: run `cargo xtask demo-cage` and commit it").into());
    } else {
        fs::write(&path, text).map_err(|error| format!("cannot write {FILE}: {error}"))?;
        println!("{FILE}: written");
    }
    Ok(())
}

/// The number of quads along a leg, from the middle of the seat to the vertices of valence 3.
const LEG: i32 = 7;
/// The number of nodes along a leg that belong to the seat.
const SEAT: i32 = 3;
/// The column of the back in which the vertices of valence 5 are.
const BACK: i32 = 2;
/// The number of quads up the back, from the vertices of valence 5 to the vertex of valence 6.
const ROWS: i32 = 3;
/// The number of quads around the hole.
const STEPS: i32 = 14;
/// The number of quads from the vertex of valence 6 to the hole.
const INNER: i32 = 2;
/// The number of quads from vertices of valence 3 and 5 to the rim. With two of them the last
/// line but one can be near the rim, which makes it round.
const EDGE: i32 = 2;

/// A place in the sheet.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Place {
    /// In the strip of a leg: `along` it from 0, in the middle of the seat, to the foot;
    /// `across` from -3, the rim at the chair's side, over 0, the ridge, to 3, the rim at the
    /// front or between back and leg.
    Leg { right: bool, rear: bool, along: i32, across: i32 },
    /// In the back: the column from -4 to 4, both on the rim, and the row, from 0 upwards.
    Back { column: i32, row: i32 },
    /// Around the hole: the step, counter-clockwise from below, and the loop, from -2, the rim
    /// of the hole, over 0, through the vertex of valence 6, to 4, the outer rim.
    Hole { step: i32, ring: i32 },
}

impl Place {
    /// The place in the strip of a leg, by the one name that it has wherever strips meet.
    fn in_leg(right: bool, rear: bool, along: i32, across: i32) -> Self {
        // At the end of a foot the rows turn into the lines along it.
        let beyond = (along - LEG).max(0);
        if beyond > 0 && across != 0 {
            return Self::in_leg(right, rear, LEG, across * (1 + beyond));
        }
        if rear && across > 0 && along <= BACK {
            let column = along + across - 1;
            return Self::Back { column: if right { column } else { -column }, row: 0 };
        }
        let right = right || (along == 0 && across >= 0);
        Self::Leg { right, rear: rear && along > 0, along, across }
    }

    /// The place around the hole, by the one name that it has.
    fn around_hole(step: i32, ring: i32) -> Self {
        match (step, ring) {
            (0, 0..) => Self::Back { column: ring, row: ROWS },
            (STEPS, 0..) => Self::Back { column: -ring, row: ROWS },
            _ => Self::Hole { step: step % STEPS, ring },
        }
    }

    fn is_on_rim(self) -> bool {
        match self {
            Self::Leg { along, across, .. } => across.abs() == 1 + EDGE || along == LEG + EDGE,
            Self::Back { column, .. } => column.abs() == BACK + EDGE,
            Self::Hole { ring, .. } => ring == BACK + EDGE || ring == -INNER,
        }
    }
}

/// The middle of the shell: places, numbered as they appear, and faces, counter-clockwise seen
/// from above and from the front.
#[derive(Default)]
struct Sheet {
    numbers: BTreeMap<Place, usize>,
    places: Vec<Place>,
    faces: Vec<[usize; 4]>,
}

impl Sheet {
    fn of_chair() -> Self {
        let mut sheet = Self::default();
        for (right, rear) in [(true, false), (false, false), (true, true), (false, true)] {
            sheet.add_leg(right, rear);
        }
        sheet.add_grid([-BACK - EDGE..BACK + EDGE, 0..ROWS], |column, row| Place::Back {
            column,
            row,
        });
        sheet
            .add_grid([-INNER..BACK + EDGE, 0..STEPS], |ring, step| Place::around_hole(step, ring));
        sheet
    }

    /// Adds a leg with its part of the seat.
    fn add_leg(&mut self, right: bool, rear: bool) {
        // Mirrored legs run through `across` the other way.
        let turn = if right == rear { 1 } else { -1 };
        let place = |along, across: i32| Place::in_leg(right, rear, along, turn * across);
        let mut add = |along, across: [i32; 2]| {
            let [low, high] = if turn > 0 { across } else { [-across[1], -across[0]] };
            self.add_grid([along, low..high], place);
        };
        let inner = if rear { 1 } else { 1 + EDGE };
        add(0..BACK, [-1 - EDGE, inner]);
        add(BACK..LEG, [-1 - EDGE, 1 + EDGE]);
        add(LEG..LEG + EDGE, [-1, 1]);
    }

    fn add_grid(&mut self, [columns, rows]: [Range<i32>; 2], place: impl Fn(i32, i32) -> Place) {
        for i in columns {
            for j in rows.clone() {
                let corners = [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]];
                let face = corners.map(|[i, j]| self.number(place(i, j)));
                self.faces.push(face);
            }
        }
    }

    fn number(&mut self, place: Place) -> usize {
        *self.numbers.entry(place).or_insert_with(|| {
            self.places.push(place);
            self.places.len() - 1
        })
    }

    /// The normal at every place: the normal of the faces around it.
    fn normals(&self, positions: &[Point]) -> Vec<Vector> {
        let mut normals = vec![[0.0; 3]; positions.len()];
        for face in &self.faces {
            let [a, b, c, d] = face.map(|v| positions[v]);
            let normal = unit(cross(sub(c, a), sub(d, b)));
            face.iter().for_each(|&v| add_scaled(&mut normals[v], 1.0, normal));
        }
        normals.into_iter().map(unit).collect()
    }
}

/// Where a place is sketched, and the strength of the spring that pulls it there.
#[derive(Clone, Copy)]
struct Pin {
    at: Point,
    strength: f64,
}

/// The sketch of a place.
fn pin(place: Place) -> Pin {
    match place {
        Place::Leg { right: true, rear, along, across } => leg_pin(rear, along, across),
        Place::Leg { right: false, rear, along, across } => {
            let Pin { at: [x, y, z], strength } = leg_pin(rear, along, across);
            Pin { at: [-x, y, z], strength }
        }
        Place::Back { column, row: ROWS } if column < 0 => hole_pin(STEPS, -column),
        Place::Back { column, row: ROWS } => hole_pin(0, column),
        Place::Back { column, row } => back_pin(column, row),
        Place::Hole { step, ring } => hole_pin(step, ring),
    }
}

/// The profile: (y,z) of the control points of a uniform cubic B-spline. Its parameter t is 0
/// near the fifth, in the middle of the seat, and about the length of arc from there.
const PROFILE: [[f64; 2]; 14] = [
    [-3.76, 1.71],
    [-2.87, 2.15],
    [-1.97, 2.56],
    [-1.00, 2.86],
    [0.00, 3.00],
    [0.99, 2.93],
    [2.03, 2.82],
    [2.81, 3.59],
    [2.85, 4.60],
    [3.13, 5.56],
    [3.66, 6.41],
    [4.25, 7.22],
    [4.87, 8.00],
    [5.50, 8.78],
];

/// The point of seat or back at `x` from the middle and `t` along the profile.
fn on_profile(x: f64, t: f64) -> Point {
    let first = ((t + 3.0).floor() as usize).min(PROFILE.len() - 4);
    let f = t + 3.0 - first as f64;
    let g = 1.0 - f;
    let inner = |f: f64| 3.0 * f * f * (f - 2.0) + 4.0;
    let values = [g * g * g, inner(f), inner(g), f * f * f];
    let slopes = [-g * g, f * (3.0 * f - 4.0), g * (4.0 - 3.0 * g), f * f];
    let sum = |weights: [f64; 4], k: usize| -> f64 {
        weights.iter().zip(&PROFILE[first..]).map(|(w, p)| w * p[k]).sum()
    };
    let up = unit([0.0, -sum(slopes, 1), sum(slopes, 0)]);
    let middle = [x, sum(values, 0) / 6.0, sum(values, 1) / 6.0];
    add(middle, scale(0.5 * curvature_across(t) * x * x, up))
}

/// The curvature across the profile, first of the seat, then of the back.
fn curvature_across(t: f64) -> f64 {
    0.39 / (1.0 + 0.4 * t * t) + 0.24 * ((t - 1.0) / 2.0).clamp(0.0, 1.0)
}

/// [x, |t|] of the seat along a front leg, for `across` from -3.
const FRONT_OF_SEAT: [[[f64; 2]; 3]; 7] = [
    [[2.45, 0.00], [2.52, 0.48], [2.75, 0.95]],
    [[2.25, 0.00], [2.31, 0.55], [2.53, 1.08]],
    [[1.60, 0.00], [1.76, 0.62], [2.20, 1.22]],
    [[0.00, 0.00], [1.00, 0.95], [1.75, 1.62]],
    [[0.00, 1.50], [0.62, 1.65], [1.30, 2.05]],
    [[0.00, 2.02], [0.55, 2.12], [1.08, 2.40]],
    [[0.00, 2.25], [0.52, 2.35], [1.00, 2.66]],
];

/// The same along a rear leg, where the back takes the place of the last three lines.
const REAR_OF_SEAT: [[[f64; 2]; 3]; 4] = [
    [[2.45, 0.00], [2.53, 0.42], [2.78, 0.80]],
    [[2.25, 0.00], [2.33, 0.47], [2.57, 0.88]],
    [[1.60, 0.00], [1.82, 0.50], [2.30, 0.92]],
    [[0.00, 0.00], [1.02, 0.68], [1.92, 1.20]],
];

/// The sketch of a leg on the right, with its part of the seat.
fn leg_pin(rear: bool, along: i32, across: i32) -> Pin {
    let end = if rear { 1.0 } else { -1.0 };
    if along < SEAT {
        let table: &[[[f64; 2]; 3]] = if rear { &REAR_OF_SEAT } else { &FRONT_OF_SEAT };
        let [x, t] = table[(across + 3) as usize][along as usize];
        return Pin { at: on_profile(x, end * t), strength: [0.2, 0.06, 0.01][along as usize] };
    }
    let (top, foot) = if rear {
        ([2.72, 1.72, 2.70], [3.20, 3.00, -0.16])
    } else {
        ([2.40, 2.15, 2.60], [2.95, 2.90, -0.16])
    };
    let beyond = (along - LEG).max(if along == LEG { across.abs() - 1 } else { 0 });
    let u = match beyond {
        1 => 0.95,
        2 => 1.0,
        _ => f64::from(along - SEAT) / f64::from(LEG + 1 - SEAT),
    };
    let [x, y, z] = add(lerp(top, foot, u), leg_section(across, u));
    Pin { at: [x, end * y, z], strength: 0.02 + u * u * u * u }
}

/// A leg's section, seen from its ridge at `u` from top to foot: it looks outward along the
/// diagonal, at first a little upward too, and recedes towards the rim.
fn leg_section(across: i32, u: f64) -> Vector {
    /// [half the width, recess] at the ridge and beside it.
    const TOP: [[f64; 2]; 4] = [[0.00, 0.00], [0.36, 0.10], [0.62, 0.28], [0.76, 0.38]];
    const FOOT: [[f64; 2]; 4] = [[0.00, 0.00], [0.27, 0.04], [0.44, 0.12], [0.54, 0.18]];
    let rank = across.unsigned_abs() as usize;
    let ease = (1.0 - u) * (1.0 - u);
    let [width, recess] = [0, 1].map(|k| FOOT[rank][k] + ease * (TOP[rank][k] - FOOT[rank][k]));
    let outward = unit([1.0, 1.0, 0.9 * (1.0 - u) * ease]);
    let sideways = scale(f64::from(across.signum()), unit([-1.0, 1.0, 0.0]));
    add(scale(width, sideways), scale(-recess, outward))
}

/// The sketch of the back below the hole.
fn back_pin(column: i32, row: i32) -> Pin {
    /// [x, t] by row, from the middle to the rim.
    const TABLE: [[[f64; 2]; 5]; 3] = [
        [[0.0, 1.35], [0.65, 1.38], [1.30, 1.50], [1.75, 1.95], [1.95, 2.30]],
        [[0.0, 2.10], [0.66, 2.12], [1.20, 2.20], [1.58, 2.35], [1.78, 2.50]],
        [[0.0, 3.20], [0.66, 3.20], [1.15, 3.18], [1.52, 3.15], [1.74, 3.12]],
    ];
    /// Between back and leg, where the sheet turns from facing forward to facing sideways.
    const CROTCH: [Point; 2] = [[1.80, 2.14, 3.09], [1.98, 2.35, 3.10]];
    let side = f64::from(column.signum());
    let (rank, row) = (column.unsigned_abs() as usize, row as usize);
    if row == 0 && rank > 2 {
        let [x, y, z] = CROTCH[rank - 3];
        return Pin { at: [side * x, y, z], strength: 0.3 };
    }
    let [x, t] = TABLE[row][rank];
    Pin { at: on_profile(side * x, t), strength: [0.15, 0.05, 0.12][row] }
}

/// The sketch of the back around the hole: superellipses |x/a|^2.4 + |t/b|^2.4 = 1, those
/// outside the vertex of valence 6 without the piece below.
fn hole_pin(step: i32, ring: i32) -> Pin {
    /// a, b, and the angle of step 0 below the horizontal in degrees, from the hole outwards.
    const RINGS: [[f64; 3]; 7] = [
        [1.25, 0.52, 90.0],
        [1.47, 0.75, 90.0],
        [1.95, 1.35, 90.0],
        [2.40, 1.58, 74.0],
        [2.72, 1.78, 62.0],
        [2.95, 1.92, 53.0],
        [3.12, 2.03, 50.0],
    ];
    const CENTRE: f64 = 5.65;
    let [a, b, start] = RINGS[(ring + INNER) as usize];
    let (side, steps) = if 2 * step <= STEPS { (1.0, step) } else { (-1.0, STEPS - step) };
    let part = 2.0 * f64::from(steps) / f64::from(STEPS);
    let angle = (part * (90.0 + start) - start).to_radians();
    let round = |t: f64| t.signum() * t.abs().powf(2.0 / 2.4);
    let at = on_profile(side * a * round(angle.cos()), CENTRE + b * round(angle.sin()));
    Pin { at, strength: if steps == 0 { 0.12 } else { 0.2 } }
}

/// The problem to minimise
///
/// ```text
/// sum_v |umbrella(v)|^2 + strength_v |p_v - at_v|^2,
/// ```
///
/// where the mean of the neighbours has weights 1 / length of the edge in the sketch, so that
/// uneven lines stay uneven. Nodes of the rim have only their neighbours on the rim.
struct Fairing<'a> {
    /// The neighbours of every node with their weights.
    umbrellas: Vec<Vec<(usize, f64)>>,
    pins: &'a [Pin],
}

impl<'a> Fairing<'a> {
    fn new(faces: &[[usize; 4]], pins: &'a [Pin], is_on_rim: impl Fn(usize) -> bool) -> Self {
        let sides = |face: &[usize; 4]| [0, 1, 2, 3].map(|k| [face[k], face[(k + 1) % 4]]);
        let sides = faces.iter().flat_map(sides);
        let edges: BTreeSet<[usize; 2]> = sides.flat_map(|[v, w]| [[v, w], [w, v]]).collect();
        let mut umbrellas = vec![Vec::new(); pins.len()];
        for [v, w] in edges {
            if is_on_rim(w) || !is_on_rim(v) {
                umbrellas[v].push((w, 1.0 / norm(sub(pins[v].at, pins[w].at))));
            }
        }
        for umbrella in &mut umbrellas {
            let sum: f64 = umbrella.iter().map(|(_, weight)| weight).sum();
            umbrella.iter_mut().for_each(|(_, weight)| *weight /= sum);
        }
        Self { umbrellas, pins }
    }

    /// Solves the normal equations by conjugate gradients, to about 12 digits.
    fn solve(&self) -> Vec<Point> {
        let mut positions: Vec<Point> = self.pins.iter().map(|pin| pin.at).collect();
        let springs = self.pins.iter().map(|pin| scale(pin.strength, pin.at));
        let mut residual: Vec<Vector> =
            springs.zip(self.apply(&positions)).map(|(a, b)| sub(a, b)).collect();
        let mut direction = residual.clone();
        let mut size = inner(&residual, &residual);
        let goal = 1e-26 * size;
        while size > goal {
            let image = self.apply(&direction);
            let step = size / inner(&direction, &image);
            for v in 0..positions.len() {
                add_scaled(&mut positions[v], step, direction[v]);
                add_scaled(&mut residual[v], -step, image[v]);
            }
            let previous = std::mem::replace(&mut size, inner(&residual, &residual));
            for (d, &r) in direction.iter_mut().zip(&residual) {
                *d = add(r, scale(size / previous, *d));
            }
        }
        positions
    }

    /// The matrix of the normal equations times `x`.
    fn apply(&self, x: &[Vector]) -> Vec<Vector> {
        let mut image: Vec<Vector> =
            x.iter().zip(self.pins).map(|(&p, pin)| scale(pin.strength, p)).collect();
        for (v, umbrella) in self.umbrellas.iter().enumerate() {
            let mut vector = scale(-1.0, x[v]);
            umbrella.iter().for_each(|&(w, weight)| add_scaled(&mut vector, weight, x[w]));
            add_scaled(&mut image[v], -1.0, vector);
            umbrella.iter().for_each(|&(w, weight)| add_scaled(&mut image[w], weight, vector));
        }
        image
    }
}

fn inner(a: &[Vector], b: &[Vector]) -> f64 {
    a.iter().zip(b).map(|(&a, &b)| dot(a, b)).sum()
}

/// Half the thickness of the shell, before it is made fair.
const THICKNESS: f64 = 0.22;

/// The strength of the springs that keep its shape then.
const STIFFNESS: f64 = 0.08;

/// Vertices and faces.
struct Cage {
    positions: Vec<Point>,
    faces: Vec<[usize; 4]>,
}

impl Cage {
    fn of_chair() -> Self {
        let sheet = Sheet::of_chair();
        let pins: Vec<Pin> = sheet.places.iter().map(|&place| pin(place)).collect();
        let middle = Fairing::new(&sheet.faces, &pins, |v| sheet.places[v].is_on_rim()).solve();
        let cage = Self::thicken(&sheet, &middle);
        let keep = |&at| Pin { at, strength: STIFFNESS };
        let pins: Vec<Pin> = cage.positions.iter().map(keep).collect();
        Self { positions: Fairing::new(&cage.faces, &pins, |_| false).solve(), ..cage }
    }

    /// Two copies of the sheet, one above and one below, joined along the rim.
    fn thicken(sheet: &Sheet, middle: &[Point]) -> Self {
        let normals = sheet.normals(middle);
        let offset = |v: usize, height| add(middle[v], scale(height, normals[v]));
        let is_inner = |v: &usize| !sheet.places[*v].is_on_rim();
        let count = middle.len();
        let mut positions: Vec<Point> =
            (0..count).map(|v| offset(v, if is_inner(&v) { THICKNESS } else { 0.0 })).collect();
        let mut below: Vec<usize> = (0..count).collect();
        for v in (0..count).filter(is_inner) {
            below[v] = positions.len();
            positions.push(offset(v, -THICKNESS));
        }
        let mut faces = sheet.faces.clone();
        faces.extend(sheet.faces.iter().map(|&[a, b, c, d]| [d, c, b, a].map(|v| below[v])));
        Self { positions, faces }
    }

    fn to_obj(&self) -> String {
        let mut text = HEADER.to_owned();
        for p in &self.positions {
            // Adding 0 turns -0 into 0.
            let [x, y, z] = p.map(|t| (t * 1e6).round() / 1e6 + 0.0);
            writeln!(text, "v {x} {y} {z}").expect("a string takes any text");
        }
        for face in &self.faces {
            let [a, b, c, d] = face.map(|v| v + 1);
            writeln!(text, "f {a} {b} {c} {d}").expect("a string takes any text");
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use evenlight::mesh::isolation::extraordinary_points;
    use evenlight::mesh::{BoundaryRule, Cage as CheckedCage, Mesh};

    use super::*;

    fn checked() -> CheckedCage {
        let Cage { positions, faces } = Cage::of_chair();
        CheckedCage::new(Mesh::new(positions, faces.iter().map(|f| f.map(|v| v as u32)))).unwrap()
    }

    #[test]
    fn it_is_one_closed_surface_with_one_hole() {
        let cage = checked();
        assert_eq!((cage.num_boundary_edges(), cage.num_components()), (0, 1));
        assert_eq!(cage.num_used_vertices() + cage.num_faces(), cage.num_edges());
    }

    #[test]
    fn extraordinary_vertices_of_valence_3_5_6_and_8_are_isolated() {
        let points = extraordinary_points(&checked(), BoundaryRule::default());
        let valences: BTreeSet<usize> = points.iter().map(|p| p.valence).collect();
        assert_eq!(valences, BTreeSet::from([3, 5, 6, 8]));
        assert!(points.iter().all(|p| p.level == 0));
    }

    #[test]
    fn right_and_left_are_mirror_images() {
        let places = |side: f64| -> BTreeSet<[i64; 3]> {
            let rounded = |[x, y, z]: Point| [side * x, y, z].map(|t| (t * 1e6).round() as i64);
            Cage::of_chair().positions.into_iter().map(rounded).collect()
        };
        assert_eq!(places(1.0), places(-1.0));
    }

    #[test]
    fn no_quad_is_folded() {
        let Cage { positions, faces } = Cage::of_chair();
        for face in faces {
            let p = face.map(|v| positions[v]);
            let normal = cross(sub(p[2], p[0]), sub(p[3], p[1]));
            for k in 0..4 {
                let sides = [sub(p[(k + 1) % 4], p[k]), sub(p[(k + 3) % 4], p[k])];
                assert!(dot(cross(sides[0], sides[1]), normal) > 0.0, "at {:?}", p[k]);
            }
        }
    }

    /// Where springs and umbrellas are in balance the gradient vanishes.
    #[test]
    fn fairing_finds_the_minimum() {
        let sheet = Sheet::of_chair();
        let pins: Vec<Pin> = sheet.places.iter().map(|&place| pin(place)).collect();
        let fairing = Fairing::new(&sheet.faces, &pins, |v| sheet.places[v].is_on_rim());
        let image = fairing.apply(&fairing.solve());
        for (a, pin) in image.iter().zip(&pins) {
            assert!(norm(sub(*a, scale(pin.strength, pin.at))) < 1e-10);
        }
    }

    #[test]
    fn the_file_is_up_to_date() {
        let file = fs::read_to_string(crate::workspace(FILE)).unwrap();
        assert!(file == Cage::of_chair().to_obj(), "run `cargo xtask demo-cage`");
    }
}
