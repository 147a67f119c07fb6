"""A reference to the engine of a viewport for as long as Blender has it."""

import weakref


def engine_reference(engine):
    """A function that returns the engine, or None once Blender has freed it.

    Its Python half may live on, for example in the frames of an exception kept by a log. Any access to it
    raises ReferenceError.
    """
    found = weakref.ref(engine)

    def living():
        engine = found()
        if engine is None:
            return None
        try:
            engine.is_preview  # noqa: B018 - asks Blender
        except ReferenceError:
            return None
        return engine

    return living
