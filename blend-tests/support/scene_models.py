"""Base of the tests of models that are fitted for a scene."""

import contextlib
import io

import bpy

from . import inputs, scenes
from .blender import BlenderTest


class SceneModelTest(BlenderTest):
    """Base of tests of scene models. The scene's only Velour material is called `material`."""

    material = "Paint"

    @property
    def node(self):
        return scenes.velour_node(bpy.data.materials[self.material])

    @property
    def settings(self):
        return self.node.velour

    def info(self, image):
        with inputs.native().Model.from_bytes(image.packed_file.data, image.name) as model:
            return model.info()

    def render(self, name="picture"):
        """The picture, and what was said."""
        said = io.StringIO()
        with contextlib.redirect_stdout(said):
            pixels = scenes.render(self.folder, name)
        return pixels, said.getvalue()

    def full_picture(self):
        self.settings.use_scene_model = False
        try:
            return self.render("full")[0]
        finally:
            self.settings.use_scene_model = True
