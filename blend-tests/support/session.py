"""Blenders that run files of tests one after the other. No Blender is needed to import this."""

import os
import selectors
import shutil
import subprocess
import tempfile
import time
from pathlib import Path

from . import process

_HARNESS = Path(__file__).resolve().parent / "harness.py"
USUAL_SCREEN = "1000x600"  # each pixel costs time to draw
_START_SECONDS = 60


class Screen:
    """An X server that nobody sees; it takes the first display that is free. `size`: WIDTHxHEIGHT."""

    def __init__(self, size):
        self.size = size
        self._folder = tempfile.TemporaryDirectory(prefix="velour-screen-")
        receiving, sending = os.pipe()
        # It writes the number of its display as soon as it takes clients.
        options = ["-displayfd", str(sending), "-screen", "0", f"{size}x24", "-fbdir", self._folder.name]
        self._server = process.start(
            ["Xvfb", *options, "-nolisten", "tcp"],
            dict(os.environ),
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            pass_fds=(sending,),
        )
        os.close(sending)
        with os.fdopen(receiving) as answer:
            number = answer.readline().strip()
        if not number:
            self.close()
            raise RuntimeError("Xvfb does not start")
        self.variables = {"DISPLAY": f":{number}", "VELOUR_SCREEN": self._folder.name}

    def close(self):
        process.stop(self._server)
        self._folder.cleanup()


class Session:
    """One Blender, started for the first file, and again for another screen and after a file that needs a
    process of its own, dies or takes too long."""

    def __init__(self, blender, stage):
        self._blender, self._stage = blender, stage
        self._screen = self._process = None

    def run(self, path, folder, seconds, alone=False, screen=None):
        """Runs a file of tests. None, or what went wrong with the process itself. `screen`: its size; None:
        there is no window."""
        if alone or screen != (self._screen and self._screen.size):
            self.close()
        if screen and self._screen is None:
            self._screen = Screen(screen)
        if self._process is None:
            self._start(folder)
        try:
            self._process.stdin.write(f"{path}\t{folder}\n".encode())
            self._process.stdin.flush()
        except BrokenPipeError:
            pass  # told below, as its end
        trouble = self._answer(seconds)
        if alone or trouble:
            self.close(wait=not trouble)
        return trouble

    def close(self, wait=True):
        """Lets it leave by itself, or not."""
        if self._process is not None:
            self._end(wait)
        if self._screen is not None:
            self._screen.close()
            self._screen = None

    def _end(self, wait):
        running, self._process = self._process, None
        try:
            running.stdin.close()
            if wait:
                running.wait(_START_SECONDS)
        except (BrokenPipeError, subprocess.TimeoutExpired):
            pass
        finally:
            running.stdout.close()
            process.stop(running)

    def _start(self, folder):
        variables = process.environment(self._blender, self._stage)
        command = [self._blender, "--factory-startup"]
        if self._screen:
            variables |= self._screen.variables
            command += ["--window-geometry", "0", "0", *self._screen.size.split("x")]
        else:
            # Windows go first: their tests type and wait.
            command = ["nice", "-n", "15", *command, "-b"]
        command += ["--python-exit-code", "1", "--python", str(_HARNESS), "--", "--orders"]
        with (folder / "start.txt").open("wb") as errors:
            self._process = process.start(
                command, variables, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=errors
            )

    def _answer(self, seconds):
        """Waits for the end of a file: None, or what ended the process before."""
        end = time.monotonic() + seconds
        output = self._process.stdout.fileno()
        said = b""
        with selectors.DefaultSelector() as selector:
            selector.register(output, selectors.EVENT_READ)
            while not said.endswith(b"done\n"):
                if not selector.select(end - time.monotonic()):
                    return f"killed after {seconds} s"
                part = os.read(output, 4096)
                if not part:
                    return f"Blender ended with status {self._process.wait()}"
                said += part
        return None


def has_screens():
    return shutil.which("Xvfb") is not None
