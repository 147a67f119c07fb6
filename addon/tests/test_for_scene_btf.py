"""From an observed scene to a model of a BTF without the texels that it does not resolve."""

from __future__ import annotations

import functools
import shutil

import numpy as np
import pytest
from command_line import velour
from inputs import write_merl
from kept import captured
from velour.native import Btf, Model, Observation, compress_job, images

# A plane of 3 x 3 tiles of 32 texels, seen over 24 pixels: 4 texels a pixel. Half as far: 2.
FAR = "0,0.001,100,0,0,0,1.71861"
NEAR = "0,0.001,50,0,0,0,1.71861"
OBLIQUE = "0,-70.7,70.7,0,0,0,1.71861"


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A BTF, its full models, a plane, a sky and an observation."""
    folder = tmp_path_factory.mktemp("for_scene_btf")
    (folder / "btf").symlink_to(captured("corduroy", 32, 12, 12, 4))
    # With few lobes, a refit to an eighth of the bytes is better than the coarse levels.
    for name, method, size in (("srbf", "srbf", 60000), ("few", "srbf", 20000), ("svd", "svd", 60000)):
        full = folder / f"{name}.velour"
        done = velour("compress", folder / "btf", "--method", method, "--bytes", size, "-o", full, "--quiet")
        assert done.status == 0, done.err
    corners = "v -1.5 -1.5 0\nv 1.5 -1.5 0\nv 1.5 1.5 0\nv -1.5 1.5 0\nvt 0 0\nvt 3 0\nvt 3 3\nvt 0 3\n"
    (folder / "plane.obj").write_text(corners + "f 1/1 2/2 3/3\nf 1/1 3/3 4/4\n")
    images.write(folder / "sky.exr", np.ones((16, 32, 3), np.float32))
    observe(folder, folder / "far.json", FAR)
    return folder


def scene(folder, material, camera=FAR):
    files = ["--mesh", folder / "plane.obj", "--up", "z", "--world", folder / "sky.exr"]
    return [*files, "--material", material, "--camera", camera, "--size", "24x24"]


def observe(folder, path, camera, material="srbf.velour"):
    done = velour("observe", *scene(folder, folder / material, camera), "-o", path, "--json")
    assert done.status == 0, done.err
    return done.json


@functools.cache
def reduce(folder, method, observation="far.json"):
    out = folder / f"{method}.{observation}.velour"
    done = velour(
        "compress", folder / "btf", "--for-scene", folder / observation, "--full-model",
        folder / f"{method}.velour", "-o", out, "--json",
    )  # fmt: skip
    assert done.status == 0, done.err
    return out, done.json


def picture(folder, material, *more, camera=FAR):
    out = folder / "picture.exr"
    spp = ["--spp", 256, "--split", 4, "--seed", 5]
    done = velour("render", *scene(folder, material, camera), *spp, *more, "-o", out, "--json")
    assert done.status == 0, done.err
    return done, images.read(out)


def test_footprints_are_observed(folder):
    far = observe(folder, folder / "x.json", FAR)["surface"]
    assert far["finest"] == pytest.approx(1 / 8, rel=0.1)
    assert sum(far["footprint"]) == pytest.approx(1)
    assert far["tile_share"] == 1
    near = observe(folder, folder / "x.json", NEAR)["surface"]
    assert near["finest"] == pytest.approx(far["finest"] / 2, rel=0.01)


def test_the_model_itself_is_observed_as_its_btf_and_its_reduction_are(folder):
    small, _ = reduce(folder, "svd")
    seen = [observe(folder, folder / "x.json", FAR, m)["surface"] for m in ("btf", "svd.velour", small)]
    assert seen[0] == seen[1] == seen[2]


def test_what_a_uniform_material_shows_says_nothing_of_footprints(folder, tmp_path):
    write_merl(tmp_path / "m.binary")
    assert velour("fit", tmp_path / "m.binary", "-o", folder / "m.velour").status == 0
    assert "surface" not in observe(folder, folder / "uniform.json", FAR, "m.velour")
    done = velour(
        "compress", folder / "btf", "--for-scene", folder / "uniform.json", "-o", folder / "no.velour"
    )
    assert done.status not in (0, 2)
    assert "does not vary" in done.err


@pytest.mark.parametrize(("method", "times"), [("srbf", 3.5), ("svd", 2)])
def test_a_far_plane_needs_fewer_bytes(folder, method, times):
    small, report = reduce(folder, method)
    assert report["texels"] == [16, 16]
    assert report["scene"]["full_texels"] == [32, 32]
    assert report["scene"]["full_parameter_bytes"] > times * report["parameter_bytes"]
    with Model.load(small) as model, Observation.load(folder / "far.json") as observation:
        assert model.info()["scene"] == report["scene"]
        assert observation.info()["hash"] == report["scene"]["hash"]
    _, reference = picture(folder, folder / "btf")
    errors = [
        np.square(picture(folder, path)[1] - reference)[..., :3].mean() / np.square(reference[..., :3]).mean()
        for path in (folder / f"{method}.velour", small)
    ]
    assert errors[1] < errors[0] + 0.002  # of the picture's energy


@pytest.mark.parametrize("method", ["srbf", "svd"])
def test_a_nearer_camera_takes_the_full_model_and_says_so(folder, method):
    small, _ = reduce(folder, method)
    full = folder / f"{method}.velour"
    done, _ = picture(folder, small, "--full-model", full)
    assert done.json["out_of_domain"] == 0
    assert "outside" not in done.err
    done, pixels = picture(folder, small, "--full-model", full, camera=NEAR)
    assert done.json["out_of_domain"] > 0.9
    assert "the full model is used" in done.err
    assert np.array_equal(pixels, picture(folder, full, camera=NEAR)[1])
    done, _ = picture(folder, small, camera=NEAR)
    assert "--full-model" in done.err


@pytest.mark.parametrize("method", ["few", "svd"])
def test_other_views_take_the_full_model_of_a_fit_to_those_seen(folder, method):
    small, report = reduce(folder, method)
    assert report["scene"]["seen_views_alone"]
    assert report["scene"]["picture_error"] > 0
    done, _ = picture(folder, small, "--full-model", folder / f"{method}.velour", camera=OBLIQUE)
    assert done.json["out_of_domain"] > 0.9
    assert "the full model is used" in done.err


def test_frames_from_near_and_far_need_what_the_nearest_needs(folder):
    both = folder / "both.json"
    options = scene(folder, folder / "svd.velour", NEAR)
    assert velour("observe", *options, "--merge", folder / "far.json", "-o", both).status == 0
    _, report = reduce(folder, "svd", "both.json")
    assert report["texels"] == [32, 32]
    assert any("needs the full model" in warning for warning in report["warnings"])


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        (["--full-model", "svd.velour"], "--for-scene"),
        (["--for-scene", "far.json", "--full-model", "small.velour"], "reduced"),
        (["--for-scene", "btf/btf.json"], "btf.json"),
    ],
)
def test_what_makes_no_sense_is_refused(folder, arguments, word):
    shutil.copy(reduce(folder, "svd")[0], folder / "small.velour")
    inside = [folder / a if (folder / str(a)).is_file() else a for a in arguments]
    done = velour("compress", folder / "btf", *inside, "-o", folder / "no.velour")
    assert done.status not in (0, 2)
    assert word in done.err
    assert not (folder / "no.velour").exists()


def test_the_fit_of_the_full_model_is_not_all_of_the_progress(folder):
    """The reduction that follows still has its part of it."""
    shown = []
    with (
        Btf.load(folder / "btf") as btf,
        Observation.load(folder / "far.json") as seen,
        compress_job(btf, method="svd", bytes=60000, for_scene=seen) as job,
    ):
        job.start()
        while not job.wait(timeout=0.001):
            shown.append(job.poll())
    fits = [state for state in shown if state.running and state.stage != "reducing to the scene"]
    assert fits
    assert max(state.fraction for state in fits) < 0.99
