"""What a fit of a BTF is asked for: of which BTF, by which method, how large."""

import os

import bpy
from bpy.props import EnumProperty, FloatProperty, IntProperty, StringProperty

from ..properties.tile_settings import METHODS, SHAPE_OF
from .tiles import find_tile, tile_folder


class AskedFit:
    """Mixin of an operator."""

    _keeps = True  # in the settings of the tile, what is given

    filepath: StringProperty(
        name="BTF",
        subtype="FILE_PATH",
        description="A folder, a CSV index or a .btf file; empty: what was captured of the tile",
        options={"SKIP_SAVE"},
    )
    collection: StringProperty(
        name="Collection", description="The tile; empty: the active object is it", options={"SKIP_SAVE"}
    )
    # Where given these replace the settings of the tile, where there is one.
    method: EnumProperty(name="Method", items=METHODS, default="SRBF", options={"SKIP_SAVE"})
    clusters: IntProperty(
        name="Clusters",
        description="Of CTA and K-CTA; 0: what serves best",
        min=0,
        max=256,
        options={"SKIP_SAVE"},
    )
    members: IntProperty(
        name="Clusters of a Texel",
        description="Of K-CTA; 0: what serves best",
        min=0,
        max=8,
        options={"SKIP_SAVE"},
    )
    tolerance: FloatProperty(
        name="Largest Error",
        description="Relative L2 error of the roots of values; the smallest model within it. 0: none",
        min=0.0,
        max=0.9,
        options={"SKIP_SAVE"},
    )
    megabytes: FloatProperty(
        name="Megabytes",
        description="Of all coefficients at most; 0: a four-hundredth of the BTF (SVD: twice that), or a few;"
        " with a largest error, whatever it takes",
        min=0.0,
        options={"SKIP_SAVE"},
    )

    def _chosen(self, context):
        """The tile, or None where a file is named; and the path of its BTF."""
        tile = None if self.filepath else find_tile(context, self.collection)
        return tile, os.path.normpath(bpy.path.abspath(self.filepath or tile_folder(tile)))

    def _options(self, tile):
        """Of compress_job()."""
        return {
            **self._asked_method(tile),
            "tolerance": self._asked(tile, "tolerance"),
            "bytes": int(self._asked(tile, "megabytes") * 1e6),
        }

    def _asked_method(self, tile):
        """The method, and of clusters and members what it takes."""
        method = self._asked(tile, "method")
        taken = {name: self._asked(tile, name) for name in SHAPE_OF.get(method, ())}
        return {"method": method.lower().replace("_", "-"), **taken}

    def _asked(self, tile, name):
        """What was given, or what the tile asks for."""
        is_given = self.properties.is_property_set(name)
        if tile and is_given and self._keeps:
            setattr(tile.owner.velour, name, getattr(self, name))
        return getattr(tile.owner.velour if tile and not is_given else self, name)
