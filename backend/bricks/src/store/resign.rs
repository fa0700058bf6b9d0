//! Correct checksums for a spoiled store of version 2, so that its numbers are trusted; the fuzz targets use it too.

// Offsets as the modules `format` and `entry` describe them; a test of hostile stores compares.
const HEADER_BYTES: usize = 192;
const VERSION_AT: usize = 8;
const HEADER_CHECKSUM_AT: usize = 12;
const NODES_AT: usize = 144;
const TABLE_AT: usize = 152;
const NAME_LENGTH_AT: usize = 160;
const LEVELS_AT: usize = 164;
const ENTRY_BYTES: usize = 64;
const LENGTHS_AT: usize = 20;
const OFFSET_AT: usize = 32;
const EXTENT_CHECKSUMS_AT: usize = 40;
const FIRST_CHILD_AT: usize = 48;
const CHILDREN_AT: usize = 56;
const ENTRY_CHECKSUM_AT: usize = 60;

/// What is put right.
#[derive(Clone, Copy, Debug)]
pub struct Repair {
    /// Count and place of the table fit the file.
    pub table: bool,
    /// Extents lie among the bricks, children in the table.
    pub places: bool,
    /// The checksums of the extents.
    pub extents: bool,
    /// The checksums of the entries.
    pub entries: bool,
    /// The checksum of the header.
    pub header: bool,
}

impl Repair {
    /// Everything.
    pub const ALL: Self = Self { table: true, places: true, extents: true, entries: true, header: true };
}

/// Puts right what `repair` says; bytes that are too few for a header, or of another version, stay as they are.
pub fn resign(bytes: &mut [u8], repair: Repair) {
    if bytes.len() < HEADER_BYTES || u32_at(bytes, VERSION_AT) != 2 {
        return;
    }
    let header = (HEADER_BYTES + 16 * (u32_at(bytes, LEVELS_AT) as usize).min(32))
        .saturating_add((u32_at(bytes, NAME_LENGTH_AT) as usize).min(4096))
        .next_multiple_of(64);
    if repair.table && bytes.len() >= header + ENTRY_BYTES {
        let most = ((bytes.len() - header) / ENTRY_BYTES) as u64;
        let nodes = u64_at(bytes, NODES_AT).clamp(1, most);
        let table = bytes.len() - nodes as usize * ENTRY_BYTES;
        put(bytes, NODES_AT, &nodes.to_le_bytes());
        put(bytes, TABLE_AT, &(table as u64).to_le_bytes());
    }
    let table = usize::try_from(u64_at(bytes, TABLE_AT)).unwrap_or(usize::MAX).min(bytes.len());
    let nodes = ((bytes.len() - table) / ENTRY_BYTES).min(u64_at(bytes, NODES_AT) as usize);
    for at in (0..nodes).map(|place| table + place * ENTRY_BYTES) {
        if repair.places {
            replace(bytes, at, header..table, nodes);
        }
        if repair.extents {
            sign_extent(bytes, at);
        }
        if repair.entries {
            let sum = crc32fast::hash(&bytes[at..at + ENTRY_CHECKSUM_AT]);
            put(bytes, at + ENTRY_CHECKSUM_AT, &sum.to_le_bytes());
        }
    }
    if repair.header && header <= bytes.len() {
        put(bytes, HEADER_CHECKSUM_AT, &[0; 4]);
        let sum = crc32fast::hash(&bytes[..header]);
        put(bytes, HEADER_CHECKSUM_AT, &sum.to_le_bytes());
    }
}

/// Folds the places that the entry at `at` names into what there is.
fn replace(bytes: &mut [u8], at: usize, bricks: std::ops::Range<usize>, nodes: usize) {
    let length: u64 = lengths(bytes, at).iter().sum();
    let room = (bricks.len() as u64).checked_sub(length);
    let offset = u64_at(bytes, at + OFFSET_AT);
    if let Some(room) = room.filter(|_| length > 0) {
        let start = bricks.start as u64;
        let folded = start + offset.wrapping_sub(start) % (room + 1);
        put(bytes, at + OFFSET_AT, &folded.to_le_bytes());
    }
    // An entry without children keeps its lie about where they are.
    if bytes[at + CHILDREN_AT] != 0 {
        let child = u64_at(bytes, at + FIRST_CHILD_AT) % nodes as u64;
        put(bytes, at + FIRST_CHILD_AT, &child.to_le_bytes());
    }
}

/// The checksums of the cells and of all that follows them, where they lie in the file.
fn sign_extent(bytes: &mut [u8], at: usize) {
    let [cells, codes, deviation] = lengths(bytes, at);
    let offset = u64_at(bytes, at + OFFSET_AT);
    let sum = |from: u64, length: u64| {
        let range = usize::try_from(from).ok()?..usize::try_from(from.checked_add(length)?).ok()?;
        Some(crc32fast::hash(bytes.get(range)?))
    };
    let sums = [sum(offset, cells), offset.checked_add(cells).and_then(|from| sum(from, codes + deviation))];
    for (i, sum) in sums.into_iter().enumerate() {
        if let Some(sum) = sum {
            put(bytes, at + EXTENT_CHECKSUMS_AT + 4 * i, &sum.to_le_bytes());
        }
    }
}

fn lengths(bytes: &[u8], at: usize) -> [u64; 3] {
    [0, 4, 8].map(|i| u64::from(u32_at(bytes, at + LENGTHS_AT + i)))
}

fn put(bytes: &mut [u8], at: usize, value: &[u8]) {
    bytes[at..at + value.len()].copy_from_slice(value);
}

fn u32_at(bytes: &[u8], at: usize) -> u32 {
    u32::from_le_bytes(std::array::from_fn(|i| bytes[at + i]))
}

fn u64_at(bytes: &[u8], at: usize) -> u64 {
    u64::from_le_bytes(std::array::from_fn(|i| bytes[at + i]))
}
