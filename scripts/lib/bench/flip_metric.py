"""How different two pictures look: LDR-FLIP [ANA20], computed by its authors' package."""

from __future__ import annotations

import functools
import site
import sys

import numpy as np
from velour.core.luminance import LUMINANCE

from .charts import display
from .project import ROOT, MissingError

# Where scripts/setup --metrics installs FLIP. Last on the path, so that numpy remains the system's.
_PACKAGES = ROOT / "build/tools/lib/python{}.{}/site-packages".format(*sys.version_info[:2])
GRAY = 0.18  # the object's mean luminance after exposure: the photographer's gray card
_SIDE, _GRAY_LIGHTNESS = 64, 50.0  # uniform patches: pixels, L*


@functools.cache
def _flip():
    site.addsitedir(str(_PACKAGES))
    try:
        import flip_evaluator
    except ImportError as error:
        raise MissingError(
            f"skipped, FLIP is not installed ({error}); scripts/setup --metrics does."
        ) from error
    return flip_evaluator


def flip_map(reference: np.ndarray, test: np.ndarray) -> np.ndarray:
    """FLIP of two sRGB pictures in [0, 1], [row from the top, column, channel], seen at the package's default
    distance, 67 pixels per degree. Returns [row, column]; 0: identical, 1: maximally different."""
    arrays = (np.ascontiguousarray(picture, np.float32) for picture in (reference, test))
    found, _, _ = _flip().evaluate(*arrays, "LDR", inputsRGB=True, applyMagma=False, computeMeanError=False)
    return found[..., 0]


def exposure(picture: np.ndarray, where: np.ndarray) -> float:
    """Factor that makes the mean luminance of the pixels of `where` equal to GRAY."""
    return float(GRAY / (picture[where] @ LUMINANCE).mean())


def of_object(reference: np.ndarray, test: np.ndarray, where: np.ndarray) -> tuple[float, float]:
    """Mean and 99th percentile of FLIP of two linear pictures, over the pixels that show the object."""
    scale = exposure(reference, where)
    values = flip_map(*(display(scale * picture) for picture in (reference, test)))[::-1][where]
    return float(values.mean()), float(np.percentile(values, 99))


def of_lightness(difference: float) -> float:
    """Mean FLIP of two uniform grays that differ by `difference` in L*, their color difference in CIELAB."""
    patches = [np.full((_SIDE, _SIDE, 3), _luminance(_GRAY_LIGHTNESS + d)) for d in (0.0, difference)]
    return float(flip_map(*map(display, patches)).mean())


def _luminance(lightness: float) -> float:
    """Y of a lightness L* > 8 [CIE 15]."""
    return ((lightness + 16) / 116) ** 3
