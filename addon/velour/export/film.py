"""Settings of the film and of what it shows that Blender keeps with Cycles; read while that is enabled."""


def film_exposure(scene):
    """What light is multiplied by."""
    cycles = getattr(scene, "cycles", None)
    return getattr(cycles, "film_exposure", 1.0)


def hides_world(world):
    """Whether the camera sees black in the place of the world."""
    visibility = getattr(world, "cycles_visibility", None)
    return not getattr(visibility, "camera", True)
