"""Files of newer Blender versions: unknown enum values read as '', and properties may be missing."""

UNKNOWN = "unknown to this version of Blender"


def choice(table, value, usual, owner, what, notes):
    """`table[value]`, or `table[usual]` with a note if `value` is not in the table."""
    if value in table:
        return table[value]
    found = f"'{value}', which is not supported" if value else UNKNOWN
    notes.add(f"{owner}: its {what} is {found}; '{usual}' is used.")
    return table[usual]


def has_nodes(owner):
    """Whether a material, world or light uses its node tree; from Blender 6.0 on, it always does."""
    return bool(owner.node_tree) and getattr(owner, "use_nodes", True)


def is_directx(normal_map):
    """Whether the green of a Normal Map node points down (5.2 and newer)."""
    return getattr(normal_map, "convention", "OPENGL") == "DIRECTX"
