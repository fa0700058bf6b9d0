//! Tests of conversations that are cut or garbled anywhere.

use super::*;
use crate::event::What;
use crate::outbox::Shared;
use std::sync::Arc;

fn described(kind: i32, number: i32, name: &str) -> Vec<u8> {
    let payload = [&(name.len() as u32 + 1).to_be_bytes()[..], name.as_bytes(), &[0]].concat();
    wire::write(&Message { time: Duration::ZERO, sender: number, kind, payload: &payload }, 0)
}

/// A device, its types, and one message of each.
fn conversation() -> Vec<u8> {
    let said =
        |kind, payload: &[u8]| wire::write(&Message { time: Duration::ZERO, sender: 1, kind, payload }, 0);
    let numbers = [0.5_f64, 1.0, 2.0, 0.0, 0.6, 0.0, 0.8].map(f64::to_be_bytes).concat();
    [
        described(wire::SENDER, 1, "Wand"),
        described(wire::TYPE, 4, "vrpn_Tracker Pos_Quat"),
        described(wire::TYPE, 5, "vrpn_Button Change"),
        said(4, &[&[0, 0, 0, 2, 0, 0, 0, 0], &numbers[..]].concat()),
        said(5, &[0, 0, 0, 7, 0, 0, 0, 1]),
    ]
    .concat()
}

/// What comes of parts of a conversation, one after the other.
fn events(parts: &[&[u8]]) -> Vec<What> {
    let shared = Arc::new(Shared::default());
    let (mut outbox, mut session) = (Outbox::new(Arc::clone(&shared)), Session::new("Wand"));
    let mut pending = Vec::new();
    for part in parts {
        pending.extend(*part);
        let Ok(heard) = hear(&mut session, &pending, &mut outbox) else { break };
        pending.drain(..heard.taken);
    }
    shared.lock().queue.take().into_iter().map(|event| event.what).collect()
}

#[test]
fn wherever_a_conversation_is_cut_it_goes_on_there() {
    let bytes = conversation();
    let whole = events(&[&bytes]);
    assert_eq!(whole.len(), 2);
    for at in 0..=bytes.len() {
        assert_eq!(events(&[&bytes[..at], &bytes[at..]]), whole, "cut at {at}");
        assert!(whole.starts_with(&events(&[&bytes[..at]])), "ends at {at}");
    }
    assert_eq!(events(&bytes.iter().map(std::slice::from_ref).collect::<Vec<_>>()), whole, "byte by byte");
}

#[test]
fn wherever_a_conversation_is_garbled_nothing_breaks() {
    let bytes = conversation();
    let whole = events(&[&bytes]);
    let mut differ = 0;
    for at in 0..bytes.len() {
        for mask in [1, 0x80, 0xff] {
            let mut garbled = bytes.clone();
            garbled[at] ^= mask;
            let events = events(&[&garbled]);
            assert!(events.len() <= 2);
            differ += usize::from(events != whole);
        }
    }
    assert!(differ > bytes.len(), "the canary: garbling shows");
}

#[test]
fn a_message_that_does_not_become_whole_is_refused_and_swallows_nothing_more() {
    let began = Instant::now();
    let at = |ms| began + Duration::from_millis(ms);
    let (mut outbox, mut session) = (Outbox::new(Arc::default()), Session::new("Wand"));
    let mut pending = Pending::new(began);
    let mut hear = |bytes: &[u8], ms| pending.hear(bytes, at(ms), &mut session, &mut outbox);
    let bytes = conversation();
    assert_eq!(hear(&bytes, 0), Ok(false));
    assert_eq!(hear(&[], 60_000), Ok(false), "silence between messages is none");
    assert_eq!(hear(&bytes[..30], 60_000), Ok(false));
    assert_eq!(hear(&bytes[30..], 60_900), Ok(false), "as slow as it may be");
    let mut garbled = bytes.clone();
    garbled[2] = 0xf0;
    for ms in (61_000..=62_000).step_by(100) {
        assert_eq!(hear(&garbled, ms), Ok(false), "it may still come, {ms}");
    }
    assert_eq!(hear(&garbled, 62_001), Err(Refusal::Short));
}
