"""Shaders that are mixed and added: what lets light through, and what glows."""

import bpy

from parity import stage
from parity.shaders import ShaderTest, image, mapped_picture, node_group


class Mixed(ShaderTest):
    def test_transparent(self):
        self.tree.end(self.tree.transparent())
        self.assert_parity("Transparent BSDF: white")

    def test_colored_transparent(self):
        self.tree.end(self.tree.transparent((0.9, 0.5, 0.2)))
        self.assert_parity("Transparent BSDF: color")

    def test_textured_transparent(self):
        self.tree.end(self.tree.transparent(self.tree.picture(image())))
        self.assert_parity("Transparent BSDF: image")

    def test_mix(self):
        self.tree.end(self.tree.mix(0.7, self.tree.transparent(), self.tree.diffuse((0.8, 0.3, 0.1))))
        self.assert_parity("Mix Shader: Transparent and Diffuse")

    def test_colored_mix(self):
        tree = self.tree
        tree.end(tree.mix(0.4, tree.transparent((0.9, 0.3, 0.6)), tree.diffuse((0.8, 0.3, 0.1))))
        self.assert_parity("Mix Shader: colored Transparent and Diffuse")

    def test_cut_out(self):
        tree = self.tree
        leaf = image(alpha=True)
        diffuse = tree.diffuse(tree.picture(leaf))
        tree.end(tree.mix(tree.picture(leaf, "Alpha"), tree.transparent(), diffuse))
        self.assert_parity("Mix Shader: cut-out by an image's alpha")

    def test_computed_factor(self):
        tree = self.tree
        tree.end(tree.mix(tree.node("ShaderNodeFresnel"), tree.transparent(), tree.diffuse()))
        self.assert_parity("Mix Shader: factor of a Fresnel node")

    def test_other_factors(self):
        tree = self.tree
        tree.end(tree.mix(tree.node("ShaderNodeAmbientOcclusion"), tree.transparent(), tree.diffuse()))
        name = self.tree.nodes.new("ShaderNodeMixShader").inputs[0].name  # not the same in all versions
        self.assert_ignored(
            "Mix Shader: factor of an Ambient Occlusion node", f"the link to '{name}' is not supported"
        )

    def test_image_factor(self):
        tree = self.tree
        factor = tree.picture(image(3))
        tree.end(tree.mix(factor, tree.diffuse((0.9, 0.2, 0.2)), tree.diffuse((0.1, 0.3, 0.9))))
        self.assert_parity("Mix Shader: factor of an image's color")

    def test_light_path(self):
        """What glTF files without shading are imported as, and a roof that only shadow rays pass."""
        tree = self.tree
        stage.world((0, 0, 0))  # whose light Cycles finds by other rays, too
        for output, first, second in (
            ("Is Camera Ray", tree.transparent(), tree.emission()),
            ("Is Shadow Ray", tree.diffuse((0.8, 0.3, 0.2)), tree.transparent((0.5, 0.9, 0.6))),
        ):
            with self.subTest(output):
                tree.end(tree.mix(tree.node("ShaderNodeLightPath", output), first, second))
                self.assert_parity(f"Light Path: {output}, as the factor of a mix")

    def test_opaque_shadows(self):
        tree, material = self.tree, self.material
        owner = material if hasattr(material, "use_transparent_shadow") else material.cycles
        owner.use_transparent_shadow = False
        stage.world((0, 0, 0))
        tree.end(tree.mix(0.6, tree.transparent(), tree.diffuse()))
        self.assert_parity("Transparent BSDF: opaque shadows")

    def test_emission(self):
        tree = self.tree
        tree.end(tree.mix(0.3, tree.diffuse((0.5, 0.5, 0.5)), tree.emission()))
        self.assert_parity("Mix Shader: Diffuse and Emission")

    def test_emission_image(self):
        tree = self.tree
        glow = tree.emission(tree.picture(image(6)), tree.picture(image(8, low=0.5, high=2)))
        tree.end(tree.add(glow, tree.diffuse((0.4, 0.4, 0.4))))
        self.assert_parity("Emission: color and strength by images")

    def test_principled_emission(self):
        tree = self.tree
        glow = {"Emission": tree.picture(image(6)), "Emission_Strength": 0.7}
        principled = tree.node(
            "ShaderNodeBsdfPrincipled", Base_Color=(0, 0, 0, 1), Alpha=0.6, Specular=0.0, **glow
        )
        tree.end(principled)
        self.assert_parity("Principled BSDF: emission by an image, alpha")

    def test_only_a_volume(self):
        """What lies behind the border of a volume is seen; Velour leaves the volume itself out."""
        absorption = self.tree.node("ShaderNodeVolumeAbsorption", Density=0.0)
        output = self.tree.nodes.new("ShaderNodeOutputMaterial")
        self.tree.links.new(absorption, output.inputs["Volume"])
        self.assert_parity("Material Output: a volume alone")

    def test_colors_in_place_of_shaders(self):
        tree = self.tree
        tree.end(tree.mix(0.6, tree.picture(image(6)), tree.diffuse((0.5, 0.5, 0.5))))
        self.assert_parity("Mix Shader: an image in place of a shader")

    def test_add(self):
        tree = self.tree
        tree.end(tree.add(tree.diffuse((0.5, 0.5, 0.5)), tree.emission()))
        self.assert_parity("Add Shader: Diffuse and Emission")

    def test_add_transparent(self):
        tree = self.tree
        tree.end(tree.add(tree.diffuse((0.5, 0.5, 0.5)), tree.transparent((0.6, 0.8, 1))))
        self.assert_parity("Add Shader: Diffuse and Transparent")

    def test_nested(self):
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
        inputs = {"Amount": "NodeSocketFloat", "Tint": "NodeSocketColor"}
        group, given, end = node_group(inputs, "Shader")
        nodes, links = group.nodes, group.links
        mix, diffuse = nodes.new("ShaderNodeMixShader"), nodes.new("ShaderNodeBsdfDiffuse")
        links.new(given.outputs["Amount"], mix.inputs[0])
        links.new(given.outputs["Tint"], diffuse.inputs["Color"])
        links.new(nodes.new("ShaderNodeBsdfTransparent").outputs[0], mix.inputs[1])
        links.new(diffuse.outputs[0], mix.inputs[2])
        links.new(mix.outputs[0], end.inputs[0])
        return group

    def test_outputs_of_engines(self):
        """Cycles has one of its own, which is not the active one."""
        tree = self.tree
        tree.end(tree.diffuse((0.1, 0.2, 0.9)), "ALL")
        tree.end(tree.diffuse((0.2, 0.9, 0.1)), "CYCLES")
        tree.end(tree.diffuse((0.9, 0.1, 0.1)), "EEVEE")
        self.assert_parity("Material Output: of Cycles beside those of others")

    def test_hidden_links(self):
        """A link from an output that another mode of its node has hidden."""
        tree = self.tree
        factor = tree.node("ShaderNodeVectorMath", "Value", {"operation": "DOT_PRODUCT"})
        factor.node.inputs[0].default_value = factor.node.inputs[1].default_value = (0.7, 0, 0)
        mixed = tree.mix(0.25, tree.diffuse((0.9, 0.2, 0.1)), tree.diffuse((0.1, 0.9, 0.2)))
        mixed.node.inputs[0].default_value = 0.25
        tree.set(mixed.node.inputs[0], factor)
        tree.end(mixed)
        factor.node.operation = "SUBTRACT"
        self.assert_parity("Links of hidden sockets")

    def test_output_of_eevee(self):
        tree = self.tree
        tree.end(tree.diffuse((0.9, 0.1, 0.1)), "EEVEE")
        self.assert_parity("Material Output: only that of EEVEE")

    def test_group(self):
        tree = self.tree
        picture = tree.picture(image(9))
        settings = {"node_tree": self._group()}
        tree.end(tree.node("ShaderNodeGroup", settings=settings, Amount=0.6, Tint=picture))
        self.assert_parity("Node group with inputs")

    def test_mapping(self):
        """The numbers of its Mapping node are set outside of the group."""
        settings = {"node_tree": mapped_picture("ShaderNodeTexImage", image(9), "UV")}
        placed = self.tree.node("ShaderNodeGroup", settings=settings, Turn=(0, 0, 0.6), Size=(2.5, 0.7, 1))
        self.tree.end(self.tree.diffuse(placed))
        self.assert_parity("Node group: mapping by its inputs")
