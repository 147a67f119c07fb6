"""The maths of texture placements: maps, densities, spreads, stretches of surfaces with known ones."""

from __future__ import annotations

import numpy as np
import pytest
from conftest import ROOT
from velour.core.placement import (
    DEFAULT_TILES,
    REAL_SIZE_TILES,
    Surface,
    UvMetric,
    lie_of,
    quantiles,
    repeats_of,
    texture_map,
    tiles_along,
    whole,
)

TURN = np.radians(30)


def grid(size, uv_of, height=None, cells=24):
    """A sheet of `size` (x, y) metres, whose texture coordinates are uv_of(x, y), 0 to 1 each way."""
    x, y = np.meshgrid(np.linspace(0, 1, cells + 1), np.linspace(0, 1, cells + 1), indexing="ij")
    z = np.zeros_like(x) if height is None else height(x, y)
    positions = np.stack([x * size[0], y * size[1], z], axis=-1).reshape(-1, 3).astype(np.float32)
    uvs = np.stack(uv_of(x, y), axis=-1).reshape(-1, 2).astype(np.float32)
    i, j = np.meshgrid(np.arange(cells), np.arange(cells), indexing="ij")
    a = (i * (cells + 1) + j).ravel()
    quads = np.stack([a, a + cells + 1, a + cells + 2, a + 1], axis=-1)
    triangles = np.concatenate([quads[:, (0, 1, 2)], quads[:, (0, 2, 3)]])
    return Surface.of(positions, triangles, uvs[triangles])


def plain(x, y):
    return x, y


def metric_of(surface, scale=1.0):
    return UvMetric.of(surface, scale * np.eye(3))


def apply(uv_map, *points):
    return (uv_map @ np.column_stack([points, np.ones(len(points))]).T).T


def test_a_map_puts_the_corner_at_the_offset_and_turns_about_it():
    uv_map = texture_map((2, 4), TURN, (0.3, 0.1))
    along_x = np.array([np.cos(TURN), np.sin(TURN)])
    along_y = np.array([-np.sin(TURN), np.cos(TURN)])
    corner = np.array([0.3, 0.1])
    tiles = apply(uv_map, corner, corner + along_x / 2, corner + along_y / 4)
    np.testing.assert_allclose(tiles, [[0, 0], [1, 0], [0, 1]], atol=1e-12)


def test_a_map_with_a_metric_turns_without_shear():
    """u is 3 long, v is 1: tiles of a unit square stay squares on the surface however they are turned."""
    uv_map = texture_map((1, 1), TURN, metric=(3, 1))
    surface = grid((3, 1), plain)
    tiles = metric_of(surface).placed(uv_map)
    np.testing.assert_allclose(tiles.stretches(), 1, rtol=1e-5)
    np.testing.assert_allclose(tiles.scales(), 1, rtol=1e-5)
    sheared = metric_of(surface).placed(texture_map((3, 1), TURN))
    assert sheared.stretches().min() > 1.5


def test_density_is_that_of_a_stretched_sheet_in_metres():
    surface = grid((4, 0.5), plain)
    assert metric_of(surface).density() == pytest.approx((1 / 4, 2))
    assert metric_of(surface, 0.001).density() == pytest.approx((250, 2000))


def test_density_of_turned_coordinates_is_the_same_for_both():
    c, s = np.cos(TURN), np.sin(TURN)
    surface = grid((1, 1), lambda x, y: (5 * (c * x - s * y), 5 * (s * x + c * y)))
    assert metric_of(surface).density() == pytest.approx((5, 5))


def test_a_matrix_counts_with_its_scale_and_not_with_its_rotation():
    surface = grid((1, 1), plain)
    c, s = np.cos(TURN), np.sin(TURN)
    turn = np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])
    assert UvMetric.of(surface, turn @ np.diag([2, 4, 9])).density() == pytest.approx((1 / 2, 1 / 4))


def test_a_sphere_in_longitude_and_latitude():
    """Half of a sphere lies within 30 degrees of the equator; u is 1 / cos(latitude) as dense there."""
    n = 96
    theta = np.linspace(0, np.pi, n + 1)
    phi = np.linspace(0, 2 * np.pi, 2 * n + 1)
    t, p = np.meshgrid(theta, phi, indexing="ij")
    positions = np.stack([np.sin(t) * np.cos(p), np.sin(t) * np.sin(p), np.cos(t)], -1).reshape(-1, 3)
    uvs = np.stack([p / (2 * np.pi), 1 - t / np.pi], -1).reshape(-1, 2)
    i, j = np.meshgrid(np.arange(n), np.arange(2 * n), indexing="ij")
    a = (i * (2 * n + 1) + j).ravel()
    b = a + 2 * n + 1
    triangles = np.concatenate([np.stack([a, b, a + 1], -1), np.stack([a + 1, b, b + 1], -1)])
    metric = metric_of(Surface.of(positions, triangles, uvs[triangles]))
    assert metric.density() == pytest.approx((1 / (2 * np.pi * np.cos(np.pi / 6)), 1 / np.pi), rel=0.01)
    real = texture_map((50, 50), metric=1 / np.array(metric.density()))
    lie = lie_of(metric.placed(real))
    # Geometric mean of both directions: sqrt(cos(latitude)) as large as at the median.
    assert lie.spread == pytest.approx(
        (np.sqrt(np.cos(np.arcsin(0.9)) / np.cos(np.pi / 6)), 1.0746), rel=0.02
    )
    # Stretched by cos(30) / cos(latitude): more than 2 beyond 64.3 degrees, where a tenth of the area is.
    assert lie.stretched == pytest.approx(1 - np.sqrt(1 - (np.cos(np.pi / 6) / 2) ** 2), rel=0.1)
    assert lie.is_stretched
    worst = Surface.of(positions, triangles, uvs[triangles]).centers[lie.worst]
    assert abs(worst[2]) > 0.99


def test_an_even_sheet_has_neither_spread_nor_stretch():
    metric = metric_of(grid((2, 1), plain))
    lie = lie_of(metric.placed(texture_map((100, 100), TURN, metric=1 / np.array(metric.density()))))
    assert lie.scale == pytest.approx(100, rel=1e-5)
    assert lie.spread == pytest.approx((1, 1), rel=1e-5)
    assert (lie.stretched, lie.is_stretched) == (0, False)
    assert lie.stretch == pytest.approx(1, rel=1e-4)


def test_a_stretched_part_is_counted_by_its_area():
    """The right quarter of the surface gets as much texture as the rest: 3 times as dense along x."""
    surface = grid((1, 1), lambda x, y: (np.where(x < 0.75, x / 1.5, 0.5 + (x - 0.75) * 2), y))
    metric = metric_of(surface)
    lie = lie_of(metric.placed(texture_map((10, 10), metric=1 / np.array(metric.density()))))
    assert lie.stretched == pytest.approx(0.25, abs=0.01)
    assert lie.stretch == pytest.approx(3, rel=1e-3)
    assert surface.centers[lie.worst][0] > 0.75


def test_what_has_no_extent_is_left_out():
    surface = grid((1, 1), lambda x, y: (np.maximum(x, 0.5), y))  # the left half shows a line
    metric = metric_of(surface)
    assert metric.density() == pytest.approx((1, 1))
    lie = lie_of(metric)
    assert lie.stretched == pytest.approx(0.5, abs=0.01)
    assert lie.stretch == np.inf
    assert metric_of(grid((1, 1), lambda x, y: (x, 0 * y))).is_flat
    assert metric_of(grid((0, 1), plain)).is_flat
    assert not metric.is_flat


@pytest.mark.parametrize(
    ("extent", "side", "wanted"),
    [
        (2.0, 0.002, 20),  # 1000 tiles would be too small to be seen
        (0.8, 0.002, 400),
        (0.802, 0.002, 20),
        (0.3, 0.002, 150),
        (0.008, 0.002, 4),
        (0.007, 0.002, 20),  # a cube as large as a few yarns
        (2.0, None, 20),
        (2.0, 0.0, 20),
        (0.0, 0.002, 20),
    ],
)
def test_tiles_along_an_object_have_their_real_size_where_it_can_be_seen(extent, side, wanted):
    assert tiles_along(extent, side) == pytest.approx(wanted)


def test_the_guide_states_these_numbers():
    text = " ".join((ROOT / "docs/guide/cloth.md").read_text(encoding="utf-8").split())
    low, high = REAL_SIZE_TILES
    assert f"real size if {low} to {high} of them" in text
    assert f"or else {DEFAULT_TILES} tiles do" in text


def test_repeats_give_tiles_their_sides():
    """A sheet of 6 x 2 m under a unit square: 20 x 4 tiles of 0.3 x 0.5 m."""
    surface = grid((6, 2), plain)
    repeats = repeats_of((0.3, 0.5), metric_of(surface).density())
    assert repeats == pytest.approx((20, 4))
    tiles = metric_of(surface).placed(texture_map(repeats))
    assert tiles.density() == pytest.approx((1 / 0.3, 1 / 0.5))
    wrong = metric_of(surface).placed(texture_map(repeats_of((0.3, 0.5), (1, 1))))
    assert wrong.density() != pytest.approx((1 / 0.3, 1 / 0.5), rel=0.2)


def test_large_repeats_are_whole():
    assert whole((54.41, 31.4)) == (54, 31)
    assert whole((9.9, 0.25)) == (9.9, 0.25)


def test_quantiles_go_by_weight():
    values = np.array([3.0, 1.0, 2.0])
    weights = np.array([1.0, 1.0, 8.0])
    assert quantiles(values, weights, (0.05, 0.5, 0.95)).tolist() == [1, 2, 3]


@pytest.mark.parametrize("rotation", [0.0, TURN, -2.0])
def test_metric_agrees_with_finite_steps_on_a_bent_sheet(rotation):
    """The scale of a map is what steps on the surface do to tiles."""
    surface = grid((2, 1), lambda x, y: (x + 0.2 * y * y, y - 0.1 * x), lambda x, y: 0.3 * x * y)
    uv_map = texture_map((7, 3), rotation, (0.1, 0.2), metric=(0.5, 2))
    tiles = metric_of(surface).placed(uv_map)
    for k in (0, 100, 700):
        edges, steps = surface.edges[k].astype(float), surface.uv_edges[k] @ uv_map[:, :2].T
        x = edges[0] / np.linalg.norm(edges[0])
        y = edges[1] - (edges[1] @ x) * x
        y /= np.linalg.norm(y)
        jacobian = steps.T @ np.linalg.inv(np.array([edges @ x, edges @ y]))
        long, short = np.linalg.svd(jacobian.astype(float), compute_uv=False)
        assert tiles.stretches()[k] == pytest.approx(long / short, rel=1e-4)
        assert tiles.scales()[k] == pytest.approx(np.sqrt(long * short), rel=1e-4)
