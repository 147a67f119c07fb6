"""Blender as the tests use it: the add-on, folders, child processes."""

import contextlib
import ctypes
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
from pathlib import Path

import addon_utils
import bpy

from . import process

ADDON = "velour"
_folder = Path("/nowhere")
# For --python-expr: writing a file fails beyond 256 bytes, as on a full disk.
FULL_DISK = (
    "import resource, signal; signal.signal(signal.SIGXFSZ, signal.SIG_IGN);"
    " resource.setrlimit(resource.RLIMIT_FSIZE, (256, 256))"
)
_CHILD_SECONDS = 300  # only ends processes that hang, on however busy a machine


def set_folder(folder):
    global _folder
    _folder = folder


def folder():
    return _folder


def enable_addon():
    if addon_utils.enable(ADDON, default_set=True) is None:
        raise RuntimeError(f"the add-on {ADDON} cannot be enabled")


def library_file():
    return Path(os.environ["VELOUR_STAGE"]) / "addons" / ADDON / "lib/libvelour.so"


def child_command(*arguments, addons=True):
    command = [bpy.app.binary_path, "-b", "--factory-startup"]
    if addons:
        command += ["--addons", ADDON]
    return [*command, *map(str, arguments)]


def run_blender(*arguments, addons=True, environment=None, seconds=_CHILD_SECONDS):
    """A headless Blender of its own: CompletedProcess with both outputs as one text."""
    return process.run(child_command(*arguments, addons=addons), environment, seconds)


def interrupt_blender(*arguments, after):
    """As run_blender, but sends Ctrl-C once the output holds `after`. Also says how long the end took."""
    return interrupt(child_command(*arguments), after)


def interrupt(command, after):
    """(exit status, output, seconds from Ctrl-C to the end or None)"""
    child = subprocess.Popen(
        command,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        errors="replace",
    )
    watchdog = threading.Timer(_CHILD_SECONDS, child.kill)
    watchdog.start()
    lines, sent = [], None
    try:
        for line in child.stdout:
            lines.append(line)
            if sent is None and after in line:
                sent = time.monotonic()
                child.send_signal(signal.SIGINT)
        return child.wait(), "".join(lines), time.monotonic() - sent if sent else None
    finally:
        watchdog.cancel()


@contextlib.contextmanager
def printed():
    """Yields a function that returns what this process has printed since, Blender itself included."""

    def flush():
        sys.stdout.flush()
        ctypes.CDLL(None).fflush(None)

    with tempfile.TemporaryFile("w+", errors="replace") as file:
        flush()
        kept = os.dup(1)
        os.dup2(file.fileno(), 1)

        def said():
            flush()
            file.seek(0)
            return file.read()

        try:
            yield said
        finally:
            text = said()
            os.dup2(kept, 1)
            os.close(kept)
            print(text, end="")


class BlenderTest(unittest.TestCase):
    """Starts from an empty file. `self.folder` is kept when the test fails."""

    def setUp(self):
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        if not hasattr(bpy.types.Scene, "velour"):
            enable_addon()
        self.folder = folder() / self.id().rpartition(".")[2]
        self.folder.mkdir(parents=True, exist_ok=True)
        self._failures_before = self._failures()

    def tearDown(self):
        if self._failures() == self._failures_before:
            shutil.rmtree(self.folder, ignore_errors=True)

    def _failures(self):
        result = self._outcome.result
        return len(result.failures) + len(result.errors)

    def assert_close(self, value, expected, tolerance, message=""):
        self.assertLessEqual(
            abs(value - expected), tolerance, f"{message} {value} is not {expected} +- {tolerance}"
        )
