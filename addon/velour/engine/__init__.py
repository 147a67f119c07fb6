"""The render engine."""

from .engine import VelourRenderEngine

CLASSES = (VelourRenderEngine,)


def attach():
    """Nothing beside the class."""


def detach():
    """Nothing beside the class."""
