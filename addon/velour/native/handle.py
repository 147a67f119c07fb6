"""Base of all wrapper classes: each owns one opaque handle of the library."""

from __future__ import annotations

import ctypes
import os

from . import library
from .errors import Status, VelourError, refuse


class Handle:
    """Owns a handle. A context manager; close() may be called repeatedly. Use from one thread at a time."""

    _free_name = ""
    _pointer: ctypes.c_void_p | None = None

    def __init__(self, lib: ctypes.CDLL, pointer: ctypes.c_void_p):
        self._lib = lib
        self._free = getattr(
            lib, self._free_name
        )  # looked up now: __del__ may run while the interpreter exits
        self._pointer = pointer

    @classmethod
    def _create(cls, function_name: str, *arguments, **more):
        """The object that `function(*arguments, &handle)` makes."""
        lib = library.load()
        pointer = ctypes.c_void_p()
        getattr(lib, function_name)(*arguments, ctypes.byref(pointer))
        return cls(lib, pointer, **more)

    @property
    def pointer(self) -> ctypes.c_void_p:
        if self._pointer is None:
            raise VelourError(Status.INVALID_STATE, f"This {type(self).__name__} is closed.")
        return self._pointer

    @property
    def closed(self) -> bool:
        return self._pointer is None

    def close(self) -> None:
        pointer, self._pointer = self._pointer, None
        if pointer is not None:
            self._free(pointer)

    def __enter__(self):
        return self

    def __exit__(self, *_exception):
        self.close()

    def __del__(self):
        self.close()


def text_bytes(text: str) -> bytes:
    """UTF-8. Names of files may have other bytes, which become question marks."""
    return text.encode("utf-8", "replace")


def path_bytes(path: str | os.PathLike) -> bytes:
    """A path for the library: UTF-8 or whatever bytes the system gave, without a zero byte."""
    encoded = os.fsencode(path)
    if b"\0" in encoded:
        raise refuse(f"The path {encoded!r} contains a zero byte.")
    return encoded


def set_fields(struct, values: dict) -> None:
    """Sets fields of an options struct by name; unknown names and values out of range are refused."""
    names = {name: kind for name, kind in struct._fields_ if name != "struct_size"}
    for name, value in values.items():
        if name not in names:
            known = ", ".join(names)
            raise TypeError(f"{type(struct).__name__} has no option {name!r}; its options are {known}")
        kind = names[name]
        largest = 2 ** (8 * ctypes.sizeof(kind)) - 1
        if kind in (ctypes.c_uint32, ctypes.c_uint64) and not 0 <= int(value) <= largest:
            raise refuse(f"{name} is {value}; an integer from 0 to {largest} is needed.")
        setattr(struct, name, value)


def choice(name: str, value, names: tuple[str, ...]) -> int:
    """The number of a named choice; a number in range is returned as it is."""
    if isinstance(value, str):
        value = value.lower()
        if value in names:
            return names.index(value)
    elif 0 <= int(value) < len(names):
        return int(value)
    raise refuse(f"{name} is {value!r}; it must be one of {', '.join(names)}.")
