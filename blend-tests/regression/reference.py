"""References: NAME.exr, the mean of many renders, and NAME.error.exr, its standard error; linear RGBA."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from velour.native import VelourError, images

from support.judge import Estimate, estimate_single

_MEAN_BITS, _ERROR_BITS = 16, 7  # of 23 after the point: what noise makes of the rest cannot be compressed
_AGAIN = "make the reference again with --update"
STORED = 2.0 ** -(_MEAN_BITS + 1) / np.sqrt(3)  # relative standard error that is left by this


def error_path(path: Path) -> Path:
    return path.with_suffix(".error.exr")


def write(path: Path, estimate: Estimate) -> None:
    # The error first: a mean without one would be taken for a single render.
    images.write(error_path(path), rounded_error(estimate))
    images.write(path, rounded_mean(estimate))


def rounded_mean(estimate: Estimate) -> np.ndarray:
    return _rounded(estimate.mean, _MEAN_BITS)


def rounded_error(estimate: Estimate) -> np.ndarray:
    return _rounded(np.sqrt(estimate.variance), _ERROR_BITS)


def read(path: Path, renders: Estimate) -> Estimate:
    """`renders` say how noisy a picture without a standard error is, and how uncertain such errors are.

    Raises ValueError with what is wrong and the remedy."""
    mean = _pixels(path)
    if mean.shape[2] == 3:
        renders = renders.channels(slice(0, 3))
    if mean.shape != renders.mean.shape:
        sizes = f"it is {_size(mean)}, the render {_size(renders.mean)}"
        raise ValueError(f"{sizes}; render at its size, or {_AGAIN}.")
    if not np.isfinite(mean).all():
        raise ValueError(f"it holds numbers that are not finite; {_AGAIN}.")
    if not error_path(path).is_file():
        return estimate_single(mean, renders)
    error = _pixels(error_path(path))
    if error.shape != mean.shape or not np.isfinite(error).all() or (error < 0).any():
        raise ValueError(f"{error_path(path).name} holds no standard errors of it; remove it, or {_AGAIN}.")
    return Estimate(mean, error**2, renders.seeds, STORED)


def _pixels(path: Path) -> np.ndarray:
    try:
        return images.read(path).astype(np.float64)
    except VelourError as error:
        detail = error.sentence.removeprefix(f"{path}: ").rstrip(".")
        raise ValueError(f"{detail}; {_AGAIN}.") from error


def _rounded(values: np.ndarray, bits: int) -> np.ndarray:
    """Float32 with so many bits after the point, to nearest."""
    dropped = 23 - bits
    whole = np.ascontiguousarray(values, np.float32).view(np.uint32)
    whole = (whole + np.uint32(1 << (dropped - 1))) & np.uint32(0xFFFFFFFF << dropped & 0xFFFFFFFF)
    return whole.view(np.float32)


def _size(pixels: np.ndarray) -> str:
    height, width, channels = pixels.shape
    return f"{width} x {height} pixels with {channels} channels"
