//! Numbers among values of any type.

use toml::Value;

/// What is a number in TOML, whole or not.
pub(super) fn number(value: &Value) -> Option<f64> {
    match value {
        Value::Float(number) => Some(*number),
        Value::Integer(number) => Some(*number as f64),
        _ => None,
    }
}
