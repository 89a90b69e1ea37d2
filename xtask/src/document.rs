//! Tables in the documentation that a chore writes between two markers.

use std::error::Error;

/// Writes `new` between the markers of `cargo xtask CHORE` in `document`; or, to `check`, only
/// fails if a number there differs from the measured one in its third digit.
pub fn write_or_check(
    document: &str,
    chore: &str,
    new: &str,
    check: bool,
) -> Result<(), Box<dyn Error>> {
    let file = crate::workspace(document);
    let text = std::fs::read_to_string(&file)?;
    let [head, old, tail] =
        parts(&text, chore).ok_or(format!("{document} has lost its markers"))?;
    if !check {
        std::fs::write(&file, format!("{head}{new}{tail}"))?;
        println!("{document}: written");
        return Ok(());
    }
    compare(old, new).map_err(|difference| {
        format!("{document}: {difference}; run `cargo xtask {chore}` and look at what changed")
    })?;
    println!("{document}: all numbers agree");
    Ok(())
}

/// The text up to and with the first marker, between the markers, from the second on.
fn parts<'a>(text: &'a str, chore: &str) -> Option<[&'a str; 3]> {
    let start = format!("<!-- written by `cargo xtask {chore}` -->\n");
    let first = text.find(&start)? + start.len();
    let second = first + text[first..].find("<!-- end of what is written -->\n")?;
    Some([&text[..first], &text[first..second], &text[second..]])
}

/// Fails unless two texts have the same words, and numbers that agree to three digits.
fn compare(old: &str, new: &str) -> Result<(), String> {
    let words =
        |text: &str| -> Vec<String> { text.split_whitespace().map(str::to_owned).collect() };
    let (old, new) = (words(old), words(new));
    let agree = |(a, b): (&String, &String)| match (a.parse::<f64>(), b.parse::<f64>()) {
        (Ok(a), Ok(b)) => (a - b).abs() <= 0.005 * a.abs().max(b.abs()) + 0.001,
        _ => a == b,
    };
    match old.iter().zip(&new).find(|&pair| !agree(pair)) {
        Some((old, new)) => Err(format!("the tables say {old}, measured is {new}")),
        None if old.len() != new.len() => Err("the tables are others".to_owned()),
        None => Ok(()),
    }
}
