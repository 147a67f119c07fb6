"""Attributes of meshes as colors, against what Cycles gives of them."""

import bpy
import numpy as np
from velour.export.color import luminance_weights

from support import inputs, scenes
from support.blender import BlenderTest

COLOR, VECTOR, BYTES = (0.9, 0.5, 0.2, 0.3), (0.1, 0.4, 0.8), (51, 128, 230, 77)
DECODED = [((c / 255 + 0.055) / 1.055) ** 2.4 for c in BYTES[:3]]


def _export(name):
    return inputs.module(f"export.{name}")


class CornerColors(BlenderTest):
    """A square; values are those that Emission nodes showed in Cycles 3.4."""

    def setUp(self):
        super().setUp()
        self.colors = _export("corner_colors")
        self.obj = scenes.add_plane()
        self.mesh = self.obj.data

    def _attribute(self, kind, domain, field, *values, name="shown"):
        attribute = self.mesh.attributes.new(name, kind, domain)
        for i, element in enumerate(attribute.data):
            setattr(element, field, values[i % len(values)])
        return attribute

    def _asked(self, part="Color", is_number=False, name="shown", otherwise=0.0):
        return self.colors.CornerColors(name, part, is_number, otherwise)

    def _values(self, *asked):
        """[sets x corners x 3]"""
        obj = self.obj.evaluated_get(bpy.context.evaluated_depsgraph_get())
        return _export("meshes").object_arrays(obj, colors=(asked,)).corner_colors

    def _assert_shown(self, expected, *asked):
        values = self._values(self._asked(*asked))[0]
        np.testing.assert_allclose(values, np.broadcast_to(expected, values.shape), rtol=1e-5)

    def test_colors(self):
        self._attribute("FLOAT_COLOR", "POINT", "color", COLOR)
        self._assert_shown(COLOR[:3], "Color")
        self._assert_shown(COLOR[:3], "Vector")
        self._assert_shown(np.mean(COLOR[:3]), "Fac")
        self._assert_shown(COLOR[3], "Alpha")
        self._assert_shown(np.dot(COLOR[:3], luminance_weights()), "Color", True)
        self._assert_shown(np.mean(COLOR[:3]), "Vector", True)

    def test_bytes_are_decoded(self):
        for domain in ("POINT", "CORNER"):
            with self.subTest(domain):
                self._attribute("BYTE_COLOR", domain, "color_srgb", [b / 255 for b in BYTES])
                self._assert_shown(DECODED, "Color")
                self._assert_shown(BYTES[3] / 255, "Alpha")
                self.mesh.attributes.remove(self.mesh.attributes["shown"])

    def test_numbers_and_vectors(self):
        weights = luminance_weights()
        cases = (
            ("FLOAT", "value", 0.7, (0.7,) * 3, 0.7, 0.7),
            ("INT", "value", 2, (2, 2, 2), 2, 2),
            ("BOOLEAN", "value", True, (1, 1, 1), 1, 1),
            ("FLOAT_VECTOR", "vector", VECTOR, VECTOR, np.mean(VECTOR), np.dot(VECTOR, weights)),
            ("FLOAT2", "vector", (0.3, 0.6), (0.3, 0.6, 0), 0.3, 0.3 * weights[0] + 0.6 * weights[1]),
        )
        for kind, field, value, color, factor, number in cases:
            with self.subTest(kind):
                self._attribute(kind, "FACE", field, value)
                self._assert_shown(color, "Color")
                self._assert_shown(factor, "Fac")
                self._assert_shown(number, "Color", True)
                self._assert_shown(1, "Alpha")
                self.mesh.attributes.remove(self.mesh.attributes["shown"])

    def test_domains(self):
        """Each corner has the value of its point, of itself and of its face."""
        bpy.ops.mesh.primitive_grid_add(x_subdivisions=3, y_subdivisions=2)
        self.obj, self.mesh = bpy.context.object, bpy.context.object.data
        elements = {
            "POINT": [loop.vertex_index for loop in self.mesh.loops],
            "CORNER": list(range(len(self.mesh.loops))),
            "FACE": [face.index for face in self.mesh.polygons for _ in face.loop_indices],
        }
        for domain, of_corners in elements.items():
            self._attribute("FLOAT", domain, "value", *range(100), name=domain)
            values = self._values(self._asked(name=domain))[0]
            np.testing.assert_array_equal(values, np.repeat(np.float32(of_corners)[:, None], 3, axis=1))

    def test_the_one_that_renders(self):
        for i, name in enumerate("ab"):
            self._attribute("FLOAT_COLOR", "POINT", "color", (i, 0.5, 0.5, 1), name=name)
        colors = self.mesh.color_attributes
        for i in range(2):
            colors.render_color_index, colors.active_color_index = i, 1 - i
            self.assertEqual(self._values(self._asked(name=None))[0, 0, 0], i)

    def test_missing(self):
        missing = self._asked("Alpha", otherwise=1.0)
        np.testing.assert_array_equal(self._values(missing, self._asked())[:, 0, 0], [1, 0])
        np.testing.assert_array_equal(self._values(self._asked(name=None)), 0)
        self._attribute("FLOAT", "EDGE", "value", 1)
        self.assertFalse(self.colors.has_attribute(self.mesh, self._asked()))

    def test_vertex_groups_are_named(self):
        asked = self._asked(name="Weights")
        self.assertIn("it has no attribute 'Weights'", self.colors.missing_colors(self.obj, asked, "Paint"))
        self.obj.vertex_groups.new(name="Weights")
        self.assertIn("vertex group 'Weights'", self.colors.missing_colors(self.obj, asked, "Paint"))

    def test_only_where_it_is_asked_for(self):
        self._attribute("FLOAT_COLOR", "POINT", "color", COLOR)
        self.assertIsNone(self._values())

    def test_slots(self):
        """Each has the sets that its material asks for; the last stands for all beyond."""
        bpy.ops.mesh.primitive_grid_add(x_subdivisions=3, y_subdivisions=1)
        self.obj, self.mesh = bpy.context.object, bpy.context.object.data
        self.mesh.polygons.foreach_set("material_index", [0, 1, 2])
        for _ in range(3):
            self.mesh.materials.append(None)
        for name, value in (("a", 1), ("b", 2)):
            self._attribute("FLOAT", "POINT", "value", value, name=name)
        a, b = self._asked(name="a"), self._asked(name="b")
        evaluated = self.obj.evaluated_get(bpy.context.evaluated_depsgraph_get())
        arrays = _export("meshes").object_arrays(evaluated, colors=((a, b), (b,)))
        of_faces = arrays.corner_colors[:, ::4, 0]
        np.testing.assert_array_equal(of_faces, [[1, 2, 2], [2, 0, 0]])
