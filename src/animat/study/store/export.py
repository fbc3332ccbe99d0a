"""The lives of a study as one file for other programs: CSV, Parquet or NetCDF.

CSV and Parquet are written some thousands of rows at a time, so that any study fits. NetCDF holds
an array for each column, [case, life], with the factors as coordinates of the cases, and is made in
memory.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from animat.files.atomic import check_writable, whole
from animat.files.settings import SettingsError
from animat.files.tables import write_tables
from animat.study.store.results import Results

if TYPE_CHECKING:
    import xarray as xr

FORMATS = ("csv", "parquet", "nc")


def export(results: Results, kind: str, path: Path, *, force: bool = False) -> int:
    """Write the lives that are finished, with the factors of their cases; return how many.

    Raises SettingsError for another format than `FORMATS`, or where `path` cannot be written.
    """
    if kind not in FORMATS:
        raise SettingsError(f'"{kind}": no such format; allowed are {", ".join(FORMATS)}')
    check_writable(path, (f".{kind}",), force=force)
    with whole(path) as partial:
        if kind == "nc":
            return _write_netcdf(results, partial)
        return write_tables(results.batches(), partial, csv=kind == "csv")


def _write_netcdf(results: Results, path: Path) -> int:
    try:
        import xarray as xr
    except ImportError:
        raise SettingsError("NetCDF needs more packages: pip install animat[netcdf]") from None
    lives = results.lives()
    per_case = results.study.lives
    case = lives["case"].to_numpy()
    first = 0 if results.study.paired else case * per_case
    place = (case, lives["life"].to_numpy() - first)
    shape = (results.cases.num_rows, per_case)
    arrays = {}
    for name in lives.column_names:
        if name not in {"case", *results.factors}:
            values = _values(lives[name])
            dims = ("case", "life", "weight")[: 1 + values.ndim]
            arrays[name] = (dims, _spread(values, place, shape))
    arrays["life_index"] = arrays.pop("life")
    factors = {name: ("case", _values(results.cases[name])) for name in results.factors}
    coordinates: dict[str, Any] = {
        "case": np.arange(shape[0]),
        "life": np.arange(per_case),
        **factors,
    }
    manifest = {key: results.manifest[key] for key in ("study", "hash", "engine")}
    how = {
        "study_file": results.text,
        "runs": json.dumps(results.manifest["runs"]),
    }
    made: xr.Dataset = xr.Dataset(arrays, coordinates, manifest | how)
    made.to_netcdf(path, engine="h5netcdf")
    return lives.num_rows


def _values(column: pa.ChunkedArray) -> NDArray[Any]:
    """Return a column as an array [N], or [N, W] for lists: texts as objects, gaps as NaN or ""."""
    kind = column.type
    if pa.types.is_list(kind):
        lists = column.to_pylist()
        width = max((len(each) for each in lists if each), default=0)
        filled = [each or [np.nan] * width for each in lists]
        return np.array(filled, float).reshape(len(filled), width)
    if pa.types.is_string(kind) or pa.types.is_dictionary(kind):
        return np.array([text or "" for text in column.to_pylist()], object)
    if pa.types.is_boolean(kind) and not column.null_count:
        return column.to_numpy()
    if column.null_count:
        return (
            column.cast(pa.int8() if pa.types.is_boolean(kind) else kind).to_numpy().astype(float)
        )
    return column.to_numpy()


def _spread(
    values: NDArray[Any], place: tuple[NDArray[Any], NDArray[Any]], shape: tuple[int, int]
) -> NDArray[Any]:
    """Return values as an array [case, life]; lives that are not finished are NaN, or ""."""
    whole_shape = (*shape, *values.shape[1:])
    if len(values) == shape[0] * shape[1]:
        spread = np.empty(whole_shape, values.dtype)
    elif values.dtype == object:
        spread = np.full(whole_shape, "", object)
    else:
        spread = np.full(whole_shape, np.nan)
    spread[place] = values
    return spread
