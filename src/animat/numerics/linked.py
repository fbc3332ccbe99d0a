"""Kernels that are compiled once, and into which shapes and custom functions are linked.

Numba would compile a kernel anew for every mind of another shape and for every custom function,
for ten seconds each time. Here it is taken once as far as LLVM's unoptimised code: the *template*,
which reads the shapes of records from tables (`layout.py`) and calls custom functions by the names
of *slots*. For each shape and each custom function these are linked in, and LLVM optimises the
whole, in a second or two; a step is as fast as if it had been compiled for them alone. Template and
machine code are kept on disk. docs/decisions/linked.md says why.

This leans on private parts of Numba; tests/numerics/test_linked.py tests each of them.
"""

from __future__ import annotations

import hashlib
import inspect
from collections.abc import Callable, Iterable, Mapping
from typing import Any, NamedTuple
from weakref import WeakKeyDictionary

from llvmlite import binding
from numba import _dynfunc, types  # pyright: ignore[reportAttributeAccessIssue]
from numba.core import config
from numba.core.compiler_lock import global_compiler_lock
from numba.core.environment import Environment
from numba.core.registry import CPUDispatcher, cpu_target
from numba.core.typing.templates import signature

from animat.numerics.compiled import OPTIONS, announce, compiled, kept
from animat.numerics.inlined import InlinedCompiler, inlined
from animat.numerics.layout import Layout
from animat.numerics.slots import CUSTOM, SLOT, Role, with_arguments
from animat.numerics.snapshot import cache_key


class Names(NamedTuple):
    """The symbols of a kernel: the one Python calls, the one it calls, and its environment."""

    wrapper: str
    function: str
    environment: str


class _Template(NamedTuple):
    """A kernel as far as it can be compiled before shapes and functions are known.

    `code`, LLVM's bitcode; `roles`, of the slots it calls; `layouts`, of the tables it reads.
    """

    code: bytes
    names: Names
    roles: tuple[str, ...]
    layouts: tuple[str, ...]


def _target() -> Any:
    return cpu_target.target_context


class Linked:
    """A kernel of some layouts and roles; `of` gives it for shapes and functions.

    `arguments` are the types it takes; `libraries`, what it has been compiled to in this process,
    each with its symbols, by counts and functions.
    """

    def __init__(
        self,
        function: Callable[..., Any],
        arguments: tuple[types.Type, ...],
        layouts: Iterable[Layout],
        slots: Any,
        roles: Mapping[str, Role],
        idle: Iterable[Any],
    ) -> None:
        """Make a kernel of a Python function; see `linked`."""
        self.function = function
        self.name = f"{function.__module__}.{function.__qualname__}"
        self.arguments, self._slots, self._roles = arguments, slots, roles
        self._idle = frozenset(idle)
        self._layouts = {layout.symbol: layout for layout in layouts}
        self._template: _Template | None = None
        self._made: dict[Any, Callable[..., Any]] = {}
        self.libraries: dict[Any, tuple[Any, Names]] = {}
        self._disk: Any = None

    def of(self, counts: Any, functions: Any = ()) -> Callable[..., Any]:
        """Return the kernel for records of these counts, with these functions in its slots.

        Both are named tuples; the counts have all that the layouts have.

        It takes arguments of the types it was declared with, which it does not check. With
        `NUMBA_DISABLE_JIT=1` it is the Python function.
        """
        if getattr(config, "DISABLE_JIT", False):
            return lambda *arguments: self.function(*arguments, functions)
        key = (counts, functions)
        made = self._made.get(key)
        if made is None:
            with global_compiler_lock:
                made = self._made.get(key) or self._kernel(counts, functions)
                self._made[key] = made
        return made

    def _kernel(self, shape_of: Any, functions: Any) -> Callable[..., Any]:
        template, counts = self._compiled(), shape_of._asdict()
        own = [cache_key(getattr(functions, role)) for role in template.roles]
        shape = [self._layouts[symbol].table(counts) for symbol in template.layouts]
        key = repr((self.name, own, shape))
        lasts = None not in own
        codegen = _target().codegen()
        known = self._load(key) if lasts else None
        if known is not None:
            names, code = known
            library = codegen.unserialize_library(code)
        else:
            suffix = f".{hashlib.sha256(key.encode()).hexdigest()[:16]}.{len(self._made)}"
            library, names = self._library(template, counts, functions, suffix)
            if lasts:
                self._save(key, (names, library.serialize_using_object_code()))
        self.libraries[shape_of, functions] = library, names
        return _callable(library, names, self.function)

    def _library(
        self, template: _Template, counts: Mapping[str, int], functions: Any, suffix: str
    ) -> tuple[Any, Names]:
        """Return the machine code of a kernel, and the names of its symbols."""
        module, names = self._linked(template, counts, functions, suffix)
        library = _target().codegen().create_library(names.function)
        library.enable_object_caching()
        library._final_module.link_in(module)
        library.finalize()
        return library, names

    def _linked(
        self, template: _Template, counts: Mapping[str, int], functions: Any, suffix: str
    ) -> tuple[binding.ModuleRef, Names]:
        """Return the template with all linked in, under names of its own, and these names."""
        module = binding.parse_bitcode(template.code)
        for role in template.roles:
            module.link_in(_filling(role, self._roles[role], getattr(functions, role)))
        for symbol in template.layouts:
            table = self._layouts[symbol].table(counts)
            words = ", ".join(f"i64 {word}" for word in table)
            _define(module, symbol, f"[{len(table)} x i64] [{words}]")
        custom = any(getattr(functions, role) not in self._idle for role in template.roles)
        _define(module, CUSTOM, f"i8 {int(custom)}")
        for role in template.roles:
            module.get_function(SLOT + role).linkage = "internal"
        # In one process there are many of a kernel, which must not take one for the other.
        names = Names(*(name + suffix for name in template.names))
        module.get_function(template.names.wrapper).name = names.wrapper
        module.get_function(template.names.function).name = names.function
        module.get_global_variable(template.names.environment).name = names.environment
        return module, names

    def _compiled(self) -> _Template:
        """Return the template, from memory, from disk, or compiled."""
        if self._template is None:
            self._template = self._load("template")
        if self._template is None:
            announce()
            self._template = self._compile()
            self._save("template", self._template)
        return self._template

    def _compile(self) -> _Template:
        around = {"body": compiled(self.function), "slots": self._slots}
        kernel = with_arguments("{}", "body({}, slots)", len(self.arguments), **around)
        # Inlined as far as LLVM's code, but with what Python calls it by.
        options: dict[str, Any] = {"no_cfunc_wrapper": True, **OPTIONS}
        dispatcher: Any = CPUDispatcher(kernel, {}, {"nopython": True, **options}, InlinedCompiler)
        dispatcher.compile(self.arguments)
        (overload,) = dispatcher.overloads.values()
        described = overload.fndesc
        overload.library._ensure_finalized()
        module = overload.library._final_module
        environment = _target().get_env_name(described)
        roles = [f.name.removeprefix(SLOT) for f in module.functions if f.name.startswith(SLOT)]
        tables = [g.name for g in module.global_variables if g.name in self._layouts]
        return _Template(
            module.as_bitcode(),
            Names(described.llvm_cpython_wrapper_name, described.llvm_func_name, environment),
            tuple(sorted(roles)),
            tuple(sorted(tables)),
        )

    def _load(self, key: str) -> Any:
        return self._file().load(self._key(key))

    def _save(self, key: str, data: Any) -> None:
        self._file().save(self._key(key), data)

    def _file(self) -> Any:
        if self._disk is None:
            self._disk = kept(self.function)
        return self._disk

    def _key(self, key: str) -> tuple[Any, ...]:
        return (key, _target().codegen().magic_tuple())


def linked(
    arguments: tuple[types.Type, ...],
    layouts: Iterable[Layout],
    slots: Any = (),
    roles: Mapping[str, Role] | None = None,
    idle: Iterable[Any] = (),
) -> Callable[[Callable[..., Any]], Linked]:
    """Return a decorator that makes a `Linked` kernel of a function.

    The function takes `arguments`, and after them `slots`: a named tuple of a `slot` for each of
    `roles`, into which `Linked.of` puts functions. Those of `idle` stand for no custom one.
    """
    return lambda function: Linked(function, arguments, layouts, slots, roles or {}, idle)


def _define(module: binding.ModuleRef, symbol: str, value: str) -> None:
    """Link a constant into a module."""
    constant = binding.parse_assembly(f"@{symbol} = constant {value}")
    constant.triple, constant.data_layout = module.triple, module.data_layout
    module.link_in(constant)
    module.get_global_variable(symbol).linkage = "internal"


_FILLINGS: WeakKeyDictionary[Any, dict[str, bytes]] = WeakKeyDictionary()


def _filling(name: str, role: Role, function: Any) -> binding.ModuleRef:
    """Return a module that fills the slot of a role: a function, its result cast to the role's."""
    known = _FILLINGS.setdefault(function, {})
    if name not in known:
        fill = with_arguments("{}", "function({})", len(role.arguments), function=function)
        dispatcher = inlined(fill, **OPTIONS)
        dispatcher.compile(signature(role.result, *role.arguments))
        (overload,) = dispatcher.overloads.values()
        module = overload.library._get_module_for_linking().clone()
        filling = module.get_function(overload.fndesc.llvm_func_name)
        filling.name = SLOT + name
        filling.linkage = "external"
        known[name] = module.as_bitcode()
    return binding.parse_bitcode(known[name])


def _callable(library: Any, names: Names, function: Callable[..., Any]) -> Callable[..., Any]:
    """Return what calls a kernel from Python."""
    environment = Environment(function.__globals__)
    made = _dynfunc.make_function(
        inspect.getmodule(function),
        function.__name__,
        function.__doc__ or "",
        library.get_pointer_to_function(names.wrapper),
        environment,
        (library,),
    )
    library.codegen.set_env(names.environment, environment)
    return made
