//! Files of quadratics: JSON, every fault with its place and what to do.

use evenlight::mesh::isolation::Place;
use evenlight::{FaceId, Point, Vector, VertexId};
use serde::Deserialize;
use serde::de::IgnoredAny;
use serde_json::Value;
use serde_json::value::RawValue;

/// What a file says of one point.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// The point.
    pub place: Place,
    /// Its new quadratic.
    pub change: Change,
}

/// How a quadratic is given.
#[derive(Clone, Debug, PartialEq)]
pub enum Change {
    /// The image of the default one under x -> p + M (x - p) + t about its centre p.
    Affine {
        /// The rows of M.
        matrix: [Vector; 3],
        /// The vector t.
        translation: Vector,
    },
    /// By its six points in sector 0.
    Coefficients([Point; 6]),
    /// By six points in each sector, of which the mean is taken.
    Sectors(Vec<[Point; 6]>),
}

/// Reads the entries of a file.
///
/// # Errors
///
/// The first thing that cannot be understood, with its line or entry (numbered from 1).
pub fn parse(text: &str) -> Result<Vec<Entry>, String> {
    let text = text.trim_start_matches('\u{feff}');
    let entries = list(text).map_err(|error| {
        format!("this is no list of quadratics, nor {{\"points\": [...]}} with one: {error}")
    })?;
    let parsed = entries.iter().zip(1..).map(|(raw, number)| {
        let entry = parse_entry(raw.get());
        entry.map_err(|fault| format!("entry {number}: {fault}"))
    });
    parsed.collect()
}

fn list(text: &str) -> Result<Vec<&RawValue>, serde_json::Error> {
    #[derive(Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Points<'a> {
        #[serde(borrow)]
        points: Vec<&'a RawValue>,
    }
    if text.trim_start().starts_with('{') {
        serde_json::from_str(text).map(|Points { points }| points)
    } else {
        serde_json::from_str(text)
    }
}

/// The keys of an entry. What `evenlight q` prints beside the points is passed over.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Keys {
    vertex: Option<Value>,
    face: Option<Value>,
    affine: Option<Value>,
    coefficients: Option<Value>,
    sectors: Option<Value>,
    #[serde(rename = "valence")]
    _valence: Option<IgnoredAny>,
    #[serde(rename = "center")]
    _center: Option<IgnoredAny>,
    #[serde(rename = "normal")]
    _normal: Option<IgnoredAny>,
    #[serde(rename = "principal_curvatures")]
    _principal_curvatures: Option<IgnoredAny>,
}

/// The keys of an affine map.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct AffineKeys {
    matrix: Option<Value>,
    translation: Option<Value>,
}

fn parse_entry(text: &str) -> Result<Entry, String> {
    if !text.starts_with('{') {
        return Err(format!("{} is no object {{\"vertex\": ..., ...}}", shown(text)));
    }
    let keys: Keys = serde_json::from_str(text).map_err(|error| without_place(&error))?;
    let place = match (&keys.vertex, &keys.face) {
        (Some(v), None) => Place::Vertex(VertexId(id(v, "vertex")?)),
        (None, Some(f)) => Place::FaceCentre(FaceId(id(f, "face")?)),
        _ => return Err("give either vertex or face, the number of the point from 0".to_owned()),
    };
    let change = match (&keys.affine, &keys.coefficients, &keys.sectors) {
        (Some(map), None, None) => affine(map)?,
        (None, Some(q), None) => Change::Coefficients(six_points(q, "coefficients")?),
        (None, None, Some(lists)) => Change::Sectors(items(lists, "sectors", six_points)?),
        _ => return Err("give one of affine, coefficients and sectors".to_owned()),
    };
    Ok(Entry { place, change })
}

fn affine(value: &Value) -> Result<Change, String> {
    if !value.is_object() {
        return Err("affine is an object with matrix, translation or both".to_owned());
    }
    let keys = AffineKeys::deserialize(value).map_err(|error| format!("affine: {error}"))?;
    let matrix = match &keys.matrix {
        Some(rows) => array(rows, "affine.matrix", "rows", triple)?,
        None => [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
    };
    let translation = match &keys.translation {
        Some(t) => triple(t, "affine.translation")?,
        None => [0.0; 3],
    };
    Ok(Change::Affine { matrix, translation })
}

fn six_points(value: &Value, path: &str) -> Result<[Point; 6], String> {
    array(value, path, "points, q_1 to q_6", triple)
}

fn triple(value: &Value, path: &str) -> Result<Point, String> {
    array(value, path, "numbers", number)
}

/// A list of exactly `N` things.
fn array<T, const N: usize>(
    value: &Value,
    path: &str,
    what: &str,
    item: fn(&Value, &str) -> Result<T, String>,
) -> Result<[T; N], String> {
    let found = items(value, path, item)?;
    let count = found.len();
    found.try_into().map_err(|_| format!("{path} has {count} items; it needs {N} {what}"))
}

fn items<T>(
    value: &Value,
    path: &str,
    item: fn(&Value, &str) -> Result<T, String>,
) -> Result<Vec<T>, String> {
    let values = value.as_array().ok_or_else(|| format!("{path} is {}, no list", json(value)))?;
    values.iter().enumerate().map(|(k, value)| item(value, &format!("{path}[{k}]"))).collect()
}

fn number(value: &Value, path: &str) -> Result<f64, String> {
    value.as_f64().ok_or_else(|| format!("{path} is {}, no finite number", json(value)))
}

fn id(value: &Value, path: &str) -> Result<u32, String> {
    let id = value.as_u64().and_then(|id| u32::try_from(id).ok());
    id.ok_or_else(|| format!("{path} is {}, no number counted from 0", json(value)))
}

fn json(value: &Value) -> String {
    shown(&value.to_string())
}

/// The beginning of `text`, for a message.
fn shown(text: &str) -> String {
    const LENGTH: usize = 40;
    let beginning: String = text.chars().take(LENGTH).collect();
    if beginning.len() < text.len() { beginning + " ..." } else { beginning }
}

/// The message without line and column, which would be counted from the entry's beginning.
fn without_place(error: &serde_json::Error) -> String {
    let text = error.to_string();
    text.rsplit_once(" at line ").map_or(text.clone(), |(message, _)| message.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIX: &str = "[[1,2,3],[0,0,0],[0,0,0],[0,0,0],[0,0,0],[0,0,-1.5e-3]]";

    fn six() -> [Point; 6] {
        let mut points = [[0.0; 3]; 6];
        points[0] = [1.0, 2.0, 3.0];
        points[5][2] = -1.5e-3;
        points
    }

    #[test]
    fn lists_are_read_bare_or_as_points() {
        let bare = format!("[{{\"vertex\": 7, \"coefficients\": {SIX}}}]");
        let entry =
            Entry { place: Place::Vertex(VertexId(7)), change: Change::Coefficients(six()) };
        assert_eq!(parse(&bare), Ok(vec![entry]));
        assert_eq!(parse(&bare), parse(&format!("\u{feff} {{\"points\": {bare}}}\n")));
        assert_eq!(parse("[]"), Ok(Vec::new()));
    }

    #[test]
    fn an_affine_map_is_the_identity_where_it_says_nothing() {
        let read = |text: &str| parse(&format!("[{{\"face\": 0, \"affine\": {text}}}]")).unwrap();
        let identity = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let expected = |matrix, translation| {
            let place = Place::FaceCentre(FaceId(0));
            vec![Entry { place, change: Change::Affine { matrix, translation } }]
        };
        assert_eq!(read("{}"), expected(identity, [0.0; 3]));
        assert_eq!(read("{\"translation\": [1,2,3]}"), expected(identity, [1.0, 2.0, 3.0]));
        let turned = [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]];
        let read = read("{\"matrix\": [[0,-1,0],[1,0,0],[0,0,1]]}");
        assert_eq!(read, expected(turned, [0.0; 3]));
    }

    #[test]
    fn damaged_files_are_refused_with_a_message_or_read() {
        let good = format!(
            "[{{\"vertex\": 7, \"coefficients\": {SIX}}}, {{\"face\": 1, \"affine\": \
             {{\"translation\": [1,2,3]}}}}, {{\"vertex\": 2, \"sectors\": [{SIX}, {SIX}]}}]"
        );
        assert_eq!(parse(&good).map(|entries| entries.len()), Ok(3));
        let mut random = 1_u32;
        let mut next = |below: usize| {
            random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (random >> 8) as usize % below
        };
        let mut refused = 0;
        for _ in 0..2000 {
            let (at, length) = (next(good.len()), next(12));
            let end = (at + length).min(good.len());
            let filler =
                ["", "1", "-", "[", "}", "\"", "null", "{}", "vertex", ",", "9e99"][next(11)];
            let damaged = format!("{}{filler}{}", &good[..at], &good[end..]);
            if let Err(message) = parse(&damaged) {
                let is_placed = message.starts_with("entry ") != message.contains(" at line ");
                assert!(is_placed, "{damaged}: {message}");
                refused += 1;
            }
        }
        assert!(refused > 1000);
    }

    #[test]
    fn numbers_are_read_as_the_nearest_of_64_bits() {
        for x in [0.1_f64 + 0.2, 1.0 / 3.0, 5e-324, 1.7976931348623157e308, -9.007199254740993e15] {
            let q = SIX.replace("-1.5e-3", &format!("{x:e}"));
            let entries = parse(&format!("[{{\"vertex\": 0, \"coefficients\": {q}}}]")).unwrap();
            let Change::Coefficients(found) = entries[0].change else { panic!("{entries:?}") };
            assert_eq!(found[5][2].to_bits(), x.to_bits());
        }
    }
}
