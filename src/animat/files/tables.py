"""Tables for other programs: CSV, Parquet and pandas."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.csv as pc_csv
import pyarrow.parquet as pq

from animat.files.arguments import file
from animat.files.atomic import whole
from animat.files.settings import SettingsError

if TYPE_CHECKING:
    import pandas as pd


def write_tables(tables: Iterable[pa.Table], path: Path, *, csv: bool) -> int:
    """Write tables of one schema, at least one, one after another; return how many rows.

    A text or a number of a CSV file reads back as the same; lists are numbers joined by blanks.
    """
    writer: Any = None
    rows = 0
    try:
        for table in tables:
            part = _plain(table) if csv else table
            if writer is None and csv:
                writer = pc_csv.CSVWriter(path, part.schema)
            elif writer is None:
                writer = pq.ParquetWriter(path, part.schema, compression="zstd")
            writer.write_table(part)
            rows += part.num_rows
    finally:
        if writer is not None:
            writer.close()
    return rows


def write_csv(table: pa.Table, path: str | Path) -> None:
    """Write a table as CSV, whole or not at all. Raises SettingsError where it cannot."""
    with whole(file("path", path)) as partial:
        write_tables([table], partial, csv=True)


def to_pandas(table: pa.Table) -> pd.DataFrame:
    """Return a table as one of pandas. Raises SettingsError where pandas is not installed."""
    try:
        import pandas  # noqa: F401
    except ImportError:
        raise SettingsError("pandas is not installed: pip install animat[pandas]") from None
    return table.to_pandas()


def _plain(table: pa.Table) -> pa.Table:
    """Return a table of numbers and texts: lists as numbers joined by blanks."""
    for n, column in enumerate(table.schema):
        values = table.column(n)
        if pa.types.is_dictionary(column.type):
            values = values.cast(column.type.value_type)
        elif pa.types.is_list(column.type):
            texts = values.cast(pa.list_(pa.string()))
            values = pc.call_function("binary_join", [texts, pa.scalar(" ")])
        table = table.set_column(n, column.name, values)
    return table
