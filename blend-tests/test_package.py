"""The zip of scripts/package, installed by Blender itself into the home of somebody who has nothing else."""

import os
import re
import unittest
from pathlib import Path

import bpy

from support import process
from support.blender import BlenderTest

ZIPS = Path(__file__).resolve().parent.parent / "build/package"
SECONDS = 60

_INSTALL = """
import bpy
bpy.ops.preferences.addon_install(filepath={path!r})
bpy.ops.preferences.addon_enable(module="velour")
bpy.ops.wm.save_userpref()
"""
_RENDER = """
import sys
import bpy
import numpy as np

name = next(name for name in bpy.context.preferences.addons.keys() if name.rpartition(".")[2] == "velour")
scene = bpy.context.scene
scene.render.engine, scene.velour.samples = "VELOUR", 4
scene.render.resolution_percentage = 5
scene.render.filepath, scene.render.image_settings.file_format = {picture!r}, "OPEN_EXR"
bpy.ops.render.render(write_still=True)
picture = bpy.data.images.load({picture!r})
pixels = np.empty(len(picture.pixels), np.float32)
picture.pixels.foreach_get(pixels)
print("MODULE", name)
print("BRIGHTEST", pixels.reshape(-1, picture.channels)[:, :3].max())
print("EMBREE", sys.modules[name + ".native"].library.system()["embree"]["path"])
print(open("/proc/self/maps").read())
"""


def _newest_zip():
    return max(ZIPS.glob("velour-*.zip"), key=lambda path: path.stat().st_mtime, default=None)


@unittest.skipIf(_newest_zip() is None, "there is no package; scripts/package makes one")
class Package(BlenderTest):
    def setUp(self):
        super().setUp()
        self.home = self.folder / "home"
        self.home.mkdir()
        names = ("PATH", "LANG", "DISPLAY", "VELOUR_BPY")  # the last: where Blender is the module bpy
        kept = {key: value for key, value in os.environ.items() if key in names}
        self.environment = {**kept, "HOME": str(self.home), "TMPDIR": str(self.folder)}

    def _blender(self, *arguments):
        command = ["env", "-i", *(f"{k}={v}" for k, v in self.environment.items()), bpy.app.binary_path]
        done = process.run([*command, *arguments], seconds=SECONDS)
        self.assertEqual(done.returncode, 0, done.stdout)
        return done.stdout

    def _install(self):
        path = str(_newest_zip())
        if hasattr(bpy.utils, "register_cli_command"):  # 4.2 and newer
            self._blender("--command", "extension", "validate", path)
            command = ("install-file", "-r", "user_default", "--enable", path)
            self._blender("--command", "extension", *command)
        else:
            self._blender("-b", "--python-exit-code", "1", "--python-expr", _INSTALL.format(path=path))

    def test_renders_with_its_own_libraries(self):
        if "VELOUR_BPY" in os.environ and bpy.app.version < (4, 3):
            self.skipTest("as a module this Blender crashes when it reads preferences")
        self._install()
        script = _RENDER.format(picture=str(self.folder / "a.exr"))
        said = self._blender("-b", "--python-exit-code", "1", "--python-expr", script)
        module = re.search(r"MODULE (\S+)", said)[1]
        self.assertEqual(module.startswith("bl_ext."), hasattr(bpy.utils, "register_cli_command"), module)
        self.assertGreater(float(re.search(r"BRIGHTEST (\S+)", said)[1]), 0.01)
        embree = re.search(r"EMBREE (\S+)", said)[1]
        self.assertTrue(embree.startswith(str(self.home)), embree)
        mapped = {path for path in re.findall(r"(/\S+\.so[.\d]*)$", said, re.MULTILINE)}
        own = {Path(path).name for path in mapped if path.startswith(str(self.home))}
        print("libraries of its own:", *sorted(own))
        self.assertIn("libvelour.so", own)
        self.assertTrue(any(name.startswith("libOpenEXR") for name in own) or self._same_openexr(mapped), own)

    @staticmethod
    def _same_openexr(mapped):
        """Of the same minor version Blender's copy serves both: its names are the same."""
        ours = {path.name for path in (ZIPS / "blender/addons/velour/lib").glob("libOpenEXR-*")}
        return any(
            re.match(re.escape(name.partition(".so")[0]), Path(path).name) for path in mapped for name in ours
        )
