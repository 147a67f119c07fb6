"""A Slurm of one node, on this machine, for as long as a test takes."""

import os
import shutil
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
SlurmdPort={daemon}
AuthType=auth/none
CredType=cred/none
SlurmUser=root
SlurmdUser=root
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
ReturnToService=2
SelectType=select/cons_tres
SelectTypeParameters=CR_Core_Memory
SchedulerType=sched/builtin
SchedulerParameters=batch_sched_delay=0,sched_min_interval=0
NodeName={host} NodeAddr=127.0.0.1 CPUs=2 RealMemory=2000
PartitionName=all Nodes=ALL Default=YES State=UP
"""


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
    """Raises RuntimeError with what the daemons said when no node comes up."""

    def __init__(self):
        self.folder = Path(tempfile.mkdtemp(prefix="velour-slurm-"))
        self.environment = {"SLURM_CONF": str(self.folder / "slurm.conf")}
        self._daemons = []
        try:
            self._start()
        except BaseException:
            self.stop()
            raise

    def _start(self):
        for name in ("state", "spool"):
            (self.folder / name).mkdir()
        text = _CONFIGURATION.format(
            host=socket.gethostname().split(".")[0],
            folder=self.folder,
            controller=_free_port(),
            daemon=_free_port(),
        )
        (self.folder / "slurm.conf").write_text(text)
        if (
            not any(Path("/sys/fs/cgroup").glob("*")) and _version() >= 24
        ):  # these do not start without, unless told
            (self.folder / "cgroup.conf").write_text("CgroupPlugin=disabled\n")
        for command in (["slurmctld", "-D", "-i"], ["slurmd", "-D"]):
            log = open(self.folder / f"{command[0]}.log", "wb")  # noqa: SIM115 - the daemon's own
            with log:
                self._daemons.append(
                    subprocess.Popen(
                        [_program(command[0]), *command[1:]],
                        env={**os.environ, **self.environment},
                        stdin=subprocess.DEVNULL,
                        stdout=log,
                        stderr=subprocess.STDOUT,
                    )
                )
        self.wait_until(lambda: self.run("sinfo", "-h", "-o", "%T").strip() == "idle", "no node came up")

    def run(self, *command):
        return process.run(command, self.environment, _SECONDS).stdout

    def wait_until_empty(self):
        self.wait_until(lambda: not self.run("squeue", "-h").strip(), "the queue does not become empty")

    def wait_until(self, done, sentence):
        """Raises RuntimeError with the sentence and what the daemons said, when they end or time is over."""
        end = time.monotonic() + _SECONDS
        while not done():
            if time.monotonic() > end or any(daemon.poll() is not None for daemon in self._daemons):
                logs = "\n".join(log.read_text(errors="replace")[-2000:] for log in self.folder.glob("*.log"))
                raise RuntimeError(f"{sentence}:\n{self.run('squeue')}\n{logs}")
            time.sleep(0.1)

    def stop(self):
        """The node first: what it runs ends with it."""
        for daemon in reversed(self._daemons):
            daemon.terminate()
            daemon.wait()
        shutil.rmtree(self.folder, ignore_errors=True)


def _free_port():
    with socket.socket() as found:
        found.bind(("127.0.0.1", 0))
        return found.getsockname()[1]
