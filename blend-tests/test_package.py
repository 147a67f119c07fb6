"""The zip of scripts/package, installed by Blender itself into the home of somebody who has nothing else."""

import os
import re
import shutil
import unittest
import zipfile
from pathlib import Path

import bpy

from support import process
from support.blender import BlenderTest

ZIPS = Path(__file__).resolve().parent.parent / "build/package"
SECONDS = 60
HAS_EXTENSIONS = hasattr(bpy.utils, "register_cli_command")  # 4.2 and newer

_INSTALL = """
import bpy
bpy.ops.preferences.addon_install(filepath={path!r})
bpy.ops.preferences.addon_enable(module="velour")
bpy.ops.wm.save_userpref()
"""
_INSTALL_AGAIN = """
import bpy
if {extension}:
    bpy.ops.extensions.package_install_files(filepath={path!r}, repo="user_default", enable_on_install=True)
else:
    bpy.ops.preferences.addon_install(filepath={path!r})
    bpy.ops.preferences.addon_disable(module="velour")
    bpy.ops.preferences.addon_enable(module="velour")
"""
_MAP = """
import mmap, os, sys
sys.kept = [mmap.mmap(os.open(path, os.O_RDONLY), 1, prot=mmap.PROT_READ) for path in {paths!r}]
"""
# With or without Velour, so that what Blender maps by itself is known.
_RENDER = """
import sys
import bpy
import numpy as np

velour = [name for name in bpy.context.preferences.addons.keys() if name.rpartition(".")[2] == "velour"]
scene = bpy.context.scene
scene.render.resolution_percentage = 5
scene.render.filepath, scene.render.image_settings.file_format = {picture!r}, "OPEN_EXR"
for name in velour:
    scene.render.engine, scene.velour.samples = "VELOUR", 4
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

    def _run(self, script, *options):
        return self._blender("-b", "--python-exit-code", "1", *options, "--python-expr", script)

    def _install(self):
        if "VELOUR_BPY" in os.environ and bpy.app.version < (4, 3):
            self.skipTest("as a module this Blender crashes when it reads preferences")
        path = str(_newest_zip())
        if HAS_EXTENSIONS:
            self._blender("--command", "extension", "validate", path)
            command = ("install-file", "-r", "user_default", "--enable", path)
            self._blender("--command", "extension", *command)
        else:
            self._run(_INSTALL.format(path=path))

    def _render(self, *options):
        """What it says, and the libraries that are mapped in the end."""
        said = self._run(_RENDER.format(picture=str(self.folder / "a.exr")), *options)
        return said, {Path(path) for path in re.findall(r"(/\S+\.so[.\d]*)$", said, re.MULTILINE)}

    def _bundled(self, mapped):
        """{a bundled library's name: the files of that name, or of a longer version, that are mapped}"""
        names = [path.name for path in (ZIPS / "blender/addons/velour/lib").glob("*.so*")]
        return {name: {path for path in mapped if f"{path.name}.".startswith(f"{name}.")} for name in names}

    def _foreign(self, mapped):
        """Bundled libraries of which a file is mapped that neither Velour nor Blender without it has."""
        # Python's own module of that name may map the system's library.
        _said, of_blender = self._render("--factory-startup", "--python-expr", "import lzma")
        return {
            name
            for name, files in self._bundled(mapped).items()
            if any(not path.is_relative_to(self.home) for path in files - of_blender)
        }

    def test_renders_with_its_own_libraries(self):
        self._install()
        said, mapped = self._render()
        module = re.search(r"MODULE (\S+)", said)[1]
        self.assertEqual(module.startswith("bl_ext."), HAS_EXTENSIONS, module)
        self.assertGreater(float(re.search(r"BRIGHTEST (\S+)", said)[1]), 0.01)
        embree = re.search(r"EMBREE (\S+)", said)[1]
        self.assertTrue(embree.startswith(str(self.home)), embree)
        own = {path.name for path in mapped if path.is_relative_to(self.home)}
        print("libraries of its own:", *sorted(own))
        self.assertIn("libvelour.so", own)
        bundled = self._bundled(mapped)
        self.assertGreater(len(bundled), 6)
        self.assertEqual({name for name, files in bundled.items() if not files}, set())
        self.assertEqual(self._foreign(mapped), set())

    def test_a_foreign_copy_of_any_library_is_seen(self):
        self._install()
        copies = shutil.copytree(ZIPS / "blender/addons/velour/lib", self.folder / "foreign")
        paths = sorted(map(str, copies.glob("*.so*")))
        _said, mapped = self._render("--python-expr", _MAP.format(paths=paths))
        self.assertEqual(self._foreign(mapped), {Path(path).name for path in paths})

    def test_an_update_asks_for_a_restart(self):
        """By Blender's own updater: extensions are moved before they are deleted."""
        self._install()
        self.assertNotIn("restart Blender", self._run("pass"))
        again = _INSTALL_AGAIN.format(path=str(_newest_zip()), extension=HAS_EXTENSIONS)
        self.assertIn("restart Blender", self._run(again))
        said, _mapped = self._render()
        self.assertIn("BRIGHTEST", said)

    @unittest.skipUnless(HAS_EXTENSIONS, "this Blender has no extensions")
    def test_blender_builds_the_extension_itself(self):
        """`--command extension build` on the folder that scripts/package packs: the same files."""
        path = str(self.folder / "built.zip")
        source = str(ZIPS / "blender/addons/velour")
        self._blender("--command", "extension", "build", "--source-dir", source, "--output-filepath", path)
        self._blender("--command", "extension", "validate", path)
        with zipfile.ZipFile(path) as built, zipfile.ZipFile(_newest_zip()) as ours:
            names = {name for name in built.namelist() if not name.endswith("/")}
            self.assertEqual(names, {name.partition("/")[2] for name in ours.namelist()} - {""})
