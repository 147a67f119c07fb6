"""What happens when a setting of a material is changed."""

listeners = []  # called with the node tree that the setting belongs to; those who do work put themselves here


def changed(settings, _context):
    """Python's properties do not say by themselves that evaluated copies are out of date."""
    settings.id_data.update_tag()


def look_changed(settings, context):
    """Of what other programs see of the material as well."""
    changed(settings, context)
    for listener in listeners:
        listener(settings.id_data)
