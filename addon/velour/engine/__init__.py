"""The render engine."""

from . import viewport_clock, write_lock
from .engine import VelourRenderEngine

CLASSES = (VelourRenderEngine,)


def attach():
    write_lock.attach()


def detach():
    viewport_clock.detach()
    write_lock.detach()
