"""Programs that compute inputs of shaders at each point."""

from .compiler import Compiler
from .draft import Computed, Draft, ImageNumber
from .finish import finished, sources_of_draft
from .normal_nodes import displaced

__all__ = ["Compiler", "Computed", "Draft", "ImageNumber", "displaced", "finished", "sources_of_draft"]
