"""velour-check: trouble with one file stops nothing, and is said in a sentence."""

import signal
import subprocess
import time
import unittest
from pathlib import Path

import bpy

from support.check_folder import CheckFolderTest


def _hear_ctrl_c():
    """A shell starts what it runs in the background deaf to it, and children inherit that."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


class Trouble(CheckFolderTest):
    def test_trouble_stops_nothing(self):
        self.save("shot")
        self.update()
        whole = (self.shots / "shot.blend").read_bytes()
        self.save("a_lonely")
        (self.shots / "b_text.blend").write_text("no scene at all\n")
        (self.shots / "c_half.blend").write_bytes(whole[: len(whole) // 2])
        self.scene.render.resolution_x = 50
        self.save("d_wide")
        self.scene.render.resolution_x = 48
        text = bpy.data.texts.new("crash.py")
        text.write("import os, signal\nos.kill(os.getpid(), signal.SIGKILL)\n")
        text.use_module = True
        self.save("e_crash")
        bpy.data.texts.remove(text)
        self.scene.camera = None
        self.save("f_blind")
        self.references("b_text", "c_half", "d_wide", "e_crash", "f_blind")
        status, said, outcomes = self.check("--scripts")
        self.assertEqual(status, 1, said)
        self.assertEqual([name for name, o in outcomes.items() if o["passed"]], ["shot"], said)
        for name, words in _TROUBLE.items():
            for word in words:
                self.assertIn(word, outcomes[name]["sentence"])

    def test_wrong_usage(self):
        for arguments, word, expected in (
            (["--seeds", 1], "--seeds", 2),
            (["--samples", 0], "--samples", 2),
            (["--frame", 3], "--update", 2),
            ([], "no .blend", 2),
            ([self.folder / "nothing"], "neither", 2),
        ):
            with self.subTest(arguments):
                if word == "neither":
                    self.save("shot")
                status, said, outcomes = self.check(*arguments)
                self.assertEqual((status, outcomes), (expected, {}), said)
                self.assertIn(word, said)

    def test_interrupt(self):
        """By Ctrl-C, and as systems of continuous integration cancel a job."""
        self.scene.velour.samples = 1 << 20
        self.save("shot")
        for number, status in ((signal.SIGINT, 130), (signal.SIGTERM, 143)):
            with self.subTest(number.name):
                self._assert_stopped_by(number, status)

    def _assert_stopped_by(self, number, status):
        command = [str(part) for part in self.command("--update")]
        log = self.shots / "velour-check/work/001/inside_render.log"
        log.unlink(missing_ok=True)  # of the run before
        child = subprocess.Popen(
            command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, preexec_fn=_hear_ctrl_c
        )
        self.addCleanup(child.kill)
        self._wait_for(log, "Rendering ")
        start = time.monotonic()
        child.send_signal(number)
        said, _ = child.communicate(timeout=120)
        self.assertLess(time.monotonic() - start, 3.0)
        self.assertEqual(child.returncode, status, said)
        if status == 130:
            self.assertIn("stopped", said)
        self.assertFalse((self.shots / "shot.exr").exists())
        left = [path for path in Path("/proc").glob("[0-9]*/cmdline") if self._names_folder(path)]
        self.assertEqual(left, [], "a Blender goes on")

    def _wait_for(self, log, words):
        for _ in range(600):
            if log.is_file() and words in log.read_text(errors="replace"):
                return
            time.sleep(0.1)
        self.fail(f"{log} never said {words!r}")

    def _names_folder(self, path):
        try:
            return str(self.shots).encode() in path.read_bytes()
        except OSError:  # it ended meanwhile
            return False


_TROUBLE = {
    "a_lonely": ("a_lonely.blend", "no reference", "--update"),
    "b_text": ("b_text.blend", "cannot be opened", "save it again"),
    "c_half": ("c_half.blend", "cannot be opened"),
    "d_wide": ("d_wide.exr", "48 x 32", "50 x 32", "--update"),
    "e_crash": ("e_crash.blend", "Blender crashed"),
    "f_blind": ("f_blind.blend", "amera"),
}


if __name__ == "__main__":
    unittest.main()
