"""What an outline is said to take before it begins."""

import math

import numpy as np
import pytest
from velour.core.outline_size import (
    Made,
    grid,
    is_too_large,
    outline_memory,
    outline_seconds,
    outline_text,
    probes,
)
from velour.native import Model, Scene, Tile, VelourError, votf_job


def _scene(scene, tile):
    mesh, materials = tile.add_to(scene)
    scene.add_instance(mesh, np.eye(4)[:3], materials)
    scene.commit()
    return {"period": tile.info()["period"], "origin": (0, 0)}


@pytest.mark.parametrize("kind", ["net", "gravel"])
def test_a_probe_tells_the_points_of_any(model_file, kind):
    with Model.load(model_file) as model, Tile.create(kind, resolution=6) as tile, Scene() as scene:
        place = {**_scene(scene, tile), "reference_height": 0.0, "check_views": 0}

        def made(texels):
            with votf_job(scene, model, texels=texels, **place) as job:
                return Made.of(job.run(), job.poll().seconds)

        for texels in (24, 50, 96):
            assert grid(texels, made(48)) == made(texels).points


def test_what_is_too_large_is_what_the_library_refuses(model_file):
    """A needle a few tiles high, of which so many points are too many."""
    with Model.load(model_file) as model, Scene() as scene:
        corners = [(0, 0, 0), (1, 0, 0), (0, 1, 3)]
        mesh, _ = scene.add_mesh(np.array(corners, np.float32), np.array([(0, 1, 2)], np.uint32))
        paint = scene.add_principled_material(base_color=(0.8, 0.5, 0.2), roughness=1.0, specular=0.0)
        scene.add_instance(mesh, np.eye(4)[:3], [paint])
        scene.commit()
        place = {"period": (1, 1), "origin": (0, 0), "reference_height": 0.0, "check_views": 0}
        with votf_job(scene, model, texels=16, **place) as job:
            made = Made.of(job.run(), job.poll().seconds)
        assert not is_too_large(grid(64, made))
        assert is_too_large(grid(400, made))
        assert "too large" in outline_text(400, (made, made, made))
        with (
            votf_job(scene, model, texels=400, **place) as job,
            pytest.raises(VelourError, match="too large"),
        ):
            job.run()


def _took(texels, power=1.25):
    """An outline of a tile a fifth as high as wide: 3 seconds before it, distances, looks."""
    points = (texels, texels, math.ceil(0.2 * texels) + 3)
    seconds = 1e-7 * math.prod(points) ** power
    looks = 20e-6 * texels**2
    height = (-1 / texels, 0.2 + 1 / texels)
    return Made(points, height, seconds, 0.1 + seconds + looks, 0.5 / texels)


def _probed(texels, **law):
    _first, few, many = (_took(p.texels, **law) for p in probes(texels))
    return Made(_took(4).points, _took(4).heights, 3.0, 3.1, None), few, many


@pytest.mark.parametrize("power", [1.05, 1.25, 1.5])
def test_two_small_ones_tell_how_its_time_grows(power):
    whole = _took(512, power=power)
    told = outline_seconds(512, _probed(512, power=power))
    assert told == pytest.approx(3.0 + whole.whole, rel=0.1)


def test_noise_makes_nothing_absurd():
    first, few, many = _probed(256)
    honest = outline_seconds(256, (first, few, many))
    for wrong in (few._replace(seconds=1e-6), few._replace(seconds=1e3), few._replace(seconds=0.0)):
        assert 0.3 * honest < outline_seconds(256, (first, wrong, many)) < 3 * honest
    assert outline_seconds(4, (first, _took(4), _took(4))) > 0


def test_memory_grows_with_the_points():
    assert outline_memory((128, 128, 18)) > 20 * 128 * 128 * 18
    assert outline_memory((256, 256, 36)) == pytest.approx(8 * outline_memory((128, 128, 18)), rel=0.15)


def test_words():
    text = outline_text(256, _probed(256))
    assert text.startswith("About ")
    assert "a few seconds for the approximation in other engines" in text
    assert "MB in the model (256 x 256 x 55 points)" in text
    assert "wrong rays at coarser resolutions: 0.78% at 64, 0.39% at 128" in text
