"""The version of animat, named here alone."""

__version__ = "0.1.0"
