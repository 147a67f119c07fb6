"""scripts/parity without Blender: names of files, and what counts as alike."""

from __future__ import annotations

from regression import engine_check


def test_files_of_one_name_are_all_rendered(tmp_path):
    paths = [tmp_path / name for name in ("a/shot.blend", "b/shot.blend", "b/more/shot.blend")]
    for path in paths:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.touch()
    found = engine_check._blends([tmp_path / "a", tmp_path / "b"])
    assert found == dict(
        zip(("a/shot", "b/more/shot", "b/shot"), (paths[0], paths[2], paths[1]), strict=True)
    )
    assert engine_check._blends([tmp_path / "b"]).keys() == {"shot", "more/shot"}
    assert engine_check._blends([tmp_path / "b/more"]).keys() == {"shot"}
