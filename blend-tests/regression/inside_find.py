"""Runs inside Blender: where the installed add-on lies. The task: "report", which gets "addons"."""

from pathlib import Path

import addon_utils


def main(_task):
    files = [module.__file__ for module in addon_utils.modules() if _is_velour(module.__name__)]
    if not files:
        raise RuntimeError("this Blender has no Velour installed")
    return {"addons": str(Path(files[0]).resolve().parents[1])}


def _is_velour(name):
    return name == "velour" or name.endswith(".velour")  # of an extension: bl_ext.REPOSITORY.velour
