//! A list of as many values as its key takes.

use serde::de::{Deserialize, Deserializer, Error, SeqAccess, Visitor};
use std::fmt;
use std::marker::PhantomData;

/// Exactly N values. Arrays by themselves leave what follows the last of N values unread, whatever it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ListOf<T, const N: usize>(pub [T; N]);

impl<'de, T: Deserialize<'de>, const N: usize> Deserialize<'de> for ListOf<T, N> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_seq(Whole(PhantomData))
    }
}

struct Whole<T, const N: usize>(PhantomData<T>);

impl<'de, T: Deserialize<'de>, const N: usize> Visitor<'de> for Whole<T, N> {
    type Value = ListOf<T, N>;

    fn expecting(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "a list of {N}")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Self::Value, A::Error> {
        let mut values = Vec::with_capacity(N);
        while let Some(value) = list.next_element()? {
            values.push(value);
        }
        let count = values.len();
        values.try_into().map(ListOf).map_err(|_| Error::invalid_length(count, &self))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    type Read<T, const N: usize> = Result<BTreeMap<String, ListOf<T, N>>, toml::de::Error>;

    #[test]
    fn as_many_as_there_must_be_are_read() {
        let read: Read<f64, 3> = toml::from_str("a = [1, 2.5, -3]");
        assert_eq!(read.unwrap()["a"], ListOf([1.0, 2.5, -3.0]));
        let read: Read<ListOf<u32, 2>, 1> = toml::from_str("a = [[1, 2]]");
        assert_eq!(read.unwrap()["a"].0[0].0, [1, 2]);
    }

    #[test]
    fn all_others_are_refused() {
        for (text, message) in [
            ("a = [1, 2]", "invalid length 2, expected a list of 3"),
            ("a = [1, 2, 3, 4]", "invalid length 4, expected a list of 3"),
            ("a = [1, 2, 3, nan]", "invalid length 4, expected a list of 3"),
            ("a = [1, 2, 3, 'x']", "invalid type: string \"x\", expected f64"),
            ("a = 1", "expected a list of 3"),
        ] {
            let read: Read<f64, 3> = toml::from_str(text);
            let error = read.unwrap_err().message().to_owned();
            assert!(error.contains(message), "{text}: {error}");
        }
    }
}
