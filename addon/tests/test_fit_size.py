"""What a fit of a BTF is said to take of memory before it begins: what the library says itself."""

import re

import numpy as np
import pytest
from velour.core.fit_size import Extent, fit_memory, least_memory, most_bytes
from velour.native import Btf, Scene, VelourError, capture_job, compress_job, directions

_METHODS = ("srbf", "kcta", "tucker", "svd", "svd-view")
_THREADS = 2


@pytest.fixture(
    scope="module", params=[(16, "12", "20", "one"), (24, "10", "9", "two")], ids=["front", "both"]
)
def btf(request, tmp_path_factory):
    texels, views, lights, sides = request.param
    path = tmp_path_factory.mktemp("btf") / "ridge.btf"
    corners = np.array([(0, 0, 0), (0.5, 0, 0.3), (1, 0, 0), (0, 1, 0), (0.5, 1, 0.3), (1, 1, 0)], np.float32)
    triangles = np.array([(0, 1, 4), (0, 4, 3), (1, 2, 5), (1, 5, 4)], np.uint32)
    with Scene() as scene:
        mesh, _ = scene.add_mesh(corners, triangles)
        paint = scene.add_principled_material(base_color=(0.8, 0.5, 0.2), roughness=1.0, specular=0.0)
        scene.add_instance(mesh, np.eye(4), [paint])
        scene.commit()
        options = {"texels": texels, "views": directions(views), "lights": directions(lights)}
        with capture_job(scene, path, period=(1, 1), sides=sides, samples=1, bounces=0, **options) as job:
            job.run()
    with Btf.load(path) as found:
        yield found


def _said(btf, method, memory, **options):
    """The sentence that a limit is refused with, or the warning that it makes another model."""
    options = {"method": method, "memory": memory, "threads": _THREADS, **options}
    with compress_job(btf, **options) as job:
        try:
            return " ".join(job.run()["warnings"])
        except VelourError as error:
            return str(error)


def _extent(btf):
    """Of an opaque tile: the two sides that light would pass through to are left out."""
    of = Extent.of(btf.info())
    return of._replace(sides=(of.sides + 1) // 2)


def _megabytes(size):
    return -(-size // 1_000_000)


@pytest.mark.parametrize("asked", [0, 60_000])
@pytest.mark.parametrize("method", _METHODS)
def test_least_is_what_the_library_asks_for(btf, method, asked):
    of = _extent(btf)
    least = least_memory(of, method, asked, threads=_THREADS)
    assert least < 1 << 30
    said = re.search(r"holds (\d+) MB at least", _said(btf, method, 1_000_000, bytes=asked))
    assert said, method
    assert int(said[1]) == _megabytes(least)
    # A control: of larger pictures it is another number.
    larger = of._replace(width=4 * of.width, height=4 * of.height)
    assert _megabytes(least_memory(larger, method, asked, threads=_THREADS)) != int(said[1])


def test_all_of_it_is_what_leaves_srbfs_as_they_are(btf):
    of = _extent(btf)
    least, whole = (f(of, "srbf", threads=_THREADS) for f in (least_memory, fit_memory))
    limit = _megabytes(least) * 1_000_000
    said = re.search(r"(\d+) MB would leave them all", _said(btf, "srbf", limit))
    assert said
    assert int(said[1]) == _megabytes(whole)


@pytest.mark.parametrize("method", _METHODS)
def test_a_model_is_no_larger_than_said(btf, method):
    of = _extent(btf)
    with compress_job(btf, method=method, threads=_THREADS) as job:
        bytes_of = job.run()["parameter_bytes"]
    assert bytes_of <= most_bytes(of, method)
    assert bytes_of > most_bytes(of, method) / 4, "the bound says nothing"
