"""Runs inside Blender: writes the table of settings that the add-on saves."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "blend-tests"))

from support import saved_settings

task = json.loads(sys.argv[sys.argv.index("--") + 1])
bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
saved_settings.add_owners()
saved_settings.write(Path(task["table"]), saved_settings.described())
