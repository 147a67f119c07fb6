"""Seconds since this process was started, loading and all. No Blender is needed to import this."""

import os
import time
from pathlib import Path

_START_FIELD = 19  # of /proc/PID/stat behind the name of the program: clock ticks from boot to start


class Stopwatch:
    """Runs from the start of the process, or from restart()."""

    def __init__(self):
        self._start = time.monotonic() - _age()

    def restart(self):
        self._start = time.monotonic()

    def seconds(self):
        return time.monotonic() - self._start


def _age():
    """Seconds since the start of this process."""
    fields = Path("/proc/self/stat").read_text().rpartition(")")[2].split()
    uptime = float(Path("/proc/uptime").read_text().split()[0])
    return uptime - int(fields[_START_FIELD]) / os.sysconf("SC_CLK_TCK")
