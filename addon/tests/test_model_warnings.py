"""What the panel says of a model that misses its tolerance: one sentence, whatever the number of views."""

from __future__ import annotations

import pytest


def _info(path) -> dict:
    from velour.native import Model

    with Model.load(path) as model:
        return model.info()


def test_missed_views_are_one_sentence(model_file):
    from velour.core.model_warnings import panel_warnings
    from velour.core.plain_words import plain

    info = _info(model_file)
    about_views = [w for w in info["warnings"] if w.startswith(("view ", "fitted views"))]
    assert len(about_views) > 3
    first, *others = panel_warnings(info)
    assert first.startswith("The model exceeds Max Error (0.0001) at 5°, 30°")
    assert others == [plain(w) for w in info["warnings"] if w not in about_views]


def test_views_that_were_not_measured_are_one_sentence():
    from velour.core.model_warnings import panel_warnings

    warnings = [f"view {angle} degrees: the measurement does not cover it" for angle in (75, 85)]
    (sentence,) = panel_warnings({"warnings": warnings, "tolerance": 0.02})
    assert sentence.startswith("The measurement has no view at 75°, 85°, so")


def test_views_between_the_reported_ones():
    from velour.core.model_warnings import panel_warnings

    warnings = [
        "fitted views that miss the tolerance with at most 3 lobes (degrees): 72.1; the worst is 72.1"
    ]
    (sentence,) = panel_warnings({"warnings": warnings, "tolerance": 0.02})
    assert sentence.startswith("The model exceeds Max Error (0.02) between the reported views.")


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


def test_a_tolerance_is_told_in_plain_words():
    from velour.core.model_warnings import tolerance_words

    told = [tolerance_words(tolerance) for tolerance in (0.0005, 0.02, 0.1, 1.0)]
    assert told[1].startswith("Error of at most 2 % up to 75\N{DEGREE SIGN}, twice that beyond: most images")
    assert len({sentence.split(": ")[1] for sentence in told}) == 4
