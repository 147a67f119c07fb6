"""The arithmetic of the chart of BTFs: each against what is known."""

from __future__ import annotations

import numpy as np
import pytest
from bench import page
from bench.pages.btf_chart import (
    HEADERS,
    Results,
    methods,
    packing,
    relative_error,
    verdicts,
    within,
)


class Fits:
    """Files of a fixed overhead that pack what is fitted, of whole units."""

    def __init__(self, overhead: int, packed: float, unit: int):
        self.overhead, self.packed, self.unit, self.asked = overhead, packed, unit, []

    def __call__(self, size: int) -> dict | None:
        self.asked.append(size)
        units = size // self.unit
        if units == 0:
            return None
        fitted = units * self.unit
        return {"parameter_bytes": fitted, "bytes": int(self.overhead + self.packed * fitted)}


@pytest.mark.parametrize("packed", [0.7, 1.0, 1.2])
@pytest.mark.parametrize("overhead", [2000, HEADERS, 25000])
def test_the_file_is_filled_but_not_overfilled(packed, overhead):
    fits = Fits(overhead, packed, 1)
    report = within(100_000, fits)
    assert 92_000 < report["bytes"] <= 101_000
    assert len(fits.asked) <= 4


def test_a_packing_that_is_known_saves_tries():
    first = within(100_000, Fits(HEADERS, 0.7, 1))
    fits = Fits(HEADERS, 0.7, 1)
    assert within(300_000, fits, packing(first))["bytes"] == pytest.approx(300_000, rel=0.02)
    assert len(fits.asked) == 1


def test_no_unit_more_would_fit_and_none_is_tried_in_vain():
    fits = Fits(HEADERS, 1.0, 30_000)
    assert within(100_000, fits)["parameter_bytes"] == 90_000
    assert len(fits.asked) == 1


def test_what_is_refused_or_too_large_is_nothing():
    assert within(100_000, Fits(HEADERS, 1.0, 200_000)) is None
    assert within(20_000, Fits(25_000, 1.0, 100)) is None


def test_the_error_of_a_picture_is_relative():
    reference = np.full((4, 5, 3), 0.5)
    assert relative_error(1.1 * reference, reference) == pytest.approx(0.1)
    assert relative_error(reference, reference) == 0


def _entry(method: str, psnr: float, *, tile="weave", ratio=500, unseen=None, rate=2e6) -> dict:
    entry = {"tile": tile, "method": method, "ratio": ratio, "psnr": psnr, "psnr_unseen": unseen}
    return entry | {"evaluations": rate}


def test_results_are_compared_at_equal_bytes():
    results = Results(
        [_entry("svd", 20), _entry("cta", 21, unseen=19), _entry("cta", 15, ratio=1000), _entry("tucker", 22)]
    )
    assert results.best("weave", 500, results.methods) == "tucker"
    assert results.best("weave", 500, ["svd", "cta"]) == "cta"
    assert results.gain("weave", 500, ["cta"], "svd") == 1
    assert results.gain("weave", 1000, ["cta"], "svd") is None
    assert results.gain("weave", 500, ["cta"], "svd", "psnr_unseen") is None
    assert results.ratios == [500, 1000]


def test_rows_are_read_as_they_were_written(tmp_path):
    rows = [_entry("svd", 1 / 3), _entry("kcta 2", 21, tile="net", ratio=50, unseen=19)]
    conditions = {"machine": "A, B", "commit": "123456789e12"}
    page.write_rows(tmp_path / "a.csv", rows, conditions)
    assert page.read_rows(tmp_path / "a.csv") == (conditions, rows)


def _found(entries: list[dict]) -> dict:
    judged = verdicts(Results(entries))
    return {(v["target"].split(",")[-1].strip(), v["where"]): v["met"] for v in judged}


def test_targets_are_judged_where_they_are_missed_most():
    entries = [_entry("tucker", 20), _entry("cta", 21), _entry("tucker", 18, ratio=1000)]
    entries += [_entry("svd", 19, unseen=20), _entry("kcta 2", 20.6, unseen=19.9), _entry("kcta 3", 20.4)]
    found = _found([*entries, _entry("cta", 17.9, ratio=1000)])
    assert found["CTA at least as good as Tucker (fitted)", "weave"] is False
    assert found["K-CTA at least as good as CTA (fitted)", "weave"] is False
    assert found["fitted", "weave"] is True  # 1.6 dB, by the best K
    assert found["unseen", "weave"] is False
    assert _found(entries)["CTA at least as good as Tucker (fitted)", "weave"] is True
    assert _found([_entry("svd", 19)])["fitted", "weave"] is None


def test_the_slowest_evaluation_counts():
    target = "a million evaluations a second and core"
    assert _found([_entry("cta", 1), _entry("cta", 1, ratio=50, rate=9e5)])[target, "cta"] is False
    assert _found([_entry("cta", 1)])[target, "cta"] is True


def test_methods_that_the_library_does_not_know_are_left_out():
    assert [m.name for m in methods(("srbf", "svd"))] == ["svd", "srbf"]
    all_of_them = methods(("svd", "srbf", "tucker", "cta", "kcta", "svd-view", "future"))
    assert [m.name for m in all_of_them][-5:] == ["kcta", "kcta 2", "kcta 3", "kcta 4", "future"]
    assert all_of_them[-2].options == {"method": "kcta", "members": 4}
    assert [m.name for m in methods(("svd", "kcta"), ["kcta 3", "svd"])] == ["svd", "kcta 3"]
    (sought,) = methods(("svd", "kcta"), ["kcta"])
    assert sought.options == {"method": "kcta"}
