"""What Velour ignores is said, by owner's name."""

import bpy

from support import inputs, scenes
from support.notes import NotesTest, export_notes


class Notes(NotesTest):
    def _material(self, shader):
        material = bpy.data.materials.new("Glass")
        material.use_nodes = True
        tree = material.node_tree
        node = tree.nodes.new(shader)
        tree.links.new(node.outputs[0], tree.nodes["Material Output"].inputs["Surface"])
        scenes.add_sphere(material)
        return material

    def test_plain_scene_is_silent(self):
        material = bpy.data.materials.new("Plain")
        material.use_nodes = True
        scenes.add_sphere(material)
        self.assertEqual(self.notes(), [])

    def test_shading_offset_of_the_shadow_terminator(self):
        ball = scenes.add_sphere(bpy.data.materials.new("Plain"))
        name = "shadow_terminator_shading_offset"
        if hasattr(ball, name):
            setattr(ball, name, 0.3)
        else:  # before Blender 5.0
            ball.cycles.shadow_terminator_offset = 0.3
        self.assert_said(f"Object '{ball.name}'", "shading offset", "0.3")

    def test_unsupported_shader(self):
        self._material("ShaderNodeBsdfToon")
        self.assert_said("Material 'Glass'", "Toon BSDF", "rendered gray")

    def test_index_of_refraction(self):
        tree = self._material("ShaderNodeBsdfPrincipled").node_tree
        node = next(n for n in tree.nodes if "Base Color" in n.inputs and n.outputs[0].is_linked)
        self.assertEqual(self.notes(), [])
        node.inputs["IOR"].default_value = 2.0
        self.assertEqual(self.notes(), [])
        node.inputs["IOR"].default_value = 0.8
        self.assertEqual(self.notes(), [])

    def test_linked_texture(self):
        material = self._material("ShaderNodeBsdfPrincipled")
        tree = material.node_tree
        node = next(
            n for n in tree.nodes if n.bl_idname == "ShaderNodeBsdfPrincipled" and n.outputs[0].is_linked
        )
        wires = tree.nodes.new("ShaderNodeWireframe")
        tree.links.new(wires.outputs[0], node.inputs["Base Color"])
        self.assert_said("Material 'Glass'", node.name, "Base Color")

    def _linked(self, idname, shader="ShaderNodeBsdfDiffuse", socket="Normal"):
        """A material of a shader with another node at one of its inputs; both nodes."""
        tree = self._material(shader).node_tree
        node = next(n for n in tree.nodes if socket in n.inputs and n.outputs[0].is_linked)
        other = tree.nodes.new(idname)
        tree.links.new(other.outputs[0], node.inputs[socket])
        return node, other

    def test_other_normals(self):
        node, tangent = self._linked("ShaderNodeTangent")
        self.assert_said("Material 'Glass'", node.name, "'Normal'", f"'{tangent.name}' is not a node that")

    def test_bump(self):
        self._linked("ShaderNodeBump")
        self.assertEqual(self.notes(), [])

    def test_spaces_of_normal_maps(self):
        glossy, normal_map = self._linked("ShaderNodeNormalMap", "ShaderNodeBsdfGlossy")
        glossy.distribution = "GGX"  # newer Blenders begin with another
        self.assertEqual(self.notes(), [])
        normal_map.space = "WORLD"
        self.assert_said("Material 'Glass'", normal_map.name, "tangent space")

    def test_distributions(self):
        tree = self._material("ShaderNodeBsdfGlossy").node_tree
        node = next(n for n in tree.nodes if hasattr(n, "distribution") and n.outputs[0].is_linked)
        node.distribution = "GGX"
        self.assertEqual(self.notes(), [])
        node.distribution = "BECKMANN"
        self.assert_said("Material 'Glass'", node.name, "'Beckmann' is not supported; rendered as GGX")

    def _shows_attribute(self, name, idname="ShaderNodeAttribute"):
        """A sphere of colors by an attribute; the object and the node."""
        _, node = self._linked(idname, socket="Color")
        setattr(node, "attribute_name" if idname == "ShaderNodeAttribute" else "layer_name", name)
        return bpy.context.object, node

    def test_missing_attribute(self):
        obj, _ = self._shows_attribute("paint")
        self.assert_said(
            f"Object '{obj.name}'", "no attribute 'paint'", "material 'Glass'", "0 is used instead"
        )
        obj.data.attributes.new("paint", "FLOAT_COLOR", "POINT")
        self.assertEqual(self.notes(), [])

    def test_attribute_of_edges(self):
        obj, _ = self._shows_attribute("paint")
        obj.data.attributes.new("paint", "FLOAT", "EDGE")
        self.assert_said("attribute 'paint'", "is stored on edges", "0 is used instead")

    def test_generated_image_needs_no_uv_map(self):
        _, image = self._linked("ShaderNodeTexImage", socket="Color")
        image.image = bpy.data.images.new("texels", 4, 4)
        tree = image.id_data
        place = tree.nodes.new("ShaderNodeTexCoord")
        tree.links.new(place.outputs["Generated"], image.inputs["Vector"])
        layers = bpy.context.object.data.uv_layers
        while layers:
            layers.remove(layers[0])
        self.assertEqual(self.notes(), [])
        tree.links.new(place.outputs["UV"], image.inputs["Vector"])
        self.assert_said("UV map")

    def test_cubic_interpolation(self):
        _, image = self._linked("ShaderNodeTexImage", socket="Color")
        image.image, image.interpolation = bpy.data.images.new("texels", 4, 4), "Cubic"
        self.assert_said("Material 'Glass'", image.name, "cubic interpolation is not supported")

    def test_normals_without_unit_length(self):
        if bpy.app.version >= (4, 0):
            self.skipTest("Cycles normalizes them")
        _, mixed = self._linked("ShaderNodeMixRGB")
        self.assert_said("Material 'Glass'", mixed.name, "may not have unit length")

    def test_values_beyond_the_range_of_principled(self):
        if bpy.app.version >= (4, 0):
            self.skipTest("Cycles clamps them")
        tree = self._material("ShaderNodeBsdfPrincipled").node_tree
        node = next(n for n in tree.nodes if "Metallic" in n.inputs and n.outputs[0].is_linked)
        node.distribution = "GGX"
        value = tree.nodes.new("ShaderNodeValue")
        value.outputs[0].default_value = 1.5
        for name in ("Metallic", "Roughness", "Clearcoat"):
            with self.subTest(name):
                link = tree.links.new(value.outputs[0], node.inputs[name])
                self.assert_said("Material 'Glass'", node.name, f"'{name}' is 1.5; 1 is used instead")
                tree.links.remove(link)

    def test_missing_color_attribute(self):
        obj, _ = self._shows_attribute("", "ShaderNodeVertexColor")
        self.assert_said(f"Object '{obj.name}'", "no color attribute", "material 'Glass'")
        obj.data.color_attributes.new("paint", "BYTE_COLOR", "CORNER")
        self.assertEqual(self.notes(), [])

    def test_attributes_of_objects(self):
        _, node = self._shows_attribute("paint")
        node.attribute_type = "OBJECT"
        self.assert_said("Material 'Glass'", "'Color'", f"'{node.name}' reads an attribute of type 'Object'")

    def test_many_attributes(self):
        """Five in one material, of which four are shown."""
        tree = self._material("ShaderNodeBsdfPrincipled").node_tree
        node = next(n for n in tree.nodes if "Metallic" in n.inputs and n.outputs[0].is_linked)
        mesh = bpy.context.object.data
        emission = "Emission Color" if "Emission Color" in node.inputs else "Emission"
        inputs_of = ("Base Color", "Metallic", "Roughness", "Alpha", emission)
        node.inputs["Emission Strength"].default_value = 1.0  # 0 in newer Blenders
        for i, socket in enumerate(inputs_of):
            self.assertEqual(self.notes(), [])
            shown = tree.nodes.new("ShaderNodeAttribute")
            shown.attribute_name = f"paint {i}"
            mesh.attributes.new(shown.attribute_name, "FLOAT_COLOR", "POINT")
            tree.links.new(shown.outputs["Color"], node.inputs[socket])
        self.assert_said("Material 'Glass'", "5 mesh attributes", "only 4")

    def test_unsupported_part_of_a_mix(self):
        tree = self._material("ShaderNodeMixShader").node_tree
        mix = next(n for n in tree.nodes if n.bl_idname == "ShaderNodeMixShader")
        tree.links.new(tree.nodes.new("ShaderNodeBsdfTransparent").outputs[0], mix.inputs[1])
        self.assertEqual(self.notes(), [])
        tree.links.new(tree.nodes.new("ShaderNodeBsdfTranslucent").outputs[0], mix.inputs[2])
        self.assertEqual(self.notes(), [])
        tree.links.new(tree.nodes.new("ShaderNodeBsdfToon").outputs[0], mix.inputs[2])
        self.assert_said("Material 'Glass'", "Toon BSDF", "rendered gray")

    def test_ignored_input(self):
        material = self._material("ShaderNodeBsdfPrincipled")
        for node in material.node_tree.nodes:
            if "Anisotropic" in node.inputs:
                node.inputs["Anisotropic"].default_value = 0.5
        self.assert_said("Material 'Glass'", "'Anisotropic'")

    def test_object_visibility(self):
        obj = scenes.add_sphere()
        self.assertEqual(self.notes(), [])
        obj.visible_camera = obj.visible_shadow = False
        self.assertEqual(self.notes(), [])
        obj.visible_glossy, obj.is_shadow_catcher = False, True
        self.assert_said("Object 'Sphere'", "hiding it from glossy rays only")
        self.assert_said("Object 'Sphere'", "Shadow Catcher is not supported")

    def test_light_visibility(self):
        lamp = bpy.data.objects.new("Spot", bpy.data.lights.new("Spot", "SPOT"))
        bpy.context.scene.collection.objects.link(lamp)
        lamp.visible_camera = False  # it never is
        self.assertEqual(self.notes(), [])
        lamp.visible_glossy = False
        self.assert_said("Light 'Spot'", "hiding it from glossy rays")

    def test_world_without_shadows(self):
        settings = bpy.context.scene.world.cycles
        if not hasattr(settings, "use_shadows"):
            self.skipTest("worlds cast shadows before Blender 5.2")
        settings.use_shadows = False
        self.assert_said(f"World '{bpy.context.scene.world.name}'", "disabling its shadows")

    def _picture_on(self, tree, uv_map, socket):
        """Links an image on that UV map, which the object has then, to an input."""
        node, source = tree.nodes.new("ShaderNodeTexImage"), tree.nodes.new("ShaderNodeUVMap")
        node.image, source.uv_map = bpy.data.images.new(uv_map, 4, 4), uv_map
        tree.links.new(source.outputs[0], node.inputs["Vector"])
        tree.links.new(node.outputs[0], socket)
        bpy.context.object.data.uv_layers.new(name=uv_map)

    def test_several_uv_maps_of_a_material(self):
        tree = self._material("ShaderNodeBsdfPrincipled").node_tree
        shader = next(n for n in tree.nodes if "Metallic" in n.inputs and n.outputs[0].is_linked)
        for socket, uv_map in zip(("Base Color", "Metallic", "Roughness", "Alpha"), "abcd", strict=True):
            self._picture_on(tree, uv_map, shader.inputs[socket])
        self.assertEqual(self.notes(), [])
        normal_map = tree.nodes.new("ShaderNodeNormalMap")
        tree.links.new(normal_map.outputs[0], shader.inputs["Normal"])
        self._picture_on(tree, "e", normal_map.inputs["Color"])
        self.assert_said("Material 'Glass'", "5 UV maps", "'a'")

    def test_normal_maps_on_several_uv_maps(self):
        tree = self._material("ShaderNodeAddShader").node_tree
        add = next(n for n in tree.nodes if n.bl_idname == "ShaderNodeAddShader")
        for i, uv_map in enumerate("ab"):
            shader, normal_map = (
                tree.nodes.new("ShaderNodeBsdfDiffuse"),
                tree.nodes.new("ShaderNodeNormalMap"),
            )
            normal_map.uv_map = uv_map
            tree.links.new(shader.outputs[0], add.inputs[i])
            tree.links.new(normal_map.outputs[0], shader.inputs["Normal"])
            self._picture_on(tree, uv_map, normal_map.inputs["Color"])
        self.assert_said("Material 'Glass'", "Normal Maps use several UV maps", "'a'")

    def test_light_factors(self):
        lamp = bpy.data.objects.new("Fill", bpy.data.lights.new("Fill", "POINT"))
        bpy.context.scene.collection.objects.link(lamp)
        self.assertEqual(self.notes(), [])
        lamp.data.specular_factor = 0.0
        self.assert_said("Light 'Fill'", "specular")

    def test_lamps_with_ies_files(self):
        lamp = bpy.data.lights.new("Down", "SPOT")
        bpy.context.scene.collection.objects.link(bpy.data.objects.new("Down", lamp))
        lamp.use_nodes = True
        tree = lamp.node_tree
        self.assertEqual(self.notes(), [])
        profile = tree.nodes.new("ShaderNodeTexIES")
        tree.links.new(profile.outputs[0], tree.nodes["Emission"].inputs["Strength"])
        self.assert_said("Light 'Down'", "shader nodes that vary by place or direction")

    def test_hair(self):
        obj = scenes.add_sphere()
        obj.modifiers.new("Fur", "PARTICLE_SYSTEM")
        obj.particle_systems[0].settings.type = "HAIR"
        self.assert_said("Object 'Sphere'", "hair")
        obj.show_instancer_for_render = obj.show_instancer_for_viewport = False
        self.assert_said("Object 'Sphere'", "hair")
        obj.modifiers["Fur"].show_render = False
        self.assertFalse([note for note in self.notes() if "hair" in note])

    def test_adaptive_subdivision(self):
        if not hasattr(bpy.types.Object, "cycles"):
            self.skipTest("Cycles is not enabled")
        obj = scenes.add_sphere()
        modifier = obj.modifiers.new("Subdivision", "SUBSURF")
        newer = hasattr(modifier, "use_adaptive_subdivision")  # 5.0 and newer
        (modifier if newer else obj.cycles).use_adaptive_subdivision = True
        if not newer:
            self.assertEqual(self.notes(), [])  # the setting stays after the feature set is no longer chosen
            bpy.context.scene.cycles.feature_set = "EXPERIMENTAL"
            bpy.context.scene.update_tag()  # which a property of an add-on does not do by itself
        self.assert_said("Object 'Sphere'", "adaptive subdivision")
        modifier.show_render = False
        self.assertEqual(self.notes(), [])
        modifier.show_render = True
        obj.modifiers.new("Twist", "SIMPLE_DEFORM")
        self.assertEqual(self.notes(), [])

    def test_volume(self):
        obj = bpy.data.objects.new("Fog", bpy.data.volumes.new("Fog"))
        bpy.context.scene.collection.objects.link(obj)
        self.assert_said("Object 'Fog'", "volumes")

    def test_missing_model_in_a_preview(self):
        """Previews render the approximation and say why."""
        scenes.add_sphere()
        bpy.ops.velour.add_material()
        self.assertIn("has no model", "".join(export_notes(strict=False)))
        with self.assertRaisesRegex(inputs.module("export").ExportError, "has no model"):
            export_notes()
