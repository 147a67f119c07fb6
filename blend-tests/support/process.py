"""A Blender process, run to its end or to a time limit. No Blender is needed to import this."""

import contextlib
import os
import signal
import subprocess
from pathlib import Path

# What Python compiles of the add-on, once for all processes: it takes as long as Blender itself to start.
_BYTECODE = Path(__file__).resolve().parents[2] / "build/bytecode"

_running = set()  # that have been started and not stopped


def environment(blender, stage=None):
    """`stage`: a folder of scripts that Blender takes in place of the user's own."""
    found = dict(os.environ, PYTHONPYCACHEPREFIX=str(_BYTECODE), LIBGL_ALWAYS_SOFTWARE="1")
    found.pop("PYTHONDONTWRITEBYTECODE", None)
    if stage:
        found.update(BLENDER_USER_SCRIPTS=str(stage), VELOUR_STAGE=str(stage))
    # A distribution's Blender looks for its Python along PATH: not a version manager's, please.
    found["PATH"] = os.pathsep.join((str(Path(blender).resolve().parent), found["PATH"]))
    return found


def run(command, variables=None, seconds=None):
    """CompletedProcess with both outputs as one text."""
    return subprocess.run(
        [str(part) for part in command],
        env={**os.environ, **(variables or {})},
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        errors="replace",
        timeout=seconds,
        check=False,
    )


def execute(command, variables, log, seconds):
    """The exit status; None when it took too long. All output is in `log`. Its own children go with it."""
    with log.open("wb") as output:
        process = start(command, variables, stdin=subprocess.DEVNULL, stdout=output, stderr=subprocess.STDOUT)
        try:
            return process.wait(seconds)
        except subprocess.TimeoutExpired:
            output.write(f"\nkilled after {seconds} s\n".encode())
            return None
        finally:
            stop(process)


def start(command, variables, **streams):
    """A process that stop() ends together with its children."""
    process = subprocess.Popen(command, env=variables, start_new_session=True, **streams)
    _running.add(process)
    return process


def stop(process):
    """Ends a process of start() and its children."""
    _kill(process)
    process.wait()
    _running.discard(process)


def stop_all():
    """Ends what other threads wait for."""
    for process in list(_running):
        _kill(process)


def _kill(process):
    with contextlib.suppress(ProcessLookupError):
        os.killpg(process.pid, signal.SIGKILL)
