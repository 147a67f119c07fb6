"""What scripts/votf measures: outlines with and without holes, shadows, and surfaces that show structures."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from bench import tiles
from bench.pages.votf import (
    WAYS,
    View,
    photographed,
    shadow_error,
    soft_iou,
    subjects,
    without_holes,
)
from bench.tiles import Cloth, Plane, Sphere, smooth_mesh, structured_mesh
from velour.native import Model, Scene


def _ring() -> np.ndarray:
    y, x = np.mgrid[:32, :32] - 15.5
    r = np.hypot(x, y)
    return ((r < 12) & (r > 6)).astype(float)


def _picture(alpha: np.ndarray, radiance: float) -> np.ndarray:
    return np.concatenate([np.repeat(radiance * alpha[..., None], 3, axis=-1), alpha[..., None]], axis=-1)


def test_a_hole_counts_for_alpha_and_not_for_the_outline():
    ring = _ring()
    disk = without_holes(ring)
    assert disk.sum() > ring.sum() + 90
    assert soft_iou(without_holes(disk), without_holes(ring)) == 1
    assert soft_iou(disk, ring) == pytest.approx(ring.sum() / disk.sum())


def test_the_error_of_a_shadow_is_relative_to_the_light_that_it_takes():
    lit, shadow = np.ones((8, 8)), np.ones((8, 8))
    shadow[2:4] = 0.5
    pictures = [
        _picture(np.ones((8, 8)), radiance[..., None]) for radiance in (lit, shadow, (lit + shadow) / 2)
    ]
    errors = [shadow_error(picture, pictures[1]) for picture in pictures]
    assert errors == pytest.approx([1, 0, 0.5])


def test_a_picture_too_large_is_cropped_at_the_right_edge():
    view = View(np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0.0]]), 0)
    assert view.size(10, 1, 64) == {"width": 26, "height": 26}
    size = view.size(100, 1, 64)
    assert size["width"] == 260
    assert size["crop_x0"] < 230 < size["crop_x1"] == size["crop_x0"] + 64


def test_scales_are_closed_and_repeat():
    mesh = tiles.structure("scales").mesh
    edges = np.sort(mesh["triangles"][:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2).astype(np.int64))
    points = np.unique((mesh["positions"] * 1e7).round(), axis=0, return_inverse=True)[1].reshape(-1)
    _, uses = np.unique(np.sort(points[edges]), axis=0, return_counts=True)
    assert not (uses % 2).any()


def test_soft_intersection_over_union():
    assert soft_iou(np.array([0.5, 1, 0]), np.array([1, 0.5, 0])) == pytest.approx(0.5)


@pytest.mark.parametrize("surface", [Sphere(6, 0.1), Plane(3, 0.1), Cloth(4, 0.1)])
def test_a_tile_s_plane_lies_on_the_smooth_surface_and_its_top_over_it(surface):
    corners = np.array([[x, y, h] for h in (0, 0.02) for x, y in ((0, 0), (0.1, 0), (0.1, 0.1), (0, 0.1))])
    tile = {
        "positions": corners,
        "triangles": np.array([[0, 1, 2], [4, 5, 6]], np.uint32),
    }
    placed = structured_mesh(surface, tile, 0.1)["positions"].reshape(-1, 2, 4, 3)
    on, over = placed[:, 0], placed[:, 1]
    np.testing.assert_allclose(np.linalg.norm(over - on, axis=-1), 0.02, rtol=1e-4)
    points = smooth_mesh(surface)["positions"]
    nearest = np.linalg.norm(points[:, None] - on.reshape(1, -1, 3), axis=-1).min(axis=0)
    assert nearest.max() < 1e-5


def test_normals_of_a_cloth_are_those_of_its_points():
    uv = np.random.default_rng(1).uniform(0.2, 3.8, (50, 2))
    cloth = Cloth(4, 0.1)
    points, normals = cloth.frame(uv)
    for step in ((1e-3, 0), (0, 1e-3)):
        along = cloth.frame(uv + np.array(step))[0] - points
        assert np.abs((along * normals).sum(axis=-1)).max() < 1e-2 * np.linalg.norm(along, axis=-1).min()


def test_a_shell_looks_like_the_geometry_that_it_stands_for(model_file):
    net = tiles.structure("net")
    ball = Sphere(3, net.period[0])
    run = SimpleNamespace(settings=SimpleNamespace(tile_pixels=(16,), samples=(16,), side=64), threads=0)
    with Model.load(model_file) as plain, Scene() as scene:
        net.add_to(scene, plain)
        shell, _report = tiles.with_shell(scene, net._asdict(), plain)
        with shell:
            shown = subjects(ball, net, dict(zip(WAYS, (plain, plain, shell, shell), strict=True)))
            views = {"ball": View(smooth_mesh(ball)["positions"], 80)}
            found = [photographed(run, shown[way], views, (1,)) for way in WAYS[:3]]
    truth, smooth, other = (pictures["ball", 16].pixels for (pictures,), _size in found)
    assert soft_iou(other[..., 3], truth[..., 3]) > 0.9 > soft_iou(smooth[..., 3], truth[..., 3])
    shadows = [pictures["shadow", 16].pixels for (pictures,), _size in found]
    assert shadow_error(shadows[2], shadows[0]) < 0.5 * shadow_error(shadows[1], shadows[0])
    assert found[2][1] < 0.5 * found[0][1]
