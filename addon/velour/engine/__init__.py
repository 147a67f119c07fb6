"""The render engine."""

from . import viewport, viewport_clock, write_lock
from .engine import VelourRenderEngine

CLASSES = (VelourRenderEngine,)


def attach():
    viewport.attach()
    write_lock.attach()


def detach():
    viewport.detach()
    viewport_clock.detach()
    write_lock.detach()
