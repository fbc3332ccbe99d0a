"""Studies: the files that describe them, the lives they ask for, and their results.

`animat.study.open(directory)` returns the results in a directory.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from animat.study.results import open as open  # noqa: A004

__all__ = ["open"]


def __getattr__(name: str) -> Any:
    """Load a public name when it is first used, as `animat` itself does."""
    if name != "open":
        raise AttributeError(f"module 'animat.study' has no attribute '{name}'")
    from animat.study import results

    return results.open
