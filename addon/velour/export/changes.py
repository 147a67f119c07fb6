"""Changes reported by Blender that a viewport's scene must apply."""

import bpy

# Ignored: the objects and worlds that use these report their own changes, and an update may only mean that
# the datablock was evaluated.
_SAID_ELSEWHERE = (
    bpy.types.Camera,
    bpy.types.Mesh,
    bpy.types.Curve,
    bpy.types.MetaBall,
    bpy.types.Armature,
    bpy.types.Lattice,
    bpy.types.Key,
    bpy.types.Action,
    bpy.types.ParticleSettings,
    bpy.types.NodeTree,
    bpy.types.Scene,
)
# Types that are never rendered; some exist only in newer Blender versions.
_NEVER_SHOWN = tuple(
    getattr(bpy.types, name)
    for name in (
        *("GreasePencil", "GreasePencilv3", "Annotation", "FreestyleLineStyle"),
        *("Curves", "PointCloud", "Volume", "LightProbe", "Speaker", "Sound"),
    )
    if hasattr(bpy.types, name)
)
_WITHOUT_A_PICTURE = ("CAMERA", "SPEAKER", "LIGHT_PROBE", "ARMATURE", "LATTICE")
# Not rendered themselves either, but geometry nodes may turn them into meshes and instances.
_LEFT_OUT = ("GPENCIL", "GREASEPENCIL", "CURVES", "POINTCLOUD", "VOLUME")


def may_be_shown(obj):
    """Whether a change of this object can be seen."""
    return obj.type not in _WITHOUT_A_PICTURE and (obj.type not in _LEFT_OUT or bool(obj.modifiers))


class Changes:
    """Changes from a depsgraph's updates. Datablocks are stored as pointers of the originals, since evaluated
    copies may be gone when the changes are applied."""

    def __init__(self, updates=()):
        self.everything = self.objects = self.lights = self.world = self.scene = False
        self.materials = set()
        self.geometry = set()  # objects
        for update in updates:
            self._add(update)

    def add(self, later):
        """Merges Changes made after these."""
        for name, value in vars(later).items():
            setattr(self, name, getattr(self, name) | value)

    def changed_materials(self, depsgraph):
        """Changed materials as currently evaluated by the depsgraph."""
        if not self.materials:
            return []
        changed = (block for block in bpy.data.materials if block.as_pointer() in self.materials)
        return [material.evaluated_get(depsgraph) for material in changed]

    def __bool__(self):
        return any((self.everything, self.objects, self.lights, self.world, self.materials))

    def _add(self, update):
        block = update.id
        if isinstance(block, bpy.types.Object):
            self._add_object(block, update.is_updated_geometry)
        elif isinstance(block, bpy.types.Light):
            self.lights = True
        elif isinstance(block, bpy.types.World):
            self.world = True
        elif isinstance(block, bpy.types.Material):
            self.materials.add(block.original.as_pointer())
        elif isinstance(block, bpy.types.Collection):
            self.objects = True
        elif isinstance(block, bpy.types.Scene):
            self.scene = True
        elif isinstance(block, bpy.types.Image):
            self.everything |= block.type not in ("RENDER_RESULT", "COMPOSITING")
        elif not isinstance(block, (*_SAID_ELSEWHERE, *_NEVER_SHOWN)):
            self.everything |= update.is_updated_geometry or update.is_updated_shading

    def _add_object(self, obj, is_geometry):
        if obj.type == "LIGHT":
            self.lights = True
        elif may_be_shown(obj):
            self.objects = True
            if is_geometry:
                self.geometry.add(obj.original.as_pointer())
