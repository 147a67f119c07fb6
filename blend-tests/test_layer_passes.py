"""Passes as artists use them: in files, in the compositor, by the nodes that take them."""

import contextlib
import io
import json

import bpy
import numpy as np

from support import inputs, scenes
from support.blender import BlenderTest

_SWITCHES = ("z", "mist", "position", "normal", "vector", "uv", "object_index", "material_index")
_SWITCHES += ("cryptomatte_object", "cryptomatte_material", "cryptomatte_asset")
_OWN_SWITCHES = ("denoising", "albedo", "error", "sample_count")
# Channels that the file has when the switches are on.
_CHANNELS = ("Depth.Z", "Mist.Z", "Position.X", "Normal.Z", "Vector.W", "UV.A", "IndexOB.X", "IndexMA.X")
_CHANNELS += ("Denoising Normal.X", "Denoising Albedo.R", "Albedo.B", "Error.G", "Sample Count.X")
_SINCE_5 = {"IndexOB.X": "Object Index.X", "IndexMA.X": "Material Index.X"}
_CRYPTO = tuple(
    f"Crypto{kind}{level:02d}.{c}"
    for kind in ("Object", "Material", "Asset")
    for level in (0, 1)
    for c in "rgba"
)


_HALF, _FLOAT = 1, 2  # kinds of OpenEXR's channels


class PassesTest(BlenderTest):
    def setUp(self):
        super().setUp()
        self.scene = scenes.use_engine(samples=64)
        self.layer = bpy.context.view_layer
        scenes.add_camera(ortho_scale=4)
        scenes.set_world()

    def switch_on(self, *names):
        for name in names:
            setattr(self.layer.velour if name in _OWN_SWITCHES else self.layer, f"use_pass_{name}", True)
        self.layer.update_render_passes()

    def layers_file(self, bits="32", codec="ZIP"):
        """The scene as a multilayer file."""
        self.layer.pass_cryptomatte_depth = 4
        settings = self.scene.render.image_settings
        if hasattr(settings, "media_type"):  # 5.0 and newer
            settings.media_type = "MULTI_LAYER_IMAGE"
        settings.file_format, settings.color_depth = "OPEN_EXR_MULTILAYER", bits
        settings.exr_codec = codec
        path = self.folder / f"layers-{bits}-{codec}.exr"
        self.scene.render.filepath = str(path)
        bpy.ops.render.render(write_still=True)
        if hasattr(settings, "media_type"):
            settings.media_type = "IMAGE"
        return path

    def shown(self, name):
        if not hasattr(self, "_show"):
            self._show = scenes.composite(self.scene)
            self.layer.update_render_passes()
        self._show(name)
        return scenes.render(self.folder, name)


class Files(PassesTest):
    def test_every_pass_is_in_a_multilayer_file(self):
        scenes.add_sphere(scenes.diffuse_material())
        self.switch_on(*_SWITCHES, *_OWN_SWITCHES)
        header = self.layers_file().read_bytes()[:20000]
        newer = bpy.app.version >= (5, 0)
        for channel in _CHANNELS:
            name = _SINCE_5.get(channel, channel) if newer else channel
            self.assertIn(name.encode() + b"\0", header)
        for channel in _CRYPTO:
            self.assertIn(channel.encode() + b"\0", header)
        self.assertNotIn(b"CryptoObject02", header)

    def test_only_colors_are_halved(self):
        """Half floats would change ids, round indices above 2048 and make positions jump."""
        scenes.add_sphere(scenes.diffuse_material())
        self.switch_on(*_SWITCHES, *_OWN_SWITCHES)
        kinds = _kinds(self.layers_file(bits="16"))
        halved = {channel.split(".")[-2] for channel, kind in kinds.items() if kind == _HALF}
        self.assertEqual(halved, {"Combined", "Albedo", "Denoising Albedo", "Error"})
        self.assertEqual(set(kinds.values()), {_HALF, _FLOAT})

    def test_nothing_is_there_that_is_off(self):
        scenes.add_sphere(scenes.diffuse_material())
        header = self.layers_file().read_bytes()[:20000]
        for channel in (*_CHANNELS[1:], *_SINCE_5.values(), *_CRYPTO):
            self.assertNotIn(channel.encode() + b"\0", header)

    def test_manifest(self):
        """Names that JSON escapes, and others of several bytes."""
        names = ['A "quoted" name', "Grün", "\\"]
        for name in names:
            scenes.add_plane(scenes.diffuse_material(name=f"Of {name}")).name = name
        self.switch_on("cryptomatte_object", "cryptomatte_material")
        header = inputs.native().images.header(self.layers_file())
        fields = {key: text for key, text in header["texts"].items() if key.startswith("cryptomatte/")}
        found = {}
        for key in {field.split("/")[1] for field in fields}:
            self.assertRegex(key, "^[0-9a-f]{7}$")
            name = fields[f"cryptomatte/{key}/name"]
            self.assertEqual(key, f"{inputs.native().cryptomatte_id(name).hash:08x}"[:7])
            self.assertEqual(fields[f"cryptomatte/{key}/hash"], "MurmurHash3_32")
            self.assertEqual(fields[f"cryptomatte/{key}/conversion"], "uint32_to_float32")
            found[name] = json.loads(fields[f"cryptomatte/{key}/manifest"])
        self.assertEqual(set(found), {f"{self.layer.name}.{p}" for p in ("CryptoObject", "CryptoMaterial")})
        ids = {name: inputs.native().cryptomatte_id(name).text for name in names}
        self.assertEqual(found[f"{self.layer.name}.CryptoObject"], ids)
        self.assertEqual(set(found[f"{self.layer.name}.CryptoMaterial"]), {f"Of {name}" for name in names})


def _kinds(path):
    """Kinds of the channels of an OpenEXR file of one part or several, by name."""
    found = {}
    for channels in path.read_bytes()[:20000].split(b"channels\0chlist\0")[1:]:
        rest = channels[4:]
        while rest[0]:
            name, _, rest = rest.partition(b"\0")
            found[name.decode()] = int.from_bytes(rest[:4], "little")
            rest = rest[16:]
    return found


class Missing(PassesTest):
    def _said(self):
        scenes.add_sphere(scenes.diffuse_material())
        said = io.StringIO()
        with contextlib.redirect_stdout(said):
            scenes.render(self.folder)
        return said.getvalue()

    def test_what_velour_does_not_make_is_named(self):
        self.switch_on("diffuse_color", "ambient_occlusion")
        self.layer.aovs.add()
        said = self._said()
        for words in ("pass Diffuse Color", "pass Ambient Occlusion", "shader AOVs"):
            self.assertIn(f"{words} ", said)

    def test_what_it_makes_is_not(self):
        self.switch_on(*_SWITCHES, *_OWN_SWITCHES)
        self.assertNotIn("left out", self._said())


class Compositor(PassesTest):
    def test_sockets_follow_the_switches(self):
        scenes.composite(self.scene)
        source = next(
            n for n in scenes.compositor(self.scene).nodes if n.bl_idname == "CompositorNodeRLayers"
        )
        self.assertFalse("Denoising Albedo" in source.outputs and source.outputs["Denoising Albedo"].enabled)
        self.layer.velour.use_pass_denoising = True
        for name in ("Denoising Normal", "Denoising Albedo"):
            self.assertTrue(source.outputs[name].enabled)

    def test_albedo(self):
        """The share of light, whatever the light; of nothing 0, for denoisers what the sky shines there."""
        scenes.add_plane(scenes.diffuse_material((0.2, 0.5, 0.8)))
        self.scene.world.node_tree.nodes["Background"].inputs["Strength"].default_value = 0.1
        self.switch_on("albedo", "denoising")
        for name, sky in (("Albedo", 0), ("Denoising Albedo", 0.1)):
            pixels = self.shown(name)
            np.testing.assert_allclose(scenes.middle(pixels), (0.2, 0.5, 0.8), atol=2e-3)
            np.testing.assert_allclose(pixels[0, 0, :3], sky, rtol=1e-6)
            self.assertLessEqual(pixels.max(), 1.0)
        normal = self.shown("Denoising Normal")
        np.testing.assert_allclose(scenes.middle(normal), (0, 0, -1), atol=1e-6)  # along the camera's axes

    def test_samples_of_the_layer(self):
        scenes.add_plane()
        self.switch_on("sample_count")
        split = self.scene.velour.split
        self.assertGreater(split, 1)
        for own, count in ((0, 64), (16, 16 * split)):  # camera rays, as in Render > Samples
            self.layer.samples = own
            np.testing.assert_array_equal(self.shown("Sample Count")[..., 0], count)

    def test_error_follows_exposure_and_samples(self):
        scenes.add_plane(scenes.diffuse_material())
        lamp = bpy.data.objects.new("Lamp", bpy.data.lights.new("Lamp", "AREA"))
        lamp.location, lamp.data.size = (0, 0, 0.5), 2
        self.scene.collection.objects.link(lamp)
        self.scene.velour.split = 1
        self.switch_on("error")
        few = scenes.middle(self.shown("Error")).mean()
        self.scene.velour.samples *= 16
        many = scenes.middle(self.shown("Error")).mean()
        self.assertGreater(few, 0)
        self.assert_close(many / few, 0.25, 0.05)
        bpy.ops.preferences.addon_enable(module="cycles")
        self.scene.cycles.film_exposure = 3
        self.assert_close(scenes.middle(self.shown("Error")).mean() / many, 3, 1e-3)

    def test_denoise_node(self):
        """With its two passes it comes nearer to what many samples show."""
        scenes.add_sphere(scenes.diffuse_material())
        scenes.add_plane(scenes.diffuse_material((0.8, 0.4, 0.2)), size=8).location.z = -1
        truth = self._picture(samples=4096)
        self.switch_on("denoising")
        noisy = self._picture(samples=4)
        self._denoise()
        clean = scenes.render(self.folder, "clean")
        if np.array_equal(clean, noisy):
            self.skipTest("This Blender is built without OpenImageDenoise.")
        errors = [float(np.square(p[..., :3] - truth[..., :3]).mean()) for p in (noisy, clean)]
        self.assertLess(errors[1], 0.5 * errors[0])

    def _picture(self, samples):
        self.scene.velour.samples = samples
        return scenes.render(self.folder, f"of{samples}")

    def _denoise(self):
        scenes.composite(self.scene)("Image")
        tree = scenes.compositor(self.scene)
        source = next(node for node in tree.nodes if node.bl_idname == "CompositorNodeRLayers")
        sink = next(link.to_socket for link in tree.links if link.from_node == source)
        denoise = tree.nodes.new("CompositorNodeDenoise")
        for name, passed in (
            ("Image", "Image"),
            ("Normal", "Denoising Normal"),
            ("Albedo", "Denoising Albedo"),
        ):
            tree.links.new(source.outputs[passed], denoise.inputs[name])
        tree.links.new(denoise.outputs[0], sink)


class UvMaps(PassesTest):
    """The UV map that renders, whatever the material looks at."""

    def setUp(self):
        super().setUp()
        self.plane = scenes.add_plane(scenes.diffuse_material())
        other = self.plane.data.uv_layers.new(name="Other")
        for corner in other.data:
            corner.uv = (corner.uv.y * 3, 0.25)
        self.switch_on("uv")

    def _assert_first_map(self):
        pixels = self.shown("UV")
        places = (np.arange(scenes.SIZE) + 0.5) / scenes.SIZE * 2 - 0.5  # of the plane from 0 to 1
        inside = slice(scenes.SIZE // 4 + 1, 3 * scenes.SIZE // 4 - 1)
        expected = np.broadcast_to(places[inside], (scenes.SIZE // 2 - 2,) * 2)
        np.testing.assert_allclose(pixels[inside, inside, 0], expected, atol=2e-3)
        np.testing.assert_allclose(pixels[inside, inside, 1], expected.T, atol=2e-3)
        np.testing.assert_array_equal(pixels[inside, inside, 2], 1)
        np.testing.assert_array_equal(pixels[0, 0, :3], 0)

    def test_of_a_uniform_material(self):
        self._assert_first_map()

    def test_of_a_picture_on_another_map(self):
        tree = self.plane.active_material.node_tree
        picture, uv_map = tree.nodes.new("ShaderNodeTexImage"), tree.nodes.new("ShaderNodeUVMap")
        picture.image, uv_map.uv_map = bpy.data.images.new("Picture", 8, 8), "Other"
        tree.links.new(uv_map.outputs[0], picture.inputs[0])
        tree.links.new(picture.outputs[0], tree.nodes["Diffuse BSDF"].inputs["Color"])
        self._assert_first_map()

    def test_of_a_mesh_without_any(self):
        while self.plane.data.uv_layers:
            self.plane.data.uv_layers.remove(self.plane.data.uv_layers[0])
        np.testing.assert_array_equal(self.shown("UV")[..., :3], 0)


class Cryptomatte(PassesTest):
    def test_holes_of_an_outline_are_no_part_of_it(self):
        """Where the net of threads is, and nowhere else: the very alpha."""
        self.scene.render.film_transparent = True
        bpy.ops.velour.add_mesostructure(type="NET", count=2, resolution=8)
        tile = bpy.context.object
        tile.hide_render = True
        material = scenes.measured_material(inputs.model_bytes(inputs.lambert_measurement((0.5, 0.5, 0.5))))
        cloth = scenes.add_plane(material)
        cloth.name = "Cloth"
        for corner in cloth.data.uv_layers.active.data:  # tiles a quarter of a metre wide
            corner.uv *= 8
        bpy.ops.velour.add_votf(material=material.name, structure=tile.name, texels=48)
        self.switch_on("cryptomatte_object")
        alpha = scenes.render(self.folder)[..., 3]
        self.assertLess(scenes.middle(np.dstack([alpha] * 3)).max(), 0.9)
        self.assertGreater(alpha.max(), 0.1)
        np.testing.assert_allclose(self._picked("Cloth"), alpha, atol=1e-6)

    def test_node_picks_a_hair_thin_net(self):
        """Wires of a twentieth of a pixel over a plane."""
        scenes.add_plane(scenes.diffuse_material(), size=8).name = "Behind"
        net, width = self._net(), 0.05 * 4 / scenes.SIZE
        self.scene.velour.samples, self.scene.velour.split = 512, 1
        self.switch_on("cryptomatte_object")
        matte = self._picked("Net")
        expected = 2 * width * 4 / (4 * 4)  # two wires across the picture, less where they cross
        self.assert_close(matte.mean(), expected, 0.1 * expected)
        self.assertLess(matte.max(), 0.2)
        self.assert_close(self._picked("Behind").mean(), 1 - expected, 0.1 * expected)
        self.assertEqual(net.name, "Net")

    def test_ids_come_through_small_files(self):
        """From files of half floats, even if a codec rounds colors, the node picks as from the render."""
        self._net()
        scenes.add_plane(scenes.diffuse_material(), size=8).name = "Behind"
        self.switch_on("cryptomatte_object")
        for codec in ("ZIP", "DWAA"):
            path = self.layers_file(bits="16", codec=codec)
            for name in ("Net", "Behind"):
                picked = self._picked(name)
                self.assertGreater(picked.max(), 0.01)
                np.testing.assert_array_equal(self._picked(name, path), picked, f"{codec}, {name}")

    def _net(self):
        """Two crossed wires."""
        half = 0.025 * 4 / scenes.SIZE
        points, faces = [], []
        for low, high in (((-half, -4), (half, 4)), ((-4, -half), (4, half))):
            x, y = 0.03, 0.04  # off the pixels' borders
            points += [(low[0] + x, low[1] + y, 1), (high[0] + x, low[1] + y, 1)]
            points += [(high[0] + x, high[1] + y, 1), (low[0] + x, high[1] + y, 1)]
            faces.append(tuple(range(len(points) - 4, len(points))))
        mesh = bpy.data.meshes.new("Net")
        mesh.from_pydata(points, [], faces)
        net = bpy.data.objects.new("Net", mesh)
        self.scene.collection.objects.link(net)
        return net

    def _picked(self, name, path=None):
        """What the compositor's Cryptomatte node makes of the render, or of a file, given a name."""
        scenes.composite(self.scene)("Image")
        tree = scenes.compositor(self.scene)
        sink = next(link.to_socket for link in tree.links)
        node = tree.nodes.new("CompositorNodeCryptomatteV2")
        node.source, node.scene = "RENDER", self.scene
        if path:
            node.source, node.image = "IMAGE", bpy.data.images.load(str(path))
        node.layer_name = f"{self.layer.name}.CryptoObject"
        node.matte_id = name
        tree.links.new(node.outputs["Matte"], sink)
        return scenes.render(self.folder, f"matte-{name}")[..., 0]
