"""The verdict on a fit in one line: every reason and every remedy has its words."""

from __future__ import annotations

import re

import pytest
from command_line import velour
from conftest import ROOT
from velour.core.verdict import REASONS, line, line_for, with_text

HEADER = ROOT / "native/src/model/records.h"


def info(quality: str, reason: str | None = None, value: float = 0.0, **changes) -> dict:
    """A parametric model's, fitted with 16 lobes that did not suffice."""
    order = {"lobes": [1, 8, 16], "parameter_bytes": [1, 2, 3], "worst": [9.0, 3.0, 1.5], "chosen": 2}
    return {
        "model": "parametric",
        "tolerance": 0.02,
        "order": order,
        "source": {"name": "paint", "sha256": "a" * 64},
        "warning_codes": [],
        "verdict": {"quality": quality, "flip_mean": 0.05, "flip_95": 0.1, "reason": reason, "value": value},
        **changes,
    }


def order(**changes) -> dict:
    return {"order": info("fair")["order"] | changes}


def codes_of(header: str) -> set[str]:
    """The reasons that the library names."""
    enum = header[header.index("enum class LookReason") :]
    return set(re.findall(r"^  (\w+),", enum[: enum.index("};")], re.MULTILINE)) - {"none"}


def test_every_reason_has_its_words():
    assert codes_of(HEADER.read_text(encoding="utf-8")) == {
        *REASONS,
        *("brightness", "measurement_noise", "unresolved_highlights"),
        *("anisotropic_samples", "held_out_samples"),
    }


@pytest.mark.parametrize(
    ("model", "said"),
    [
        (info("good"), "Good: looks like the measurement"),
        (info("fair", "grazing_views", 60.0), "Fair: differs at grazing views; more lobes?"),
        (info("fair", "highlights"), "Fair: differs in the highlights; more lobes?"),
        (info("fair", "everywhere"), "Fair: differs at all views; more lobes?"),
        (info("poor", "color"), "Poor: differs in color. Fit with more lobes"),
        (info("poor", "brightness", 1.25), "Poor: 25% brighter than the measurement. Fit with more lobes"),
        (info("poor", "brightness", 0.5), "Poor: 50% darker than the measurement. Fit with more lobes"),
        (info("poor", None), "Poor: differs from the measurement. Fit with more lobes"),
        (
            info("poor", "measurement_noise", 0.2),
            "Poor: the measurement is noisy. More lobes do not help; use a cleaner measurement",
        ),
        (
            info("poor", "unresolved_highlights", 4.2),
            "Poor: samples 4° apart do not resolve the highlights. More lobes do not help; measure more",
        ),
        (
            info("poor", "anisotropic_samples"),
            "Poor: the surface is brushed, and the model is not. Use a measurement with azimuths",
        ),
        (
            info("fair", "held_out_samples", 1.2),
            "Fair: misses samples that were held out. More lobes do not help; measure more directions",
        ),
        (
            info("poor", "highlights", warning_codes=[{"code": "few_samples", "values": {}}]),
            "Poor: the measurement has too few samples. More lobes do not help; use a denser measurement",
        ),
        (info("fair", "color", **order(worst=[9, 3, 0.9])), "Fair: differs in color; smaller error?"),
        (info("fair", "color", **order(lobes=[1, 8, 32])), "Fair: differs in color; per-view model?"),
        (info("fair", "color", model="scattered", **order(lobes=[1, 8, 64])), "Fair: differs in color"),
        ({"verdict": info("poor", "color")["verdict"], "warning_codes": []}, "Poor: differs in color"),
    ],
)
def test_lines(model, said):
    found = line(model)
    assert found.text == said
    assert found.is_good == said.startswith("Good")
    assert len(found.text) < 100
    assert with_text(model)["text"] == said


@pytest.mark.parametrize(
    ("model", "label", "settings"),
    [
        (info("fair", "color"), "More Lobes", {"max_lobes": 32}),
        (info("fair", "color", **order(lobes=[1, 2, 5])), "More Lobes", {"max_lobes": 10}),
        (info("poor", "color", **order(worst=[9, 3, 1])), "Smaller Error", {"tolerance": 0.01}),
        (
            info("poor", "color", **order(lobes=[1, 2, 32])),
            "Per-View Model",
            {"model": "SCATTERED", "max_lobes": 32},
        ),
        (info("fair", "color", model="scattered"), "More Lobes", {"max_lobes": 32}),
    ],
)
def test_remedies(model, label, settings):
    remedy = line(model).remedy
    assert (remedy.label, remedy.settings) == (label, settings)


def test_good_and_noise_have_no_remedy():
    for model in (info("good"), info("poor", "measurement_noise", 0.2)):
        assert line(model).remedy is None


def test_a_larger_model_of_a_btf():
    tile = {"model": "srbf-btf", "texels": [32, 32], "parameter_bytes": 100_000, "raw_bytes": 40_000_000}
    found = line(info("fair", "everywhere", **tile))
    assert found.text == "Fair: differs at all views; larger model?"
    assert found.remedy.settings == {"megabytes": 0.4}
    assert line(info("fair", "everywhere", **tile | {"raw_bytes": 1_000_000})).remedy is None


def test_models_without_a_verdict_have_no_line():
    assert line({"verdict": None, "warning_codes": []}) is None
    assert line({"warning_codes": []}) is None
    assert with_text({"verdict": None}) is None


def test_a_model_of_another_measurement_is_named():
    good = info("good")
    for digest in (None, "", "a" * 64):
        assert line_for(good, digest) == line(good)
    assert line_for(good, "b" * 64).text == "The model was fitted to another measurement, 'paint'. Fit again"


def test_the_command_line_says_it(measurement_file, model_file, tmp_path):
    fitted = tmp_path / "fitted.velour"
    said = velour("fit", measurement_file, "-o", fitted, "--max-lobes", 1).out
    assert re.search(r"^verdict: (Fair|Poor): .*more lobes", said, re.MULTILINE), said
    report = velour("compare", measurement_file, fitted, "--json").json["verdict"]
    stored = velour("info", fitted, "--json").json["verdict"]
    assert stored["flip_mean"] == pytest.approx(report["flip_mean"], rel=1e-3)
    assert report["text"].split(":")[0] in ("Fair", "Poor")
