"""What the Properties editor and the Add menu of shaders offer with Velour: what is rendered, and once."""

import unittest
from collections import Counter
from types import SimpleNamespace
from unittest import mock

import addon_utils
import bpy
from velour.operators import measured
from velour.operators.background_job import TABS
from velour.ui import material_panel, model_panel, summaries
from velour.ui.advanced_panel import VELOUR_MATERIAL_PT_advanced
from velour.ui.material_panel import VELOUR_MATERIAL_PT_measured
from velour.ui.viewport_panel import VELOUR_VIEW3D_PT_lighting

from support import inputs, scenes
from support.blender import ADDON, BlenderTest, enable_addon
from support.panels import Layout

_LAMPS = {
    "POINT": {"shadow_soft_size"},
    "SUN": {"angle"},
    "SPOT": {"shadow_soft_size", "spot_size", "spot_blend"},
    "AREA": {"shape", "size", "size_y", "spread", "is_portal"},
}
_EVERY_LAMP = {"type", "color", "energy"}
_NEWER = {"use_temperature", "temperature", "exposure", "normalize", "use_soft_falloff"}
_OF_NO_LAMP = ("context", "preview", "animation", "custom_props")
_NOT_READ = ("freestyle", "stereoscopy", "DATA_PT_falloff_curve", "OBJECT_PT_shading", "EEVEE_light")
_MENUS = ("NODE_MT_category_SH_NEW_SHADER", "NODE_MT_category_shader_shader")  # of 3.4, of 4.0 and newer
_SHADERS = {"MixShader", "AddShader", "Emission"}
_SHADERS |= {f"Bsdf{name}" for name in ("Principled", "Diffuse", "Glossy", "Transparent")}


class Panels(BlenderTest):
    def setUp(self):
        super().setUp()
        self.scene = scenes.use_engine()

    def test_lamps(self):
        for kind, shape in _LAMPS.items():
            lamp = bpy.data.lights.new(kind, kind)
            if kind == "AREA":
                lamp.shape = "ELLIPSE"
            shown = self._shown("data", light=lamp)
            shadow = "cast_shadow" if hasattr(lamp.cycles, "cast_shadow") else "use_shadow"
            wanted = _EVERY_LAMP | shape | {shadow} | {name for name in _NEWER if hasattr(lamp, name)}
            self.assertEqual({name: shown[name] for name in wanted}, dict.fromkeys(wanted, 1), kind)
            self.assertFalse({name for name in shown if name.endswith("_factor")}, kind)

    def test_world(self):
        world = bpy.data.worlds.new("World")
        self.assertEqual(self._shown("world", world=world)["camera"], 1)

    def test_material(self):
        material = bpy.data.materials.new("Plain")
        shown = self._shown("material", material=material)
        self.assertEqual(shown["emission_sampling"] + shown["sample_as_light"], 1)
        has_correction = hasattr(material.cycles, "use_bump_map_correction")
        self.assertEqual(shown["use_bump_map_correction"], int(has_correction))

    def test_threads(self):
        shown = self._shown("render")
        for name in ("threads_mode", "threads", "preview_pixel_size", "film_transparent", "film_exposure"):
            self.assertEqual(shown[name], 1, name)

    def test_simplify(self):
        shown = self._shown("render")
        for name in ("subdivision", "subdivision_render", "child_particles", "child_particles_render"):
            self.assertEqual(shown[f"simplify_{name}"], 1, name)

    def test_lighting_of_a_rendered_viewport(self):
        """As with Cycles, of whose settings World Opacity is not read."""
        panel, switches = VELOUR_VIEW3D_PT_lighting, ["use_scene_lights_render", "use_scene_world_render"]
        shading = SimpleNamespace(type="RENDERED", use_scene_world_render=True)
        context = SimpleNamespace(engine="VELOUR", space_data=SimpleNamespace(shading=shading))
        self.assertEqual(self._drawn(panel, context), switches)
        shading.use_scene_world_render = False
        shown = self._drawn(panel, context)
        self.assertEqual(shown, [*switches, "studiolight_rotate_z", "studiolight_intensity"])
        self.assertLessEqual(set(shown), set(bpy.types.View3DShading.bl_rna.properties.keys()))
        self.assertTrue(panel.is_registered and hasattr(bpy.types, panel.bl_parent_id))
        context.engine = "CYCLES"
        self.assertEqual(self._drawn(panel, context), [])
        context.engine, shading.type = "VELOUR", "MATERIAL"
        self.assertEqual(self._drawn(panel, context), [])

    def test_no_panel_of_blender_stands_above_sampling(self):
        """Among panels without an order, Blender's own come first, because they were registered earlier."""
        for panel in self._panels_of("render"):
            is_below = getattr(panel, "bl_order", 0) > 0 or getattr(panel, "bl_parent_id", "")
            is_title = "HIDE_HEADER" in getattr(panel, "bl_options", ())  # the choice of the engine
            ours = panel.__module__.startswith("velour.")
            self.assertTrue(ours or is_below or is_title, panel.__name__)

    def test_what_is_not_read_is_not_shown(self):
        names = [p.__name__ for p in bpy.types.Panel.__subclasses__() if self._is_ours(p)]
        self.assertEqual([n for n in names if any(word in n for word in _NOT_READ)], [])

    def test_a_running_job_is_shown(self):
        """With its cross, of BTFs as of BRDFs; and Esc cancels over no other tab than those that show it."""
        context, found = self._of_a_material(), set()
        context.object.velour.is_tile = context.collection.velour.is_tile = True
        tabs = {getattr(panel, "bl_context", "") for panel in bpy.types.Panel.__subclasses__()}
        for info in ({"texels": (8, 8), "source": {"name": "", "sha256": ""}}, {}):
            with mock.patch.object(material_panel, "model_summary", lambda _image, info=info: info):
                self.assertNotIn("velour.cancel_fit", self._offered(VELOUR_MATERIAL_PT_measured, context))
                context.window_manager.velour.running = True
                offered = self._offered(VELOUR_MATERIAL_PT_measured, context)
                found |= {tab for tab in tabs if self._shows_a_job(tab, context)}
                context.window_manager.velour.running = False
            self.assertEqual(offered.count("velour.cancel_fit"), 1, info)
            self.assertEqual("velour.fit" in offered, "texels" not in info)
        self.assertEqual({tab.upper() for tab in found}, set(TABS))

    def test_a_material_of_a_btf_is_fitted_as_one(self):
        """Before it has a model, too."""
        context = self._of_a_material()
        node = scenes.velour_node(context.material)
        for name, is_btf in (("cloth.btf", True), ("cloth/btf.json", True), ("paint.binary", False)):
            node.velour.measurement = measured.file_image(str(self.folder / name))
            offered = self._offered(VELOUR_MATERIAL_PT_measured, context)
            self.assertEqual("velour.compress_btf" in offered, is_btf, name)
            self.assertEqual("velour.estimate_fit" in offered, is_btf, name)
            self.assertEqual("velour.fit" in offered, not is_btf, name)

    def test_the_verdict_on_a_btf_offers_a_larger_model(self):
        context = self._of_a_material()
        node = scenes.velour_node(context.material)
        node.velour.measurement = measured.file_image(str(self.folder / "cloth.btf"))
        verdict = {"quality": "fair", "flip_mean": 0.07, "flip_95": 0.2, "reason": "everywhere", "value": 0}
        info = {"model": "srbf-btf", "texels": (8, 8), "parameter_bytes": 1e5, "raw_bytes": 1e8}
        info |= {"source": {"name": "cloth", "sha256": ""}, "verdict": verdict, "warning_codes": []}
        with mock.patch.object(material_panel, "model_summary", return_value=info):
            offered = self._offered(VELOUR_MATERIAL_PT_measured, context)
            told = "".join(self._layout(VELOUR_MATERIAL_PT_measured, context).labels)
        self.assertEqual(offered.count("velour.compress_btf"), 2)
        self.assertIn("Fair: differs at all views; larger model?", told)

    def test_a_model_that_is_missing_is_told_where_the_tab_begins(self):
        context = self._of_a_material()
        node = scenes.velour_node(context.material)
        for path, is_told in ((self.folder / "gone.velour", True), (self.folder / "here.velour", False)):
            (self.folder / "here.velour").write_bytes(inputs.model_bytes(inputs.lambert_measurement()))
            node.image = measured.linked_model(str(path), "")
            self._read_and_offered(context)
            told = "".join(self._layout(VELOUR_MATERIAL_PT_measured, context).labels)
            self.assertEqual("Find Missing Files" in told, is_told, told)

    def test_a_changed_measurement_can_be_accepted(self):
        context = self._of_a_material()
        path = self.folder / "paint.binary"
        path.write_bytes(inputs.lambert_measurement().read_bytes())
        with bpy.context.temp_override(material=context.material):
            bpy.ops.velour.open_measurement(filepath=str(path))
        self.assertNotIn("velour.accept_file", self._read_and_offered(context))
        path.write_bytes(inputs.glossy_measurement().read_bytes())
        self.assertIn("velour.accept_file", self._read_and_offered(context))
        with bpy.context.temp_override(material=context.material):
            bpy.ops.velour.accept_file()
        self.assertNotIn("velour.accept_file", self._read_and_offered(context))
        path.unlink()  # to accept it would not help
        scenes.velour_node(context.material).velour.use_reference = True
        self.assertNotIn("velour.accept_file", self._read_and_offered(context))

    def test_a_model_that_is_missing_cannot_be_accepted(self):
        context = self._of_a_material()
        node = scenes.velour_node(context.material)
        node.image = measured.linked_model(str(self.folder / "gone.velour"), "old")
        panel = model_panel.VELOUR_MATERIAL_PT_model
        self.assertEqual(self._read_and_offered(context, panel), [])
        (self.folder / "gone.velour").write_bytes(inputs.model_bytes(inputs.lambert_measurement()))
        self.assertEqual(self._read_and_offered(context, panel), ["velour.accept_file"])

    def test_numbers_of_a_model(self):
        info = {"source": {"name": "paint"}, "model": "scattered", "lobes": 7, "views": 9, "bytes": 1000}
        info |= {"relative_l2": 0.125, "albedo_max": 0.75, "reciprocity": 0.0625, "by_view_angle": {}}
        layout = Layout()
        model_panel._draw_numbers(layout, info)
        rows = dict(zip(layout.labels[::2], layout.labels[1::2], strict=False))
        shown = {name: rows[name] for name in ("Source", "Relative error", "Max albedo", "Reciprocity error")}
        self.assertEqual(list(shown.values()), ["paint", "0.125", "0.75", "0.0625"])

    def test_order_of_a_fitted_material(self):
        """Name, look, verdict, measurement, fit; settings of the fit are under Advanced."""
        context = self._of_a_material()
        node = scenes.velour_node(context.material)
        node.velour.measurement = measured.file_image(str(inputs.lambert_measurement()))
        self._read_and_offered(context)
        layout = self._layout(VELOUR_MATERIAL_PT_measured, context)
        (verdict,) = (text for text in layout.labels if text.startswith(("Good: ", "Fair: ", "Poor: ")))
        wanted = ["node_tree", "Tint", "Exposure", "Roughness Offset", verdict, "measurement", "velour.fit"]
        self.assertEqual([each for each in layout.order if each in wanted], wanted)
        settings = {"model", "tolerance", "max_lobes", "use_limit_albedo", "use_symmetric", "use_all_data"}
        self.assertFalse(settings & set(layout.props))
        self.assertLessEqual(settings, set(self._layout(VELOUR_MATERIAL_PT_advanced, context).props))

    def test_what_is_closed(self):
        ours = [panel for panel in self._panels_of("material") if panel.__module__.startswith("velour.ui.")]
        inside = {p.bl_label for p in ours if getattr(p, "bl_parent_id", "") == "VELOUR_MATERIAL_PT_advanced"}
        self.assertEqual(inside, {"Scene Model", "Model", "Plots", "Approximation"})
        open_ones = {p.bl_label for p in ours if "DEFAULT_CLOSED" not in getattr(p, "bl_options", ())}
        wanted = {"Measured Material", "Placement", "Unsupported Features", "Surface"}
        self.assertEqual(open_ones, wanted)

    def test_the_verdict_and_what_it_advises(self):
        context = self._of_a_material()
        node = scenes.velour_node(context.material)
        node.velour.measurement = measured.file_image(str(inputs.lambert_measurement()))
        order = {"lobes": [8], "worst": [2.0], "chosen": 0}
        info = {"model": "parametric", "tolerance": 0.02, "order": order, "warning_codes": []}
        info["source"] = {"name": "paint", "sha256": "a"}
        for verdict, said, more in (
            ({"quality": "good", "reason": None, "value": 0}, "Good: looks like the measurement", None),
            (
                {"quality": "fair", "reason": "grazing_views", "value": 60},
                "Fair: differs at grazing views; more lobes?",
                16,
            ),
        ):
            found = info | {"verdict": verdict}
            with mock.patch.object(material_panel, "model_summary", lambda _image, found=found: found):
                layout = self._layout(VELOUR_MATERIAL_PT_measured, context)
            self.assertIn(said, layout.labels)
            fits = [operator for operator in layout.operators if operator.name == "velour.fit"]
            lobes = [fit.max_lobes for fit in fits if hasattr(fit, "max_lobes")]
            self.assertEqual(lobes, [more] if more else [])

    def test_a_canceled_fit_says_so(self):
        context = self._of_a_material()
        state = context.window_manager.velour
        state.canceled, state.canceled_subject = "The fit was canceled.", context.material.name
        self.assertIn(state.canceled, self._layout(VELOUR_MATERIAL_PT_measured, context).labels)
        state.canceled_subject = "Another"
        self.assertNotIn(state.canceled, self._layout(VELOUR_MATERIAL_PT_measured, context).labels)
        state.canceled = ""

    def _read_and_offered(self, context, panel=VELOUR_MATERIAL_PT_measured):
        """What the panel offers once the files are read."""
        self._offered(panel, context)
        while not summaries.is_at_rest():
            summaries._turn()
        return self._offered(panel, context)

    def test_a_pinned_material(self):
        """Its tab shows no object: panels are there but for what fills an object's slot."""
        context = self._of_a_material()
        on_object = self._names_of_panels(context)
        context.object = None
        pinned = self._names_of_panels(context)
        self.assertEqual(on_object - pinned, {"VELOUR_MATERIAL_PT_browser"})
        self.assertIn("VELOUR_MATERIAL_PT_measured", pinned)
        self._offered(VELOUR_MATERIAL_PT_measured, context)
        context.material = bpy.data.materials.new("Plain")
        self.assertEqual(self._offered(VELOUR_MATERIAL_PT_measured, context), ["velour.add_material"])

    def _names_of_panels(self, context):
        ours = [panel for panel in self._panels_of("material") if panel.__module__.startswith("velour.ui.")]
        return {panel.__name__ for panel in ours if panel.poll(context)}

    def _of_a_material(self):
        """The context of a tab that shows a plane with a measured material."""
        scenes.add_plane().active_material = scenes.measured_material(
            inputs.model_bytes(inputs.lambert_measurement())
        )
        return SimpleNamespace(
            preferences=bpy.context.preferences,
            region=SimpleNamespace(width=400),
            engine="VELOUR",
            scene=self.scene,
            view_layer=bpy.context.view_layer,
            window_manager=bpy.context.window_manager,
            object=bpy.context.object,
            material=bpy.context.object.active_material,
            collection=bpy.data.collections.new("Tile"),
            world=bpy.data.worlds.new("World"),
            light=None,
        )

    def _shows_a_job(self, tab, context):
        ours = [panel for panel in self._panels_of(tab) if panel.__module__.startswith("velour.ui.")]
        return any(
            "velour.cancel_fit" in self._offered(panel, context)
            for panel in ours
            if not getattr(panel, "bl_parent_id", "") and panel.poll(context)
        )

    def _offered(self, panel, context):
        return [operator.name for operator in self._layout(panel, context).operators]

    @staticmethod
    def _layout(panel, context):
        """The drawn panel; sentences are labels, because they are wrapped in windows only."""

        def draw(_context, layout, text, icon="NONE"):
            layout.label(text=text)

        layout = Layout(panel)
        with mock.patch.object(material_panel, "draw_sentence", draw):
            panel.draw(layout, context)
        return layout

    def _shown(self, tab, **context):
        """How often each setting stands in a tab."""
        manager = bpy.context.window_manager
        nothing = {"object": None, "light": None, "world": None, "material": None}
        drawn = {"preferences": bpy.context.preferences, "region": SimpleNamespace(width=400)}
        context = SimpleNamespace(
            engine="VELOUR", scene=self.scene, window_manager=manager, **{**drawn, **nothing, **context}
        )
        return Counter(
            name
            for panel in self._panels_of(tab)
            if panel.__module__.startswith("velour.") or self._is_of_lamps(panel)
            for name in self._drawn(panel, context)
        )

    def _panels_of(self, tab):
        found = {p.__name__: p for p in bpy.types.Panel.__subclasses__() if self._is_ours(p)}
        parents = {name: getattr(panel, "bl_parent_id", "") for name, panel in found.items()}
        return [
            panel
            for name, panel in found.items()
            if getattr(panel, "bl_context", "") == tab and (not parents[name] or parents[name] in found)
        ]

    @staticmethod
    def _is_of_lamps(panel):
        is_stock = panel.__module__ == "bl_ui.properties_data_light"
        return is_stock and not any(word in panel.__name__ for word in _OF_NO_LAMP)

    @staticmethod
    def _is_ours(panel):
        return "VELOUR" in getattr(panel, "COMPAT_ENGINES", ())

    @staticmethod
    def _drawn(panel, context):
        if hasattr(panel, "poll") and not panel.poll(context):
            return []
        layout = Layout(panel)
        panel.draw(layout, context)
        return layout.props


class AddMenu(BlenderTest):
    def test_of_materials(self):
        self.assertLessEqual(_SHADERS, self._offered(bpy.data.materials.new("Plain")))

    def test_of_worlds(self):
        offered = self._offered(bpy.data.worlds.new("World"))
        self.assertIn("Background", offered)
        self.assertNotIn("BsdfDiffuse", offered)

    def test_of_other_engines(self):
        """They are as they were, with the add-on and without."""
        material = bpy.data.materials.new("Plain")
        engines = ("CYCLES", "BLENDER_WORKBENCH")
        before = [self._offered(material, engine) for engine in engines]
        addon_utils.disable(ADDON)
        self.assertEqual([self._offered(material, engine) for engine in engines], before)
        without = self._offered(material)
        enable_addon()
        self.assertLessEqual(without, self._offered(material))

    @staticmethod
    def _offered(owner, engine="VELOUR"):
        kind = "WORLD" if isinstance(owner, bpy.types.World) else "OBJECT"
        space = SimpleNamespace(
            type="NODE_EDITOR",
            tree_type="ShaderNodeTree",
            shader_type=kind,
            id=owner,
            id_from=None if kind == "WORLD" else SimpleNamespace(type="MESH"),
        )
        menus = (getattr(bpy.types, name, None) for name in _MENUS)
        menu = next(menu for menu in menus if menu is not None)
        layout = Layout(menu)
        menu.draw(layout, SimpleNamespace(engine=engine, space_data=space))
        return {operator.type.removeprefix("ShaderNode") for operator in layout.operators}


if __name__ == "__main__":
    unittest.main()
