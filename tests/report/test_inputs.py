"""The files that a study names stand in its page, as they were."""

import hashlib
import json

from animat.report.inputs import LARGEST, inputs_of

MANIFEST = {
    "study": "s", "hash": "0", "engine": 1, "steps_to_learn": 0,
    "teachers": {"in_a_part": 1, "places": []}, "lives": {"in_a_part": 1, "places": [[1, 1]]},
    "runs": [{"made": "", "command": "", "versions": {}, "machine": {}}],
}  # fmt: skip


def results(directory, **copies):
    """A results directory that has copies of some files, by their names."""
    (directory / "inputs").mkdir(parents=True)
    inputs = {}
    for name, content in copies.items():
        inputs[f"mine/{name}.py"] = f"0-{name}.py"
        if content is not None:
            (directory / "inputs" / f"0-{name}.py").write_bytes(content)
    (directory / "manifest.json").write_text(json.dumps({**MANIFEST, "inputs": inputs}))


def test_each_file_is_told_with_its_digest_and_its_text(tmp_path):
    law = b"def law(value, low, high, rate, factor):\n    return value <= high\n"
    results(tmp_path / "experiment1", law=law)
    results(tmp_path / "experiment2", bytes=b"\xff\xfe", large=b"#" * (LARGEST + 1), gone=None)
    files = inputs_of(tmp_path)
    assert files.digests["mine/law.py"] == f"SHA-256 {hashlib.sha256(law).hexdigest()}"
    assert files.digests["mine/bytes.py"].startswith("SHA-256 ")
    assert files.digests["mine/large.py"].startswith("SHA-256 ")
    assert "missing" in files.digests["mine/gone.py"]
    assert files.text == "# mine/law.py\n\n" + law.decode()


def test_a_study_that_names_no_file_has_no_such_part(tmp_path):
    results(tmp_path)
    assert inputs_of(tmp_path) == ({}, "")
