"""The preset library: what its .blend says in the asset browser, and the click that adds it."""

import importlib
import shutil
import unittest
import unittest.mock
from pathlib import Path

import bpy
import numpy as np

from support import inputs, scenes
from support.blender import BlenderTest, run_blender

CATALOG = "6f3f5b36-31cf-4d4e-9a8b-6a1c0f5ad101"
GROUP_CATALOG = "5d0e7c1a-8f42-4b0b-a1d3-6f2b9c4e7d01"
_ASSET = """
import bpy
material = bpy.data.materials["Paint"]
group = next(n for n in material.node_tree.nodes if n.bl_idname == "ShaderNodeGroup")
for datablock, catalog in ((material, {catalog!r}), (group.node_tree, {group_catalog!r})):
    asset = datablock.asset_data
    assert asset.catalog_id == catalog, asset.catalog_id
    assert asset.author == "The Velour authors", asset.author
    assert "CC0-1.0" in asset.description and asset.description.startswith("Glossy"), asset.description
    assert getattr(asset, "license", "CC0-1.0") == "CC0-1.0", asset.license
    assert sorted(tag.name for tag in asset.tags) == ["gloss", "velour"]
    assert tuple(datablock.preview.image_size) == (128, 128)
    pixels = datablock.preview.image_pixels_float
    assert abs(pixels[0] - 0.248) < 0.01 and abs(pixels[1] - 0.485) < 0.01, pixels[:4]
node = next(n for n in group.node_tree.nodes if n.bl_idname == "ShaderNodeTexImage" and n.velour.enabled)
assert '"masking": "correlated"' in group.node_tree.velour.fitted, "fitted for Blender 3.4"
assert node.image.packed_file and node.image.packed_file.size > 1000
assert not [image.name for image in bpy.data.images if image.source == "FILE" and not image.packed_file]
print("ASSET READ")
"""


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
        """The asset library of one preset, in `folder` with the preset's files."""
        presets = importlib.import_module("velour.core.presets")
        native = importlib.import_module("velour.native")
        folder.mkdir(parents=True, exist_ok=True)
        preset = presets.Preset(
            "Paint", folder / "paint.velour", folder / "paint.png", "Paints", "Glossy", ("gloss",), 0
        )
        preset.model.write_bytes(inputs.model_bytes(inputs.glossy_measurement()))
        native.images.write(
            preset.picture, np.broadcast_to(np.float32([0.05, 0.2, 0.5]), (256, 256, 3)).copy()
        )
        (folder / presets.INDEX_FILE).write_text(presets.index_text([preset]))
        path = folder / presets.LIBRARY_FILE
        catalogs = {"catalogs": {"Paints": CATALOG}, "group_catalogs": {"Paints": GROUP_CATALOG}}
        inputs.script("bench.inside.presets").write({"path": str(path), "folder": str(folder)} | catalogs)
        return path

    def test_assets_say_what_they_are_and_hold_their_models(self):
        path = self._built(self.folder / "library")
        (path.parent / "paint.velour").unlink()
        done = run_blender(
            path,
            "--python-exit-code",
            1,
            "--python-expr",
            _ASSET.format(catalog=CATALOG, group_catalog=GROUP_CATALOG),
        )
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


class OnePreset(BlenderTest):
    """velour.add_preset and velour.new_look with the presets of the add-on."""

    def setUp(self):
        super().setUp()
        if not importlib.import_module("velour.core.presets").listed():
            self.skipTest("scripts/presets has not been run")

    def test_a_preset_goes_into_the_active_slot(self):
        bpy.ops.mesh.primitive_cube_add()
        bpy.ops.velour.add_preset(preset="Polished Gold")
        material = bpy.context.object.active_material
        self.assertEqual(material.name, "Polished Gold")
        self.assertTrue(scenes.velour_node(material).image.packed_file)

    def test_a_former_name_is_known(self):
        bpy.ops.velour.add_preset(preset="Brushed Aluminium", assign=False)
        self.assertIn("Brushed Aluminum", bpy.data.materials)

    def test_cloths_repeat(self):
        bpy.ops.velour.add_preset(preset="Denim", assign=False)
        material = bpy.data.materials["Denim"]
        self.assertTrue(material.use_fake_user)
        self.assertGreater(scenes.velour_node(material).velour.placement.repeats[0], 1)

    def test_an_unknown_preset_is_refused_with_the_names(self):
        with self.assertRaisesRegex(RuntimeError, "Mithril.*Polished Gold"):
            bpy.ops.velour.add_preset(preset="Mithril")

    def test_the_look_scene_renders_its_ball(self):
        before = set(bpy.data.scenes)
        bpy.ops.velour.new_look(preset="Red Enamel")
        (scene,) = set(bpy.data.scenes) - before
        scene.render.resolution_x = scene.render.resolution_y = 48
        scene.velour.samples = 32
        scene.render.image_settings.file_format = "OPEN_EXR"
        scene.render.filepath = str(self.folder / "look.exr")
        bpy.ops.render.render(scene=scene.name, write_still=True)
        images = importlib.import_module("velour.native").images
        pixels = images.read_picture(self.folder / "look.exr")
        ball, corner = pixels[20:26, 20:26, :3].mean(axis=(0, 1)), pixels[:4, :4, :3].mean(axis=(0, 1))
        self.assertGreater(ball[0], 4 * ball[2])  # red
        self.assertLess(np.ptp(corner), 0.3 * corner.mean())  # the gray ground
        self.assertEqual(tuple(scene.objects["Turntable"].animation_data.action.frame_range), (1, 121))
