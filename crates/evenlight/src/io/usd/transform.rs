//! `xformOpOrder`: how the coordinates of a prim become those of its parent.
//!
//! USD multiplies rows of coordinates with matrices: `p' = p M`. The last operation in the order
//! is the first to be applied to a point.

use super::ReadError;
use super::attributes::{Attributes, Found};
use super::parse::{Prim, Value};
use crate::angle::{cosine, sine};
use crate::io::excerpt::excerpt;
use crate::point::Point;

/// An affine map: `p' = p linear + offset`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Affine {
    linear: [[f64; 3]; 3],
    offset: [f64; 3],
}

impl Affine {
    pub const IDENTITY: Self =
        Self { linear: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], offset: [0.0; 3] };

    /// The image of a point.
    pub fn apply(&self, p: Point) -> Point {
        let [x, y, z] = rows(p, self.linear);
        let [a, b, c] = self.offset;
        [x + a, y + b, z + c]
    }

    /// First `self`, then `next`.
    fn then(&self, next: &Self) -> Self {
        Self {
            linear: self.linear.map(|row| rows(row, next.linear)),
            offset: next.apply(self.offset),
        }
    }

    /// Negative if it mirrors, 0 if it flattens.
    pub fn determinant(&self) -> f64 {
        let [a, b, c] = self.linear;
        crate::point::dot(a, crate::point::cross(b, c))
    }

    fn inverse(&self) -> Option<Self> {
        use crate::point::cross;
        let determinant = self.determinant();
        if determinant == 0.0 || !determinant.is_finite() {
            return None;
        }
        let [a, b, c] = self.linear;
        let columns = [cross(b, c), cross(c, a), cross(a, b)];
        let linear = [0, 1, 2].map(|i| [0, 1, 2].map(|j| columns[j][i] / determinant));
        let offset = rows(self.offset, linear).map(|x| -x);
        Some(Self { linear, offset })
    }
}

/// `p` times the matrix with these rows.
fn rows(p: [f64; 3], linear: [[f64; 3]; 3]) -> [f64; 3] {
    [0, 1, 2].map(|j| p[0] * linear[0][j] + p[1] * linear[1][j] + p[2] * linear[2][j])
}

/// From the coordinates of the last prim of `chain` to those of the stage; `None` if they are the
/// same.
pub(super) fn to_stage(chain: &[&Prim]) -> Result<Option<Affine>, ReadError> {
    let mut total = None;
    for prim in chain {
        if let Some((local, resets)) = local(prim)? {
            let parent = total.filter(|_| !resets).unwrap_or(Affine::IDENTITY);
            total = Some(local.then(&parent));
        }
    }
    Ok(total)
}

/// From the coordinates of a prim to its parent's, and whether it goes to the stage's instead;
/// `None` if the prim has no operations.
fn local(prim: &Prim) -> Result<Option<(Affine, bool)>, ReadError> {
    let mut attributes = Attributes::new(prim);
    let Some(order) = attributes.find("xformOpOrder") else { return Ok(None) };
    let names = match &order.value {
        Value::Texts(names) => &names[..],
        Value::Numbers { values, .. } if values.is_empty() => &[],
        _ => return Err(super::attributes::fault(order, "must be a list of tokens")),
    };
    let resets = names.first().is_some_and(|name| name == "!resetXformStack!");
    let mut total = Affine::IDENTITY;
    for name in names[usize::from(resets)..].iter().rev() {
        let (is_inverse, name) = match name.strip_prefix("!invert!") {
            Some(name) => (true, name),
            None => (false, name.as_str()),
        };
        let missing = || {
            let what = format!("names `{}`, which is not there", excerpt(name.as_bytes()));
            super::attributes::fault(order, &what)
        };
        let operation = operation(name, &mut attributes)?.ok_or_else(missing)?;
        let inverse = || {
            let what = format!("inverts `{}`, which cannot be", excerpt(name.as_bytes()));
            operation.inverse().ok_or_else(|| super::attributes::fault(order, &what))
        };
        total = total.then(&if is_inverse { inverse()? } else { operation });
    }
    Ok(Some((total, resets)))
}

/// The operation of this name; `None` if it has no value.
fn operation(name: &str, attributes: &mut Attributes) -> Result<Option<Affine>, ReadError> {
    let kind = name.strip_prefix("xformOp:").and_then(|rest| rest.split(':').next()).unwrap_or("");
    let Some(attribute) = attributes.find(name) else { return Ok(None) };
    let unknown = || {
        let message = "is no operation that is known: apply it in the program that wrote it";
        super::attributes::fault(attribute, message)
    };
    let width = match kind {
        "translate" | "scale" => 3,
        "orient" => 4,
        "transform" => 16,
        _ => match axes(kind).ok_or_else(unknown)?.len() {
            1 => 1,
            _ => 3,
        },
    };
    let Some(found) = attributes.numbers(name, width)? else { return Ok(None) };
    if found.value.len() != width || !found.value.iter().all(|x| x.is_finite()) {
        return Err(found.fault("must be one finite value"));
    }
    let values = found.value;
    Ok(Some(match kind {
        "translate" => Affine { offset: [values[0], values[1], values[2]], ..Affine::IDENTITY },
        "scale" => scale(values),
        "orient" => orient(values),
        "transform" => transform(&found)?,
        _ => {
            let axes = axes(kind).unwrap_or_default();
            let turns = axes
                .iter()
                .map(|&axis| rotate(axis, if width == 1 { values[0] } else { values[axis] }));
            turns.fold(Affine::IDENTITY, |total, turn| total.then(&turn))
        }
    }))
}

/// The axes of `rotateX`, `rotateYXZ` ... in order.
fn axes(kind: &str) -> Option<Vec<usize>> {
    let letters = kind.strip_prefix("rotate")?;
    let axis = |c| "XYZ".find(c);
    let axes: Vec<usize> = letters.chars().map(axis).collect::<Option<_>>()?;
    let is_order = axes.len() == 3 && (0..3).all(|k| axes.contains(&k));
    (axes.len() == 1 || is_order).then_some(axes)
}

fn scale(values: &[f64]) -> Affine {
    let mut linear = [[0.0; 3]; 3];
    (0..3).for_each(|k| linear[k][k] = values[k]);
    Affine { linear, offset: [0.0; 3] }
}

/// A turn by so many degrees, counter-clockwise seen against the axis.
fn rotate(axis: usize, degrees: f64) -> Affine {
    let (c, s) = turn(degrees);
    let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
    let mut linear = Affine::IDENTITY.linear;
    (linear[i][i], linear[i][j], linear[j][i], linear[j][j]) = (c, s, -s, c);
    Affine { linear, offset: [0.0; 3] }
}

/// Cosine and sine of an angle in degrees; exact for quarter turns.
fn turn(degrees: f64) -> (f64, f64) {
    let degrees = degrees.rem_euclid(360.0);
    let quarters = (degrees / 90.0).floor();
    let radians = (degrees - 90.0 * quarters) * (std::f64::consts::PI / 180.0);
    let (c, s) = if radians == 0.0 { (1.0, 0.0) } else { (cosine(radians), sine(radians)) };
    match quarters as u8 {
        0 | 4 => (c, s),
        1 => (-s, c),
        2 => (-c, -s),
        _ => (s, -c),
    }
}

/// A turn by a unit quaternion, its real part first.
fn orient(q: &[f64]) -> Affine {
    let (w, x, y, z) = (q[0], q[1], q[2], q[3]);
    let linear = [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + z * w), 2.0 * (z * x - y * w)],
        [2.0 * (x * y - z * w), 1.0 - 2.0 * (z * z + x * x), 2.0 * (y * z + x * w)],
        [2.0 * (z * x + y * w), 2.0 * (y * z - x * w), 1.0 - 2.0 * (y * y + x * x)],
    ];
    Affine { linear, offset: [0.0; 3] }
}

fn transform(found: &Found<[f64]>) -> Result<Affine, ReadError> {
    let row = |k: usize| [0, 1, 2].map(|j| found.value[4 * k + j]);
    let last_column = [3, 7, 11, 15].map(|k| found.value[k]);
    if last_column != [0.0, 0.0, 0.0, 1.0] {
        return Err(found.fault("is not affine: its last column must be 0, 0, 0, 1"));
    }
    Ok(Affine { linear: [row(0), row(1), row(2)], offset: row(3) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quarter_turns_are_exact() {
        assert_eq!(rotate(2, 90.0).apply([1.0, 0.0, 5.0]), [0.0, 1.0, 5.0]);
        assert_eq!(rotate(0, -90.0).apply([0.0, 1.0, 0.0]), [0.0, 0.0, -1.0]);
        assert_eq!(rotate(1, 540.0).apply([1.0, 2.0, 3.0]), [-1.0, 2.0, -3.0]);
    }

    #[test]
    fn inverses_undo() {
        let maps = [
            scale(&[2.0, -3.0, 0.5]),
            rotate(1, 37.0),
            orient(&[0.5, 0.5, -0.5, 0.5]),
            Affine { offset: [1.0, 2.0, 3.0], ..Affine::IDENTITY },
        ];
        let total = maps.iter().fold(Affine::IDENTITY, |total, map| total.then(map));
        let p = [0.3, -1.0, 7.0];
        let back = total.then(&total.inverse().unwrap()).apply(p);
        assert!(p.iter().zip(back).all(|(a, b)| (a - b).abs() < 1e-14), "{back:?}");
        assert_eq!(scale(&[1.0, 0.0, 1.0]).inverse(), None);
    }
}
