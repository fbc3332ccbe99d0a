"""The worlds and lives that the tests of a life have, too."""

from ..life.conftest import (  # noqa: F401
    affording,
    caring_for,
    columns,
    lived,
    small,
    spared,
    step_by_step,
    trained,
    usual,
)
