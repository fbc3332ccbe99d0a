"""The version of the engine, which is the version of the bits of lives.

Two lives of equal seed, index and settings are equal to the last bit if they were lived by engines
of the same number; docs/determinism.md says what else that takes, and how it is tested.
"""

ENGINE = 1
"""Raised by 1 with every change after which any golden life (tests/life/golden.json) is another."""
