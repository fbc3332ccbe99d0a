"""The files that a study draws on beside its own, put into a page: functions, worlds."""

from __future__ import annotations

import hashlib
from pathlib import Path
from typing import NamedTuple

from animat.study.store.manifest import INPUTS, MANIFEST, WRITTEN_ANEW, read_manifest

LARGEST = 100_000
"""Bytes of the largest file that is put into the page; of a larger one stands its digest only."""


class Inputs(NamedTuple):
    """The files by their paths, each with its digest or what is wrong, and the text of them all."""

    digests: dict[str, str]
    text: str


def inputs_of(directory: Path) -> Inputs:
    """Return every such file of the results in a directory or right below it.

    Raises SettingsError for results that are damaged.
    """
    copies = {
        path: manifest.parent / INPUTS / copy
        for manifest in sorted([*directory.glob(MANIFEST), *directory.glob(f"*/{MANIFEST}")])
        for path, copy in read_manifest(manifest.parent)["inputs"].items()
    }
    digests, texts = {}, []
    for path, copy in copies.items():
        try:
            content = copy.read_bytes()
        except OSError:
            digests[path] = f"{copy.name} is missing; {WRITTEN_ANEW}"
            continue
        digests[path] = f"SHA-256 {hashlib.sha256(content).hexdigest()}"
        text = content.decode(errors="replace")
        if len(content) <= LARGEST and text.encode() == content:
            texts.append(f"# {path}\n\n{text}")
    return Inputs(digests, "\n\n".join(texts))
