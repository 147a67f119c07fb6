"""What a file of tests found: FOLDER/report.json. No Blender is needed to import this."""

import json
import os
import time
from typing import NamedTuple

FILE = "report.json"
PASSED, FAILED, SKIPPED = "passed", "failed", "skipped"


class Test(NamedTuple):
    name: str
    outcome: str  # PASSED, FAILED or SKIPPED
    seconds: float = 0.0
    processor: float = 0.0  # seconds of all threads, and of child processes that have ended
    reason: str = ""  # why it was skipped, or failed if that fits a sentence


class Clock:
    """What a test takes, from here on."""

    def __init__(self):
        self._start, self._processor = time.monotonic(), sum(os.times()[:4])

    def read(self):
        """Seconds, and those of the processor."""
        return time.monotonic() - self._start, sum(os.times()[:4]) - self._processor


def write(folder, tests):
    """How many failed. Written atomically: where the file is, the tests have ended."""
    counts = {
        outcome: sum(test.outcome == outcome for test in tests) for outcome in (PASSED, FAILED, SKIPPED)
    }
    partial = folder / f"{FILE}.partial"
    partial.write_text(json.dumps({**counts, "tests": [test._asdict() for test in tests]}))
    os.replace(partial, folder / FILE)
    return counts[FAILED]


def read(folder):
    """The list of tests; None without a whole report."""
    try:
        return [Test(**test) for test in json.loads((folder / FILE).read_text())["tests"]]
    except (OSError, ValueError, KeyError, TypeError):
        return None
