"""Nodes of a farm that are not as they should be: no picture, and a sentence that says why."""

import os
import shutil
import tempfile
import unittest
from pathlib import Path

import bpy

from support import process
from support.farm import FarmTest

_NOBODY = 65534
_STAMP = 'result.stamp_data_add_field("velour.version", version_text())'


class Nodes(FarmTest):
    def _assert_refused(self, *words, environment=None):
        """A status and the reason, at once and when asked later."""
        node = self.node("--frames", 1, environment=environment)
        self.assertEqual(node.returncode, 1, node.stdout)
        self.assertEqual(self.pictures(), [])
        status, said = self.status()
        self.assertEqual(status, 1, said)
        for word in words:
            self.assertIn(word, node.stdout)
            self.assertIn(word, said)
        self.assertEqual(list((self.output / "farm/partial").rglob("*.exr")), [])

    def test_without_velour(self):
        empty = self.folder / "empty"
        empty.mkdir()
        words = ("frame 1", "Blender ended with status 1", "VELOUR")
        self._assert_refused(*words, environment={"BLENDER_USER_SCRIPTS": str(empty)})

    def test_older_velour(self):
        older = _STAMP.replace("version_text()", '"0.0.9"')
        environment = self.another_stage("older", "engine/stamps.py", _STAMP, older)
        self._assert_refused("Velour 0.0.9 rendered it, the job is for 0.1.0", environment=environment)

    def test_velour_that_says_nothing(self):
        environment = self.another_stage("silent", "engine/stamps.py", _STAMP, "pass")
        self._assert_refused("no Velour wrote it, or one older than 0.1.0", environment=environment)

    def test_missing_model(self):
        (self.shots / "paint.velour").unlink()
        self._assert_refused("Material 'paint'", "paint.velour", "Find Missing Files")

    def test_other_model(self):
        self.edit_job(models={"paint": ["0" * 64]})
        self._assert_refused("rendered from other models than the job's: 'paint'")


@unittest.skipUnless(os.geteuid() == 0 and shutil.which("setpriv"), "needs root, to become nobody")
class Site(FarmTest):
    """The add-on lies where nobody may write, and the home cannot be written to."""

    def setUp(self):
        if "VELOUR_BPY" in os.environ:
            self.skipTest("the module bpy lies where nobody may not read")
        super().setUp()
        # Where nobody can go, whatever folder these tests are in.
        self.site = Path(tempfile.mkdtemp(prefix="velour-site-"))
        self.addCleanup(shutil.rmtree, self.site)
        self.site.chmod(0o755)

    def test_read_only_site_and_home(self):
        scripts = self.site / "scripts"
        shutil.copytree(os.environ["VELOUR_STAGE"], scripts)
        self._render_as_nobody(scripts, {"BLENDER_USER_SCRIPTS": str(scripts)})

    @unittest.skipUnless(hasattr(bpy.utils, "extension_path_user"), "Blender has no extensions before 4.2")
    def test_system_repository_of_extensions(self):
        repositories = self.site / "extensions"
        addon = Path(os.environ["VELOUR_STAGE"]) / "addons/velour"
        shutil.copytree(addon, repositories / "system/velour")
        self.edit_job(addon="bl_ext.system.velour")
        nothing = self.site / "nothing"
        nothing.mkdir()
        variables = {"BLENDER_SYSTEM_EXTENSIONS": str(repositories), "BLENDER_USER_SCRIPTS": str(nothing)}
        self._render_as_nobody(repositories, variables)

    def _render_as_nobody(self, addon, variables):
        home = self.site / "home"
        shutil.copytree(self.shots, self.site / "shots")
        home.mkdir()
        self.output = self.site / "shots/frames"
        self.edit_job(blend=str(self.site / "shots/shot.blend"))
        for path in (self.output, *self.output.rglob("*")):
            os.chown(path, _NOBODY, _NOBODY)
        nobody = ["setpriv", f"--reuid={_NOBODY}", f"--regid={_NOBODY}", "--clear-groups"]
        refused = process.run([*nobody, "touch", home / "x", addon / "x"])
        self.assertEqual(refused.stdout.count("Permission denied"), 2, refused.stdout)
        node = self.node("--frames", 1, environment={**variables, "HOME": str(home)}, prefix=nobody)
        self.assertEqual(node.returncode, 0, node.stdout)
        self.assertEqual(self.pictures(), ["shot_0001.exr"])
        self.assertEqual(list(home.iterdir()), [])
