"""What scripts/votf measures: outlines with and without holes, and surfaces with a tile all over them."""

from __future__ import annotations

import numpy as np
import pytest
from bench import tiles
from bench.pages.votf import Shot, shell_errors, soft_iou, without_holes
from bench.tiles import Cloth, Cylinder, Sphere, smooth_mesh, structured_mesh
from velour.native import Model, Scene, Tile


def _ring() -> np.ndarray:
    y, x = np.mgrid[:32, :32] - 15.5
    r = np.hypot(x, y)
    return ((r < 12) & (r > 6)).astype(float)


def _picture(alpha: np.ndarray, radiance: float) -> np.ndarray:
    return np.concatenate([np.repeat(radiance * alpha[..., None], 3, axis=-1), alpha[..., None]], axis=-1)


def test_the_same_picture_has_no_error():
    errors = shell_errors(_picture(_ring(), 0.5), _picture(_ring(), 0.5))
    assert errors == (1, 1, 0)


def test_a_hole_counts_for_alpha_and_not_for_the_outline():
    ring = _ring()
    disk = without_holes(ring)
    assert disk.sum() > ring.sum() + 90
    errors = shell_errors(_picture(disk, 0.6), _picture(ring, 0.5))
    assert errors.outline == 1
    assert errors.alpha == pytest.approx(ring.sum() / disk.sum())
    assert errors.light == pytest.approx(0.2)


def test_soft_intersection_over_union():
    assert soft_iou(np.array([0.5, 1, 0]), np.array([1, 0.5, 0])) == pytest.approx(0.5)


@pytest.mark.parametrize("surface", [Sphere(6, 0.1), Cylinder(12, 3, 0.1), Cloth(4, 0.1)])
def test_a_tile_s_plane_lies_on_the_smooth_surface_and_its_top_over_it(surface):
    corners = np.array([[x, y, h] for h in (0, 0.02) for x, y in ((0, 0), (0.1, 0), (0.1, 0.1), (0, 0.1))])
    tile = {
        "positions": corners,
        "triangles": np.array([[0, 1, 2], [4, 5, 6]], np.uint32),
        "material_slots": np.zeros(2, np.uint32),
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
    with Tile.create("net") as tile, Model.load(model_file) as plain, Scene() as scene:
        tiles.add(tile, scene)
        shell, _report = tiles.with_shell(scene, tile.info(), plain)
        shot = Shot(Sphere(3, tile.info()["period"][0]), 16, 64, 16)
        with shell:
            truth, found, smooth = shot.of_geometry(tile, plain), shot.of_model(shell), shot.of_model(plain)
    errors, control = (shell_errors(each.pixels, truth.pixels) for each in (found, smooth))
    assert errors.alpha > 0.9 > control.alpha
    assert errors.outline > 0.9
    blocks = [each.pixels.reshape(8, 8, 8, 8, 4).mean(axis=(1, 3)) for each in (truth, found, smooth)]
    of_shell, of_smooth = (np.square(each - blocks[0]).sum() for each in blocks[1:])
    assert of_shell < 0.05 * of_smooth
    assert found.bytes < 0.5 * truth.bytes
