"""Runs one file of tests inside Blender: `--python harness.py -- FILE FOLDER`. Writes FOLDER/report.json."""

import importlib.util
import json
import sys
import time
import traceback
import unittest
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from support import blender

SLOW_SECONDS = 5


class Result(unittest.TextTestResult):
    """Also counts the passed ones, and says what took long."""

    def __init__(self, *arguments, **keywords):
        super().__init__(*arguments, **keywords)
        self.passed = 0

    def startTest(self, test):  # noqa: N802  (unittest's name)
        super().startTest(test)
        self._start = time.monotonic()

    def stopTest(self, test):  # noqa: N802
        super().stopTest(test)
        seconds = time.monotonic() - self._start
        if seconds > SLOW_SECONDS:
            self.stream.writeln(f"slow: {test.id().rpartition('.')[2]}: {seconds:.1f} s")

    def addSuccess(self, test):  # noqa: N802
        super().addSuccess(test)
        self.passed += 1


def load(path):
    spec = importlib.util.spec_from_file_location(path.stem, path)
    module = importlib.util.module_from_spec(spec)
    sys.modules[path.stem] = module
    spec.loader.exec_module(module)
    return unittest.defaultTestLoader.loadTestsFromModule(module)


def run(path, folder):
    blender.set_folder(folder)
    blender.enable_addon()
    result = unittest.TextTestRunner(stream=sys.stdout, verbosity=2, resultclass=Result).run(load(path))
    failed = len(result.failures) + len(result.errors) + len(result.unexpectedSuccesses)
    reasons = sorted({reason for _test, reason in result.skipped})
    report = {"passed": result.passed, "failed": failed, "skipped": len(result.skipped), "reasons": reasons}
    (folder / "report.json").write_text(json.dumps(report))
    sys.stdout.flush()
    return failed


def main():
    path, folder = (Path(argument) for argument in sys.argv[sys.argv.index("--") + 1 :])
    if bpy.app.background:
        sys.exit(1 if run(path, folder) else 0)
    # With a window: once it is there. What needs several turns of the event loop writes its report itself.
    bpy.app.timers.register(lambda: run_in_window(path, folder), first_interval=1.0)


def run_in_window(path, folder):
    try:
        blender.set_folder(folder)
        blender.enable_addon()
        spec = importlib.util.spec_from_file_location(path.stem, path)
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        module.start(folder)
    except BaseException:
        traceback.print_exc(file=sys.stdout)
        bpy.ops.wm.quit_blender()  # without a report, which counts as failed


main()
