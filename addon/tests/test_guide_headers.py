"""The arrows of panels are found on a picture, and nothing else is."""

from __future__ import annotations

import numpy as np
from guide import headers


def _strip(height: int) -> np.ndarray:
    return np.full((height, headers.STRIP, 3), 61, np.uint8)


def _draw(strip: np.ndarray, row: int, x: int, rows: tuple[str, ...]) -> None:
    shape = np.array([[int(digit) for digit in row] for row in rows])
    strip[row : row + shape.shape[0], x : x + shape.shape[1]] += (shape * 12).astype(np.uint8)[..., None]


def test_arrows_are_found_from_the_top():
    strip = _strip(200)
    _draw(strip, 100, 12, headers._CLOSED)
    _draw(strip, 20, 9, headers._OPEN)
    _draw(strip, 60, 26, headers._CLOSED)
    found = headers.find(strip)
    assert [(header.x, header.is_open) for header in found] == [(9, True), (26, False), (12, False)]
    assert [header.row for header in found] == [23, 65, 105]


def test_an_arrow_that_points_elsewhere_is_none():
    strip = _strip(60)
    _draw(strip, 10, 12, tuple(reversed(headers._OPEN)))
    _draw(strip, 30, 12, tuple(row[::-1] for row in headers._CLOSED))
    assert headers.find(strip) == []


def test_text_is_none():
    rng = np.random.default_rng(1)
    assert headers.find(rng.integers(0, 256, (400, headers.STRIP, 3), np.uint8)) == []
