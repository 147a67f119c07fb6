"""Passes beyond those that every picture has."""

from __future__ import annotations

import numpy as np
import pytest
from velour.native import (
    INSTANCE_LABEL,
    MATERIAL_LABEL,
    Passes,
    Scene,
    VelourError,
    cryptomatte_id,
    render_job,
    table,
)
from velour.native.passes import sums_per_pixel

_CORNERS = np.array([[-9, -9, 0], [9, -9, 0], [9, 9, 0], [-9, 9, 0]], np.float32)
_TRIANGLES = np.array([[0, 1, 2], [0, 2, 3]], np.uint32)


@pytest.fixture(name="scene")
def _scene():
    """A square that fills the picture, two metres below the camera."""
    with Scene() as scene:
        material = scene.add_principled_material(base_color=(0.5, 0.5, 0.5), specular=0.0)
        mesh, _ = scene.add_mesh(_CORNERS, _TRIANGLES)
        scene.add_instance(mesh, np.eye(4)[:3], [material])
        scene.set_world_color((1, 1, 1))
        scene.look_at((0, 0, 2), (0, 0.001, 0), 0.5, 1.0)
        scene.commit()
        yield scene


def test_labels_and_mist(scene):
    passes = Passes(
        frozenset({"object_index", "material_index", "crypto_object", "mist"}),
        mist=(1.0, 2.0, 1.0),
        instances=np.array([(3, cryptomatte_id("Square").value, 0, -1)], INSTANCE_LABEL),
        materials=np.array([(4, 0)], MATERIAL_LABEL),
    )
    with render_job(scene, passes, width=8, height=8, spp=16) as job:
        job.run()
        np.testing.assert_array_equal(job.read_pass("IndexOB"), 3)
        np.testing.assert_array_equal(job.read_pass("IndexMA"), 4)
        ids = job.read_pass("CryptoObject00")
        np.testing.assert_array_equal(ids[..., 0], np.float32(cryptomatte_id("Square").value))
        np.testing.assert_array_equal(ids[..., 1:], (np.ones((8, 8, 1)) * (1, 0, 0)))
        np.testing.assert_allclose(job.read_pass("Mist")[3:5, 3:5], 0.5, atol=0.01)
        for name in ("Position", "CryptoAsset00", "CryptoObject03"):
            with pytest.raises(VelourError, match="not requested"):
                job.read_pass(name)


@pytest.mark.parametrize(
    "asked", [None, (), ("position", "mist"), ("crypto_asset", "error"), tuple(table.PASSES)]
)
def test_a_film_is_as_large_as_is_said_before(scene, asked):
    passes = None if asked is None else Passes(frozenset(asked), cryptomatte_ranks=4)
    with render_job(scene, passes, width=3, height=2) as job:
        assert job.sums_per_pixel() == sums_per_pixel(passes)
        assert job.read_sums().shape == (2, 3, sums_per_pixel(passes))


def test_sums_of_another_film_are_refused(scene):
    with render_job(scene, width=2, height=2) as other:
        sums = other.read_sums()
    with render_job(scene, width=3, height=2) as job, pytest.raises(VelourError, match="72 numbers, not 48"):
        job.add_sums(sums)


def test_labels_of_another_kind_are_refused(scene):
    passes = Passes(frozenset({"object_index"}), instances=np.zeros(1, MATERIAL_LABEL))
    with pytest.raises(VelourError, match="instances"):
        render_job(scene, passes, width=8, height=8)


def test_ids_are_as_manifests_have_them():
    found = cryptomatte_id("hello")
    assert (found.hash, found.text) == (0x248BFA47, "248bfa47")
    assert np.float32(found.value).view(np.uint32) == found.hash
