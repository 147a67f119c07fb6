"""The normal map of a model's approximation: of its own pictures, and only where it brings them nearer."""

import numpy as np
import pytest
from velour.core import normal_map
from velour.core.approximation import Steps
from velour.core.normal_map import NormalMapJob
from velour.native import Model, Scene, Tile, VelourError, votf_job

SIZE = 48


@pytest.fixture(scope="module")
def paint(model_file):
    with Model.load(model_file) as model:
        yield model


@pytest.fixture(scope="module")
def wires(paint):
    """A net of that paint: no BTF, but an outline."""
    with Tile.create("net") as tile, Scene() as scene:
        mesh, materials = tile.add_to(scene)
        scene.add_instance(mesh, np.eye(3, 4), materials)
        scene.commit()
        options = {"texels": SIZE, "period": tile.info()["period"], "reference_height": 0}
        with votf_job(scene, paint, **options) as job:
            job.run()
            with job.result_model() as model:
                yield model


@pytest.fixture(scope="module")
def steps(wires):
    """Run to the end, with what was said meanwhile."""
    steps, said = Steps(wires, has_layers=True, masking=None), []
    while job := steps.next_job():
        job.start().wait(lambda state: said.append((state.stage, state.fraction)))
    return steps.result, said


def _job(model, approximation, **principled):
    values = approximation.principled | principled
    return NormalMapJob(model, values, approximation.diffuse, approximation.color_map)


def _made(*arguments, **principled):
    job = _job(*arguments, **principled)
    job.start().wait()
    return job.result()


def test_an_outline_gets_one(steps):
    normals = steps[0].normal_map
    assert normals.shape == (SIZE, SIZE, 3)
    np.testing.assert_allclose((normals**2).sum(-1), 1, rtol=1e-6)
    tilted = normals[..., 2] < np.cos(np.radians(20))
    assert 0.1 < tilted.mean() < 0.6


def test_the_same_again_is_the_same_to_the_bit(wires, steps):
    again = _made(wires, steps[0])
    assert again.error_with < 0.9 * again.error_without
    np.testing.assert_array_equal(again.normals, steps[0].normal_map)


def test_what_is_flat_gets_none(paint, steps):
    assert _made(paint, steps[0]).normals is None


def test_none_where_it_would_make_pictures_worse(wires, steps, monkeypatch):
    """On a net shown as a metal mirror, a normal map puts highlights where the model has none."""
    mirror = {"metallic": 1.0, "roughness": 0.1}
    found = _made(wires, steps[0], **mirror)
    assert found.error_with > 0.9 * found.error_without
    assert found.normals is None
    monkeypatch.setattr(normal_map, "_LEAST_GAIN", -1e9)
    assert _made(wires, steps[0], **mirror).normals is not None, "that was not why"


def test_its_progress_is_told(steps):
    fractions = [fraction for stage, fraction in steps[1] if stage == "computing normals"]
    assert fractions == sorted(fractions)
    assert fractions[-1] == 1


def test_it_ends_when_it_is_cancelled(wires, steps):
    job = _job(wires, steps[0])
    job.start().cancel()
    with pytest.raises(VelourError, match="cancelled"):
        job.wait()
    job._thread.join(timeout=60)
    assert not job._thread.is_alive()
    assert job._done < job._all
