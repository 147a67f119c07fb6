"""Closures of Blender fitted to a model."""

from __future__ import annotations

import inputs
import numpy as np
import pytest
from conftest import ROOT
from velour.core.approximation import Steps
from velour.native import Model, Status, VelourError

SAMPLES = 65


@pytest.fixture(scope="module")
def model(model_file) -> Model:
    return Model.load(model_file)


@pytest.fixture(scope="module")
def closures(model) -> dict:
    return model.closures()


def test_curves_have_a_sample_per_angle(closures):
    assert np.shape(closures["diffuse"]) == (SAMPLES, 3)
    for lobe in closures["lobes"]:
        assert lobe["distribution"] in ("GGX", "BECKMANN")
        assert np.shape(lobe["color"]) == (SAMPLES, 3)
        assert np.min(lobe["color"]) >= 0
        for key, least, most in (("roughness", 0, 1), ("tilt", -1, 1), ("anisotropy", -0.99, 0.99)):
            assert np.shape(lobe[key]) == (SAMPLES,)
            assert least <= np.min(lobe[key]) <= np.max(lobe[key]) <= most


def test_a_brushed_model_keeps_its_frame(closures):
    brushed = Model.load(inputs.BRUSHED_MODEL).closures(masking="correlated")
    assert (closures["frame"], brushed["frame"]) == ("incidence", "surface")
    assert max(abs(value) for lobe in brushed["lobes"] for value in lobe["anisotropy"]) > 0.2
    assert brushed["relative_l2_mean"] < 0.05


def test_errors_are_per_view_and_small(closures):
    assert closures["views"] == [5, 30, 60, 75, 85]
    assert closures["relative_l2_mean"] == pytest.approx(np.mean(closures["relative_l2"][:4]))
    assert closures["relative_l2_mean"] < 0.05
    assert closures["albedo_excess"] <= 0.01
    assert closures["reason"] == ""
    assert closures["seconds"] > 0


def ggx(alpha: float, cosine: np.ndarray) -> np.ndarray:
    return alpha**2 / (np.pi * (1 - cosine**2 * (1 - alpha**2)) ** 2)


def beckmann(alpha: float, cosine: np.ndarray) -> np.ndarray:
    return np.exp((1 - cosine**-2) / alpha**2) / (np.pi * alpha**2 * cosine**4)


def test_they_show_the_model_at_the_normal(model, closures):
    """There tilt and anisotropy are 0, so a few lines give the closures' value."""
    angle = np.radians([0, 5, 10, 20])
    wl = np.stack([np.sin(angle), 0 * angle, np.cos(angle)], 1).astype(np.float32)
    f, _ = model.eval((0, 0, 1), wl)
    half = np.cos(angle / 2)
    value = np.array(closures["diffuse"][0]) / np.pi * np.cos(angle)[:, None]
    for lobe in closures["lobes"]:
        distribution = ggx if lobe["distribution"] == "GGX" else beckmann
        value += np.outer(distribution(lobe["roughness"][0] ** 2, half) / 4, lobe["color"][0])
    assert value == pytest.approx(f * np.cos(angle)[:, None], rel=0.1)


def test_a_material_with_closures_has_the_coat_and_tints_of_exporters_in_any_blender(model):
    def approximation(has_layers: bool):
        steps = Steps(model, has_layers, "correlated")
        while job := steps.next_job():
            job.start().wait()
        return steps.result

    old, new = approximation(has_layers=False), approximation(has_layers=True)
    assert old.principled == new.principled
    assert old.closures["masking"] == "correlated"


def test_the_page_says_how_dark_lobes_for_newer_blenders_are_in_3_4():
    """In the mirror direction, where view and light are masked alike."""
    page = " ".join((ROOT / "docs/reference/other_programs.md").read_text().split())

    def loss(alpha, degrees):
        masked = (np.sqrt(1 + (alpha * np.tan(np.radians(degrees))) ** 2) - 1) / 2
        return 1 - (1 + 2 * masked) / (1 + masked) ** 2

    at_75, at_85 = (f"{100 * loss(0.5, view):.0f} %" for view in (75, 85))
    assert f"highlights of alpha 0.5 {at_75} darker at 75 degrees, {at_85} at 85" in page


def test_options(model):
    assert len(model.closures(max_lobes=1)["lobes"]) == 1
    assert len(model.closures(tolerance=0.9)["lobes"]) == 1
    assert model.closures(masking="correlated")["lobes"] != model.closures()["lobes"]


@pytest.mark.parametrize(
    ("options", "sentence"),
    [({"max_lobes": 4}, "must be 1, 2 or 3"), ({"tolerance": -0.5}, "must be positive")],
)
def test_options_out_of_range_are_refused(model, options, sentence):
    with pytest.raises(VelourError, match=sentence) as caught:
        model.closures(**options)
    assert caught.value.status == Status.INVALID_ARGUMENT


def test_an_unknown_masking_is_refused(model):
    with pytest.raises(ValueError, match="separable, correlated"):
        model.closures(masking="none")
