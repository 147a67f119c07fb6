"""Folders of pages: an earlier page goes, nothing else does, and two runs do not share one."""

from __future__ import annotations

import sys

import pytest
from regression import engine_check, room


def test_only_an_earlier_page_is_removed(tmp_path):
    page = tmp_path / "page"
    room.take(page).close()
    for name in ("index.html", "report.json", "notes.txt"):
        (page / name).write_bytes(b"")
    (page / "pictures").mkdir()
    room.take(page).close()
    assert {path.name for path in page.iterdir()} == {room.MARK, "notes.txt"}


def test_two_runs_do_not_share_a_folder(tmp_path):
    with room.take(tmp_path):
        (tmp_path / "work").mkdir()
        with pytest.raises(room.RoomError, match="Another run writes to"):
            room.take(tmp_path)
        assert (tmp_path / "work").is_dir()
    room.take(tmp_path).close()


def test_parity_leaves_the_pictures_of_its_user(tmp_path, monkeypatch, capsys):
    holiday = tmp_path / "pictures/holiday.png"
    holiday.parent.mkdir()
    holiday.touch()
    (tmp_path / "shot.blend").touch()
    monkeypatch.setattr(sys, "argv", ["parity", str(tmp_path), "--output", str(tmp_path)])
    monkeypatch.setattr(engine_check, "_judged", lambda *_: pytest.fail("it renders"))
    assert engine_check.main() == 1
    assert "name another --output" in capsys.readouterr().err
    assert holiday.is_file()
