"""What a .blend keeps of Velour, as a table: what releases have stored, made anew as files without Velour.

Run inside Blender with `-- TABLE BLEND NUMBER` it writes such a file and needs no add-on: the numbers and
names of the table lie in it as the release of that number has left them there.
"""

import json
import sys
from pathlib import Path

import bpy

STAMP = "saved_by"
RELEASES = Path(__file__).resolve().parents[1] / "releases"
# Where the settings are: owner(kind of datablock) in a file that add_owners() has filled.
OWNERS = {
    "Scene": lambda: bpy.data.scenes[0],
    "ViewLayer": lambda: bpy.data.scenes[0].view_layers[0],
    "ShaderNodeTexImage": lambda: bpy.data.materials["Owner"].node_tree.nodes["Owner"],
    "ShaderNodeGroup": lambda: bpy.data.materials["Owner"].node_tree.nodes["Group"],
    "ShaderNodeTree": lambda: bpy.data.node_groups["Owner"],
    "Image": lambda: bpy.data.images["Owner"],
    "Object": lambda: bpy.data.objects["Owner"],
    "Collection": lambda: bpy.data.collections["Owner"],
}
_STAMPED = set(OWNERS) - {"ViewLayer"}  # layers are their scene's


def add_owners():
    """One of each, in an empty file."""
    material = bpy.data.materials.new("Owner")
    material.use_nodes = True
    material.node_tree.nodes.new("ShaderNodeTexImage").name = "Owner"
    material.node_tree.nodes.new("ShaderNodeGroup").name = "Group"
    bpy.data.node_groups.new("Owner", "ShaderNodeTree")
    bpy.data.images.new("Owner", 1, 1)
    bpy.data.images.new("Pointed at", 1, 1)
    bpy.data.materials.new("Pointed at")
    for name in ("Owner", "Pointed at"):
        bpy.data.objects.new(name, None)
    bpy.data.collections.new("Owner")
    for lists in (
        bpy.data.materials,
        bpy.data.node_groups,
        bpy.data.images,
        bpy.data.objects,
        bpy.data.collections,
    ):
        for datablock in lists:
            datablock.use_fake_user = True


def write_own(path):
    """Writes the table of the Velour that runs (scripts/saved_settings)."""
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    add_owners()
    write(Path(path), described())


def described():
    """{owner: {path of a property in its `velour`: what it is}} of the Velour that runs."""
    return {name: dict(_properties(owner().velour)) for name, owner in OWNERS.items()}


def _properties(group, path=""):
    for known in group.bl_rna.properties:
        if known.identifier in ("rna_type", "name", STAMP) or known.is_skip_save:
            continue
        if known.type == "POINTER" and isinstance(getattr(group, known.identifier), bpy.types.PropertyGroup):
            yield from _properties(getattr(group, known.identifier), f"{path}{known.identifier}.")
        else:
            yield path + known.identifier, _entry(known)


def _entry(known):
    if known.type == "POINTER":
        return {"type": "POINTER", "to": known.fixed_type.identifier, "saved": "Pointed at"}
    entry = {"type": known.type}
    if known.type == "ENUM":
        entry["numbers"] = {item.identifier: item.value for item in known.enum_items}
    if getattr(known, "is_array", False):
        entry["default"] = [_rounded(value) for value in known.default_array]
        entry["saved"] = [_other(known, value) + 0.125 * i for i, value in enumerate(known.default_array)]
    else:
        entry["default"] = _rounded(known.default)
        entry["saved"] = _other(known, known.default)
    return entry


def _rounded(value):
    return float(f"{value:.6g}") if isinstance(value, float) else value


def _other(known, default):
    """A value that is not the default, and that 32 bits hold."""
    if known.type == "BOOLEAN":
        return not default
    if known.type == "STRING":
        return f"{known.identifier} of a release"
    if known.type == "ENUM":
        return next(item.identifier for item in reversed(known.enum_items) if item.identifier != default)
    if known.type == "INT":
        return default + 1 if default < known.hard_max else default - 1
    higher = (int(64 * default) + 17) / 64
    return higher if higher <= known.hard_max else (int(64 * default) - 17) / 64


def differences(before, now):
    """Sentences on what of the table `before` means something else in the table `now`."""
    found = []
    for owner, properties in before.items():
        for path, entry in properties.items():
            other = now.get(owner, {}).get(path)
            if other is None:
                found.append(f"{owner}.{path} is gone")
                continue
            for key in entry.keys() - {"saved", "numbers"}:
                if entry[key] != other.get(key):
                    found.append(f"{owner}.{path}: {key} was {entry[key]!r} and is {other.get(key)!r}")
            for item, number in entry.get("numbers", {}).items():
                if other.get("numbers", {}).get(item) != number:
                    found.append(f"{owner}.{path}: {item} was number {number}")
    return found


def set_values(table):
    """The table's values, through the add-on."""
    for group, identifier, entry in _places(table):
        setattr(group, identifier, _datablock(entry) if entry["type"] == "POINTER" else entry["saved"])


def wrong_values(table):
    """Sentences on what is not as the table says that it was stored."""
    found = []
    for group, identifier, entry in _places(table):
        value = getattr(group, identifier)
        if entry["type"] == "POINTER":
            value = value.name if value else None
        elif isinstance(entry["saved"], list):
            value = [float(x) for x in value]
        if value != entry["saved"]:
            found.append(f"{group.path_from_id()}.{identifier} is {value!r}, stored was {entry['saved']!r}")
    return found


def _places(table):
    for owner, properties in table.items():
        for path, entry in properties.items():
            *groups, identifier = path.split(".")
            group = OWNERS[owner]().velour
            for name in groups:
                group = getattr(group, name)
            yield group, identifier, entry


def _datablock(entry):
    lists = {"Image": bpy.data.images, "Material": bpy.data.materials, "Object": bpy.data.objects}
    return lists[entry["to"]][entry["saved"]]


def store(table, saved_by):
    """The table's values as they lie in files, without the add-on; `saved_by`: the number of its release."""
    for owner, properties in table.items():
        values = {STAMP: saved_by} if owner in _STAMPED else {}
        for path, entry in properties.items():
            *groups, identifier = path.split(".")
            group = values
            for name in groups:
                group = group.setdefault(name, {})
            group[identifier] = _stored(entry)
        raw(OWNERS[owner]())["velour"] = values


def _stored(entry):
    if entry["type"] == "ENUM":
        return entry["numbers"][entry["saved"]]
    if entry["type"] == "POINTER":
        return _datablock(entry)
    return int(entry["saved"]) if entry["type"] == "BOOLEAN" else entry["saved"]


def raw(owner):
    """Where Blender itself keeps what add-ons store: since 5.0 apart from the users' own properties."""
    return owner.bl_system_properties_get(do_create=True) if bpy.app.version >= (5, 0) else owner


def read(path):
    return json.loads(path.read_text(encoding="utf-8"))


def write(path, table):
    """A line a property, so that a change of one is a change of a line."""
    owners = [
        f" {json.dumps(owner)}: {{\n"
        + ",\n".join(f"  {json.dumps(path)}: {json.dumps(entry)}" for path, entry in properties.items())
        + "\n }"
        for owner, properties in table.items()
    ]
    path.write_text("{\n" + ",\n".join(owners) + "\n}\n", encoding="utf-8")


def _write_blend(table, blend, saved_by):
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    add_owners()
    store(read(Path(table)), int(saved_by))
    bpy.ops.wm.save_as_mainfile(filepath=blend)


if __name__ == "__main__":
    _write_blend(*sys.argv[sys.argv.index("--") + 1 :])
