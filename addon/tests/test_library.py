"""Every way in which the library can be the wrong one is a LibraryError of one sentence."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys

import pytest
from velour.native import LibraryError, library


@pytest.fixture(autouse=True)
def _fresh_library():
    library.release()
    yield
    library.release()


_OLD = "unsigned vlr_version(void) { return 7; } unsigned vlr_abi_version(void) { return 1; }"


def _compile(compiler, folder, source: str):
    code, built = folder / "fake.c", folder / "libfake.so"
    code.write_text(source)
    subprocess.run([compiler, "-shared", "-fPIC", code, "-o", built], check=True)
    return built


def _refusal(monkeypatch, path) -> str:
    monkeypatch.setenv("VELOUR_LIBRARY", str(path))
    with pytest.raises(LibraryError) as caught:
        library.load()
    assert "\n" not in str(caught.value)
    assert str(path) in str(caught.value)
    return str(caught.value)


def test_the_staged_library_loads_and_knows_itself():
    system = library.system()
    assert {"version", "embree", "simd", "simd_targets", "threads", "build_type"} <= set(system)
    assert system["simd"] in system["simd_targets"]


def test_loading_twice_gives_the_same_library():
    assert library.load() is library.load()


def test_absent(monkeypatch, tmp_path):
    assert "does not exist" in _refusal(monkeypatch, tmp_path / "libvelour.so")


def test_not_a_library(monkeypatch, tmp_path):
    path = tmp_path / "libvelour.so"
    path.write_bytes(b"no ELF at all")
    assert "cannot be loaded" in _refusal(monkeypatch, path)


def test_a_missing_dependency_is_named(monkeypatch, tmp_path, compiler):
    needed = _compile(compiler, tmp_path, "int velour_needed(void) { return 1; }")
    code, built = tmp_path / "user.c", tmp_path / "libvelour.so"
    code.write_text("int velour_needed(void); int user(void) { return velour_needed(); }")
    subprocess.run(
        [compiler, "-shared", "-fPIC", "-Wl,--no-as-needed", code, "-o", built, f"-L{tmp_path}", "-lfake"],
        check=True,
    )
    needed.unlink()
    assert "libfake.so" in _refusal(monkeypatch, built)


# As Blender 3.4 updates add-ons, then as 4.2 and newer do extensions: the folder is moved, and deleted later.
_REPLACE = "new = path + '.new'; shutil.copy(source, new); os.replace(new, path)"
_MOVE = """
folder = os.path.dirname(path)
moved = os.path.join(os.path.dirname(folder), ".velour.~temp~")
os.rename(folder, moved)
os.mkdir(folder)
shutil.copy(source, path)
"""
_DELETE = "shutil.rmtree(moved)"
_UPDATE = """
import os, shutil
from velour.native import LibraryError, library
path, source = os.environ["VELOUR_LIBRARY"], os.environ["SOURCE"]
library.load()
library.release()
library.load()  # the same file
{update}
library.release()  # as an update of the add-on does
try:
    library.load()
except LibraryError as error:
    print(error)
"""


@pytest.mark.parametrize("version", ["the same", "another"])
@pytest.mark.parametrize("update", [_REPLACE, _MOVE, _MOVE + _DELETE], ids=["replaced", "moved", "deleted"])
def test_an_update_asks_for_a_restart(tmp_path, compiler, update, version):
    """The loader would give out the library that is mapped, whatever the file is now."""
    path = tmp_path / "velour/libvelour.so"
    path.parent.mkdir()
    shutil.copy(library.library_path(), path)
    source = library.library_path() if version == "the same" else _compile(compiler, tmp_path, _OLD)
    run = [sys.executable, "-c", _UPDATE.format(update=update)]
    variables = {"VELOUR_LIBRARY": path, "SOURCE": source, "PYTHONPATH": os.pathsep.join(sys.path)}
    environment = {**os.environ, **{name: str(value) for name, value in variables.items()}}
    done = subprocess.run(run, env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert "restart Blender" in done.stdout
    assert "scripts/build" not in done.stdout
    assert str(path) in done.stdout


def test_foreign(monkeypatch, tmp_path, compiler):
    path = _compile(compiler, tmp_path, "int other(void) { return 1; }")
    assert "is not a Velour library" in _refusal(monkeypatch, path)


def test_old(monkeypatch, tmp_path, compiler):
    sentence = _refusal(monkeypatch, _compile(compiler, tmp_path, _OLD))
    assert "0.0.7" in sentence
    assert "0.1.0" in sentence


def test_a_failed_load_is_tried_again(monkeypatch, tmp_path):
    _refusal(monkeypatch, tmp_path / "absent.so")
    monkeypatch.delenv("VELOUR_LIBRARY")
    assert library.load()


def test_instruction_sets_can_be_pinned_and_unknown_ones_are_refused():
    for name in library.system()["simd_targets"]:
        library.select_simd(name)
        assert library.system()["simd"] == name
    library.select_simd("auto")
    with pytest.raises(library.VelourError, match="'ENIAC' is not available"):
        library.select_simd("ENIAC")
