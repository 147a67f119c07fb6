"""scripts/saved_settings: writes the table of settings that this version saves, in the real Blender."""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

import headless_blender
from velour.native.version import version_text
from velour_cli import ROOT


def main() -> None:
    table = ROOT / f"blend-tests/releases/{version_text()}.json"
    with tempfile.TemporaryDirectory(prefix="velour-saved-") as folder:
        log = Path(folder) / "blender.log"
        headless_blender.run("saved_settings_inside.py", {"table": str(table)}, log, ["--addons", "velour"])
    print(table)


if __name__ == "__main__":
    main()
