"""What Python hands over: every public callable, given everything that is wrong."""

from __future__ import annotations

import inspect
import math
import warnings
from decimal import Decimal
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pytest
from pydantic import BaseModel

import animat
import animat.study
from animat.files.settings import Settings
from animat.files.validation_errors import shown
from animat.mind.physiology import Variable
from animat.robot.khepera import Sensor
from animat.study.file.design import Exclusion
from animat.study.file.factors import Range
from animat.study.file.sampling import Sample
from animat.study.file.study import Record


class Unhashable:
    """Can be called, but is in no set."""

    __hash__ = None  # pyright: ignore[reportAssignmentType]

    def __call__(self, *_):
        """Do nothing."""


class Untold:
    """Does not tell what it is, nor whether it is equal."""

    def __repr__(self):
        raise RuntimeError("untold")


class Index:
    """A whole number by its own word, which breaks it."""

    def __index__(self):
        raise OverflowError("no")


WRONG: list[Any] = [
    None, True, np.True_, 0, -1, 1.5, 1e308, -1e308, 5e-324, math.nan, math.inf, 2**63, 2**64,
    10**400, 10**5000, np.int8(-1), np.uint64(2**64 - 1), np.float32("nan"), np.float64(0.5),
    np.longdouble(2), Fraction(1, 3), Decimal("1"), 1j, "", "1", "a\nb", "a\0b", "\ud800", "_", "/",
    "x" * 5_000, b"x", np.str_("BLIND"), np.array([1, 2]), np.zeros((2, 2)), np.array(["a"]),
    np.datetime64("2003"), [], [1], [[1, 2]], [None], (), {}, {"a": 1}, {1: 2}, {"": {}},
    {"a": {"b": {}}}, {"eat": None}, set(), range(3), object(), int, Unhashable(), Untold(),
    Index(), Path("/dev/null/x"), Path(), pa.table({}), animat.Mind(), animat.TABLE_1,
]  # fmt: skip


def given_wrongly(call: Any, right: dict[str, Any], name: str) -> list[str]:
    """Call with every wrong value of an argument; return what else comes out than animat's own."""
    found = []
    for value in WRONG:
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                call(**{**right, name: value})
        except animat.Error as error:
            if not error.problems or any(not p or "\n" in p or "\r" in p for p in error.problems):
                found.append(f"{name} = {type(value).__name__}: {error.problems}")
        except BaseException as error:
            found.append(f"{name}{shown(value)} ({type(value).__name__}): {error!r}"[:300])
    return found


def arguments_of(call: Any) -> list[str]:
    """Return the names of what a public callable takes."""
    if isinstance(call, type) and issubclass(call, BaseModel):
        return list(call.model_fields)
    return [name for name in inspect.signature(call).parameters if name != "self"]


MODELS: dict[type[Settings], dict[str, Any]] = {
    animat.Arena: {},
    animat.Behaviour: {"serves": "hunger", "needs": "grasp"},
    animat.Drive: {"a": {"nutrition": 1.0}},
    animat.Khepera: {},
    animat.Learning: {},
    animat.Mind: {},
    animat.ObjectType: dict(animat.TABLE_1[0]),
    animat.Placement: {"type": "TS", "x": 500.0, "y": 500.0},
    animat.VariableChange: {},
    Variable: {"law": "decay", "rate": 0.1, "set_point": 0.5},
    Sensor: {"x": 1.0, "y": 1.0, "direction": 0.0},
    animat.study.CaseSettings: {},
    animat.study.Design: {},
    animat.study.LifeSettings: {},
    animat.study.Study: {"name": "small"},
    animat.study.Teacher: {},
    animat.study.WorldChoice: {},
    Exclusion: {"when": {"a": 1}, "why": "so"},
    Range: {"low": 0, "high": 1},
    Record: {"what": "all"},
    Sample: {"method": "sobol", "points": 2, "over": {"mind.overflow": ["clamp"]}},
}
"""Settings that are right; what is wrong is put in their place."""


@pytest.mark.parametrize("model", MODELS, ids=lambda model: model.__name__)
def test_settings_refuse_whatever_is_wrong_as_animat_does(model):
    found = [
        line for name in model.model_fields for line in given_wrongly(model, MODELS[model], name)
    ]
    assert not found, "\n".join(found)


NESTED = {
    "variables": ("nutrition", animat.VariableChange, {}),
    "drives": ("hunger", animat.Drive, {}),
    "behaviours": ("eat", animat.Behaviour, {}),
}


@pytest.mark.parametrize("table", NESTED)
def test_settings_in_settings_are_refused_where_they_stand(table):
    entry, model, right = NESTED[table]
    base = animat.Mind().model_dump()[table] if table != "variables" else {}
    right = base.get(entry, right)

    def mind(**inner: Any) -> animat.Mind:
        return animat.Mind(**{table: {**base, entry: inner}})

    found = [line for name in model.model_fields for line in given_wrongly(mind, right, name)]
    assert not found, "\n".join(found)


@pytest.fixture(scope="module")
def calls(tmp_path_factory):
    """Every public callable that is no group of settings, with arguments that are right.

    Some wrong values are names of files; those are written to a folder of their own.
    """
    folder = tmp_path_factory.mktemp("border")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        yield calls_in(folder)


def calls_in(folder: Path) -> dict[Any, dict[str, Any]]:
    """Return `calls`, whose files are in a folder."""
    world = animat.World.random({"TS": 1}, arena=animat.Arena(width=400.0, height=400.0))
    mind = animat.Mind(agent="LEARNING")
    born = {"mind": mind, "world": world, "steps": 1}
    life = animat.live(**born, record="all")
    file = folder / "life.parquet"
    animat.record(**born, path=file)
    recording = animat.Recording.load(file)
    networks = life.networks
    study = animat.study.Study(name="small")
    small = animat.study.Study(name="small", lives=1, steps=1)
    done = animat.run(small, folder / "done", progress=False)
    features = {"features": {"shape": 0.0, "size": 1.0}}
    return {
        animat.live: born,
        life.to_csv: {"path": folder / "life.csv"},
        animat.live_many: {**born, "lives": 1, "threads": 1},
        animat.live_many(**born, lives=1).to_csv: {"path": folder / "lives.csv"},
        animat.record: {**born, "path": folder / "again.parquet"},
        animat.Layout: {"placements": world.layout.placements, "arena": world.arena},
        animat.World: {"layout": world.layout},
        animat.Networks: vars(networks),
        animat.World.random: {"counts": {"TS": 1}},
        animat.World.load: {"path": folder / "none.toml"},
        world.save: {"path": folder / "world.toml"},
        world.with_spares: {"n_per_type": 1},
        world.raster: {"horizon": 60.0},
        mind.functions: {},
        mind.weight_count: {"feature_count": 2},
        networks.likelihoods: features,
        networks.save: {"path": folder / "networks.toml"},
        networks.figure: {"objects": {"TS": {"shape": 0.0, "size": 1.0}}},
        animat.Networks.load: {"path": folder / "none.toml"},
        animat.Recording.load: {"path": file},
        recording.at: {"step": 0},
        recording.verify: {},
        recording.at(0).live: {"steps": 1},
        animat.run: {"study": small, "out": folder / "done", "threads": 1, "progress": False},
        done.report: {"out": folder / "report.html"},
        animat.study.read_study: {"path": folder / "none.toml"},
        animat.study.study_file: {"study": "experiment1"},
        animat.study.open: {"directory": folder},
        animat.study.cases: {"study": study},
        animat.study.excluded: {"study": study},
        study.chosen: {"choice": study.world},
    }


def test_every_call_refuses_whatever_is_wrong_as_animat_does(calls):
    found = [
        f"{call.__qualname__}: {line}"
        for call, right in calls.items()
        for name in arguments_of(call)
        for line in given_wrongly(call, right, name)
    ]
    assert not found, "\n".join(found)


MADE_BY_ANIMAT = {
    *(animat.Life, animat.Lives, animat.Moment, animat.Recording, animat.StudyRun),
    *(animat.study.Case, animat.study.Excluded, animat.study.Results),
}
"""What users get and do not make; methods of Results are called in study/store/test_results.py."""


def test_every_public_callable_is_called(calls):
    public = [getattr(module, n) for module in (animat, animat.study) for n in module.__all__]
    known = {*MODELS, *MADE_BY_ANIMAT, animat.Error, animat.SettingsError}
    called = {getattr(call, "__qualname__", "") for call in calls}
    for each in filter(callable, public):
        assert each in known or each.__qualname__ in called, each
        if isinstance(each, type) and each is not animat.study.Results:
            for name, method in vars(each).items():
                own = getattr(method, "__func__", method)
                is_public = inspect.isfunction(own) and not name.startswith("_")
                if is_public and set(inspect.signature(own).parameters) - {"self", "cls"}:
                    assert own.__qualname__ in called, own
