"""Materials made from BTFs."""

import bpy

from support import scenes
from support.blender import BlenderTest

_SMALL = {"texels": 16, "views": 24, "lights": 24, "samples": 16, "bounces": 0, "sides": "ONE"}


class CompressBtf(BlenderTest):
    def _captured(self):
        """The folder of a captured tile, which is the active object."""
        bpy.ops.velour.add_mesostructure(type="CORDUROY", count=2, resolution=8)
        folder = self.folder / "ribs.btf"
        bpy.ops.velour.capture_btf(directory=str(folder), **_SMALL)
        return folder

    def test_what_was_captured_of_a_tile_becomes_a_packed_model(self):
        self._captured()
        before = {material.name for material in bpy.context.object.data.materials}
        self.assertEqual(bpy.ops.velour.compress_btf(), {"FINISHED"})
        image = scenes.velour_node(bpy.data.materials["ribs"]).image
        self.assertIsNotNone(image.packed_file)
        self.assertEqual(bytes(image.packed_file.data[:4]), b"v/1\x01")
        self.assertTrue(bpy.data.materials["ribs"].use_fake_user)
        self.assertEqual({material.name for material in bpy.context.object.data.materials}, before)

    def test_bytes_are_bounded(self):
        self._captured()
        bpy.ops.velour.compress_btf(megabytes=0.02)
        small = scenes.velour_node(bpy.data.materials["ribs"]).image.packed_file.size
        bpy.ops.velour.compress_btf(megabytes=0.1)
        self.assertGreater(
            scenes.velour_node(bpy.data.materials["ribs.001"]).image.packed_file.size, small + 40000
        )

    def test_the_material_renders_on_another_object_under_its_texture_coordinates(self):
        folder = self._captured()
        bpy.data.objects.remove(bpy.context.object)
        scenes.use_engine(size=64)
        scenes.add_plane(size=4)
        bpy.ops.velour.compress_btf(filepath=str(folder), assign=True, megabytes=0.1)
        self.assertEqual(bpy.context.object.active_material.name, "ribs")
        scenes.set_world()
        scenes.add_camera(ortho_scale=4)
        picture = scenes.render(self.folder)[:, :, :3]
        self.assertGreater(picture.min(), 0.01)
        # One tile covers the plane: its ribs run one way, so only across them is it uneven.
        spread = [picture.mean(axis=axis).std(axis=0).max() for axis in (0, 1)]
        self.assertGreater(max(spread), 5 * min(spread))

    def test_what_is_not_a_btf_is_refused_with_its_name(self):
        with self.assertRaisesRegex(RuntimeError, "nowhere.btf"):
            bpy.ops.velour.compress_btf(filepath=str(self.folder / "nowhere.btf"))
        with self.assertRaisesRegex(RuntimeError, "save the .blend first"):
            bpy.ops.mesh.primitive_plane_add()
            bpy.ops.velour.compress_btf()
        self.assertNotIn("nowhere", bpy.data.materials)

    def test_importing_a_btf_as_a_material_says_what_does_it(self):
        with self.assertRaisesRegex(RuntimeError, "compress_btf"):
            bpy.ops.velour.load_material(filepath=str(self._captured()))
