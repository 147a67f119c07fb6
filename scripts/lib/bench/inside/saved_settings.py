"""Writes the table of settings that the add-on saves."""

from pathlib import Path

import bpy
from support import saved_settings


def main(task):
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    saved_settings.add_owners()
    saved_settings.write(Path(task["table"]), saved_settings.described())
