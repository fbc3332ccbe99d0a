"""A compiler of functions that are only ever inlined into a kernel.

Numba optimises and emits machine code for every function it compiles, with two wrappers, also for
those that a kernel inlines as a whole. That is half the time of a first life. Here a function is
taken as far as LLVM's text, and the kernel that inlines it does the rest, once. Lives are the same
to the last bit: the kernel is optimised as before.

This leans on private parts of Numba; tests/numerics/test_inlined.py tests each of them.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import Any

import numba
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import CompilerBase, DefaultPassBuilder
from numba.core.compiler_machinery import PassManager, register_pass
from numba.core.registry import CPUDispatcher
from numba.core.typed_passes import NativeLowering


class InlinedLibrary(JITCodeLibrary):
    """The code of one function, to be linked into the library of a kernel."""

    def _optimize_final_module(self) -> None:
        """Leave it to the kernel."""

    def _finalize_final_module(self) -> None:
        self._finalize_dynamic_globals()
        self._finalized = True

    def get_pointer_to_function(self, name: str) -> int:
        """Return the null pointer: there is no machine code."""
        self._ensure_finalized()
        return 0

    @property
    def codegen(self) -> Any:
        """What would put the function's environment into its machine code."""
        return _WithoutEnvironments(self._codegen)


class _WithoutEnvironments:
    def __init__(self, codegen: Any) -> None:
        self._codegen = codegen

    def __getattr__(self, name: str) -> Any:
        return getattr(self._codegen, name)

    def set_env(self, name: str, environment: object) -> None:
        pass


@register_pass(mutates_CFG=True, analysis_only=False)
class InlinedLowering(NativeLowering):
    """Numba's lowering, into a library of ours."""

    _name = "inlined_lowering"

    def run_pass(self, state: Any) -> bool:
        """Lower the function of a compiler's state."""
        if state.library is None:
            name = state.func_id.func_qualname
            state.library = InlinedLibrary(state.targetctx.codegen(), name)
        return super().run_pass(state)


class InlinedCompiler(CompilerBase):
    """Numba's compiler with our lowering in the place of its own."""

    def define_pipelines(self) -> list[PassManager]:
        """Return the passes of Numba's compiler, in their order."""
        passes = DefaultPassBuilder.define_nopython_pipeline(self.state, "inlined")
        passes.passes = [
            (InlinedLowering if each is NativeLowering else each, why)
            for each, why in passes.passes
        ]
        passes.finalize()
        return [passes]


class InlinedDispatcher(CPUDispatcher):
    """A function that kernels inline. Called from Python, it is compiled apart, in the usual way.

    `locals` and `targetoptions` are Numba's; it makes a dispatcher anew with these three arguments
    where it reads machine code from disk.
    """

    def __init__(
        self,
        py_func: Callable[..., Any],
        locals: dict[str, Any] | None = None,  # noqa: A002
        targetoptions: dict[str, Any] | None = None,
    ) -> None:
        """Make a dispatcher as Numba does, with our compiler."""
        super().__init__(py_func, locals, targetoptions, InlinedCompiler)

    @cached_property
    def _called(self) -> Any:
        options = {k: v for k, v in self.targetoptions.items() if k in USUAL}
        return numba.njit(**options)(self.py_func)

    def _compile_for_args(self, *args: Any, **kws: Any) -> Any:
        return self._called

    def add_overload(self, cres: Any) -> None:
        """Keep what was compiled for kernels, where calls from Python do not find it."""
        self.overloads[tuple(cres.signature.args)] = cres


USUAL = ("nogil", "error_model", "fastmath", "_nrt", "boundscheck")
"""The options that also hold where a function is called from Python."""


def inlined(function: Callable[..., Any], **options: Any) -> InlinedDispatcher:
    """Return a function that kernels inline, compiled with options of `numba.njit`."""
    every = {
        "nopython": True,
        "boundscheck": None,
        "forceinline": True,
        "no_cpython_wrapper": True,
        "no_cfunc_wrapper": True,
        **options,
    }
    return InlinedDispatcher(function, targetoptions=every)
