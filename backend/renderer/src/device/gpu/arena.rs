//! Pictures of many views in one buffer, so that one dispatch casts tiles of all of them: a GPU does not wait for the longest
//! rays of each view before it begins with the next.

use super::context::Context;
use super::kernels::Kernel;
use super::pass::{in_rows, note_pass};
use super::storage::{Storage, Stretch, entries_of};
use layout::{TALLIED_TILES, TileTally, ViewBlock, binding};

/// Pictures begin at whole multiples of so many pixels: of 256 bytes of colours, as parts of buffers that are bound have to.
const APART: u64 = 16;
/// Bytes of a pixel's colour.
pub(super) const COLOUR_BYTES: u64 = 16;
/// Bytes of a pixel's count.
const COUNT_BYTES: u64 = 4;

/// A buffer of pictures, and what a dispatch casts of them.
#[derive(Debug)]
pub(super) struct Arena {
    pub(super) pixels: Storage,
    pub(super) counts: Storage,
    /// A [`ViewBlock`] for each view of a dispatch.
    pub(super) views: Storage,
    /// What a dispatch casts: see [`binding::LISTED`].
    pub(super) listed: Storage,
    tallies: Storage,
}

/// Where a picture lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Room {
    /// Index of the arena.
    pub(super) arena: usize,
    /// Its first pixel.
    pub(super) first: u64,
    /// Pixels that there is room for.
    pub(super) pixels: u64,
}

impl Arena {
    pub(super) fn new(context: &Context) -> Self {
        let storage = |label| Storage::new(context, label);
        Self {
            pixels: storage("pixels"),
            counts: storage("sample counts"),
            views: storage("views"),
            listed: storage("what is cast"),
            tallies: storage("sample counts of tiles"),
        }
    }

    /// Writes what the next dispatch casts: numbers of it, then the items of a list, of these views.
    pub(super) fn list(
        &mut self,
        context: &Context,
        views: &[ViewBlock],
        numbers: &[u32],
        items: &[[u32; 3]],
    ) {
        self.views.write(context, views);
        let words: Vec<u32> = numbers.iter().chain(items.as_flattened()).copied().collect();
        self.listed.write(context, &words);
    }

    /// Makes room for so many pixels; those that are there stay.
    pub(super) fn grow(&mut self, context: &Context, pixels: u64) {
        self.pixels.grow(context, COLOUR_BYTES * pixels);
        self.counts.grow(context, COUNT_BYTES * pixels);
    }

    /// The colours of a picture of so many pixels.
    pub(super) fn colours(&self, room: &Room, pixels: u64) -> Stretch<'_> {
        self.pixels.stretch(COLOUR_BYTES * room.first, COLOUR_BYTES * pixels)
    }

    /// Notes that the counts of the tiles that are listed are added up. What will hold a [`TileTally`] for every
    /// [`TALLIED_TILES`] of them.
    pub(super) fn tally(
        &mut self,
        context: &Context,
        encoder: &mut wgpu::CommandEncoder,
        tiles: u32,
    ) -> Stretch<'_> {
        let groups = tiles.div_ceil(TALLIED_TILES);
        let bytes = tally_bytes(tiles);
        self.tallies.reserve(context, bytes);
        let pipeline = context.kernel(Kernel::Tally);
        let entries: Vec<_> = entries_of([
            (binding::VIEWS, &self.views),
            (binding::LISTED, &self.listed),
            (binding::COUNTS, &self.counts),
            (binding::TALLIES, &self.tallies),
        ])
        .collect();
        note_pass(&context.device, encoder, &pipeline, &entries, in_rows(groups));
        self.tallies.stretch(0, bytes)
    }
}

/// Bytes of the tallies of so many tiles.
pub(super) fn tally_bytes(tiles: u32) -> u64 {
    u64::from(tiles.div_ceil(TALLIED_TILES)) * size_of::<TileTally>() as u64
}

/// Finds room for pictures in buffers of at most so many pixels each.
#[derive(Clone, Debug)]
pub(super) struct Plan {
    most_pixels: u64,
    /// Pixels of each arena that are some picture's.
    pub(super) used: Vec<u64>,
}

impl Plan {
    pub(super) fn new(most_bytes: u64) -> Self {
        // Whole multiples, so that what lies behind a picture fits as well.
        Self { most_pixels: most_bytes / COLOUR_BYTES / APART * APART, used: Vec::new() }
    }

    /// Room for a picture of so many pixels that may have had other room: the same where it suffices; more at the end of an
    /// arena. A picture that is larger than an arena has one of its own.
    pub(super) fn room(&mut self, had: Option<Room>, pixels: u64) -> Room {
        if let Some(room) = had {
            if room.pixels >= pixels {
                return room;
            }
            let is_last = self.used[room.arena] == room.first + room.pixels;
            if is_last && room.first + pixels <= self.most_pixels {
                return self.take(room.arena, room.first, pixels);
            }
        }
        let last = self.used.last().copied().unwrap_or(u64::MAX);
        if last.saturating_add(pixels) > self.most_pixels {
            self.used.push(0);
        }
        let arena = self.used.len() - 1;
        self.take(arena, self.used[arena], pixels)
    }

    fn take(&mut self, arena: usize, first: u64, pixels: u64) -> Room {
        let pixels = pixels.next_multiple_of(APART);
        self.used[arena] = first + pixels;
        Room { arena, first, pixels }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_keep_their_room_and_lie_beside_each_other_as_long_as_they_fit() {
        let mut plan = Plan::new(1000 * COLOUR_BYTES);
        let a = plan.room(None, 300);
        let b = plan.room(None, 500);
        let c = plan.room(None, 400);
        assert_eq!((a.arena, a.first, b.arena, b.first), (0, 0, 0, 304));
        assert_eq!((c.arena, c.first), (1, 0));
        assert_eq!(plan.room(Some(a), 299), a);
        // The last of an arena grows where it is; others move to the end.
        let larger = plan.room(Some(c), 700);
        assert_eq!((larger.arena, larger.first, larger.pixels), (1, 0, 704));
        let moved = plan.room(Some(a), 310);
        assert_eq!((moved.arena, moved.first), (2, 0));
        let huge = plan.room(None, 5000);
        assert_eq!((huge.arena, huge.first, plan.used.len()), (3, 0, 4));
    }
}
