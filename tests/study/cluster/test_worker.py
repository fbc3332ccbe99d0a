"""What a worker says it has, and what it does not live."""

from __future__ import annotations

import hashlib
from importlib.metadata import version
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

import animat
from animat.life.engine import ENGINE
from animat.study.cluster import worker
from animat.study.cluster.worker import Equipment, OtherLivesError, equipment, live
from animat.study.plan.numbering import Part
from animat.study.plan.shard import part_identity

NAMES = st.dictionaries(
    st.sampled_from(["animat", "engine", "numpy", "numba"]), st.text(), min_size=1
)
FILES = st.dictionaries(st.sampled_from(["a.py", "b.toml"]), st.one_of(st.none(), st.text()))
EQUIPMENT = st.builds(Equipment, NAMES, st.text(), FILES, st.just("/here"))


def test_what_decides_the_bytes_of_results_is_told(tmp_path):
    (tmp_path / "mine.py").write_bytes(b"content")
    here, missing = str(tmp_path / "mine.py"), str(tmp_path / "yours.py")
    has = equipment([here, missing])
    assert has.versions["engine"] == str(ENGINE)
    for package in ("numpy", "numba", "llvmlite", "pyarrow", "distributed"):
        assert has.versions[package] == version(package)
    assert has.files == {here: hashlib.sha256(b"content").hexdigest(), missing: None}


@given(EQUIPMENT)
def test_who_has_the_same_lacks_nothing_wherever_it_is(has):
    there = has._replace(folder="/there", files=dict.fromkeys(has.files, "content"))
    assert there.lacks(there._replace(folder="/here")) == []


@given(EQUIPMENT, st.data())
def test_every_difference_is_told_with_both_versions(wanted, data):
    name = data.draw(st.sampled_from(sorted(wanted.versions)))
    wanted = wanted._replace(files=dict.fromkeys(wanted.files, "content"))
    other = wanted.versions[name] + "1"
    has = wanted._replace(versions=wanted.versions | {name: other})
    assert has.lacks(wanted) == [f"{name} {other} and not {wanted.versions[name]}"]
    less = {key: value for key, value in wanted.versions.items() if key != name}
    has = wanted._replace(versions=less)
    assert has.lacks(wanted) == [f"{name} none and not {wanted.versions[name]}"]
    has = wanted._replace(source=wanted.source + "1", folder="/there")
    assert has.lacks(wanted) == ["other source files of animat"]
    for path in wanted.files:
        has = wanted._replace(files=wanted.files | {path: "other"}, folder="/there")
        assert has.lacks(wanted) == [f"another {path} in /there"]
        has = wanted._replace(files=wanted.files | {path: None}, folder="/there")
        assert has.lacks(wanted) == [f"no file {path} in /there"]


def test_other_lives_than_the_client_means_are_not_lived(small):
    part = Part("teachers", 0)
    identity = part_identity(small, part)
    with pytest.raises(OtherLivesError, match="reads other lives"):
        live(small.text, part, {}, identity[::-1])


def test_every_source_file_of_animat_counts(monkeypatch):
    seen = []
    monkeypatch.setattr(worker, "_hash", seen.append)
    worker.equipment([])
    assert set(seen) == set(Path(animat.__file__).parent.rglob("*.py"))
