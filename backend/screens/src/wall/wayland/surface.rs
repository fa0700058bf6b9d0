//! A full-screen window, with the pictures that it shows and will show.

use super::globals::{Globals, Hears};
use super::screen::Screen;
use crate::ScreenError;
use crate::wall::pixels::Layout;
use display_config::Output;
use glam::UVec2;
use protocol::ScreenImage;
use std::fs::File;
use std::os::fd::AsFd;
use std::os::unix::fs::FileExt;
use wayland_client::QueueHandle;
use wayland_client::protocol::wl_buffer::WlBuffer;
use wayland_client::protocol::wl_shm::Format;
use wayland_client::protocol::wl_shm_pool::WlShmPool;
use wayland_client::protocol::wl_surface::WlSurface;
use wayland_protocols::wp::idle_inhibit::zv1::client::zwp_idle_inhibitor_v1::ZwpIdleInhibitorV1;
use wayland_protocols::wp::viewporter::client::wp_viewport::WpViewport;
use wayland_protocols::xdg::shell::client::xdg_surface::XdgSurface;
use wayland_protocols::xdg::shell::client::xdg_toplevel::XdgToplevel;

/// One is on the output, one waits for its turn, and one is made ready.
const PICTURES: usize = 3;

/// A window.
pub struct Surface {
    /// The number of the output that it covers.
    pub screen: u32,
    /// Pixels of the output.
    pub size: [u16; 2],
    surface: WlSurface,
    shell: XdgSurface,
    top: XdgToplevel,
    viewport: Option<WpViewport>,
    inhibitor: Option<ZwpIdleInhibitorV1>,
    /// What it is called when it is told of.
    index: usize,
    /// Size in the desktop's own units, once it has told.
    pub told: Option<[i32; 2]>,
    is_on_screen: bool,
    /// What was put last, or is black: blue, green, red and nothing, by rows.
    pixels: Vec<u8>,
    /// The pictures one after another, for the desktop to read.
    file: File,
    pool: WlShmPool,
    pictures: [Shared; PICTURES],
    /// Which of them is shown, or was given to be.
    front: usize,
    /// Which is made ready.
    back: usize,
    /// Of what was given to be shown last.
    serial: u32,
    pub has_shown: bool,
}

/// A picture that the desktop can read.
struct Shared {
    buffer: WlBuffer,
    /// Whether it may be reading.
    is_read: bool,
}

impl Surface {
    /// Asks for a window on an output of so many pixels. It opens when the desktop has told its size.
    ///
    /// # Errors
    /// There is no room for its pictures.
    pub fn new(
        index: usize,
        globals: &Globals<impl Hears>,
        screen: &Screen,
        size: [u16; 2],
        name: &str,
    ) -> Result<Self, ScreenError> {
        let Globals { queue, compositor, shm, base, viewporter, inhibitors, .. } = globals;
        let surface = compositor.create_surface(queue, ());
        let shell = base.get_xdg_surface(&surface, queue, index);
        let top = shell.get_toplevel(queue, index);
        top.set_title(format!("lightloom: {name}"));
        top.set_app_id("lightloom".to_owned());
        top.set_fullscreen(Some(&screen.output));
        let viewport = viewporter.as_ref().map(|viewporter| viewporter.get_viewport(&surface, queue, ()));
        let inhibitor =
            inhibitors.as_ref().map(|inhibitors| inhibitors.create_inhibitor(&surface, queue, ()));
        surface.commit();
        let bytes = 4 * usize::from(size[0]) * usize::from(size[1]);
        let no_room = |error: std::io::Error| ScreenError::NoRoom(error.to_string());
        let folder = std::env::var_os("XDG_RUNTIME_DIR").map_or_else(std::env::temp_dir, Into::into);
        let file = tempfile::tempfile_in(folder).map_err(no_room)?;
        file.set_len((PICTURES * bytes) as u64).map_err(no_room)?;
        let all = i32::try_from(PICTURES * bytes).map_err(|error| ScreenError::NoRoom(error.to_string()))?;
        let pool = shm.create_pool(file.as_fd(), all, queue, ());
        let picture = |place: usize| shared(&pool, queue, (index, place), size);
        Ok(Self {
            screen: screen.global,
            size,
            surface,
            shell,
            top,
            viewport,
            inhibitor,
            index,
            told: None,
            is_on_screen: false,
            pixels: vec![0; bytes],
            file,
            pictures: [picture(0), picture(1), picture(2)],
            pool,
            front: 0,
            back: 1,
            serial: 0,
            has_shown: true,
        })
    }

    /// Takes over what another showed, where that is of the same size.
    pub fn take_over(&mut self, other: &Self) {
        if self.size == other.size {
            self.pixels.clone_from(&other.pixels);
        }
    }

    /// Whether it is open.
    pub fn is_on_screen(&self) -> bool {
        self.is_on_screen
    }

    /// The desktop is ready for it, in the size that it has told: shows what there is, for the first time or in another size.
    ///
    /// # Errors
    /// There is no room for its pictures.
    pub fn configure(&mut self, globals: &Globals<impl Hears>, serial: u32) -> Result<(), ScreenError> {
        self.shell.ack_configure(serial);
        if let (Some(viewport), Some([width, height])) = (&self.viewport, self.told)
            && width > 0
            && height > 0
        {
            // Pixel for pixel, whatever units the desktop counts in.
            viewport.set_destination(width, height);
        }
        if self.is_on_screen {
            self.surface.commit();
            return Ok(());
        }
        self.is_on_screen = true;
        self.ready()?;
        self.show(globals);
        Ok(())
    }

    /// A picture that is not shown and that the desktop does not read.
    pub fn spare(&self) -> Option<usize> {
        (0..PICTURES).find(|&place| place != self.front && !self.pictures[place].is_read)
    }

    /// Puts the picture of a projector among the pixels, as far as they go.
    pub fn put(&mut self, image: &ScreenImage, output: &Output) {
        let bytes = Layout::BLUE_FIRST.bytes(image, output.turn);
        let size = output.turn.size(UVec2::new(image.width, image.height));
        let [across, down] = self.size.map(usize::from);
        let (x, y) = (output.first_px.x as usize, output.first_px.y as usize);
        let width = (size.x as usize).min(across.saturating_sub(x));
        if width == 0 {
            return;
        }
        let rows = bytes.chunks_exact(4 * size.x as usize).take(down.saturating_sub(y));
        for (row, pixels) in rows.enumerate() {
            let at = 4 * ((y + row) * across + x);
            self.pixels[at..at + 4 * width].copy_from_slice(&pixels[..4 * width]);
        }
    }

    /// Hands the pixels to the desktop, as the picture to show next. Where it still reads all pictures, one that it has long had the
    /// time for is overwritten.
    ///
    /// # Errors
    /// There is no room for them.
    pub fn ready(&mut self) -> Result<(), ScreenError> {
        self.back = self.spare().unwrap_or((self.front + 1) % PICTURES);
        let at = self.back as u64 * self.pixels.len() as u64;
        self.file.write_all_at(&self.pixels, at).map_err(|error| ScreenError::NoRoom(error.to_string()))
    }

    /// Has the picture that is ready shown: at the next refresh of the output, and as a whole.
    pub fn show(&mut self, globals: &Globals<impl Hears>) {
        if !self.is_on_screen {
            return;
        }
        self.front = self.back;
        let picture = &mut self.pictures[self.front];
        picture.is_read = true;
        self.surface.attach(Some(&picture.buffer), 0, 0);
        self.surface.damage_buffer(0, 0, i32::MAX, i32::MAX);
        self.serial = self.serial.wrapping_add(1);
        let number = (self.index, self.serial);
        if let Some(presentation) = &globals.presentation {
            presentation.feedback(&self.surface, &globals.queue, number);
        }
        self.surface.frame(&globals.queue, number);
        self.has_shown = false;
        self.surface.commit();
    }

    /// The desktop has shown, or passed over, what this number was given to.
    pub fn shown(&mut self, serial: u32) {
        self.has_shown |= serial == self.serial;
    }

    /// The desktop is done with a picture.
    pub fn done_with(&mut self, buffer: &WlBuffer) {
        self.pictures
            .iter_mut()
            .filter(|picture| picture.buffer == *buffer)
            .for_each(|picture| picture.is_read = false);
    }
}

impl Drop for Surface {
    fn drop(&mut self) {
        self.inhibitor.iter().for_each(ZwpIdleInhibitorV1::destroy);
        self.viewport.iter().for_each(WpViewport::destroy);
        self.top.destroy();
        self.shell.destroy();
        self.surface.destroy();
        self.pictures.iter().for_each(|picture| picture.buffer.destroy());
        self.pool.destroy();
    }
}

/// The picture at a place of a pool, of the `index`th window.
fn shared(
    pool: &WlShmPool,
    queue: &QueueHandle<impl Hears>,
    (index, place): (usize, usize),
    size: [u16; 2],
) -> Shared {
    let [width, height] = size.map(i32::from);
    let at = place as i32 * 4 * width * height;
    let buffer = pool.create_buffer(at, width, height, 4 * width, Format::Xrgb8888, queue, index);
    Shared { buffer, is_read: false }
}
