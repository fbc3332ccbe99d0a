"""`animat schema`."""

from __future__ import annotations

from animat.cli.app import app
from animat.cli.options import Debug


@app.command()
def schema(debug: Debug = False) -> None:
    """Print the JSON schema of a study file, for an editor to complete and check it."""
    import json

    from animat.study.file.schema import study_schema

    print(json.dumps(study_schema(), indent=2))
