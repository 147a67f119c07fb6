"""What happens when a setting of a material is changed."""

# Those who do work put themselves here.
listeners = []  # called with the node tree that the setting belongs to
period_listeners = []  # called with the object or collection


def changed(settings, _context):
    """Python's properties do not say by themselves that evaluated copies are out of date."""
    settings.id_data.update_tag()


def period_changed(settings, context):
    """Of a tile, which may be shown repeated."""
    changed(settings, context)
    for listener in period_listeners:
        listener(settings.id_data)


def look_changed(settings, context):
    """Of what other programs see of the material as well."""
    changed(settings, context)
    for listener in listeners:
        listener(settings.id_data)
