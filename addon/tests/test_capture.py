"""velour capture of tiles: directions by default, one direction, held-out pairs that models are judged by."""

from __future__ import annotations

import numpy as np
import pytest
from command_line import refused, velour
from inputs import write_ribs
from velour.native import Btf

PAIRS = 12
COMMON = ["--texels", 8, "--samples", 4, "--sides", "one", "--quiet"]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("btf")


@pytest.fixture(scope="module")
def ribs(folder):
    return write_ribs(folder / "ribs.obj")


@pytest.fixture(scope="module")
def held_out(folder, ribs):
    path = folder / "held-out"
    report = velour("capture", ribs, *COMMON, "--held-out", PAIRS, "-o", path, "--json").json
    assert (report["views"], report["lights"], report["pairs"]) == (PAIRS, PAIRS, PAIRS)
    return path


@pytest.fixture(scope="module")
def btf(folder, ribs):
    path = folder / "fitted"
    assert velour("capture", ribs, *COMMON, "--views", 12, "--lights", 12, "-o", path).status == 0
    return path


def test_captures_reach_85_degrees_by_default(folder, ribs):
    path = folder / "default"
    few = ["--texels", 1, "--samples", 1, "--bounces", 0]
    report = velour("capture", ribs, *few, "-o", path, "--json").json
    assert report["pairs"] == 105 * 105
    with Btf.load(path) as loaded:
        angles = loaded.angles()
    assert angles[:, 0].max() == angles[:, 2].max() == 85


def test_one_direction_makes_a_model(folder, ribs):
    path, model = folder / "single", folder / "single.velour"
    assert velour("capture", ribs, *COMMON, "--views", 1, "--lights", 1, "-o", path).status == 0
    report = velour("compress", path, "-o", model, "--bytes", 100000, "--json").json
    assert report["psnr"] > 30
    assert velour("compare", path, path, "--json").json["pairs"] == 1


def test_every_view_has_a_light_of_its_own(held_out):
    with Btf.load(held_out) as loaded:
        angles = loaded.angles()
        assert loaded.read(0, PAIRS).shape == (PAIRS, 8, 8, 3)
    assert angles.shape == (PAIRS, 4)
    assert len(np.unique(angles, axis=0)) == PAIRS
    assert (angles[:, (0, 2)] <= 75).all()


def test_models_and_tables_are_judged_by_it(folder, btf, held_out):
    model = folder / "judged.velour"
    method = ["--method", "svd", "--bytes", 20000]
    compress = ["compress", btf, "-o", model, "--held-out", held_out, *method, "--json"]
    report = velour(*compress).json
    assert report["psnr_held_out"] < report["psnr"]
    compared = velour("compare", held_out, model, "--json").json
    assert compared["psnr"] == pytest.approx(report["psnr_held_out"], abs=1e-9)
    assert compared["pairs"] == PAIRS
    assert velour("compare", held_out, btf, "--json").json["pairs"] == PAIRS


def test_refusals(folder, ribs, btf, held_out):
    assert "--views" in refused("capture", ribs, *COMMON, "--held-out", 2, "--views", 3, "-o", folder / "no")
    assert "pairs" in refused("compress", held_out, "-o", folder / "no.velour")
    assert "pairs" in refused("compare", btf, held_out)
