"""Files are the old one or the new one, never a part."""

from __future__ import annotations

import json

import pytest
from velour.core import files


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
