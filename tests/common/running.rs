//! The program with an open window on an X server of its own.
#![allow(dead_code)]

use std::fs;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, ChildStderr, Command, Output, Stdio};
use std::sync::{Arc, Mutex, PoisonError, RwLock, RwLockReadGuard, RwLockWriteGuard};
use std::thread::{JoinHandle, sleep, spawn};
use std::time::{Duration, Instant};

use skylight::compare::{Picture, flip};
use x11rb::protocol::xproto::Window;

use crate::x::{Display, PATIENCE, keysym, until};

/// Coordinates the tests of this program on one machine: tests that open windows or render for long hold the read lock, a test
/// that measures time holds the write lock.
static MACHINE: RwLock<()> = RwLock::new(());

/// Waits until no test needs the machine to itself; others may run beside.
pub fn shared_machine() -> RwLockReadGuard<'static, ()> {
    MACHINE.read().unwrap_or_else(PoisonError::into_inner)
}

/// Waits until no other window is open and no other test renders, and keeps it so.
pub fn quiet_machine() -> RwLockWriteGuard<'static, ()> {
    MACHINE.write().unwrap_or_else(PoisonError::into_inner)
}

/// Options of the light of sun and sky alone, with ambient occlusion of the screen: the picture at rest does not depend on what was
/// drawn before. Cells are kept while the view moves, so that their noise does.
pub const DIRECT: [&str; 4] = ["--bounces", "0", "--ambient", "ssao"];

/// The running program and its window.
pub struct Running {
    pub display: Display,
    child: Option<Child>,
    pub window: Window,
    pub folder: tempfile::TempDir,
    stderr: (Arc<Mutex<String>>, Option<JoinHandle<()>>),
}

/// Collects what a program says, while it runs.
fn listen(stderr: ChildStderr) -> (Arc<Mutex<String>>, Option<JoinHandle<()>>) {
    let said = Arc::new(Mutex::new(String::new()));
    let kept = said.clone();
    let thread = spawn(move || {
        for line in BufReader::new(stderr).lines().map_while(Result::ok) {
            let mut said = kept.lock().unwrap_or_else(PoisonError::into_inner);
            said.push_str(&line);
            said.push('\n');
        }
    });
    (said, Some(thread))
}

/// CPU time of a process that has not been waited for, seconds.
fn cpu_seconds(pid: u32) -> f64 {
    let text = fs::read_to_string(format!("/proc/{pid}/stat")).expect("it runs");
    let after_name = text.rsplit(')').next().expect("fields");
    let fields: Vec<&str> = after_name.split_whitespace().collect();
    let ticks = |i: usize| fields[i].parse::<f64>().expect("a number");
    (ticks(11) + ticks(12)) / 100.0
}

pub fn program(folder: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_skylight"));
    command
        .current_dir(folder)
        .env_remove("WAYLAND_DISPLAY")
        .env("XDG_STATE_HOME", folder)
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped());
    command
}

impl Running {
    pub fn new(words: &[&str]) -> Self {
        Self::with(words, &[])
    }

    /// Starts the program with extra environment variables.
    pub fn with(words: &[&str], variables: &[(&str, &Path)]) -> Self {
        Self::on(Display::new(), words, variables)
    }

    /// Starts the program on this display, with extra environment variables; on the colonnade unless the first word names another scene.
    pub fn on(display: Display, words: &[&str], variables: &[(&str, &Path)]) -> Self {
        let folder = tempfile::tempdir().expect("a scratch folder");
        let has_scene = words.first().is_some_and(|word| !word.starts_with('-'));
        let mut child = program(folder.path())
            .arg("view")
            .args((!has_scene).then_some("colonnade"))
            .args(words)
            .env("DISPLAY", &display.name)
            .envs(variables.iter().copied())
            .spawn()
            .expect("the program starts");
        let stderr = listen(child.stderr.take().expect("a pipe"));
        // A program that exits at once may never map its window.
        let window = until("a window", || {
            let ended = || child.try_wait().expect("a state").map(|_| x11rb::NONE);
            display.window().or_else(ended)
        });
        display.focus(window);
        let running = Self {
            display,
            child: Some(child),
            window,
            folder,
            stderr,
        };
        // Park the pointer outside the window.
        running.display.point(1590, 1190);
        running
    }

    /// Starts the program with panel and read-outs hidden: only the picture is shown.
    pub fn bare(words: &[&str]) -> Self {
        Self::bare_with(words, &[])
    }

    /// As [`Running::bare`], with extra environment variables.
    pub fn bare_with(words: &[&str], variables: &[(&str, &Path)]) -> Self {
        Self::with(words, variables).bared()
    }

    /// Hides panel and read-outs, once the scene is there.
    pub fn bared(self) -> Self {
        until("the scene", || {
            let title = self.display.title(self.window);
            (title != "skylight").then_some(())
        });
        self.display.key(keysym::TAB, false);
        self
    }

    /// The picture once it no longer changes.
    pub fn picture(&self) -> Picture {
        self.display
            .still_picture(self.window, || self.is_working())
    }

    /// The picture of a scene by day once it no longer changes: on a busy machine the dark window before it may stand still too.
    pub fn daylit(&self) -> Picture {
        until("a bright picture", || {
            let shown = self.picture();
            let green = shown.rgb.iter().map(|colour| colour[1]).sum::<f32>();
            (green / shown.rgb.len() as f32 > 0.1).then_some(shown)
        })
    }

    /// Whether one of its threads runs, or waits for a processor: on a busy machine the CPU time of a program at work grows slowly.
    pub fn is_working(&self) -> bool {
        self.states().any(|state| "RD".contains(state))
    }

    /// The state of each thread, as in `/proc/PID/stat`.
    fn states(&self) -> impl Iterator<Item = char> {
        let tasks = fs::read_dir(format!("/proc/{}/task", self.pid()));
        let stats = tasks
            .into_iter()
            .flatten()
            .filter_map(|task| fs::read_to_string(task.ok()?.path().join("stat")).ok());
        let state = |text: String| text.rsplit(") ").next()?.chars().next();
        stats.filter_map(state)
    }

    fn signal(&self, name: &str) {
        let words = format!("kill -s {name} {}", self.pid());
        let status = Command::new("sh").args(["-c", &words]).status();
        assert!(status.expect("a shell").success());
    }

    /// What is shown while the program is stopped: it goes on from there, so that no frame is missed on a busy machine.
    pub fn stopped_picture(&self) -> Picture {
        self.signal("STOP");
        until("a stopped program", || {
            self.states().all(|state| state == 'T').then_some(())
        });
        let shown = self.display.picture(self.window, None);
        self.signal("CONT");
        shown
    }

    /// CPU time of the program so far, seconds.
    pub fn cpu_seconds(&self) -> f64 {
        cpu_seconds(self.pid())
    }

    /// Performs an action that changes the picture, and returns the new picture once it no longer changes.
    pub fn after(&self, act: impl FnOnce(&Display)) -> Picture {
        let before = self.picture();
        act(&self.display);
        self.display.wait_for_change(self.window, &before);
        self.picture()
    }

    pub fn pid(&self) -> u32 {
        self.child.as_ref().expect("it runs").id()
    }

    /// Closes the window as a user does; returns the program's output.
    pub fn close(self) -> Output {
        self.display.close(self.window);
        self.ended()
    }

    /// Waits until the program exits; returns its output. On a busy machine a program at work gets little time, so that its CPU time is
    /// limited, and the time in which it uses none.
    pub fn ended(mut self) -> Output {
        let mut child = self.child.take().expect("it runs");
        let started = cpu_seconds(child.id());
        let (mut used, mut idle_since) = (0.0, Instant::now());
        while child.try_wait().expect("a state").is_none() {
            let now = cpu_seconds(child.id()) - started;
            if now > used {
                (used, idle_since) = (now, Instant::now());
            }
            if used.max(idle_since.elapsed().as_secs_f64()) > PATIENCE.as_secs_f64() {
                child.kill().expect("it runs");
                panic!("the program does not end");
            }
            sleep(Duration::from_millis(20));
        }
        let mut output = child.wait_with_output().expect("what it said");
        if let Some(thread) = self.stderr.1.take() {
            thread.join().expect("what it said");
        }
        output.stderr = self.said().into_bytes();
        output
    }

    /// What the program has said on stderr so far.
    pub fn said(&self) -> String {
        let said = self.stderr.0.lock();
        said.unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Closes the window; the program must succeed without complaints.
    pub fn close_well(self) {
        let output = self.close();
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.success(), "{:?}: {said}", output.status);
        assert_eq!(said, "");
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        if let Some(child) = &mut self.child {
            let _ = child.kill();
            let _ = child.wait();
        }
    }
}

pub fn difference(a: &Picture, b: &Picture) -> f64 {
    flip::mean(&flip::ldr(a, b))
}
