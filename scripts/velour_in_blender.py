"""The command line of Velour inside Blender: blender -b --python-exit-code 1 -P THIS -- VERB ...

Runs the add-on that scripts/build staged, which need not be enabled. From Blender 4.2 on,
`blender --command velour VERB ...` does the same with an installed add-on.
"""

import os
import runpy
import sys
from pathlib import Path

_ROOT = Path(__file__).resolve().parents[1]
_STAGE = Path(os.environ.get("VELOUR_STAGE", _ROOT / "build/release/blender"))
_PROGRAM = _STAGE / "addons/velour/core/cli/in_blender.py"

if not _PROGRAM.is_file():
    sys.exit(f"velour: Velour is not built yet; run {_ROOT}/scripts/build (after scripts/setup)")
runpy.run_path(str(_PROGRAM), run_name="__main__")
