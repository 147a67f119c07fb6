"""The preset library: what its .blend says in the asset browser, and the click that adds it."""

import importlib
import shutil
import sys
import unittest
import unittest.mock
from collections import Counter
from pathlib import Path

import bpy
import numpy as np

from support import inputs, level
from support.blender import BlenderTest, run_blender

CATALOG = "6f3f5b36-31cf-4d4e-9a8b-6a1c0f5ad101"
_ASSET = """
import bpy
material = bpy.data.materials["Paint"]
asset = material.asset_data
assert asset.catalog_id == {catalog!r}, asset.catalog_id
assert asset.author == "The Velour authors", asset.author
assert "CC0-1.0" in asset.description and asset.description.startswith("Glossy"), asset.description
assert getattr(asset, "license", "CC0-1.0") == "CC0-1.0", asset.license
assert sorted(tag.name for tag in asset.tags) == ["gloss", "velour"]
assert tuple(material.preview.image_size) == (256, 256)
pixels = material.preview.image_pixels_float
assert abs(pixels[0] - 0.25) < 0.01 and abs(pixels[1] - 0.5) < 0.01, pixels[:4]
group = next(n for n in material.node_tree.nodes if n.bl_idname == "ShaderNodeGroup")
node = next(n for n in group.node_tree.nodes if n.bl_idname == "ShaderNodeTexImage" and n.velour.enabled)
assert node.image.packed_file and node.image.packed_file.size > 1000
assert not [image.name for image in bpy.data.images if image.source == "FILE" and not image.packed_file]
print("ASSET READ")
"""


def _script(name):
    scripts = str(Path(__file__).resolve().parents[1] / "scripts/lib")
    with unittest.mock.patch.object(sys, "path", [scripts, *sys.path]):
        return importlib.import_module(name)


class Presets(BlenderTest):
    def setUp(self):
        super().setUp()
        self._known = {library.path for library in self._libraries}

    def tearDown(self):
        for number, library in reversed([*enumerate(self._libraries)]):
            if library.path not in self._known:
                bpy.ops.preferences.asset_library_remove(index=number)
        super().tearDown()

    @property
    def _libraries(self):
        return bpy.context.preferences.filepaths.asset_libraries

    def _built(self, folder):
        folder.mkdir(parents=True, exist_ok=True)
        model, preview = self.folder / "a.velour", self.folder / "a.npy"
        model.write_bytes(inputs.model_bytes(inputs.glossy_measurement()))
        np.save(preview, np.broadcast_to(np.float32([0.25, 0.5, 0.75, 1]), (256, 256, 4)))
        preset = {
            "name": "Paint",
            "model": str(model),
            "preview": str(preview),
            "catalog": CATALOG,
            "description": "Glossy",
            "tags": ["gloss", "velour"],
            "repeats": 0,
        }
        path = folder / "velour_presets.blend"
        _script("presets_blend").write({"path": str(path), "presets": [preset]})
        return path

    def test_assets_say_what_they_are_and_hold_their_models(self):
        path = self._built(self.folder / "library")
        (self.folder / "a.velour").unlink()
        done = run_blender(path, "--python-exit-code", 1, "--python-expr", _ASSET.format(catalog=CATALOG))
        self.assertIn("ASSET READ", done.stdout, done.stdout)

    def test_a_click_adds_the_library_once(self):
        path = self._built(self.folder / "library")
        for _ in range(2):
            result = bpy.ops.velour.add_presets(directory=str(path.parent))
            self.assertEqual(result, {"FINISHED"})
            added = [library for library in self._libraries if library.path not in self._known]
            self.assertEqual([library.name for library in added], ["Velour Presets"])
        self.assertEqual(Path(added[0].path).resolve(), path.parent.resolve())
        if hasattr(added[0], "import_method"):
            self.assertTrue(added[0].import_method.startswith("APPEND"))

    def test_the_add_ons_own_folder_is_the_default(self):
        presets = importlib.import_module("velour.core.presets")
        with unittest.mock.patch.object(
            presets, "folder", return_value=self._built(self.folder / "own").parent
        ):
            bpy.ops.velour.add_presets()
        self.assertEqual(len(self._libraries), len(self._known) + 1)

    def test_without_presets_nothing_is_added_and_it_says_what_to_run(self):
        self._built(self.folder / "library")
        shutil.rmtree(self.folder / "library")
        with self.assertRaisesRegex(RuntimeError, "scripts/presets"):
            bpy.ops.velour.add_presets(directory=str(self.folder / "library"))
        self.assertEqual(len(self._libraries), len(self._known))


@unittest.skipUnless(level.LONG, level.REASON)
class WholeLibrary(BlenderTest):
    """All 24 of the table, by the script that writes the library; models of the tests stand in for theirs."""

    def test_has_all_materials_with_what_the_asset_browser_shows(self):
        table, presets = _script("preset_table"), _script("presets")
        preview = self.folder / "preview.npy"
        np.save(preview, np.random.default_rng(1).random((256, 256, 4), np.float32))  # packs badly
        presets.write_library(self.folder, _StandIns(self.folder), dict.fromkeys(table.PRESETS, preview))
        with bpy.data.libraries.load(str(self.folder / "velour_presets.blend"), assets_only=True) as (
            there,
            got,
        ):
            got.materials = there.materials
        found = Counter()
        for preset, material in zip(
            sorted(table.PRESETS, key=lambda preset: preset.name),
            sorted(got.materials, key=lambda material: material.name),
            strict=True,
        ):
            asset = material.asset_data
            self.assertEqual(material.name, preset.name)
            self.assertEqual(asset.catalog_id, table.CATALOGS[preset.catalog])
            self.assertEqual(asset.author, "The Velour authors")
            self.assertIn("CC0-1.0", asset.description)
            self.assertEqual({tag.name for tag in asset.tags}, {*preset.tags, "velour"})
            self.assertEqual(tuple(material.preview.image_size), (256, 256))
            found[preset.catalog] += 1
        self.assertEqual(sorted(found.values()), [4, 6, 6, 8])
        size = sum(path.stat().st_size for path in self.folder.glob("*") if path != preview)
        self.assertLess(size, presets.MOST_BYTES / 2)  # models of cloths, 0.4 to 1.3 MB each, take the rest
        catalogs = (self.folder / "blender_assets.cats.txt").read_text()
        self.assertTrue(all(number in catalogs for number in table.CATALOGS.values()))
        self.assertIn("CC0-1.0", (self.folder / "LICENSE.txt").read_text())


class _StandIns:
    """In the place of a Workshop."""

    def __init__(self, folder):
        self.work = folder

    @staticmethod
    def model_path(preset):
        data = Path(__file__).parent / "scenes/data"
        if preset.catalog == "Cloths":
            return data / "weave.velour"
        is_brushed = getattr(preset.made_of, "anisotropy", 1.0) != 1.0
        return data / ("brushed.velour" if is_brushed else "paint.velour")
