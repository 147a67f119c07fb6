"""UV maps and pictures on surfaces."""

import functools
import math
import struct
import zlib

import bpy
import numpy as np

from parity import stage
from parity.board import BoardTest
from parity.case import ParityTest


class WallTest(ParityTest):
    """A wall with two UV maps, one turned and twice as dense."""

    def setUp(self):
        super().setUp()
        stage.camera((0, -6, 0), (math.pi / 2, 0, 0))
        stage.world()
        self.material = stage.gray(0.5)
        self.wall = stage.mesh(
            [(-1.5, 0, -1), (1.5, 0, -1), (1.5, 0, 1), (-1.5, 0, 1)], [(0, 1, 2, 3)], self.material
        )
        uv = np.array([(0, 0), (1, 0), (1, 1), (0, 1)], np.float32)
        for name, values in (("first", uv), ("second", 2 * uv[:, ::-1] + 0.25)):
            layer = self.wall.data.uv_layers.new(name=name)
            layer.data.foreach_set("uv", values.ravel())

    def _node(self, image, interpolation="Closest"):
        """Shows the colors of `image` on the wall."""
        tree = self.material.node_tree
        node = tree.nodes.new("ShaderNodeTexImage")
        node.image, node.interpolation = image, interpolation
        shader = next(n for n in tree.nodes if n.bl_idname == "ShaderNodeBsdfDiffuse")
        tree.links.new(node.outputs[0], shader.inputs["Color"])
        return node


class UvMaps(WallTest):
    def _picture(self, interpolation="Linear", is_float=True):
        image = bpy.data.images.new("checker", 8, 8, float_buffer=is_float)
        pixels = np.random.default_rng(2).uniform(0.1, 0.9, (8, 8, 4)).astype(np.float32)
        pixels[..., 3] = 1
        image.pixels.foreach_set(pixels.ravel())
        image.pack()
        return self._node(image, interpolation)

    def _uv_map(self, node, name):
        tree = self.material.node_tree
        source = tree.nodes.new("ShaderNodeUVMap")
        source.uv_map = name
        tree.links.new(source.outputs[0], node.inputs["Vector"])

    def test_active(self):
        self._picture("Closest")
        self.assert_parity("UV maps: the one that renders")

    def test_second_renders(self):
        self._picture("Closest")
        self.wall.data.uv_layers["second"].active_render = True
        self.assert_parity("UV maps: another one renders")

    def test_named(self):
        self._uv_map(self._picture("Closest"), "second")
        self.assert_parity("UV maps: chosen by a UV Map node")

    def test_mapping(self):
        """Location, rotation and scale of each type of Mapping."""
        tree = self.material.node_tree
        picture = self._picture("Closest")
        mapping, source = tree.nodes.new("ShaderNodeMapping"), tree.nodes.new("ShaderNodeTexCoord")
        tree.links.new(source.outputs["UV"], mapping.inputs["Vector"])
        tree.links.new(mapping.outputs[0], picture.inputs["Vector"])
        mapping.inputs["Location"].default_value = (0.3, -0.2, 0)
        mapping.inputs["Rotation"].default_value = (0, 0, 0.7)
        mapping.inputs["Scale"].default_value = (1.5, -0.6, 1)
        for kind in ("POINT", "TEXTURE", "VECTOR"):
            with self.subTest(kind):
                mapping.vector_type = kind
                self.assert_parity(f"Image Texture: {kind.lower()} mapping")

    def test_two_at_once(self):
        """Colors on one UV map, the factor of a mix on the other; both are magnified pictures."""
        tree = self.material.node_tree
        color, factor = self._picture("Closest"), self._picture("Closest")
        self._uv_map(factor, "second")
        shader = next(n for n in tree.nodes if n.bl_idname == "ShaderNodeBsdfDiffuse")
        tree.links.new(color.outputs[0], shader.inputs["Color"])
        other, mix = tree.nodes.new("ShaderNodeBsdfDiffuse"), tree.nodes.new("ShaderNodeMixShader")
        other.inputs["Color"].default_value = (0.1, 0.2, 0.6, 1)
        tree.links.new(factor.outputs[0], mix.inputs[0])
        tree.links.new(shader.outputs[0], mix.inputs[1])
        tree.links.new(other.outputs[0], mix.inputs[2])
        tree.links.new(mix.outputs[0], tree.nodes["Material Output"].inputs["Surface"])
        self.assert_parity("UV maps: two in one material")

    def test_two_slots(self):
        """Each material has its pictures on a UV map of its own."""
        self._uv_map(self._picture("Closest"), "second")
        self.wall.data.materials.append(self.material.copy())
        other = self.wall.data.materials[1].node_tree
        next(n for n in other.nodes if n.bl_idname == "ShaderNodeUVMap").uv_map = "first"
        mesh = self.wall.data
        mesh.clear_geometry()
        mesh.from_pydata(
            [(-1.5, 0, -1), (0, 0, -1), (0, 0, 1), (-1.5, 0, 1), (1.5, 0, -1), (1.5, 0, 1)],
            [],
            [(0, 1, 2, 3), (1, 4, 5, 2)],
        )
        mesh.polygons.foreach_set("material_index", [0, 1])
        uv = np.array([(0, 0), (1, 0), (1, 1), (0, 1)] * 2, np.float32)
        for name, values in (("first", uv), ("second", 2 * uv[:, ::-1] + 0.25)):
            (mesh.uv_layers.get(name) or mesh.uv_layers.new(name=name)).data.foreach_set("uv", values.ravel())
        self.assert_parity("UV maps: one for each slot")

    def test_linear(self):
        self._picture()
        self.assert_parity("Image Texture: linear")

    def test_linear_bytes(self):
        """Cycles interpolates bytes, which are sRGB."""
        self._picture(is_float=False)
        self.assert_parity("Image Texture: linear, sRGB")

    def test_linear_number(self):
        """The brightness of an sRGB picture as a factor."""
        tree = self.material.node_tree
        picture = self._picture(is_float=False)
        other, mix = tree.nodes.new("ShaderNodeEmission"), tree.nodes.new("ShaderNodeMixShader")
        shader = next(n for n in tree.nodes if n.bl_idname == "ShaderNodeBsdfDiffuse")
        tree.links.new(picture.outputs[0], mix.inputs[0])
        tree.links.new(shader.outputs[0], mix.inputs[1])
        tree.links.new(other.outputs[0], mix.inputs[2])
        tree.links.new(mix.outputs[0], tree.nodes["Material Output"].inputs["Surface"])
        self.assert_parity("Image Texture: linear, sRGB, as a number")


class Alpha(WallTest):
    """Pictures that are see-through in part, with and without the alpha being looked at."""

    def _shown(self, is_float, mode, interpolation="Closest"):
        image = bpy.data.images.new("veil", 8, 8, alpha=True, float_buffer=is_float)
        pixels = np.random.default_rng(5).uniform(0.2, 0.9, (8, 8, 4)).astype(np.float32)
        if is_float:
            pixels[..., :3] *= pixels[..., 3:]
        else:
            # Cycles cuts off what color times alpha is beyond whole bytes; of these nothing is.
            pixels = np.round(pixels * 51) * 5 / 255
            pixels[..., 3] = np.round(pixels[..., 3] * 5) / 5
        image.pixels.foreach_set(pixels.ravel())
        image.alpha_mode = mode
        image.pack()
        return self._node(image, interpolation)

    def _cut_out(self, node):
        """Where the picture is see-through, so is the wall."""
        tree = self.material.node_tree
        mix, clear = tree.nodes.new("ShaderNodeMixShader"), tree.nodes.new("ShaderNodeBsdfTransparent")
        surface = tree.nodes["Material Output"].inputs["Surface"]
        tree.links.new(node.outputs["Alpha"], mix.inputs[0])
        tree.links.new(clear.outputs[0], mix.inputs[1])
        tree.links.new(surface.links[0].from_socket, mix.inputs[2])
        tree.links.new(mix.outputs[0], surface)

    def test_bytes(self):
        self._shown(False, "STRAIGHT")
        self.assert_parity("Image Texture: alpha of bytes, not looked at")

    def test_cut_out_bytes(self):
        self._cut_out(self._shown(False, "STRAIGHT"))
        self.assert_parity("Image Texture: alpha of bytes, cut out")

    def test_floats(self):
        self._shown(True, "PREMUL")
        self.assert_parity("Image Texture: alpha of floats, not looked at")

    def test_cut_out_floats(self):
        self._cut_out(self._shown(True, "PREMUL"))
        self.assert_parity("Image Texture: alpha of floats, cut out")

    def test_channel_packed(self):
        self._cut_out(self._shown(False, "CHANNEL_PACKED"))
        self.assert_parity("Image Texture: alpha is a channel of its own, cut out")

    def test_none(self):
        self._cut_out(self._shown(False, "NONE"))
        self.assert_parity("Image Texture: no alpha")

    def test_linear_cut_out(self):
        """Cycles divides by alpha, and decodes sRGB, between texels."""
        for is_float, mode in ((True, "PREMUL"), (False, "STRAIGHT")):
            with self.subTest(mode):
                self._cut_out(self._shown(is_float, mode, "Linear"))
                self.assert_parity(f"Image Texture: alpha, cut out, linear, {mode.lower()}")


def gray_alpha_png(values):
    """A PNG file of gray and alpha, 8 bits each, of [height x width x 2] values."""
    height, width, _ = values.shape
    rows = b"".join(b"\0" + row.tobytes() for row in np.rint(255 * values).astype(np.uint8))

    def chunk(name, content):
        return (
            struct.pack(">I", len(content)) + name + content + struct.pack(">I", zlib.crc32(name + content))
        )

    header = chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 4, 0, 0, 0))
    return b"\x89PNG\r\n\x1a\n" + header + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


def tiff(values, alpha):
    """A TIFF file of one strip. `values`: [height x width x channels]; `alpha`: 0 none, 2 straight."""
    height, width, channels = values.shape
    bits, kind = 8 * values.dtype.itemsize, 3 if values.dtype.kind == "f" else 1
    tags = [(256, 3, width), (257, 3, height), (259, 3, 1), (262, 3, 2 if channels > 2 else 1)]
    tags += [(277, 3, channels), (278, 3, height), (279, 4, values.nbytes)] + (
        [(338, 3, alpha)] if alpha else []
    )
    arrays = {258: bits, 339: kind}
    start = 8 + 2 + 12 * (len(tags) + 3) + 4
    tags.append((273, 4, start + 4 * channels))
    entries, tail = [(tag, kind, 1, value) for tag, kind, value in tags], b""
    for tag, value in arrays.items():
        packed = struct.pack(f"<{channels}H", *[value] * channels)
        place = start + len(tail) if channels > 2 else int.from_bytes(packed, "little")
        entries.append((tag, 3, channels, place))
        tail += packed if channels > 2 else bytes(2 * channels)
    directory = b"".join(struct.pack("<HHII", *entry) for entry in sorted(entries))
    head = struct.pack("<2sHIH", b"II", 42, 8, len(entries))
    return head + directory + bytes(4) + tail + values.tobytes()


class AlphaModes(BoardTest):
    """Images with alpha in .blend files and in files of their own, of each number format."""

    def _image(self, name, values, is_float):
        image = bpy.data.images.new(name, *values.shape[1::-1], alpha=True, float_buffer=is_float)
        image.pixels.foreach_set(values.ravel())
        return image

    def _packed(self, is_float):
        # Whole fifths: Cycles truncates products of bytes.
        values = np.random.default_rng(8).integers(1, 6, (4, 4, 4)).astype(np.float32) / 5
        image = self._image("packed", values, is_float)
        image.pack()
        return image

    def _file(self, ending, depth, space=None):
        values = np.random.default_rng(9).uniform(0.3, 0.9, (4, 4, 4)).astype(np.float32)
        values[..., :3] *= values[..., 3:]
        path = self.folder / f"stored{ending}"
        settings = self.scene.render.image_settings
        settings.file_format, settings.color_mode = ("PNG" if ending == ".png" else "OPEN_EXR"), "RGBA"
        settings.color_depth = depth
        self._image("source", values, True).save_render(str(path), scene=self.scene)
        image = bpy.data.images.load(str(path))
        if space:
            image.colorspace_settings.name = space
        return image

    def _assert_all(self, feature, make):
        """Colors of each alpha mode, alone and beside the alpha."""

        def build(mode, is_used):
            def built(nodes):
                image = make()
                image.alpha_mode = mode
                node = nodes.add("TexImage", image=image, interpolation="Closest")
                if not is_used:
                    return node.outputs["Color"]
                inputs = {0: node.outputs["Alpha"], 1: (0.2,) * 3, 2: node.outputs["Color"]}
                return nodes.add("VectorMath", inputs, operation="MULTIPLY_ADD").outputs[0]

            return built

        modes = ("STRAIGHT", "PREMUL", "CHANNEL_PACKED", "NONE")
        self.show([build(mode, is_used) for mode in modes for is_used in (False, True)])
        self.assert_parity(f"Image Texture: alpha modes, {feature}")

    def test_packed_bytes(self):
        self._assert_all("packed bytes", lambda: self._packed(False))

    def test_packed_floats(self):
        self._assert_all("packed floats", lambda: self._packed(True))

    def test_png(self):
        self._assert_all("PNG of 8 bits", lambda: self._file(".png", "8"))

    def test_deep_png(self):
        self._assert_all("PNG of 16 bits", lambda: self._file(".png", "16"))

    def _stored(self, name, content):
        path = self.folder / name
        path.write_bytes(content)
        return bpy.data.images.load(str(path))

    def test_gray_png(self):
        """Cycles does not multiply gray by alpha."""
        values = np.random.default_rng(9).uniform(0.3, 0.9, (4, 4, 2))
        self._assert_all("PNG of gray and alpha", lambda: self._stored("gray.png", gray_alpha_png(values)))

    def test_tiff(self):
        """Blender 3.4 itself shows most of them wrongly."""
        values = np.random.default_rng(9).uniform(0.3, 0.9, (4, 4, 4))
        deep = np.rint(65535 * values).astype(np.uint16)
        for name, stored, alpha in (
            ("8 bits, straight", np.rint(255 * values).astype(np.uint8), 2),
            ("16 bits, gray", deep[..., :1], 0),
            ("16 bits", deep[..., :3], 0),
            ("16 bits, straight", deep, 2),
            ("floats", values[..., :3].astype(np.float32), 0),
        ):
            with self.subTest(name):
                content = tiff(stored, alpha)
                make = functools.partial(self._stored, "stored.tif", content)
                self._assert_all(f"TIFF, {name}", make)

    def test_exr(self):
        self._assert_all("OpenEXR", lambda: self._file(".exr", "32"))

    def test_tone_mapped(self):
        """Color spaces with sRGB in their names are not sRGB for that."""
        image = self._packed(False)
        found = None
        for name in ("AgX Base sRGB", "Filmic sRGB"):
            try:
                image.colorspace_settings.name = found = name
                break
            except TypeError:
                continue
        if found is None:
            self.skipTest("this Blender has no such color space")
        self.show([lambda nodes: nodes.add("TexImage", image=image, interpolation="Closest").outputs[0]])
        self.assert_ignored(f"Image Texture: {found}", f"its color space '{found}' is not supported")

    def test_encoded_exr(self):
        self._assert_all("OpenEXR in sRGB", lambda: self._file(".exr", "32", "sRGB"))
