"""Export of Blender's evaluated depsgraph to the library's scene."""

from .notes import ExportError, Notes
from .scene import export_scene

__all__ = ["ExportError", "Notes", "export_scene"]
