"""The frame program beside a Blender that is none: what it makes of how that ends, and of other runs."""

from __future__ import annotations

import os
import signal
import subprocess
import sys

import numpy as np
import pytest
from conftest import ROOT
from farm import blender, frame, job, status

_MODELS = {"velour.version": "0.1.0", "velour.models": "{}"}


@pytest.fixture
def task(tmp_path) -> job.Job:
    """A job of two frames. Its Blender is what _blender_that() makes."""
    made = job.Job(
        blend=str(tmp_path / "shot.blend"),
        blend_state=[1, 2],
        name="shot",
        format="OPEN_EXR",
        velour="0.1.0",
        models={},
        frames=[1, 2],
        tasks=2,
        blender=str(tmp_path / "blender"),
        folder=tmp_path / "frames/farm",
    )
    made.save()
    return made


def _blender_that(task, script):
    path = task.output.parent / "blender"
    path.write_text(f"#!/bin/sh\n{script}\n")
    path.chmod(0o755)


def _run(task, *arguments):
    task.save()
    return frame.main([str(task.folder / "job.json"), *arguments])


def test_out_of_time_is_not_failed(task, capsys):
    """Nor is it done. What failed beside it is what the status says."""
    stopped = (
        "Stopped at sample 64 of 400; 0002.exr has what there is, and the same command goes on from there."
    )
    _blender_that(
        task, f'case "$*" in *"-f 1 "*) echo "Error: no lamp.";; *) echo "Error: {stopped}";; esac; exit 1'
    )
    task.failure(job.Unit(2)).write_text("An attempt before.\n")
    assert _run(task, "--frames", "2") == frame.UNFINISHED
    assert "frame 2: ended by the .blend's own time limit" in capsys.readouterr().err
    now = status.look(task)
    assert (now.failed, now.left, now.code) == ({}, [1, 2], status.UNFINISHED)
    assert _run(task, "--frames", "1-2") == frame.FAILED
    now = status.look(task)
    assert (list(now.failed), now.left) == ([1], [2])
    assert "no lamp" in now.failed[1]


def test_an_error_after_the_time_limit_has_failed(task):
    _blender_that(task, 'echo "Error: Stopped at sample 8 of 9; x"; echo "Error: no space"; exit 1')
    assert _run(task, "--frames", "1") == frame.FAILED
    assert "no space" in status.look(task).failed[1]


# A batch engine that ends the program right after it has started Blender.
_ENGINE = """
import os, signal, subprocess, sys
from farm import frame

start = subprocess.Popen

def started(*arguments, **options):
    child = start(*arguments, **options)
    print(child.pid, flush=True)
    os.kill(os.getpid(), signal.SIGTERM)
    return child

subprocess.Popen = started
sys.exit(frame.main(sys.argv[1:]))
"""


def test_ended_while_blender_starts(task):
    """No Blender goes on alone."""
    _blender_that(task, "exec sleep 60")
    done = subprocess.run(
        [sys.executable, "-c", _ENGINE, task.folder / "job.json", "--frames", "1-2"],
        env={**os.environ, "PYTHONPATH": str(ROOT / "scripts/lib")},
        capture_output=True,
        text=True,
    )
    (child,) = map(int, done.stdout.split())
    try:
        os.kill(child, signal.SIGKILL)
        pytest.fail("Blender still runs")
    except ProcessLookupError:
        pass
    assert done.returncode == frame.UNFINISHED, done.stderr
    assert "frame 1: ended by SIGTERM" in done.stderr
    assert status.look(task).failed == {}


def test_nothing_is_started_after_sigterm(task, monkeypatch, tmp_path):
    """The last part of a frame ended well; its picture is the next run's."""
    monkeypatch.setattr(blender, "stopped", type(blender.stopped)())
    blender.stopped.set()
    assert blender.execute(["touch", str(tmp_path / "started")], tmp_path / "log") == -signal.SIGTERM
    assert not (tmp_path / "started").exists()
    assert _run(task, "--frames", "1") == frame.UNFINISHED


@pytest.fixture
def shared(task):
    """A frame whose parts are all there: any task may make the picture."""
    task.parts = 2
    task.film(1).mkdir(parents=True)
    (task.film(1) / "shot.0-64.exr").touch()
    for unit in task.parts_of(1):
        task.part_done(unit).touch()
    return task


def test_two_make_the_picture(shared, tmp_path):
    """The other one was first: its Velour has removed the film, and it is still looking at its picture."""
    from velour.native import images

    good = tmp_path / "good.exr"
    images.write_part(good, np.ones((4, 6, 4), np.float32), images.Frame(6, 4), _MODELS)
    name = f"(sleep 1; mv '{good}' '{shared.picture(1)}') &"
    _blender_that(shared, f"rm '{shared.film(1)}'/*.exr\n{name}\necho 'Error: shot.0-64.exr is gone'; exit 1")
    assert _run(shared, "--frames", "1", "--part", "2") == frame.DONE
    assert status.look(shared).done == [1]
    assert list((shared.folder / "failed").iterdir()) == []


def test_another_run_that_was_killed(shared, monkeypatch):
    """It had removed the film, and left no picture: the frame is left, and begins anew."""
    monkeypatch.setattr(frame, "_ANOTHER_SECONDS", 0)
    _blender_that(shared, f"rm '{shared.film(1)}'/*.exr; echo 'Error: shot.0-64.exr is gone'; exit 1")
    assert _run(shared, "--frames", "1", "--part", "2") == frame.UNFINISHED
    assert status.look(shared).left == [1, 2]
    _blender_that(shared, "echo 'Error: no space'; exit 1")
    assert _run(shared, "--frames", "1", "--part", "2") == frame.FAILED


def test_nodes_with_the_same_process_id(tmp_path, monkeypatch):
    """They write the same file of a folder that they share, one while the other one does."""
    path, replace, begun = tmp_path / "0001.txt", os.replace, []

    def interrupted(source, target):
        begun.append(source)
        if len(begun) == 1:
            job.replace_text(path, "of the other one")
        replace(source, target)

    monkeypatch.setattr(os, "replace", interrupted)
    job.replace_text(path, "of this one")
    assert path.read_text() == "of this one"
    assert list(tmp_path.iterdir()) == [path]


def test_what_killed_runs_leave_is_read_by_nobody(task, monkeypatch):
    for folder, name in ((task.folder, "job.json"), (task.folder / "failed", "0001.txt")):
        (folder / f".{name}.node-1").write_text("half a")
    assert job.load(task.output) == task
    assert status.look(task).failed == {}

    def full(_source, _target):
        raise OSError("no space")

    before = sorted(task.folder.iterdir())
    monkeypatch.setattr(os, "replace", full)
    with pytest.raises(OSError, match="no space"):
        task.save()
    assert sorted(task.folder.iterdir()) == before
