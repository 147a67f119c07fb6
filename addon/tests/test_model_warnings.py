"""What the panel says of a model that misses its tolerance: one sentence, whatever the number of views."""

from __future__ import annotations

import pytest


def _info(path) -> dict:
    from velour.native import Model

    with Model.load(path) as model:
        return model.info()


def test_missed_views_are_one_sentence(model_file):
    from velour.core.model_warnings import panel_warnings
    from velour.core.warning_table import sentence

    info = _info(model_file)
    codes = [warning["code"] for warning in info["warning_codes"]]
    assert codes[:2] == ["views_exceed_tolerance", "fitted_views_exceed_tolerance"]
    first, *others = panel_warnings(info | {"verdict": None})
    assert first.startswith("The model exceeds Max Error (0.0001, twice that beyond 75°) at 5°, 30°")
    assert others == [sentence(warning) for warning in info["warning_codes"][2:]]
    assert panel_warnings(info) == [s for s in others if "noise" not in s], "the verdict says it"


def test_views_between_the_reported_ones_are_told_if_no_others_are():
    from velour.core.model_warnings import panel_warnings

    angles = {"views": [72.1], "azimuths": [], "worst": 72.1, "worst_azimuth": []}
    fitted = {
        "code": "fitted_views_exceed_tolerance",
        "values": {**angles, "missed": 1, "fitted": 96, "lobes": 3, "error": 0.05, "tolerance": 0.02},
    }
    reported = {
        "code": "views_exceed_tolerance",
        "values": {"views": [75.0], "errors": [0.1], "tolerance": 0.02},
    }
    (told,) = panel_warnings({"warning_codes": [fitted]})
    assert told.startswith("1 of 96 fitted views exceed Max Error (0.02) with at most 3 lobes")
    assert "the first at 72.1°." in told
    (told,) = panel_warnings({"warning_codes": [reported, fitted]})
    assert told.startswith("The model exceeds Max Error (0.02")


@pytest.mark.parametrize(
    ("albedo", "gain", "said"),
    [
        (0.9, (1.0, 1.0, 1.0), None),
        (0.9, (1.0, 1.1, 1.0), None),
        (0.9, (1.0, 2.0, 0.5), "1.8 times"),
        (1.02, (1.0, 1.0, 1.0), None),  # the measurement's own fault, told elsewhere
        (None, (4.0, 4.0, 4.0), None),
    ],
)
def test_a_tint_that_makes_light_is_told(albedo, gain, said):
    from velour.core.model_warnings import gain_warning

    sentence = gain_warning(albedo, gain)
    assert (sentence is None) if said is None else (said in sentence)


@pytest.mark.parametrize(
    ("info", "reference", "said"),
    [
        ({"model": "parametric"}, False, None),
        ({}, False, None),
        ({"model": "scattered"}, True, "Disable Render from Measurement"),
        ({"texels": [4, 4]}, False, "of a BTF"),
    ],
)
def test_what_cannot_be_made_rougher_is_told(info, reference, said):
    from velour.core.model_warnings import roughness_reason

    sentence = roughness_reason(info, reference)
    assert (sentence is None) if said is None else (said in sentence)
