"""The files that a browser of measurements shows."""

import os

import pytest
from velour.core import measurement_files
from velour.core.measurement_files import find_measurements


def _touch(folder, *names):
    for name in names:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_bytes(b"x" * 7)


def _names(folder):
    found = find_measurements(folder)
    assert not found.problems, found.problems
    return [file.name for file in found.files]


def test_files_are_known_by_their_suffixes_and_sorted_as_people_do(tmp_path):
    _touch(
        tmp_path, "paint 10.binary", "paint 2.binary", "Cloth/wool.BTF", "sky.exr", "notes.txt", "a.velour"
    )
    _touch(tmp_path, ".hidden/b.velour")
    assert _names(tmp_path) == ["a", os.path.join("Cloth", "wool"), "paint 2", "paint 10"]


def test_a_btf_that_is_a_folder_is_one_file(tmp_path):
    _touch(tmp_path, "weave/btf.json", "weave/btf.csv", "weave/view/0.velour", "weave/1.binary", "z.bsdf")
    found = find_measurements(tmp_path).files
    assert [(file.name, os.path.basename(file.path)) for file in found] == [
        ("weave", "btf.json"),
        ("z", "z.bsdf"),
    ]
    assert _names(tmp_path / "weave") == ["weave"]


def test_what_a_file_is_changes_with_its_content(tmp_path):
    _touch(tmp_path, "a.velour")
    before = find_measurements(tmp_path).files
    assert find_measurements(tmp_path).files == before
    (tmp_path / "a.velour").write_bytes(b"another")
    os.utime(tmp_path / "a.velour", ns=(1, 1))
    assert find_measurements(tmp_path).files != before


def test_links_in_a_circle_end(tmp_path):
    _touch(tmp_path, "below/a.velour")
    (tmp_path / "below" / "up").symlink_to(tmp_path, target_is_directory=True)
    assert _names(tmp_path) == [os.path.join("below", "a")]


def test_a_folder_that_is_not_there_is_a_sentence(tmp_path):
    files, problems = find_measurements(tmp_path / "gone")
    assert not files
    assert len(problems) == 1
    assert "gone cannot be read (No such file or directory)" in problems[0]


def test_a_folder_without_end_is_left_with_what_was_found(tmp_path, monkeypatch):
    monkeypatch.setattr(measurement_files, "MOST_ENTRIES", 50)
    _touch(tmp_path, *(f"{number}.velour" for number in range(80)))
    files, problems = find_measurements(tmp_path)
    assert 0 < len(files) < 50
    assert len(problems) == 1
    assert "only the first 50 entries were searched" in problems[0]


def test_a_search_can_be_stopped(tmp_path):
    _touch(tmp_path, *(f"{number}.velour" for number in range(20)))
    looked = []
    found = find_measurements(tmp_path, lambda: looked.append(1) or len(looked) > 5)
    assert len(found.files) < 20


@pytest.mark.parametrize("name", ["neu\nline.velour", "ä.binary", b"\xff.velour"])
def test_odd_names(tmp_path, name):
    path = os.path.join(os.fsencode(tmp_path), name) if isinstance(name, bytes) else tmp_path / name
    with open(path, "wb"):
        pass
    (found,) = find_measurements(tmp_path).files
    assert os.path.exists(found.path)
