//! The application as eframe runs it, which outlives eframe's window when the graphics device is lost, and the keys of
//! the numeric pad, which come directly from winit.

use std::cell::RefCell;
use std::collections::VecDeque;
use std::rc::Rc;

use eframe::egui;
use eframe::{EframeWinitApplication, UserEvent};
use winit::application::ApplicationHandler;
use winit::event::{DeviceEvent, DeviceId, ElementState, StartCause, WindowEvent};
use winit::event_loop::ActiveEventLoop;
use winit::keyboard::{KeyCode, PhysicalKey};
use winit::window::WindowId;

use super::Application;
use pliant_engine::EngineError;

/// The application between two windows.
pub type Shared = Rc<RefCell<Option<Application>>>;

/// Digits of the numeric pad that went down and have not been taken yet: egui gives the keys of both rows of digits the
/// same name.
pub type NumpadDigits = Rc<RefCell<VecDeque<u8>>>;

/// The application in one of eframe's windows.
pub struct Shell {
    application: Shared,
    numpad: NumpadDigits,
}

impl Shell {
    /// Begins by `begin`, or goes on with the application that has lost its last window's device.
    ///
    /// # Errors
    /// As [`Application::new`].
    pub fn new(
        context: &eframe::CreationContext<'_>,
        application: Shared,
        begin: impl FnOnce(&eframe::CreationContext<'_>) -> Result<Application, EngineError>,
        numpad: NumpadDigits,
    ) -> Result<Self, EngineError> {
        let mut held = application.borrow_mut();
        match held.as_mut() {
            Some(application) => application.revive(context)?,
            None => *held = Some(begin(context)?),
        }
        drop(held);
        Ok(Self { application, numpad })
    }
}

impl eframe::App for Shell {
    fn ui(&mut self, ui: &mut egui::Ui, frame: &mut eframe::Frame) {
        if let Some(application) = self.application.borrow_mut().as_mut() {
            application.press_numpad(std::mem::take(&mut *self.numpad.borrow_mut()));
            application.ui(ui, frame);
        }
    }
}

/// eframe's event handler, extended by the keys of the numeric pad.
pub struct Listener<'a> {
    /// eframe's handler.
    pub inner: EframeWinitApplication<'a>,
    /// The queue for the pad's digits.
    pub numpad: NumpadDigits,
}

impl ApplicationHandler<UserEvent> for Listener<'_> {
    fn resumed(&mut self, event_loop: &ActiveEventLoop) {
        self.inner.resumed(event_loop);
    }

    fn window_event(&mut self, event_loop: &ActiveEventLoop, window: WindowId, event: WindowEvent) {
        if let WindowEvent::KeyboardInput { event, .. } = &event
            && event.state == ElementState::Pressed
            && let Some(digit) = numpad_digit(event.physical_key)
        {
            self.numpad.borrow_mut().push_back(digit);
        }
        self.inner.window_event(event_loop, window, event);
    }

    fn new_events(&mut self, event_loop: &ActiveEventLoop, cause: StartCause) {
        self.inner.new_events(event_loop, cause);
    }

    fn user_event(&mut self, event_loop: &ActiveEventLoop, event: UserEvent) {
        self.inner.user_event(event_loop, event);
    }

    fn device_event(&mut self, event_loop: &ActiveEventLoop, device: DeviceId, event: DeviceEvent) {
        self.inner.device_event(event_loop, device, event);
    }

    fn about_to_wait(&mut self, event_loop: &ActiveEventLoop) {
        self.inner.about_to_wait(event_loop);
    }

    fn suspended(&mut self, event_loop: &ActiveEventLoop) {
        self.inner.suspended(event_loop);
    }

    fn exiting(&mut self, event_loop: &ActiveEventLoop) {
        self.inner.exiting(event_loop);
    }

    fn memory_warning(&mut self, event_loop: &ActiveEventLoop) {
        self.inner.memory_warning(event_loop);
    }
}

fn numpad_digit(key: PhysicalKey) -> Option<u8> {
    let PhysicalKey::Code(code) = key else { return None };
    let keys = [
        KeyCode::Numpad0,
        KeyCode::Numpad1,
        KeyCode::Numpad2,
        KeyCode::Numpad3,
        KeyCode::Numpad4,
        KeyCode::Numpad5,
        KeyCode::Numpad6,
        KeyCode::Numpad7,
        KeyCode::Numpad8,
        KeyCode::Numpad9,
    ];
    keys.iter().position(|&other| other == code).map(|digit| digit as u8)
}
