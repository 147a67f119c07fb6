"""The real-time viewport."""

from .drawing import Drawing
from .scene import RealtimeScene, UnshownError

__all__ = ["Drawing", "RealtimeScene", "UnshownError"]
