"""A part of the demonstration is made again if something that it is made from has changed, and only then."""

from __future__ import annotations

import demo
import pytest
from bench.progress import Progress
from demo import Part, Parts

PART = Part("it", "the thing", {"first": 1, "second": 2}, ("file", "folder"))


class Maker:
    """Makes the part in `folder` from the file `input` beside it, and counts how often it had to."""

    def __init__(self, folder):
        self.folder, self.input, self.count = folder / "out", folder / "input", 0
        self.folder.mkdir()
        self.input.write_text("input")

    def make(self, part: Part = PART, fresh: bool = False) -> dict:
        parts = Parts(Progress(), fresh)
        parts.expect(part)
        return parts.make(part, self.folder, {"input": self.input}, self._run)

    def _run(self, steps) -> dict:
        self.count += 1
        steps.begin("first")
        (self.folder / "file").write_text("made")
        steps.hear("step: second\n")
        (self.folder / "folder").mkdir(exist_ok=True)
        (self.folder / "folder/inner").write_text("made")
        return {"count": self.count}


@pytest.fixture
def maker(tmp_path):
    maker = Maker(tmp_path)
    assert maker.make() == {"count": 1, "kept": False}
    return maker


def test_is_kept(maker, capsys):
    capsys.readouterr()
    assert maker.make() == {"count": 1, "kept": True}
    assert capsys.readouterr().out == "[  2/2] the thing, with the times of the run that made it: kept\n"


def test_tells_its_steps(tmp_path, capsys):
    Maker(tmp_path).make()
    lines = capsys.readouterr().out.splitlines()
    assert [line.rpartition(":")[0] for line in lines] == ["[  1/2] first", "[  2/2] second"]


@pytest.mark.parametrize("name", ["input", "out/file", "out/folder/inner"])
def test_a_file_that_has_changed(maker, tmp_path, name):
    (tmp_path / name).write_text("other")
    assert maker.make() == {"count": 2, "kept": False}
    assert maker.make() == {"count": 2, "kept": True}


def test_a_file_that_is_gone(maker):
    (maker.folder / "file").unlink()
    assert maker.make()["count"] == 2


def test_other_code(maker, monkeypatch):
    monkeypatch.setattr(demo, "_code", lambda: "other")
    assert maker.make()["count"] == 2


def test_another_version_of_the_part(maker):
    assert maker.make(Part("it", PART.title, {"first": 1, "second": 3}, PART.files))["count"] == 2


def test_fresh(maker):
    assert maker.make(fresh=True)["count"] == 2


def test_a_failure_leaves_nothing_that_is_kept(maker):
    maker.input.write_text("other")

    def fail(steps):
        raise RuntimeError

    with pytest.raises(RuntimeError):
        Parts(Progress(), False).make(PART, maker.folder, {"input": maker.input}, fail)
    maker.input.write_text("input")
    assert maker.make() == {"count": 2, "kept": False}
