"""scripts/saved_settings: writes the table of settings that this version saves, in the real Blender."""

import tempfile
from pathlib import Path

from bench import blender
from bench.velour_cli import ROOT
from velour.native.version import version_text

table = ROOT / f"blend-tests/releases/{version_text()}.json"
with tempfile.TemporaryDirectory(prefix="velour-saved-") as folder:
    blender.run("saved_settings", {"table": str(table)}, Path(folder) / "blender.log", ("--addons", "velour"))
print(table)
