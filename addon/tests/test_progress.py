"""How the command line tells how far a job is."""

from __future__ import annotations

import argparse
import io
import logging
import sys

import pytest
from velour.core.cli import info, main, output
from velour.core.cli.progress import ProgressBar, ProgressLines
from velour.native.job_state import JobState


def state(seconds: float, running: bool = True) -> JobState:
    return JobState("running" if running else "done", seconds / 40, "rendering", seconds, 40 - seconds, 0)


def tell(progress, *states: JobState) -> None:
    for each in states:
        progress(each)


def test_lines_of_a_log_are_ten_seconds_apart(caplog):
    caplog.set_level(logging.INFO, "velour-test")
    times = [tenth / 10 for tenth in range(400)]
    tell(ProgressLines(logging.getLogger("velour-test")), *map(state, times), state(40, running=False))
    assert caplog.messages == [
        " 25% rendering, 30 s left",
        " 50% rendering, 20 s left",
        " 75% rendering, 10 s left",
    ]


def test_the_bar_is_wiped_at_the_end():
    stream = io.StringIO()
    tell(ProgressBar(stream), state(20), state(40, running=False))
    _, half, end = stream.getvalue().split("\r\x1b[K")
    assert half == "[###############...............]  50% rendering, 20 s left"
    assert end == ""


@pytest.fixture
def kept_log():
    """The command line sets up the log of its process, which here is that of all tests."""
    before = list(output.log.handlers), output.log.propagate, output.log.level
    yield
    output.log.handlers[:], output.log.propagate, level = before
    output.log.setLevel(level)


def test_the_bar_is_wiped_by_ctrl_c(monkeypatch, kept_log):
    """Before the word about it, which would stand behind it."""
    stream = io.StringIO()
    stream.isatty = lambda: True
    monkeypatch.setattr(sys, "stderr", stream)

    def interrupted(args):
        tell(output.progress_of(args), state(20))
        raise KeyboardInterrupt

    monkeypatch.setattr(info, "run", interrupted)
    assert main.main(["info", "x"]) == main.INTERRUPTED
    assert stream.getvalue().endswith(" s left\r\x1b[Kvelour: Interrupted.\n")


@pytest.mark.parametrize(
    ("terminal", "quiet", "level", "said"),
    [
        (True, False, "warning", True),
        (True, True, "info", False),
        (False, False, "info", True),
        (False, False, "warning", False),
        (False, True, "warning", False),
    ],
)
def test_who_is_told_a_line(monkeypatch, kept_log, terminal, quiet, level, said):
    stream = io.StringIO()
    stream.isatty = lambda: terminal
    monkeypatch.setattr(sys, "stderr", stream)
    output.set_up_log(level)
    output.tell(argparse.Namespace(quiet=quiet), "a line.")
    assert stream.getvalue() == ("velour: a line.\n" if said else "")


@pytest.mark.parametrize(
    ("terminal", "quiet", "level", "kind"),
    [
        (True, False, "warning", ProgressBar),
        (True, True, "info", type(None)),
        (False, False, "info", ProgressLines),
        (False, False, "warning", type(None)),
        (False, True, "info", type(None)),
    ],
)
def test_who_is_told(monkeypatch, terminal, quiet, level, kind):
    stream = io.StringIO()
    stream.isatty = lambda: terminal
    monkeypatch.setattr(sys, "stderr", stream)
    before = output.log.level
    output.log.setLevel(level.upper())
    try:
        assert isinstance(output.progress_of(argparse.Namespace(quiet=quiet)), kind)
    finally:
        output.log.setLevel(before)
