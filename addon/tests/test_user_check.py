"""scripts/velour-check with simulated renders: what it holds, leaves behind and reports."""

from __future__ import annotations

import itertools
import json
import sys
import weakref

import numpy as np
import pytest
from regression import blender, check, page, room, user_check
from test_causes import HEIGHT, WIDTH, Scene
from velour.native import images


class Blender:
    """Renders nothing; check.read_frame() is simulated."""

    def run(self, *_arguments):
        return {"layer": "Layer"}


@pytest.fixture
def shots(tmp_path):
    made = tmp_path / "shots"
    made.mkdir()
    return made


@pytest.fixture
def call(shots, monkeypatch, capsys):
    """Runs velour-check on `shots`: the status and what is said."""
    monkeypatch.setattr(user_check, "_installation", lambda _arguments: Blender())
    seeds = itertools.count()
    monkeypatch.setattr(check, "read_frame", lambda *_: check.Renders(*Scene().renders(next(seeds))))

    def run(*arguments, paths=(shots,)):
        monkeypatch.setattr(sys, "argv", ["velour-check", *map(str, (*paths, *arguments))])
        try:
            status = user_check.main()
        except SystemExit as ended:
            status = ended.code
        said = capsys.readouterr()
        return status, said.out + said.err

    return run


def outcomes(folder):
    found = json.loads((folder / "velour-check/report.json").read_text())["outcomes"]
    return {outcome["name"]: outcome for outcome in found}


def add(folder, *names):
    for name in names:
        folder.mkdir(exist_ok=True)
        (folder / f"{name}.blend").touch()


def test_one_picture_at_a_time_is_held(shots, call, monkeypatch):
    add(shots, "a", "b")
    frames = [part for frame in range(4) for part in ("--frame", frame)]
    held, read = [], check.read_frame

    def counted(*arguments):
        assert not [each for each in held if each() is not None]
        found = read(*arguments)
        held.append(weakref.ref(found.picture.mean))
        return found

    monkeypatch.setattr(check, "read_frame", counted)
    assert call("--update", "--jobs", 1, *frames)[0] == 0
    assert call("--jobs", 1)[0] == 0
    assert len(held) == 16
    assert len(list((shots / "velour-check/pictures").iterdir())) == 8 * 3


def test_renders_are_removed_once_they_are_read(shots, call):
    add(shots, "a", "b")
    assert call("--update")[0] == 0
    images.write(shots / "b.exr", np.zeros((HEIGHT, WIDTH, 4), np.float32))
    assert call()[0] == 1
    assert call("--update")[0] == 1
    assert not list(shots.rglob("renders"))


def test_trouble_with_one_frame_stops_no_other(shots, call, monkeypatch):
    """As a full disk, or a picture larger than the memory."""
    add(shots, "a", "b")
    two = ("--update", "--frame", 1, "--frame", 2)
    assert call(*two)[0] == 0
    write = check.write

    def fails(path, renders):
        if path.name == "a_0001.exr":
            raise MemoryError
        return write(path, renders)

    before = {path: path.read_bytes() for path in shots.glob("*.exr")}
    monkeypatch.setattr(check, "write", fails)
    status, said = call(*two, "--yes", "--junit", "/dev/full")
    assert status == 1
    assert "FAILED: a, frame 1: a.blend: MemoryError" in said
    assert "3 references replaced" in said
    kept = {path.name for path, was in before.items() if path.read_bytes() == was}
    assert kept == {"a_0001.exr", "a_0001.error.exr"}
    assert "No space left" in said
    assert outcomes(shots).keys() == {f"{name}, frame {frame}" for name in "ab" for frame in (1, 2)}


def test_page_without_room_for_pictures(shots, call, monkeypatch):
    add(shots, "a")
    assert call("--update")[0] == 0

    def full(*_arguments):
        raise OSError("No space left on device")

    monkeypatch.setattr(page.images, "write", full)
    status, said = call()
    assert status == 0, said
    assert "Its pictures are not shown: No space left" in (shots / "velour-check/index.html").read_text()


def test_strange_folder_is_left_alone(shots, call, tmp_path):
    add(shots, "a")
    mine = tmp_path / "pictures"
    mine.mkdir()
    for name in ("holiday.png", "report.json"):  # other programs write reports, too
        (mine / name).touch()
    status, said = call("--update", "--output", mine)
    assert status == 2
    assert "name another --output" in said
    assert len(list(mine.iterdir())) == 2


def test_two_runs_do_not_share_a_page(shots, call):
    add(shots, "a")
    assert call("--update")[0] == 0
    with room.take(shots / "velour-check"):
        status, said = call()
    assert (status, "Another run writes to" in said) == (2, True)


@pytest.mark.parametrize("trouble", ["no Blender", "no .blend", "no report"])
def test_no_earlier_report_is_taken_for_one_of_a_refused_run(shots, call, tmp_path, monkeypatch, trouble):
    add(shots, "a")
    report = tmp_path / "reports/report.xml"
    assert call("--update", "--junit", report)[0] == 0
    assert report.is_file()
    if trouble == "no Blender":

        def missing(_arguments):
            raise blender.BlenderError("There is no Blender.")

        monkeypatch.setattr(user_check, "_installation", missing)
    elif trouble == "no .blend":
        (shots / "a.blend").unlink()
    elif trouble == "no report":
        report = shots / "a.blend/report.xml"
    status, said = call("--junit", report)
    assert status == 2, said
    assert not report.is_file()
    assert not (shots / "velour-check/index.html").is_file()


def test_a_name_that_is_wrong_makes_no_folder(shots, call):
    assert call(paths=(shots / "none",))[0] == 2
    assert not list(shots.iterdir())


def test_a_file_that_is_gone_fails(shots, call):
    add(shots, "a", "b", "c_0001")
    assert call("--update")[0] == 0
    assert call("--update", "--frame", 3, "--frame", -5, paths=(shots / "b.blend",))[0] == 0
    for name in "ab":
        (shots / f"{name}.blend").unlink()
    status, said = call()
    assert status == 1
    assert {name: each["passed"] for name, each in outcomes(shots).items()} == {
        "a": False,
        "b": False,
        "c_0001": True,
    }
    assert "FAILED: a: a.blend is missing, but its reference is there" in said
    assert call("--update", "--yes")[0] == 1


def test_files_of_one_name_are_told_apart_and_others_mentioned(shots, call, tmp_path):
    add(shots, "shot")
    add(shots / "more", "shot")
    add(shots / "more/deep", "shot")
    both = (shots, shots / "more")
    assert call("--update", paths=both)[0] == 0
    report = tmp_path / "report.xml"
    status, said = call("--junit", report, paths=both)
    assert status == 0
    assert outcomes(shots).keys() == {"shot", "more/shot"}
    assert 'name="more/shot"' in report.read_text()
    assert "not checked: 1 .blend files in folders below" in said
    assert "not checked: 2 .blend" in call()[1]


def test_references_of_negative_frames_are_checked(shots, call):
    add(shots, "shot")
    assert call("--update", "--frame", -5)[0] == 0
    assert call()[0] == 0
    assert outcomes(shots).keys() == {"shot, frame -5"}


def test_a_reference_has_as_many_renders_as_a_check(shots, call):
    """A check takes its errors for as certain as its own."""
    add(shots, "a")
    status, said = call("--update", "--seeds", 3)
    assert (status, "--seeds: a reference needs at least 4" in said) == (2, True)
    assert call("--update", "--seeds", 4)[0] == 0
    assert call("--seeds", 2)[0] == 0
