"""What a fit of a BTF is said to take of memory before it begins: what the library says itself."""

import re

import numpy as np
import pytest
from velour.core.warning_table import sentences
from velour.native import Btf, Scene, VelourError, capture_job, compress_job, compress_size, directions

_METHODS = ("srbf", "kcta", "tucker", "svd", "svd-view")
_THREADS = 2


@pytest.fixture(
    scope="module", params=[(16, "12", "20", "one"), (16, "10", "9", "two")], ids=["front", "both"]
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
        with capture_job(
            scene, path, period=(1, 1), sides=sides, samples=1, bounces=0, reference_height=0.1, **options
        ) as job:
            job.run()
    with Btf.load(path) as found:
        yield found


def _said(btf, method, memory, **options):
    """The sentence that a limit is refused with, or the warning that it makes another model."""
    options = {"method": method, "memory": memory, "threads": _THREADS, **options}
    with compress_job(btf, **options) as job:
        try:
            return " ".join(sentences(job.run()["warning_codes"]))
        except VelourError as error:
            return str(error)


def _megabytes(size):
    return -(-size // 1_000_000)


@pytest.mark.parametrize("asked", [0, 60_000])
@pytest.mark.parametrize("method", _METHODS)
def test_least_is_what_the_library_asks_for(btf, method, asked):
    least = compress_size(btf, method=method, bytes=asked, threads=_THREADS).least_memory
    said = re.search(r"requires at least (\d+) MB", _said(btf, method, 1_000_000, bytes=asked))
    assert said, method
    of_sides = method == "srbf" and btf.info()["largest_theta"]["view"] > 90  # dark ones are left out later
    assert int(said[1]) < _megabytes(least) if of_sides else int(said[1]) == _megabytes(least)
    assert least < 1 << 30


def test_all_of_it_is_what_leaves_srbfs_as_they_are(btf):
    size = compress_size(btf, method="srbf", threads=_THREADS)
    limit = _megabytes(size.least_memory) * 1_000_000
    said = re.search(r"(\d+) MB would suffice", _said(btf, "srbf", limit))
    assert said
    assert int(said[1]) <= _megabytes(size.memory) <= 2 * int(said[1])
    assert _said(btf, "srbf", _megabytes(size.memory) * 1_000_000) == ""


@pytest.mark.parametrize("method", _METHODS)
def test_a_model_is_no_larger_than_said(btf, method):
    size = compress_size(btf, method=method, threads=_THREADS)
    with compress_job(btf, method=method, threads=_THREADS) as job:
        bytes_of = job.run()["parameter_bytes"]
    assert bytes_of <= size.bytes
    assert bytes_of > size.bytes / 8, "the bound says nothing"


def test_an_error_that_is_asked_for_may_take_more(btf):
    for method in _METHODS:
        usual, searched = (compress_size(btf, method=method, tolerance=t) for t in (0.0, 0.1))
        assert searched.memory >= usual.memory, method
        assert searched.least_memory <= usual.memory, method


def test_a_wrong_option_is_refused(btf):
    with pytest.raises(VelourError, match="tolerance"):
        compress_size(btf, tolerance=2.0)
