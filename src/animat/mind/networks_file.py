"""Networks as TOML files: every bit of a weight is written, and damage is found.

format = 1
features = ["shape", "size"]
hidden = 2
sha256 = "..."                # of all that follows from the file; may be left out

[weights]
eat = [
    [0.1, 0.2, 0.3],          # a hidden unit: its bias, and a weight for each feature
    [0.4, 0.5, 0.6],
    [0.7, 0.8, 0.9],          # the output: its bias, and a weight for each hidden unit
]
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated

import numpy as np
import tomli_w
from numpy.typing import NDArray
from pydantic import Field, ValidationError, model_validator

from animat.files.atomic import write_whole
from animat.files.settings import Settings, SettingsError, explain, parse_toml, validated
from animat.files.validation_errors import plain, written

FORMAT = 1
"""Raised by 1 with every change after which an earlier version cannot read a file."""

LARGEST_FILE = 10_000_000
"""Bytes; some 500,000 weights."""

HEAD = """\
# Affordance networks that a robot has learnt, for `animat life --networks`. Each has a row for each
# hidden unit: its bias, then a weight for each feature; then one for the output: its bias, then a
# weight for each hidden unit. If you change a number, remove the line sha256.
"""


class NetworksFile(Settings):
    """What a file of networks may say: `weights` by behaviour, H rows of F + 1 and one of H + 1."""

    format: int
    features: Annotated[tuple[str, ...], Field(min_length=1)]
    hidden: Annotated[int, Field(ge=1, le=64)]
    sha256: str | None = None
    weights: Annotated[dict[str, tuple[tuple[float, ...], ...]], Field(min_length=1)]

    @model_validator(mode="after")
    def _fits(self) -> NetworksFile:
        problems = list(_misfits(self))
        if not problems and self.sha256 not in {None, self.checksum()}:
            problems = ["sha256 is not that of the file: it is damaged, or was changed by hand"]
        if problems:
            raise ValueError("\n".join(problems))
        return self

    def matrix(self) -> NDArray[np.float64]:
        """Return the weights [B, W]."""
        return np.array([[w for row in rows for w in row] for rows in self.weights.values()])

    def checksum(self) -> str:
        """Return the SHA-256 of names, sizes and weights, in hexadecimal."""
        names = json.dumps([self.format, self.features, self.hidden, [*self.weights]])
        return hashlib.sha256(names.encode() + self.matrix().astype("<f8").tobytes()).hexdigest()


def _misfits(file: NetworksFile) -> Iterator[str]:
    if len(set(file.features)) < len(file.features):
        yield "features: names one twice"
    rows, unit = file.hidden + 1, len(file.features) + 1
    for name, weights in file.weights.items():
        key = written(("weights", name))
        if len(weights) != rows:
            yield f"{key} has {len(weights)} rows; hidden = {file.hidden} makes {rows}"
            continue
        for n, row in enumerate(weights):
            wanted = unit if n < file.hidden else rows
            if len(row) != wanted:
                what = "a hidden unit" if n < file.hidden else "the output"
                yield f"{key}[{n}] has {len(row)} numbers; {what} has {wanted}"


def read_networks_file(path: Path) -> NetworksFile:
    """Return what a file of networks says. Raises SettingsError, a line for each mistake."""
    data = parse_toml(path, LARGEST_FILE)
    if data.get("format", FORMAT) != FORMAT:
        raise SettingsError(
            f"{path}: format = {plain(data['format'])}: this animat reads format {FORMAT}"
        )
    try:
        return validated(data, NetworksFile)
    except ValidationError as error:
        raise explain(error, NetworksFile, str(path)) from None


def write_networks_file(
    path: Path,
    behaviours: tuple[str, ...],
    features: tuple[str, ...],
    hidden: int,
    weights: NDArray[np.float64],
) -> None:
    """Write networks, `weights` [B, W], whole or not at all. Raises SettingsError."""
    units, outputs = np.split(weights, [hidden * (len(features) + 1)], axis=1)
    rows = {
        name: (*units[b].reshape(hidden, -1).tolist(), outputs[b].tolist())
        for b, name in enumerate(behaviours)
    }
    try:
        file = NetworksFile.__pydantic_validator__.validate_python(
            {"format": FORMAT, "features": features, "hidden": hidden, "weights": rows},
            strict=False,
        )
    except ValidationError as error:
        raise explain(error, NetworksFile, str(path)) from None
    said = file.model_dump(mode="json", exclude={"weights", "sha256"})
    lines = [HEAD, tomli_w.dumps(said | {"sha256": file.checksum()}), "\n[weights]\n"]
    for name, each in file.weights.items():
        lines.append(tomli_w.dumps({name: 0}).removesuffix("0\n") + "[\n")
        lines += [f"    [{', '.join(map(repr, row))}],\n" for row in each]
        lines.append("]\n")
    write_whole(path, "".join(lines).encode())
