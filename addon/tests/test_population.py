"""scripts/population: measurements from seeds, and what its page says of them."""

from __future__ import annotations

import pytest
from bench import population
from bench.pages import population as page
from velour.native import Measurement


@pytest.mark.parametrize("index", range(7))
def test_members_are_measurements_that_a_seed_determines(tmp_path, index):
    paths = [tmp_path / name for name in ("first", "second")]
    for path in paths:
        population.member(7, index).write(path)
    assert paths[0].read_bytes() == paths[1].read_bytes()
    with Measurement.load(paths[0]) as measurement:
        info = measurement.info()
    assert info["format"] == population.member(7, index).layout
    assert info["entries"]["valid"] > 0.9 * (info["entries"]["total"] - info["entries"]["below_horizon"]) or (
        population.member(7, index).defect == "holes"
    )


def test_another_seed_makes_another_population():
    names = [[population.member(seed, i).defect for i in range(40)] for seed in (1, 2)]
    assert names[0] != names[1]
    assert {"none", "noise", "holes"} <= set(names[0])


def test_the_spread_leaves_out_what_is_not_known():
    assert page.spread([0.3, None, 0.1, 0.2]) == {"median": 0.2, "most": 0.3, "worst": 0.3}
    assert page.spread([None])["median"] is None


def test_a_model_is_beaten_by_a_tenth():
    row = {"error": 0.11, "per_view": 0.2, "ggx": 0.101, "principled": 0.3}
    assert not page.beaten(row)
    assert page.beaten(row | {"ggx": 0.099})
