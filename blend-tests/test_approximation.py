"""The nodes in a measured material's group that show it where there is no Velour."""

import hashlib
from unittest import mock

import bpy
import numpy as np

from support import blender, inputs, scenes
from support.blender import BlenderTest, run_blender
from support.drawn import drawn

SIZE = 96
_BLOCK = 8  # pixels: noise is far below what is looked for

# What any Blender has: nothing that Velour registers.
_NATIVE = {
    "NodeFrame",
    "NodeGroupInput",
    "NodeGroupOutput",
    "NodeReroute",
    "ShaderNodeDisplacement",
    "ShaderNodeSeparateXYZ",
    "ShaderNodeAddShader",
    "ShaderNodeBsdfAnisotropic",
    "ShaderNodeBsdfDiffuse",
    "ShaderNodeBsdfGlossy",
    "ShaderNodeBsdfPrincipled",
    "ShaderNodeCombineXYZ",
    "ShaderNodeFloatCurve",
    "ShaderNodeMapping",
    "ShaderNodeMath",
    "ShaderNodeNewGeometry",
    "ShaderNodeNormalMap",
    "ShaderNodeRGBCurve",
    "ShaderNodeTangent",
    "ShaderNodeTexImage",
    "ShaderNodeUVMap",
    "ShaderNodeVectorMath",
    "ShaderNodeVectorRotate",
}

_RENDER = """
import bpy
assert not hasattr(bpy.types.Scene, "velour"), "Velour is there"
scene = bpy.context.scene
scene.render.engine = "CYCLES"
scene.cycles.samples, scene.cycles.max_bounces, scene.cycles.use_denoising = 64, 0, False
scene.render.filepath, scene.render.image_settings.file_format = {path!r}, "OPEN_EXR"
bpy.ops.render.render(write_still=True)
"""


def group_module():
    return inputs.module("operators.approximation_group")


def group_of(material):
    return inputs.module("export.nodes").approximation_node(material)


class Approximation(BlenderTest):
    def setUp(self):
        super().setUp()
        self.obj = scenes.add_sphere()
        scenes.use_engine(samples=64, size=SIZE)

    @property
    def material(self):
        return self.obj.active_material

    def _import(self, path, **options):
        """The material of a file. Tests share what the first one imported."""
        key = hashlib.sha256(path.read_bytes() + path.name.encode() + repr(options).encode()).hexdigest()
        shared = blender.folder() / f"imported-{key}.blend"
        if shared.is_file():
            with bpy.data.libraries.load(str(shared)) as (source, target):
                target.materials = source.materials
            self.obj.active_material = target.materials[0]
        else:
            bpy.ops.velour.load_material(filepath=str(path), **options)
            bpy.data.libraries.write(str(shared), {self.material})
        return self.material

    def _model_file(self, data, name="paint"):
        path = self.folder / f"{name}.velour"
        path.write_bytes(data)
        return path


class InCycles(Approximation):
    """Rendered by Cycles, under a sky and a sun."""

    def setUp(self):
        super().setUp()
        scenes.add_camera(ortho_scale=2.2)
        scenes.set_world(strength=0.3)
        lamp = bpy.data.objects.new("Sun", bpy.data.lights.new("Sun", "SUN"))
        lamp.data.energy, lamp.data.angle, lamp.rotation_euler = 3, 0.1, (0.3, 0.7, 0)
        bpy.context.scene.collection.objects.link(lamp)

    def _cycles(self, name):
        scene = bpy.context.scene
        scene.render.engine = "CYCLES"
        scene.cycles.samples, scene.cycles.max_bounces, scene.cycles.use_denoising = 64, 0, False
        picture = _blocks(scenes.render(self.folder, name))
        scene.render.engine = "VELOUR"
        return picture

    def _without_velour(self, name):
        """The same in a Blender that has no Velour."""
        blend, path = self.folder / f"{name}.blend", self.folder / f"{name}.exr"
        bpy.ops.wm.save_as_mainfile(filepath=str(blend), copy=True)
        code = _RENDER.format(path=str(path))
        done = run_blender(blend, "--python-exit-code", "1", "--python-expr", code, addons=False)
        self.assertEqual(done.returncode, 0, done.stdout)
        return _blocks(scenes.read(path))

    def _error(self, name):
        return self._error_of(self._cycles(name))

    def _error_of(self, picture):
        """Relative RMS difference from what Velour shows."""
        velour = _blocks(scenes.render(self.folder))
        return float(np.sqrt(((picture - velour) ** 2).mean() / (velour**2).mean()))


class Uniform(InCycles):
    def test_a_plastic(self):
        self._import(inputs.plastic_measurement())
        self.assertLess(self._error("plastic"), 0.06)
        self.assertLess(self._error_of(self._without_velour("elsewhere")), 0.06)
        self._import(inputs.plastic_measurement(), fit=False)
        model = inputs.model_bytes(inputs.plastic_measurement())
        self._give_model(model)
        self.assertGreater(self._error("gray"), 0.3, "gray is no approximation")

    def _give_model(self, data):
        measured = inputs.module("operators.measured")
        scenes.velour_node(self.material).image = measured.packed_model(data, "Paint")

    def test_a_brushed_metal_lies_as_it_does(self):
        self._import(self._model_file(inputs.brushed_model()))
        scenes.set_look(self.material, rotation=0.6)
        self.assertLess(self._error("brushed"), 0.06)
        scenes.set_look(self.material, rotation=0.6 + np.pi / 2)
        self.assertLess(self._error("turned"), 0.06)
        tree = group_of(self.material).node_tree
        for turns in [node.inputs["Rotation"] for node in tree.nodes if "Rotation" in node.inputs]:
            tree.links.remove(turns.links[0])
            turns.default_value = 0.6 / (2 * np.pi)
        self.assertGreater(self._error("as it lay"), 0.5)

    def test_the_artist_s_look_is_followed(self):
        self._import(inputs.plastic_measurement())
        before = self._cycles("before")
        scenes.set_look(self.material, tint=(0.9, 0.5, 0.3), exposure=-0.5)
        self.assertLess(self._error("tinted"), 0.06)
        scenes.set_look(self.material, roughness=0.5)
        self.assertLess(self._error("rough"), 0.08)
        velour = _blocks(scenes.render(self.folder))
        self.assertGreater(np.sqrt(((before - velour) ** 2).mean() / (velour**2).mean()), 0.3)


class Tiles(InCycles):
    """Approximations of BTFs, on a plane seen from above."""

    def setUp(self):
        super().setUp()
        bpy.data.objects.remove(self.obj)
        self.obj = scenes.add_plane()
        bpy.context.scene.camera.data.ortho_scale = 2.0

    def test_they_lie_as_they_do(self):
        self._import(self._model_file(inputs.quarters_model()))
        placement = scenes.velour_node(self.material).velour.placement
        bpy.ops.velour.approximate()
        before = self._cycles("before")
        placement.repeats, placement.offset = (1.5, 1.0), (0.1, 0.2)
        scenes.set_look(self.material, rotation=0.4, scale=0.8)
        self.assertLess(self._error("quarters"), 0.06)
        scenes.set_look(self.material, tint=(0.4, 1.0, 0.7))
        self.assertLess(self._error("tinted"), 0.06)
        velour = _blocks(scenes.render(self.folder))
        self.assertGreater(np.sqrt(((before - velour) ** 2).mean() / (velour**2).mean()), 0.2)

    def test_tiles_of_a_real_size_lie_so_where_a_unit_is_a_metre(self):
        """The plane's unit of texture coordinates is 2 m."""
        self._import(self._model_file(inputs.quarters_model(metres=0.5)))
        placement = scenes.velour_node(self.material).velour.placement
        placement.mode, placement.uv_density = "REAL_SIZE", (0.5, 0.5)
        bpy.ops.velour.approximate()
        self.assertLess(self._error("real"), 0.12)

    def test_one_sees_through_holes(self):
        bpy.ops.velour.add_material()
        pixels = np.ones((4, 4, 4), np.float32) * 0.5
        pixels[:, :2, 3], pixels[:, 2:, 3] = 0, 1  # the left half is open
        core = inputs.module("core.approximation")
        found = core.UNFITTED._replace(color_map=pixels)
        group_module().put(scenes.velour_node(self.material), self.material, found, {"texels": (4, 4)})
        left, right = np.split(self._cycles("holes")[2:-2], 2, axis=1)
        np.testing.assert_allclose(left[:, 2:-2], 0.3, atol=0.01)  # the sky
        self.assertGreater(right[:, 2:-2].min(), 0.5)  # the sun as well


class Relief(InCycles):
    """Normal maps in approximations of BTFs, under a sun from the side."""

    def setUp(self):
        super().setUp()
        bpy.data.objects.remove(self.obj)
        self.obj = scenes.add_plane()
        bpy.context.scene.camera.data.ortho_scale = 1.0
        scenes.set_world(strength=0.0)
        self.sun = bpy.data.objects["Sun"]
        self.sun.data.angle, self.sun.rotation_euler = 0, (0, np.radians(60), 0.4)
        self._import(self._model_file(inputs.weave_model()))

    def _without(self):
        """The error without the normal map, whose links are back afterwards."""
        group = group_of(self.material).node_tree
        relief = _node(group, "ShaderNodeNormalMap")
        sockets = [link.to_socket for link in relief.outputs[0].links]
        for socket in sockets:
            group.links.remove(socket.links[0])
        error = self._error("flat")
        for socket in sockets:
            group.links.new(relief.outputs[0], socket)
        return error

    def test_pictures_are_nearer_with_them(self):
        self.assertLess(self._error("relief"), 0.75 * self._without())

    def test_they_turn_with_the_tiles_and_no_repeats_change_them(self):
        placement = scenes.velour_node(self.material).velour.placement
        placement.repeats = 2.0, 1.0
        scenes.set_look(self.material, rotation=2.0)
        right = self._error("turned")
        self.assertLess(right, 0.85 * self._without())
        tree = group_of(self.material).node_tree
        tree.links.remove(_node(tree, "ShaderNodeVectorRotate").inputs["Angle"].links[0])
        self.assertGreater(self._error("as they lay"), 1.25 * right)

    def test_they_follow_the_uv_map(self):
        placement = scenes.velour_node(self.material).velour.placement
        placement.uv_map = "Other"
        group = group_of(self.material).node_tree
        self.assertEqual(_node(group, "ShaderNodeNormalMap").uv_map, "Other")

    def test_their_image_is_of_numbers_and_goes_with_the_group(self):
        group = group_of(self.material).node_tree
        colors, normals, *_rest = _images(group)
        self.assertFalse(colors.colorspace_settings.is_data)
        self.assertTrue(normals.colorspace_settings.is_data)
        self.assertTrue(normals.packed_file)
        tilts = 2 * np.array(normals.pixels).reshape(-1, 4)[:, :3] - 1
        np.testing.assert_allclose((tilts**2).sum(-1), 1, atol=0.02)
        bpy.ops.velour.approximate()
        names = [image.name for image in bpy.data.images if image.name.startswith(f"{self.material.name} ")]
        count = sum(image is not None for image in _images(group))
        self.assertEqual(len(names), count, "the ones before stay")

    def test_its_relief_displaces_in_place_of_the_normals(self):
        tree, output = group_of(self.material).node_tree, self.material.node_tree.nodes["Material Output"]
        before, kinds = scenes.render(self.folder), _kinds(tree)
        images = _images(tree)
        bpy.ops.velour.displace()
        self.assertEqual(output.inputs["Displacement"].links[0].from_node, group_of(self.material))
        self.assertEqual(_method(self.material), "BOTH")
        self.assertFalse(_node(tree, "ShaderNodeNormalMap").outputs[0].is_linked)
        self.assertEqual(_images(tree), images)
        np.testing.assert_array_equal(scenes.render(self.folder), before)
        bpy.ops.velour.displace(enable=False)
        self.assertFalse(output.inputs["Displacement"].is_linked)
        self.assertEqual(_method(self.material), "BUMP")
        self.assertTrue(_node(tree, "ShaderNodeNormalMap").outputs[0].is_linked)
        self.assertEqual((_images(tree), _kinds(tree)), (images, kinds))

    def test_its_height_follows_the_size_of_its_tile(self):
        """The plane is 2 m wide, and its texture coordinates have half a unit per meter."""
        bpy.ops.velour.displace()
        placement = scenes.velour_node(self.material).velour.placement
        placement.uv_density, placement.repeats = (0.5, 0.5), (2.0, 2.0)  # a tile of 1 m
        _subdivide(self.obj, 6)
        bpy.context.scene.camera.rotation_euler = np.pi / 2, 0, 0
        bpy.context.scene.camera.location = 0, -5, 0
        look = inputs.module("operators.approximation_look")
        wanted = look.fitted(group_of(self.material).node_tree)["height"]
        bpy.context.scene.camera.data.ortho_scale = 4 * wanted
        scenes.set_world(strength=0.0)
        shown = self._cycles("side")[:, 2:-2].max(-1) > 0.01  # blocks that the surface covers
        covered = shown.any(axis=1).mean() * 4 * wanted
        self.assert_close(covered, wanted, 0.35 * wanted)

    def test_the_error_is_stated_by_view(self):
        state = group_of(self.material).node_tree.velour
        self.assertTrue(all(0 < error < 1 for error in state.by_view_angle), list(state.by_view_angle))
        self.assert_close(state.relative_l2, np.mean(state.by_view_angle[:4]), 1e-6)

    def test_what_is_flat_has_none(self):
        self._import(self._model_file(inputs.quarters_model(), "quarters"))
        kinds = {node.bl_idname for node in group_of(self.material).node_tree.nodes}
        self.assertIsNone(_images(group_of(self.material).node_tree).normals)
        self.assertNotIn("ShaderNodeNormalMap", kinds)


class Group(Approximation):
    def test_a_new_material_has_one(self):
        bpy.ops.velour.add_material()
        self.assertEqual(group_of(self.material).node_tree.name, self.material.name)
        self.assertTrue(group_of(self.material).outputs[0].is_linked)

    def test_it_is_of_native_nodes_and_so_is_solid_mode(self):
        for name, data in (
            ("brushed", inputs.brushed_model()),
            ("quarters", inputs.quarters_model()),
            ("weave", inputs.weave_model()),
            ("lambert", inputs.model_bytes(inputs.lambert_measurement())),
        ):
            group = group_of(self._import(self._model_file(data, name))).node_tree
            self.assertLessEqual({node.bl_idname for node in group.nodes}, _NATIVE)
        self.assert_close(self.material.metallic, 0, 0.05)
        np.testing.assert_allclose(self.material.diffuse_color[:3], (0.8, 0.5, 0.2), atol=0.03)

    def test_its_error_is_the_library_s(self):
        data = inputs.model_bytes(inputs.plastic_measurement())
        state = group_of(self._import(self._model_file(data))).node_tree.velour
        masking = "separable" if bpy.app.version < (3, 5) else "correlated"
        with inputs.native().Model.from_bytes(data, "plastic") as model:
            report = model.closures(masking=masking)
        self.assert_close(state.relative_l2, report["relative_l2_mean"], 1e-6)
        np.testing.assert_allclose(state.by_view_angle, report["relative_l2"], rtol=1e-5)
        self.assertEqual(state.model, scenes.velour_node(self.material).image.velour.sha256)

    def test_a_fit_refreshes_it(self):
        self._import(inputs.lambert_measurement(), fit=False)
        self.assertEqual(group_of(self.material).node_tree.velour.model, "")
        bpy.ops.velour.fit(tolerance=0.1, max_lobes=3)
        group = group_of(self.material)
        self.assertEqual(group.node_tree.velour.model, scenes.velour_node(self.material).image.velour.sha256)
        self.assertEqual(group.node_tree.name, self.material.name)
        self.assertTrue(group.outputs[0].is_linked)
        self.assertEqual(len(bpy.data.node_groups), 1)

    def test_the_panel_says_when_it_is_of_another_model(self):
        """Also of one whose content nobody has vouched for, as of images that were opened by hand."""
        module = inputs.module("ui.approximation_panel")
        files = inputs.module("export.files")
        old = "The approximation is of another model. Press Refresh."

        def read(image):
            return files.StoredFile.of(image, "Test").model_info()

        def said():
            with mock.patch.object(module, "model_summary", read):
                return drawn(module.VELOUR_MATERIAL_PT_approximation, material=self.material).texts

        self._import(self._model_file(inputs.model_bytes(inputs.lambert_measurement())))
        self.assertNotIn(old, said())
        image = bpy.data.images.load(
            str(self._model_file(inputs.model_bytes(inputs.glossy_measurement()), "other"))
        )
        scenes.velour_node(self.material).image = image
        self.assertEqual(image.velour.sha256, "")
        self.assertIn(old, said())
        bpy.ops.velour.approximate()
        self.assertNotIn(old, said())

    def test_it_is_discarded_if_the_model_is_replaced_meanwhile(self):
        self._import(self._model_file(inputs.quarters_model(), "quarters"))
        module, measured = group_module(), inputs.module("operators.measured")
        steps = module.steps

        def replaced(model):
            image = measured.packed_model(inputs.model_bytes(inputs.lambert_measurement()), "Other")
            node = scenes.velour_node(self.material)
            measured.set_model(self.material, node, image, print, info={"isotropic": True})
            return steps(model)

        with mock.patch.object(module, "steps", replaced):
            self.assertEqual(bpy.ops.velour.approximate(), {"CANCELLED"})
        self.assertNotIn("Vector", group_of(self.material).inputs)

    def test_it_replaces_the_surface_and_keeps_its_nodes(self):
        self.obj.active_material = material = scenes.diffuse_material()
        bpy.ops.velour.add_material()
        surface = material.node_tree.nodes["Material Output"].inputs["Surface"]
        self.assertEqual(surface.links[0].from_node, group_of(material))
        self.assertIn("ShaderNodeBsdfDiffuse", [node.bl_idname for node in material.node_tree.nodes])

    def test_nodes_of_the_artist_in_the_group_stay(self):
        self._import(self._model_file(inputs.model_bytes(inputs.lambert_measurement())))
        tree = group_of(self.material).node_tree
        sink, own = _node(tree, "NodeGroupOutput"), tree.nodes.new("ShaderNodeBsdfDiffuse")
        tree.links.new(own.outputs[0], sink.inputs[0])
        own.name = "Mine"
        count = len(tree.nodes)
        bpy.ops.velour.approximate()
        self.assertEqual(sink.inputs[0].links[0].from_node.name, "Mine")
        self.assertEqual(len(tree.nodes), count)

    def test_solid_mode_follows_the_inputs_of_each_copy(self):
        self._import(self._model_file(inputs.model_bytes(inputs.lambert_measurement())))
        original, copy = self.material, self.material.copy()
        self.assertEqual(group_of(copy).node_tree, group_of(original).node_tree)
        before = tuple(original.diffuse_color)
        scenes.add_plane(copy)
        scenes.set_look(copy, tint=(0.5, 0.25, 1.0))
        bpy.context.view_layer.update()
        self.assertEqual(tuple(original.diffuse_color), before)
        np.testing.assert_allclose(copy.diffuse_color, np.multiply(before, (0.5, 0.25, 1, 1)), rtol=1e-4)

    def test_undo(self):
        bpy.context.preferences.edit.use_global_undo = True
        self._import(self._model_file(inputs.model_bytes(inputs.lambert_measurement())))
        color, kinds = tuple(self.material.diffuse_color), _kinds(group_of(self.material).node_tree)
        bpy.ops.ed.undo_push(message="before")
        name = self.material.name
        measured = inputs.module("operators.measured")
        other = inputs.model_bytes(inputs.plastic_measurement())
        scenes.velour_node(self.material).image = measured.packed_model(other, "Other")
        bpy.ops.velour.approximate()
        self.assertNotEqual(tuple(self.material.diffuse_color), color)
        self.assertNotEqual(_kinds(group_of(self.material).node_tree), kinds)
        bpy.ops.ed.undo_push(message="approximate")
        bpy.ops.ed.undo()
        material = bpy.data.materials[name]
        self.assertEqual(tuple(material.diffuse_color), color)
        self.assertEqual(_kinds(group_of(material).node_tree), kinds)


class Refusals(Approximation):
    def _refused(self, words, **arguments):
        with self.assertRaisesRegex(RuntimeError, words):
            bpy.ops.velour.approximate(**arguments)

    def test_without_a_material_or_a_model(self):
        self._refused("There is no active material")
        self._refused("Nobody", material="Nobody")
        bpy.ops.velour.add_material()
        self._refused("has no model")

    def test_linked_materials(self):
        self._import(self._model_file(inputs.model_bytes(inputs.lambert_measurement())))
        path, name = str(self.folder / "library.blend"), self.material.name
        bpy.ops.wm.save_as_mainfile(filepath=path)
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        with bpy.data.libraries.load(path, link=True) as (_source, target):
            target.materials = [name]
        self._refused("linked from another file", material=name)
        self.assertEqual(len(bpy.data.node_groups), 1)


def _node(group, idname):
    return next(node for node in group.nodes if node.bl_idname == idname)


def _images(group):
    """The TileImages of a group."""
    return inputs.module("operators.approximation_image").images_of(group)


def _subdivide(obj, times):
    modifier = obj.modifiers.new("Subdivision", "SUBSURF")
    modifier.subdivision_type, modifier.levels, modifier.render_levels = "SIMPLE", times, times


def _method(material):
    owner = material if hasattr(material, "displacement_method") else material.cycles
    return owner.displacement_method


def _kinds(group):
    return sorted(node.bl_idname for node in group.nodes)


def _blocks(picture):
    count = SIZE // _BLOCK
    return picture[..., :3].reshape(count, _BLOCK, count, _BLOCK, 3).mean(axis=(1, 3))
