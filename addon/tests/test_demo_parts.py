"""A part of the demonstration is made again if something that it is made from has changed, and only then."""

from __future__ import annotations

from types import SimpleNamespace

import demo
import pytest
from bench.run import Run
from demo import Part

PART = Part("it", "the thing", 3, ("file", "folder"))


class Maker:
    """Makes the part in `folder` from the file `input` beside it, and counts how often it had to."""

    def __init__(self, folder):
        self.folder, self.input, self.count = folder / "out", folder / "input", 0
        self.input.write_text("input")

    def make(self, part: Part = PART, fresh: bool = False) -> dict:
        run = Run("demo", self.folder, self.folder, SimpleNamespace(), fresh=fresh)
        run.progress.expect(part.seconds)
        return demo.keep(run, part, {"input": self.input}, self._make)

    def _make(self) -> dict:
        self.count += 1
        (self.folder / "file").write_text("made")
        (self.folder / "folder").mkdir(exist_ok=True)
        return {"count": self.count}


@pytest.fixture
def maker(tmp_path):
    maker = Maker(tmp_path)
    assert maker.make() == {"count": 1, "kept": False}
    return maker


def test_is_kept(maker, capsys):
    capsys.readouterr()
    assert maker.make() == {"count": 1, "kept": True}
    assert capsys.readouterr().out == "[  1/1] the thing: kept\n"


def test_another_input_replaces_the_files(maker):
    maker.input.write_text("other")
    assert maker.make() == {"count": 2, "kept": False}
    assert maker.make() == {"count": 2, "kept": True}
    maker.input.write_text("input")
    assert maker.make() == {"count": 3, "kept": False}


def test_a_file_that_is_gone(maker):
    (maker.folder / "file").unlink()
    assert maker.make()["count"] == 2


def test_other_code(maker, monkeypatch):
    monkeypatch.setattr(demo, "_code", lambda: "other")
    assert maker.make()["count"] == 2


def test_another_version_of_the_part(maker):
    assert maker.make(PART._replace(seconds=4))["count"] == 2


def test_fresh(maker):
    assert maker.make(fresh=True)["count"] == 2


def test_a_failure_leaves_nothing_that_is_kept(maker, monkeypatch):
    maker.input.write_text("other")
    with monkeypatch.context() as patch:
        patch.setattr(maker, "_make", lambda: 1 / 0)
        with pytest.raises(ZeroDivisionError):
            maker.make()
    maker.input.write_text("input")
    assert maker.make() == {"count": 2, "kept": False}
