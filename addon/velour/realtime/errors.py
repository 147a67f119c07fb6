"""What real time does not show."""

import contextlib
import logging

log = logging.getLogger(__package__)


class UnshownError(Exception):
    """Something that only the ray tracer shows; a sentence says what."""


LOST = (RuntimeError, SystemError, ReferenceError)  # what Blender raises where its context is gone


@contextlib.contextmanager
def asking_for(what, errors=Exception):
    """Around what the graphics processor is asked to make: it may have no room, or be gone."""
    try:
        yield
    except UnshownError:
        raise
    except errors as error:
        log.error("the graphics processor refuses %s", what, exc_info=error)
        raise UnshownError(
            f"the graphics processor refuses {what}, so the ray tracer shows the scene; close what else uses"
            " it or choose smaller images, then choose Real Time again"
        ) from error
