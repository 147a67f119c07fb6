"""The library's warnings as artists read them: every one has its sentence, without the words of engineers."""

from __future__ import annotations

import re

import pytest
from conftest import ROOT
from velour.core import plain_words
from velour.core.model_warnings import panel_warnings

FOLDERS = ("brdf/fit", "btf/fit", "usage", "capture", "votf/capture")
_WARNS = re.compile(r"warnings_?\.(?:push|emplace)_back\((.*?)\);$", re.DOTALL | re.MULTILINE)
JARGON = re.compile(
    r"relmse|relative L2|\bL2\b|reciprocal:|albedo\b|\bRMS\b|coefficient|kcta|clustered|Rec\. 709|\bentries\b"
    r"|\bsrbf\b|resolves|lobes"
)
# What expressions of the sources stand for.
_NAMED = {"where +": "albedo 1.5 at view 5 degrees: ", "views.names() +": "view 5 degrees"}
# As the library says them, each with what its sentence has to have kept of it.
SAMPLES = (
    (
        "250 of 1000 entries are invalid and were left out; errors are measured on the others",
        "25%",
    ),
    (
        "the measurement has 40 samples: what lies between them is a guess, and the errors are measured",
        "40",
    ),
    (
        "the measurement's own noise exceeds the tolerance at 2 of the reported views; at 85 degrees",
        "Max Error",
    ),
    (
        "views 75, 85 degrees: the highlight, or a lobe of the model, is narrower than the spacing",
        "75°, 85°",
    ),
    (
        "view 85 degrees: the measurement covers as little as 0.31 of the light directions; errors",
        "31%",
    ),
    (
        "no reported view is covered: the error is not known and is reported as 1",
        "not known",
    ),
    (
        "the model is black: the measurement is darker than any value that can be fitted; check",
        "black",
    ),
    (
        "the measurement is black at every view; check that it is the right file",
        "black",
    ),
    (
        "albedo at most 0.0004 at every view, darker than any known material; check",
        "0.04%",
    ),
    (
        "albedo 3.1 at view 60.0 degrees: the measurement reflects more light there than arrives, far more",
        "3.1",
    ),
    (
        "albedo 1.03 at view 85.0/90 degrees: the measurement reflects more light there than arrives",
        "Limit Albedo",
    ),
    (
        "albedo 1.2 at view 85.0 degrees: the model reflects more light there than arrives, but the",
        "Max Lobes",
    ),
    (
        "the measurement is not reciprocal: exchanging light and view changes it by 0.21 (relative L2), and",
        "21%",
    ),
    (
        "the model is not reciprocal: exchanging light and view changes it by 0.21 (relative L2)",
        "Reciprocal",
    ),
    (
        "3 of 90 sampled views are outside the measurement and were left out",
        "3%",
    ),
    (
        "1 of 9000 fitted values have a negative channel (a color outside Rec. 709), which non-neg",
        "less than 1%",
    ),
    (
        "the bound of 900 bytes leaves 5 views and 9 lobes",
        "900",
    ),
    (
        "the scene needs all of the full model: no smaller model gives images of the same",
        "full model",
    ),
    (
        "of clustered tensors the finest levels were left out, and no more: they are not refitted",
        "Method SRBF",
    ),
    (
        "the scene resolves the finest texels, so it needs the full model",
        "farther away",
    ),
    (
        "the surface is anisotropic: 40 pairs of samples differ by a factor of 1.8 (median)",
        "a factor of 1.8",
    ),
    (
        "12 entries of the BTF are not finite; they were replaced by the mean of their image.",
        "12 values",
    ),
    (
        "within the memory allowed lobes are chosen by 9 places in place of 64; 900 MB would leave them all",
        "900 MB",
    ),
    (
        "the tolerance of 0.1 is not met: the error is 0.2 with 90000 bytes; about 1500000 bytes would do",
        "1.5 MB",
    ),
    (
        "the tolerance of 0.1 is not met: the error is 0.2 with 9 bytes; a tolerance of 0.21 would do",
        "Max Error to 0.21",
    ),
    (
        "7 of 4096 vertical lines meet a sheet without thickness, which was made about one texel thick.",
        "Solidify",
    ),
)
# Sentences of the library that say it in everybody's words already.
PLAIN_ALREADY = (
    "A material of the tile is transparent (alpha)",
    "A material of the tile emits light",
    "the fit was not resumed but started from the beginning: ",
    "the fit cannot be resumed: ",
    "fitted views that miss the tolerance",  # these three by panel_warnings
    " degrees: relative L2 ",
    " degrees: the measurement does not cover it",
)


def _example(statement: str) -> str:
    """A warning as the C++ expression makes it, with 5 for whatever it puts between its texts."""
    for name, text in _NAMED.items():
        statement = statement.replace(name, f'"{text}"')
    parts = re.split(r'"((?:[^"\\]|\\.)*)"', re.sub(r'"\s*\+?\s*"', "", statement))
    return "".join(
        part if number % 2 else "5" * bool(re.search(r"\w", part)) for number, part in enumerate(parts)
    )


def _warnings_of_the_library() -> list[str]:
    sources = [
        path.read_text(encoding="utf-8") for f in FOLDERS for path in (ROOT / "native/src" / f).rglob("*.cpp")
    ]
    statements = [statement for source in sources for statement in _WARNS.findall(source)]
    return [_example(statement) for statement in statements if '"' in statement]


def _is_told(warning: str) -> bool:
    return plain_words.plain(warning) != warning or any(known in warning for known in PLAIN_ALREADY)


def test_every_warning_of_the_library_is_told_in_plain_words():
    said = _warnings_of_the_library()
    assert len(said) > 20
    assert [warning for warning in said if not _is_told(warning)] == []


def test_a_warning_that_is_not_told_is_seen():
    assert not _is_told(_example('std::to_string(n) + " lobes of the kcta have no texels"'))


def _without_labels(sentence: str) -> str:
    return sentence.replace("Max Lobes", "").replace("Limit Albedo", "")


@pytest.mark.parametrize(("sample", "kept"), SAMPLES)
def test_artists_read_plain_words(sample, kept):
    sentence = plain_words.plain(sample)
    assert sentence != sample
    assert kept in sentence
    assert not JARGON.search(_without_labels(sentence)), sentence
    assert sentence.endswith(".")
    assert sentence[0].isupper() or sentence[0].isdigit()


def test_each_sentence_has_a_sample():
    unused = [
        pattern for pattern, _ in plain_words._SENTENCES if not any(re.match(pattern, s) for s, _ in SAMPLES)
    ]
    assert unused == []


def test_what_is_not_known_is_left_as_it_is():
    assert plain_words.plain("made rougher by 0.2; errors are those of the model before that").startswith(
        "made rougher"
    )


def test_a_bad_fit_is_told_in_plain_words(model_file):
    from velour.native import Model

    with Model.load(model_file) as model:
        sentences = panel_warnings(model.info())
    assert sentences
    for sentence in sentences:
        assert not JARGON.search(_without_labels(sentence)), sentence
