"""Files are the old one or the new one, never a part."""

from __future__ import annotations

import json
import os

import pytest
from velour.core import files
from velour.core.mesh_memory import mesh_memory


def test_a_failing_writer_leaves_the_old_file_and_nothing_else(tmp_path):
    path = tmp_path / "report.json"
    path.write_text("old")

    def write(temporary):
        temporary.write_text("half")
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        files.write_atomic(path, write)
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]


def test_a_link_stays_and_its_target_is_replaced(tmp_path):
    target, link = tmp_path / "v003.json", tmp_path / "latest.json"
    target.write_text("old")
    link.symlink_to(target.name)
    files.write_text(link, "new")
    assert link.is_symlink()
    assert target.read_text() == "new"


def test_a_folder_that_takes_no_files_is_named_by_the_file_that_was_asked_for(tmp_path):
    path = tmp_path / "missing" / "report.json"
    with pytest.raises(OSError, match="No such file") as raised:
        files.write_atomic(path, lambda temporary: temporary.write_text("new"))
    assert raised.value.filename == str(path)


def test_written_files_are_readable_by_others(tmp_path):
    files.write_text(tmp_path / "a", "text")
    plain = tmp_path / "b"
    plain.write_text("text")
    assert (tmp_path / "a").stat().st_mode == plain.stat().st_mode


def test_json_is_standard_json(tmp_path):
    files.write_json(tmp_path / "r.json", {"a": None, "b": 0.5})
    assert json.loads((tmp_path / "r.json").read_text()) == {"a": None, "b": 0.5}
    with pytest.raises(ValueError, match="not JSON compliant"):
        files.json_text({"a": float("nan")})


@pytest.mark.parametrize("read", [files.read_bytes, files.sha256, mesh_memory])
def test_pipes_and_devices_are_refused_without_waiting(read, tmp_path):
    os.mkfifo(tmp_path / "pipe.obj")
    for path in (tmp_path / "pipe.obj", "/dev/zero"):
        with pytest.raises(OSError, match="is not a regular file; choose a file") as raised:
            read(path)
        assert raised.value.filename == str(path)
