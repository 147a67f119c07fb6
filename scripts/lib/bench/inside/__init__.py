"""What runs in Blender: main(task), or in a window the generator steps(folder, task); and their scenes."""

import importlib
import json

FRAME_MARK = "night frame: "  # begins the line of a frame that night.listen() prints


def start(script, task, report):
    """Calls main() of a script of this folder and writes what it returns to the file `report`."""
    found = importlib.import_module(f"{__name__}.{script}").main(json.loads(task))
    if found is not None:
        with open(report, "w") as file:
            json.dump(found, file)


def frames_of(log):
    """The frames that night.listen() has printed into a log."""
    lines = log.read_text(encoding="utf-8", errors="replace").splitlines()
    return [json.loads(line.removeprefix(FRAME_MARK)) for line in lines if line.startswith(FRAME_MARK)]
