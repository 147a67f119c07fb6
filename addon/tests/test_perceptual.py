"""scripts/perceptual: the metric against what is known of it, and a small run on the test data."""

from __future__ import annotations

import csv

import numpy as np
import pytest
from bench import charts, flip_metric
from bench.flip_metric import of_object
from bench.project import MissingError
from campaigns import only_kept, run_script

SIDE = 64
EVERYWHERE = np.ones((SIDE, SIDE), bool)


@pytest.fixture(scope="module")
def flip():
    try:
        flip_metric._flip()
    except MissingError as absent:
        pytest.skip(str(absent))


def _noise(seed: int) -> np.ndarray:
    return np.random.default_rng(seed).uniform(0, 1, (SIDE, SIDE, 3))


def test_equal_pictures_do_not_differ(flip):
    assert flip_metric.flip_map(_noise(1), _noise(1)).max() == 0


def test_black_against_white_is_nearly_all(flip):
    """[ANA20] 4.1.3: the largest difference of colors is that of green and blue."""
    black, white = np.zeros((SIDE, SIDE, 3)), np.ones((SIDE, SIDE, 3))
    assert 0.9 < flip_metric.flip_map(black, white).mean() <= 1
    green, blue = (np.broadcast_to(np.eye(3)[k], (SIDE, SIDE, 3)) for k in (1, 2))
    assert flip_metric.flip_map(green, blue).mean() == pytest.approx(1, abs=1e-3)


@pytest.mark.parametrize("difference", [0.5, 1.0, 2.3])
def test_even_grays_differ_as_the_paper_says(flip, difference):
    """[ANA20] 4.1.3: p_t d^q / (p_c c_max), q = 0.7, p_c = 0.4, p_t = 0.95, c_max = HyAB(green, blue)^q."""
    expected = 0.95 / (0.4 * 41.28) * difference**0.7
    assert flip_metric.of_lightness(difference) == pytest.approx(expected, rel=2e-3)


def test_noise_is_larger_close_up(flip):
    """The eye's filter takes fine noise for less than a patch as far off; a fine checkerboard is gray."""
    x, y = np.mgrid[:SIDE, :SIDE]
    board = np.repeat(((x + y) % 2)[..., None].astype(float), 3, axis=2)
    coarse = np.repeat(((x // 32 + y // 32) % 2)[..., None].astype(float), 3, axis=2)
    assert (
        flip_metric.flip_map(board, 1 - board).mean() < 0.5 * flip_metric.flip_map(coarse, 1 - coarse).mean()
    )


def test_display_is_the_srgb_curve_upside_down():
    linear = np.array([[[0.0, 0.0031308, 0.18]], [[1.0, 7.0, -1.0]]])
    found = charts.display(linear)
    np.testing.assert_allclose(found[0], [[1, 1, 0]])
    np.testing.assert_allclose(found[1], [[0, 0.04045, 0.46136]], atol=1e-5)


def test_exposure_makes_the_object_gray():
    picture = 3.0 * _noise(2)
    where = EVERYWHERE.copy()
    where[:10] = False
    scaled = flip_metric.exposure(picture, where) * picture
    assert (scaled[where] @ flip_metric.LUMINANCE).mean() == pytest.approx(flip_metric.GRAY)


def test_the_percentile_and_the_mean_are_the_objects(flip):
    reference = 0.2 + 0 * _noise(3)
    test, where = reference.copy(), np.zeros((SIDE, SIDE), bool)
    test[:16] *= 3  # row 0 is the bottom
    where[40:] = True
    assert of_object(reference, test, where)[0] < 1e-3
    assert of_object(reference, test, ~where)[1] > 0.2


@pytest.mark.long
def test_a_small_run_is_whole_and_goes_on(flip, data_folder, tmp_path):
    done = run_script("perceptual", tmp_path, data=data_folder)
    assert done.returncode == 0, done.stdout + done.stderr
    page = (tmp_path / "out/perceptual.md").read_text()
    assert "(perceptual/flip_by_error.png)" in page
    assert (tmp_path / "out/perceptual/flip_by_error.png").stat().st_size > 5000
    with open(tmp_path / "out/perceptual/perceptual.csv", newline="") as file:
        rows = [row for row in csv.DictReader(file) if row["flip_mean"]]
    assert {row["scene"] for row in rows} == {"sphere, venice_sunset", "bunny, venice_sunset"}
    for scene in {row["scene"] for row in rows}:
        fine, coarse = sorted(
            (row for row in rows if row["scene"] == scene), key=lambda r: -int(r["max_lobes"])
        )
        assert float(fine["flip_mean"]) < float(coarse["flip_mean"])
        assert float(fine["flip_mean"]) < 0.5 * float(fine["noise_mean"])
    assert only_kept(run_script("perceptual", tmp_path, data=data_folder).stdout)
