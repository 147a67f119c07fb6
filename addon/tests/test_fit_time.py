"""How long a fit of a BTF is said to take: by those that were made."""

import json

import pytest
from velour.core import fit_time
from velour.core.fit_time import Fit, expected, fit_of, remember, time_text

_FIT = Fit("srbf", 1000, 1000, False, False, False, 2)


def test_the_same_fit_takes_what_it_took(tmp_path):
    remember(tmp_path, _FIT, 40.0)
    found = expected(tmp_path, _FIT)
    assert found.least < 40 < found.most
    assert found.most / found.least < 4
    assert found.made == 1
    assert time_text(tmp_path, _FIT) == "27 seconds to 60 seconds, estimated from one fit on this computer"


def test_larger_ones_take_longer_but_not_in_proportion(tmp_path):
    remember(tmp_path, _FIT, 40.0)
    larger = expected(tmp_path, _FIT._replace(texels=4000))
    assert larger.least < 80 < 100 < larger.most
    # The control: in proportion it were 160.
    assert larger.most < 160
    assert expected(tmp_path, _FIT._replace(pairs=4000)).most > larger.most


@pytest.mark.parametrize(
    "other",
    [{"method": "kcta"}, {"searched": True}, {"sized": True}, {"shaped": True}, {"threads": 16}],
)
def test_other_kinds_tell_nothing(tmp_path, other):
    remember(tmp_path, _FIT._replace(**other), 4000.0)
    assert expected(tmp_path, _FIT) is None
    assert "no similar fit was made on this computer yet" in time_text(tmp_path, _FIT)


def test_the_nearest_in_size_count(tmp_path):
    """What is far away says less, and comes in only where nothing else is there."""
    for _ in range(3):
        remember(tmp_path, _FIT, 40.0)
    remember(tmp_path, _FIT._replace(texels=1), 400.0)
    assert expected(tmp_path, _FIT) == expected(tmp_path, _FIT)._replace(made=3)
    assert expected(tmp_path, _FIT).most < 100
    far = tmp_path / "far"
    remember(far, _FIT._replace(texels=1), 4.0)
    found = expected(far, _FIT)
    near = expected(far, _FIT._replace(texels=1))
    assert found.most / found.least > near.most / near.least


def test_the_last_ones_are_kept(tmp_path):
    for seconds in range(1, 80):
        remember(tmp_path, _FIT, float(seconds))
    kept = sorted((tmp_path / "fits-2").iterdir())
    assert [json.loads(path.read_text())["seconds"] for path in kept] == list(range(16, 80))


@pytest.mark.parametrize(
    "text", ["", "{", "[]", "{}", '{"release": [0, 1, 0], "fit": ["srbf", 1], "seconds": 1}']
)
def test_a_damaged_one_is_none(tmp_path, text):
    remember(tmp_path, _FIT, 40.0)
    (path,) = (tmp_path / "fits-2").iterdir()
    path.write_text(text)
    assert expected(tmp_path, _FIT) is None
    remember(tmp_path, _FIT, 40.0)
    assert expected(tmp_path, _FIT).made == 1


def test_fits_of_other_releases_tell_nothing(tmp_path, monkeypatch):
    remember(tmp_path, _FIT, 40.0)
    monkeypatch.setattr(fit_time, "VERSION", (9, 9, 9))
    assert expected(tmp_path, _FIT) is None


def test_without_a_folder_that_can_be_written(tmp_path):
    (tmp_path / "file").touch()
    remember(tmp_path / "file" / "folder", _FIT, 40.0)
    assert expected(tmp_path / "file" / "folder", _FIT) is None


def test_what_a_fit_is():
    info = {"texels": [64, 32], "pairs": 100}
    asked = {"method": "kcta", "tolerance": 0.1, "bytes": 0, "clusters": 0, "members": 2}
    assert fit_of(info, asked, 3) == Fit("kcta", 2048, 100, True, False, True, 3)
    asked = {"method": "srbf", "tolerance": 0.0, "bytes": 10_000}
    assert fit_of(info, asked, 3) == Fit("srbf", 2048, 100, False, True, False, 3)
