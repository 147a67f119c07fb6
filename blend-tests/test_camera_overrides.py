"""Renders through a camera that is not the scene's: that of a Scene strip, or of a viewport."""

import bpy

from support import scenes
from support.blender import BlenderTest, printed
from support.motion import blur

SIZE = 32


class CameraOverrides(BlenderTest):
    """A plane far from the scene's own camera, and a camera above the plane."""

    def setUp(self):
        super().setUp()
        self.scene = scenes.use_engine(samples=8, size=SIZE)
        scenes.set_world((0.1, 0.1, 0.1))
        self.plane = scenes.add_plane(scenes.diffuse_material((0.5, 0.5, 0.5)))
        self.plane.location.x = -20
        self.other = scenes.add_camera()
        self.other.name, self.other.location.x = "Other", -20
        self.own = scenes.add_camera()
        self.edit = None

    def _strip(self):
        """Makes a scene whose sequencer shows this one through the other camera."""
        self.edit = bpy.data.scenes.new("Edit")
        render = self.edit.render
        render.engine, render.resolution_x, render.resolution_y = "VELOUR", SIZE, SIZE
        editor = self.edit.sequence_editor_create()
        strips = editor.strips if hasattr(editor, "strips") else editor.sequences
        strips.new_scene("Cut", self.scene, 1, self.scene.frame_current).scene_camera = self.other
        self.edit.frame_set(self.scene.frame_current)

    def _brightness(self, **options):
        """Mean of the middle of the picture: 0.1 is the world, 0.05 the plane."""
        render = (self.edit or self.scene).render
        render.image_settings.file_format, render.filepath = "OPEN_EXR", str(self.folder / "picture.exr")
        bpy.ops.render.render(scene=(self.edit or self.scene).name, write_still=True, **options)
        return float(scenes.middle(scenes.read(self.folder / "picture.exr")).mean())

    def test_strip(self):
        self.assert_close(self._brightness(), 0.1, 0.01)
        self._strip()
        self.assert_close(self._brightness(), 0.05, 0.01)

    def test_strip_with_motion_blur(self):
        blur(self.scene)
        self._strip()
        self.assert_close(self._brightness(), 0.05, 0.01)

    def test_strip_of_a_scene_without_a_camera(self):
        self.scene.camera = None
        self._strip()
        self.assert_close(self._brightness(), 0.05, 0.01)

    def test_a_camera_inside_an_object_is_the_one_that_renders(self):
        scenes.add_sphere(scenes.diffuse_material()).location = self.other.location
        self._strip()
        with printed() as said:
            self._brightness()
            self.assertIn("Camera 'Other': it is inside object 'Sphere'", said())

    def test_local_camera_of_a_viewport(self):
        windows = bpy.context.window_manager.windows
        areas = [(window, area) for window in windows for area in window.screen.areas]
        window, area = next((each for each in areas if each[1].type == "VIEW_3D"), (None, None))
        if area is None:
            self.skipTest("this Blender has no viewports")
        space = area.spaces.active
        space.use_local_camera, space.camera = True, self.other
        with bpy.context.temp_override(window=window, area=area, region=area.regions[-1]):
            self.assert_close(self._brightness(use_viewport=True), 0.05, 0.01)
