"""The command `pathwarp` of vpype."""

from .command import pathwarp

__all__ = ["pathwarp"]
