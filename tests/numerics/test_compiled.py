import json
import math
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

import animat
from animat.numerics.compiled import COMPILING_LAYERS, compiled, kernel

HELPER = """
from animat.numerics.compiled import compiled

SHIFT = 100.0

@compiled
def doubled(x):
    return 2.0 * x
"""

ENGINE = """
from typing import Any, NamedTuple

from numba import types

from animat.life.helper import SHIFT, doubled
from animat.numerics.compiled import compiled
from animat.numerics.linked import linked
from animat.numerics.slots import Role, slot

ROLES = {"own": Role((types.float64,), types.float64)}

class Functions(NamedTuple):
    own: Any

class Counts(NamedTuple):
    pass

@compiled
def law(x):
    return doubled(x) + SHIFT

@linked((types.float64,), (), Functions(slot("own", ROLES["own"])), ROLES)
def kernel(x, functions):
    return law(x) + functions.own(x)

def run(x, own):
    return kernel.of(Counts(), Functions(own))(x)
"""

THEIRS = """
from animat.numerics.compiled import compiled

STEEPNESS = (7.0, 0.0)

@compiled
def part(x):
    return 7.0 * x

@compiled
def whole(x):
    return 0.0 * x
"""

OWN = """
from animat.numerics.compiled import compiled
import theirs
import deep.params
import numpy
from theirs import STEEPNESS, part

RATES = numpy.loadtxt("rates.txt")

@compiled
def other(x):
    return 1.0 + STEEPNESS[0] * x + theirs.whole(x) + RATES[1] + deep.params.WHICH

@compiled
def own(x):
    return part(x) + 1.0

def bare(x):
    return x

def made(gain):
    @compiled
    def scaled(x):
        return gain * x
    return scaled
"""

# Runs the kernel and says what came out and which functions were compiled on the way.
CHILD = """
import importlib.util, json, sys, types
from numba.core import event

names = []

def loaded(file, name):
    # As a user's file is: under a name that cannot be imported.
    spec = importlib.util.spec_from_file_location("apart", file)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return getattr(module, name)

def beside_a_namesake(file, name):
    sys.modules["apart"] = types.ModuleType("apart")
    return loaded(file, name)

class Compilations(event.Listener):
    def on_start(self, event):
        names.append(event.data["dispatcher"].__name__)
    def on_end(self, event):
        pass

with event.install_listener("numba:compile", Compilations()):
    import mine
    from animat.life.engine import run
    from animat.numerics.snapshot import snapshot
    own = snapshot(eval(sys.argv[1], {**globals(), **vars(mine)}))
    print(json.dumps({"result": run(float(sys.argv[2]), own), "compiled": names}))
"""

# Runs a function by itself, then a kernel, then another; says how often it was told by then that
# one is compiled, and what is written to the error output. A negative number asks for silence.
TELLING = """
import contextlib, io, json, logging, sys
import mine
from animat.life.engine import run
from animat.numerics.snapshot import snapshot

own = snapshot(mine.own)
if float(sys.argv[2]) < 0.0:
    logging.getLogger("animat").setLevel("ERROR")
said, told = io.StringIO(), []
with contextlib.redirect_stderr(said):
    own(1.0)
    told.append(said.getvalue().count("compiling"))
    run(1.0, own)
    told.append(said.getvalue().count("compiling"))
    run(1.0, snapshot(mine.bare))
print(json.dumps({"result": said.getvalue(), "compiled": told}))
"""

# Forks a process for each line it is given. Numba is imported before, which takes a second.
ZYGOTE = """
import json, os, sys, traceback, warnings
import animat.numerics.linked, numba.core.event
from numba.core import config
for name in [name for name in sys.modules if name.partition(".")[0] == "animat"]:
    del sys.modules[name]
for line in sys.stdin:
    asked = json.loads(line)
    out, into = os.pipe()
    if not os.fork():
        os.dup2(into, 1)
        os.dup2(into, 2)
        os.close(out)
        try:
            os.environ.update(asked["environment"])
            os.chdir(asked["folder"])
            config.reload_config()
            sys.argv, sys.path[:1] = ["-c", *asked["arguments"]], [asked["folder"]]
            exec(asked["script"], {"__name__": "__main__"})
            sys.stdout.flush()
        except BaseException:
            traceback.print_exc()
            sys.stderr.flush()
        os._exit(0)
    os.close(into)
    with open(out) as said:
        print(json.dumps(said.read()), flush=True)
    os.wait()
"""


class Laboratory:
    """A copy of the package with an engine of its own, and a user's files beside it."""

    def __init__(self, folder: Path, zygote: Any):
        self.folder, self.zygote = folder, zygote
        self.package = folder / "animat"
        real = Path(animat.__file__).parent
        unread = shutil.ignore_patterns("__pycache__")
        shutil.copytree(real / "numerics", self.package / "numerics", ignore=unread)
        shutil.copy(real / "errors.py", self.package)
        (self.package / "life").mkdir()
        for package in (self.package, self.package / "life"):
            (package / "__init__.py").write_text("")
        (self.package / "life" / "helper.py").write_text(HELPER)
        (self.package / "life" / "engine.py").write_text(ENGINE)
        (folder / "mine.py").write_text(OWN)
        (folder / "theirs.py").write_text(THEIRS)
        (folder / "rates.txt").write_text("1.0 0.0")
        (folder / "deep").mkdir()
        (folder / "deep" / "params.py").write_text("WHICH = 0.0")

    def run(self, own="own", x=1.0, script=CHILD):
        """Run in a process of its own; return the result and the names of what it compiled."""
        asked = {
            "environment": {"NUMBA_CACHE_DIR": str(self.folder / "cache")},
            "folder": str(self.folder),
            "arguments": [own, str(x)],
            "script": script,
        }
        self.zygote.stdin.write(json.dumps(asked) + "\n")
        self.zygote.stdin.flush()
        answer = json.loads(self.zygote.stdout.readline())
        try:
            said = json.loads(answer.splitlines()[-1])
        except (json.JSONDecodeError, IndexError):
            raise AssertionError(answer) from None
        return said["result"], said["compiled"]

    def run_uncompiled(self):
        """Run in a process in which Numba compiles nothing."""
        environment = {
            **os.environ,
            "PYTHONPATH": str(self.folder),
            "PYTHONDONTWRITEBYTECODE": "1",
            "NUMBA_CACHE_DIR": str(self.folder / "cache"),
            "NUMBA_DISABLE_JIT": "1",
        }
        command = [sys.executable, "-W", "error", "-c", CHILD, "own", "1.0"]
        ran = subprocess.run(
            command, env=environment, cwd=self.folder, capture_output=True, text=True, check=False
        )
        assert ran.returncode == 0, ran.stderr
        said = json.loads(ran.stdout)
        return said["result"], said["compiled"]

    def edit(self, name, old, new):
        """Change a source file so that neither its length nor its time of change tells."""
        path = self.folder / name
        before = path.stat()
        text = path.read_text()
        assert text.count(old) == 1
        assert len(old) == len(new)
        path.write_text(text.replace(old, new))
        os.utime(path, ns=(before.st_atime_ns, before.st_mtime_ns))


@pytest.fixture(scope="module")
def zygote():
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    command = [sys.executable, "-W", "error", "-B", "-c", ZYGOTE]
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True}
    with subprocess.Popen(command, env=environment, **pipes) as process:
        yield process
        process.stdin.close()


@pytest.fixture
def laboratory(tmp_path, zygote):
    return Laboratory(tmp_path, zygote)


EDITS = [
    # file, what stands there, what comes instead, the kernel's result from then on
    ("animat/life/helper.py", "2.0 * x", "3.0 * x", 111),
    ("animat/life/helper.py", "SHIFT = 100.0", "SHIFT = 200.0", 211),
    ("animat/life/engine.py", "+ functions.own(x)", "- functions.own(x)", 195),
    ("mine.py", "+ 1.0", "+ 5.0", 191),
    ("theirs.py", "7.0 * x", "8.0 * x", 190),
]


def test_only_a_changed_source_is_compiled_in_a_second_process(laboratory):
    result, names = laboratory.run()
    assert result == 110
    assert {"kernel", "law", "doubled", "own", "part"} <= set(names)
    assert laboratory.run(x=2.0) == (119, [])
    for file, old, new, expected in EDITS:
        laboratory.edit(file, old, new)
        result, names = laboratory.run()
        assert result == expected, (file, new)
        assert names
        assert ("law" in names) == file.startswith("animat")  # the template stays
    assert laboratory.run() == (190, [])


def test_every_layer_that_compiles_is_stamped():
    root = Path(animat.__file__).parent
    compiling = {
        path.relative_to(root).parts[0]
        for path in root.rglob("*.py")
        if re.search(r"^@(compiled|kernel|linked\()", path.read_text("utf-8"), re.MULTILINE)
    }
    assert compiling == set(COMPILING_LAYERS)


def test_what_a_user_s_file_imports_is_not_overlooked(laboratory):
    assert laboratory.run("other")[0] == 110
    laboratory.edit("theirs.py", "STEEPNESS = (7.0", "STEEPNESS = (9.0")
    assert laboratory.run("other")[0] == 112
    laboratory.edit("theirs.py", "0.0 * x", "5.0 * x")
    laboratory.edit("rates.txt", "1.0 0.0", "1.0 3.0")
    laboratory.edit("deep/params.py", "0.0", "4.0")
    assert laboratory.run("other")[0] == 124
    assert laboratory.run("other") == (124, [])


def test_a_file_that_cannot_be_imported_by_its_name_is_found_again(laboratory):
    assert laboratory.run("loaded('mine.py', 'own')")[0] == 110
    assert laboratory.run("loaded('mine.py', 'own')") == (110, [])


def test_what_was_compiled_beside_another_module_of_a_file_s_name_is_no_trap(laboratory):
    """The compiler counts the file's functions to that module, which the next process lacks."""
    assert laboratory.run("beside_a_namesake('mine.py', 'own')")[0] == 110
    assert laboratory.run("loaded('mine.py', 'own')")[0] == 110
    assert laboratory.run("loaded('mine.py', 'own')") == (110, [])


def test_what_is_torn_is_compiled_anew(laboratory):
    laboratory.run()
    torn = [path for path in (laboratory.folder / "cache").rglob("*.nbc") if "kernel" in path.name]
    assert torn
    for path in torn:
        path.write_bytes(path.read_bytes()[:-100])
    assert laboratory.run()[0] == 110
    assert laboratory.run() == (110, [])


def test_a_function_that_is_gone_takes_no_other_with_it(laboratory):
    """What is kept names the functions it was compiled with."""
    assert laboratory.run("compiled(bare)")[0] == 103
    laboratory.edit("mine.py", "def bare(x)", "def base(x)")
    assert laboratory.run("other")[0] == 110
    assert laboratory.run("other") == (110, [])


def test_a_user_is_told_once_that_kernels_are_compiled_and_not_when_they_are_read(laboratory):
    text, told = laboratory.run(script=TELLING)
    assert text == "compiling the simulator, once, some 10 s ...\n"
    assert told == [0, 1]
    assert laboratory.run(script=TELLING) == ("", [0, 0])


def test_who_wants_no_word_of_compiling_silences_the_logger(laboratory):
    assert laboratory.run(script=TELLING, x=-1.0) == ("", [0, 0])


def test_functions_made_by_one_function_are_told_apart(laboratory):
    assert laboratory.run("made(3.0)")[0] == 105
    result, names = laboratory.run("made(4.0)")
    assert result == 106
    assert "scaled" in names
    assert "law" not in names
    assert laboratory.run("made(3.0)") == (105, [])


def test_uncompiled_nothing_is_compiled(laboratory):
    assert laboratory.run_uncompiled() == (110, [])
    assert not (laboratory.folder / "cache").exists()


@compiled
def quotient(a, b):
    return a / b


@kernel
def quotient_of_sum(a, b, c):
    return quotient(a + b, c)


def test_no_step_raises():
    assert quotient_of_sum(1.0, 2.0, 4.0) == 0.75
    assert quotient_of_sum(1.0, 2.0, 0.0) == math.inf


@kernel
def there_and_back(small, large):
    return (small + large) - large


def test_sums_keep_their_order():
    """Fast maths would let the large terms cancel and the small one survive."""
    assert there_and_back(1.0, 1e300) == 0.0
