"""From an observed scene to a model reduced to it, and what other pictures are told."""

from __future__ import annotations

import csv

import numpy as np
import pytest
from campaigns import run_script
from command_line import velour
from inputs import write_merl
from velour.native import Model, Observation, images

SEEN = "0,-1.93,2.3,0,0,0,20"  # at some 40 degrees
MOVED = "0,-2.9,0.6,0,0,0,20"


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A patch under an even sky, a measurement, its full model, an observation and the reduced model."""
    folder = tmp_path_factory.mktemp("for_scene")
    corners = "v -0.5 -0.5 0\nv 0.5 -0.5 0\nv 0.5 0.5 0\nv -0.5 0.5 0\n"
    (folder / "patch.obj").write_text(corners + "f 1 2 3\nf 1 3 4\n")
    images.write(folder / "sky.exr", np.ones((16, 32, 3), np.float32))
    write_merl(folder / "m.binary")
    assert velour("fit", folder / "m.binary", "-o", folder / "full.velour").status == 0
    observed = velour(
        "observe", *scene(folder), "-o", folder / "SCENE.json", "--material", folder / "full.velour"
    )
    assert observed.status == 0, observed.err
    return folder


def scene(folder, camera=SEEN, world="sky.exr"):
    files = ["--mesh", folder / "patch.obj", "--up", "z", "--world", folder / world]
    return [*files, "--camera", camera, "--size", "32x24"]


@pytest.fixture(scope="module")
def reduced(folder):
    report = velour(
        "fit", folder / "m.binary", "--for-scene", folder / "SCENE.json", "--full-model",
        folder / "full.velour", "-o", folder / "small.velour", "--json",
    )  # fmt: skip
    assert report.status == 0, report.err
    return report.json


def test_the_reduced_model_is_smaller_and_says_for_what_it_is(folder, reduced):
    with Model.load(folder / "full.velour") as full, Model.load(folder / "small.velour") as small:
        assert 3 * small.info()["parameter_bytes"] <= full.info()["parameter_bytes"]
        assert small.info()["scene"] == reduced["scene"]
        assert "scene" not in full.info()
        low, high = small.info()["view_range"]
    assert 25 < low < 40 < high < 55
    assert reduced["scene"]["picture_error"] <= 1.05 * reduced["scene"]["full_picture_error"] + 1e-12
    assert reduced["by_view_angle"]["75"] is None
    with Observation.load(folder / "SCENE.json") as observation:
        assert observation.info()["hash"] == reduced["scene"]["hash"]


def picture(folder, material, *more, camera=SEEN, world="sky.exr"):
    out = folder / "picture.exr"
    arguments = [*scene(folder, camera, world), "--material", folder / material, "--spp", "16", "-o", out]
    done = velour("render", *arguments, *more, "--json")
    assert done.status == 0, done.err
    return done, images.read(out)


def test_the_picture_it_was_made_for_is_inside(folder, reduced):
    done, _ = picture(folder, "small.velour", "--full-model", folder / "full.velour")
    assert done.json["out_of_domain"] <= 1e-3
    assert "outside" not in done.err


def test_a_moved_camera_takes_the_full_model_and_says_so(folder, reduced):
    done, pixels = picture(folder, "small.velour", "--full-model", folder / "full.velour", camera=MOVED)
    assert done.json["out_of_domain"] > 0.9
    assert "the full model is used" in done.err
    _, full = picture(folder, "full.velour", camera=MOVED)
    assert np.array_equal(pixels, full)


def test_strict_usage_refuses_a_moved_camera(folder, reduced):
    strict = "--full-model", folder / "full.velour", "--strict-usage"
    picture(folder, "small.velour", *strict)
    arguments = [*scene(folder, MOVED, "sky.exr"), "--material", folder / "small.velour", *strict]
    refused = velour("render", *arguments, "--spp", "16", "-o", folder / "refused.exr")
    assert refused.status == 1
    assert "small.velour was fitted for" in refused.err
    assert not (folder / "refused.exr").exists()


def test_without_the_full_model_there_is_a_warning(folder, reduced):
    done, _ = picture(folder, "small.velour", camera=MOVED)
    assert "--full-model" in done.err
    assert done.json["out_of_domain"] > 0.9


def test_a_small_sun_is_outside(folder, reduced):
    sky = np.ones((64, 128, 3), np.float32)
    sky[50, 40] = 5e4
    images.write(folder / "sun.exr", sky)
    done, _ = picture(folder, "small.velour", world="sun.exr")
    assert done.json["out_of_domain"] > 0.9


def test_models_for_any_scene_have_no_domain(folder):
    done, _ = picture(folder, "full.velour")
    assert done.json["out_of_domain"] is None
    arguments = [*scene(folder), "--material", folder / "full.velour", "--full-model", folder / "full.velour"]
    refusal = velour("render", *arguments, "-o", folder / "x.exr")
    assert refusal.status == 1
    assert "--full-model" in refusal.err


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        (["--full-model", "full.velour"], "--for-scene"),
        (["--for-scene", "SCENE.json", "--model", "scattered"], "parametric"),
        (["--for-scene", "SCENE.json", "--full-model", "small.velour"], "reduced"),
        (["--for-scene", "m.binary"], "m.binary"),
        (["--limit-albedo", "--model", "scattered"], "albedo"),
    ],
)
def test_what_makes_no_sense_is_refused(folder, reduced, arguments, word):
    inside = [folder / a if (folder / str(a)).is_file() else a for a in arguments]
    done = velour("fit", folder / "m.binary", *inside, "-o", folder / "no.velour")
    assert done.status not in (0, 2)
    assert word in done.err
    assert not (folder / "no.velour").exists()


@pytest.mark.long
def test_the_script_writes_its_part_of_the_page(folder, tmp_path, data_folder):
    assert run_script("for_scene", tmp_path, data=data_folder).returncode == 0
    page = (tmp_path / "out/for_scene.md").read_text(encoding="utf-8")
    with (tmp_path / "out/for_scene.csv").open(encoding="utf-8") as file:
        (row,) = (row for row in csv.DictReader(file) if row["moved camera"])  # others state conditions
    assert float(row["moved camera"]) > 0
    assert f"| {row['material']} |" in page
