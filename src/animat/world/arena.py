"""The arena: a walled rectangle, of which an inner rectangle is free."""

from __future__ import annotations

from typing import Annotated, Self

from pydantic import Field, model_validator

from animat.files.settings import Settings

LONGEST = 1e7
"""mm; 10 km, more than a raster can hold."""

Length = Annotated[float, Field(gt=0, le=LONGEST)]
Margin = Annotated[float, Field(ge=0, le=LONGEST)]


class Arena(Settings):
    """A playground of `width` x `height` mm, x to the right, y up, walls all round.

    The margins are how far the walls reach in from each edge, in mm. The defaults are those of
    Michel's Khepera Simulator 2.0: 1 m by 1 m, free for x in 22..978 mm and y in 26..976 mm.
    """

    width: Length = 1000.0
    height: Length = 1000.0
    left: Margin = 22.0
    right: Margin = 22.0
    bottom: Margin = 26.0
    top: Margin = 24.0

    @model_validator(mode="after")
    def _some_of_it_is_free(self) -> Self:
        if self.left + self.right >= self.width:
            raise ValueError(
                f"left + right = {self.left + self.right:g} mm leave nothing free "
                f"of the width of {self.width:g} mm"
            )
        if self.bottom + self.top >= self.height:
            raise ValueError(
                f"bottom + top = {self.bottom + self.top:g} mm leave nothing free "
                f"of the height of {self.height:g} mm"
            )
        return self

    @property
    def free(self) -> tuple[float, float, float, float]:
        """The free rectangle: x from, x to, y from, y to, in mm."""
        return self.left, self.width - self.right, self.bottom, self.height - self.top
