//! Things that several tests of a program need and that take long to make: each is made by whoever asks first.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

/// Things of one kind by their keys, for a `static`. A key has to say everything that the thing depends on.
pub struct MadeOnce<V>(Mutex<BTreeMap<String, Place<V>>>);

/// Where a thing will lie; locked while it is made.
type Place<V> = Arc<Mutex<Option<Arc<V>>>>;

impl<V> MadeOnce<V> {
    /// Nothing yet.
    #[expect(clippy::new_without_default, reason = "a default is no constant, and a static needs one")]
    pub const fn new() -> Self {
        Self(Mutex::new(BTreeMap::new()))
    }

    /// The thing of this key. Others who ask for it meanwhile wait until it is made; where making it panics, they try
    /// again.
    pub fn get(&self, key: String, make: impl FnOnce() -> V) -> Arc<V> {
        let place = {
            let mut places = self.0.lock().unwrap_or_else(PoisonError::into_inner);
            Arc::clone(places.entry(key).or_default())
        };
        let mut thing = place.lock().unwrap_or_else(PoisonError::into_inner);
        Arc::clone(thing.get_or_insert_with(|| Arc::new(make())))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_key_is_made_once() {
        static SQUARES: MadeOnce<u32> = MadeOnce::new();
        let square = |n: u32, made: &mut u32| {
            *SQUARES.get(n.to_string(), || {
                *made += 1;
                n * n
            })
        };
        let mut made = 0;
        assert_eq!([3, 4, 3, 4].map(|n| square(n, &mut made)), [9, 16, 9, 16]);
        assert_eq!(made, 2);
    }
}
