"""Materials with the outline and the holes of a tile."""

import unittest.mock

import bpy
import numpy as np

from support import blender, inputs, scenes
from support.blender import BlenderTest
from support.drawn import drawn
from support.notes import export_notes


class Outline(BlenderTest):
    def setUp(self):
        super().setUp()
        scenes.use_engine(samples=64)
        bpy.context.scene.render.film_transparent = True
        bpy.ops.velour.add_mesostructure(type="NET", count=2, resolution=8)
        self.tile = bpy.context.object
        self.tile.hide_render = True
        self.material = scenes.measured_material(
            inputs.model_bytes(inputs.lambert_measurement((0.5, 0.5, 0.5)))
        )
        bpy.ops.mesh.primitive_plane_add(size=2)
        plane = bpy.context.object.data
        plane.materials.append(self.material)
        for corner in plane.uv_layers.active.data:  # tiles a quarter of a metre wide
            corner.uv *= 8
        scenes.add_camera(ortho_scale=1)
        bpy.context.scene.camera.location = (0, 0, 5)
        bpy.context.scene.camera.rotation_euler = (0, 0, 0)
        scenes.set_world()

    def _outlined(self):
        """The outline is captured by the first test that asks; the others open what it saved."""
        path, names = blender.folder() / "outlined.blend", (self.material.name, self.tile.name)
        if path.exists():
            bpy.ops.wm.open_mainfile(filepath=str(path))
            self.material, self.tile = bpy.data.materials[names[0]], bpy.data.objects[names[1]]
        else:
            bpy.ops.velour.add_votf(material=names[0], structure=names[1], texels=48)
            bpy.ops.wm.save_as_mainfile(filepath=str(path), copy=True)

    def _info(self):
        image = scenes.velour_node(self.material).image
        with inputs.native().Model.from_bytes(image.packed_file.data, image.name) as model:
            return model.info()

    def _alpha(self, name):
        return float(scenes.render(self.folder, name)[..., 3].mean())

    def test_holes_let_the_background_through(self):
        self.assertEqual(self._alpha("before"), 1.0)
        before = scenes.velour_node(self.material).image
        result = bpy.ops.velour.add_votf(material=self.material.name, structure=self.tile.name, texels=48)
        self.assertEqual(result, {"FINISHED"})
        node = scenes.velour_node(self.material)
        self.assertNotEqual(node.image, before)
        self.assertIsNotNone(before.packed_file)  # the model before it stays
        self.assertEqual((node.velour.structure, node.velour.outline_texels), (self.tile, 48))
        shell = self._info()["shell"]
        self.assertEqual(shell["source"], self.tile.name)
        self.assertEqual(shell["points"][0], 48)
        self.assertAlmostEqual(self._alpha("after"), self._solid(), delta=0.03)

    def test_a_wider_tile_has_a_higher_outline(self):
        self._outlined()
        camera, angle = bpy.context.scene.camera, np.radians(70)
        camera.location = (0, -5 * np.sin(angle), 5 * np.cos(angle))
        camera.rotation_euler = (angle, 0, 0)
        camera.data.ortho_scale = 0.5
        low = self._alpha("low")
        scenes.velour_node(self.material).velour.outline_width = 0.5  # twice what the coordinates say
        high = self._alpha("high")
        self.assertGreater(high, low + 0.05)
        bpy.context.scene.unit_settings.scale_length = 0.001
        self.assertEqual(self._alpha("millimeters"), high)  # like the object, it is entered in Blender units

    def test_a_soft_edge_fades_and_keeps_what_is_covered(self):
        self._outlined()
        bpy.context.scene.camera.data.ortho_scale = 0.125  # half a tile
        hard = scenes.render(self.folder, "hard")[..., 3]
        scenes.velour_node(self.material).velour.outline_softness = 0.05
        soft = scenes.render(self.folder, "soft")[..., 3]
        self.assertAlmostEqual(float(soft.mean()), float(hard.mean()), delta=0.03)
        self.assertGreater(np.mean((soft > 0.1) & (soft < 0.9)), 1.5 * np.mean((hard > 0.1) & (hard < 0.9)))

    def _solid(self):
        with inputs.native().Tile.create("net", count=2, resolution=8) as tile:
            return 1 - tile.info()["open_area"]

    def test_it_lies_as_its_placement_says(self):
        self._outlined()
        layers = bpy.context.object.data.uv_layers
        bpy.context.scene.camera.data.ortho_scale = 0.25  # a tile
        plain = scenes.render(self.folder, "plain")[..., 3]
        placement = scenes.velour_node(self.material).velour.placement
        placement.repeats = 2, 1
        scenes.set_look(self.material, rotation=np.pi / 2)
        placed = scenes.render(self.folder, "placed")[..., 3]
        placement.repeats = 1, 1
        scenes.set_look(self.material, rotation=0)
        for corner in layers.active.data:
            corner.uv = 2 * corner.uv.y, -corner.uv.x
        moved = scenes.render(self.folder, "moved")[..., 3]
        self.assertLess(np.abs(placed - moved).mean(), 0.02)
        self.assertGreater(np.abs(placed - plain).mean(), 0.1)
        layers.remove(layers[0])
        bpy.context.scene.camera.data.ortho_scale = 1
        self.assertAlmostEqual(self._alpha("projected"), self._solid(), delta=0.03)  # one tile, of a metre

    def test_its_placement_cannot_vary(self):
        self._outlined()
        tree, group = self.material.node_tree, scenes.velour_node(self.material).group
        names = ("Rotation", "Scale", "Roughness Offset")
        varying = tree.nodes.new("ShaderNodeTexNoise")
        for name in names:
            tree.links.new(varying.outputs[0], group.inputs[name])
        notes = " ".join(export_notes())
        for name in names:
            self.assertIn(f"the link to '{name}' is not supported for models with a silhouette", notes)

    def test_its_height_is_told_in_radii_of_the_surface(self):
        self._outlined()
        bpy.ops.mesh.primitive_cylinder_add(radius=0.5, depth=2, vertices=256, end_fill_type="NOTHING")
        cylinder = bpy.context.object
        bpy.ops.object.shade_smooth()
        cylinder.data.materials.append(self.material)
        shell = self._info()["shell"]

        def report(width):
            depsgraph = bpy.context.evaluated_depsgraph_get()
            outline = inputs.module("export.outline_report")
            return outline.outline_report_on(depsgraph, cylinder, self.material, shell, None, width)

        low, _high = shell["heights"]
        flat, expected = report(0.1), -low * 0.1 / 0.5
        self.assertAlmostEqual(flat.share, expected, delta=0.05 * expected)
        self.assertEqual(flat.warnings, ())
        folded = report(1.2 * 0.5 / -low)
        self.assertIn("folds", folded.warnings[0])
        self.assertEqual(dict(folded.rows)["Height / radius"], "120%")
        bpy.context.scene.unit_settings.scale_length = 0.001
        small = report(0.1)
        self.assertEqual(dict(small.rows)["Tile width"], "0.1 mm")
        self.assertAlmostEqual(small.share, flat.share, delta=1e-3)

    def test_a_render_warns_of_folds_in_meters(self):
        self._outlined()
        bpy.ops.mesh.primitive_uv_sphere_add(radius=1)
        bpy.ops.object.shade_smooth()
        bpy.context.object.data.materials.append(self.material)
        scenes.velour_node(self.material).velour.outline_width = 20
        bpy.context.scene.unit_settings.scale_length = 0.001
        self.assertRegex(" ".join(export_notes()), r"they are 0\.02 m wide")

    def test_it_is_captured_as_wide_as_it_is_rendered(self):
        """Captures are in meters."""
        self._outlined()
        scenes.velour_node(self.material).velour.outline_width = 0.5
        bpy.context.scene.unit_settings.scale_length = 0.001
        tiles, depsgraph = inputs.module("export.tiles"), bpy.context.evaluated_depsgraph_get()
        source = tiles.object_tile(bpy.data.objects["Plane"], depsgraph)
        with unittest.mock.patch.object(inputs.native().Scene, "set_shell_tile") as given:
            tiles.export_tile(source, depsgraph, approximate=True)[0].close()
        self.assertAlmostEqual(given.call_args.args[1], 0.0005)

    def test_an_estimate_before_it_begins(self):
        """By small outlines, which change nothing; it is of this structure and these texels alone."""
        node, state = scenes.velour_node(self.material), bpy.context.window_manager.velour
        asked = inputs.module("operators.asked_outline").outlined_as
        before, images = node.image, len(bpy.data.images)
        with self.assertRaisesRegex(RuntimeError, "choose the object"):
            bpy.ops.velour.estimate_votf()
        self.assertEqual(bpy.ops.velour.estimate_votf(structure=self.tile.name, texels=48), {"FINISHED"})
        said = state.outline_estimate
        self.assertRegex(said, r"^About \d+ (seconds|minutes).*[kM]B of additional memory; wrong rays")
        self.assertEqual(state.outline_estimated, asked(self.material, self.tile, 48))
        self.assertNotEqual(state.outline_estimated, asked(self.material, self.tile, 49))
        self.assertEqual((node.image, len(bpy.data.images)), (before, images))
        self.assertEqual((node.velour.structure, node.velour.outline_texels), (None, 128))
        self.assertNotIn("estimate", " ".join(self._panel().texts), "another structure")
        node.velour.structure, node.velour.outline_texels = self.tile, 48
        self.assertIn(said, self._panel().texts)
        bpy.ops.velour.add_votf()
        points = " x ".join(map(str, self._info()["shell"]["points"]))
        self.assertIn(f"({points} points)", said)

    def test_its_curve_is_what_it_covers_from_above(self):
        with self.assertRaisesRegex(RuntimeError, "no silhouette"):
            bpy.ops.velour.save_plot(
                material=self.material.name, kind="OUTLINE", filepath=str(self.folder / "no.csv")
            )
        self._outlined()
        path = self.folder / "outline.csv"
        bpy.ops.velour.save_plot(material=self.material.name, kind="OUTLINE", filepath=str(path))
        rows = [line.split(",") for line in path.read_text().splitlines()[1:]]
        mean = {float(x): float(y) for name, x, y, _ in rows if name == "mean"}
        self.assertAlmostEqual(mean[0], self._solid(), delta=0.03)
        self.assertGreater(mean[75], mean[0])
        operators = self._panel().operators
        self.assertEqual(operators[-2:], ["velour.enlarge_plot", "velour.save_plot"])

    def _panel(self):
        """As it is once the model is read."""
        material = self.material
        panel = inputs.module("ui.outline_panel")
        with unittest.mock.patch.object(panel, "model_summary", return_value=self._info()):
            return drawn(
                panel.VELOUR_MATERIAL_PT_outline,
                material=material,
                object=bpy.context.object,
                view_layer=bpy.context.view_layer,
            )

    def test_what_is_missing_is_said(self):
        with self.assertRaisesRegex(RuntimeError, "choose the object"):
            bpy.ops.velour.add_votf(material=self.material.name)
        with self.assertRaisesRegex(RuntimeError, "nothing of that name"):
            bpy.ops.velour.add_votf(material=self.material.name, structure="nothing of that name")
        with self.assertRaisesRegex(RuntimeError, "no material 'none'"):
            bpy.ops.velour.add_votf(material="none")
        bare = bpy.data.materials.new("bare")
        with self.assertRaisesRegex(RuntimeError, "has no model"):
            bpy.ops.velour.add_votf(material=bare.name, structure=self.tile.name)
