"""Normals from pictures under several lights: found as they are, in spite of highlights and shadows."""

import numpy as np
import pytest
from velour.core import photometric_stereo
from velour.core.photometric_stereo import normals_of, root_mean_square_slope
from velour.core.tile_maps import _AZIMUTHS, _RINGS, _rings

LIGHTS = _rings(_RINGS, _AZIMUTHS)
SIZE = 24
_UP = (0.0, 0.0, 1.0)


@pytest.fixture
def relief():
    """Waves that repeat, up to 37 degrees steep."""
    y, x = (np.arange(SIZE) + 0.5)[:, None] / SIZE, (np.arange(SIZE) + 0.5)[None, :] / SIZE
    slopes = 0.6 * np.cos(2 * np.pi * (2 * x + y)), 0.45 * np.sin(2 * np.pi * (y - x))
    return unit(np.dstack([*slopes, np.ones((SIZE, SIZE))]))


def unit(vectors):
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def lambert(normals, albedo=0.5):
    """Attached shadows included."""
    return albedo * np.maximum(np.einsum("ki,yxi->kyx", LIGHTS, normals), 0)


def angles(found, normals):
    return np.degrees(np.arccos(np.clip((found * normals).sum(-1), -1, 1)))


def solved(radiance, coverage=None):
    return normals_of(LIGHTS, radiance, np.ones(radiance.shape[1:]) if coverage is None else coverage)


def least_squares(radiance):
    """Normals fitted to all pictures by plain least squares, with no pixel left out."""
    scaled = np.linalg.lstsq(LIGHTS, radiance.reshape(len(LIGHTS), -1), rcond=None)[0]
    return unit(scaled.T.reshape(*radiance.shape[1:], 3))


def test_what_is_matt_is_found_exactly(relief):
    albedo = np.random.default_rng(1).uniform(0.05, 0.9, (SIZE, SIZE))
    radiance = lambert(relief, albedo)
    assert (radiance == 0).any(), "there are attached shadows"
    assert angles(solved(radiance), relief).max() < 0.01
    assert angles(least_squares(radiance), relief).max() > 1


def test_highlights_and_cast_shadows_are_left_out(relief):
    halves = unit(LIGHTS + np.array(_UP))
    lobe = np.maximum(np.einsum("ki,yxi->kyx", halves, relief), 0) ** 60
    radiance = lambert(relief) + 2 * lobe
    radiance[np.random.default_rng(2).random(radiance.shape) < 0.12] = 0
    robust, plain = (angles(found, relief) for found in (solved(radiance), least_squares(radiance)))
    assert np.median(robust) < 0.5
    assert np.percentile(robust, 90) < 4
    assert np.median(plain) > 10


def test_more_shadows_than_are_left_out_do_no_harm(relief):
    radiance = lambert(relief)
    radiance[np.random.default_rng(4).random(radiance.shape) < 0.3] = 0
    assert ((radiance == 0).sum(axis=0) > 6).mean() > 0.5
    assert np.percentile(angles(solved(radiance), relief), 90) < 1


def test_nothing_is_told_by_what_is_black_or_not_there(relief):
    radiance, coverage = lambert(relief), np.ones((SIZE, SIZE))
    radiance[:, 3, 4] = 0
    coverage[7, 8] = 0
    radiance[:, 7, 8] = 1e-3
    found = solved(radiance, coverage)
    np.testing.assert_array_equal(found[[3, 7], [4, 8]], [_UP, _UP])
    assert np.delete(found[..., 2].ravel(), [3 * SIZE + 4, 7 * SIZE + 8]).mean() < 0.95
    np.testing.assert_array_equal(solved(0 * radiance), np.broadcast_to(_UP, (SIZE, SIZE, 3)))


def test_lights_in_a_plane_tell_nothing():
    flat = LIGHTS * (1, 0, 1)
    radiance = np.maximum(flat[:, 2], 0)[:, None, None] * np.ones((1, 2, 2))
    found = normals_of(flat, radiance, np.ones((2, 2)))
    np.testing.assert_array_equal(found, np.broadcast_to(_UP, (2, 2, 3)))


def test_the_tile_as_a_whole_stays_upright(relief):
    """A surface that repeats has no slope of its own."""
    slopes = relief[..., :2] / relief[..., 2:] + (0.1, -0.05)
    tilted = unit(np.dstack([slopes, np.ones((SIZE, SIZE))]))
    assert angles(solved(lambert(tilted)), relief).max() < 0.01


def test_what_is_level_stays_so_though_it_is_not_matt(monkeypatch):
    """Brightness falls as the square of the cosine, with noise: what is kept has to be one ring."""
    noise = np.random.default_rng(3).normal(1, 0.01, (len(LIGHTS), SIZE, SIZE))
    radiance = LIGHTS[:, 2, None, None] ** 2 * noise
    assert root_mean_square_slope(solved(radiance)) < 0.02
    monkeypatch.setattr(photometric_stereo, "_DARKEST", 1 / 8)
    assert root_mean_square_slope(solved(radiance)) > 0.02


def test_large_pictures_are_solved_in_parts_of_no_account(relief):
    radiance = np.tile(lambert(relief), (1, 8, 8))
    np.testing.assert_allclose(solved(radiance)[:SIZE, :SIZE], solved(lambert(relief)), atol=1e-9)
