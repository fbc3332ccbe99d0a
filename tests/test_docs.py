"""The documentation: what it shows runs, and it names every setting with its default."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Literal, NamedTuple, get_args, get_origin

import annotated_types
import pytest
from pydantic import BaseModel
from pydantic.fields import FieldInfo

from animat.files.settings import Settings, SettingsError, read_toml
from animat.life.scenario import bring_together
from animat.mind.functions import SIGNATURES
from animat.mind.mind import Behaviour, Drive, Learning, Mind, VariableChange
from animat.mind.physiology import PHYSIOLOGIES, Variable
from animat.robot.khepera import Khepera
from animat.study.execute.run import run, threads
from animat.study.file.design import Exclusion
from animat.study.file.read import read_study
from animat.study.file.sampling import Sample
from animat.study.file.settings import LifeSettings, Teacher, WorldChoice
from animat.study.file.study import Record, Study
from animat.study.plan.plan import Plan, plan_of
from animat.world.files import world_file
from animat.world.world import World

ROOT = Path(__file__).parents[1]
STUDIES = ROOT / "docs" / "studies.md"
RUNNING = ROOT / "docs" / "running.md"
OF_STUDIES = [STUDIES, RUNNING]
"""The pages that show study files, and not settings files."""

PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]

SMALLER = {"steps=300_000": "steps=2_000", "lives=1_000": "lives=4", "lives=100": "lives=4"}
"""How much of what a page shows is run here."""

WORLD_FILE = "the file of a world"
WRITTEN_OUT = "these are the defaults, written out:"


class Block(NamedTuple):
    """Something shown in a page: its language, its text, and the paragraph before it."""

    language: str
    text: str
    before: str


def blocks(page: Path) -> list[Block]:
    found = re.finditer(r"^```(\w*)\n(.*?)^```$", page.read_text("utf-8"), re.DOTALL | re.MULTILINE)
    return [Block(m[1], m[2], m.string[: m.start()].rstrip().rsplit("\n\n", 1)[-1]) for m in found]


def shown(language: str, pages: list[Path]) -> list[Any]:
    return [
        pytest.param(block, id=f"{page.name}-{number}")
        for page in pages
        for number, block in enumerate(blocks(page))
        if block.language == language
    ]


@pytest.fixture
def here(tmp_path, monkeypatch) -> Path:
    """A folder of its own in which the paths of the pages hold."""
    (tmp_path / "docs").symlink_to(ROOT / "docs")
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.parametrize(
    "block", shown("toml", [page for page in PAGES if page not in {STUDIES, RUNNING}])
)
def test_every_file_shown_is_accepted(here, block):
    file = here / "shown.toml"
    file.write_text(block.text)
    if WORLD_FILE in block.text:
        world = World.load(file)
        assert world.n_objects > 0
        world.save(here / "again.toml")
        assert World.load("again.toml") == world
        assert world_file(world.name, world.layout, world.resolution).model_dump_json()
        return
    settings = read_toml(file, LifeSettings)
    bring_together(settings.mind, settings.world.world(), settings.robot)
    if block.before.endswith(WRITTEN_OUT):
        assert settings == LifeSettings()
        assert settings.mind.model_fields_set | settings.robot.model_fields_set


@pytest.mark.parametrize("block", shown("toml", OF_STUDIES))
def test_every_study_shown_is_accepted_or_refused_as_shown(here, block):
    file = Path("wrong.toml")
    file.write_text(block.text)
    if not block.text.startswith(f"# {file}"):
        assert Plan(read_study(file)).lived
        return
    told = next(b.text for b in blocks(STUDIES) if b.text.startswith(f"$ animat check {file}"))
    with pytest.raises(SettingsError) as caught:
        read_study(file)
    lines = [line.removeprefix("animat: ") for line in told.splitlines()[1:]]
    assert list(caught.value.problems) == lines


def test_what_is_said_to_be_written_out_is():
    settings = ROOT / "docs" / "settings.md"
    assert sum(block.before.endswith(WRITTEN_OUT) for block in blocks(settings)) == 2


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_every_program_shown_runs_and_says_what_is_shown(here, capsys, page):
    """The programs of a page share their names, as they would in a notebook.

    One that begins with the name of its file is written there instead, for others to load.
    """
    names: dict[str, Any] = {"__name__": "shown"}
    shown_here = blocks(page)
    if page == RUNNING:
        live_small(shown_here[0].text, here / "results" / "lifespan")
    for number, (language, text, _) in enumerate(shown_here):
        if language != "python":
            continue
        for large, small in SMALLER.items():
            text = text.replace(large, small)  # noqa: PLW2901
        if own := re.match(r"# (\S+\.py)\n", text):
            (here / own[1]).parent.mkdir(exist_ok=True)
            (here / own[1]).write_text(text)
            continue
        file = here / f"shown_{number}.py"
        file.write_text(text)
        capsys.readouterr()
        following = shown_here[number + 1] if number + 1 < len(shown_here) else Block("", "", "")
        answer = following.text if following.language == "text" else None
        try:
            exec(compile(text, file, "exec"), names)
            said = capsys.readouterr().out
        except SettingsError as error:
            if answer is None:
                raise
            said = f"{error}\n"
        assert answer in {None, said.replace(str(here), "/home/you")}


def live_small(text: str, directory: Path) -> None:
    """Live the study that a page is about, so that its programs find results."""
    study = directory.parent.parent / "shown.toml"
    study.write_text(text)
    smaller = ("lives=4", "steps=100", "teacher.robots=2", "teacher.steps=100")
    plan = plan_of(read_study(study, smaller).to_toml())
    with threads(1) as workers:
        assert run(plan, directory, workers, lambda *_, **__: None).complete


def test_the_python_of_the_readme_is_run_small():
    (program, *_) = (block for block in blocks(ROOT / "README.md") if block.language == "python")
    assert "steps=300_000" in program.text
    assert "lives=1_000" in program.text


def test_every_link_leads_somewhere():
    for page in PAGES:
        for target in re.findall(r"\]\(([^)#]+)(?:#[^)]*)?\)", page.read_text("utf-8")):
            if "://" not in target:
                assert (page.parent / target).exists(), f"{page.name}: {target}"


SOURCES = [
    path
    for folder in ("src", "tests", "bench", "browser", "tools")
    for path in sorted((ROOT / folder).rglob("*"))
    if path.suffix in {".py", ".toml", ".j2"}
]


def test_every_page_that_the_code_names_is_there():
    for file in [*SOURCES, *PAGES, ROOT / "Makefile", ROOT / "pyproject.toml"]:
        for name in re.findall(r"(?<![\w/.-])docs/[\w./-]*\w", file.read_text("utf-8")):
            assert (ROOT / name).exists(), f"{file.relative_to(ROOT)}: {name}"


TABLES: dict[str, tuple[type[Settings], type[Settings]]] = {
    "[world]": (WorldChoice, WorldChoice),
    "[robot]": (Khepera, Khepera),
    "[mind]": (Mind, Mind),
    "[mind.variables.NAME]": (VariableChange, Variable),
    "[mind.drives.NAME]": (Drive, Drive),
    "[mind.behaviours.NAME]": (Behaviour, Behaviour),
    "[mind.learning]": (Learning, Learning),
}
"""Under which heading which settings stand, and which model has their defaults."""


STUDY_TABLES: dict[str, type[Settings]] = {
    "## The study": Study,
    "## `[teacher]`": Teacher,
    "## `[record]`": Record,
    "### `[design.sample]`": Sample,
    "### `[[design.exclude]]`": Exclusion,
}
"""The same of a study, which has the settings of a case besides."""


COLUMNS = 4
"""Of a table of settings: name, default, allowed, what it means."""


def rows(heading: str, page: Path = ROOT / "docs" / "settings.md") -> dict[str, list[str]]:
    """The settings in the tables of a section: default, allowed and meaning by name."""
    level = heading.split(maxsplit=1)[0]
    section = page.read_text("utf-8").split(f"\n{heading}\n")[1].split(f"\n{level} ")[0]
    lines = [line for line in section.splitlines() if line.startswith("| `")]
    cells = [[cell.strip() for cell in line.strip("|").split(" | ")] for line in lines]
    return {row[0].strip("`"): row[1:] for row in cells if len(row) == COLUMNS and row[0].islower()}


@pytest.mark.parametrize("heading", TABLES)
def test_every_setting_is_documented_with_its_default(heading):
    model, defaults = TABLES[heading]
    check_documented(rows(f"## `{heading}`"), model, defaults)


@pytest.mark.parametrize("heading", STUDY_TABLES)
def test_every_key_of_a_study_is_documented_with_its_default(heading):
    model = STUDY_TABLES[heading]
    check_documented(rows(heading, STUDIES), model, model, besides=set(LifeSettings.model_fields))


def check_documented(
    documented: dict[str, list[str]],
    model: type[Settings],
    defaults: type[Settings],
    besides: set[str] | None = None,
) -> None:
    """Hold a table against the settings of a model, but for those told elsewhere."""
    elsewhere = besides if besides and besides < set(model.model_fields) else set()
    assert set(documented) == set(model.model_fields) - elsewhere
    for name, (default, allowed, meaning) in documented.items():
        assert default == written(defaults.model_fields[name]), name
        for word in limits(model.model_fields[name]):
            assert re.search(rf"(?<![\w.]){re.escape(word)}(?![\w])", allowed), (name, word)
        assert meaning


def written(field: FieldInfo) -> str:
    """A default as the page has it."""
    if field.is_required():
        return "required"
    default = field.get_default(call_default_factory=True)
    if default is None:
        return "left out"
    if default != {} and isinstance(default, dict | tuple | BaseModel):
        return "below"
    if isinstance(default, bool):
        return f"`{str(default).lower()}`"
    if isinstance(default, str):
        return f'`"{default}"`'
    return f"`{default}`"


def limits(field: FieldInfo) -> Iterator[str]:
    """What the page must say of what is allowed."""
    options = [field.annotation, *get_args(field.annotation)]
    metadata = [*field.metadata, *(m for o in options for m in getattr(o, "__metadata__", ()))]
    for option in options:
        if get_origin(option) is Literal:
            yield from (f'"{choice}"' for choice in get_args(option))
        if option is bool:
            yield from ("true", "false")
    for inner in list(metadata):
        if isinstance(inner, FieldInfo):
            metadata += inner.metadata
    for limit in metadata:
        if isinstance(limit, annotated_types.Ge):
            yield told(limit.ge)
        if isinstance(limit, annotated_types.Gt):
            yield f"above {told(limit.gt)}"
        if isinstance(limit, annotated_types.Le):
            yield told(limit.le)
        if isinstance(limit, annotated_types.Lt):
            yield f"below {told(limit.lt)}"


def told(limit: Any) -> str:
    """A limit as the page has it."""
    if isinstance(limit, int) and limit >= 1 << 20 and limit & (limit - 1) == 0:
        return f"2^{limit.bit_length() - 1}"
    return str(limit) if isinstance(limit, int) else f"{limit:g}"


def test_the_physiologies_are_as_documented():
    text = (ROOT / "docs" / "settings.md").read_text("utf-8")
    for name, variables in PHYSIOLOGIES.items():
        margins = {variable.lethal_margin for variable in variables.values()}
        (margin,) = margins
        laws = " | ".join(f"`{variable.law}`" for variable in variables.values())
        assert f"| `{name}` | {laws} | {f'{margin:g}' if margin else 'none'} |" in text
        assert [v.rate for v in variables.values()] == [1e-4, 1e-4, 1e-3]
        assert [v.set_point for v in variables.values()] == [0.9, 0.2, 0.1]


def test_every_signature_is_documented():
    text = (ROOT / "docs" / "functions.md").read_text("utf-8")
    for role, signature in SIGNATURES.items():
        assert re.search(rf"^\| {role} \| `mind\.\S+` \| `{re.escape(signature)}` \|$", text, re.M)


def test_a_file_of_the_examples_is_accepted(here):
    examples = sorted((ROOT / "docs" / "examples").glob("*.toml"))
    assert examples
    for file in examples:
        assert read_toml(file, LifeSettings).mind.functions()


def test_toml_of_numbers_is_what_it_says():
    """The defaults of the tables can be written into a file as they stand."""
    for heading in TABLES:
        for name, (default, *_) in rows(f"## `{heading}`").items():
            if default.startswith("`"):
                assert name in tomllib.loads(f"{name} = {default.strip('`')}")
