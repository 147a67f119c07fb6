"""How different two pictures look: LDR-FLIP [ANA20], by its authors' own package."""

from __future__ import annotations

import functools
import site
import sys

import numpy as np
from agreement import LUMINANCE
from velour_cli import ROOT

# Where scripts/setup --metrics puts it. Behind all else: numpy stays the system's.
_PACKAGES = ROOT / "build/tools/lib/python{}.{}/site-packages".format(*sys.version_info[:2])
GREY = 0.18  # of the object's mean luminance after exposure: the photographer's grey card
_SIDE, _GREY_LIGHTNESS = 64, 50.0  # of the even patches: pixels, L*


class NoFlipError(RuntimeError):
    """A sentence."""


@functools.cache
def _flip():
    site.addsitedir(str(_PACKAGES))
    try:
        import flip_evaluator
    except ImportError as error:
        raise NoFlipError(
            f"skipped, FLIP is not installed ({error}); scripts/setup --metrics does."
        ) from error
    return flip_evaluator


def flip_map(reference: np.ndarray, test: np.ndarray) -> np.ndarray:
    """Of pictures for the eye, sRGB in [0, 1], [row from the top, column, channel], seen at the package's
    default distance, 67 pixels a degree. [row, column], 0: alike, 1: as different as can be."""
    arrays = (np.ascontiguousarray(picture, np.float32) for picture in (reference, test))
    found, _, _ = _flip().evaluate(*arrays, "LDR", inputsRGB=True, applyMagma=False, computeMeanError=False)
    return found[..., 0]


def exposure(picture: np.ndarray, where: np.ndarray) -> float:
    """What makes the mean luminance of the pixels of `where` GREY."""
    return float(GREY / (picture[where] @ LUMINANCE).mean())


def display(linear: np.ndarray) -> np.ndarray:
    """Rec. 709 linear to sRGB [IEC 61966-2-1], clipped, without rounding; rows turned round: row 0 on top."""
    c = np.clip(np.asarray(linear, np.float64)[::-1], 0, 1)
    return np.where(c <= 0.0031308, 12.92 * c, 1.055 * c ** (1 / 2.4) - 0.055)


def of_lightness(difference: float) -> float:
    """FLIP of two even greys that differ by so much in L*, which for greys is their difference in CIELAB."""
    patches = [np.full((_SIDE, _SIDE, 3), _luminance(_GREY_LIGHTNESS + d)) for d in (0.0, difference)]
    return float(flip_map(*map(display, patches)).mean())


def _luminance(lightness: float) -> float:
    """Y of L* > 8 [CIE 15]."""
    return ((lightness + 16) / 116) ** 3
