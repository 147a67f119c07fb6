"""The render engine."""

from . import frame_parts, model_images, viewport, viewport_clock, write_lock
from .engine import VelourRenderEngine

CLASSES = (VelourRenderEngine,)


def attach():
    frame_parts.attach()
    model_images.attach()
    viewport.attach()
    write_lock.attach()


def detach():
    viewport.detach()
    viewport_clock.detach()
    write_lock.detach()
    model_images.detach()
    frame_parts.detach()
