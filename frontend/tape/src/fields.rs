//! Whether the fields of a record fit into it, by the lengths that they claim.
//!
//! The library reserves what a string claims, and slices an attachment before it looks at its length.

use mcap::records::op;

/// A field, as far as its length goes. Lists and maps claim their bytes, not their entries.
#[derive(Clone, Copy)]
enum Field {
    /// Numbers that take so many bytes together.
    Numbers(usize),
    /// Four bytes of length, and as many bytes: a string, a list, or the text of a schema.
    Short,
    /// Eight bytes of length, and as many bytes.
    Long,
    /// Four bytes of length, and in as many bytes strings: names, each before its value.
    Map,
}
use Field::{Long, Map, Numbers, Short};

/// The fields of a kind of record in their order, as the specification has them (<https://mcap.dev/spec>).
fn of_kind(opcode: u8) -> &'static [Field] {
    match opcode {
        op::HEADER => &[Short, Short],
        op::FOOTER => &[Numbers(20)],
        op::SCHEMA => &[Numbers(2), Short, Short, Short],
        op::CHANNEL => &[Numbers(4), Short, Short, Map],
        op::MESSAGE => &[Numbers(22)],
        op::CHUNK => &[Numbers(28), Short, Long],
        op::MESSAGE_INDEX => &[Numbers(2), Short],
        op::CHUNK_INDEX => &[Numbers(32), Short, Numbers(8), Short, Numbers(16)],
        op::ATTACHMENT => &[Numbers(16), Short, Short, Long, Numbers(4)],
        op::ATTACHMENT_INDEX => &[Numbers(40), Short, Short],
        op::STATISTICS => &[Numbers(42), Short],
        op::METADATA => &[Short, Map],
        op::METADATA_INDEX => &[Numbers(16), Short],
        op::SUMMARY_OFFSET => &[Numbers(17)],
        op::DATA_END => &[Numbers(4)],
        // Of a later version, or another program: the library takes it as it is.
        _ => &[],
    }
}

/// Checks that all fields of a record lie within its body; what follows them is for later versions.
///
/// # Errors
/// A field claims more bytes than are left.
pub fn check(opcode: u8, mut body: &[u8]) -> Result<(), String> {
    for field in of_kind(opcode) {
        match field {
            Numbers(bytes) => _ = taken(&mut body, *bytes as u64)?,
            Short => _ = short(&mut body)?,
            Long => {
                let length = number(taken(&mut body, 8)?);
                taken(&mut body, length)?;
            }
            Map => {
                let mut strings = short(&mut body)?;
                while !strings.is_empty() {
                    short(&mut strings)?;
                }
            }
        }
    }
    Ok(())
}

fn short<'a>(body: &mut &'a [u8]) -> Result<&'a [u8], String> {
    let length = number(taken(body, 4)?);
    taken(body, length)
}

/// The next bytes of a body.
fn taken<'a>(body: &mut &'a [u8], length: u64) -> Result<&'a [u8], String> {
    let split = usize::try_from(length).ok().and_then(|length| body.split_at_checked(length));
    let (field, rest) =
        split.ok_or_else(|| format!("a field claims {length} bytes, and {} are left", body.len()))?;
    *body = rest;
    Ok(field)
}

/// A number in little-endian order.
fn number(bytes: &[u8]) -> u64 {
    bytes.iter().rev().fold(0, |number, &byte| number << 8 | u64::from(byte))
}
