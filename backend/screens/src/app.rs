//! A window as its window system drives it.

use crate::{Act, Button, Picture, ScreenError, keys};
use softbuffer::{Context, Surface};
use std::collections::VecDeque;
use std::num::NonZeroU32;
use std::rc::Rc;
use std::sync::mpsc::Sender;
use std::time::Instant;
use winit::application::ApplicationHandler;
use winit::dpi::PhysicalSize;
use winit::event::{ElementState, KeyEvent, MouseButton, MouseScrollDelta, StartCause, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow};
use winit::keyboard::{Key, ModifiersState, NamedKey};
use winit::window::{Window, WindowId};

/// A notch of a wheel that reports pixels.
const NOTCH_PX: f64 = 40.0;

/// What another thread asks for.
pub(crate) enum Order {
    Show { picture: Picture, at: Instant },
    Close,
}

/// The window's side of the main thread.
pub(crate) struct App {
    title: String,
    shown: Picture,
    /// What is not due yet, in the order in which it was asked for.
    next: VecDeque<(Picture, Instant)>,
    tell: Sender<Act>,
    open: Option<Open>,
    mouse: Mouse,
    pub(crate) failure: Option<ScreenError>,
}

/// A window that is open.
struct Open {
    window: Rc<Window>,
    /// As the events tell it: to ask for it would be a fault of the program where the window system has gone away.
    size: PhysicalSize<u32>,
    surface: Surface<Rc<Window>, Rc<Window>>,
}

/// The state of the mouse, and of Shift.
#[derive(Default)]
struct Mouse {
    at: Option<(f64, f64)>,
    held: Option<MouseButton>,
    modifiers: ModifiersState,
}

impl App {
    pub(crate) fn new(title: String, shown: Picture, tell: Sender<Act>) -> Self {
        Self { title, shown, next: VecDeque::new(), tell, open: None, mouse: Mouse::default(), failure: None }
    }

    fn open(&self, events: &ActiveEventLoop) -> Result<Open, String> {
        let size = PhysicalSize::new(self.shown.width, self.shown.height);
        let attributes = Window::default_attributes().with_title(&self.title).with_inner_size(size);
        let window = Rc::new(events.create_window(attributes).map_err(|error| error.to_string())?);
        let context = Context::new(Rc::clone(&window)).map_err(|error| error.to_string())?;
        let surface = Surface::new(&context, Rc::clone(&window)).map_err(|error| error.to_string())?;
        Ok(Open { size: window.inner_size(), window, surface })
    }

    fn draw(&mut self) -> Result<(), String> {
        let Some(Open { size, surface, .. }) = &mut self.open else { return Ok(()) };
        let PhysicalSize { width, height } = *size;
        // One that is minimised has no pixels.
        let (Some(across), Some(down)) = (NonZeroU32::new(width), NonZeroU32::new(height)) else {
            return Ok(());
        };
        surface.resize(across, down).map_err(|error| error.to_string())?;
        let mut pixels = surface.buffer_mut().map_err(|error| error.to_string())?;
        self.shown.fill([width, height], &mut pixels);
        pixels.present().map_err(|error| error.to_string())
    }

    fn fail(&mut self, events: &ActiveEventLoop, why: String) {
        self.failure = Some(ScreenError::Window(why));
        self.act(Act::Leave);
        events.exit();
    }

    fn draw_or_fail(&mut self, events: &ActiveEventLoop) {
        if let Err(why) = self.draw() {
            self.fail(events, why);
        }
    }

    /// Shows what is due, and says when to look again.
    fn look(&mut self, events: &ActiveEventLoop) {
        let now = Instant::now();
        let due = self.next.partition_point(|(_, at)| *at <= now);
        let latest = self.next.drain(..due).next_back();
        if let Some((picture, _)) = latest {
            self.shown = picture;
            self.draw_or_fail(events);
        }
        let wait = self.next.front().map_or(ControlFlow::Wait, |(_, at)| ControlFlow::WaitUntil(*at));
        events.set_control_flow(wait);
    }

    fn act(&self, act: Act) {
        // Nobody listens only while the program ends.
        let _ = self.tell.send(act);
    }

    fn press(&self, key: &Key) {
        match key {
            Key::Named(NamedKey::Escape) => self.act(Act::Leave),
            Key::Named(NamedKey::Space) => self.act(Act::Letter(' ')),
            Key::Character(text) => text.chars().for_each(|letter| self.act(Act::Letter(letter))),
            _ => {}
        }
    }

    fn drag(&mut self, to: (f64, f64)) {
        let from = self.mouse.at.replace(to);
        let button = match self.mouse.held {
            Some(MouseButton::Left) if self.mouse.modifiers.shift_key() => Button::Right,
            Some(MouseButton::Left) => Button::Left,
            Some(MouseButton::Right) => Button::Right,
            _ => return,
        };
        if let Some(from) = from {
            self.act(Act::Drag { button, right_px: to.0 - from.0, down_px: to.1 - from.1 });
        }
    }
}

impl ApplicationHandler<Order> for App {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        if self.open.is_none() {
            match self.open(events) {
                Ok(open) => self.open = Some(open),
                Err(why) => self.fail(events, why),
            }
        }
    }

    fn new_events(&mut self, events: &ActiveEventLoop, cause: StartCause) {
        if let StartCause::ResumeTimeReached { .. } = cause {
            self.look(events);
        }
    }

    fn user_event(&mut self, events: &ActiveEventLoop, order: Order) {
        match order {
            Order::Close => events.exit(),
            Order::Show { picture, at } => {
                self.next.push_back((picture, at));
                self.look(events);
            }
        }
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        match event {
            WindowEvent::CloseRequested => self.act(Act::Leave),
            WindowEvent::RedrawRequested => self.draw_or_fail(events),
            WindowEvent::Resized(size) => {
                if let Some(open) = &mut self.open {
                    open.size = size;
                    open.window.request_redraw();
                }
            }
            WindowEvent::ModifiersChanged(modifiers) => self.mouse.modifiers = modifiers.state(),
            WindowEvent::KeyboardInput {
                event: KeyEvent { logical_key, state: ElementState::Pressed, .. },
                ..
            } => self.press(&logical_key),
            WindowEvent::MouseInput { state, button, .. } => {
                self.mouse.held = (state == ElementState::Pressed).then_some(button);
                self.open.iter().for_each(|open| keys::take(&open.window));
            }
            WindowEvent::CursorMoved { position, .. } => self.drag((position.x, position.y)),
            WindowEvent::MouseWheel { delta, .. } => self.act(Act::Wheel(match delta {
                MouseScrollDelta::LineDelta(_, notches) => f64::from(notches),
                MouseScrollDelta::PixelDelta(pixels) => pixels.y / NOTCH_PX,
            })),
            _ => {}
        }
    }
}
