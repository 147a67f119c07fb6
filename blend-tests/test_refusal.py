"""Which changes of a scene end the refusal of real time."""

import bpy

from support import inputs, scenes
from support.blender import BlenderTest


class Refusal(BlenderTest):
    def setUp(self):
        super().setUp()
        scenes.use_engine()
        self.material = scenes.measured_material(inputs.model_bytes(inputs.lambert_measurement()))
        scenes.add_plane(self.material)
        self.settings = scenes.velour_node(self.material).velour

    def _is_over_after(self, name, value):
        """Whether a refusal of the scene as it is may be over after a change of the material's settings."""
        bpy.context.view_layer.update()
        depsgraph, asked = bpy.context.evaluated_depsgraph_get(), []
        refusal = inputs.module("engine.refusal").Refusal("too much", True, depsgraph)
        handlers = bpy.app.handlers.depsgraph_update_post

        def ask(_scene, depsgraph):
            asked.append(refusal.may_be_over(depsgraph))

        handlers.append(ask)
        try:
            setattr(self.settings, name, value)
            bpy.context.view_layer.update()
        finally:
            handlers.remove(ask)
        self.assertTrue(asked, "Blender reports no change")
        return any(asked)

    def test_render_from_measurement(self):
        for value in (True, False):
            self.assertTrue(self._is_over_after("use_reference", value), value)

    def test_scene_model(self):
        self.settings.scene_model = scenes.velour_node(self.material).image
        self.assertTrue(self._is_over_after("use_scene_model", True))

    def test_other_settings_end_none(self):
        self.assertFalse(self._is_over_after("neighbors", 2))
