//! Control nets that tests make themselves, exact to rounding (files have nine digits).

use evenlight::Point;
use evenlight::net::CNet;

/// The characteristic c-net of Catmull-Clark subdivision at valence `n`, in the plane z = 0: its
/// eigennet for the subdominant eigenvalue, with line 0 along x and largest distance 1.
pub fn characteristic_cnet(n: usize) -> CNet {
    let mut net = circle(n);
    for _ in 0..400 {
        net = to_unit_size(&turned(&refined(&net)));
    }
    net
}

/// A net of the right symmetry to begin with.
fn circle(n: usize) -> CNet {
    let sector = |s: usize| {
        [(0, 1), (0, 2), (1, 1), (1, 2), (2, 1), (2, 2)].map(|(a, b)| {
            let (along, at) = (direction(n, s + n - 1), direction(n, s));
            [0, 1, 2].map(|d| f64::from(a) * along[d] + f64::from(b) * at[d])
        })
    };
    CNet { center: [0.0; 3], sectors: (0..n).map(sector).collect() }
}

/// The direction of line `s`.
fn direction(n: usize, s: usize) -> Point {
    let angle = std::f64::consts::TAU * s as f64 / n as f64;
    [angle.cos(), angle.sin(), 0.0]
}

/// One step of regular refinement, e staying at the origin: what Catmull-Clark subdivision does
/// to a net that turns into itself.
fn refined(net: &CNet) -> CNet {
    let mask = |k: isize| {
        if k % 2 == 0 {
            vec![(k / 2 - 1, 0.125), (k / 2, 0.75), (k / 2 + 1, 0.125)]
        } else {
            vec![(k / 2, 0.5), (k / 2 + 1, 0.5)]
        }
    };
    let new_node = |s: usize, a: isize, b: isize| {
        let mut sum = [0.0; 3];
        for (i, wi) in mask(a) {
            for (j, wj) in mask(b) {
                let p = node(net, s as isize, i, j);
                (0..3).for_each(|d| sum[d] += wi * wj * p[d]);
            }
        }
        sum
    };
    let names = [(0, 1), (0, 2), (1, 1), (1, 2), (2, 1), (2, 2)];
    let sectors = (0..net.valence()).map(|s| names.map(|(a, b)| new_node(s, a, b)));
    CNet { center: net.center, sectors: sectors.collect() }
}

/// The net whose sectors are sector 0 turned: rounding would bring in other Fourier modes.
fn turned(net: &CNet) -> CNet {
    let n = net.valence();
    let image = |s: usize| {
        let [c, d, _] = direction(n, s);
        net.sectors[0].map(|[x, y, _]| [c * x - d * y, d * x + c * y, 0.0])
    };
    CNet { center: [0.0; 3], sectors: (0..n).map(image).collect() }
}

/// The node `a` steps along line s-1 and `b` along line s.
pub fn node(net: &CNet, s: isize, a: isize, b: isize) -> Point {
    match (a, b) {
        (0, 0) => net.center,
        (a, b) if a < 0 => node(net, s + 1, b, -a),
        (a, b) if b < 0 => node(net, s - 1, -b, a),
        (a, 0) => node(net, s - 1, 0, a),
        (a, b) => {
            let sector = s.rem_euclid(net.valence() as isize) as usize;
            net.sectors[sector][(2 * a + b - 1) as usize]
        }
    }
}

fn to_unit_size(net: &CNet) -> CNet {
    let length = |p: &Point| (p[0] * p[0] + p[1] * p[1]).sqrt();
    let largest = net.sectors.iter().flatten().map(length).fold(0.0, f64::max);
    net_of(net, |p| p.map(|x| x / largest))
}

/// The net with every node mapped.
pub fn net_of(net: &CNet, map: impl Fn(Point) -> Point) -> CNet {
    CNet { center: map(net.center), sectors: net.sectors.iter().map(|s| s.map(&map)).collect() }
}
