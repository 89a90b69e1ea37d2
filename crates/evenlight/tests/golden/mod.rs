//! Files of `data/golden/guided`: what an independent program computed of guided subdivision.

use evenlight::Point;
use evenlight::net::CNet;
use serde_json::Value;

/// The file of valence `n`.
pub fn guided(n: usize) -> Value {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../data/golden/guided");
    let file = std::fs::read_to_string(format!("{folder}/n{n:02}.json"))
        .expect("a file of the repository");
    serde_json::from_str(&file).expect("it is JSON")
}

/// Three numbers.
pub fn point(value: &Value) -> Point {
    [0, 1, 2].map(|k| value[k].as_f64().expect("three numbers"))
}

/// The c-net; nodes (1,0) (2,0) (1,1) (2,1) (1,2) (2,2) of each sector, then e.
pub fn cnet(golden: &Value, n: usize) -> CNet {
    let nodes = golden["cnet"].as_array().expect("a list of nodes");
    let mut sectors = vec![[[0.0; 3]; 6]; n];
    for (s, k) in (0..n).flat_map(|s| (0..6).map(move |k| (s, k))) {
        let (a, b) = [(1, 0), (2, 0), (1, 1), (2, 1), (1, 2), (2, 2)][k];
        // Nodes on a line belong to the sector before.
        let (sector, node) = if b == 0 { ((s + n - 1) % n, a - 1) } else { (s, 2 * a + b - 1) };
        sectors[sector][node] = point(&nodes[6 * s + k]);
    }
    CNet { center: point(&nodes[6 * n]), sectors }
}
