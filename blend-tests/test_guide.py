"""The user guide: its snippets run, and what it names is what Blender and Velour show."""

import importlib
import os
import shutil
import tempfile
import unittest
from pathlib import Path
from unittest import mock

import bpy

from support import guide, inputs, labels, level
from support.blender import BlenderTest
from support.snippets import ROOT, SnippetTest

MEASUREMENT = "cc_iris_purple_gem_rgb.bsdf"  # the guide's; any will do, formats are recognized by content
NEWER = {"Get Extensions", "Install from Disk..."}  # of 4.2 and newer; all others are 3.4's


class Snippets(SnippetTest):
    """Each page's, in order, in a folder of their own."""

    def _run_page(self, name, measurement=inputs.glossy_measurement):
        page = guide.FOLDER / name
        shutil.copy(measurement(), self.folder / MEASUREMENT)
        (self.folder / "scripts").symlink_to(ROOT / "scripts")
        found = guide.snippets(page)
        self.assertEqual({language for language, _ in found} - {"python", "sh", "text"}, set())
        python = [text for language, text in found if language == "python"]
        if python:
            self.run_python("\n".join(python))
        printed = ""
        for language, text in found:
            if language == "sh":
                printed = self.run_shell(text)
            elif language == "text":
                self.assertIn(text, printed)
        return found

    @unittest.skipUnless(level.LONG, level.REASON)
    def test_first_material(self):
        self.assertEqual([language for language, _ in self._run_page("first_material.md")], ["python", "sh"])
        self.assertTrue((self.folder / "iris.velour").is_file())
        self.assertTrue((self.folder / "monkey_0001.png").is_file())

    def test_preset(self):
        if not importlib.import_module("velour.core.presets").listed():
            self.skipTest("scripts/presets has not been run")
        self._run_page("preset.md")
        self.assertTrue((self.folder / "look.png").is_file())

    def test_library(self):
        with tempfile.TemporaryDirectory() as cache, mock.patch.dict(os.environ, XDG_CACHE_HOME=cache):
            self._run_page("library.md")
            pictures = list(Path(cache).glob("velour/thumbnails-*/*.npz"))
        self.assertEqual(len(pictures), 1)

    def test_tolerance(self):
        # Not the default measurement, which a few lobes fit within any tolerance.
        self._run_page("tolerance.md", inputs.plastic_measurement)
        sizes = [(self.folder / f"iris_{tolerance}.velour").stat().st_size for tolerance in (0.1, 0.02)]
        self.assertLess(*sizes)
        self.assertTrue((self.folder / "iris_0.05.csv").is_file())

    def test_scene_model(self):
        self._run_page("scene_model.md")
        reduced, full = (
            inputs.native().Model.load(self.folder / f"iris{kind}.velour") for kind in (".scene", "")
        )
        self.assertLess(reduced.info()["parameter_bytes"], full.info()["parameter_bytes"])

    @unittest.skipUnless(level.LONG, level.REASON)
    def test_cloth(self):
        self._run_page("cloth.md")
        self.assertGreater((self.folder / "weave.velour").stat().st_size, 10_000)

    def test_batch(self):
        self._save_shot()
        self.assertEqual(len(self._run_page("batch.md")), 5)
        self.assertTrue((self.folder / "out_0001.exr").is_file())
        self.assertEqual(len(list(self.folder.glob("shot_*.png"))), 2)
        self.assertEqual(len(list((self.folder / "frames").glob("shot_*.exr"))), 2)

    def _save_shot(self):
        model = inputs.model_bytes(inputs.glossy_measurement())
        (self.folder / "paint.velour").write_bytes(model)
        bpy.ops.mesh.primitive_uv_sphere_add()
        bpy.ops.velour.load_material(filepath=str(self.folder / "paint.velour"))
        bpy.ops.object.light_add(location=(0, 0, 3))
        bpy.ops.object.camera_add(location=(0, 0, 5))
        scene = bpy.context.scene
        scene.camera = bpy.context.object
        scene.render.engine, scene.velour.samples, scene.render.resolution_percentage = "VELOUR", 4, 3
        scene.render.filepath = "//shot_####"
        bpy.ops.wm.save_as_mainfile(filepath=str(self.folder / "shot.blend"))

    def test_no_page_is_left_out(self):
        run = {"preset.md", "first_material.md", "library.md", "tolerance.md", "scene_model.md", "cloth.md"}
        run |= {"batch.md"}
        self.assertEqual({page.name for page in guide.PAGES if guide.snippets(page)}, run)

    def test_a_wrong_snippet_is_seen(self):
        with self.assertRaises(AssertionError):
            self.run_python("import bpy\nbpy.ops.velour.fit_all()")
        with self.assertRaises(AssertionError):
            self.run_shell("scripts/farm missing.blend --no-submit\ntrue")


class Labels(BlenderTest):
    def test_ours(self):
        known = labels.ours()
        named = {label for page in guide.PAGES for label in guide.our_labels(page)}
        self.assertGreater(len(named), 25)
        self.assertEqual(named - known, set())
        self.assertEqual({"Capture BTFs", "Shrinkwrap"} & known, set())  # nobody's, and Blender's

    def test_blenders(self):
        known = labels.blenders()
        named = {label for page in guide.PAGES for label in guide.blenders_labels(page)}
        self.assertGreater(len(named), 15)
        self.assertLessEqual(NEWER, named)
        self.assertEqual((named & NEWER if bpy.app.version >= (4, 2) else named - NEWER) - known, set())
        self.assertEqual({"Capture BTF"} & known, set())

    def test_menus(self):
        paths = [path for page in guide.PAGES for path in guide.menu_paths(page)]
        self.assertGreaterEqual({path for path, _ in paths}, {"File > Import", "Add > Mesh"})
        for path, entry in paths:
            self.assertIn(entry, labels.our_entries(path), path)
        self.assertNotIn("Mesostructure", labels.our_entries("File > Import"))

    def test_messages(self):
        source = labels.our_texts()
        quoted = {message for page in guide.PAGES for message in guide.messages(page)}
        self.assertGreater(len(quoted), 3)
        for message in quoted:
            self.assertTrue(any(message in text for text in source), message)
        self.assertFalse(any("nothing shines on it" in text for text in source))
