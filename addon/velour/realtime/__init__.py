"""The real-time viewport."""

from .drawing import Drawing
from .errors import UnshownError
from .scene import RealtimeScene

__all__ = ["Drawing", "RealtimeScene", "UnshownError"]
