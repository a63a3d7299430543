"""Lesk: a light-and-shading workbench.

Every reflectance model is written once, as its paper states it; numbers, gradients, shader source, plots, checks and
pictures come from that one definition.

>>> import lesk
>>> satin = lesk.models.ggx(alpha_x=0.2, alpha_y=0.4)
>>> satin.eval([0.0, 0.6, 0.8], [0.0, 0.0, 1.0]).shape
(3,)
"""

from lesk import models
from lesk._lesk import __version__
from lesk._model import Model, Sample
from lesk.errors import LeskError, ParameterError, SceneError

__all__ = ["LeskError", "Model", "ParameterError", "Sample", "SceneError", "__version__", "models"]
