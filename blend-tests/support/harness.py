"""Runs files of tests inside Blender, each of which writes FOLDER/report.json.

`--python harness.py -- FILE FOLDER` runs one file. `--python harness.py -- --orders` runs one after another,
each from factory settings: an order is a line "FILE<tab>FOLDER" on stdin, its answer a line "done" on stdout;
all else that is said goes to FOLDER/log.txt. The process ends with the orders.
"""

import importlib.util
import os
import sys
import traceback
import unittest
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from support import blender, report

ORDERS = "--orders"
TURN = 0.05  # seconds
IN_SCRIPTS = {path.stem for path in (Path(__file__).resolve().parents[2] / "scripts/lib").iterdir()}


class Result(unittest.TextTestResult):
    """Also lists what it has seen, with times."""

    def __init__(self, *arguments, **keywords):
        super().__init__(*arguments, **keywords)
        self.tests = []

    def startTest(self, test):  # noqa: N802  (unittest's name)
        super().startTest(test)
        self._clock, self._outcome = report.Clock(), report.PASSED

    def stopTest(self, test):  # noqa: N802
        super().stopTest(test)
        name = test.id().partition(".")[2]
        self.tests.append(report.Test(name, self._outcome, *self._clock.read(), self._reason(test)))

    def _reason(self, test):
        return next((reason for skipped, reason in self.skipped if skipped is test), "")

    def addSkip(self, test, reason):  # noqa: N802
        super().addSkip(test, reason)
        self._note(test, report.SKIPPED, reason)

    def addFailure(self, test, error):  # noqa: N802
        super().addFailure(test, error)
        self._note(test, report.FAILED)

    def addError(self, test, error):  # noqa: N802
        super().addError(test, error)
        self._note(test, report.FAILED)

    def addSubTest(self, test, subtest, error):  # noqa: N802
        super().addSubTest(test, subtest, error)
        if error:
            self._note(test, report.FAILED)

    def addUnexpectedSuccess(self, test):  # noqa: N802
        super().addUnexpectedSuccess(test)
        self._note(test, report.FAILED)

    def _note(self, test, outcome, reason=""):
        """A class or module that cannot be set up is no test that has started."""
        if isinstance(test, unittest.TestCase):
            self._outcome = outcome
        else:
            self.tests.append(report.Test(test.id(), outcome, reason=reason))


def load(path):
    spec = importlib.util.spec_from_file_location(path.stem, path)
    module = importlib.util.module_from_spec(spec)
    sys.modules[path.stem] = module
    spec.loader.exec_module(module)
    return module


def run(path, folder):
    """Runs a file without a window; how many of its tests failed."""
    prepare(folder)
    suite = unittest.defaultTestLoader.loadTestsFromModule(load(path))
    result = unittest.TextTestRunner(stream=sys.stdout, verbosity=2, resultclass=Result).run(suite)
    return report.write(folder, result.tests)


def prepare(folder):
    blender.set_folder(folder)
    blender.enable_addon()


def begin(path, folder):
    """Starts a file in a window: its tests take turns with Blender, and the report tells their end."""
    try:
        prepare(folder)
        load(path).start(folder)
    except BaseException:
        traceback.print_exc(file=sys.stdout)
        report.write(folder, [report.Test(path.stem, report.FAILED)])


def _is_of_a_file(name):
    """Whether no other file may find this module: a file of tests, or a module or package of scripts/lib."""
    return name.startswith(("test_", "window_")) or name.partition(".")[0] in IN_SCRIPTS


class Orders:
    """Orders on stdin, answers on stdout; for what is run they are /dev/null and the log of its folder."""

    def __init__(self):
        self._orders, self._answers = os.fdopen(os.dup(0)), os.fdopen(os.dup(1), "w")
        os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
        self._environment, self._path = dict(os.environ), list(sys.path)

    def next(self):
        """File and folder of the next order, for which Blender is as new; None after the last."""
        line = self._orders.readline()
        if not line:
            return None
        path, folder = map(Path, line.rstrip("\n").split("\t"))
        self._log_to(folder / "log.txt")
        self._reset()
        return path, folder

    def done(self):
        self._flush()
        self._answers.write("done\n")
        self._answers.flush()

    def _reset(self):
        os.environ.clear()
        os.environ.update(self._environment)
        sys.path[:] = self._path
        for name in [name for name in sys.modules if _is_of_a_file(name)]:
            del sys.modules[name]
        bpy.ops.wm.read_factory_settings(use_empty=False)

    def _log_to(self, path):
        self._flush()
        log = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
        for output in (1, 2):
            os.dup2(log, output)
        os.close(log)

    @staticmethod
    def _flush():
        sys.stdout.flush()
        sys.stderr.flush()


def run_orders():
    orders = Orders()
    while order := orders.next():
        try:
            run(*order)
        except Exception:
            traceback.print_exc(file=sys.stdout)  # without a report, which counts as failed
        orders.done()


def run_orders_in_window():
    orders, folder = Orders(), None

    def turn():
        nonlocal folder
        if folder and not (folder / report.FILE).exists():
            return TURN
        # Blender does not survive a new file beside a render of the tests, or of a preview.
        if any(map(bpy.app.is_job_running, ("RENDER", "RENDER_PREVIEW"))):
            return TURN
        if folder:
            orders.done()
        if order := orders.next():
            folder = order[1]
            begin(*order)
            return TURN
        bpy.ops.wm.quit_blender()
        return None

    bpy.app.timers.register(turn, first_interval=1.0, persistent=True)  # over file loads


def run_in_window(path, folder):
    def turn():
        if not (folder / report.FILE).exists():
            return TURN
        bpy.ops.wm.quit_blender()
        return None

    begin(path, folder)
    bpy.app.timers.register(turn, persistent=True)


def main():
    arguments = sys.argv[sys.argv.index("--") + 1 :]
    if arguments == [ORDERS]:
        run_orders() if bpy.app.background else run_orders_in_window()
        return
    path, folder = map(Path, arguments)
    if bpy.app.background:
        sys.exit(1 if run(path, folder) else 0)
    bpy.app.timers.register(
        lambda: run_in_window(path, folder), first_interval=1.0
    )  # once the window is there


main()
