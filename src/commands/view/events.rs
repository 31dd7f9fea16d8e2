//! Handling of window and loader events.

use winit::application::ApplicationHandler;
use winit::event::{ElementState, KeyEvent, StartCause, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow};
use winit::keyboard::{Key, NamedKey};
use winit::window::WindowId;

use crate::error::{Error, Result};

use super::app::App;
use super::input::Wheel;
use super::keys;
use super::loader::Message;
use super::stage::{self, Stage};

impl App {
    fn key(&mut self, event: &KeyEvent, is_free: bool) -> Result<()> {
        self.input.key(event, is_free);
        if is_free && event.state == ElementState::Pressed {
            let modifiers = self.input.modifiers;
            let shift = modifiers.shift_key();
            // Ctrl slows flight down; Cmd belongs to the system.
            let is_free = !(modifiers.control_key() || modifiers.super_key());
            let action = keys::action(&event.logical_key, shift);
            let action = action.or_else(|| keys::digit(event.physical_key));
            if let Some(action) = action.filter(|_| is_free) {
                self.perform(action)?;
            }
        }
        self.request_redraw();
        Ok(())
    }

    fn on_event(&mut self, event_loop: &ActiveEventLoop, event: WindowEvent) -> Result<()> {
        let Some(stage) = &mut self.stage else {
            return Ok(());
        };
        // Tab is a shortcut here, unless the keyboard works the panel. And egui answers every redraw event with another repaint request.
        let is_tab = is_tab(&event) && !stage.ui().egui_wants_keyboard_input();
        let (consumed, repaint) = if is_tab || event == WindowEvent::RedrawRequested {
            (false, false)
        } else {
            stage.on_event(&event)
        };
        if repaint {
            stage.window.request_redraw();
        }
        match event {
            WindowEvent::CloseRequested => event_loop.exit(),
            WindowEvent::RedrawRequested => {
                // The input that came during a wait is handled before the frame is drawn that it belongs to.
                if stage.wait_for_turn()? {
                    stage.window.request_redraw();
                } else {
                    self.redraw(event_loop)?;
                }
            }
            WindowEvent::Resized(size) => {
                stage.resize(size);
                stage.window.request_redraw();
            }
            WindowEvent::ScaleFactorChanged { .. } => stage.window.request_redraw(),
            WindowEvent::Occluded(false) | WindowEvent::Focused(true) => {
                stage.window.request_redraw();
            }
            WindowEvent::Focused(false) => self.input.let_go(),
            WindowEvent::DroppedFile(path) => self.open_file(path),
            WindowEvent::ModifiersChanged(modifiers) => self.input.modifiers = modifiers.state(),
            WindowEvent::KeyboardInput { event, .. } => {
                let is_free = is_tab || !stage.ui().egui_wants_keyboard_input();
                self.key(&event, is_free)?;
            }
            other => self.on_pointer(&other, consumed),
        }
        Ok(())
    }

    fn on_pointer(&mut self, event: &WindowEvent, consumed: bool) {
        let Some(stage) = &self.stage else { return };
        let height = f64::from(stage.size().height);
        match event {
            WindowEvent::CursorMoved { position, .. } => {
                let controls = self.document.as_mut().map(|d| &mut d.controls);
                self.input.moved((*position).into(), height, controls);
            }
            WindowEvent::CursorLeft { .. } => self.input.left(),
            WindowEvent::MouseInput { state, button, .. } => {
                if *state == ElementState::Released {
                    self.input.released(*button);
                } else if !consumed {
                    let now = self.started.elapsed().as_secs_f64();
                    if self.input.pressed(*button, now) {
                        self.focus();
                    }
                }
            }
            WindowEvent::MouseWheel { delta, .. } if !consumed => {
                let about = self.interface.point_under_pointer();
                if let Some(document) = &mut self.document {
                    match self.input.wheel(*delta) {
                        Wheel::Dolly(steps) => document.controls.dolly(steps, about),
                        Wheel::Speed(steps) => document.controls.change_speed(steps),
                    }
                }
            }
            WindowEvent::PinchGesture { delta, .. } if !consumed => {
                let about = self.interface.point_under_pointer();
                if let Some(document) = &mut self.document {
                    document.controls.magnify(1.0 + delta, about);
                }
            }
            WindowEvent::Touch(touch) => {
                let scale = stage.ui().pixels_per_point();
                let [x, y] = [touch.location.x, touch.location.y].map(|v| v as f32 / scale);
                let is_taken = self.interface.is_at(stage.ui(), egui::pos2(x, y));
                let controls = self.document.as_mut().map(|d| &mut d.controls);
                self.touches.on_touch(touch, height, is_taken, controls);
            }
            _ => return,
        }
        self.request_redraw();
    }

    /// Turns the camera toward the point under the pointer.
    fn focus(&mut self) {
        if let (Some(document), Some(point)) =
            (&mut self.document, self.interface.point_under_pointer())
        {
            document.controls.focus(point);
        }
    }
}

fn is_tab(event: &WindowEvent) -> bool {
    matches!(event, WindowEvent::KeyboardInput { event, .. } if event.logical_key == Key::Named(NamedKey::Tab))
}

impl ApplicationHandler<Message> for App {
    fn new_events(&mut self, event_loop: &ActiveEventLoop, cause: StartCause) {
        if matches!(cause, StartCause::ResumeTimeReached { .. }) {
            self.again_at = None;
            if self.trouble.is_ending() {
                event_loop.exit();
            }
            self.request_redraw();
        }
    }

    fn resumed(&mut self, event_loop: &ActiveEventLoop) {
        if self.stage.is_some() {
            return;
        }
        let opened = stage::window(event_loop, &self.options).and_then(|window| {
            self.window = Some(window.0.clone());
            Stage::new(window, &self.options)
        });
        match opened {
            Ok(stage) => {
                self.stage = Some(stage);
                self.interface.loading(Some((0.0, "opening")));
                if let Some((ticket, path, result)) = self.waiting.take() {
                    self.opened(ticket, path, result);
                }
                self.request_redraw();
            }
            Err(error) => self.trouble_of(event_loop, error),
        }
    }

    fn user_event(&mut self, _: &ActiveEventLoop, message: Message) {
        match message {
            Message::Progress {
                ticket,
                share,
                stage,
            } if self.loader.is_newest(ticket) => {
                self.interface.loading(Some((share, stage)));
                self.request_redraw();
            }
            Message::Loaded {
                ticket,
                path,
                result,
            } if self.loader.is_newest(ticket) => self.opened(ticket, path, result),
            Message::Done => {
                self.look_for_opened();
                self.request_redraw();
            }
            // A load that has been superseded.
            _ => {}
        }
    }

    fn window_event(&mut self, event_loop: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        let done = match event {
            WindowEvent::Destroyed => Err(Error::WindowGone),
            // A window that may be gone is not drawn to.
            _ if self.trouble.is_ending() => Ok(()),
            event => self.on_event(event_loop, event),
        };
        if let Err(error) = done {
            self.trouble_of(event_loop, error);
        }
    }

    fn about_to_wait(&mut self, event_loop: &ActiveEventLoop) {
        event_loop.set_control_flow(
            self.again_at
                .map_or(ControlFlow::Wait, ControlFlow::WaitUntil),
        );
    }

    fn exiting(&mut self, _: &ActiveEventLoop) {
        // Frames in flight still use the document. A lost device has none in flight.
        if let Some(stage) = &mut self.stage {
            let _ = stage.idle();
        }
        self.drop_openings();
        self.keep_settings();
        self.document = None;
    }
}
