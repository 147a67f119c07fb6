"""The panel's plot: the curve falls to the right, the chosen point stands out."""

from __future__ import annotations

import numpy as np
import pytest
from velour.core.small_plot import order_picture

ORDER = {
    "lobes": [1, 2, 4, 8],
    "parameter_bytes": [52, 80, 136, 248],
    "worst": [20.0, 8.0, 2.0, 0.7],
    "relative_l2": [0.3, 0.1, 0.03, 0.01],
    "chosen": 3,
}


def _orange(picture: np.ndarray) -> np.ndarray:
    """Where [n x (row, column)] the picture has the colour of the chosen point."""
    return np.argwhere((picture[..., 0] > 0.8) & (picture[..., 2] < 0.4))


def test_the_chosen_point_is_marked_where_it_lies():
    for chosen in range(4):
        marked = _orange(order_picture({**ORDER, "chosen": chosen}))
        row, column = marked.mean(axis=0) / 192
        assert column == pytest.approx(0.08 + 0.84 * chosen / 3, abs=0.01)
        share = np.log(ORDER["worst"][chosen] / 0.7) / np.log(20 / 0.7)
        assert row == pytest.approx(0.08 + 0.84 * share, abs=0.01)


def test_without_a_chosen_point_none_is_marked():
    assert len(_orange(order_picture({**ORDER, "chosen": None}))) == 0


@pytest.mark.parametrize("worst", [[0.0, 0.0, 0.0, 0.0], [1.0, 1.0, 1.0, 1.0], [3.0, 1.0, 0.0, 0.0]])
def test_flat_and_black_curves_are_drawn(worst):
    picture = order_picture({**ORDER, "worst": worst}, side=64)
    assert picture.shape == (64, 64, 4)
    assert picture.dtype == np.float32
    assert np.isfinite(picture).all()
    assert len(_orange(picture)) > 50


def test_a_single_point_is_in_the_middle():
    single = {key: ORDER[key][:1] for key in ("lobes", "parameter_bytes", "worst", "relative_l2")}
    row, column = _orange(order_picture({**single, "chosen": 0})).mean(axis=0) / 192
    assert column == pytest.approx(0.5, abs=0.01)
    assert row > 0.8


def test_the_same_order_gives_the_same_picture():
    np.testing.assert_array_equal(order_picture(ORDER), order_picture(ORDER))
