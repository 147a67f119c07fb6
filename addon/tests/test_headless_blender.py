"""How scripts run Blender, with a program in its place."""

from __future__ import annotations

import os
import signal
import subprocess

import pytest
from bench import blender as headless
from bench import inside


@pytest.fixture
def blender(tmp_path, monkeypatch):
    """Writes the program that is found as Blender."""

    def write(script: str) -> None:
        program = tmp_path / "blender"
        program.write_text(f"#!/bin/bash\n{script}\n")
        program.chmod(0o755)

    monkeypatch.setenv("PATH", str(tmp_path), prepend=":")
    return write


def test_its_lines_are_kept(blender, tmp_path):
    blender("echo said; echo warned >&2; echo ${@: -1}")
    assert headless.run("demo", {"size": 3}, tmp_path / "log") is None
    said, warned, script = (tmp_path / "log").read_text().splitlines()
    assert (said, warned) == ("said", "warned")
    assert """bench.inside.start('demo', '{"size": 3}', """ in script


def test_what_a_script_returns_comes_back(tmp_path, monkeypatch):
    monkeypatch.setattr(inside.importlib, "import_module", lambda _name: Doubling)
    inside.start("doubling", '{"size": 3}', str(tmp_path / "report.json"))
    assert (tmp_path / "report.json").read_text() == '{"size": 6}'


class Doubling:
    @staticmethod
    def main(task):
        return {"size": 2 * task["size"]}


def test_its_failure_is_told_with_the_end_of_the_log(blender, tmp_path):
    blender("echo one; echo; echo its reason; exit 7")
    with pytest.raises(headless.BlenderError) as caught:
        headless.run("demo", {}, tmp_path / "log")
    assert str(caught.value) == f"Blender failed with status 7; {tmp_path}/log ends: one / its reason"


def test_it_does_not_outlive_ctrl_c(blender, tmp_path):
    blender(f"trap '' INT; echo $$; (sleep 1; kill -INT {os.getpid()}) & exec sleep 60")
    former = signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell's background ignores Ctrl-C
    try:
        with pytest.raises(KeyboardInterrupt):
            headless.run("demo", {}, tmp_path / "log")
    finally:
        signal.signal(signal.SIGINT, former)
    process = (tmp_path / "log").read_text().strip()
    assert subprocess.run(["ps", "-p", process], stdout=subprocess.DEVNULL).returncode == 1
