"""The runner of regression scenes: what it must refuse, and that one scene that dies leaves the others be."""

import shutil
import unittest
from pathlib import Path

import bpy

from support import level, process
from support.blender import BlenderTest

HERE = Path(__file__).resolve().parent
_PICTURE = "instances"
_SUN, _BRIGHTER_SUN = '"SUN", 3,', '"SUN", 3.03,'
_DIE = """QUANTITY = "a crash"
def build(folder):
    import os, signal
    os.kill(os.getpid(), signal.SIGKILL)
"""
_RAISE = 'QUANTITY = "a mistake"\ndef build(folder):\n    raise RuntimeError("no such thing")\n'


class Runner(BlenderTest):
    """A folder of scenes of its own."""

    def setUp(self):
        super().setUp()
        self.scenes = self.folder / "scenes"
        (self.scenes / "references").mkdir(parents=True)

    def add(self, name, text):
        """A scene with the picture's reference."""
        (self.scenes / f"{name}.py").write_text(text)
        for ending in (".exr", ".error.exr"):
            shutil.copy(
                HERE / f"scenes/references/{_PICTURE}{ending}", self.scenes / f"references/{name}{ending}"
            )

    def picture(self):
        return (HERE / f"scenes/{_PICTURE}.py").read_text()

    def brighter(self):
        """The picture under a sun that is 1 % too strong."""
        text = self.picture()
        self.assertIn(_SUN, text)
        return text.replace(_SUN, _BRIGHTER_SUN)

    def run_scenes(self, *arguments):
        command = [HERE / "run_scenes", "--folder", self.scenes, "--output", self.folder / "page", *arguments]
        command += ["--blender", bpy.app.binary_path]
        return process.run(command)

    def test_each_scene_stands_alone(self):
        self.add("a_crash", _DIE)
        self.add("b_mistake", _RAISE)
        self.add("c_brighter", self.brighter())
        self.add("d_refused", self.picture() + '\nREFUSAL = ("never said",)\n')
        self.add("e_same", self.picture())
        done = self.run_scenes()
        self.assertEqual(done.returncode, 1, done.stdout)
        for words in (
            "FAILED: a_crash: it cannot be built: Blender crashed (SIGKILL)",
            "FAILED: b_mistake: it cannot be built: no such thing",
            "FAILED: c_brighter, frame 1: differs in color",
            "FAILED: d_refused: Blender ended with status 0, wrote ['picture_0001.exr']",
            "ok: e_same, frame 1:",
            "1 passed, 4 failed",
        ):
            self.assertIn(words, done.stdout)
        for name in ("a_crash", "c_brighter", "e_same"):
            self.assertIn(name, (self.folder / "page/index.html").read_text())

    def test_each_meaning_has_its_reference(self):
        """What a scene means in this Blender is held against that reference, and no other will do."""
        meant = self.picture() + '\nMEANINGS = ("", "other")\ndef meaning():\n    return "MEANT"\n'
        self.add("a_other", meant.replace("MEANT", "other"))
        for ending in (".exr", ".error.exr"):
            path = self.scenes / f"references/a_other{ending}"
            path.rename(self.scenes / f"references/a_other.other{ending}")
            shutil.copy(HERE / f"scenes/references/sphere{ending}", path)
        self.add("b_first", meant.replace("MEANT", ""))
        self.add("c_without", meant.replace("MEANT", "other"))
        self.add("d_unknown", meant.replace("MEANT", "strange"))
        done = self.run_scenes()
        for words in (
            "ok: a_other, frame 1:",
            "ok: b_first, frame 1:",
            "FAILED: c_without, frame 1: c_without.other.exr: cannot read",
            "FAILED: d_unknown: its MEANINGS lack 'strange'",
        ):
            self.assertIn(words, done.stdout)

    @unittest.skipUnless(level.LONG, level.REASON)
    def test_update_makes_what_passes(self):
        self.add("brighter", self.brighter())
        before = (self.scenes / "references/brighter.exr").read_bytes()
        self.assertEqual(self.run_scenes("--update", "brighter").returncode, 0)
        self.assertNotEqual((self.scenes / "references/brighter.exr").read_bytes(), before)
        done = self.run_scenes("brighter")
        self.assertEqual(done.returncode, 0, done.stdout)

    def test_unknown_name(self):
        self.add("sphere", self.picture())
        done = self.run_scenes("spear")
        self.assertEqual(done.returncode, 1)
        self.assertIn("There is no scene 'spear'; the scenes are sphere.", done.stdout)


if __name__ == "__main__":
    unittest.main()
