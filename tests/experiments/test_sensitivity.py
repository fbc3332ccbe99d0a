from types import SimpleNamespace

import numpy as np
import pyarrow as pa
import pytest

from animat.experiments.multiverse_designs import with_points
from animat.experiments.sensitivity import check, name_of, sensitivity
from animat.files.settings import SettingsError, validated
from animat.report.sensitivity_page import publish, short
from animat.statistics.sobol import sobol_table
from animat.study.execute.run import run, threads
from animat.study.file.axes import axes
from animat.study.file.builtin import shipped
from animat.study.file.cases import cases
from animat.study.file.read import read_study
from animat.study.file.sampling import Sample
from animat.study.file.study import Study
from animat.study.plan.plan import Plan
from animat.study.store.results import open as open_results

SMALL = ("lives=4", "steps=400", "teacher.robots=1", "teacher.steps=600", "design.sample.points=4")


@pytest.fixture(scope="module")
def small() -> Study:
    return read_study(shipped("sensitivity"), SMALL)


@pytest.fixture(scope="module")
def lived(small, tmp_path_factory):
    directory = tmp_path_factory.mktemp("sensitivity")
    with threads(2) as workers:
        outcome = run(Plan(small), directory, workers, lambda *_, **__: None)
    assert outcome.complete
    return open_results(directory)


def test_the_points_are_two_samples_and_their_mixtures():
    over = {"mind.success_effect": {"low": 0.1, "high": 0.3}, "mind.cruise_speed": [1, 2, 3]}
    sample = Sample.model_validate({"method": "saltelli", "points": 8, "over": over})
    a, b, first, second = sample.shares().reshape(4, 8, 2)
    assert sample.size == 32
    np.testing.assert_array_equal(first, np.column_stack([b[:, 0], a[:, 1]]))
    np.testing.assert_array_equal(second, np.column_stack([a[:, 0], b[:, 1]]))
    assert not np.any(a == b)
    assert ((a >= 0.0) & (a < 1.0)).all()
    with pytest.raises(ValueError, match="power of 2"):
        Sample.model_validate({"method": "saltelli", "points": 6, "over": over})


def test_the_study_that_ships_varies_what_was_asked_for(small):
    assert read_study(shipped("sensitivity"), ["design.sample.points=2"]).steps == 50_000
    names = [name_of(key) for key in small.design.sample.over]
    assert len(set(names)) == len(names)
    for kind in ("rate", "set point", "effect", "speed", "arena", "counts", "seed"):
        assert any(kind in name for name in names), kind
    assert len(cases(small)) == 2 * small.design.sample.size
    for case in cases(small):
        assert case.settings.world.arena is not None
        if case.teacher is not None:
            assert case.teacher.world == case.settings.world


def test_the_indices_are_those_of_the_mean_lifespans(lived):
    found = sensitivity(lived)
    lives = lived.lives(["mind.agent", "case", "lifespan"]).to_pandas()
    means = lives.groupby("case").lifespan.mean()
    half = len(means) // 2
    names = [name_of(key) for key in found.study.design.sample.over]
    expected = sobol_table(
        {"BLIND": np.log(means[:half].to_numpy()), "AF": np.log(means[half:].to_numpy())}, names
    )
    assert found.indices.to_pandas().equals(expected.to_pandas())
    within = lives[lives.case < half].groupby("case").lifespan.var(ddof=1) / 4
    noise = (within / means[:half] ** 2).mean() / np.log(means[:half]).var(ddof=0)
    assert found.noise["BLIND"] == pytest.approx(noise)


def made_up(study, lifespan):
    """Results in which a life of a point lasts as long as `lifespan` of its parameters says."""
    (points,) = [axis for axis in axes(study.design, study) if len(axis) > 2]
    spans = [lifespan(option.factors) for option in points] * 2
    rows = pa.table(
        {
            "case": np.repeat(np.arange(len(spans)), study.lives),
            "lifespan": np.repeat(spans, study.lives),
            "error": pa.array([None] * len(spans) * study.lives, pa.string()),
        }
    )
    return SimpleNamespace(
        study=study,
        cases=pa.table({"case": np.arange(len(spans))}),
        batches=lambda _: iter([rows.slice(0, 50), rows.slice(50)]),
        directory="results/made-up",
    )


def test_a_planted_parameter_explains_all_and_nothing_is_random(small):
    study = with_points(small, 128)
    found = sensitivity(
        made_up(study, lambda point: 1_000.0 * np.exp(3.0 * point["mind.success_effect"]))
    )
    for row in found.indices.to_pylist():
        expected = 1.0 if row["parameter"] == "success effect" else 0.0
        assert row["index"] == pytest.approx(expected, abs=0.2)
    assert found.noise == {"BLIND": 0.0, "AF": 0.0}
    blind, af = short(found, most=1)
    assert blind.startswith("BLIND: success effect ")
    assert af.endswith("0% of the variance is random")


def test_points_whose_lives_failed_are_told_of(small):
    results = made_up(small, lambda point: 500.0)
    whole = next(results.batches(None))
    results.batches = lambda _: iter([whole])
    with pytest.raises(SettingsError, match="cases have lives that failed"):
        sensitivity(results)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"sample": {"method": "sobol"}}, 'method = "saltelli"'),
        ({"grid": {"mind.agent": ["AF"], "mind.gate": ["always"]}}, "a grid of"),
        ({"lives": 1}, "at least 2 lives"),
    ],
)
def test_a_study_of_other_points_is_refused(small, change, message):
    data = small.model_dump(mode="json", exclude_none=True)
    if "lives" in change:
        data |= change
    else:
        for name, part in change.items():
            data["design"][name] = {**(data["design"][name] if name == "sample" else {}), **part}
    with pytest.raises(SettingsError, match=message):
        check(validated(data, Study))


def test_the_page_has_the_indices_and_the_ranges(lived, tmp_path):
    publish(sensitivity(lived), tmp_path, "animat sensitivity")
    text = (tmp_path / "sensitivity.html").read_text("utf-8")
    assert "restlessness rate" in text
    assert "by its logarithm" in text
    assert "is itself in part random" in text
    assert (tmp_path / "indices.csv").exists()
    assert (tmp_path / "sobol.svg").exists()
