"""scripts/parity without Blender: names of files, and what counts as alike."""

from __future__ import annotations

import numpy as np
import pytest
from regression import engine_check
from velour.native import images


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


@pytest.mark.parametrize(("alpha", "alike"), [(1, True), (0.99, True), (0.9, False), (0, False)])
def test_alpha_must_agree_like_color(tmp_path, alpha, alike):
    """As for a black object on a transparent film."""
    effort = engine_check.Effort(2, 64, 32, False)
    for name, value in (("cycles", 1), ("velour", alpha)):
        (tmp_path / name).mkdir()
        for seed in range(effort.seeds):
            picture = np.ones((32, 32, 4), np.float32)
            picture[..., :3] += 0.001 * np.random.default_rng(seed).standard_normal((32, 32, 3))
            picture[:16, :16] = 0, 0, 0, value
            images.write(tmp_path / name / f"0-{seed}.exr", picture)
    outcome = engine_check._compared("shot", tmp_path, 0, effort, 2)
    assert outcome.passed == alike, outcome.sentence
