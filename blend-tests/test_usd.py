"""The approximation of measured materials in USD files, which no Blender of Debian writes."""

import unittest

import bpy
import numpy as np

from support import inputs, scenes
from support.blender import run_blender
from test_approximation import InCycles, group_of

# An export in a Blender of its own, which has to end; {before} what is done before Velour is there.
_EXPORT = """
import sys
{before}
import addon_utils
addon_utils.enable("velour")
import bpy
bpy.ops.wm.open_mainfile(filepath={blend!r})
bpy.ops.wm.usd_export(filepath={path!r})
print("EXPORTED", flush=True)
"""

_PLASTIC = {
    "base_color": (0.6, 0.3, 0.1),
    "metallic": 0.1,
    "roughness": 0.25,
    "specular": 0.7,
    "coat": 0.4,
    "coat_roughness": 0.1,
}


def has_usd():
    try:
        from pxr import UsdShade  # noqa: F401
    except ImportError:
        return False
    return hasattr(bpy.types, "USDHook")


def module(name):
    return inputs.module(f"operators.{name}")


@unittest.skipUnless(has_usd(), "this Blender cannot write USD")
class Usd(InCycles):
    _count = 0

    def _model(self, data):
        path = self.folder / "paint.velour"
        path.write_bytes(data)
        bpy.ops.velour.load_material(filepath=str(path))
        return group_of(self.material)

    def _approximation(self, tile="texels", **changed):
        """A material of such values, as a fit makes them of a plastic; its group."""
        bpy.ops.velour.add_material()
        core = inputs.module("core.approximation")
        values = {"principled": {**core.UNFITTED.principled, **_PLASTIC}, **changed}
        info = {tile: (4, 4)} if "color_map" in changed else {"isotropic": "anisotropic" not in changed}
        found = core.UNFITTED._replace(**values)
        module("approximation_group").put(scenes.velour_node(self.material), self.material, found, info)
        return group_of(self.material).node_tree

    def _exported(self, **options):
        """The only material of the file, its surface's inputs by name, and the stage."""
        from pxr import Usd, UsdShade

        self._count += 1  # no file is written anew while a stage shows it
        path = self.path = self.folder / f"exported{self._count}.usda"
        self.assertEqual(bpy.ops.wm.usd_export(filepath=str(path), **options), {"FINISHED"})
        stage = Usd.Stage.Open(str(path))
        (prim,) = (prim for prim in stage.Traverse() if prim.IsA(UsdShade.Material))
        surface = UsdShade.Material(prim).ComputeSurfaceSource()[0]
        values = {each.GetBaseName(): each.Get() for each in surface.GetInputs()} if surface else None
        return UsdShade.Material(prim), values, stage

    def _node(self, material, name):
        from pxr import UsdShade

        return UsdShade.Shader(material.GetPrim().GetChild(name))


class Values(Usd):
    def test_of_a_plastic(self):
        shader = next(n for n in self._approximation().nodes if n.bl_idname == "ShaderNodeBsdfPrincipled")
        _material, values, _stage = self._exported()
        color = tuple(shader.inputs["Base Color"].default_value)[:3]
        np.testing.assert_allclose(values["diffuseColor"], color, rtol=1e-5)
        for name, key in (
            ("Metallic", "metallic"),
            ("Roughness", "roughness"),
            ("Coat Weight", "clearcoat"),
            ("Coat Roughness", "clearcoatRoughness"),
        ):
            self.assertAlmostEqual(values[key], shader.inputs[name].default_value, 5)
        f0 = ((values["ior"] - 1) / (values["ior"] + 1)) ** 2
        self.assertAlmostEqual(f0, 0.08 * shader.inputs["Specular IOR Level"].default_value, 5)

    def test_nothing_without_the_hook(self):
        """The control: this is what Blender writes by itself."""
        self._approximation()
        module("usd_hook").detach()
        try:
            self.assertIsNone(self._exported()[1])
        finally:
            module("usd_hook").attach()

    def test_of_a_metal_over_a_diffuse_base(self):
        core = inputs.module("core.approximation")
        metal = {**core.UNFITTED.principled, "base_color": (0.1, 0.2, 0.3), "metallic": 1.0}
        self._approximation(principled=metal, anisotropic=0.5, diffuse=(0.4, 0.3, 0.2))
        _material, values, _stage = self._exported()
        self.assertEqual(values["useSpecularWorkflow"], 1)
        np.testing.assert_allclose(values["specularColor"], (0.1, 0.2, 0.3), rtol=1e-5)
        np.testing.assert_allclose(values["diffuseColor"], (0.4, 0.3, 0.2), rtol=1e-5)

    def test_a_surface_of_the_artist_s_own_stays(self):
        self._approximation()
        tree = self.material.node_tree
        mine = tree.nodes.new("ShaderNodeBsdfPrincipled")
        mine.inputs["Base Color"].default_value = (0.9, 0.1, 0.2, 1)
        tree.links.new(mine.outputs[0], tree.nodes["Material Output"].inputs["Surface"])
        material, values, _stage = self._exported()
        np.testing.assert_allclose(values["diffuseColor"], (0.9, 0.1, 0.2), rtol=1e-5)
        self.assertFalse(material.GetPrim().GetChild("Velour_Approximation"))

    def test_solid_mode_s_stays(self):
        self._approximation()
        _material, values, _stage = self._exported(generate_preview_surface=False)
        self.assertEqual(set(values), {"diffuseColor", "metallic", "roughness"})


class Images(Usd):
    """Images of BTFs, on a plane seen from above. USD checks the file, and Blender's importer shows it."""

    def setUp(self):
        super().setUp()
        bpy.data.objects.remove(self.obj)
        self.obj = scenes.add_plane()
        bpy.context.scene.camera.data.ortho_scale = 2.0

    def test_it_is_beside_the_file(self):
        from pxr import UsdUtils

        ours = module("approximation_image").images_of(self._quarters()).colors
        material, _values, _stage = self._exported()
        named = self._node(material, "Velour_Color").GetInput("file").Get().path
        picture = scenes.read(self.folder / named)
        self.assertEqual(picture.shape[:2], tuple(ours.size)[::-1])
        self.assertGreater(picture[..., :3].std(), 0.05)
        checker = UsdUtils.ComplianceChecker(skipARKitRootLayerCheck=True)
        checker.CheckCompliance(str(self.path))
        self.assertEqual([checker.GetErrors(), checker.GetFailedChecks()], [[], []])

    def test_it_is_written_where_blender_helps_with_none(self):
        """As 4.3 and older: the context of the export has a stage alone."""
        tree = self._quarters()
        _material, _values, stage = self._exported()

        class Context:
            @staticmethod
            def get_stage():
                return stage

        image = module("approximation_image").images_of(tree).colors
        named = module("usd_nodes").exported(Context, image)
        again = bpy.data.images.load(str(self.folder / named))
        np.testing.assert_array_equal(np.array(again.pixels[:]), np.array(image.pixels[:]))

    def _quarters(self):
        return self._model(inputs.quarters_model()).node_tree

    def _placed(self, **settings):
        measured = scenes.velour_node(self.material).velour
        for name, value in settings.items():
            if name == "rotation":
                scenes.set_look(self.material, rotation=value)
            else:
                setattr(measured.placement, name, value)

    def test_it_lies_as_it_did(self):
        self._quarters()
        scenes.set_look(self.material, tint=(0.4, 1.0, 0.7))
        for name, settings in (
            ("apart", {"repeats": (1.5, 1.0), "offset": (0.1, 0.2)}),
            ("turned", {"repeats": (1.5, 1.5), "rotation": 0.4}),
            ("both", {"repeats": (1.5, 1.0), "rotation": 0.4}),
        ):
            with self.subTest(name):
                self._placed(**settings)
                here = self._cycles(name)
                there = self._again(name)
                self.assertLess(_difference(there, here), 0.03)
                self._placed(rotation=0.7, offset=(0.3, 0.2))
                self.assertGreater(
                    _difference(self._cycles(f"{name}-moved"), there), 0.2, "the control lies so, too"
                )
                self._placed(rotation=0.0, offset=(0, 0))

    def _again(self, name):
        """The picture with the material that Blender's importer makes of the file."""
        self._exported()
        before = self.material
        known = set(bpy.data.materials), set(bpy.data.objects)
        scene, world = bpy.context.scene, bpy.context.scene.world
        scene.world = None  # which the importer of 5.0 would change
        bpy.ops.wm.usd_import(filepath=str(self.path), import_all_materials=True)
        scene.world = world
        (new,) = set(bpy.data.materials) - known[0]
        for obj in set(bpy.data.objects) - known[1]:
            bpy.data.objects.remove(obj)
        self.obj.data.materials[0] = new
        self.obj.data.uv_layers[0].name = "st"  # as the file calls them
        try:
            return self._cycles(f"{name}-again")
        finally:
            self.obj.data.materials[0] = before
            bpy.data.materials.remove(new)

    def test_normals_are_written_as_they_are(self):
        tilted = np.array((0.36, -0.48, 0.8))
        pixels = {"color_map": np.ones((4, 4, 4)), "normal_map": np.broadcast_to(tilted, (4, 4, 3))}
        group = self._approximation(**pixels)
        material, values, _stage = self._exported()
        self.assertIn("normal", values)
        texture = self._node(material, "Velour_Normals")
        told = {name: texture.GetInput(name).Get() for name in ("file", "scale", "bias", "sourceColorSpace")}
        stored = scenes.read(self.folder / told["file"].path)[..., :3]
        decoded = stored * np.array(told["scale"][:3]) + np.array(told["bias"][:3])
        np.testing.assert_allclose(decoded, np.broadcast_to(tilted, (4, 4, 3)), atol=0.01)
        self.assertEqual(told["sourceColorSpace"], "raw")
        colors = self._node(material, "Velour_Color").GetInput("file").Get().path
        np.testing.assert_allclose(scenes.read(self.folder / colors)[..., :3], 1, atol=0.01)
        images = [n for n in group.nodes if n.bl_idname == "ShaderNodeTexImage" and not n.velour.enabled]
        group.nodes.remove(images[1])
        self.assertNotIn("normal", self._exported()[1])

    def test_a_roughness_map_is_connected(self):
        maps = {"color_map": np.ones((4, 4, 4)), "roughness_map": np.full((4, 4), 0.6)}
        self._approximation("shell", **maps)
        material, _values, _stage = self._exported()
        surface = material.ComputeSurfaceSource()[0]
        self.assertTrue(surface.GetInput("roughness").HasConnectedSource())
        texture = self._node(material, "Velour_Roughness")
        self.assertEqual(texture.GetInput("sourceColorSpace").Get(), "raw")
        stored = scenes.read(self.folder / texture.GetInput("file").Get().path)
        np.testing.assert_allclose(stored[..., 0], 0.6, atol=0.01)
        scenes.set_look(self.material, roughness=0.5)
        material, values, _stage = self._exported()
        self.assertGreater(values["roughness"], _PLASTIC["roughness"])
        self.assertFalse(self._node(material, "Velour_Roughness"))

    def test_names_of_texture_coordinates(self):
        self._quarters()
        self.obj.data.uv_layers[0].name = "First"
        self.obj.data.uv_layers.new(name="Second Map")
        for wanted, rename, written in (
            ("", True, "st"),
            ("", False, "First"),
            ("First", True, "st"),
            ("Second Map", True, "Second_Map"),
        ):
            self._placed(uv_map=wanted)
            material, _values, stage = self._exported(rename_uvmaps=rename)
            self.assertEqual(self._node(material, "Velour_UV").GetInput("varname").Get(), written)
            meshes = [prim for prim in stage.Traverse() if prim.HasAttribute(f"primvars:{written}")]
            self.assertEqual(len(meshes), 1, written)


class MaterialX(Usd):
    """The surface of the MaterialX context, beside the preview surface."""

    def _surface(self, material):
        from pxr import UsdShade

        output = material.GetSurfaceOutput("mtlx")
        return UsdShade.Shader(output.GetConnectedSources()[0][0].source.GetPrim())

    def _known(self, material):
        """All shaders and their inputs are those of USD's MaterialX library; their names."""
        from pxr import Sdr, UsdShade

        names = []
        for prim in material.GetPrim().GetChildren():
            shader = UsdShade.Shader(prim)
            if not shader.GetIdAttr().Get().startswith("ND_"):
                continue
            node = Sdr.Registry().GetNodeByIdentifier(shader.GetIdAttr().Get())
            self.assertIsNotNone(node, shader.GetIdAttr().Get())
            unknown = {each.GetBaseName() for each in shader.GetInputs()} - set(node.GetInputNames())
            self.assertEqual(unknown, set(), prim.GetName())
            names.append(prim.GetName())
        return names

    def test_a_brdf_is_fitted(self):
        data = inputs.model_bytes(inputs.plastic_measurement())
        self._model(data)
        material, _values, _stage = self._exported()
        self.assertEqual(self._known(material), ["Velour_OpenPBR"])
        surface = self._surface(material)
        self.assertEqual(surface.GetIdAttr().Get(), "ND_open_pbr_surface_surfaceshader")
        fits = inputs.module("core.analytic.open_pbr_fit")
        look = inputs.module("operators.approximation_look")
        start = look.fitted(group_of(self.material).node_tree)["principled"]
        with inputs.native().Model.from_bytes(data, "plastic") as model:
            found = fits.fitted_open_pbr(model, start)
        for name, value in found.material.inputs().items():
            np.testing.assert_allclose(
                surface.GetInput(name).Get(), value, rtol=1e-4, atol=1e-5, err_msg=name
            )
        self.assertIn(f"{found.errors['relative_l2']:.3f}", surface.GetPrim().GetDocumentation())

    def test_the_look_is_that_of_the_material(self):
        self._model(inputs.model_bytes(inputs.lambert_measurement()))
        colors = []
        for tint in ((1.0, 1.0, 1.0), (0.5, 0.25, 1.0)):
            scenes.set_look(self.material, tint=tint)
            material, _values, _stage = self._exported()
            colors.append(self._surface(material).GetInput("base_color").Get())
        np.testing.assert_allclose(np.divide(colors[1], colors[0]), (0.5, 0.25, 1.0), rtol=0.05)

    def test_a_tangent_turns(self):
        self._model(inputs.brushed_model())
        scenes.set_look(self.material, rotation=0.5)
        material, _values, _stage = self._exported()
        self.assertIn("Velour_Turned_Tangent", self._known(material))
        self._is_in_world_space(material)

    def _is_in_world_space(self, material):
        for name in ("Velour_Tangent", "Velour_Bitangent"):
            self.assertEqual(self._node(material, name).GetInput("space").Get(), "world")

    def _shares(self, material, name):
        """Shares of the tangent and the bitangent in a direction."""
        return [self._node(material, f"Velour_{name}_Part_{n}").GetInput("in2").Get() for n in (1, 2)]

    def test_a_roughness_map_is_connected(self):
        self._approximation(color_map=np.ones((4, 4, 4)), roughness_map=np.full((4, 4), 0.6))
        material, _values, _stage = self._exported()
        self.assertIn("Velour_MaterialX_Roughness", self._known(material))
        self.assertTrue(self._surface(material).GetInput("specular_roughness").HasConnectedSource())

    def test_normals_turn_with_the_tiles(self):
        tilted = np.broadcast_to(np.array((0.36, -0.48, 0.8)), (4, 4, 3))
        self._approximation(color_map=np.ones((4, 4, 4)), normal_map=tilted)
        material, _values, _stage = self._exported()
        self.assertNotIn("Velour_Tangent", self._known(material))
        scenes.set_look(self.material, rotation=0.5)
        material, _values, _stage = self._exported()
        self._known(material)
        self._is_in_world_space(material)
        cos, sin = np.cos(0.5), np.sin(0.5)
        np.testing.assert_allclose(self._shares(material, "Tangent"), (cos, sin), rtol=1e-5)
        np.testing.assert_allclose(self._shares(material, "Bitangent"), (-sin, cos), rtol=1e-5)
        for name in ("tangent", "bitangent"):
            self.assertTrue(self._node(material, "Velour_Relief").GetInput(name).HasConnectedSource())

    def test_images_are_connected_and_placed(self):
        self._model(inputs.quarters_model())
        placement = scenes.velour_node(self.material).velour.placement
        placement.repeats, placement.offset = (1.5, 2.0), (0.1, 0.2)
        scenes.set_look(self.material, rotation=0.4)
        material, _values, _stage = self._exported()
        self.assertIn("Velour_MaterialX_Color", self._known(material))
        named = self._node(material, "Velour_MaterialX_Color").GetInput("file").Get().path
        self.assertTrue((self.folder / named).exists())
        rows = [self._node(material, f"Velour_{axis}_Turned").GetInput("in2").Get() for axis in "XY"]
        start = [self._node(material, f"Velour_{axis}_Moved").GetInput("in2").Get() for axis in "XY"]
        moved, turn = np.array((0.7, -0.3)) - (0.1, 0.2), -0.4
        rotation = np.array(((np.cos(turn), -np.sin(turn)), (np.sin(turn), np.cos(turn))))
        expected = rotation @ moved * (1.5, 2.0)
        np.testing.assert_allclose(np.array(rows) @ (0.7, -0.3) + start, expected, rtol=1e-5)

    def test_a_surface_of_the_artist_s_own_stays(self):
        self._approximation()
        tree = self.material.node_tree
        mine = tree.nodes.new("ShaderNodeBsdfPrincipled")
        tree.links.new(mine.outputs[0], tree.nodes["Material Output"].inputs["Surface"])
        material, _values, _stage = self._exported()
        self.assertFalse(material.GetPrim().GetChild("Velour_OpenPBR"))


class Ends(Usd):
    def test_an_error_is_a_sentence(self):
        self._approximation()
        usd, said = module("approximation_usd"), []
        before, usd._inputs = usd._inputs, lambda parts: said.append(1) or parts["nothing"]
        try:
            self._exported()  # FINISHED
        finally:
            usd._inputs = before
        self.assertEqual(said, [1])

    def _export_in_a_blender(self, before):
        self._approximation()
        blend, path = self.folder / "scene.blend", self.folder / "child.usda"
        bpy.ops.wm.save_as_mainfile(filepath=str(blend))
        code = _EXPORT.format(before=before, blend=str(blend), path=str(path))
        done = run_blender("--python-exit-code", 1, "--python-expr", code, addons=False)
        self.assertEqual(done.returncode, 0, done.stdout)
        self.assertIn("EXPORTED", done.stdout)
        return path.read_text()

    def test_a_blender_that_has_exported_ends(self):
        """As a module 4.5 waits for ever where a hook is left registered; add-ons are switched off before."""
        self.assertIn("UsdPreviewSurface", self._export_in_a_blender(""))

    def test_without_usd_s_python_modules(self):
        """Any hook makes an export abort the process then; builds as a module may lack them."""
        self.assertNotIn("UsdPreviewSurface", self._export_in_a_blender('sys.modules["pxr"] = None'))


def _difference(picture, reference):
    return float(np.sqrt(((picture - reference) ** 2).mean() / (reference**2).mean()))
