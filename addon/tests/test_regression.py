"""Regression scenes, as far as no Blender is needed: references, pages, names of files, processes."""

from __future__ import annotations

import json
import os
import sys
import time

import numpy as np
import pytest
from regression import check, folder, reference, scene
from regression.case import Outcome, Settings
from regression.comparison import compare, smallest_factor
from regression.page import Page
from regression.views import MAGNIFICATION, crop, views
from support import judge, process
from velour.native import images

SIZE = (24, 40, 4)


@pytest.fixture(scope="module")
def renders():
    """A noisy ramp, opaque."""
    truth = np.ones(SIZE)
    truth[..., :3] = np.linspace(0.1, 2.0, SIZE[1])[:, None]
    noise = np.random.default_rng(3).standard_normal((16, *SIZE)) * 0.02
    noise[..., 3] = 0
    return judge.estimate(truth * (1 + noise))


def test_reference_is_what_was_written(tmp_path, renders):
    path = tmp_path / "ramp.exr"
    reference.write(path, renders)
    found = reference.read(path, renders)
    assert np.abs(found.mean / renders.mean - 1).max() < 2**-17 * 1.01
    varies = renders.variance > 0
    assert np.abs(np.sqrt(found.variance[varies] / renders.variance[varies]) - 1).max() < 2**-8 * 1.01
    assert not found.variance[~varies].any()
    assert compare(renders, found, 1).agrees
    assert path.stat().st_size < 4 * renders.mean.size  # three of four bytes are left to compress


def test_reference_without_errors_is_noted_as_such(tmp_path, renders):
    path = tmp_path / "ramp.exr"
    images.write(path, renders.mean.astype(np.float32))
    found = reference.read(path, renders)
    assert (found.variance >= 0).all()
    assert compare(renders, found, 1).agrees
    images.write(path, np.ascontiguousarray(renders.mean[..., :3], np.float32))
    assert reference.read(path, renders).mean.shape == (*SIZE[:2], 3)
    assert compare(renders, reference.read(path, renders), 1).agrees


@pytest.mark.parametrize("fault", ["size", "error size", "negative error", "not a number"])
def test_reference_that_cannot_be(tmp_path, renders, fault):
    path = tmp_path / "ramp.exr"
    mean, error = renders.mean.astype(np.float32), np.sqrt(renders.variance).astype(np.float32)
    if fault == "size":
        mean = np.ascontiguousarray(mean[:, :-1])
    if fault == "error size":
        error = np.ascontiguousarray(error[:-1])
    if fault == "negative error":
        error[0, 0, 0] = -1
    if fault == "not a number":
        mean[0, 0, 0] = np.nan
    images.write(path, mean)
    images.write(reference.error_path(path), error)
    with pytest.raises(ValueError, match=r"pixels|standard errors|not finite"):
        reference.read(path, renders)


def test_alpha_is_judged_for_itself(renders):
    mean = renders.mean.copy()
    mean[0, 0, 3] = 0.9
    found = compare(renders, renders._replace(mean=mean), 1)
    assert not found.agrees
    assert (found.what, found.block, found.percent) == ("alpha", (0, 0), 0.0)


def test_sees_is_what_is_refused(renders):
    sees = compare(renders, renders, 1).sees
    assert 0 < sees < 1
    for factor, agrees in ((0.3, True), (1.5, False)):
        mean = renders.mean * ([1 + factor * sees / 100] * 3 + [1])
        assert compare(renders._replace(mean=mean), renders, 1).agrees == agrees


def test_channels_without_light_tell_no_factor(tmp_path, renders):
    """As all of a picture under red lamps but its red."""
    red = renders._replace(mean=renders.mean * [1, 0, 0, 1], variance=renders.variance * [1, 0, 0, 1])
    alone = renders._replace(mean=renders.mean[..., [0, 0, 0]], variance=renders.variance[..., [0, 0, 0]])
    sees = smallest_factor(red, red, 4.0)
    assert sees == pytest.approx(smallest_factor(alone, alone, 4.0))
    black = renders._replace(mean=renders.mean * [0, 0, 0, 1], variance=renders.variance * 0)
    found = compare(black, black, 1)
    assert (found.agrees, found.sees) == (True, np.inf)
    page = Page(tmp_path, "Test")
    page.add(Outcome("black", True, check.describe(found), comparison=found))
    page.finish()
    assert json.loads((tmp_path / "report.json").read_text())["outcomes"][0]["sees"] is None


def test_checks_and_references_share_no_seed():
    settings = Settings()
    assert (len(settings.seed_list(False)), len(settings.seed_list(True))) == (4, 16)
    assert not set(settings.seed_list(False)) & set(settings.seed_list(True))


def test_pictures_belong_to_files(tmp_path):
    for name in ("shot.blend", "shot_0012.blend", "shot.exr", "shot.error.exr", "shot_0007.exr"):
        (tmp_path / name).touch()
    for name in ("shot_0012.exr", "shot_12.exr", "shot_-005.exr", "sky.exr", "old.blend1"):
        (tmp_path / name).touch()
    cases = folder.cases([tmp_path, tmp_path / "shot.blend"], tmp_path)
    assert {case.name: case.references for case in cases} == {
        "shot": {
            None: tmp_path / "shot.exr",
            -5: tmp_path / "shot_-005.exr",
            7: tmp_path / "shot_0007.exr",
        },
        "shot_0012": {None: tmp_path / "shot_0012.exr"},
    }


def test_page_is_whole_and_escaped(tmp_path, renders):
    other = renders._replace(mean=renders.mean * ([1.1] * 3 + [1]))
    comparison = compare(other, renders, 1)
    failed = Outcome("a <b> & c", False, check.describe(comparison), comparison=comparison)
    failed.ours, failed.reference = other.mean, renders.mean
    page = Page(tmp_path, "Test")
    page.add(failed)
    page.add(Outcome("gone", False, 'Blender crashed (<signal> "11")'))
    text = page.finish().read_text(encoding="utf-8")
    assert "a &lt;b&gt; &amp; c" in text
    assert "<b>" not in text
    assert "<signal>" not in text
    assert '<td colspan="4">Blender crashed (&lt;signal&gt; &quot;11&quot;)</td></tr>' in text
    names = sorted(path.name for path in (tmp_path / "pictures").iterdir())
    kinds = ("difference", "new", "reference")
    assert names == sorted([f"001-{k}.png" for k in kinds] + [f"001-crop-{k}.png" for k in kinds])
    assert all(f'src="pictures/{name}"' in text for name in names)
    # The difference of a tenth, ten times, is the picture.
    shown, whole = (images.read(tmp_path / f"pictures/001-{k}.png") for k in ("difference", "reference"))
    np.testing.assert_allclose(shown, whole, atol=0.02)


def test_crop_is_the_block_with_a_margin():
    view = np.arange(48 * 64, dtype=float).reshape(48, 64, 1)
    found = crop(view, (1, 2))
    assert found.shape[:2] == ((48 - 24) * MAGNIFICATION, 32 * MAGNIFICATION)
    assert found[0, 0] == view[24, 8]


def test_bright_and_dark_pictures_are_shown_alike(renders):
    shown = []
    for gain in (0.01, 100.0):
        mean = renders.mean * ([gain] * 3 + [1])
        outcome = Outcome("picture", True, "", ours=mean, reference=mean)
        shown.append(views(outcome)[0]["new"])
    np.testing.assert_allclose(*shown, rtol=1e-6)


def test_committed_references_are_there_and_small():
    scenes = [scene.load(name) for name in scene.names()]
    assert len(scenes) >= 8
    for one in scenes:
        assert bool(one.refusal) != bool(one.references())
        for path in _references(one):
            assert path.stat().st_size + reference.error_path(path).stat().st_size <= 100_000
    kept = {path.name for path in (scene.SCENES / "references").iterdir()}
    known = [path for one in scenes for path in _references(one)]
    assert kept == {p.name for path in known for p in (path, reference.error_path(path))}


def _references(one):
    """In every Blender."""
    return [path for meaning in one.meanings for path in one.references(meaning).values()]


def test_process_that_hangs_ends_with_its_children(tmp_path):
    log, mark = tmp_path / "log.txt", tmp_path / "mark"
    script = f"(sleep 3; touch {mark}) & echo begun; wait"
    start = time.monotonic()
    assert process.execute(["sh", "-c", script], dict(os.environ), log, 1) is None
    assert time.monotonic() - start < 2.5
    assert log.read_text().splitlines() == ["begun", "", "killed after 1 s"]
    time.sleep(3)
    assert not mark.exists()


def test_process_that_ends_gives_its_status(tmp_path):
    command = [sys.executable, "-c", "raise SystemExit(3)"]
    assert process.execute(command, dict(os.environ), tmp_path / "log.txt", 20) == 3
