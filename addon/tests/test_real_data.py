"""The command line on real measurements."""

from __future__ import annotations

import pytest
from command_line import velour

FORMATS = {
    "satin_rosaline_rgb.bsdf": "rgl",
    "paper_white_rgb.bsdf": "rgl",
    "cc_iris_purple_gem_rgb.bsdf": "rgl",
    "krylon_blue.brdf": "cornell",
}


@pytest.fixture(params=FORMATS)
def real_file(request, data_folder):
    return data_folder / "brdf" / request.param


def test_info(real_file):
    report = velour("info", real_file, "--json").json
    assert report["format"] == FORMATS[real_file.name]
    assert report["isotropic"] is True
    assert 0 < report["entries"]["valid"] <= report["entries"]["total"]


@pytest.mark.long
def test_fit_and_compare(real_file, tmp_path):
    model = tmp_path / "m.velour"
    fit = velour("fit", real_file, "-o", model, "--max-lobes", 4, "--json").json
    assert 0 < fit["relative_l2"] < 0.5
    compared = velour("compare", real_file, model, "--json").json
    assert compared["relative_l2"] == pytest.approx(fit["relative_l2"], rel=0.05)
    assert compared["samples"] > 100


def test_the_up_axis_turns_the_mesh(data_folder, model_file, tmp_path):
    """A y-up mesh in the z-up world: --up z shows another side of it."""
    from velour.native import images

    out = tmp_path / "o.exr"
    mesh, world = data_folder / "mesh/bunny.obj", data_folder / "hdr/studio_small_03_1k.hdr"
    arguments = ["--mesh", mesh, "--world", world, "--material", model_file, "-o", out, "--size", "64x64"]
    assert velour("render", *arguments, "--spp", 8).status == 0
    turned = tmp_path / "turned.exr"
    arguments[arguments.index(out)] = turned
    assert velour("render", *arguments, "--spp", 8, "--up", "z").status == 0
    assert images.compare(images.read(out), images.read(turned))[0] > 0.01
