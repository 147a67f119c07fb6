"""Runs the command line as a user does: in a process of its own."""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
import sys
from typing import NamedTuple

from conftest import ADDONS


class Result(NamedTuple):
    status: int
    out: str
    err: str

    @property
    def json(self) -> dict:
        """The one object on stdout of a call that went well."""
        assert self.status == 0, self.err
        return json.loads(self.out)


def command(*arguments) -> list[str]:
    return [sys.executable, "-P", "-m", "velour.core.cli", *map(str, arguments)]


def hear_ctrl_c() -> None:
    """For preexec_fn: what a shell starts in the background is deaf to Ctrl-C, and so are its children."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


def undated(page: str) -> str:
    """What a script wrote, to be compared: midnight may come between two runs."""
    return re.sub(r"\b\d{4}-\d\d-\d\d\b", "today", page)


def environment(**more) -> dict:
    return {**os.environ, "PYTHONPATH": str(ADDONS), **more}


def velour(*arguments, cwd=None, **env) -> Result:
    done = subprocess.run(
        command(*arguments), capture_output=True, text=True, timeout=300, cwd=cwd, env=environment(**env)
    )
    return Result(done.returncode, done.stdout, done.stderr)


def refused(*arguments, **env) -> str:
    """The sentence of a call that must fail with status 1: one line on stderr, nothing on stdout."""
    status, out, err = velour(*arguments, **env)
    assert (status, out) == (1, ""), err
    lines = err.strip().splitlines()
    assert len(lines) == 1, err
    return lines[0]
