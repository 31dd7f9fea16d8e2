//! A private X server and a client that drives it: windows, screenshots, keys and pointer. Every request is answered before
//! the next is sent.
#![allow(dead_code)]

use std::io::{BufRead, BufReader, IoSlice};
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use skylight::compare::Picture;
use x11rb::connection::{Connection, RequestConnection};
use x11rb::protocol::xproto::{
    AtomEnum, ClientMessageEvent, ConfigureWindowAux, ConnectionExt, EventMask, ImageFormat,
    InputFocus, MapState, Window,
};
use x11rb::rust_connection::RustConnection;

/// Longest wait for anything: software Vulkan on a busy machine is slow.
pub const PATIENCE: Duration = Duration::from_secs(120);

/// Keysyms of keys that have no character.
pub mod keysym {
    pub const TAB: u32 = 0xff09;
    pub const ESCAPE: u32 = 0xff1b;
    pub const F12: u32 = 0xffc9;
    pub const SHIFT: u32 = 0xffe1;
}

/// An Xvfb server; it is killed when this is dropped.
pub struct Display {
    server: Child,
    pub name: String,
    connection: RustConnection,
    root: Window,
    xtest: u8,
}

/// Looks at a program in the second in which it must be idle.
const LOOKS: u32 = 20;
/// Most of them that may find it at work: egui's animations.
const MOST_AT_WORK: usize = 4;

impl Display {
    /// Starts the server. Fails without Xvfb.
    pub fn new() -> Self {
        Self::of_depth(24)
    }

    /// Starts a server whose screen has this many bits for the colour of a pixel: 24, or 30.
    pub fn of_depth(bits: u32) -> Self {
        let screen = format!("1600x1200x{bits}");
        let mut server = Command::new("Xvfb")
            .args([
                "-displayfd",
                "1",
                "-screen",
                "0",
                &screen,
                "-nolisten",
                "tcp",
            ])
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap_or_else(|e| panic!("Xvfb does not start ({e}); run scripts/setup"));
        let mut line = String::new();
        let output = server.stdout.take().expect("a pipe");
        let read = BufReader::new(output).read_line(&mut line);
        assert!(
            read.is_ok() && !line.trim().is_empty(),
            "Xvfb gave no display"
        );
        let name = format!(":{}", line.trim());
        let (connection, screen) = x11rb::connect(Some(&name)).expect("a display server");
        let root = connection.setup().roots[screen].root;
        let xtest = connection
            .extension_information("XTEST")
            .expect("a question")
            .expect("XTEST")
            .major_opcode;
        Self {
            server,
            name,
            connection,
            root,
            xtest,
        }
    }

    /// The first mapped window.
    pub fn window(&self) -> Option<Window> {
        let tree = self.connection.query_tree(self.root).ok()?.reply().ok()?;
        tree.children.into_iter().find(|window| {
            let attributes = self.connection.get_window_attributes(*window);
            let attributes = attributes.ok().and_then(|cookie| cookie.reply().ok());
            attributes.is_some_and(|a| a.map_state == MapState::VIEWABLE)
        })
    }

    /// Title of a window.
    pub fn title(&self, window: Window) -> String {
        let c = &self.connection;
        let name = c
            .intern_atom(false, b"_NET_WM_NAME")
            .expect("sent")
            .reply()
            .expect("an atom");
        let any = AtomEnum::ANY;
        let property = c.get_property(false, window, name.atom, any, 0, 1024);
        let value = property.expect("sent").reply().expect("a property").value;
        String::from_utf8_lossy(&value).into_owned()
    }

    /// Gives a window the keyboard focus. A window that is already gone is no error: its program may have exited.
    pub fn focus(&self, window: Window) {
        let focus = InputFocus::PARENT;
        let cookie = self
            .connection
            .set_input_focus(focus, window, x11rb::CURRENT_TIME);
        let _ = cookie.expect("sent").check();
    }

    /// Takes the keyboard focus from all windows.
    pub fn unfocus(&self) {
        let cookie =
            self.connection
                .set_input_focus(InputFocus::NONE, x11rb::NONE, x11rb::CURRENT_TIME);
        cookie.expect("sent").check().expect("no focus");
    }

    /// Width and height of a window, pixels.
    pub fn size(&self, window: Window) -> [u32; 2] {
        let geometry = self
            .connection
            .get_geometry(window)
            .expect("sent")
            .reply()
            .expect("a size");
        [geometry.width.into(), geometry.height.into()]
    }

    /// Screenshot of a window, or of a part of it (x, y, width, height).
    pub fn picture(&self, window: Window, part: Option<[u32; 4]>) -> Picture {
        let [width, height] = self.size(window);
        let [x, y, width, height] = part.unwrap_or([0, 0, width, height]);
        let narrow = |v: u32| u16::try_from(v).expect("a small window");
        let image = self
            .connection
            .get_image(
                ImageFormat::Z_PIXMAP,
                window,
                narrow(x).cast_signed(),
                narrow(y).cast_signed(),
                narrow(width),
                narrow(height),
                u32::MAX,
            )
            .expect("sent")
            .reply()
            .expect("a picture");
        let bytes: Vec<u8> = image
            .data
            .chunks_exact(4)
            .flat_map(|p| match image.depth {
                30 => eight_of_ten_bits(u32::from_le_bytes([p[0], p[1], p[2], p[3]])),
                _ => [p[2], p[1], p[0]],
            })
            .collect();
        Picture::from_srgb8([width as usize, height as usize], &bytes)
    }

    /// The picture once it has been the same for a second in which the program was idle. `is_working` tells whether it is at work at this
    /// moment: a slow frame shows nothing new for long.
    pub fn still_picture(&self, window: Window, is_working: impl Fn() -> bool) -> Picture {
        let started = Instant::now();
        let mut last = self.picture(window, None);
        loop {
            let looks = (0..LOOKS).filter(|_| {
                sleep(Duration::from_secs(1) / LOOKS);
                is_working()
            });
            let is_busy = looks.count() > MOST_AT_WORK;
            let next = self.picture(window, None);
            let is_blank = next.rgb.iter().all(|p| *p == next.rgb[0]);
            if next == last && !is_blank && !is_busy {
                return next;
            }
            assert!(
                started.elapsed() < PATIENCE,
                "the picture does not come to rest"
            );
            last = next;
        }
    }

    /// Waits until a window shows something other than `before`.
    pub fn wait_for_change(&self, window: Window, before: &Picture) {
        until("another picture", || {
            (self.picture(window, None) != *before).then_some(())
        });
    }

    pub fn resize(&self, window: Window, width: u32, height: u32) {
        let size = ConfigureWindowAux::new().width(width).height(height);
        self.connection
            .configure_window(window, &size)
            .expect("sent")
            .check()
            .expect("a size");
    }

    /// Unmaps a window, as a window manager does when it is minimized.
    pub fn hide(&self, window: Window) {
        self.connection
            .unmap_window(window)
            .expect("sent")
            .check()
            .expect("hidden");
    }

    pub fn show(&self, window: Window) {
        self.connection
            .map_window(window)
            .expect("sent")
            .check()
            .expect("shown");
    }

    /// Asks a window to close, as its close button does.
    pub fn close(&self, window: Window) {
        let c = &self.connection;
        let atom = |name: &[u8]| {
            c.intern_atom(false, name)
                .expect("sent")
                .reply()
                .expect("an atom")
                .atom
        };
        let data = [atom(b"WM_DELETE_WINDOW"), x11rb::CURRENT_TIME, 0, 0, 0];
        let message = ClientMessageEvent::new(32, window, atom(b"WM_PROTOCOLS"), data);
        c.send_event(false, window, EventMask::NO_EVENT, message)
            .expect("sent")
            .check()
            .expect("told");
    }

    /// Destroys a window of another program.
    pub fn destroy(&self, window: Window) {
        self.connection
            .destroy_window(window)
            .expect("sent")
            .check()
            .expect("destroyed");
    }

    /// Closes the connection of the program that has this window.
    pub fn kill_client(&self, window: Window) {
        self.connection
            .kill_client(window)
            .expect("sent")
            .check()
            .expect("killed");
    }

    /// Types the key of a keysym (a Latin-1 character is its own keysym), with Shift if asked.
    pub fn key(&self, keysym: u32, shift: bool) {
        let shift = shift.then_some(keysym::SHIFT);
        if let Some(held) = shift {
            self.fake(2, self.keycode(held), [0, 0]);
        }
        let code = self.keycode(keysym);
        self.fake(2, code, [0, 0]);
        self.fake(3, code, [0, 0]);
        if let Some(held) = shift {
            self.fake(3, self.keycode(held), [0, 0]);
        }
    }

    /// Presses the key of a character and keeps it down.
    pub fn hold(&self, character: char) {
        self.fake(2, self.keycode(character.into()), [0, 0]);
    }

    /// Lets the key of a character go.
    pub fn let_go(&self, character: char) {
        self.fake(3, self.keycode(character.into()), [0, 0]);
    }

    pub fn typed(&self, character: char) {
        self.key(character.into(), false);
    }

    /// Moves the pointer to a position on the screen, pixels.
    pub fn point(&self, x: u32, y: u32) {
        let narrow = |v: u32| u16::try_from(v).expect("on the screen").cast_signed();
        self.fake(6, 0, [narrow(x), narrow(y)]);
    }

    pub fn press(&self, button: u8) {
        self.fake(4, button, [0, 0]);
    }

    pub fn release(&self, button: u8) {
        self.fake(5, button, [0, 0]);
    }

    fn keycode(&self, keysym: u32) -> u8 {
        let setup = self.connection.setup();
        let count = setup.max_keycode - setup.min_keycode + 1;
        let map = self
            .connection
            .get_keyboard_mapping(setup.min_keycode, count);
        let map = map.expect("sent").reply().expect("a keyboard");
        let each = usize::from(map.keysyms_per_keycode);
        let row = map
            .keysyms
            .chunks(each)
            .position(|row| row.contains(&keysym));
        let row = row.unwrap_or_else(|| panic!("no key for {keysym:#x}"));
        setup.min_keycode + u8::try_from(row).expect("a keycode")
    }

    /// XTEST's FakeInput. `kind`: 2 and 3 are key press and release, 4 and 5 button press and release, 6 is pointer motion.
    fn fake(&self, kind: u8, detail: u8, to: [i16; 2]) {
        let mut request = [0u8; 36];
        (request[0], request[1]) = (self.xtest, 2);
        request[2..4].copy_from_slice(&9u16.to_ne_bytes());
        (request[4], request[5]) = (kind, detail);
        request[12..16].copy_from_slice(&self.root.to_ne_bytes());
        request[24..26].copy_from_slice(&to[0].to_ne_bytes());
        request[26..28].copy_from_slice(&to[1].to_ne_bytes());
        let sent = self
            .connection
            .send_request_without_reply(&[IoSlice::new(&request)], Vec::new());
        sent.expect("sent").check().expect("XTEST takes it");
    }
}

/// Red, green and blue of a pixel of 30 bits.
fn eight_of_ten_bits(word: u32) -> [u8; 3] {
    [20, 10, 0].map(|bit| ((word >> bit & 0x3ff) as f32 * 255.0 / 1023.0).round() as u8)
}

impl Drop for Display {
    fn drop(&mut self) {
        let _ = self.server.kill();
        let _ = self.server.wait();
    }
}

/// Polls `ask` until it returns something; fails after [`PATIENCE`].
pub fn until<T>(what: &str, mut ask: impl FnMut() -> Option<T>) -> T {
    let started = Instant::now();
    loop {
        if let Some(answer) = ask() {
            return answer;
        }
        assert!(started.elapsed() < PATIENCE, "waited in vain for {what}");
        sleep(Duration::from_millis(20));
    }
}
