"""The approximation of measured materials in glTF files."""

import contextlib
import io
import json
import sys
import types
from unittest import mock
from urllib.parse import unquote

import bpy
import numpy as np

from support import inputs, scenes
from test_approximation import Approximation, group_module, group_of

_TRANSFORM = "KHR_texture_transform"
_EXPORTER = "io_scene_gltf2.blender.exp"


def images_of(group):
    return inputs.module("operators.approximation_image").images_of(group)


def exporter():
    return inputs.module("operators.approximation_gltf")


class Files(Approximation):
    def _gltf(self, **options):
        """The file, as numbers and names."""
        bpy.ops.preferences.addon_enable(module="io_scene_gltf2")
        path = self.folder / "exported.gltf"
        bpy.ops.export_scene.gltf(filepath=str(path), export_format="GLTF_SEPARATE", **options)
        return json.loads(path.read_text())

    def _put(self, info, **changed):
        """Gives a new material an approximation of such values."""
        bpy.ops.velour.add_material()
        found = inputs.module("core.approximation").UNFITTED._replace(**changed)
        group_module().put(scenes.velour_node(self.material), self.material, found, info)

    def _put_maps(self, kind="texels", **principled):
        """A tile with all maps, of a BTF or, with "shell", of a VOTF; returns the one of roughness."""
        values = {**inputs.module("core.approximation").UNFITTED.principled, **principled}
        rough = np.linspace(0.2, 0.8, 16, dtype=np.float32).reshape(4, 4)
        normals = np.broadcast_to(np.array((0.36, -0.48, 0.8), np.float32), (4, 4, 3))
        colors = np.full((4, 4, 4), (0.2, 0.5, 0.3, 1), np.float32)
        maps = {"color_map": colors, "normal_map": normals, "roughness_map": rough}
        self._put({kind: (4, 4)}, principled=values, **maps)
        return rough

    def test_files_carry_it(self):
        self._import(self._model_file(inputs.model_bytes(inputs.plastic_measurement())))
        scenes.set_look(self.material, tint=(0.5, 0.9, 1.0))
        shown = inputs.module("operators.approximation_look").shown(self.material)
        (written,) = self._gltf()["materials"]
        pbr = written["pbrMetallicRoughness"]
        np.testing.assert_allclose(pbr["baseColorFactor"][:3], shown.principled["base_color"], 1e-5)
        for name in ("metallic", "roughness"):
            self.assertAlmostEqual(pbr.get(f"{name}Factor", 1.0), shown.principled[name], 5)

    def test_files_carry_the_image_of_a_btf(self):
        self._import(self._model_file(inputs.quarters_model()))
        written = self._gltf()
        (material,), (image,) = written["materials"], written["images"]
        self.assertEqual(material["pbrMetallicRoughness"]["baseColorTexture"]["index"], 0)
        picture = scenes.read(self.folder / unquote(image["uri"]))
        ours = images_of(group_of(self.material).node_tree).colors
        self.assertEqual(picture.shape[:2], tuple(ours.size)[::-1])
        self.assertGreater(picture[..., :3].std(), 0.05)

    def test_files_carry_normals(self):
        self._import(self._model_file(inputs.weave_model()))
        written = self._gltf()
        (material,) = written["materials"]
        textures = material["pbrMetallicRoughness"]["baseColorTexture"], material["normalTexture"]
        self.assertNotIn("scale", textures[1])
        images = [written["textures"][texture["index"]]["source"] for texture in textures]
        self.assertNotEqual(*images)
        path = self.folder / unquote(written["images"][images[1]]["uri"])
        picture = bpy.data.images.load(str(path), check_existing=False)
        picture.colorspace_settings.is_data = True
        ours = images_of(group_of(self.material).node_tree).normals
        np.testing.assert_allclose(picture.pixels, ours.pixels, atol=1.5 / 255)
        self.assertGreater(np.std(np.array(ours.pixels).reshape(-1, 4)[:, 0]), 0.05)

    def test_files_of_what_is_flat_carry_none(self):
        self._import(self._model_file(inputs.quarters_model()))
        self.assertNotIn("normalTexture", self._gltf()["materials"][0])

    def test_all_images_lie_as_they_do(self):
        self._put_maps(coat=0.3)
        placement = scenes.velour_node(self.material).velour.placement
        placement.repeats, placement.offset = (2.0, 2.0), (0.1, 0.2)
        scenes.set_look(self.material, rotation=0.4, scale=0.5)
        copy = self.material.copy()  # with the same group, elsewhere
        scenes.velour_node(copy).velour.placement.repeats = 3.0, 3.0
        scenes.add_plane(copy)
        written = self._gltf()
        self.assertNotIn(_TRANSFORM, written.get("extensionsRequired", []))
        expected = {self.material.name: 4.0, copy.name: 6.0}
        self.assertEqual({each["name"] for each in written["materials"]}, set(expected))
        for material in written["materials"]:
            repeats = expected[material["name"]]
            pbr = material["pbrMetallicRoughness"]
            coat = material["extensions"]["KHR_materials_clearcoat"]
            coated = [coat[name] for name in coat if name.endswith("Texture")]  # in Blender 4.1 and newer
            images = pbr["baseColorTexture"], pbr["metallicRoughnessTexture"], material["normalTexture"]
            for info in (*images, *coated):
                found = info["extensions"][_TRANSFORM]
                np.testing.assert_allclose(found["scale"], (repeats, repeats), rtol=1e-5)
                self.assert_close(found["rotation"], -0.4, 1e-5)
                cos, sin = np.cos(-0.4), np.sin(-0.4)
                u, v = 0.1 * repeats, (1 - 0.2) * repeats  # the corner of a tile, v downward
                corner = np.array((cos * u + sin * v, cos * v - sin * u)) + found["offset"]
                np.testing.assert_allclose(corner, (0, 1), atol=1e-5)

    def test_tiles_that_would_be_sheared_are_reported(self):
        self._put_maps()
        scenes.velour_node(self.material).velour.placement.repeats = 1.0, 2.0
        scenes.set_look(self.material, rotation=0.4)
        said = io.StringIO()
        with contextlib.redirect_stdout(said):
            self._gltf()
        self.assertIn(f"material '{self.material.name}' are scaled to the nearest shape", said.getvalue())

    def test_unplaced_tiles_have_no_transform(self):
        self._put_maps()
        written = self._gltf()
        self.assertNotIn(_TRANSFORM, json.dumps(written))

    def test_tiles_are_on_the_uv_map_of_their_placement(self):
        self._put_maps()
        self.obj.data.uv_layers.new(name="Second")
        scenes.velour_node(self.material).velour.placement.uv_map = "Second"
        (material,) = self._gltf()["materials"]
        pbr = material["pbrMetallicRoughness"]
        for info in (pbr["baseColorTexture"], pbr["metallicRoughnessTexture"], material["normalTexture"]):
            self.assertEqual(info["texCoord"], 1)

    def test_a_roughness_map_is_not_multiplied_by_its_mean(self):
        rough = self._put_maps()
        written = self._gltf()
        pbr = written["materials"][0]["pbrMetallicRoughness"]
        self.assertEqual(pbr.get("roughnessFactor", 1.0), 1.0)
        source = written["textures"][pbr["metallicRoughnessTexture"]["index"]]["source"]
        path = self.folder / unquote(written["images"][source]["uri"])
        picture = bpy.data.images.load(str(path), check_existing=False)
        picture.colorspace_settings.is_data = True
        texels = np.array(picture.pixels).reshape(4, 4, 4)
        np.testing.assert_allclose(texels[..., 1], rough, atol=1.5 / 255)
        np.testing.assert_allclose(texels[..., 2], 1, atol=1.5 / 255)  # metallic

    def test_a_roughness_offset_replaces_the_map(self):
        self._put_maps("shell")
        scenes.set_look(self.material, roughness=0.5)
        pbr = self._gltf()["materials"][0]["pbrMetallicRoughness"]
        self.assertNotIn("metallicRoughnessTexture", pbr)
        shown = inputs.module("operators.approximation_look").shown(self.material)
        self.assert_close(pbr["roughnessFactor"], shown.principled["roughness"], 1e-5)

    def test_files_carry_coat_and_specular_reflection(self):
        core = inputs.module("core.approximation")
        paint = {**core.UNFITTED.principled, "specular": 0.3, "coat": 0.4, "coat_roughness": 0.1}
        maps = {"color_map": np.ones((4, 4, 4)), "normal_map": np.full((4, 4, 3), 3**-0.5)}
        for changed in ({}, maps):
            self._put({"texels": (4, 4)} if changed else {"isotropic": True}, principled=paint, **changed)
            found = self._gltf()["materials"][0]["extensions"]
            coat = found["KHR_materials_clearcoat"]
            self.assert_close(coat["clearcoatFactor"], 0.4, 1e-5)
            self.assert_close(coat["clearcoatRoughnessFactor"], 0.1, 1e-5)
            self.assert_close(found["KHR_materials_specular"]["specularFactor"], 0.6, 1e-5)

    def test_files_without_images_have_the_mean_color(self):
        core = inputs.module("core.approximation")
        paint = {**core.UNFITTED.principled, "base_color": (0.2, 0.5, 0.3)}
        self._put({"texels": (4, 4)}, principled=paint, color_map=np.ones((4, 4, 4), np.float32))
        pbr = self._gltf(export_image_format="NONE")["materials"][0]["pbrMetallicRoughness"]
        np.testing.assert_allclose(pbr["baseColorFactor"][:3], (0.2, 0.5, 0.3), rtol=1e-5)
        self.assertNotIn("baseColorTexture", pbr)

    def test_a_metal_over_a_diffuse_base_has_the_color_of_the_base(self):
        core = inputs.module("core.approximation")
        metal = {**core.UNFITTED.principled, "base_color": (0.03, 0.03, 0.03), "metallic": 1.0}
        self._put({"isotropic": False}, principled=metal, anisotropic=0.5, diffuse=(0.6, 0.1, 0.1))
        pbr = self._gltf()["materials"][0]["pbrMetallicRoughness"]
        np.testing.assert_allclose(pbr["baseColorFactor"][:3], (0.6, 0.1, 0.1), rtol=1e-5)
        self.assertEqual(pbr["metallicFactor"], 0.0)

    def test_colors_are_those_of_rec_709(self):
        halved = mock.patch.object(exporter(), "working_to_rec709", lambda color: [c / 2 for c in color[:3]])
        for name, put in (
            ("color", lambda: self._put({"isotropic": True})),
            ("tint of an image", self._put_maps),
        ):
            put()
            written = []
            for space in (contextlib.nullcontext(), halved):
                with self.subTest(name), space:
                    pbr = self._gltf()["materials"][0]["pbrMetallicRoughness"]
                    written.append(np.array(pbr.get("baseColorFactor", [1.0] * 4)[:3]))
            np.testing.assert_allclose(written[1], written[0] / 2, rtol=1e-5)


class Exporters(Approximation):
    """Where the exporters of other Blenders have the function that gathers images."""

    def test_it_is_found_in_each(self):
        older, newer = (f"{_EXPORTER}.{part}gltf2_blender_gather_texture_info" for part in ("", "material."))
        infos = types.SimpleNamespace(gather=lambda *arguments: (arguments, "UV map"))
        for name, modules, found in (
            ("3.4 and 3.5", {newer: None, older: infos}, ("a", ("a", "b"), {})),
            ("3.6 and 4.0", {newer: infos, older: None}, ("a", ("a", "b"), {})),
            ("newer, which need none", {newer: None, older: None}, None),
        ):
            with self.subTest(name), mock.patch.dict(sys.modules, modules):
                self.assertEqual(exporter()._texture("gather", ("a", "b"), {}), found)
