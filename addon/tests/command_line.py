"""Runs the command line: in this process, or in one of its own for what only a process has."""

from __future__ import annotations

import contextlib
import io
import json
import os
import re
import signal
import subprocess
import sys
from collections.abc import Iterator
from typing import NamedTuple

from conftest import ADDONS

_INTERRUPTED = 130


class Result(NamedTuple):
    status: int
    out: str
    err: str

    @property
    def json(self) -> dict:
        """The one object on stdout of a call that went well."""
        assert self.status == 0, self.err
        return json.loads(self.out)


def velour(*arguments, **env) -> Result:
    """Calls main() in this process, which has the library loaded: no process start for each call.

    program() is for what only a process has: signals, the exit status, its memory, what the library prints.
    """
    from velour.core.cli.main import main

    out, err = io.StringIO(), io.StringIO()
    words = list(map(str, arguments))
    with _isolated(env, "--simd" in words), contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        try:
            status = main(words)
        except SystemExit as left:  # argparse: wrong usage, --help, --version
            status = left.code
    if status == _INTERRUPTED:  # Ctrl-C was meant for the tests
        raise KeyboardInterrupt
    return Result(status, out.getvalue(), err.getvalue())


@contextlib.contextmanager
def _isolated(env: dict[str, str], pins_simd: bool) -> Iterator[None]:
    """Takes back what main() changes in its process: the log, and the instruction set that --simd pins."""
    from velour.core.cli import output
    from velour.native import library

    log, before = output.log, dict(os.environ)
    handlers, level, propagate = log.handlers[:], log.level, log.propagate
    os.environ.update(env)
    try:
        yield
    finally:
        os.environ.clear()
        os.environ.update(before)
        log.handlers[:], log.propagate = handlers, propagate
        log.setLevel(level)
        if pins_simd:
            library.select_simd("auto")


def program(*arguments, **env) -> Result:
    """Runs the command line in a process of its own."""
    done = subprocess.run(
        command(*arguments), capture_output=True, text=True, timeout=300, env=environment(**env)
    )
    return Result(done.returncode, done.stdout, done.stderr)


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


def refused(*arguments, run=velour, **env) -> str:
    """The sentence of a call that must fail with status 1: one line on stderr, nothing on stdout."""
    status, out, err = run(*arguments, **env)
    assert (status, out) == (1, ""), err
    lines = err.strip().splitlines()
    assert len(lines) == 1, err
    return lines[0]
