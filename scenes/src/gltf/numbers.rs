//! Whole numbers that a file writes as decimals: `3.0`, `3e0` and `30e-1` all stand for 3 (glTF 2.0, section 2.7, point 5).
//!
//! JSON readers in Rust accept only `3` where an integer is due. The text is rewritten before it is parsed, so that the rule holds
//! everywhere: in the format itself, in extensions and in extras.

use std::borrow::Cow;

/// Rewrites each whole number of the JSON text as an integer. Spaces fill the freed bytes, so line and column of a later error stay as
/// they are, except after numbers such as `1e5`, which grow. Negative numbers stay: no integer of glTF is negative, and `-0.0` is not
/// `0`.
pub(super) fn whole(json: &[u8]) -> Cow<'_, [u8]> {
    let mut rewritten = Vec::new();
    let mut copied = 0;
    let mut at = 0;
    while at < json.len() {
        match json[at] {
            b'"' => at = after_string(json, at),
            b'0'..=b'9' | b'-' => {
                let end = at + json[at..].iter().take_while(|byte| is_part(**byte)).count();
                if let Some(number) = integer(&json[at..end]) {
                    let digits = number.to_string();
                    rewritten.extend_from_slice(&json[copied..at]);
                    rewritten.extend_from_slice(digits.as_bytes());
                    rewritten.extend(std::iter::repeat_n(b' ', (end - at).saturating_sub(digits.len())));
                    copied = end;
                }
                at = end;
            }
            _ => at += 1,
        }
    }
    if copied == 0 {
        return Cow::Borrowed(json);
    }
    rewritten.extend_from_slice(&json[copied..]);
    Cow::Owned(rewritten)
}

/// Returns the offset behind a string that starts at `at`, or the end of the text if the string is not closed.
fn after_string(json: &[u8], at: usize) -> usize {
    let mut at = at + 1;
    while at < json.len() {
        match json[at] {
            b'"' => return at + 1,
            b'\\' => at += 2,
            _ => at += 1,
        }
    }
    json.len()
}

fn is_part(byte: u8) -> bool {
    byte.is_ascii_digit() || b"+-.eE".contains(&byte)
}

/// Returns the value of a number with a fraction or an exponent, if it is whole and fits 64 bits. None for plain integers, which need
/// no rewriting, and for text that is no JSON number.
fn integer(number: &[u8]) -> Option<u64> {
    let text = std::str::from_utf8(number).ok()?;
    let (mantissa, exponent) = match text.split_once(['e', 'E']) {
        Some((mantissa, exponent)) => (mantissa, exponent.strip_prefix('+').unwrap_or(exponent)),
        None => (text, "0"),
    };
    let (before, fraction) = match mantissa.split_once('.') {
        Some((before, fraction)) if !fraction.is_empty() => (before, fraction),
        Some(_) => return None,
        None if mantissa.len() == text.len() => return None,
        None => (mantissa, ""),
    };
    let digits_only = |text: &str| text.bytes().all(|byte| byte.is_ascii_digit());
    let leading_zero = before.len() > 1 && before.starts_with('0');
    if before.is_empty() || leading_zero || !digits_only(before) || !digits_only(fraction) {
        return None;
    }
    let exponent: i64 = exponent.parse().ok()?;
    let digits = [before, fraction].concat();
    // The digits before the decimal point, once the exponent has moved it.
    let point = i64::try_from(before.len()).ok()?.checked_add(exponent)?;
    let significant = digits.trim_end_matches('0');
    if significant.is_empty() {
        return Some(0);
    }
    // 20 digits hold every number of 64 bits.
    let point =
        usize::try_from(point).ok().filter(|point| significant.len() <= *point && *point <= before.len() + 20)?;
    let zeros = "0".repeat(point - significant.len());
    [significant, &zeros].concat().parse().ok()
}

#[cfg(test)]
mod tests {
    use super::{integer, whole};

    #[test]
    fn only_whole_numbers_are_integers() {
        for (text, number) in
            [("3.0", 3), ("3e0", 3), ("30e-1", 3), ("0.3E+1", 3), ("1e2", 100), ("0.0", 0), ("0e99", 0)]
        {
            assert_eq!(integer(text.as_bytes()), Some(number), "{text}");
        }
        let largest = "18446744073709551615.0";
        assert_eq!(integer(largest.as_bytes()), Some(u64::MAX));
        for text in [
            "3",
            "3.5",
            "3.",
            "03.0",
            ".5e1",
            "-3.0",
            "-0.0",
            "3e",
            "3e-1",
            "1e20",
            "3e999999999999999999999",
            "1e4000000000",
            "3.0000000000000000000001",
            "18446744073709551616.0",
            "1.0.0",
            "1e1e1",
            "5e-324",
        ] {
            assert_eq!(integer(text.as_bytes()), None, "{text}");
        }
    }

    #[test]
    fn strings_and_places_stay() {
        let json = br#"{"a 1.0 \" 2.0":3.0,"b":[1.50,4e0,"5.0"],"c":-6.0}"#;
        let expected = br#"{"a 1.0 \" 2.0":3  ,"b":[1.50,4  ,"5.0"],"c":-6.0}"#;
        assert_eq!(whole(json), &expected[..]);
        assert!(matches!(whole(b"[1, 2.5, \"3.0"), std::borrow::Cow::Borrowed(_)));
    }
}
