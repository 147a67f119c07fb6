"""Finds texts and icons in a picture of the screen. No Blender is needed to import this.

Pictures are [height x width] in [0, 1], the lowest row first; places are pixels from the lower left corner.
"""

from typing import NamedTuple

import numpy as np

_LEAST_SCORE = 0.95  # buttons reach 0.99: a shadow below the letters costs the rest
_SAME = 0.03  # scores that differ by less are of the same text
_LEAST_DEVIATION = 0.02  # standard deviation of a part that shows anything
_INK = 0.35  # share of the contrast of a text from which on a pixel beside it belongs to another letter
_GAP = 3  # rows of background that part two icons


class Place(NamedTuple):
    """A text in a picture."""

    x: int  # of its middle
    y: int
    score: float  # 1: exactly the text
    contrast: float  # of letters to background; below 0: dark letters


class Box(NamedTuple):
    """A rectangle of a picture."""

    left: int
    bottom: int
    width: int
    height: int

    def part(self, picture):
        return picture[self.bottom : self.bottom + self.height, self.left : self.left + self.width]


def whole(picture):
    return Box(0, 0, picture.shape[1], picture.shape[0])


def find(picture, letters, margin, box=None):
    """Places of a text within a Box that stands alone there, the highest first.

    letters: share of each pixel that the text covers, without empty rows and columns around it.
    margin: pixels on both sides that hold no other letters; more than between two words."""
    box = box or whole(picture)
    part = box.part(picture)
    if part.shape[0] < letters.shape[0] or part.shape[1] < letters.shape[1]:
        return []
    scores, slopes = _correlation(part.astype(np.float64), letters.astype(np.float64))
    found = []
    height, width = letters.shape
    for row, column in _peaks(np.abs(scores), letters.shape):
        if _stands_alone(part, letters, row, column, margin, slopes[row, column]):
            x, y = box.left + column + width // 2, box.bottom + row + height // 2
            found.append(Place(x, y, abs(float(scores[row, column])), float(slopes[row, column])))
    best = max((place.score for place in found), default=0.0)
    return sorted((place for place in found if place.score > best - _SAME), key=lambda place: -place.y)


def _correlation(part, letters):
    """Correlation coefficients of the letters with the part above and right of each pixel, and the factors
    between them."""
    height, width = letters.shape
    centered = letters - letters.mean()
    shape = part.shape
    spectrum = np.fft.rfft2(part) * np.conj(np.fft.rfft2(centered, shape))
    valid = (slice(0, shape[0] - height + 1), slice(0, shape[1] - width + 1))
    product = np.fft.irfft2(spectrum, shape)[valid]
    mean = _sums(part, height, width) / letters.size
    variance = np.maximum(_sums(part**2, height, width) / letters.size - mean**2, 0.0)
    deviation = np.sqrt(variance)
    own = np.sqrt((centered**2).sum())
    shows = deviation > _LEAST_DEVIATION
    scores = np.where(shows, product / (own * np.sqrt(letters.size) * np.where(shows, deviation, 1.0)), 0.0)
    return scores, product / own**2


def _sums(values, height, width):
    """Sums of all rectangles of this size."""
    total = np.pad(values.cumsum(0).cumsum(1), ((1, 0), (1, 0)))
    return (
        total[height:, width:] - total[:-height, width:] - total[height:, :-width] + total[:-height, :-width]
    )


def _peaks(scores, shape):
    """Rows and columns of the highest score in each surrounding as large as the text."""
    scores = scores.copy()
    found = []
    while True:
        row, column = np.unravel_index(np.argmax(scores), scores.shape)
        if scores[row, column] < _LEAST_SCORE:
            return found
        found.append((int(row), int(column)))
        low, left = max(row - shape[0] + 1, 0), max(column - shape[1] + 1, 0)
        scores[low : row + shape[0], left : column + shape[1]] = 0.0


def _stands_alone(part, letters, row, column, margin, contrast):
    height, width = letters.shape
    rows = part[row : row + height]
    text = rows[:, column : column + width]
    background = np.median(text[letters == 0]) if (letters == 0).any() else text.min()
    # The icon of a file stands as close before its name as a word may stand before another one.
    start, end = max(column - margin + 1, 0), column + width
    beside = np.hstack([rows[:, start:column], rows[:, end : end + margin]])
    towards_ink = (beside - background) / contrast
    return not (towards_ink > _INK).any()


def icons(picture, box):
    """Middles of the icons that stand in a column, the highest first: (x, y)."""
    part = box.part(picture)
    differs = (np.abs(part - np.median(part)) > 0.08).any(axis=1)
    runs, start, last = [], None, None
    for row in np.flatnonzero(differs):
        if last is None or row - last > _GAP:
            if last is not None:
                runs.append((start, last))
            start = row
        last = row
    if last is not None:
        runs.append((start, last))
    x = box.left + box.width // 2
    return [(x, box.bottom + (low + high) // 2) for low, high in reversed(runs)]


def gray(pixels):
    """A picture of [height x width x 3] bytes."""
    return pixels.mean(axis=2, dtype=np.float32) / 255
