"""Errors of the library and its wrappers. Each is one sentence for the user."""

from __future__ import annotations

from enum import IntEnum


class Status(IntEnum):
    """vlr_status."""

    OK = 0
    UNKNOWN = 1
    INVALID_ARGUMENT = 2
    INVALID_STATE = 3
    OUT_OF_MEMORY = 4
    UNSUPPORTED = 5
    IO = 6
    BAD_DATA = 7
    CANCELLED = 8
    VERSION_MISMATCH = 9


class VelourError(RuntimeError):
    """A call was refused or failed. `status` is a Status, or its number if it is newer than this table."""

    def __init__(self, status: int, sentence: str):
        super().__init__(sentence)
        self.status = Status(status) if status in Status._value2member_map_ else status
        self.sentence = sentence

    @property
    def cancelled(self) -> bool:
        return self.status == Status.CANCELLED


class LibraryError(VelourError):
    """The shared library is missing, cannot be loaded, or does not match this package."""

    def __init__(self, sentence: str):
        super().__init__(Status.VERSION_MISMATCH, sentence)


def refuse(sentence: str) -> VelourError:
    """The error of an argument that is refused before it reaches the library; the caller raises it."""
    return VelourError(Status.INVALID_ARGUMENT, sentence)
