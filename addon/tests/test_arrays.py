"""Arrays are refused with a sentence, never copied in silence."""

from __future__ import annotations

import numpy as np
import pytest
from velour.native import VelourError, arrays
from velour.native.structs import FitOptions
from velour.native.table import KERNELS


def test_a_good_array_passes_as_it_is():
    array = np.zeros((3, 2), np.float32)
    assert arrays.checked("u", array, (None, 2)) is array


@pytest.mark.parametrize(
    ("array", "word"),
    [
        ([[0.0, 0.0]], "NumPy array"),
        (np.zeros((3, 2)), "float64"),
        (np.zeros((3, 3), np.float32), "shape"),
        (np.zeros(6, np.float32), "shape"),
        (np.zeros((2, 3), np.float32).T, "contiguous"),
        (np.zeros((6, 2), np.float32)[::2], "contiguous"),
    ],
)
def test_others_are_refused(array, word):
    with pytest.raises(VelourError, match=word) as caught:
        arrays.checked("u", array, (None, 2))
    assert str(caught.value).startswith("u ")


def test_small_values_may_be_any_sequence():
    assert list(arrays.small("color", [1, 2, 3], 3)) == [1, 2, 3]
    assert list(arrays.small("m", np.eye(3), 9)) == [1, 0, 0, 0, 1, 0, 0, 0, 1]


@pytest.mark.parametrize("values", [[1, 2], [1, 2, float("nan")], ["a", "b", "c"], None])
def test_bad_small_values(values):
    with pytest.raises(VelourError, match="color"):
        arrays.small("color", values, 3)


def test_affine_takes_the_upper_rows_of_an_affine_matrix_only():
    matrix = np.arange(16.0).reshape(4, 4)
    with pytest.raises(VelourError, match="last row"):
        arrays.affine("m", matrix)
    matrix[3] = 0, 0, 0, 1
    assert list(arrays.affine("m", matrix)) == list(range(12))


def test_options_are_checked_by_name_and_range():
    from velour.native.handle import choice, set_fields

    options = FitOptions()
    set_fields(options, {"max_lobes": 5})
    assert options.max_lobes == 5
    with pytest.raises(TypeError, match="max_lobe"):
        set_fields(options, {"max_lobe": 5})
    for wrong in (-1, 2**32):
        with pytest.raises(VelourError, match="max_lobes"):
            set_fields(options, {"max_lobes": wrong})
    assert choice("kernel", "Gaussian", KERNELS) == 0
    for wrong in ("box", 2, -1):
        with pytest.raises(VelourError, match="abel-poisson"):
            choice("kernel", wrong, KERNELS)
