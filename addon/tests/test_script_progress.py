"""What scripts tell while something takes long: with_progress of common.sh, and Progress in Python."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
import time

import pytest
from bench import progress
from command_line import hear_ctrl_c
from conftest import ROOT

_SCRIPT = f". {ROOT}/scripts/lib/common.sh; progress_interval=1; "
_NINJA_LOG = """[1/345] Building CXX object a.o
[12/345] Building CXX object b.o
b.cpp:3: warning: [99/100] is no progress
"""
_APT_LOG = """Reading package lists...
1 upgraded, 2 newly installed, 0 to remove and 132 not upgraded.
Get:1 http://deb.debian.org/debian bookworm/main amd64 liba amd64 1.0 [7 kB]
Get:2 http://deb.debian.org/debian bookworm/main amd64 libb amd64 1.0 [7 kB]
"""


def _start(script: str, cwd) -> subprocess.Popen:
    """In a process group of its own, as a shell with job control starts it."""
    return subprocess.Popen(
        ["bash", "-c", _SCRIPT + script, "name"],
        cwd=cwd,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
        preexec_fn=hear_ctrl_c,
    )


def _run(script: str, cwd) -> tuple[int, str, str]:
    process = _start(script, cwd)
    return *reversed(process.communicate(timeout=300)), process.returncode


def test_tells_stage_done_total_and_seconds_left(tmp_path):
    log = r"for i in 1 2 3 4; do echo \"[\$i/4] Building\"; sleep 0.8; done"
    script = f'with_progress building count_ninja log/it bash -c "{log}"; echo after'
    err, out, status = _run(script, tmp_path)
    assert (status, err) == (0, "")
    *lines, done, after = out.splitlines()
    assert lines  # how many depends on how busy the machine is
    for line in lines:
        assert re.fullmatch(r"\[ *[1-4]/4\] building: \d+ s, about \d+ s left", line), line
    assert (re.sub(r"\d+", "N", done), after) == ("building: done after N s", "after")
    assert (tmp_path / "log/it").read_text().endswith("[4/4] Building\n")


def test_says_nothing_of_what_is_soon_done(tmp_path):
    assert _run("progress_interval=30; quietly log nothing true", tmp_path) == ("", "", 0)


def test_a_failure_shows_the_log_and_ends_the_script(tmp_path):
    script = "quietly log building bash -c 'echo fine; echo its error; exit 3'; echo after"
    err, out, status = _run(script, tmp_path)
    assert (status, out) == (1, "")
    assert err.splitlines() == ["its error", "name: building failed; the whole log: log"]


def test_a_failure_may_be_the_callers(tmp_path):
    script = "try_with_progress a count_nothing log bash -c 'exit 3' || echo $?"
    assert _run(script, tmp_path) == ("", "3\n", 0)


@pytest.mark.parametrize(("number", "status"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
@pytest.mark.parametrize("send", [os.killpg, os.kill], ids=["group", "script alone"])
def test_a_signal_ends_the_program_first(tmp_path, number, status, send):
    program = "trap 'echo ended >>ended; exit' INT TERM; touch started; while true; do sleep 0.1; done"
    process = _start(f'quietly log building bash -c "{program}"', tmp_path)
    _wait_for(tmp_path / "started")
    send(process.pid, number)
    _out, err = process.communicate(timeout=120)
    assert (process.returncode, err) == (status, "name: stopped while building\n")
    assert (tmp_path / "ended").is_file()
    with pytest.raises(ProcessLookupError):
        os.killpg(process.pid, 0)


def _wait_for(path) -> None:
    deadline = time.monotonic() + 30
    while not path.exists():
        assert time.monotonic() < deadline
        time.sleep(0.05)


def test_traps_of_the_script_are_kept(tmp_path):
    script = "trap 'echo mine' INT; quietly log a true; trap -p INT"
    assert _run(script, tmp_path) == ("", "trap -- 'echo mine' SIGINT\n", 0)


@pytest.mark.parametrize(
    ("counter", "log", "counted"),
    [
        ("count_ninja", "", ""),
        ("count_ninja", _NINJA_LOG, "12 345"),
        ("count_apt", "Reading package lists...\n", ""),
        ("count_apt", _APT_LOG, "2 9"),
        # One of three was fetched before.
        ("count_apt", _APT_LOG + "Unpacking liba (1.0) ...\nUnpacking libb (1.0) ...\n", "4 8"),
        ("count_apt", _APT_LOG + "Unpacking a ...\n" * 3 + "Setting up a (1.0) ...\n" * 3, "8 8"),
    ],
)
def test_counters(tmp_path, counter, log, counted):
    (tmp_path / "log").write_text(log)
    assert _run(f"{counter} log", tmp_path)[1].split() == counted.split()


# The same in Python.


@pytest.fixture
def soon(monkeypatch):
    monkeypatch.setattr(progress, "_LINE_SECONDS", 0.1)


def _plain(text: str) -> list[str]:
    return [re.sub(r"\d+\.\d s|\d+ s", "N s", line) for line in text.splitlines()]


def test_work_that_goes_on_is_told(capsys, soon):
    work = progress.Progress(rate=1.0)
    work.expect(10.0, 2)
    with work.work("first", 10.0):
        time.sleep(0.35)
    lines = _plain(capsys.readouterr().out)
    assert len(lines) == 4
    assert set(lines[:3]) == {"[  0/2] first: N s, about N s left"}
    assert lines[3] == "[  1/2] first: N s, about N s left"


def test_the_time_left_shrinks_while_work_goes_on(capsys, soon):
    work = progress.Progress(rate=1.0)
    work.expect(2.0, 2)
    with work.work("first", 2.0):
        time.sleep(1.25)
    left = [int(re.search(r"about (\d+) s", line)[1]) for line in capsys.readouterr().out.splitlines()[:-1]]
    assert (left[0], left[-1]) == (4, 3)


def test_nothing_is_told_of_work_that_has_failed(capsys, soon):
    work = progress.Progress()
    with pytest.raises(RuntimeError), work.work("it", 1.0):
        raise RuntimeError
    time.sleep(0.2)
    assert capsys.readouterr().out == ""


def test_a_terminal_has_one_line_that_changes(capsys, monkeypatch):
    monkeypatch.setattr(sys.stdout, "isatty", lambda: True)
    work = progress.Progress()
    work.expect(1.0)
    with work.work("it", 1.0):
        time.sleep(1.1)
    assert _plain(capsys.readouterr().out.replace("\r\x1b[K", "|")) == ["|[  0/1] it: N s|[  1/1] it: N s"]
