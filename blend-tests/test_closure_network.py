"""A network of Blender's own nodes that stands in for a measured material, rendered by Cycles."""

import sys
from unittest import mock

import addon_utils
import bpy
import numpy as np
from mathutils import Euler

from support import closures, inputs, scenes
from support.blender import BlenderTest

SIZE = 48
_TAN = 5.0  # the widest view angle of a picture's edge: 79 degrees; 82 in corners
_ENERGY = 2.0
_SUNS = ((0.1, 0.05, 0), (0.9, 0.2, 0.5), (-0.5, 1.25, 0.3))  # polar angles of 6, 52 and 73 degrees
_EXACT = 0.004  # relative L2: tables of 256 entries between 65 points

GRAZING = closures.X**4
SMOOTH = 0.5 - 0.5 * np.cos(np.pi * closures.X)
COLORS = np.stack([0.2 + 0.5 * GRAZING, 0.6 - 0.2 * SMOOTH, 0.1 + 1.4 * SMOOTH], axis=-1)

# One freedom after the other.
CASES = {
    "diffuse": closures.curves(diffuse=COLORS / 2),
    "constant": closures.curves((0.2, 0.1, 0.05), [{"color": (0.5, 0.8, 1.5), "roughness": 0.4}]),
    "ggx": closures.curves(lobes=[{"color": COLORS, "roughness": 0.6 - 0.4 * SMOOTH}]),
    "beckmann": closures.curves(
        lobes=[{"color": COLORS, "roughness": 0.4 + 0.2 * SMOOTH, "distribution": "BECKMANN"}]
    ),
    "to the viewer": closures.curves(lobes=[{"color": COLORS, "roughness": 0.5, "tilt": 0.8 * SMOOTH}]),
    "by a constant": closures.curves(lobes=[{"color": COLORS, "roughness": 0.5, "tilt": 0.6}]),
    "from the viewer": closures.curves(
        lobes=[{"roughness": 0.5, "tilt": -0.15 * np.sin(np.pi * closures.X)}]
    ),
    "stretched along": closures.curves(lobes=[{"roughness": 0.5, "anisotropy": -0.4 * SMOOTH}]),
    "stretched across": closures.curves(lobes=[{"roughness": 0.5, "anisotropy": 0.4 * SMOOTH}]),
    "all": closures.curves(
        COLORS / 4,
        [
            {
                "color": COLORS / 3,
                "roughness": 0.35 + 0.2 * SMOOTH,
                "tilt": 0.6 * SMOOTH,
                "anisotropy": 0.4 * SMOOTH,
            },
            {"color": COLORS / 5, "roughness": 0.6, "tilt": -0.05 * SMOOTH, "distribution": "BECKMANN"},
            {
                "color": 0.1 * (1 - SMOOTH[:, None]),
                "roughness": 0.7 - 0.2 * SMOOTH,
                "anisotropy": -0.3 * SMOOTH,
            },
        ],
    ),
}


class Network(BlenderTest):
    """A plane below a camera that looks down: each pixel has a view of its own, and N is constant."""

    def setUp(self):
        super().setUp()
        addon_utils.enable("cycles")
        self.module = inputs.module("operators.closure_network")
        self.scene = scene = bpy.context.scene
        scene.render.engine = "CYCLES"
        scene.render.resolution_x = scene.render.resolution_y = SIZE
        scene.render.resolution_percentage = 100
        scene.cycles.samples, scene.cycles.max_bounces, scene.cycles.use_denoising = 1, 0, False
        scene.cycles.light_sampling_threshold = 0  # no roulette: a picture has no noise
        scene.cycles.pixel_filter_type, scene.cycles.filter_width = "GAUSSIAN", 0.01  # middles of pixels
        self.camera = scenes.add_camera(distance=1.0)
        self.camera.data.angle = 2 * np.arctan(_TAN)
        self.camera.data.clip_start = 0.01
        scenes.set_world(strength=0)
        self.material = bpy.data.materials.new("Measured")
        self.material.use_nodes = True
        self.tree = self.material.node_tree
        self.tree.nodes.clear()
        self.surface = self.tree.nodes.new("ShaderNodeOutputMaterial").inputs["Surface"]
        self.plane = scenes.add_plane(self.material, size=40)
        lamp = self.lamp = bpy.data.objects.new("Sun", bpy.data.lights.new("Sun", "SUN"))
        lamp.data.angle, lamp.data.energy = 0, _ENERGY
        scene.collection.objects.link(lamp)

    def build(self, curves, **sockets):
        self.tree.links.new(self.module.build(self.tree, curves, **sockets), self.surface)

    def picture(self, sun):
        self.lamp.rotation_euler = sun
        return scenes.render(self.folder)[..., :3].reshape(-1, 3)

    def expected(self, curves, sun):
        wl = np.array(Euler(sun).to_matrix())[:, 2]
        return _ENERGY * closures.f_cos(curves, views(), wl)

    def error(self, curves):
        """The largest relative L2 distance between pictures of the nodes and those of `curves`."""
        return max(_distance(self.picture(sun), self.expected(curves, sun)) for sun in _SUNS)

    def value(self, idname, value):
        """An unlinked node's output, as a control."""
        node = self.tree.nodes.new(idname)
        node.outputs[0].default_value = value
        return node.outputs[0]

    def vector(self, *values):
        node = self.tree.nodes.new("ShaderNodeCombineXYZ")
        for socket, value in zip(node.inputs, values, strict=True):
            socket.default_value = value
        return node.outputs[0]


def views():
    """Directions to the camera from the points that pixels show."""
    place = _TAN * ((np.arange(SIZE) + 0.5) * 2 / SIZE - 1)
    y, x = np.meshgrid(place, place, indexing="ij")
    wv = np.stack([-x, -y, np.ones_like(x)], axis=-1).reshape(-1, 3)
    return wv / np.linalg.norm(wv, axis=-1, keepdims=True)


def _distance(picture, expected):
    return np.sqrt(((picture - expected) ** 2).sum() / (expected**2).sum())


class ClosedForm(Network):
    def test_pictures_are_those_of_the_curves(self):
        for name, curves in CASES.items():
            with self.subTest(name):
                self.build(curves)
                self.assertLess(self.error(curves), _EXACT)

    def test_each_curve_counts(self):
        """The control: the same pictures are not those of other curves."""
        curves = CASES["all"]
        self.build(curves)
        first, *others = curves["lobes"]
        for name, factor in (("color", 1.05), ("roughness", 1.05), ("tilt", -1), ("anisotropy", -1)):
            other = {**first, name: (factor * np.array(first[name])).tolist()}
            self.assertGreater(self.error({**curves, "lobes": [other, *others]}), 4 * _EXACT, name)
        other = {**first, "distribution": "BECKMANN"}
        self.assertGreater(self.error({**curves, "lobes": [other, *others]}), 4 * _EXACT)

    def test_black(self):
        self.build(closures.curves())
        self.assertEqual(self.picture(_SUNS[0]).max(), 0)

    def test_the_back_is_like_the_front(self):
        self.build(CASES["all"])
        self.plane.rotation_euler.x = np.pi
        self.assertLess(self.error(CASES["all"]), _EXACT)

    def test_albedo(self):
        """Means over rings of equal view angles under a white world."""
        self.lamp.hide_render = True
        scenes.set_world()
        self.scene.cycles.samples = 64
        cell = np.radians(0.25)
        theta, phi = np.meshgrid(np.arange(cell / 2, np.pi / 2, cell), np.arange(cell / 2, np.pi, cell))
        sine = np.sin(theta)
        wl = np.stack([sine * np.cos(phi), sine * np.sin(phi), np.cos(theta)], axis=-1).reshape(-1, 3)
        solid_angle = 2 * sine.ravel() * cell**2  # of the other half, too
        angle = np.arccos(views()[:, 2])
        for name in ("ggx", "beckmann", "all"):
            self.build(CASES[name])
            picture = scenes.render(self.folder)[..., :3].reshape(-1, 3)
            for degrees in (30, 60, 75):
                ring = np.abs(angle - np.radians(degrees)) < np.radians(2.5)
                at = angle[ring].mean()
                f_cos = closures.f_cos(CASES[name], np.array([np.sin(at), 0, np.cos(at)]), wl)
                np.testing.assert_allclose(
                    picture[ring].mean(0), solid_angle @ f_cos, rtol=0.04, err_msg=name
                )


class Controls(Network):
    """Inputs of the group that holds a network."""

    def test_tint_and_exposure(self):
        tint = self.value("ShaderNodeRGB", (0.5, 1.0, 0.2, 1))
        exposure = self.value("ShaderNodeValue", -1.5)
        gain = 2**-1.5 * np.array([0.5, 1, 0.2])
        for used, factor in (
            ({"tint": tint}, np.array([0.5, 1, 0.2])),
            ({"exposure": exposure}, np.full(3, 2**-1.5)),
            ({"tint": tint, "exposure": exposure}, gain),
        ):
            for name in ("constant", "all"):
                self.build(CASES[name], **used)
                self.assertLess(self.error(_dyed(CASES[name], factor)), _EXACT)

    def test_normal(self):
        """A bent normal is as a turned plane under a turned sun; a vector of 0 is as no normal."""
        for name in ("diffuse", "all"):
            self.build(CASES[name], normal=self.vector(0, 0, 0))
            self.assertLess(self.error(CASES[name]), _EXACT)
        sun, turn = (0.3, 0.2, 0), np.array(Euler((0.15, -0.1, 0)).to_matrix())
        wl = np.array(Euler(sun).to_matrix())[:, 2]
        bent = _ENERGY * closures.f_cos(CASES["ggx"], views() @ turn, wl @ turn)
        self.build(CASES["ggx"], normal=self.vector(*turn[:, 2]))
        seen = np.arccos(views()[:, 2]) < np.radians(65)  # beyond, Cycles bends normals back
        picture = self.picture(sun)
        self.assertLess(_distance(picture[seen], bent[seen]), _EXACT)
        flat = self.expected(CASES["ggx"], sun)
        self.assertGreater(_distance(picture[seen], flat[seen]), 10 * _EXACT)

    def test_roughness(self):
        curves = closures.curves(lobes=[{"color": COLORS, "roughness": 0.5 - 0.3 * SMOOTH}])
        self.build(curves, roughness=self.value("ShaderNodeValue", 0.45))
        blurred = (np.array(curves["lobes"][0]["roughness"]) ** 4 + 0.45**4) ** 0.25
        self.assertLess(self.error(closures.curves(lobes=[{"color": COLORS, "roughness": blurred}])), _EXACT)
        self.build(curves, roughness=self.value("ShaderNodeValue", 0))
        self.assertLess(self.error(curves), _EXACT)

    def test_roughness_of_stretched_lobes(self):
        """Squared alphas add along and across, and none exceeds 1."""
        roughness = 0.35 + 0.25 * SMOOTH
        for amount in (0.6, -0.6, 1.2 * (SMOOTH - 0.5)):
            lobe = {"color": COLORS, "roughness": roughness, "anisotropy": amount + 0 * SMOOTH}
            curves = closures.curves(lobes=[lobe])
            self.build(curves, roughness=self.value("ShaderNodeValue", 0))
            self.assertLess(self.error(curves), 2 * _EXACT)
            for blur in (0.5, 0.9):
                self.build(curves, roughness=self.value("ShaderNodeValue", blur))
                blurred = closures.curves(lobes=[{**lobe, **_blurred(lobe, blur)}])
                self.assertLess(self.error(blurred), 2 * _EXACT)

    def test_rotation_of_a_brushed_surface(self):
        lobe = {"roughness": 0.5, "anisotropy": 0.5}
        curves = {**closures.curves(lobes=[lobe]), "frame": "surface"}
        self.build(curves)
        self.assertLess(self.error(curves), _EXACT)
        self.build(curves, rotation=self.value("ShaderNodeValue", np.pi / 2))
        turned = {**closures.curves(lobes=[{**lobe, "anisotropy": -0.5}]), "frame": "surface"}
        self.assertLess(self.error(turned), _EXACT)
        self.assertGreater(self.error(curves), 10 * _EXACT)

    def test_the_distributions_of_brushed_surfaces(self):
        for distribution in ("GGX", *_other_distributions()):
            lobe = {"roughness": 0.5, "anisotropy": 0.5, "distribution": distribution}
            curves = {**closures.curves(lobes=[lobe]), "frame": "surface"}
            self.build(curves)
            self.assertLess(self.error(curves), _EXACT)

    def _under_a_sky(self, distribution):
        """How bright a brushed plane is from above under a white sky: in Cycles, and by its curves."""
        lobe = {"roughness": 0.35, "anisotropy": -0.5, "distribution": distribution}
        curves = {**closures.curves((0.01,) * 3, [lobe]), "frame": "surface"}
        self.build(curves)
        scenes.set_world(strength=1)
        self.lamp.hide_render, self.camera.data.angle, self.scene.cycles.samples = True, 0.02, 64
        z = (np.arange(50000) + 0.5) / 50000
        phi, across = np.pi * (1 + 5**0.5) * np.arange(50000), np.sqrt(1 - z**2)
        wl = np.stack([across * np.cos(phi), across * np.sin(phi), z], axis=-1)
        expected = 2 * np.pi * closures.f_cos(curves, (0, 0, 1), wl).mean()
        return scenes.render(self.folder)[..., :3].mean(), expected

    def test_under_a_sky_they_are_seen_as_under_lamps(self):
        """Directions are drawn by the density that Cycles divides by."""
        for distribution in _other_distributions():
            drawn, divided = self._under_a_sky(distribution)
            self.assert_close(drawn, divided, 0.02 * divided)
        if not closures.is_correlated():
            drawn, divided = self._under_a_sky("BECKMANN")
            self.assertGreater(abs(drawn - divided), 0.1 * divided)


def _other_distributions():
    """What fits take beside GGX for brushed surfaces."""
    return ["BECKMANN"] if closures.is_correlated() else ["ASHIKHMIN_SHIRLEY"]


def _blurred(lobe, blur):
    ratio = (1 - np.abs(lobe["anisotropy"])) ** 2  # alphas are roughness^2 times and over its root
    narrow, wide = (np.minimum(lobe["roughness"] ** 4 * each + blur**4, 1) for each in (ratio, 1 / ratio))
    stretched = np.sign(lobe["anisotropy"]) * (1 - (narrow / wide) ** 0.25)
    return {"roughness": (wide * narrow) ** 0.125, "anisotropy": stretched}


def _dyed(curves, gain):
    lobes = [{**lobe, "color": (np.array(lobe["color"]) * gain).tolist()} for lobe in curves["lobes"]]
    return {"diffuse": (np.array(curves["diffuse"]) * gain).tolist(), "lobes": lobes}


class Tree(Network):
    def test_a_rebuild_leaves_other_nodes_alone(self):
        self.build(CASES["all"])
        count = len(self.tree.nodes)
        mix = self.tree.nodes.new("ShaderNodeMixShader")
        self.tree.links.new(self.surface.links[0].from_socket, mix.inputs[1])
        self.tree.links.new(mix.outputs[0], self.surface)
        copy = self.tree.nodes.new("ShaderNodeBsdfDiffuse")
        copy["velour_closures"] = "Diffuse BSDF"  # as a node that was duplicated
        copy.name = "My copy"
        bsdf = self.module.build(self.tree, CASES["all"])
        self.assertEqual(len(self.tree.nodes), count + 2)
        self.assertEqual(mix.inputs[1].links[0].from_socket, bsdf)
        self.assertIn("My copy", self.tree.nodes)
        self.module.build(self.tree, CASES["diffuse"])
        self.assertLess(len(self.tree.nodes), count)
        self.assertEqual(mix.inputs[1].links[0].from_node.bl_idname, "ShaderNodeBsdfDiffuse")

    def test_constants_need_no_curves(self):
        self.build(CASES["constant"])
        kinds = {node.bl_idname for node in self.tree.nodes}
        self.assertFalse(kinds & {"ShaderNodeRGBCurve", "ShaderNodeFloatCurve"})

    def test_nodes_do_not_overlap(self):
        """Heights are known to a drawn window only: nodes that can be tall have a row of their own."""
        white, no_normal = self.value("ShaderNodeRGB", (1, 1, 1, 1)), self.vector(0, 0, 0)
        self.build(CASES["all"], tint=white, normal=no_normal, roughness=self.value("ShaderNodeValue", 0.1))
        boxes = [
            (node.location.x, node.location.y, node.width, 55 if node.hide else 180, node.name)
            for node in self.tree.nodes
            if node.parent and node.bl_idname not in ("NodeFrame", "NodeReroute")
        ]
        for i, (x, y, width, height, name) in enumerate(boxes):
            for other_x, other_y, other_width, other_height, other in boxes[:i]:
                beside = x + width <= other_x or other_x + other_width <= x
                apart = y - height >= other_y or other_y - other_height >= y
                self.assertTrue(beside or apart, f"{name} lies on {other}")

    def test_links_run_to_the_right(self):
        blur = self.value("ShaderNodeValue", 0.1)
        self.build(CASES["all"], normal=self.vector(0, 0, 0), roughness=blur)
        for link in self.tree.links:
            if link.from_node.parent and link.to_node.parent:
                self.assertLess(link.from_node.location.x, link.to_node.location.x, link.to_node.name)


class File(Network):
    """A material in a .blend file of its own."""

    def setUp(self):
        super().setUp()
        self.path = self.folder / "curves.blend"
        self.blend_file = inputs.module("core.blend_file")

    def _write(self, curves, blender="blender"):
        self.blend_file.write_closures(self.path, "Satin", curves, "Off by 3 %.", blender)

    def _append(self):
        """Shows the material of the file; returns its group node."""
        with bpy.data.libraries.load(str(self.path)) as (source, target):
            target.materials = source.materials
        (material,) = target.materials
        self.plane.data.materials[0] = material
        return next(n for n in material.node_tree.nodes if n.bl_idname == "ShaderNodeGroup")

    def test_it_renders_as_the_curves(self):
        before = len(bpy.data.materials), len(bpy.data.node_groups)
        self._write(CASES["all"])
        self.assertEqual((len(bpy.data.materials), len(bpy.data.node_groups)), before)
        node = self._append()
        self.assertLess(self.error(CASES["all"]), _EXACT)
        node.inputs["Tint"].default_value = (0.5, 1, 0.2, 1)
        self.assertLess(self.error(_dyed(CASES["all"], (0.5, 1, 0.2))), _EXACT)
        self.assertEqual(self.plane.active_material.asset_data.description, "Off by 3 %.")
        self.assertEqual(node.node_tree.name, "Satin")
        self.assertNotIn("Rotation", node.inputs)

    def test_a_blender_of_its_own_writes_it(self):
        curves = {**closures.curves(lobes=[{"roughness": 0.5, "anisotropy": 0.5}]), "frame": "surface"}
        outside = {name: module for name, module in sys.modules.items() if name != "bpy"}
        with mock.patch.dict(sys.modules, outside, clear=True):
            self._write(curves, bpy.app.binary_path)
        node = self._append()
        node.inputs["Rotation"].default_value = np.pi / 2
        turned = closures.curves(lobes=[{"roughness": 0.5, "anisotropy": -0.5}])
        self.assertLess(self.error({**turned, "frame": "surface"}), _EXACT)

    def test_a_missing_blender_is_named(self):
        native = inputs.native()
        outside = {name: module for name, module in sys.modules.items() if name != "bpy"}
        refused = self.assertRaisesRegex(native.VelourError, "does not start .* name it with --blender")
        with mock.patch.dict(sys.modules, outside, clear=True), refused:
            self._write(CASES["all"], "no-such-blender")
        self.assertEqual(list(self.folder.iterdir()), [])
