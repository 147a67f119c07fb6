"""velour-check --update: no reference is replaced without approval, and none by halves unnoticed."""

from __future__ import annotations

import builtins
import sys

import pytest
from regression import check, passes_file, reference, update
from regression.case import Case, Settings
from test_causes import HEIGHT, REFERENCE_SEEDS, WIDTH, Scene, known
from velour.core import files


def brighter(seed=3):
    scene = Scene()
    scene.picture[..., :3] *= 1.01
    return check.Renders(*scene.renders(seed, REFERENCE_SEEDS))


@pytest.fixture
def path(tmp_path):
    made = tmp_path / "shot.exr"
    check.write(made, check.Renders(*known()))
    return made


@pytest.fixture
def staged(tmp_path, path):
    """With a new reference for `path`."""
    found = update.Staged(tmp_path / "new")
    found.add(path, brighter())
    return found


def contents(path):
    files_of_it = path, reference.error_path(path), passes_file.passes_path(path)
    return [file.read_bytes() for file in files_of_it]


def test_without_a_terminal_nothing_is_replaced(staged, path, monkeypatch, capsys):
    before = contents(path)
    monkeypatch.setattr(sys.stdin, "isatty", lambda: False, raising=False)
    monkeypatch.setattr(builtins, "input", lambda _: pytest.fail("it waits for an answer"))
    assert staged.approve(yes=False) == 1
    assert contents(path) == before
    assert "1 reference kept; look at the page, and approve with --update --yes." in capsys.readouterr().out


def test_yes_replaces_without_asking(staged, path, monkeypatch):
    monkeypatch.setattr(builtins, "input", lambda _: pytest.fail("it asks"))
    before = contents(path)
    assert staged.approve(yes=True) == 0
    assert not set(contents(path)) & set(before)
    passes_file.read(path, (HEIGHT, WIDTH))  # they belong to the new picture
    assert not list(path.parent.glob(".*"))


class Terminal:
    def isatty(self):
        return True


@pytest.mark.parametrize(("answer", "replaced"), [("y", True), ("YES ", True), ("", False), ("n", False)])
def test_terminal_is_asked(staged, path, monkeypatch, answer, replaced):
    asked, before = [], contents(path)
    monkeypatch.setattr(sys, "stdin", Terminal())
    monkeypatch.setattr(builtins, "input", lambda question: asked.append(question) or answer)
    assert staged.approve(yes=False) == (0 if replaced else 1)
    assert (contents(path) != before) == replaced
    assert asked == ["Replace 1 reference by the new ones on the page? [y/N] "]


def test_end_of_input_is_no(staged, path, monkeypatch):
    def end(_question):
        raise EOFError

    before = contents(path)
    monkeypatch.setattr(sys, "stdin", Terminal())
    monkeypatch.setattr(builtins, "input", end)
    assert staged.approve(yes=False) == 1
    assert contents(path) == before


@pytest.mark.parametrize("whole", [0, 1, 2])
def test_replacement_that_is_cut_off_is_noticed(staged, path, monkeypatch, whole):
    """After none, one or two of the three files: the passes are never taken for those of another picture."""
    write, count = files.write_atomic, [0]

    def cut_off(target, make):
        if count[0] == whole:
            raise OSError("the disk is full")
        count[0] += 1
        write(target, make)

    monkeypatch.setattr(files, "write_atomic", cut_off)
    with pytest.raises(OSError, match="full"):
        staged.approve(yes=True)
    if whole < 2:  # the picture is the former one
        assert passes_file.read(path, (HEIGHT, WIDTH)).objects.names
    else:
        with pytest.raises(passes_file.PassesError, match="belongs to another"):
            passes_file.read(path, (HEIGHT, WIDTH))


class Rendered:
    """In place of Blender."""

    def run(self, *_arguments):
        return {"layer": None}


def test_new_references_are_written_and_others_wait(tmp_path, path, monkeypatch):
    new = tmp_path / "new_0002.exr"
    case = Case("shot", tmp_path / "shot.blend", {None: path, 2: new}, tmp_path / "work")
    monkeypatch.setattr(check, "read_frame", lambda *_arguments: brighter())
    before, staged = contents(path), update.Staged(tmp_path / "waiting")
    first, second = update.update(case, Rendered(), Settings(passes=True), 1, staged)
    assert contents(path) == before
    assert (first.passed, first.to_approve, second.to_approve) == (True, True, False)
    assert first.line.startswith("to approve: shot: exposure: all colors times 1.0")
    assert len(contents(new)) == 3
    assert staged.approve(yes=True) == 0
    assert contents(path) != before


def test_nothing_to_approve_is_no_failure(tmp_path):
    assert update.Staged(tmp_path).approve(yes=False) == 0
