"""Programs that compute inputs of shaders at each point."""

from .compiler import Compiler
from .draft import Computed
from .finish import finished, sources_of_draft
from .normal_nodes import displaced

__all__ = ["Compiler", "Computed", "displaced", "finished", "sources_of_draft"]
