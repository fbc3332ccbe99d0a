"""One file for other programs: everything is in it, as other programs read it."""

from __future__ import annotations

import math
import shutil
import sys

import pandas as pd
import pyarrow.parquet as pq
import pytest
import xarray as xr

from animat.files.settings import SettingsError
from animat.study.store.export import export
from animat.study.store.results import Results


@pytest.fixture
def copied(finished, tmp_path):
    return Results(shutil.copytree(finished, tmp_path / "results"))


def test_parquet_is_the_table_of_lives(copied, tmp_path):
    path = tmp_path / "lives.parquet"
    assert export(copied, "parquet", path) == 16
    assert pq.read_table(path).to_pylist() == copied.lives().to_pylist()


def test_csv_says_the_same_to_the_last_digit(copied, tmp_path):
    path = tmp_path / "lives.csv"
    assert export(copied, "csv", path) == 16
    frame = pd.read_csv(path, float_precision="round_trip")
    lives = copied.lives()
    assert list(frame.columns) == lives.column_names
    for name in ("case", "mind.agent", "life", "lifespan", "mean_drive", "likelihood_eat_TS"):
        assert frame[name].tolist() == lives[name].to_pylist()
    for text, weights in zip(frame["weights"], lives["weights"].to_pylist(), strict=True):
        if weights is None:
            assert isinstance(text, float)
            assert math.isnan(text)
        else:
            assert [float(number) for number in text.split()] == weights
    assert frame["error"].isna().all()


def test_netcdf_has_an_array_for_each_column(copied, tmp_path):
    path = tmp_path / "lives.nc"
    assert export(copied, "nc", path) == 16
    with xr.open_dataset(path, engine="h5netcdf") as data:
        assert dict(data.sizes) == {"case": 2, "life": 8, "weight": 27}
        assert data["mind.agent"].values.tolist() == ["LEARNING", "AF"]
        for row in copied.lives().to_pylist():
            one = data.sel(case=row["case"], life=row["life"])
            for name in ("lifespan", "mean_drive", "acts_eat", "censored", "agent"):
                assert one[name].item() == row[name]
            weights = row["weights"] or [math.nan] * 27
            assert one["weights"].values.tolist() == pytest.approx(weights, nan_ok=True, rel=0)
        assert data.attrs["study"] == "small"
        assert data.attrs["study_file"].startswith('name = "small"')


@pytest.mark.parametrize("kind", ["csv", "parquet", "nc"])
def test_what_is_not_finished_is_left_out_or_empty(copied, tmp_path, kind):
    (copied.directory / "lives" / "part-000000.parquet").unlink()
    path = tmp_path / f"lives.{kind}"
    assert export(copied, kind, path) == 8
    if kind == "nc":
        with xr.open_dataset(path, engine="h5netcdf") as data:
            assert data["lifespan"].isnull().sum(dim="life").values.tolist() == [8, 0]
            assert data["lifespan"].sel(case=1).values.tolist() == [150.0] * 8
            assert data["agent"].values.tolist() == [[""] * 8, ["AF"] * 8]


def test_unpaired_lives_have_a_place_of_their_own(faults, tmp_path):
    faults.go_on(
        faults.plan(
            'name = "unpaired"\nlives = 3\nsteps = 20\npaired = false\n'
            '[design.grid]\n"mind.gate" = ["positive", "always"]\n'
        ),
        tmp_path / "results",
    )
    export(Results(tmp_path / "results"), "nc", tmp_path / "lives.nc")
    with xr.open_dataset(tmp_path / "lives.nc", engine="h5netcdf") as data:
        assert data["life_index"].values.tolist() == [[0, 1, 2], [3, 4, 5]]


def test_what_cannot_be_written_is_refused(copied, tmp_path):
    for kind, name, why in (
        ("xls", "a.xls", "no such format; allowed are csv, parquet, nc"),
        ("csv", "a.txt", r"give a name that ends in \.csv"),
        ("csv", "none/a.csv", "there is no directory"),
    ):
        with pytest.raises(SettingsError, match=why):
            export(copied, kind, tmp_path / name)
    (tmp_path / "a.csv").write_text("mine")
    with pytest.raises(SettingsError, match="is there already; --force replaces it"):
        export(copied, "csv", tmp_path / "a.csv")
    assert export(copied, "csv", tmp_path / "a.csv", force=True) == 16


def test_netcdf_says_what_it_needs(copied, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "xarray", None)
    with pytest.raises(SettingsError, match=r"pip install animat\[netcdf\]"):
        export(copied, "nc", tmp_path / "lives.nc")
    assert not list(tmp_path.glob("*lives*"))
