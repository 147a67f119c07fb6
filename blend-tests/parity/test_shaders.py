"""Shaders that are mixed and added: what lets light through, what reflects and what glows."""

import bpy
import numpy as np

from parity import stage
from parity.case import ParityTest
from parity.shaders import Tree, image


class ShaderTest(ParityTest):
    """A roof over a coloured ground, seen from above at an angle: camera and shadow rays meet it."""

    def setUp(self):
        super().setUp()
        stage.ground(12, 0.6)
        stage.box((-2.5, 0.5, 0), (-1.5, 1.5, 0.6), 0.3)
        self.material = bpy.data.materials.new("Roof")
        self.tree = Tree(self.material)
        corners = [(-1.5, -1.2, 1), (1.5, -1.2, 1), (1.5, 1.2, 1), (-1.5, 1.2, 1)]
        self.roof = stage.mesh(corners, [(0, 1, 2, 3)], self.material, "Roof")
        layer = self.roof.data.uv_layers.new(name="UVMap")
        layer.data.foreach_set("uv", [0, 0, 1, 0, 1, 1, 0, 1])
        stage.camera((0, -5, 6), (0.7, 0, 0), 45)
        stage.sharp_sun()
        stage.world((0.6, 0.8, 1), 0.4)


class Mixed(ShaderTest):
    def test_transparent(self):
        self.tree.end(self.tree.transparent())
        self.assert_parity("Transparent BSDF: white")

    def test_coloured_transparent(self):
        self.tree.end(self.tree.transparent((0.9, 0.5, 0.2)))
        self.assert_parity("Transparent BSDF: colour")

    def test_textured_transparent(self):
        self.tree.end(self.tree.transparent(self.tree.picture(image())))
        self.assert_parity("Transparent BSDF: image")

    def test_mix(self):
        self.tree.end(self.tree.mix(0.7, self.tree.transparent(), self.tree.diffuse((0.8, 0.3, 0.1))))
        self.assert_parity("Mix Shader: Transparent and Diffuse")

    def test_coloured_mix(self):
        tree = self.tree
        tree.end(tree.mix(0.4, tree.transparent((0.9, 0.3, 0.6)), tree.diffuse((0.8, 0.3, 0.1))))
        self.assert_parity("Mix Shader: coloured Transparent and Diffuse")

    def test_cut_out(self):
        tree = self.tree
        leaf = image(alpha=True)
        diffuse = tree.diffuse(tree.picture(leaf))
        tree.end(tree.mix(tree.picture(leaf, "Alpha"), tree.transparent(), diffuse))
        self.assert_parity("Mix Shader: cut-out by an image's alpha")

    def test_image_factor(self):
        tree = self.tree
        factor = tree.picture(image(3))
        tree.end(tree.mix(factor, tree.diffuse((0.9, 0.2, 0.2)), tree.diffuse((0.1, 0.3, 0.9))))
        self.assert_parity("Mix Shader: factor of an image's colour")

    def _bounce_once(self):
        """Cycles counts light of a surface that glows as one bounce less: nothing may see what it lights."""
        scene = bpy.context.scene
        bpy.data.objects["Box"].hide_render = True
        scene.velour.bounces = scene.cycles.max_bounces = scene.cycles.diffuse_bounces = 1
        if hasattr(self.material.cycles, "sample_as_light"):
            self.material.cycles.sample_as_light = False
        else:
            self.material.cycles.emission_sampling = "NONE"  # 3.5 and newer

    def test_emission(self):
        self._bounce_once()
        tree = self.tree
        tree.end(tree.mix(0.3, tree.diffuse((0.5, 0.5, 0.5)), tree.emission()))
        self.assert_parity("Mix Shader: Diffuse and Emission")

    def test_emission_image(self):
        self._bounce_once()
        tree = self.tree
        glow = tree.emission(tree.picture(image(6)), tree.picture(image(8, low=0.5, high=2)))
        tree.end(tree.add(glow, tree.diffuse((0.4, 0.4, 0.4))))
        self.assert_parity("Emission: colour and strength by images")

    def test_principled_emission(self):
        self._bounce_once()
        tree = self.tree
        inputs = {"Emission": tree.picture(image(6)), "Emission Strength": 0.7}
        principled = tree.node("ShaderNodeBsdfPrincipled", Base_Color=(0, 0, 0, 1), Alpha=0.6, Specular=0.0)
        for name, value in inputs.items():
            tree.set(principled.node.inputs[name], value)
        tree.end(principled)
        self.assert_parity("Principled BSDF: emission by an image, alpha")

    def test_add(self):
        self._bounce_once()
        tree = self.tree
        tree.end(tree.add(tree.diffuse((0.5, 0.5, 0.5)), tree.emission()))
        self.assert_parity("Add Shader: Diffuse and Emission")

    def test_add_transparent(self):
        tree = self.tree
        tree.end(tree.add(tree.diffuse((0.5, 0.5, 0.5)), tree.transparent((0.6, 0.8, 1))))
        self.assert_parity("Add Shader: Diffuse and Transparent")

    def test_nested(self):
        self._bounce_once()
        tree = self.tree
        inner = tree.mix(tree.picture(image(5)), tree.diffuse((0.9, 0.5, 0.1)), tree.transparent())
        tree.end(tree.mix(0.25, tree.add(inner, tree.emission(strength=0.2)), tree.diffuse((0.1, 0.4, 0.1))))
        self.assert_parity("Mix Shader: nested")

    def test_one_side_empty(self):
        tree = self.tree
        node = tree.nodes.new("ShaderNodeMixShader")
        node.inputs[0].default_value = 0.4
        tree.links.new(tree.diffuse(), node.inputs[2])
        tree.end(node.outputs[0])
        self.assert_parity("Mix Shader: one side empty")

    def test_alpha_of_the_film(self):
        tree = self.tree
        for name in ("Ground", "Box"):
            bpy.data.objects[name].hide_render = True
        bpy.context.scene.render.film_transparent = True
        tree.end(tree.mix(tree.picture(image(7)), tree.transparent((1, 0.5, 0.5)), tree.diffuse()))
        self.assert_parity("Mix Shader: transparent film")

    def test_bounces(self):
        scene = bpy.context.scene
        scene.velour.bounces = scene.cycles.max_bounces = scene.cycles.diffuse_bounces = 2
        tree = self.tree
        tree.end(tree.mix(0.5, tree.transparent((1, 0.6, 0.3)), tree.diffuse((0.9, 0.9, 0.9))))
        self.assert_parity("Mix Shader: two bounces", samples=2)


class Groups(ShaderTest):
    """Shaders inside a node group, whose inputs are set outside."""

    def _group(self):
        group = bpy.data.node_groups.new("Leaf", "ShaderNodeTree")
        if hasattr(group, "interface"):  # 4.0 and newer
            for name, kind in (("Amount", "NodeSocketFloat"), ("Tint", "NodeSocketColor")):
                group.interface.new_socket(name=name, in_out="INPUT", socket_type=kind)
            group.interface.new_socket(name="Shader", in_out="OUTPUT", socket_type="NodeSocketShader")
        else:
            group.inputs.new("NodeSocketFloat", "Amount")
            group.inputs.new("NodeSocketColor", "Tint")
            group.outputs.new("NodeSocketShader", "Shader")
        nodes, links = group.nodes, group.links
        given, end = nodes.new("NodeGroupInput"), nodes.new("NodeGroupOutput")
        mix, diffuse = nodes.new("ShaderNodeMixShader"), nodes.new("ShaderNodeBsdfDiffuse")
        links.new(given.outputs["Amount"], mix.inputs[0])
        links.new(given.outputs["Tint"], diffuse.inputs["Color"])
        links.new(nodes.new("ShaderNodeBsdfTransparent").outputs[0], mix.inputs[1])
        links.new(diffuse.outputs[0], mix.inputs[2])
        links.new(mix.outputs[0], end.inputs[0])
        return group

    def test_group(self):
        tree = self.tree
        picture = tree.picture(image(9))
        settings = {"node_tree": self._group()}
        tree.end(tree.node("ShaderNodeGroup", settings=settings, Amount=0.6, Tint=picture))
        self.assert_parity("Node group with inputs")


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

    def test_glossy(self):
        """Steep facets show what a roughness of 1 shows of flat ones."""
        self.tree.end(self.tree.glossy(0.4, Normal=self._map(low=0.35, high=0.65)))
        self.assert_approximate("Normal Map: Glossy", 1, samples=4)

    def test_half_strength(self):
        """Before strength scaled tilt in tangent space, Cycles interpolated the normals themselves."""
        self.tree.end(self.tree.diffuse(Normal=self._map(0.5)))
        self.assert_approximate("Normal Map: strength 0.5", 4)

    def test_strong(self):
        self.tree.end(self.tree.diffuse(Normal=self._map(2.0)))
        self.assert_approximate("Normal Map: strength 2", 4)

    def test_mirrored(self):
        layer = self.roof.data.uv_layers["UVMap"]
        layer.data.foreach_set("uv", [1, 0.2, 0, 0, 0.1, 1, 1, 1])
        self.tree.end(self.tree.diffuse(Normal=self._map()))
        self.assert_parity("Normal Map: mirrored and sheared UV map")

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
        ball = stage.sphere(1.2, segments=24, rings=12)
        ball.location.z = 2.2
        self.roof.hide_render = True
        ball.data.materials.clear()
        ball.data.materials.append(self.material)
        self.tree.end(self.tree.diffuse(Normal=self._map(size=16, low=0.35, high=0.65)))
        self.assert_parity("Normal Map: smooth sphere")


class Reflecting(ShaderTest):
    def test_glossy(self):
        self.tree.end(self.tree.glossy(0.5))
        self.assert_parity("Glossy BSDF: GGX, roughness 0.5")

    def test_glossy_image(self):
        self.tree.end(self.tree.glossy(self.tree.picture(image(4, low=0.1, high=0.6))))
        self.assert_parity("Glossy BSDF: roughness by an image")

    def test_roughest(self):
        """Before 3.5, Cycles masks incoming and outgoing light as if their shadows were independent."""
        self.tree.end(self.tree.glossy(1.0))
        self.assert_approximate("Glossy BSDF: GGX, roughness 1", 2)

    def test_sharp(self):
        self.tree.end(self.tree.glossy(0.0, distribution="SHARP"))
        self.assert_parity("Glossy BSDF: sharp")

    def test_beckmann(self):
        self.tree.end(self.tree.glossy(0.5, distribution="BECKMANN"))
        self.assert_approximate("Glossy BSDF: Beckmann", 20)

    def test_rough_diffuse(self):
        self.tree.end(self.tree.diffuse(Roughness=1.0))
        self.assert_parity("Diffuse BSDF: roughness 1")

    def test_principled(self):
        """Before 4.0, Blender's base is brighter at grazing angles, as Disney's is."""
        self.tree.end(self.tree.node("ShaderNodeBsdfPrincipled", Roughness=0.9, Specular=0.0))
        self.assert_approximate("Principled BSDF: base, roughness 0.9", 6)
