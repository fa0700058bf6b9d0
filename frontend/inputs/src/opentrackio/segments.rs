//! Samples that are longer than a datagram, put together.

use super::packet::{self, Encoding, Packet};
use super::sample;
use crate::Refusal;
use crate::reading::Parts;

/// A longer sample is a mistake, bytes: those of the examples have 2 to 4 thousand.
const LONGEST: usize = 1 << 16;

/// The parts of a sample that have arrived.
#[derive(Default)]
pub(crate) struct Segments {
    sample: Vec<u8>,
    /// What the next part has to be.
    next: Option<(Encoding, u16)>,
}

impl Segments {
    /// What a datagram says, if a sample ends with it.
    pub fn decode(&mut self, datagram: &[u8]) -> Result<Parts, Refusal> {
        let packet = packet::parse(datagram)?;
        if packet.is_last && packet.offset == 0 {
            self.next = None;
            return sample::parse(packet.encoding, packet.payload);
        }
        self.add(packet)?;
        if !packet.is_last {
            return Ok(Parts::new());
        }
        self.next = None;
        sample::parse(packet.encoding, &self.sample)
    }

    fn add(&mut self, packet: Packet<'_>) -> Result<(), Refusal> {
        let expected = self.next.take();
        if packet.offset == 0 {
            self.sample.clear();
        } else if expected != Some((packet.encoding, packet.sequence))
            || packet.offset as usize != self.sample.len()
        {
            return Err(Refusal::Gap);
        }
        if self.sample.len() + packet.payload.len() > LONGEST {
            return Err(Refusal::Long);
        }
        self.sample.extend(packet.payload);
        self.next = Some((packet.encoding, packet.sequence.wrapping_add(1)));
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::opentrackio::packet::tests::datagram;

    const SAMPLE: &[u8] =
        br#"{"transforms":[{"translation":{"x":1,"y":2,"z":3},"rotation":{"pan":0,"tilt":0,"roll":0}}]}"#;

    /// A sample in three datagrams; the counter wraps between them.
    fn three() -> [Vec<u8>; 3] {
        let part = |sequence, from: usize, to: usize, is_last| {
            datagram(1, sequence, from as u32, is_last, &SAMPLE[from..to])
        };
        [part(65_534, 0, 30, false), part(65_535, 30, 31, false), part(0, 31, SAMPLE.len(), true)]
    }

    #[test]
    fn parts_in_order_make_a_sample() {
        let mut segments = Segments::default();
        let sizes = three().map(|part| segments.decode(&part).unwrap().len());
        assert_eq!(sizes, [0, 0, 1]);
        assert_eq!(segments.decode(&datagram(1, 7, 0, true, SAMPLE)).unwrap().len(), 1);
    }

    #[test]
    fn a_lost_part_spoils_its_sample_alone() {
        let [a, b, c] = three();
        let mut segments = Segments::default();
        for (part, outcome) in
            [(&a, Ok(0)), (&c, Err(Refusal::Gap)), (&c, Err(Refusal::Gap)), (&b, Err(Refusal::Gap))]
        {
            assert_eq!(segments.decode(part).map(|parts| parts.len()), outcome);
        }
        let sizes = [&a, &a, &b, &c].map(|part| segments.decode(part).unwrap().len());
        assert_eq!(sizes, [0, 0, 0, 1]);
    }

    #[test]
    fn what_never_ends_is_refused() {
        let mut segments = Segments::default();
        let payload = vec![b' '; 30_000];
        let mut send = |part: u16| {
            segments.decode(&datagram(1, part, u32::from(part) * 30_000, false, &payload)).map(|_| ())
        };
        assert_eq!(
            [send(0), send(1), send(2), send(3)],
            [Ok(()), Ok(()), Err(Refusal::Long), Err(Refusal::Gap)]
        );
    }
}
