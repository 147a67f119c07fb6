"""The render engine."""

from . import (
    denoising,
    failed_frame,
    frame_parts,
    freed_engines,
    kept_scene,
    model_images,
    viewport,
    viewport_clock,
    write_lock,
)
from .engine import VelourRenderEngine

CLASSES = (VelourRenderEngine, write_lock.VELOUR_OT_allow_writes)


def attach():
    denoising.attach()
    failed_frame.attach()
    frame_parts.attach()
    kept_scene.attach()
    model_images.attach()
    viewport.attach()
    write_lock.attach()


def detach():
    viewport.detach()
    freed_engines.detach()
    viewport_clock.detach()
    write_lock.detach()
    model_images.detach()
    kept_scene.detach()
    frame_parts.detach()
    failed_frame.detach()
    denoising.detach()
