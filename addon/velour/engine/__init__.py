"""The render engine."""

from . import frame_parts, viewport, viewport_clock, write_lock
from .engine import VelourRenderEngine

CLASSES = (VelourRenderEngine,)


def attach():
    frame_parts.attach()
    viewport.attach()
    write_lock.attach()


def detach():
    viewport.detach()
    viewport_clock.detach()
    write_lock.detach()
    frame_parts.detach()
