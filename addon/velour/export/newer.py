"""Files of newer Blenders: enumerations that this one does not know read as '', properties may be gone."""

UNKNOWN = "one that this Blender does not know"


def choice(table, value, usual, owner, what, notes):
    """`table[value]`, or of a value that is not in it that of the usual one, said in `notes`."""
    if value in table:
        return table[value]
    found = f"'{value}', which is not supported" if value else UNKNOWN
    notes.add(f"{owner}: its {what} is {found}; '{usual}' is used.")
    return table[usual]


def has_nodes(owner):
    """Whether a material, world or light uses a node tree; from Blender 6.0 on each that it has."""
    return bool(owner.node_tree) and getattr(owner, "use_nodes", True)
