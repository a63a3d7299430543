"""Errors of the package."""


class LeskError(Exception):
    """Base of all errors that Lesk raises on bad input."""


class ParameterError(LeskError, ValueError):
    """A parameter, direction or array that a model does not accept."""


class SceneError(LeskError, ValueError):
    """A scene file that cannot be rendered; the text lists all its faults."""
