//! A number as people type it: a sum like `2*5` or `1/4`, with a comma or a point, with a unit.

/// A unit that may follow a number, and its size in the field's own unit.
pub type Unit = (&'static str, f64);

/// Lengths in metres, the unit of glTF.
pub const LENGTHS: &[Unit] = &[("mm", 1e-3), ("cm", 1e-2), ("m", 1.0), ("in", 0.0254), ("ft", 0.3048)];

/// Angles in degrees.
pub const DEGREES: &[Unit] = &[("°", 1.0), ("deg", 1.0), ("rad", 180.0 / std::f64::consts::PI)];

/// Reads a typed number.
///
/// # Errors
///
/// A sentence if the text is no finite number, or has a unit that is not one of `units`.
pub fn parse(text: &str, units: &[Unit]) -> Result<f64, String> {
    let refused = || {
        let example = units.first().map_or(String::new(), |(unit, _)| format!(" or 5 {unit}"));
        let text = text.trim();
        format!("\u{201c}{text}\u{201d} is not a number: type one like 1.5, 2*5, 1/4{example}.")
    };
    let plain: String = text.chars().filter(|character| !character.is_whitespace()).collect();
    // The minus sign of typesetters.
    let plain = plain.replace('\u{2212}', "-");
    let with_unit = |&(unit, size): &Unit| {
        let number = plain.strip_suffix(unit)?;
        number
            .ends_with(|last: char| last.is_ascii_digit() || last == ')' || last == '.')
            .then_some((number, size))
    };
    let (sum, size) = units.iter().find_map(with_unit).unwrap_or((&plain, 1.0));
    // One comma is a decimal comma; several, or one beside a point, could also part thousands.
    let sum = match (sum.matches(',').count(), sum.contains('.')) {
        (0, _) => sum.to_owned(),
        (1, false) => sum.replace(',', "."),
        _ => return Err(refused()),
    };
    // Sums have no powers of ten with an e.
    let number = sum.parse().or_else(|_| exmex::eval_str::<f64>(&sum));
    let number = number.map_err(|_| refused())? * size;
    if number.is_finite() { Ok(number) } else { Err(refused()) }
}

#[cfg(test)]
mod tests {
    use super::{DEGREES, LENGTHS, parse};

    #[test]
    fn sums_commas_and_units_are_read() {
        for (text, number) in [
            ("2*5", 10.0),
            ("1/4", 0.25),
            ("0,5", 0.5),
            ("-5 cm", -0.05),
            ("\u{2212}3", -3.0),
            ("(1 + 2) * 3", 9.0),
            ("2^3", 8.0),
            (".5", 0.5),
            ("1e-3", 1e-3),
            ("1.5e+3", 1500.0),
            ("2 m", 2.0),
            ("10/4 in", 0.0635),
            ("-0.25", -0.25),
        ] {
            let read = parse(text, LENGTHS);
            let near = |read: f64| (read - number).abs() <= 1e-12 * number.abs();
            assert!(read.as_ref().is_ok_and(|read| near(*read)), "{text}: {read:?}");
        }
        assert_eq!(parse("90°", DEGREES), Ok(90.0));
        assert_eq!(parse("30 px", &[("px", 1.0)]), Ok(30.0));
    }

    #[test]
    fn anything_else_is_refused_with_the_remedy() {
        for text in [
            "", "abc", "5 apples", "1/0", "1,2,3", "1.234,5", "2**", "5 cm", "x", "cm", "1 2 +",
        ] {
            let refused = parse(text, DEGREES);
            assert!(
                refused.as_ref().is_err_and(|why| why.contains("type one like")),
                "{text}: {refused:?}"
            );
        }
    }
}
