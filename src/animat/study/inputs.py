"""The files that a study draws on beside its own, put into a page: functions, worlds."""

from __future__ import annotations

import hashlib
from pathlib import Path

from animat.report.page import Section
from animat.study.store.description import INPUTS, MANIFEST, WRITTEN_ANEW, read_manifest

LARGEST = 100_000
"""Bytes of the largest file that is put into the page; of a larger one stands its digest only."""


def inputs_sections(directory: Path) -> list[Section]:
    """Return a part with every such file of the results in a directory or right below it.

    There is none where a study names no file. Raises SettingsError for results that are torn.
    """
    copies = {
        path: manifest.parent / INPUTS / copy
        for manifest in sorted([*directory.glob(MANIFEST), *directory.glob(f"*/{MANIFEST}")])
        for path, copy in read_manifest(manifest.parent)["inputs"].items()
    }
    if not copies:
        return []
    terms, texts = {}, []
    for path, copy in copies.items():
        try:
            content = copy.read_bytes()
        except OSError:
            terms[path] = f"{copy.name} is missing; {WRITTEN_ANEW}"
            continue
        terms[path] = f"SHA-256 {hashlib.sha256(content).hexdigest()}"
        text = content.decode(errors="replace")
        if len(content) <= LARGEST and text.encode() == content:
            texts.append(f"# {path}\n\n{text}")
    told = "The study names these files; the same lives need them as they were."
    return [Section("The files it draws on", [told], terms=terms, code="\n\n".join(texts))]
