"""Runs inside Blender: where the installed add-on lies. The task: "report", which gets "addons"."""

import json
import sys
from pathlib import Path

import addon_utils


def main(task):
    files = [module.__file__ for module in addon_utils.modules() if _is_velour(module.__name__)]
    error = None if files else "this Blender has no Velour installed"
    addons = str(Path(files[0]).resolve().parents[1]) if files else None
    Path(task["report"]).write_text(json.dumps({"error": error, "addons": addons}))


def _is_velour(name):
    return name == "velour" or name.endswith(".velour")  # of an extension: bl_ext.REPOSITORY.velour


main(json.loads(sys.argv[sys.argv.index("--") + 1]))
