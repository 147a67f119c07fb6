"""What a single shader reflects, and its relief."""

import bpy
import numpy as np

from parity import stage
from parity.case import NEVER
from parity.shaders import ShaderTest, image


class NormalMaps(ShaderTest):
    """The roof has a relief, and is seen and lit from above."""

    def _map(self, strength=1.0, seed=12, size=8, low=0.2, high=0.8, **settings):
        """A linear picture of random tilts, towards the surface's normal in the mean."""
        picture = image(seed, size, low, high)
        pixels = np.array(picture.pixels[:], np.float32).reshape(-1, 4)
        pixels[:, 2] = 0.5 + 0.5 * pixels[:, 2]
        picture.pixels.foreach_set(pixels.ravel())
        picture.pack()
        color = self.tree.picture(picture)
        return self.tree.node("ShaderNodeNormalMap", settings=settings, Color=color, Strength=strength)

    def test_diffuse(self):
        self.tree.end(self.tree.diffuse(Normal=self._map()))
        self.assert_parity("Normal Map: Diffuse")

    def test_directx(self):
        normal = self._map()
        if not hasattr(normal.node, "convention"):
            self.skipTest("before 5.2 all normal maps are OpenGL's")
        normal.node.convention = "DIRECTX"
        self.tree.end(self.tree.diffuse(Normal=normal))
        self.assert_parity("Normal Map: DirectX")

    def test_glossy(self):
        """Steep facets show what a roughness of 1 shows of flat ones."""
        self.tree.end(self.tree.glossy(0.6, Normal=self._map(low=0.35, high=0.65)))
        self.assert_approximate("Normal Map: Glossy", 1, exact=((5, 0), NEVER))

    def test_leaf(self):
        """What foliage is made of."""
        tree = self.tree
        leaf = image(alpha=True)
        relief = self._map(low=0.35, high=0.65)
        inputs = {"Base_Color": tree.picture(leaf), "Roughness": 0.6, "Normal": relief}
        principled = tree.node("ShaderNodeBsdfPrincipled", **inputs)
        tree.end(tree.mix(tree.picture(leaf, "Alpha"), tree.transparent(), principled))
        self.assert_parity("Principled BSDF: cut-out, base color and normal map by images")

    def test_principled(self):
        """How much of the light the base keeps is a matter of the lobe's normal."""
        normal = self._map(low=0.35, high=0.65)
        inputs = {"Base_Color": (0.8, 0.3, 0.1, 1), "Roughness": 0.3, "Normal": normal}
        self.tree.end(self.tree.node("ShaderNodeBsdfPrincipled", **inputs))
        self.assert_parity("Principled BSDF: normal map, roughness 0.3")

    def test_coat(self):
        """The coat itself is flat."""
        if bpy.app.version < (4, 0, 0):
            self.skipTest("before 4.0 a coat has another formula")
        inputs = {
            "Base_Color": (0.8, 0.3, 0.1, 1),
            "Coat_Weight": 1.0,
            "Coat_Roughness": 0.3,
            "Roughness": 0.6,
        }
        normal = self._map(low=0.35, high=0.65)
        self.tree.end(self.tree.node("ShaderNodeBsdfPrincipled", Normal=normal, **inputs))
        self.assert_parity("Principled BSDF: coat over a normal map")

    def test_uncorrected(self):
        if not hasattr(self.material.cycles, "use_bump_map_correction"):
            self.skipTest("Bump Map Correction is a choice since Blender 4.2")
        self.material.cycles.use_bump_map_correction = False
        self.tree.end(self.tree.diffuse(Normal=self._map()))
        self.assert_parity("Normal Map: without Bump Map Correction")

    def test_half_strength(self):
        """Before strength scaled tilt in tangent space, Cycles interpolated the normals themselves."""
        self.tree.end(self.tree.diffuse(Normal=self._map(0.5)))
        self.assert_approximate("Normal Map: strength 0.5", 4, exact=((4, 0), NEVER))

    def test_strong(self):
        self.tree.end(self.tree.diffuse(Normal=self._map(2.0)))
        self.assert_approximate("Normal Map: strength 2", 4, exact=((4, 0), NEVER))

    def test_mirrored(self):
        layer = self.roof.data.uv_layers["UVMap"]
        layer.data.foreach_set("uv", [1, 0.2, 0, 0, 0.1, 1, 1, 1])
        self.tree.end(self.tree.diffuse(Normal=self._map()))
        self.assert_parity("Normal Map: mirrored and sheared UV map")

    def _other_uv_map(self):
        """Another UV map, turned and mirrored: it is not the one that renders."""
        layer = self.roof.data.uv_layers.new(name="turned")
        layer.data.foreach_set("uv", [1, 0, 1, 1.5, 0, 1.5, 0, 0])

    def test_other_uv_map(self):
        """Another UV map for the tangents alone: the image stays on the one that renders."""
        self._other_uv_map()
        self.tree.end(self.tree.diffuse(Normal=self._map(uv_map="turned")))
        self.assert_parity("Normal Map: tangents of another UV map")

    def test_picture_on_other_uv_map(self):
        """Tangents stay those of the UV map that renders."""
        self._other_uv_map()
        normal = self._map()
        picture = normal.node.inputs["Color"].links[0].from_node
        self.tree.set(
            picture.inputs["Vector"], self.tree.node("ShaderNodeUVMap", settings={"uv_map": "turned"})
        )
        self.tree.end(self.tree.diffuse(Normal=normal))
        self.assert_parity("Normal Map: its image on another UV map")

    def test_from_behind(self):
        self.roof.rotation_euler = (3.14159, 0, 0)
        self.roof.location.z = 2
        self.tree.end(self.tree.diffuse(Normal=self._map()))
        self.assert_parity("Normal Map: back faces")

    def test_uneven_scale(self):
        self.roof.scale = (1.3, 0.7, -1)
        self.roof.location.z = 2
        stage.twin(self.roof)
        self.tree.end(self.tree.diffuse(Normal=self._map()))
        self.assert_parity("Normal Map: uneven negative scale")

    def test_sphere(self):
        """Blender 5's fade ends at another horizon where the surface is smooth."""
        ball = stage.sphere(1.2, segments=24, rings=12)
        ball.location.z = 2.2
        self.roof.hide_render = True
        ball.data.materials.clear()
        ball.data.materials.append(self.material)
        self.tree.end(self.tree.diffuse(Normal=self._map(size=16, low=0.35, high=0.65)))
        self.assert_approximate("Normal Map: smooth sphere", 0.5, exact=((3, 0), (5, 0)))


class Reflecting(ShaderTest):
    """test_principled.py has the values at all angles."""

    def test_glossy_image(self):
        self.tree.end(self.tree.glossy(self.tree.picture(image(4, low=0.1, high=0.6))))
        self.assert_parity("Glossy BSDF: roughness by an image")

    def test_bright_images(self):
        """Colors above 1, which only a metal clamps."""
        bright = self.tree.picture(image(4, low=0.5, high=2.5))
        for kind in ("diffuse", "glossy", "Principled"):
            inputs = {"Base_Color": bright, "Roughness": 0.8}
            principled = self.tree.node("ShaderNodeBsdfPrincipled", **inputs)
            made = {
                "diffuse": self.tree.diffuse(bright),
                "glossy": self.tree.glossy(0.5, bright),
                "Principled": principled,
            }
            self.tree.end(made[kind])
            self.assert_parity(f"{kind} BSDF: image of colors above 1")

    def test_bright_computed(self):
        bright = self.tree.node("ShaderNodeHueSaturation", Color=(0.9, 0.5, 0.3, 1), Value=2.0)
        inputs = {"Base_Color": bright, "Roughness": 0.6, "Metallic": 0.3}
        self.tree.end(self.tree.node("ShaderNodeBsdfPrincipled", **inputs))
        self.assert_parity("Principled BSDF: Hue/Saturation with a value of 2, metallic 0.3")

    def test_sharp(self):
        node = self.tree.glossy(0.0)
        if any(item.identifier == "SHARP" for item in node.node.bl_rna.properties["distribution"].enum_items):
            node.node.distribution = "SHARP"
        self.tree.end(node)
        self.assert_parity("Glossy BSDF: sharp")

    def test_beckmann(self):
        self.tree.end(self.tree.glossy(0.5, distribution="BECKMANN"))
        self.assert_approximate("Glossy BSDF: Beckmann", 20)

    def test_multiple_scattering(self):
        """Before 4.0 it is a random walk between facets, of which only the brightness is met."""
        if bpy.app.version >= (4, 0, 0):
            self.skipTest("test_principled.py has it at all angles")
        for roughness in (0.5, 1.0):
            self.tree.nodes.clear()
            self.tree.end(self.tree.glossy(roughness, distribution="MULTI_GGX"))
            self.assert_approximate(f"Glossy BSDF: Multiscatter GGX, roughness {roughness:g}", 6)

    def test_rough_diffuse(self):
        self.tree.end(self.tree.diffuse(Roughness=1.0))
        self.assert_parity("Diffuse BSDF: roughness 1")
