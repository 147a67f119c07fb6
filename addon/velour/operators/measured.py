"""Shared by operators: creation of measured materials and of the image datablocks of their files."""

import os
from typing import NamedTuple

import bpy
from bpy.props import StringProperty

from ..core.measurement_files import INDICES
from ..export import ExportError
from ..export.files import StoredFile, absolute_path, sha256
from ..export.nodes import velour_node
from . import approximation_group, measured_group
from .convert import convert


class OfMaterial:
    """Mixin for an operator that works on a material, by name or the active one."""

    material: StringProperty(
        name="Material", description="Name of the material. Empty: the active one", options={"SKIP_SAVE"}
    )


def find_material(context, name):
    """The material called `name`, or the active one if `name` is empty; None if there is none.

    In a tab or a node editor, the material shown is active; it may be pinned and on no object."""
    if name:
        return bpy.data.materials.get(name)
    shown, obj = getattr(context, "material", None), context.object
    return shown or (obj.active_material if obj else None)


def wanted_material(context, name):
    """Like find_material(); raises ExportError if there is none."""
    material = find_material(context, name)
    if material is None:
        missing = f"There is no material {name!r}; check its name."
        raise ExportError(missing if name else "There is no active material; select an object that has one.")
    return material


def modelled_node(material):
    """The material's measured node; raises ExportError if it has no model."""
    node = velour_node(material)
    if node is None or node.image is None:
        raise _no_model(material)
    return node


def stored_model(target):
    """StoredFile of a JobTarget's current model; raises ExportError if there is none."""
    material, node = target.find()
    if node is None:
        raise ExportError(f"Material '{target.material_name}' no longer exists.")
    if node.image is None:
        raise _no_model(material)
    return StoredFile.of(node.image, f"Material '{material.name}'")


def _no_model(material):
    return ExportError(f"Material '{material.name}' has no model; fit one, or choose a model file.")


def refuse_linked(material):
    """Raises ExportError for a linked material, whose changes would be lost on the next load of its file."""
    if material.library is not None:
        raise ExportError(
            f"Material '{material.name}' is linked from a library and cannot be changed; make it local."
        )


def refuse_linked_group(material, node):
    """Raises ExportError if the node group of a MeasuredNode is linked or a library override, whose nodes
    Blender resets when it loads the file."""
    tree = node.group and node.group.node_tree
    if tree and (tree.library or tree.override_library):
        library = tree.library or tree.override_library.reference.library
        raise ExportError(
            f"Material '{material.name}': its node group '{tree.name}'"
            f" {'is linked from' if tree.library else 'overrides that of'} {library.filepath}"
            " and cannot be changed; make it local with the icon beside its name in the Material tab, or"
            " change it in that file."
        )


def refuse_folder(path):
    """Raises ExportError for a folder that is no BTF: the file browser was left without choosing a file.

    Otherwise all images in it would be read as those of a BTF."""
    if os.path.isdir(path) and not any(os.path.isfile(os.path.join(path, name)) for name in INDICES):
        raise ExportError(f"No file is chosen in {path}; choose a measurement or a model.")


def new_material(name):
    """Creates a material whose surface is a measured node without a model."""
    material = bpy.data.materials.new(name)
    if material.node_tree is None:
        material.use_nodes = True
    material.node_tree.nodes.clear()
    measured_group.add(material)
    return material


def ensure_node(material):
    """The material's measured node, which is added as its surface if needed."""
    return velour_node(material) or measured_group.add(material)


def file_image(path, name=None):
    """Creates an image datablock for the file `path`, stored relative to the .blend if that is saved."""
    image = bpy.data.images.new(name or os.path.basename(path), 1, 1)
    image.source = "FILE"
    image.colorspace_settings.name = _data_space(image)
    image.filepath_raw = bpy.path.relpath(path) if bpy.data.filepath else os.path.abspath(path)
    return image


def packed_model(data, name, digest=None):
    """Creates an image datablock with the bytes of a model packed into it, as if read from //NAME.velour.

    `digest`: their SHA-256, if known."""
    image = file_image(f"//{bpy.path.clean_name(name)}.velour", name=f"{name}.velour")
    image.filepath_raw = f"//{bpy.path.clean_name(name)}.velour"
    image.pack(data=data, data_len=len(data))
    image.velour.sha256 = digest or sha256(data)
    return image


def put_model(data, target, report, users="SINGLE"):
    """Puts a model into a new image of a JobTarget; the previous image is kept, so that undo restores it.

    users: as for set_model(). Returns the material and the node; (None, None) if they are gone, but the image
    is kept."""
    material, node = target.find()
    image = packed_model(data, material.name if material else target.material_name)
    if node is None:
        image.use_fake_user = True
        report({"WARNING"}, f"The material no longer exists; its model is kept as image '{image.name}'.")
        return None, None
    return material, set_model(material, node, image, report, users)


def set_model(material, node, image, report, users="SINGLE", info=None):
    """Sets another model on a material's node, and disables its scene model; returns the node.

    users: materials that share the node's group: "SINGLE", this one alone gets the model, or "ALL". info: the
    model's, which determines the node's inputs; None: they are not changed."""
    refuse_linked_group(material, node)
    if node.group is None:
        node = convert(material)
    if users == "SINGLE":
        node = measured_group.make_single_user(node)
    node.image = image
    if info is not None:
        approximation_group.put_inputs(node, material, info)
    if node.velour.use_scene_model:
        node.velour.use_scene_model = False
        report({"INFO"}, "The scene model belongs to the previous model and was disabled; fit it again.")
    return node


def linked_model(path, digest):
    """Creates an image datablock for a model file on disk with this SHA-256."""
    image = file_image(path)
    image.velour.sha256 = digest
    return image


def measurement_image(path, digest):
    """The image datablock of a measurement file: an existing one, or a new one."""
    for image in bpy.data.images:
        if image.velour.sha256 == digest and absolute_path(image) == os.path.normpath(os.path.abspath(path)):
            return image
    image = file_image(path)
    image.velour.sha256 = digest
    return image


def place_of(image):
    """Identifies the file of an image, also after an undo or if the image has been renamed."""
    if image is None:
        return None
    return absolute_path(image), image.packed_file.size if image.packed_file else None


def model_key(node):
    """Identifies the model of a MeasuredNode or None, also after an undo."""
    image = node and node.image
    return image and (image.velour.sha256 or place_of(image))


class ReadFile(NamedTuple):
    """The measurement that a job has read."""

    name: str  # name of the image
    place: tuple

    @classmethod
    def of(cls, image):
        return cls(image.name, place_of(image))


def after_fit(material, node, read, digest, report):
    """Stores the hash of the measurement that a model was fitted to, if the material still has it; reports a
    VOTF that only the previous model has."""
    if node.velour.structure is not None:
        sentence = "The new model has no silhouette (VOTF); press Add Silhouette to add it."
        report({"INFO"}, f"Material '{material.name}': {sentence}")
    measurement = node.velour.measurement
    if place_of(measurement) == read.place:
        measurement.velour.sha256 = digest
        return
    report(
        {"WARNING"},
        f"Material '{material.name}': its measurement was changed meanwhile; the model was fitted to"
        f" '{read.name}'.",
    )


def is_btf(image):
    """Whether a measurement is a BTF, judged by its file name. Safe in draw()."""
    path = absolute_path(image)
    suffix, is_index = os.path.splitext(path)[1], os.path.basename(path) in INDICES
    return is_index or suffix in (".btf", ".csv") or os.path.isdir(path)


def btf_name(path):
    """Name of a BTF; that of its folder if `path` is the index in it."""
    folder, name = os.path.split(path)
    return os.path.splitext(os.path.basename(folder) if name in INDICES else name)[0]


def btf_file(path):
    """The file that represents a BTF: its index if it is a folder with one, otherwise `path`."""
    indices = (os.path.join(path, name) for name in INDICES)
    return next((index for index in indices if os.path.isfile(index)), path)


def _data_space(image):
    """The color space of this configuration that leaves values unchanged."""
    names = image.colorspace_settings.bl_rna.properties["name"].enum_items.keys()
    return next((name for name in ("Non-Color", "Raw") if name in names), image.colorspace_settings.name)
