"""A frame counts as done only when this Velour rendered it from these models and all of it is there."""

import os
import shutil
import tempfile
import unittest
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import bpy
import numpy as np

from support import inputs, process
from support.farm import FarmTest

_NOBODY = 65534
_STAMP = 'result.stamp_data_add_field("velour.version", version_text())'


class Farm(FarmTest):
    def _assert_refused(self, node, *words):
        """No picture, a status, and the reason in a sentence, at once and when asked later."""
        self.assertEqual(node.returncode, 1, node.stdout)
        self.assertEqual(self.pictures(), [])
        status, said = self.status()
        self.assertEqual(status, 1, said)
        for word in words:
            self.assertIn(word, node.stdout)
            self.assertIn(word, said)
        self.assertEqual(list((self.output / "farm/partial").rglob("*.exr")), [])

    def test_frames_that_are_done_are_kept(self):
        self.make("--threads", "1")
        self.assertEqual(self.status()[0], 3)
        done = self.node("--frames", "1-2")
        self.assertEqual(done.returncode, 0, done.stdout)
        self.assertEqual(self.pictures(), ["shot_0001.exr", "shot_0002.exr"])
        self.assertEqual(
            self.status()[1].splitlines(), ["not done yet: 3", "2 of 3 frames done, 0 failed, 1 left"]
        )

        kept, whole = self.picture(1).stat().st_mtime_ns, self.picture(2).read_bytes()
        self.picture(2).write_bytes(whole[:-100])
        killed = self.output / "farm/partial/0002/node-1"  # what a run that was killed leaves
        killed.mkdir(parents=True)
        (killed / "picture_0002.exr").write_bytes(whole[:50])
        for task in range(3):
            done = self.node("--task", task)
            self.assertEqual(done.returncode, 0, done.stdout)
        self.assertEqual(self.picture(1).stat().st_mtime_ns, kept)
        self.assertEqual(len(self.picture(2).read_bytes()), len(whole))
        self.assertFalse(killed.exists())
        self.assertEqual(self.status(), (0, "3 of 3 frames done, 0 failed, 0 left\n"))
        self.assertEqual(self.node("--task", 3).returncode, 1)

    def test_two_runs_of_a_frame(self):
        """Whichever is first clears away what the other one has."""
        self.make("--frames", "1")
        with ThreadPoolExecutor(2) as pool:
            for node in pool.map(lambda _: self.node("--task", 0), range(2)):
                self.assertEqual(node.returncode, 0, node.stdout)
        self.assertEqual(self.status()[0], 0)

    def test_layers_and_preferences(self):
        """A multilayer file, of whose layers one shows the model; with the node's preferences."""
        bpy.context.scene.view_layers.new("Empty").use_sky = True
        bpy.ops.wm.save_mainfile()
        self.make("--format", "OPEN_EXR_MULTILAYER", "--preferences")
        done = self.node("--frames", "2", environment={"BLENDER_USER_CONFIG": str(self.folder / "config")})
        self.assertEqual(done.returncode, 0, done.stdout)
        data = self.picture(2).read_bytes()
        self.assertIn(b"Empty", data)
        self.assertIn(bpy.data.images["paint.velour"].velour.sha256.encode(), data)

    def test_another_picture(self):
        """Whole, but not rendered by Velour."""
        self.make("--frames", "1")
        inputs.native().images.write(self.picture(1), np.ones((60, 80, 4), np.float32))
        self.assertEqual(self.status()[0], 3)
        self.assertEqual(self.node("--task", 0).returncode, 0)
        self.assertEqual(self.status()[0], 0)

    def test_without_velour(self):
        self.make("--frames", "1")
        empty = self.folder / "empty"
        empty.mkdir()
        node = self.node("--task", 0, environment={"BLENDER_USER_SCRIPTS": str(empty)})
        self._assert_refused(node, "frame 1", "Blender ended with status 1", "VELOUR")

    def test_older_velour(self):
        self.make("--frames", "1")
        older = _STAMP.replace("version_text()", '"0.0.9"')
        environment = self.another_stage("older", "engine/stamps.py", _STAMP, older)
        node = self.node("--task", 0, environment=environment)
        self._assert_refused(node, "Velour 0.0.9 rendered it, the job is for 0.1.0")

    def test_velour_that_says_nothing(self):
        self.make("--frames", "1")
        environment = self.another_stage("silent", "engine/stamps.py", _STAMP, "pass")
        node = self.node("--task", 0, environment=environment)
        self._assert_refused(node, "no Velour wrote it, or one older than 0.1.0")

    def test_missing_model(self):
        self.make("--frames", "1")
        (self.shots / "paint.velour").unlink()
        self._assert_refused(self.node("--task", 0), "Material 'paint'", "paint.velour", "Find Missing Files")

    def test_other_model(self):
        self.make("--frames", "1")
        self.edit_job(models={"paint": ["0" * 64]})
        self._assert_refused(self.node("--task", 0), "rendered from other models than the job's: 'paint'")

    def test_another_blend(self):
        """What is half done is not finished from another state of the scene."""
        self.make()
        bpy.context.scene.frame_end = 4
        bpy.ops.wm.save_mainfile()
        done = self.farm(self.blend, "--no-submit")
        self.assertEqual(done.returncode, 1, done.stdout)
        self.assertIn("is of another .blend", done.stdout)

    def test_blend_without_velour_here(self):
        done = self.farm(self.blend, "--no-submit", "--addon", "velours")
        self.assertEqual(done.returncode, 1, done.stdout)
        self.assertIn("there is no add-on 'velours' in this Blender", done.stdout)
        self.assertFalse(self.output.exists())


@unittest.skipUnless(os.geteuid() == 0 and shutil.which("setpriv"), "needs root, to become nobody")
class Site(FarmTest):
    """The add-on lies where nobody may write, and the home cannot be written to."""

    def setUp(self):
        super().setUp()
        # Where nobody can go, whatever folder these tests are in.
        self.site = Path(tempfile.mkdtemp(prefix="velour-site-"))
        self.addCleanup(shutil.rmtree, self.site)
        self.site.chmod(0o755)

    def test_read_only_site_and_home(self):
        self.make("--frames", "1")
        shutil.copytree(os.environ["VELOUR_STAGE"], self.site / "scripts")
        shutil.copytree(self.shots, self.site / "shots")
        (self.site / "home").mkdir()
        self.output = self.site / "shots/frames"
        for path in (self.output, *self.output.rglob("*")):
            os.chown(path, _NOBODY, _NOBODY)
        self.edit_job(blend=str(self.site / "shots/shot.blend"))
        environment = {"BLENDER_USER_SCRIPTS": str(self.site / "scripts"), "HOME": str(self.site / "home")}
        nobody = ["setpriv", f"--reuid={_NOBODY}", f"--regid={_NOBODY}", "--clear-groups"]
        refused = process.run([*nobody, "touch", self.site / "home/x", self.site / "scripts/x"])
        self.assertEqual(refused.stdout.count("Permission denied"), 2, refused.stdout)
        node = self.node("--task", 0, environment=environment, prefix=nobody)
        self.assertEqual(node.returncode, 0, node.stdout)
        self.assertEqual(self.pictures(), ["shot_0001.exr"])
        self.assertEqual(list((self.site / "home").iterdir()), [])
