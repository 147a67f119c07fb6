"""One cache folder that several processes read and write at once, as machines do over a network."""

import hashlib
import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from velour.core import fit_time
from velour.core.measurement_files import find_measurements
from velour.core.thumbnails import thumbnail
from velour.native import Model, Scene, render_job

_SKIES = 2
_FIT = fit_time.Fit("srbf", 1000, 1000, False, False, False, 2)


_CORNERS = np.array([[-1, -1, 0], [1, -1, 0], [0, 1, 0]], np.float32)


def _sky(number, model, cache):
    """SHA-256 of a picture that samples directions from a fit of the world, or what the cache has of it."""
    pixels = np.full((8, 16, 3), 0.2, np.float32)
    pixels[5, 3 + 4 * number] = 20.0
    with Scene() as scene, Model.load(model) as paint:
        mesh, _ = scene.add_mesh(_CORNERS, np.array([[0, 1, 2]], np.uint32))
        scene.add_instance(mesh, np.eye(3, 4), [scene.add_model_material(paint)])
        scene.set_world_pixels(pixels)
        scene.look_at((0, 0, 3), (0, 1e-6, 0), 0.3, 1.0)
        scene.commit()
        options = {"width": 4, "height": 4, "spp": 8, "strategy": "product", "cache_folder": cache}
        with render_job(scene, **options) as job:
            job.run()
            return hashlib.sha256(job.read_pass("Combined").tobytes()).hexdigest()


def _pictures(folder, cache):
    made = [thumbnail(file, cache, lambda: None) for file in find_measurements(folder).files]
    return [hashlib.sha256(each.pixels.tobytes()).hexdigest() for each in made]


def _work(process, rounds, folder, cache):
    """What one process sees, round by round; takes away results that others may be about to read."""
    skies, pictures = [], []
    for turn in range(rounds):
        skies.append([_sky(number, next(folder.iterdir()), cache) for number in range(_SKIES)])
        pictures.append(_pictures(folder, cache))
        fit_time.remember(cache, _FIT, float(1 + process * rounds + turn))
        for path in [*cache.glob("sky-*"), *cache.glob("thumbnails-*/*.npz")][process % 2 :: 2]:
            path.unlink(missing_ok=True)
    return {"skies": skies, "pictures": pictures}


def _begun(process, rounds, folder, cache):
    command = [sys.executable, __file__, *map(str, (process, rounds, folder, cache))]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    return subprocess.Popen(command, env=environment, stdout=subprocess.PIPE, text=True)


@pytest.mark.parametrize(("count", "rounds"), [(4, 2), pytest.param(8, 3, marks=pytest.mark.long)])
def test_processes_share_a_cache(count, rounds, tmp_path, model_file):
    folder, cache = tmp_path / "measurements", tmp_path / "cache"
    folder.mkdir()
    shutil.copy(model_file, folder)
    expected = {
        "skies": [[_sky(number, model_file, tmp_path / "own") for number in range(_SKIES)]] * rounds,
        "pictures": [_pictures(folder, tmp_path / "own")] * rounds,
    }
    processes = [_begun(process, rounds, folder, cache) for process in range(count)]
    seen = [process.communicate()[0] for process in processes]
    assert [process.returncode for process in processes] == [0] * count
    for each in seen:
        assert json.loads(each) == expected
    found = fit_time._known(cache)
    assert sorted(made.seconds for made in found) == list(range(1, 1 + count * rounds))
    left = [path for path in cache.rglob("*") if path.name.startswith(".") or ".velour-" in path.name]
    assert left == []


if __name__ == "__main__":
    json.dump(_work(int(sys.argv[1]), int(sys.argv[2]), Path(sys.argv[3]), Path(sys.argv[4])), sys.stdout)
