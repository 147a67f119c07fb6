"""The frame program beside a Blender that is none: what it makes of how that ends, and of other runs."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from conftest import ADDONS
from velour.farm import blender, frame, job, sources, status

_STAMPS = {"velour.version": "0.1.0", "velour.blender": "3.4.1", "velour.models": "{}"}
# What a Blender does that is none: out is where its picture goes, without number and extension.
_OUT = 'while [ $# -gt 0 ]; do [ "$1" = -o ] && out=${2%%#*}; shift; done\n'
_PROGRAM = "import sys; from velour.farm import frame; sys.exit(frame.main(sys.argv[1:]))"


@pytest.fixture
def task(tmp_path) -> job.Job:
    """A job of two frames. Its Blender is what _blender_that() makes."""
    blend = tmp_path / "shot.blend"
    blend.write_text("a scene")
    made = job.Job(
        blend=str(blend),
        blend_hash=sources.sha256(blend),
        libraries={},
        name="shot",
        format="OPEN_EXR",
        velour="0.1.0",
        blender_version="3.4.9",
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
        "Stopped at sample 64 of 400; 0002.exr has the samples so far."
        " Run the same command again to continue."
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
from velour.farm import frame

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
        env={**os.environ, "PYTHONPATH": str(ADDONS)},
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
def good(tmp_path) -> Path:
    """A picture of any frame of the job."""
    from velour.native import images

    path = tmp_path / "good.exr"
    images.write_part(path, np.ones((4, 6, 4), np.float32), images.Frame(6, 4), _STAMPS)
    return path


@pytest.fixture
def shared(task):
    """A frame whose parts are all there: any task may make the picture."""
    task.parts = 2
    task.film(1).mkdir(parents=True)
    (task.film(1) / "shot.0-64.exr").touch()
    for unit in task.parts_of(1):
        task.part_done(unit).touch()
    return task


def test_a_picture_of_some_samples_is_no_frame(task, good, tmp_path):
    from velour.native import images

    part = tmp_path / "part.exr"
    stamps = {**_STAMPS, "velour.samples": "0:64"}
    images.write_part(part, np.ones((4, 6, 4), np.float32), images.Frame(6, 4), stamps)
    assert frame.problem(task, good) == ""
    assert "it has the samples 0:64 alone" in frame.problem(task, part)


def test_two_make_the_picture(shared, good):
    """The other one was first: it named its picture, and cleared away what there was of the frame."""
    taken = f"mv '{good}' '{shared.picture(1)}'; rm -r '{shared.film(1)}'"
    _blender_that(shared, f"{taken}; echo 'Error: shot.0-64.exr is gone'; exit 1")
    assert _run(shared, "--frames", "1", "--part", "2") == frame.DONE
    assert status.look(shared).done == [1]
    assert list((shared.folder / "failed").iterdir()) == []


def test_film_stays_until_the_picture_is_looked_at(shared):
    """A full disk, of which Blender says nothing."""
    _blender_that(shared, "exit 0")
    assert _run(shared, "--frames", "1", "--part", "2") == frame.FAILED
    assert "--velour-keep-parts" in blender.render(shared, job.Unit(1), shared.partial(1) / "picture_")
    assert (shared.film(1) / "shot.0-64.exr").exists()


def test_ended_while_blender_writes(task, good):
    """The picture is whole: it is taken, and nothing else begins."""
    _blender_that(task, f'{_OUT}cp "{good}" "$out"0001.exr; kill -TERM $PPID; exec sleep 60')
    done = subprocess.run(
        [sys.executable, "-c", _PROGRAM, task.folder / "job.json", "--frames", "1-2"],
        env={**os.environ, "PYTHONPATH": str(ADDONS)},
        capture_output=True,
        text=True,
    )
    assert done.returncode == frame.UNFINISHED, done.stderr
    now = status.look(task)
    assert (now.done, now.left) == ([1], [2])


def test_a_blend_that_changed(task, good, capsys):
    """Before the frame, and while it is rendered: neither becomes part of the sequence."""
    blend = Path(task.blend)
    picture = f'{_OUT}cp "{good}" "$out"0001.exr'
    _blender_that(task, f'{picture}; echo more >> "{blend}"')
    assert _run(task, "--frames", "1") == frame.FAILED
    assert f"{blend} changed since the job was made" in capsys.readouterr().err
    _blender_that(task, f'{picture}; touch "{task.folder / "started"}"')
    assert _run(task, "--frames", "1") == frame.FAILED
    assert not (task.folder / "started").exists()
    blend.write_text("a scene")
    assert _run(task, "--frames", "1") == frame.DONE
    blend.unlink()
    assert "cannot be read (No such file or directory)" in sources.changed(task)


def test_a_library_that_changed(task):
    """Those beside the .blend are looked for beside the node's."""
    library = Path(task.blend).parent / "props/lib.blend"
    library.parent.mkdir()
    library.write_text("props")
    absolute = Path(task.blend).with_name("set.blend")
    absolute.write_text("a set")
    task.libraries = sources.libraries(task.blend, ["props/lib.blend", str(absolute)])
    assert sources.changed(task) == ""
    library.write_text("others")
    assert f"{library} changed" in sources.changed(task)
    with pytest.raises(job.JobError, match=r"gone\.blend cannot be read .* bring it back"):
        sources.libraries(task.blend, ["gone.blend"])


def test_a_failure_that_cannot_be_noted(task, monkeypatch, capsys):
    """The task's other frames are rendered all the same."""

    def full(_path, _text):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(job, "replace_text", full)
    _blender_that(task, "echo Error: no lamp; exit 1")
    assert frame.main([str(task.folder / "job.json"), "--frames", "1-2"]) == frame.FAILED
    said = capsys.readouterr().err
    assert said.count("no lamp") == 2
    assert said.count("cannot be written (No space left on device)") == 2


def test_another_blender(task, good):
    """Corrections of a release are no other one."""
    assert frame.problem(task, good) == ""
    task.blender_version = "4.3.2"
    assert frame.problem(task, good) == "Blender 3.4.1 rendered it, the job is for 4.3.2"


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
