"""Every warning of the library has its sentence, with all of its values and without words of engineers."""

from __future__ import annotations

import ast
import re
from string import Formatter

import pytest
from conftest import ROOT
from velour.core import warning_table
from velour.core.warning_table import COMMAND_LINE, PANEL, SENTENCES, sentence

HEADER = ROOT / "native/src/base/warning.h"
JARGON = re.compile(
    r"relmse|relative L2|\bL2\b|reciprocal:|albedo\b|\bRMS\b|coefficient|kcta|clustered|\bentries\b|\bsrbf\b"
    r"|resolves"
)
# A value of each kind for the names of the header, with what the sentence must show of it.
VALUES = {
    "views": ([75.0, 85.04], "75\N{DEGREE SIGN}, 85\N{DEGREE SIGN}"),
    "azimuths": ([30.0, -90.0], "azimuth 30\N{DEGREE SIGN}, -90\N{DEGREE SIGN}"),
    "azimuth": ([30.0], "azimuth 30\N{DEGREE SIGN}"),
    "worst_azimuth": ([40.0], "azimuth 40\N{DEGREE SIGN}"),
    "errors": ([0.031, 0.25], "0.031, 0.25"),
    "channels": (list("abcdefgh"), "a, b, c, d, e, f and 2 more"),
    "orientation": (6, "rotated by 90 degrees"),
    "held_out": (1, "held-out"),
    "layer": ("depth", "of layer 'depth'"),
    "part": ("beauty", "'beauty'"),
}
NUMBERS = {  # of single numbers, by the form of the sentence
    "": (0.0625, "0.0625"),
    "percent": (0.0625, "6.25%"),
    "degrees": (60.0, "60\N{DEGREE SIGN}"),
    "meters": (0.0625, "0.0625 m"),
    "memory": (101_200_000, "102 MB"),
    "size": (1_500_000, "1.50 MB"),
    "subject": ("sky.hdr", "sky.hdr"),
}


def kinds_of(header: str) -> dict[str, list[str]]:
    """The names of the values of each code in the library's header."""
    found = re.findall(r"^\s*X\((\w+),[\s\\]*(\"[\w ]*\")\)", header, re.MULTILINE)
    return {code: ast.literal_eval(names).split() for code, names in found}


KINDS = kinds_of(HEADER.read_text(encoding="utf-8"))


def placeholders(template: str) -> dict[str, str]:
    """The names in a sentence, settings included, each with its form."""
    return {name: form for _, name, form, _ in Formatter().parse(template) if name is not None}


def faults(kinds: dict[str, list[str]], table: dict[str, str]) -> list[str]:
    """What does not agree between the library's codes and a table of sentences."""
    found = [f"{code}: no sentence" for code in kinds if code not in table]
    found += [f"{code}: not in the library" for code in table if code not in kinds]
    for code in kinds.keys() & table.keys():
        names = placeholders(table[code]).keys() - PANEL.keys()
        found += [f"{code}: no value {name}" for name in names - set(kinds[code])]
        found += [f"{code}: does not say {name}" for name in set(kinds[code]) - names]
    return found


def example(code: str) -> tuple[dict, list[str]]:
    """A warning of a code, and what its sentence must show."""
    forms = placeholders(SENTENCES[code])
    pairs = {}
    for name in KINDS[code]:
        number = name == "views" and forms[name] == ""  # their count
        pairs[name] = NUMBERS[forms[name]] if number or name not in VALUES else VALUES[name]
    values = {name: value for name, (value, _) in pairs.items()}
    return {"code": code, "values": values}, [shown for _, shown in pairs.values()]


def test_the_table_has_every_code_and_every_value():
    assert len(KINDS) > 50
    assert faults(KINDS, SENTENCES) == []


def test_settings_have_both_names():
    assert PANEL.keys() == COMMAND_LINE.keys()


def test_what_does_not_agree_is_found():
    kinds = kinds_of('// X(code, "names")\n  X(no_light, "")\n  X(long,  \\\n "file values")')
    assert kinds == {"no_light": [], "long": ["file", "values"]}
    assert faults(kinds, {"no_light": "There is none.", "long": "{file}: {values} of {all}."}) == [
        "long: no value all"
    ]
    assert faults(kinds, {"no_light": "There is none.", "long": "{values} {MAX_ERROR}."}) == [
        "long: does not say file"
    ]
    assert faults(kinds, {"no_light": "There is none."}) == ["long: no sentence"]
    assert faults({}, {"old": "There was one."}) == ["old: not in the library"]


@pytest.mark.parametrize("code", sorted(KINDS))
def test_sentences_keep_the_numbers_in_plain_words(code):
    warning, shown = example(code)
    said = sentence(warning)
    for part in shown:
        assert part in said
    assert "{" not in said
    assert not JARGON.search(said.replace("Limit Albedo", "")), said
    if code not in ("stored_sentence", "fit_not_resumed", "checkpoint_not_written"):  # end with the reason
        assert said.endswith(".")
    if not set(KINDS[code]) & {"file", "index", "text"}:  # those begin with a name
        assert said[0].isupper() or said[0].isdigit()


@pytest.mark.parametrize("code", sorted(KINDS))
def test_no_value_is_lost_between_two_numbers(code):
    """Another value gives another sentence: each is really written."""
    warning, _ = example(code)
    for name, value in warning["values"].items():
        other = [] if isinstance(value, list) else "other" if isinstance(value, str) else value / 2
        other = 0 if name in ("orientation", "held_out") else other
        changed = {"code": code, "values": {**warning["values"], name: other}}
        assert sentence(changed) != sentence(warning), name


def test_settings_are_named_as_the_reader_knows_them():
    warning = {"code": "views_exceed_tolerance", "values": example("views_exceed_tolerance")[0]["values"]}
    assert "raise Max Lobes" in sentence(warning, PANEL)
    assert "raise --max-lobes" in sentence(warning, COMMAND_LINE)


@pytest.mark.parametrize(
    "values",
    [{}, {"views": 3, "share": "much"}, {"views": ["a"], "share": 0.5}, {"views": [75.0], "share": []}],
)
def test_values_of_a_damaged_file_are_shown_as_they_are(values):
    said = sentence({"code": "partial_coverage", "values": values})
    assert said.startswith("partial_coverage (")


def test_sentences_of_earlier_models_are_shown_as_they_are():
    old = "albedo 3.1 at view 60.0 degrees: {braces} the measurement reflects more light there than arrives"
    assert sentence({"code": "stored_sentence", "values": {"text": old}}) == old


def test_lengths_are_in_meters_whatever_the_unit():
    lengths = {"bottom": -2.0, "top": 3.0, "radius": 5.0, "tile": 8.0}
    values = {"material": 1, "triangles": 1, "sampled": 2, **lengths}
    said = sentence({"code": "silhouette_folds", "values": values}, metres=0.001)
    assert re.findall(r"[-\d.]+ m\b", said) == ["-0.002 m", "0.003 m", "0.005 m", "0.008 m"]


def test_the_environment_image_has_no_file():
    said = sentence({"code": "negative_values", "values": {"file": "", "values": 3}})
    assert said == "The environment image: 3 values are negative and were replaced by 0."


def test_a_bad_fit_is_told_in_plain_words(model_file):
    """By its verdict, or where there is none, by the errors."""
    from velour.core.model_warnings import panel_warnings
    from velour.native import Model

    with Model.load(model_file) as model:
        info = model.info()
    errors = {"views_exceed_tolerance", "fitted_views_exceed_tolerance", "noise_exceeds_tolerance"}
    assert info["verdict"]
    assert errors & {warning["code"] for warning in info["warning_codes"]}
    for warning in info["warning_codes"]:
        assert set(warning["values"]) == set(KINDS[warning["code"]])
        said = warning_table.sentence(warning)
        assert (said in panel_warnings(info)) != (warning["code"] in errors)
        without = panel_warnings({**info, "verdict": None})
        assert said in without or warning["code"] == "fitted_views_exceed_tolerance"
