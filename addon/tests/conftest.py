"""Where things are, and small inputs that every test may use."""

from __future__ import annotations

import os
import shutil
import sys
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[2]
STAGE = Path(os.environ.get("VELOUR_STAGE", ROOT / "build/release/blender"))
ADDONS = STAGE / "addons"
sys.path[:0] = [str(ADDONS), str(ROOT / "scripts/lib"), str(Path(__file__).parent), str(ROOT / "blend-tests")]

import inputs  # noqa: E402

LONG = "long: scripts/test --all runs it"
# Files that take longest, which begin first, so that the workers of a run end together.
SLOWEST = ("test_compress_size", "test_campaigns", "test_compress", "test_for_scene_btf", "test_cli_verbs",
           "test_fit_size", "test_package", "test_shared_cache", "test_thumbnails")  # fmt: skip


def pytest_collection_modifyitems(items):
    """Long tests are left to scripts/test --all."""
    places = {name: place for place, name in enumerate(SLOWEST)}
    items.sort(key=lambda item: places.get(item.path.stem, len(places)))
    if os.environ.get("VELOUR_LONG_TESTS") != "1":
        for item in items:
            if item.get_closest_marker("long"):
                item.add_marker(pytest.mark.skip(reason=LONG))


@pytest.fixture(scope="session")
def measurement_file(tmp_path_factory) -> Path:
    """A small glossy paint in MERL layout."""
    return inputs.write_merl(tmp_path_factory.mktemp("merl") / "paint.binary")


@pytest.fixture(scope="session")
def model_file(tmp_path_factory, measurement_file) -> Path:
    """A coarse model of it."""
    from velour.native import Measurement, fit_job

    path = tmp_path_factory.mktemp("model") / "paint.velour"
    with (
        Measurement.load(measurement_file) as measurement,
        fit_job(measurement, max_lobes=2, tolerance=1e-4) as job,
    ):
        job.run()
        with job.result_model() as model:
            model.save(path)
    return path


@pytest.fixture(scope="session")
def world_file(tmp_path_factory) -> Path:
    """A sky: bright above, dark below, a lamp on one side."""
    from velour.native import images

    pixels = np.full((16, 32, 3), 0.2, np.float32)
    pixels[8:] = 1.0  # row 0 is the bottom
    pixels[11, 20] = 30.0
    path = tmp_path_factory.mktemp("world") / "sky.exr"
    images.write(path, pixels)
    return path


@pytest.fixture(scope="session")
def mesh_file(tmp_path_factory) -> Path:
    return inputs.write_octahedron(tmp_path_factory.mktemp("mesh") / "octahedron.obj")


@pytest.fixture(scope="session")
def compiler() -> str:
    found = shutil.which("gcc") or shutil.which("cc")
    if not found:
        pytest.skip("no C compiler")
    return found


@pytest.fixture(scope="session")
def data_folder() -> Path:
    folder = Path(os.environ.get("VELOUR_DATA", ROOT.parent / "shared/data"))
    if not folder.is_dir():
        pytest.skip("no test data: set VELOUR_DATA")
    return folder
