"""Programs that compute inputs of shaders at each point."""

from .compiler import Compiler
from .draft import Computed
from .finish import finished, sources_of_draft

__all__ = ["Compiler", "Computed", "finished", "sources_of_draft"]
