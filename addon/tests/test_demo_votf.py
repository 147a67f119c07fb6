"""The demonstration of shells, small."""

import unittest.mock

import demo
import numpy as np
import pytest
from velour.native import Measurement, fit_job, images, microsurface_job


@pytest.fixture(scope="module")
def metal(tmp_path_factory):
    folder = tmp_path_factory.mktemp("metal")
    with microsurface_job(folder / "metal.exr", rays=60_000) as job:
        job.run()
    with Measurement.load(folder / "metal.exr") as measured, fit_job(measured, max_lobes=2) as job:
        job.run()
        with job.result_model() as model:
            model.save(folder / "metal.velour")
    return folder / "metal.velour"


def blocks(picture: np.ndarray) -> np.ndarray:
    """Means of 6 x 6 pixels: what is left is hardly noise."""
    return picture[..., :3].reshape(9, 6, 16, 6, 3).mean(axis=(1, 3))


def test_shells_look_like_the_geometry_that_they_stand_for(metal, tmp_path):
    begun = []
    with unittest.mock.patch.multiple(demo, _ROWS=3, _CLOTH=2):
        report = demo.make_votf_pictures(tmp_path, metal, (96, 54), 64, begin=begun.append)
    assert begun == [*demo.VOTF.steps][1:]
    shell, geometry = (blocks(images.read(tmp_path / f"{name}.exr")) for name in ("model", "reference"))
    floor = geometry[-1:].mean(axis=1, keepdims=True)
    assert np.square(shell - geometry)[2:].sum() < 0.1 * np.square(floor - geometry[2:]).sum()
    assert shell.mean() == pytest.approx(geometry.mean(), rel=0.02)
    assert report["model"]["bytes"] < 0.1 * report["reference"]["bytes"]
