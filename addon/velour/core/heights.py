"""The height of a surface from its normals, by Fourier integration [FC88]."""

from __future__ import annotations

import numpy as np


def heights_of(normals: np.ndarray, aspect: float = 1.0) -> np.ndarray:
    """Heights [rows x columns] of a tile that repeats, mean 0, of unit normals [rows x columns x 3].

    In widths of the tile, which is `aspect` widths high: row 0 and column 0 at y = x = 0. Of all surfaces it
    is the one whose slopes are nearest to those of the normals, in the mean square.
    """
    slopes = -normals[..., :2] / normals[..., 2:]
    along_x, along_y = (np.fft.fft2(slopes[..., axis]) for axis in (0, 1))
    rows, columns = normals.shape[:2]
    u = 2 * np.pi * np.fft.fftfreq(columns, 1 / columns)
    v = 2 * np.pi * np.fft.fftfreq(rows, 1 / rows)[:, None] / aspect
    squares = u**2 + v**2
    squares[0, 0] = 1  # the mean, which no slope determines
    heights = -1j * (u * along_x + v * along_y) / squares
    heights[0, 0] = 0
    return np.fft.ifft2(heights).real.astype(np.float32)
