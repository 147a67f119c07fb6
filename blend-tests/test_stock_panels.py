"""Blender's own panels with Velour as the engine, as Blender asks them: those of what is read, no others."""

import unittest

import bpy

from support import panels, scenes
from support.blender import BlenderTest

# What Velour does not read, in any Blender that has it.
_NOT_READ = {
    "render": (
        "freestyle",
        "motion_blur",
        "gpencil",
        "grease_pencil",
        "eevee",
        "CYCLES",
        "RENDER_PT_simplify",
    ),
    "output": ("stereoscopy", "output_views"),
    "view_layer": ("freestyle", "VIEWLAYER_PT_layer_passes", "VIEWLAYER_PT_filter", "eevee", "CYCLES"),
    "world": ("volume", "CYCLES", "settings"),
    "object": ("OBJECT_PT_shading", "linking", "motion_blur", "shadow_terminator"),
    "light": ("falloff", "EEVEE", "CYCLES", "nodes", "DATA_PT_area", "DATA_PT_spot"),
    "camera": ("stereoscopy", "CYCLES"),
    "mesh": ("CYCLES",),
    "material": ("volume", "displacement", "freestyle", "EEVEE_MATERIAL_PT_settings", "CYCLES"),
}


class StockPanels(BlenderTest):
    def setUp(self):
        super().setUp()
        scenes.use_engine()
        scenes.set_world()
        self.camera = scenes.add_camera()
        self.cube = scenes.add_plane(scenes.diffuse_material())
        self.lamp = bpy.data.objects.new("Lamp", bpy.data.lights.new("Lamp", "AREA"))

    def _context(self, tab, engine="VELOUR"):
        obj = {"light": self.lamp, "camera": self.camera}.get(tab, self.cube)
        members = dict.fromkeys(("light", "camera", "mesh", "world", "material", "material_slot"))
        if tab in ("light", "camera", "mesh"):
            members[tab] = obj.data
        elif tab == "world":
            members["world"] = bpy.context.scene.world
        elif tab == "material":
            members.update(material=obj.active_material, material_slot=obj.material_slots[0])
        bpy.context.scene.render.engine = engine
        return panels.Context(engine=engine, object=obj, active_object=obj, **members)

    def _shown(self, tab, engine="VELOUR"):
        return panels.shown(tab, self._context(tab, engine))

    def test_those_of_what_is_read_are_there_and_no_others(self):
        for tab in panels.STOCK:
            with self.subTest(tab=tab):
                self.assertEqual(panels.wrong(tab, self._shown(tab)), ([], []))

    def test_those_of_what_is_not_read_are_absent(self):
        for tab, words in _NOT_READ.items():
            with self.subTest(tab=tab):
                stock = {name for name in self._shown(tab) if not name.startswith("VELOUR_")}
                self.assertEqual([n for n in stock if any(word in n for word in words)], [])
                self.assertNotIn("DATA_PT_light", stock)  # Velour's own has all of it

    def test_with_cycles_they_are_there(self):
        """The words above are those of panels that exist."""
        bpy.ops.preferences.addon_enable(module="cycles")
        for tab, word in (
            ("render", "CYCLES"),
            ("output", "stereoscopy"),
            ("view_layer", "CYCLES"),
            ("world", "volume"),
            ("object", "motion_blur"),
            ("light", "CYCLES"),
            ("camera", "CYCLES"),
            ("material", "displacement"),
        ):
            with self.subTest(tab=tab):
                names = self._shown(tab, "CYCLES")
                self.assertTrue(any(word in name for name in names), sorted(names))
                self.assertFalse(any(name.startswith("VELOUR_") for name in names), sorted(names))

    def test_what_is_read_stands_in_them(self):
        """A panel that is there may still lack what it is there for."""
        for name, tab, settings in (
            ("RENDER_PT_format", "output", {"resolution_x", "resolution_percentage", "use_border"}),
            ("DATA_PT_lens", "camera", {"type", "lens", "shift_x", "clip_start"}),
            ("DATA_PT_camera_dof", "camera", {"focus_object", "focus_distance"}),
            ("DATA_PT_camera_dof_aperture", "camera", {"aperture_fstop", "aperture_blades"}),
            ("OBJECT_PT_visibility", "object", {"hide_render", "is_holdout"}),
        ):
            layout = panels.Layout(getattr(bpy.types, name))
            getattr(bpy.types, name).draw(layout, self._context(tab))
            self.assertLessEqual(settings, set(layout.props), name)


if __name__ == "__main__":
    unittest.main()
