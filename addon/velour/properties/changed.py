"""Update callbacks of settings."""

# Other modules register their callbacks here.
listeners = []  # called with the node tree that the setting belongs to
uv_map_listeners = []  # called with the placement, before those
period_listeners = []  # called with the object or collection


def changed(settings, _context):
    """Tags the datablock, since Python's properties do not invalidate evaluated copies by themselves."""
    settings.id_data.update_tag()


def period_changed(settings, context):
    """Callback for the period of a tile, which may be shown repeated."""
    changed(settings, context)
    for listener in period_listeners:
        listener(settings.id_data)


def uv_map_changed(settings, context):
    """Callback for the UV map of a placement."""
    for listener in uv_map_listeners:
        listener(settings)
    look_changed(settings, context)


def look_changed(settings, context):
    """Callback for settings that also affect the material's approximation for other programs."""
    changed(settings, context)
    for listener in listeners:
        listener(settings.id_data)
