"""The test data that several runs expand at once."""

from __future__ import annotations

import threading

from bench import project

_EXPAND = """
import pathlib, sys, time
out = pathlib.Path(sys.argv[1])
out.mkdir(parents=True, exist_ok=True)
with open(out / f"{sys.argv[2]}.binary", "w") as file:
    for part in "half", " and half":
        file.write(part)
        file.flush()
        time.sleep(0.3)
"""


def test_all_who_ask_at_once_find_it_whole(tmp_path, monkeypatch):
    data = tmp_path / "data"
    (data / "brdf").mkdir(parents=True)
    (data / "brdf/expand_merl.py").write_text(_EXPAND)
    monkeypatch.setattr(project, "_EXPANDED", tmp_path / "build/merl")
    found = []

    def ask():
        found.append(project.merl(data, "nickel").read_text())

    threads = [threading.Thread(target=ask) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert found == ["half and half"] * 4
    assert [path.name for path in (tmp_path / "build/merl").iterdir()] == ["nickel.binary"]


def test_meshes_of_one_name_in_two_folders_of_data_stay_apart(tmp_path, monkeypatch):
    monkeypatch.setattr(project, "_SMOOTH", tmp_path / "build/meshes")
    made = []
    for content in ("v 0 0 0\n", "v 1 1 1\n"):
        source = tmp_path / str(len(made)) / "mesh/bunny.obj"
        source.parent.mkdir(parents=True)
        source.write_text(content)
        made.append((project.mesh(source.parents[1], "bunny"), "s 1\n" + content))
    for path, content in made:
        assert (path.name, path.read_text()) == ("bunny.obj", content)
