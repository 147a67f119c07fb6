"""Errors of the real-time viewport."""

import contextlib
import logging

log = logging.getLogger(__package__)


class UnshownError(Exception):
    """Only the ray tracer supports the scene; the message says why."""


LOST = (RuntimeError, SystemError, ReferenceError)  # raised by Blender if its context is gone


@contextlib.contextmanager
def asking_for(what, errors=Exception):
    """Turns errors of GPU allocations into UnshownError: the GPU may be out of memory, or lost."""
    try:
        yield
    except UnshownError:
        raise
    except errors as error:
        log.error("the GPU cannot create %s", what, exc_info=error)
        raise UnshownError(
            f"the GPU cannot create {what}, so the ray tracer shows the scene; close other programs that use"
            " the GPU or use smaller images, then choose Real Time again"
        ) from error
