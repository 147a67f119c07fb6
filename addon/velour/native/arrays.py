"""Arrays that are passed to the library: checked, never silently copied.

Large arrays must already be float32 (or uint32, uint8), C-contiguous and of the right shape. Small ones (a
color, a matrix) may be any sequence of numbers.
"""

from __future__ import annotations

import ctypes

import numpy as np

from .errors import refuse

_POINTERS = {
    np.dtype(np.float32): ctypes.POINTER(ctypes.c_float),
    np.dtype(np.uint32): ctypes.POINTER(ctypes.c_uint32),
    np.dtype(np.uint8): ctypes.POINTER(ctypes.c_uint8),
}


def checked(name: str, array, shape: tuple, dtype=np.float32) -> np.ndarray:
    """`array` itself. Refused unless contiguous and of this `dtype` and `shape` (None: any length)."""
    if not isinstance(array, np.ndarray):
        raise refuse(
            f"{name} is a {type(array).__name__}; a NumPy array of {np.dtype(dtype).name} is needed."
        )
    if array.dtype != dtype:
        raise refuse(f"{name} is {array.dtype}; {np.dtype(dtype).name} is needed; convert it with astype().")
    if not _fits(array.shape, shape):
        wanted = " x ".join("n" if w is None else str(w) for w in shape)
        raise refuse(f"{name} has shape {array.shape}; {wanted} is needed.")
    if not array.flags.c_contiguous:
        raise refuse(f"{name} is not contiguous in memory; pass numpy.ascontiguousarray({name}).")
    return array


def _fits(found: tuple, wanted: tuple) -> bool:
    if len(found) != len(wanted):
        return False
    for n, w in zip(found, wanted, strict=True):  # noqa: SIM110  (many small meshes: all() takes twice as long)
        if w is not None and w != n:
            return False
    return True


def address(array: np.ndarray) -> int:
    """Like pointer(), for arguments without a type: several times faster."""
    return array.__array_interface__["data"][0]


def pointer(array: np.ndarray | None):
    """The array's memory for ctypes; None for NULL. The caller keeps the array alive during the call."""
    return None if array is None else array.ctypes.data_as(_POINTERS[array.dtype])


def small(name: str, values, count: int) -> ctypes.Array:
    """`count` finite numbers from any (nested) sequence, as a C float array."""
    try:
        flat = np.asarray(values, dtype=np.float32).ravel()
    except (TypeError, ValueError) as error:
        raise refuse(f"{name} must be {count} numbers ({error}).") from error
    if flat.size != count:
        raise refuse(f"{name} has {flat.size} numbers; {count} are needed.")
    if not np.isfinite(flat).all():
        raise refuse(f"{name} contains a number that is not finite: {flat.tolist()}.")
    return (ctypes.c_float * count)(*flat.tolist())


def affine(name: str, matrix) -> ctypes.Array:
    """3 x 4 row-major from a 3 x 4 or an affine 4 x 4 matrix."""
    try:
        rows = np.asarray(matrix, dtype=np.float32)
    except (TypeError, ValueError) as error:
        raise refuse(f"{name} must be a matrix of numbers ({error}).") from error
    if rows.shape == (4, 4):
        if not np.allclose(rows[3], (0, 0, 0, 1)):
            raise refuse(f"{name} has the last row {rows[3].tolist()}; an affine matrix ends with 0 0 0 1.")
        rows = rows[:3]
    return small(name, rows, 12)


def directions(name: str, array) -> np.ndarray:
    """[n x 3] float32."""
    return checked(name, array, (None, 3))
