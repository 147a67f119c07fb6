"""Programs that the export makes of nodes."""

from unittest import mock

import bpy
import numpy as np

from support import inputs
from support.blender import BlenderTest


def _export(name):
    return inputs.module(f"export.{name}")


class ProgramDrafts(BlenderTest):
    def setUp(self):
        super().setUp()
        self.material = bpy.data.materials.new("Bumpy")
        self.material.use_nodes = True
        self.tree = self.material.node_tree
        self.shader = self.tree.nodes["Principled BSDF"]

    def _node(self, idname, **links):
        """A node; `links`: outputs or values by the names of inputs."""
        node = self.tree.nodes.new(f"ShaderNode{idname}")
        for name, value in links.items():
            if isinstance(value, bpy.types.NodeSocket):
                self.tree.links.new(value, node.inputs[name])
            else:
                node.inputs[name].default_value = value
        return node

    def _draft(self):
        """The material's Draft, and what is noted."""
        notes = _export("notes").Notes()
        layers = _export("shaders").surface_layers(self.material, notes)
        found = [picture for layer in layers for picture in layer.pictures.values()]
        found += [layer.relief.picture for layer in layers if layer.relief]
        return next(each.draft for each in found if hasattr(each, "draft")), list(notes)

    def _link_bump(self, *widths):
        """Links a chain of Bump nodes, as if these were their filter widths."""
        height, normal = self._node("TexNoise").outputs["Fac"], {}
        plugs, sockets = _export("plugs"), {}
        for width in widths:
            bump = self._node("Bump", Height=height, **normal)
            normal = {"Normal": bump.outputs["Normal"]}
            sockets[bump.name] = self._node("Math")  # before Blender 4.5, they have no such input
            sockets[bump.name].inputs[0].default_value = width
        self.tree.links.new(normal["Normal"], self.shader.inputs["Normal"])
        of_node = plugs.Plug.input

        def found(plug, *names):
            if names == ("Filter Width",) and plug.node.name in sockets:
                return plugs.Plug(sockets[plug.node.name].inputs[0])
            return of_node(plug, *names)

        patch = mock.patch.object(plugs.Plug, "input", found)
        patch.start()
        self.addCleanup(patch.stop)

    def _displace(self, height):
        moved = self._node("Displacement", Height=height)
        end = self.tree.nodes["Material Output"]
        self.tree.links.new(moved.outputs[0], end.inputs["Displacement"])
        owner = self.material if hasattr(self.material, "displacement_method") else self.material.cycles
        owner.displacement_method = "BUMP"

    def test_filter_width(self):
        """It may be wider than a pixel."""
        self._link_bump(8.0)
        draft, notes = self._draft()
        self.assertEqual(draft.width, 8.0)
        self.assertEqual(notes, [])

    def test_different_filter_widths(self):
        self._link_bump(8.0, 2.0, 4.0)
        draft, notes = self._draft()
        self.assertEqual(draft.width, 2.0)
        self.assertTrue(any("filter widths" in note for note in notes), notes)

    def test_filter_width_of_displacement(self):
        self._displace(self._node("TexNoise").outputs["Fac"])
        self.assertEqual(self._draft()[0].width, 0.1 if bpy.app.version >= (4, 4) else 1.0)
        with mock.patch.object(_export("programs.normal_nodes"), "_USUAL_WIDTH", 0.1):
            self.assertEqual(self._draft()[0].width, 0.1)
            self._link_bump(float(np.float32(0.1)))  # the usual width of Bump nodes
            draft, notes = self._draft()
        self.assertAlmostEqual(draft.width, 0.1)
        self.assertEqual(notes, [])

    def test_normal_as_height(self):
        """Blender 4.4 and newer interpolate it at the points beside."""
        place = self._node("TexCoord").outputs["Normal"]
        bump = self._node("Bump", Height=self._node("TexNoise", Vector=place).outputs["Fac"])
        self.tree.links.new(bump.outputs["Normal"], self.shader.inputs["Normal"])
        for shifts, expected in ((False, {"none"}), (True, {"none", "x", "y"})):
            with mock.patch.object(_export("programs.coordinate_nodes"), "_SHIFTS_NORMAL", shifts):
                steps = self._draft()[0].steps
            sources = [step.choices for step in steps if step.operation == "source"]
            self.assertEqual({shift for kind, _, shift in sources if kind == "object_normal"}, expected)

    def test_node_of_displacement_and_surface(self):
        """The surface sees the displaced normal, the displacement the normal before it."""
        weight = self._node("LayerWeight").outputs["Facing"]
        self._displace(weight)
        self.tree.links.new(weight, self.shader.inputs["Roughness"])
        steps = self._draft()[0].steps
        bump = next(step.output for step in steps if step.operation == "bump")
        normals = [step.inputs[1].first for step in steps if step.operation == "layer_weight"]
        self.assertEqual([normal == bump for normal in normals], [False, True])

    def test_attribute_without_a_set(self):
        """Nodes compute with a constant, not with another attribute."""
        colors, programs = _export("corner_colors"), _export("programs")
        shown = colors.CornerColors("shown", "Color", False)
        for otherwise in (0.0, 1.0):
            missing = colors.CornerColors("missing", "Alpha", False, otherwise)
            draft = programs.Draft()
            value = draft.source("corner", _export("programs.draft").CornerSet(missing))
            output = draft.output(draft.vector_math("add", value, draft.vector((0.5, 0.5, 0.5)))[0], "color")
            sky = np.array([(0, 0, 1)], np.float32)
            with programs.finished(draft, None, (shown,), None) as program:
                found = program.radiance(output.index, "others", sky)
            np.testing.assert_array_equal(found, [[otherwise + 0.5] * 3])
