"""Film settings that Blender stores with Cycles; available only while Cycles is enabled."""


def film_exposure(scene):
    """Exposure factor of the film; 1 without Cycles."""
    cycles = getattr(scene, "cycles", None)
    return getattr(cycles, "film_exposure", 1.0)


def hides_world(world):
    """Whether the camera sees black instead of the world."""
    visibility = getattr(world, "cycles_visibility", None)
    return not getattr(visibility, "camera", True)
