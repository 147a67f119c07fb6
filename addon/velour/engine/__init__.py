"""The render engine."""

from . import write_lock
from .engine import VelourRenderEngine

CLASSES = (VelourRenderEngine,)


def attach():
    write_lock.attach()


def detach():
    write_lock.detach()
