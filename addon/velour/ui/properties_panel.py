"""Base of the panels in the Properties editor."""

from ..engine.engine import VelourRenderEngine


class PropertiesPanel:
    """Mixin for a panel that is shown while Velour is the engine."""

    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    COMPAT_ENGINES = {VelourRenderEngine.bl_idname}

    @classmethod
    def poll(cls, context):
        return context.engine in cls.COMPAT_ENGINES
