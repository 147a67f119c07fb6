"""Light that passes through surfaces: Glass, Refraction and Translucent BSDFs, Principled transmission."""

import bpy

from parity import stage
from parity.case import ParityTest
from parity.shaders import Tree, image
from parity.test_principled import ROUGH, Plates

_TINT = (0.9, 0.7, 0.4, 1)
_INDICES = (1.5, 0.7)


class Angles(Plates):
    """Values at all angles; suns behind a plate light it from the other side."""

    def _assert_glass(self, idname, roughness, index, distribution="GGX"):
        def shader():
            inputs = {"Color": _TINT, "Roughness": roughness, "IOR": index}
            return self.tree.node(f"ShaderNode{idname}", settings={"distribution": distribution}, **inputs)

        feature = f"{idname[4:]} BSDF: {distribution}, roughness {roughness:g}, IOR {index:g}"
        self.assert_angles(feature, shader)

    def test_refraction(self):
        for index in _INDICES:
            for roughness in ROUGH:
                self._assert_glass("BsdfRefraction", roughness, index)

    def test_glass(self):
        for index in _INDICES:
            for roughness in ROUGH:
                self._assert_glass("BsdfGlass", roughness, index)

    def test_from_behind(self):
        """The index of what is behind a back face is the reciprocal."""
        self.plates.data.flip_normals()
        for idname in ("BsdfGlass", "BsdfRefraction"):
            self._assert_glass(idname, 0.4, 1.5)

    def test_multiple_scattering(self):
        if bpy.app.version < (4, 0, 0):
            self.skipTest("before 4.0 it is a random walk, whose values are random numbers")
        for index in _INDICES:
            for roughness in ROUGH:
                self._assert_glass("BsdfGlass", roughness, index, "MULTI_GGX")

    def test_translucent(self):
        self.assert_angles(
            "Translucent BSDF", lambda: self.tree.node("ShaderNodeBsdfTranslucent", Color=_TINT)
        )

    def _assert_principled(self, distribution="GGX", **inputs):
        weight = "Transmission_Weight" if bpy.app.version >= (4, 0, 0) else "Transmission"
        settings = {"distribution": distribution}
        given = {"Base_Color": _TINT, weight: 0.7, **inputs}
        described = ", ".join(f"{name.replace('_', ' ')} {value:g}" for name, value in inputs.items())
        self.assert_angles(
            f"Principled BSDF: transmission 0.7, {described}",
            lambda: self.tree.node("ShaderNodeBsdfPrincipled", settings=settings, **given),
        )

    def test_transmission(self):
        for index in _INDICES:
            self._assert_principled(Roughness=0.3, IOR=index)
        self._assert_principled(Roughness=0.8, IOR=1.45, Metallic=0.4)

    def test_transmission_roughness(self):
        if bpy.app.version >= (4, 0, 0):
            self.skipTest("4.0 has one roughness")
        self._assert_principled(Roughness=0.3, IOR=1.45, Transmission_Roughness=0.5)

    def test_transmission_with_multiple_scattering(self):
        if bpy.app.version < (4, 0, 0):
            self.skipTest("before 4.0 it is a random walk, whose values are random numbers")
        self._assert_principled("MULTI_GGX", Roughness=0.6, IOR=1.45)


class GlassTest(ParityTest):
    """Glass on a ground before a wall, under an even sky and a broad lamp."""

    bounces = 8

    def setUp(self):
        super().setUp()
        stage.ground(12, 0.6)
        stage.box((-3, 1.8, 0), (3, 2.2, 2.5), 0.3)
        stage.box((-0.4, 0.9, 0), (0.4, 1.3, 0.8), 0.8)
        stage.camera((0, -5, 3), (1.12, 0, 0), 45)
        stage.world((0.6, 0.8, 1), 0.5)
        self.material = bpy.data.materials.new("Glass")
        self.tree = Tree(self.material)

    def _ball(self, radius=0.8, height=0.85, material=None):
        ball = stage.sphere(radius, segments=48, rings=24)
        ball.location = (0, -0.6, height)
        ball.data.materials.clear()
        ball.data.materials.append(material or self.material)
        return ball

    def _glass(self, roughness=0.0, index=1.45, color=(1, 1, 1), idname="BsdfGlass", tree=None):
        settings = {"distribution": "GGX"}
        inputs = {"Color": (*color, 1), "Roughness": roughness, "IOR": index}
        return (tree or self.tree).node(f"ShaderNode{idname}", settings=settings, **inputs)


class Scenes(GlassTest):
    def _pane(self, thickness=0.1):
        low, high = (-1.2, -0.6, 0.3), (1.2, -0.6 + thickness, 1.7)
        pane = stage.box(low, high, 0.5)
        pane.data.materials.clear()
        pane.data.materials.append(self.material)

    def test_smooth_ball(self):
        self._ball()
        self.tree.end(self._glass())
        self.assert_parity("Glass BSDF: smooth ball")

    def test_rough_ball(self):
        self._ball()
        self.tree.end(self._glass(0.4, color=(0.9, 1, 0.8)))
        self.assert_parity("Glass BSDF: rough ball")

    def test_index_below_one(self):
        self._ball()
        self.tree.end(self._glass(0.0, 0.7))
        self.assert_parity("Glass BSDF: IOR 0.7")

    def test_smooth_pane(self):
        self._pane()
        self.tree.end(self._glass(color=(0.8, 0.9, 1)))
        self.assert_parity("Glass BSDF: smooth pane")

    def test_rough_pane(self):
        self._pane()
        self.tree.end(self._glass(0.3))
        self.assert_parity("Glass BSDF: rough pane")

    def test_refraction(self):
        self._ball()
        self.tree.end(self._glass(0.2, idname="BsdfRefraction"))
        self.assert_parity("Refraction BSDF: ball")

    def test_nested(self):
        """A bubble in a ball, and a ball of another index that reaches into both."""
        self._ball()
        self.tree.end(self._glass())
        air = bpy.data.materials.new("Air")
        tree = Tree(air)
        tree.end(self._glass(index=1 / 1.45, tree=tree))
        self._ball(0.4, material=air)
        denser = bpy.data.materials.new("Denser")
        tree = Tree(denser)
        tree.end(self._glass(index=1.8, tree=tree))
        self._ball(0.3, 1.3, material=denser)
        self.assert_parity("Glass BSDF: nested and overlapping")

    def test_shadow(self):
        """Glass is opaque to shadow rays."""
        self._ball()
        stage.sharp_sun()
        self.tree.end(self._glass())
        self.assert_parity("Glass BSDF: shadow of a sharp sun")

    def test_mixed(self):
        self._ball()
        tree = self.tree
        mixed = tree.mix(0.5, tree.diffuse((0.7, 0.2, 0.1)), self._glass(0.3))
        tree.end(tree.mix(0.4, mixed, self._glass(0.0, 1.6)))
        self.assert_parity("Glass BSDF: mixed with a Diffuse BSDF and other glass")

    def _in_part_transparent(self, roughness):
        self._ball()
        self.tree.end(self.tree.mix(0.3, self._glass(roughness), self.tree.transparent((0.5, 1, 0.5))))

    def test_in_part_transparent(self):
        self._in_part_transparent(0.0)
        self.assert_parity("Glass BSDF: smooth, mixed with a Transparent BSDF")

    def test_rough_in_part_transparent(self):
        """Before 4.0 Cycles averages what passes with what is refracted where light goes straight on."""
        self._in_part_transparent(0.3)
        feature = "Glass BSDF: rough, mixed with a Transparent BSDF"
        if bpy.app.version < (4, 0, 0):
            self.assert_approximate(feature, 12)
        else:
            self.assert_parity(feature)

    def test_images(self):
        self._pane()
        tree = self.tree
        inputs = {"Color": tree.picture(image(3)), "Roughness": tree.picture(image(4, low=0.1, high=0.6))}
        tree.end(tree.node("ShaderNodeBsdfGlass", settings={"distribution": "GGX"}, IOR=1.3, **inputs))
        self.assert_parity("Glass BSDF: color and roughness by images")

    def test_translucent(self):
        tree = self.tree
        corners = [(-1, -0.8, 0.4), (1, -0.8, 0.4), (1, -0.2, 1.6), (-1, -0.2, 1.6)]
        stage.mesh(corners, [(0, 1, 2, 3)], self.material, "Leaf")
        translucent = tree.node("ShaderNodeBsdfTranslucent", Color=(0.4, 0.9, 0.2, 1))
        tree.end(tree.mix(0.6, tree.diffuse((0.2, 0.5, 0.1)), translucent))
        stage.sharp_sun()
        self.assert_parity("Translucent BSDF: leaf")

    def test_transmission(self):
        self._ball()
        weight = "Transmission_Weight" if bpy.app.version >= (4, 0, 0) else "Transmission"
        inputs = {"Base_Color": (0.9, 0.5, 0.3, 1), "Roughness": 0.0, weight: 0.8}
        self.tree.end(self.tree.node("ShaderNodeBsdfPrincipled", settings={"distribution": "GGX"}, **inputs))
        self.assert_parity("Principled BSDF: transmission 0.8, smooth")


class Hidden(GlassTest):
    """What transmitted rays see is told apart from what reflected ones see."""

    bounces = 4

    def setUp(self):
        super().setUp()
        self._ball()
        self.tree.end(self._glass())
        self.wall = next(obj for obj in self.scene.objects if obj.name.startswith("Box"))

    def test_object(self):
        self.wall.visible_transmission = False
        self.assert_parity("Object: hidden from transmission rays")

    def test_object_hidden_from_others(self):
        """It is seen in glass, and lets the even sky pass."""
        self.wall.visible_diffuse = self.wall.visible_glossy = False
        self.assert_parity("Object: hidden from diffuse and glossy rays, behind glass")

    def test_emissive(self):
        glow = bpy.data.materials.new("Glow")
        tree = Tree(glow)
        tree.end(tree.emission((1, 0.7, 0.4), 4.0))
        self.wall.data.materials[0] = glow
        for names in (("transmission",), ("diffuse", "glossy")):
            with self.subTest(names):
                for name in ("transmission", "diffuse", "glossy"):
                    setattr(self.wall, f"visible_{name}", name not in names)
                self.assert_parity(f"Emissive object: hidden from {' and '.join(names)} rays", samples=2)

    def test_world(self):
        self.scene.world.cycles_visibility.transmission = False
        self.assert_parity("World: hidden from transmission rays")

    def test_lamps(self):
        """A broad lamp and a sharp sun before rough glass, where Cycles 4 leaves a part of their light."""
        self.tree.end(self._glass(0.3))
        stage.world((0, 0, 0))
        broad = stage.lamp("AREA", 200, (0, 1.5, 3), (-0.7, 0, 0), size=1.5)
        for lamp in (broad, stage.sharp_sun()):
            lamp.visible_transmission = False
        self.assert_approximate(
            "Lights: hidden from transmission rays", 60, samples=2, exact=((3, 4, 0), (4, 0, 0))
        )
