"""Color of a glowing body by its temperature."""

import functools
import math

import numpy as np

from ..color import rec709_to_working

_LOW, _HIGH = 800.0, 12000.0  # kelvins; colors beyond are those at the ends, as in Cycles
_ROWS = 256
_SECOND_RADIATION_CONSTANT = 1.438777e7  # nm K
_XYZ_TO_REC709 = np.array(
    (
        (3.2404542, -1.5371385, -0.4985314),
        (-0.9692660, 1.8760108, 0.0415560),
        (0.0556434, -0.2040259, 1.0572252),
    )
)


def blackbody(c, plug):
    """Planck's spectrum, as the CIE 1931 observer sees it, of luminance 1; clipped to the gamut."""
    kelvins = c.input(plug.input("Temperature"))
    place = c.draft.math("divide", c.draft.math("logarithm", kelvins, math.e), math.log(_HIGH / _LOW))
    place = c.draft.math("subtract", place, math.log(_LOW) / math.log(_HIGH / _LOW))
    return c.draft.step("ramp", (place,), (3, 1), (1,), _table())[0]


def _table():
    """Rows of RGBA in the working space, evenly by the logarithm of the temperature."""
    colors = np.maximum(_colors() @ rec709_to_working().T, 0)
    return tuple(np.column_stack((colors, np.ones(_ROWS))).ravel().tolist())


@functools.cache
def _colors():
    """[rows x 3] linear Rec. 709."""
    wavelengths = np.arange(360.0, 831.0)  # nm
    kelvins = np.geomspace(_LOW, _HIGH, _ROWS)[:, None]
    spectra = wavelengths**-5.0 / np.expm1(_SECOND_RADIATION_CONSTANT / (wavelengths * kelvins))
    xyz = spectra @ _observer(wavelengths)
    return (xyz / xyz[:, 1:2]) @ _XYZ_TO_REC709.T


def _observer(wavelengths):
    """Color matching functions [wavelengths x 3] [WSS13], equations 4 to 6."""

    def lobe(scale, center, below, above):
        width = np.where(wavelengths < center, below, above)
        return scale * np.exp(-0.5 * ((wavelengths - center) / width) ** 2)

    x = lobe(1.056, 599.8, 37.9, 31.0) + lobe(0.362, 442.0, 16.0, 26.7) + lobe(-0.065, 501.1, 20.4, 26.2)
    y = lobe(0.821, 568.8, 46.9, 40.5) + lobe(0.286, 530.9, 16.3, 31.1)
    z = lobe(1.217, 437.0, 11.8, 36.0) + lobe(0.681, 459.0, 26.0, 13.8)
    return np.column_stack((x, y, z))
