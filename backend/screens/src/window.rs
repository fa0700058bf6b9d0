//! The ends of a window: the loop in the main thread, and what other threads show pictures and hear of people with.

use crate::app::{App, Order};
use crate::{Act, Picture, ScreenError};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::time::Instant;
use winit::event_loop::{EventLoop, EventLoopProxy};

/// The main thread's end.
pub struct WindowLoop {
    events: EventLoop<Order>,
    app: App,
}

/// The end that shows pictures. Dropped, it closes the window.
pub struct Window {
    orders: EventLoopProxy<Order>,
}

/// The end that tells what people do.
pub struct Acts {
    acts: Receiver<Act>,
}

/// A window for pictures of this size, which opens once its loop runs. Call it from the main thread, once in a process.
///
/// # Errors
/// There is no window system.
pub fn open(title: &str, width: u32, height: u32) -> Result<(WindowLoop, Window, Acts), ScreenError> {
    let events = EventLoop::with_user_event()
        .build()
        .map_err(|error| ScreenError::NoWindowSystem(without_place(&error.to_string())))?;
    let (tell, acts) = channel();
    let orders = events.create_proxy();
    let app = App::new(title.to_owned(), Picture::black(width, height), tell);
    Ok((WindowLoop { events, app }, Window { orders }, Acts { acts }))
}

/// What the window library says, without the line of its own code that it names before.
fn without_place(text: &str) -> String {
    let after = text.split_once(".rs:").and_then(|(_, rest)| rest.split_once(": "));
    after.map_or(text, |(_, what)| what).to_owned()
}

impl WindowLoop {
    /// Shows what is asked for until the other end is dropped.
    ///
    /// # Errors
    /// The window system refuses the window, or goes away.
    pub fn run(self) -> Result<(), ScreenError> {
        let Self { events, mut app } = self;
        // The library panics where the window system goes away between two of its questions.
        let ended = catch_unwind(AssertUnwindSafe(|| events.run_app(&mut app)));
        let ended = ended.map_err(|_| ScreenError::Window("the window system went away".to_owned()))?;
        ended.map_err(|error| ScreenError::Window(error.to_string()))?;
        app.failure.map_or(Ok(()), Err)
    }
}

impl Window {
    /// Shows a picture from a moment on, after those that were handed over before.
    pub fn show(&self, picture: Picture, at: Instant) {
        // A loop that has ended shows nothing any more, and the person has seen to that.
        let _ = self.orders.send_event(Order::Show { picture, at });
    }
}

impl Acts {
    /// What was done in the window since this was last asked. Whoever was at a window that is gone has left.
    pub fn take(&self) -> Vec<Act> {
        let mut acts = Vec::new();
        loop {
            match self.acts.try_recv() {
                Ok(act) => acts.push(act),
                Err(TryRecvError::Empty) => return acts,
                Err(TryRecvError::Disconnected) => {
                    acts.push(Act::Leave);
                    return acts;
                }
            }
        }
    }
}

impl Drop for Window {
    fn drop(&mut self) {
        let _ = self.orders.send_event(Order::Close);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_line_of_a_library_is_told() {
        let text = "os error at /home/me/x-0.30/src/linux/mod.rs:765: neither A nor B is set.";
        assert_eq!(without_place(text), "neither A nor B is set.");
        assert_eq!(without_place("no window"), "no window");
    }
}
