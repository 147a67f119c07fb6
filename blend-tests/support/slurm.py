"""A Slurm of small nodes, all on this machine, for as long as a test or a measurement takes."""

import contextlib
import itertools
import os
import shutil
import signal
import socket
import subprocess
import tempfile
import time
from pathlib import Path

from . import process

_PROGRAMS = ("slurmctld", "slurmd", "sbatch", "squeue", "scontrol", "scancel")
_SECONDS = 90  # for a node to come up, a pass to be rendered, or a queue to become empty

_CONFIGURATION = """\
ClusterName=velour
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={controller}
AuthType=auth/none
CredType=cred/none
SlurmUser=root
SlurmdUser=root
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool-%n
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd-%n.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
ReturnToService=2
SlurmdTimeout={patience}
SelectType=select/cons_tres
SelectTypeParameters=CR_Core_Memory
SchedulerType=sched/builtin
SchedulerParameters=batch_sched_delay=0,sched_min_interval=0
PartitionName=all Nodes=ALL Default=YES State=UP
"""
_NODE = (
    "NodeName={name} NodeHostname={host} NodeAddr=127.0.0.1 Port={port} CPUs={processors} RealMemory={mib}\n"
)


def why_not():
    """Why Slurm cannot be started here, or ""."""
    missing = [name for name in _PROGRAMS if not _program(name)]
    if missing:
        return f"Slurm is not installed ({', '.join(missing)})"
    if os.geteuid() != 0:
        return "only root can start Slurm's daemons"
    return "" if len(os.sched_getaffinity(0)) >= 2 else "the node of the test has two processors"


def _program(name):
    return shutil.which(name, path=f"{os.environ['PATH']}:/usr/sbin")


def _version():
    """The first number of the release: 22 of 22.05."""
    said = subprocess.run([_program("slurmd"), "-V"], capture_output=True, text=True, check=True).stdout
    return int(said.split()[-1].split(".")[0])


class Slurm:
    """`nodes`: their names; all share this machine. `processors`, `mib`: of each node. `patience`: seconds
    until a node that does not answer is down.

    Raises RuntimeError with what the daemons said when the nodes do not come up.
    """

    def __init__(self, nodes=("node1",), processors=2, mib=2000, patience=300):
        self.folder = Path(tempfile.mkdtemp(prefix="velour-slurm-"))
        self.environment = {"SLURM_CONF": str(self.folder / "slurm.conf")}
        self.nodes = list(nodes)
        self._daemons = {}  # by the name of the node; the controller's is ""
        try:
            self._configure(patience, {"processors": processors, "mib": mib})
            self._start("", "slurmctld", "-D", "-i")
            for name in self.nodes:
                self.start_node(name)
            self.wait_until(self._all_idle, "the nodes do not come up")
        except BaseException:
            self.stop()
            raise

    def _configure(self, patience, each):
        (self.folder / "state").mkdir()
        host = socket.gethostname().split(".")[0]
        text = _CONFIGURATION.format(
            host=host, folder=self.folder, controller=_free_port(), patience=patience
        )
        for name in self.nodes:
            (self.folder / f"spool-{name}").mkdir()
            text = _NODE.format(name=name, host=host, port=_free_port(), **each) + text
        (self.folder / "slurm.conf").write_text(text)
        if (
            not any(Path("/sys/fs/cgroup").glob("*")) and _version() >= 24
        ):  # these do not start without, unless told
            (self.folder / "cgroup.conf").write_text("CgroupPlugin=disabled\n")

    def start_node(self, name):
        """Starts the daemon of a node, again after kill_node()."""
        self._start(name, "slurmd", "-D", "-N", name)

    def _start(self, key, program, *options):
        with open(self.folder / f"{key or program}.log", "ab") as log:
            self._daemons[key] = subprocess.Popen(
                [_program(program), *options],
                env={**os.environ, **self.environment, "SLURMD_NODENAME": key},
                stdin=subprocess.DEVNULL,
                stdout=log,
                stderr=subprocess.STDOUT,
            )

    def _all_idle(self):
        return self.states() == dict.fromkeys(self.nodes, "idle")

    def states(self):
        """The state of each node that Slurm knows, by name."""
        return dict(line.split() for line in self.run("sinfo", "-h", "-N", "-o", "%N %T").splitlines())

    def processes(self, node):
        """The ids of what a node runs, by the name of the program: job steps, and each one's slurmstepd."""
        found = {}
        for pid in map(int, filter(str.isdigit, os.listdir("/proc"))):
            if self._runs(pid, node) and (name := _program_of(pid)) not in ("", "slurmd"):
                found.setdefault(name, []).append(pid)
        return found

    def _runs(self, pid, node):
        """Daemons of a node and what they start have its name in their environment."""
        with contextlib.suppress(OSError):
            variables = Path(f"/proc/{pid}/environ").read_bytes().split(b"\0")
            wanted = {**self.environment, "SLURMD_NODENAME": node}
            return all(f"{name}={value}".encode() in variables for name, value in wanted.items())
        return False

    def kill_node(self, name):
        """Fails the power of a node: the daemon and all that the node runs end at once."""
        daemon = self._daemons.pop(name)
        daemon.kill()
        daemon.wait()
        self._kill_steps(name)

    def _kill_steps(self, node):
        while running := self.processes(node):
            for pid in itertools.chain(*running.values()):
                kill(pid)
            time.sleep(0.05)

    def run(self, *command):
        return process.run(command, self.environment, _SECONDS).stdout

    def wait_until_empty(self):
        self.wait_until(lambda: not self.run("squeue", "-h").strip(), "the queue does not become empty")

    def wait_until(self, done, sentence):
        """Raises RuntimeError with the sentence and what the daemons said, when they end or time is over."""
        end = time.monotonic() + _SECONDS
        while not done():
            if time.monotonic() > end or any(daemon.poll() is not None for daemon in self._daemons.values()):
                logs = "\n".join(log.read_text(errors="replace")[-2000:] for log in self.folder.glob("*.log"))
                raise RuntimeError(f"{sentence}:\n{self.run('squeue')}\n{logs}")
            time.sleep(0.1)

    def stop(self):
        """The nodes first: what they run ends with them."""
        for daemon in reversed(self._daemons.values()):
            daemon.terminate()
            daemon.wait()
        for name in self.nodes:
            self._kill_steps(name)
        shutil.rmtree(self.folder, ignore_errors=True)


def kill(pid):
    """SIGKILL, to a process that may have ended."""
    with contextlib.suppress(ProcessLookupError):
        os.kill(pid, signal.SIGKILL)


def _program_of(pid):
    """The name of a process; "" once it has ended."""
    with contextlib.suppress(OSError):
        return Path(f"/proc/{pid}/comm").read_text().strip()
    return ""


def _free_port():
    with socket.socket() as found:
        found.bind(("127.0.0.1", 0))
        return found.getsockname()[1]
