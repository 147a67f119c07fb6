"""Luminance of linear Rec. 709 colors."""

from __future__ import annotations

import numpy as np

LUMINANCE = np.array([0.2126, 0.7152, 0.0722])  # weights of the channels, as in the library
