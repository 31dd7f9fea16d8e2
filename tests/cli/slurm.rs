//! The Slurm script of `scripts/jobs` in a Slurm of its own: controller, node and authentication on this machine, loopback alone.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

use crate::shards::{MOMENT, PROGRAM, jobs, scratch, succeed};

/// How long Slurm may take for anything.
const PATIENCE: Duration = Duration::from_secs(120);

/// A Slurm with one node; ends with its value.
struct Slurm {
    folder: tempfile::TempDir,
    daemons: Vec<Child>,
}

impl Drop for Slurm {
    fn drop(&mut self) {
        for daemon in self.daemons.iter_mut().rev() {
            drop(daemon.kill());
            drop(daemon.wait());
        }
    }
}

/// A program of Slurm or munge: daemons are not in every user's path.
fn found(name: &str) -> Option<PathBuf> {
    let paths = std::env::var_os("PATH").unwrap_or_default();
    let folders =
        std::env::split_paths(&paths).chain(["/usr/sbin".into(), "/usr/local/sbin".into()]);
    folders.map(|f| f.join(name)).find(|path| path.is_file())
}

/// A free port of this machine; another program may take it before Slurm does, but hardly will.
fn port() -> u16 {
    let socket = std::net::TcpListener::bind("127.0.0.1:0").expect("a port");
    socket.local_addr().expect("an address").port()
}

impl Slurm {
    /// `None` where Slurm or munge is not installed.
    fn start() -> Option<Self> {
        let [munged, controller, node] = ["munged", "slurmctld", "slurmd"].map(found);
        let (Some(munged), Some(controller), Some(node)) = (munged, controller, node) else {
            println!("skipped: no Slurm here; apt-get install slurm-wlm munge");
            return None;
        };
        let mut slurm = Self {
            folder: tempfile::tempdir().expect("a scratch folder"),
            daemons: Vec::new(),
        };
        slurm.configure();
        let munge = [
            "key-file=munge.key",
            "socket=munge.socket",
            "pid-file=munge.pid",
        ];
        let munge = munge
            .into_iter()
            .chain(["log-file=munge.log", "seed-file=munge.seed"]);
        let words = munge.map(|word| {
            let (name, file) = word.split_once('=').expect("a file");
            format!("--{name}={}", slurm.at(file).display())
        });
        let words: Vec<String> = ["--foreground".into(), "--force".into()]
            .into_iter()
            .chain(words)
            .collect();
        slurm.daemon(&munged, &words);
        slurm.wait_for("munge's socket", |slurm| slurm.at("munge.socket").exists());
        let conf = slurm.at("slurm.conf").display().to_string();
        slurm.daemon(&controller, &["-D".into(), "-f".into(), conf.clone()]);
        slurm.daemon(
            &node,
            &[
                "-D".into(),
                "-N".into(),
                "localhost".into(),
                "-f".into(),
                conf,
            ],
        );
        slurm.wait_for("an idle node", |slurm| {
            slurm.said("sinfo", &["-h", "-o", "%t"]).trim() == "idle"
        });
        Some(slurm)
    }

    fn at(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn configure(&self) {
        let key: Vec<u8> = (0..1024_u32).map(|i| (i * 167 + 13) as u8).collect();
        fs::write(self.at("munge.key"), key).expect("a key");
        let private = std::os::unix::fs::PermissionsExt::from_mode(0o600);
        fs::set_permissions(self.at("munge.key"), private).expect("private");
        for name in ["state", "spool"] {
            fs::create_dir(self.at(name)).expect(name);
        }
        let user = Command::new("id").arg("-un").output().expect("id").stdout;
        let user = String::from_utf8_lossy(&user).trim().to_owned();
        let (folder, cores) = (
            self.folder.path().display(),
            std::thread::available_parallelism(),
        );
        let cores = cores.map_or(1, usize::from);
        let text = format!(
            "ClusterName=skylight\nSlurmctldHost=localhost\nSlurmUser={user}\nSlurmdUser={user}\nSlurmctldPort={}\nSlurmdPort={}\n\
             AuthType=auth/munge\nAuthInfo=socket={folder}/munge.socket\nCredType=cred/munge\n\
             StateSaveLocation={folder}/state\nSlurmdSpoolDir={folder}/spool\n\
             SlurmctldPidFile={folder}/controller.pid\nSlurmdPidFile={folder}/node.pid\n\
             ProctrackType=proctrack/linuxproc\nTaskPlugin=task/none\nJobAcctGatherType=jobacct_gather/none\nMpiDefault=none\n\
             SelectType=select/cons_tres\nSelectTypeParameters=CR_Core\nSchedulerType=sched/builtin\nReturnToService=2\n\
             NodeName=localhost CPUs={cores} State=UNKNOWN\nPartitionName=all Nodes=ALL Default=YES State=UP\n",
            port(),
            port(),
        );
        fs::write(self.at("slurm.conf"), text).expect("written");
    }

    /// Starts a program that runs until the end; what it says is in a file.
    fn daemon(&mut self, program: &Path, words: &[String]) {
        let name = program
            .file_name()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned();
        let log = fs::File::create(self.at(&format!("{name}.log"))).expect("a log");
        let mut command = Command::new(program);
        command
            .args(words)
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(log);
        self.daemons.push(command.spawn().expect("it starts"));
    }

    fn wait_for(&self, what: &str, is_there: impl Fn(&Self) -> bool) {
        let start = Instant::now();
        while !is_there(self) {
            if start.elapsed() > PATIENCE {
                let log = |name: &str| fs::read_to_string(self.at(name)).unwrap_or_default();
                let logs = ["munged.log", "slurmctld.log", "slurmd.log"].map(log);
                panic!("no {what}: {}", logs.concat());
            }
            std::thread::sleep(Duration::from_millis(100));
        }
    }

    fn run(&self, program: &str, words: &[&str], folder: &Path) -> Output {
        let mut command = Command::new(program);
        command
            .current_dir(folder)
            .env("SLURM_CONF", self.at("slurm.conf"));
        command.env("SKYLIGHT", PROGRAM).args(words);
        command.output().expect(program)
    }

    fn said(&self, program: &str, words: &[&str]) -> String {
        let output = self.run(program, words, self.folder.path());
        String::from_utf8_lossy(&output.stdout).into_owned()
    }

    /// Submits the tasks of an array; the number of the job.
    fn submit(&self, folder: &Path, array: &str, line: &str) -> String {
        let script = jobs().join("skylight.sbatch").display().to_string();
        let array = format!("--array={array}");
        let mut words = vec!["--parsable", "--cpus-per-task=1", &array, &script, "12"];
        words.extend(line.split_whitespace());
        let output = self.run("sbatch", &words, folder);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.success(), "{said}");
        String::from_utf8_lossy(&output.stdout).trim().to_owned()
    }

    /// Waits until a job has left the queue.
    fn finish(&self, job: &str) {
        self.wait_for("end of the job", |slurm| {
            !slurm.said("squeue", &["-h", "-o", "%A %F"]).contains(job)
        });
    }
}

#[test]
fn twelve_tasks_of_an_array_make_the_single_run_and_a_killed_one_is_run_again() {
    let Some(slurm) = Slurm::start() else {
        return;
    };
    let folder = scratch(31);
    let folder = folder.path();
    let single = succeed(folder, &format!("{MOMENT} --json"));
    let line = format!("{MOMENT} --json");
    // A task of seconds, so that it can be killed: its sensors want more paths than they can have.
    let slow = line.replace(
        "--max-paths 2048 --error 0.05",
        "--max-paths 100000000 --error 0",
    );
    let job = slurm.submit(folder, "7", &slow);
    slurm.wait_for("a running task", |slurm| {
        slurm
            .said("squeue", &["-h", "-o", "%T"])
            .contains("RUNNING")
    });
    assert!(slurm.run("scancel", &[&job], folder).status.success());
    slurm.finish(&job);
    let part = |number: usize| format!("daylight_{number}-of-12.shard");
    assert!(
        !folder.join(part(7)).exists(),
        "a killed task writes nothing"
    );
    let job = slurm.submit(folder, "1-6,8-12", &line);
    slurm.finish(&job);
    let parts: Vec<String> = (1..=12)
        .map(part)
        .filter(|p| folder.join(p).exists())
        .collect();
    let log =
        |number: usize| fs::read_to_string(folder.join(format!("skylight_{job}_{number}.log")));
    assert_eq!(parts.len(), 11, "{:?}", log(1));
    let words: Vec<&str> = parts.iter().map(String::as_str).collect();
    let missing = Command::new(PROGRAM)
        .current_dir(folder)
        .arg("merge")
        .args(words)
        .output();
    let missing = String::from_utf8_lossy(&missing.expect("it runs").stderr).into_owned();
    assert!(missing.contains("run again with --shard 7/12"), "{missing}");
    let job = slurm.submit(folder, "7", &line);
    slurm.finish(&job);
    let parts: Vec<String> = (1..=12).map(part).collect();
    assert!(succeed(folder, &format!("merge {}", parts.join(" "))) == single);
}
