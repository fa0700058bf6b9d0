//! The transfer curve of a projector, as its key gives it.

use super::number::number;
use crate::ConfigError;
use crate::finish::{Response, Transfer};
use crate::parse::source::Source;
use toml::{Spanned, Value};

/// Curves of projectors, as messages ask for them.
const A_CURVE: &str = "\"srgb\", a gamma from 0.1 to 10, a list of [light, code] pairs, or a table with such a list for \
                       each of red, green and blue";
const A_GAMMA: &str = "a gamma from 0.1 to 10";
/// Lists of pairs, as messages ask for them.
const PAIRS: &str = "expected two or more pairs of light (0 or more) and code (a whole number from 0 to 255), both \
                     rising from pair to pair";

pub(super) fn transfer(source: &Source<'_>, value: &Spanned<Value>) -> Result<Transfer, ConfigError> {
    let wrong = |message: &str| source.wrong_value("transfer", value.span(), message);
    match value.get_ref() {
        Value::String(name) if name == "srgb" => Ok(Transfer::Srgb),
        Value::Array(pairs) => {
            let response = response(pairs).ok_or_else(|| wrong(PAIRS))?;
            Ok(Transfer::Measured(Box::new([response.clone(), response.clone(), response])))
        }
        Value::Table(channels) => {
            let channel = |name| {
                let pairs = channels.get(name).and_then(Value::as_array)?;
                response(pairs)
            };
            let three = [channel("red"), channel("green"), channel("blue")];
            match three {
                [Some(red), Some(green), Some(blue)] if channels.len() == 3 => {
                    Ok(Transfer::Measured(Box::new([red, green, blue])))
                }
                _ => Err(wrong(&format!("{PAIRS}, for each of red, green and blue"))),
            }
        }
        other => {
            let gamma = number(other).ok_or_else(|| wrong(&format!("expected {A_CURVE}")))?;
            match gamma {
                _ if (0.1..=10.0).contains(&gamma) => Ok(Transfer::Gamma(gamma)),
                _ if gamma.is_finite() => Err(source.out_of_range("transfer", value.span(), gamma, A_GAMMA)),
                _ => Err(ConfigError::NotFinite { place: source.place("transfer", value.span()) }),
            }
        }
    }
}

fn response(pairs: &[Value]) -> Option<Response> {
    let knot = |pair: &Value| {
        let [light, Value::Integer(code)] = pair.as_array()?.as_slice() else { return None };
        Some((number(light)?, u8::try_from(*code).ok()?))
    };
    Response::new(pairs.iter().map(knot).collect::<Option<_>>()?)
}
