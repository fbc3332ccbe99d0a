"""Function files: a Python file, run with the modules beside it as its own.

An import statement in a function file, or in a module beside it, finds the modules of the file's
folder first. They are run from their source for this one file, each time it is loaded; `sys.path`
and `sys.modules` have no part in it, so that the neighbours of one file never reach another.
"""

from __future__ import annotations

import ast
import builtins
import importlib.util
import linecache
import sys
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from types import ModuleType
from typing import Any

from animat.numerics.taken import PACKAGES, in_library

NEVER_NEIGHBOURS = ("animat", "numpy", "numba")
"""What these names import is compiled or told apart by its name, so it is never a neighbour."""


def load(path: Path) -> ModuleType:
    """Run a function file and return its module. Raises whatever the file raises."""
    folder = Folder(path)
    return folder.run(folder.module, folder.file, folder.package)


def imported_files(path: Path) -> set[Path]:
    """Return the source files that a function file imports, directly or not.

    Without those of Python and of installed packages. It has to be loaded before.
    """
    folder = Folder(path)
    found: set[Path] = set()
    waiting = [(folder.file, folder.package)]
    for file, package in waiting:
        for name in _imports(file, package):
            source = folder.locate(name) or _loaded_from(name)
            if source is not None and source.is_file() and source not in found | {folder.file}:
                found.add(source)
                inner = name if source.name == "__init__.py" else name.rpartition(".")[0]
                waiting.append((source, inner))
    return found


class Folder:
    """The modules beside a function file, as that file alone has them.

    If the folder is a package, the file is a module of it, and the whole package can be imported.
    """

    def __init__(self, path: Path) -> None:
        """Take the place of a file; nothing is run yet."""
        self.file = path.resolve()
        self.top = self.folder = self.file.parent
        while (self.top / "__init__.py").is_file() and self.top.parent != self.top:
            self.top = self.top.parent
        self.package = ".".join(self.folder.relative_to(self.top).parts)
        self.module = path.stem
        self.modules: dict[str, ModuleType] = {}
        self.is_installed = in_library(str(self.file)) or any(
            name in self.file.parts for name in PACKAGES
        )

    def locate(self, name: str) -> Path | None:
        """Return the file of a module beside the function file, or its folder; None if not there.

        A folder without `__init__.py` is a package only if nothing else has its name.
        """
        first, *_ = parts = name.split(".")
        if self.is_installed or not name or first in NEVER_NEIGHBOURS:
            return None
        own = self.package and first == self.package.split(".")[0]
        path = (self.top if own else self.folder).joinpath(*parts)
        for file in (path / "__init__.py", path.with_name(f"{path.name}.py")):
            if file.is_file():
                return file
        is_ours = path.is_dir() and (len(parts) > 1 or not _is_elsewhere(first))
        return path if is_ours else None

    def run(self, name: str, path: Path, package: str) -> ModuleType:
        """Return a module after running its file. Raises whatever that raises."""
        module = ModuleType(name)
        vars(module).update(
            __file__=str(path),
            __package__=package,
            __builtins__={**vars(builtins), "__import__": self.import_},
        )
        if path.name == "__init__.py" or path.is_dir():
            module.__path__ = [str(path if path.is_dir() else path.parent)]
        self.modules[name] = module
        if path.is_dir():
            return module
        linecache.checkcache(str(path))
        try:
            exec(compile(path.read_bytes(), path, "exec", dont_inherit=True), vars(module))
        except BaseException:
            del self.modules[name]
            raise
        return module

    def import_(
        self,
        name: str,
        around: Mapping[str, Any] | None = None,
        within: Mapping[str, Any] | None = None,
        fromlist: Sequence[str] | None = (),
        level: int = 0,
    ) -> ModuleType:
        """Import as Python's own `__import__` does, but from the folder first."""
        package = (around or {}).get("__package__") or ""
        full = _absolute(name, package, level)
        if full and not level and self.locate(full.partition(".")[0]) is None:
            return builtins.__import__(name, around, within, fromlist or (), level)
        module = self._imported(full) if full else ModuleType(self.folder.name)
        for one in fromlist or ():
            for inner in getattr(module, "__all__", ()) if one == "*" else (one,):
                below = f"{full}.{inner}" if full else inner
                if not hasattr(module, inner) and self.locate(below) is not None:
                    setattr(module, inner, self._imported(below))
        return module if fromlist or not full else self.modules[full.partition(".")[0]]

    def _imported(self, name: str) -> ModuleType:
        """Return a neighbour after running it and the packages that it is in."""
        if name in self.modules:
            return self.modules[name]
        above, _, last = name.rpartition(".")
        parent = self._imported(above) if above else None
        path = self.locate(name)
        if path is None:
            raise ModuleNotFoundError(f"No module named {name!r} beside {self.file}", name=name)
        is_package = path.is_dir() or path.name == "__init__.py"
        module = self.run(name, path, name if is_package else above)
        if parent is not None:
            setattr(parent, last, module)
        return module


def _absolute(name: str, package: str, level: int) -> str:
    """Return the whole name of a module that is named from within a package."""
    if not level:
        return name
    parts = package.split(".") if package else []
    if level > max(len(parts), 1):
        raise ImportError("attempted relative import beyond the folder of the function file")
    return ".".join([*parts[: len(parts) - level + 1], *([name] if name else [])])


def _imports(file: Path, package: str) -> Iterator[str]:
    """Yield every module that a source file may import, with the packages they are in."""
    for node in ast.walk(ast.parse(file.read_bytes())):
        names: list[str] = []
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            base = _absolute(node.module or "", package, node.level)
            names = [f"{base}.{alias.name}".lstrip(".") for alias in node.names]
        for name in names:
            parts = name.split(".")
            yield from (".".join(parts[:count]) for count in range(1, len(parts) + 1))


def _loaded_from(name: str) -> Path | None:
    """Return the source file of a module that is loaded and belongs to no installed package."""
    file = getattr(sys.modules.get(name), "__file__", None)
    if file is None or not file.endswith(".py") or in_library(file):
        return None
    path = Path(file).resolve()
    return None if any(one in path.parts for one in PACKAGES) else path


def _is_elsewhere(name: str) -> bool:
    """Tell whether Python finds a module that is more than a folder."""
    try:
        spec = importlib.util.find_spec(name)
    except (ImportError, ValueError):
        return name in sys.modules
    return spec is not None and spec.origin is not None
