"""README.md of a robot's data sets in the hub's format: one configuration an action, whose parts `datasets` loads."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from huggingface_hub import DatasetCardData

Manifest = Mapping[str, Any]
COLUMNS = (  # beside the arguments; as tailor.models.episodes.episodes writes them
    ("episode", "", "number of the episode"),
    ("tick", "", "number of the 10 Hz tick in the episode"),
    ("work_j", "J", "work of the drives until the next tick; NaN: not recorded"),
    ("duration_s", "s", "duration of the whole episode"),
    ("success", "", "whether the action achieved its effect"),
    ("finished", "", "whether its controller finished"),
    ("failure", "", "kind of failure, or empty"),
    ("in_context", "", "whether it was decided, or gathered, beside objects of the action's context"),
)
SIZES = (("n<1K", 10**3), ("1K<n<10K", 10**4), ("10K<n<100K", 10**5), ("100K<n<1M", 10**6), ("1M<n<10M", 10**7))


def data_card(robot: str, manifests: Mapping[str, Manifest], rows: int, licence: str) -> str:
    """The text of README.md.

    Args:
      robot: Name of the robot.
      manifests: Manifest of each data set, by folder.
      rows: Number of rows of all parts.
      licence: SPDX id in lower case.
    """
    configurations = [
        {"config_name": folder, "data_files": [{"split": "train", "path": f"{folder}/part-*.parquet"}]}
        for folder in manifests
    ]
    data = DatasetCardData(
        license=licence,
        tags=["robotics", "tailor", robot],
        task_categories=["robotics", "tabular-regression"],
        pretty_name=f"Episodes of {robot}'s actions",
        size_categories=[next((name for name, limit in SIZES if rows < limit), "n>10M")],
        configs=configurations,
    )
    return f"---\n{data.to_yaml()}\n---\n\n" + "\n".join(_text(robot, manifests)) + "\n"


def _text(robot: str, manifests: Mapping[str, Manifest]) -> Iterator[str]:
    first = next(iter(manifests))
    yield f"# Episodes of {robot}'s actions"
    yield ""
    yield "Runs of single actions, one row a tick of 10 Hz, from which action models are learned."
    yield ""
    yield "```python"
    yield f'datasets.load_dataset("USER/NAME", "{first}")      # or: tailor models pull --data DIR --from USER/NAME'
    yield "```"
    for folder, manifest in manifests.items():
        yield from ("", f"## {folder}", "", f"Action {manifest['action']}. {_source(manifest)}", "")
        yield from ("| column | unit | meaning |", "|---|---|---|")
        yield from (f"| {name} | {unit} | {meaning} |" for name, unit, meaning in _columns(manifest["arguments"]))


def _source(manifest: Manifest) -> str:
    """What the manifest states of how the episodes came about."""
    known = [f"{key} {manifest[key]}" for key in ("source", "seed", "episodes") if key in manifest]
    return ("; ".join(known) or "No provenance is recorded").capitalize() + "."


def _columns(arguments: Sequence[Mapping[str, Any]]) -> Iterator[tuple[str, str, str]]:
    for argument in arguments:
        yield argument["name"], argument["unit"], "believed now; at the goal: as requested"
    for argument in arguments:
        yield f"asked_{argument['name']}", argument["unit"], "as requested at the start"
    yield from COLUMNS
