//! Colours: linear light, its coding in a file, and the colour map of curvature.
//!
//! All mixing (averages over a pixel, light on a material) is done on amounts of light; the
//! sRGB code, which is not proportional to light, appears only in the finished picture.

/// Amounts of red, green and blue light (linear sRGB), 1 being white.
pub(super) type Light = [f64; 3];

/// The light of an sRGB colour as it is written in files and style sheets.
pub(super) fn from_srgb(code: [u8; 3]) -> Light {
    code.map(|c| {
        let c = f64::from(c) / 255.0;
        if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
    })
}

/// The nearest sRGB colour; light below 0 or above 1 is cut off, NaN is black.
pub(super) fn to_srgb(light: Light) -> [u8; 3] {
    light.map(|x| {
        let x = x.clamp(0.0, 1.0);
        let code = if x <= 0.0031308 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 };
        (255.0 * code).round() as u8
    })
}

/// `(1 - t) a + t b`.
pub(super) fn mix(a: Light, b: Light, t: f64) -> Light {
    crate::point::lerp(a, b, t)
}

/// The colour of the value `t` in -1..1: blue below zero, white at zero, red above; values
/// beyond are shown like the ends, NaN in grey.
///
/// Lightness falls linearly from zero to both ends in the perceptual space Oklab, at constant
/// hue, so that equal steps look equal and equal amounts of either sign look equally strong.
pub(super) fn diverging(t: f64) -> Light {
    if t.is_nan() {
        return from_srgb([150, 150, 150]);
    }
    const BLUE: f64 = 261.0;
    const RED: f64 = 27.0;
    let (strength, hue) = (t.abs().min(1.0), if t < 0.0 { BLUE } else { RED });
    let lightness = 0.98 - 0.54 * strength;
    let chroma = 0.165 * strength * (2.0 - strength);
    from_oklch(lightness, chroma, hue)
}

/// The light of a colour given by Oklab lightness, chroma, and hue in degrees ([Ottosson20]).
fn from_oklch(lightness: f64, chroma: f64, hue: f64) -> Light {
    let (sin, cos) = hue.to_radians().sin_cos();
    let (a, b) = (chroma * cos, chroma * sin);
    let l = (lightness + 0.396_337_777_4 * a + 0.215_803_757_3 * b).powi(3);
    let m = (lightness - 0.105_561_345_8 * a - 0.063_854_172_8 * b).powi(3);
    let s = (lightness - 0.089_484_177_5 * a - 1.291_485_548_0 * b).powi(3);
    [
        4.076_741_662_1 * l - 3.307_711_591_3 * m + 0.230_969_929_2 * s,
        -1.268_438_004_6 * l + 2.609_757_401_1 * m - 0.341_319_396_5 * s,
        -0.004_196_086_3 * l - 0.703_418_614_7 * m + 1.707_614_701_0 * s,
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_code_survives_the_way_to_light_and_back() {
        for code in 0..=255 {
            assert_eq!(to_srgb(from_srgb([code; 3])), [code; 3]);
        }
    }

    #[test]
    fn the_mean_of_black_and_white_is_not_the_middle_code() {
        assert_eq!(to_srgb(mix([0.0; 3], [1.0; 3], 0.5)), [188; 3]);
    }

    #[test]
    fn zero_is_near_white_the_ends_are_blue_and_red() {
        let [r, g, b] = to_srgb(diverging(0.0));
        assert!(r.abs_diff(g) <= 1 && g.abs_diff(b) <= 1 && r > 245, "{r} {g} {b}");
        let [r, g, b] = to_srgb(diverging(-1.0));
        assert!(b > 130 && b > g && g > r, "blue is {r} {g} {b}");
        let [r, g, b] = to_srgb(diverging(1.0));
        assert!(r > 130 && r > 3 * g && r > 3 * b, "red is {r} {g} {b}");
    }

    #[test]
    fn values_out_of_range_look_like_the_ends() {
        assert_eq!(diverging(7.0), diverging(1.0));
        assert_eq!(diverging(f64::NEG_INFINITY), diverging(-1.0));
        assert_eq!(to_srgb(diverging(f64::NAN)), [150; 3]);
    }

    /// No colour is cut off, which would show as a kink in the bar.
    #[test]
    fn all_colours_can_be_shown() {
        for k in -100..=100 {
            let light = diverging(0.01 * f64::from(k));
            assert!(light.iter().all(|x| (0.0..=1.0).contains(x)), "{light:?} at {k} percent");
        }
    }

    /// Luminance falls on both sides of zero, alike up to what the colours allow.
    #[test]
    fn stronger_values_are_darker() {
        let luminance = |t: f64| {
            let [r, g, b] = diverging(t);
            0.2126 * r + 0.7152 * g + 0.0722 * b
        };
        for k in 0..20 {
            let (t, next) = (f64::from(k) / 20.0, f64::from(k + 1) / 20.0);
            assert!(luminance(next) < luminance(t) && luminance(-next) < luminance(-t));
            assert!((luminance(next) - luminance(-next)).abs() < 0.06);
        }
    }
}
