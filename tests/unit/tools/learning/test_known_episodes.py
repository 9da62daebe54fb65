"""Episodes to compare a model with: of its own robot, action and arguments, or none."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tailor.models.episodes.episodes import UNOBSERVED, Episode, write_part
from tailor.models.episodes.manifest import write_manifest
from tailor.models.runtime import load_model
from tailor.tools.learning.known_episodes import known_episodes
from tailor.tools.main import main
from tests.support import standin

NAMES = ("x", "y", "phi", "v", "xg", "yg", "phig", "vg")
OBJECT = ("obstacle_x", "obstacle_y", "obstacle_r")


def written(root: Path, objects: int = 0, beside: bool = False, failure: str = "", count: int = 12, **entries) -> Path:
    """A data set of goToPose below `root`; beside an object every second episode fails by it."""
    names = NAMES + OBJECT if beside else NAMES
    width = len(names)
    rows = [np.pad(ticks, ((0, 0), (0, width - 8))) for ticks, *_ in standin.episodes(count, 1)]
    made = [Episode(k, t[0], t, 5.0, True, failure) for k, t in enumerate(rows)]
    if beside:
        made = [replace(e, success=False, failure="touched opponent") if e.number % 2 else e for e in made]
    folder = root / str(entries.get("folder", "goToPose"))
    folder.mkdir(parents=True)
    write_part(folder / "part-000000-000012.parquet", made, names)
    about = {
        "robot": "agilo",
        "action": "goToPose",
        "arguments": [{"name": name, "unit": "", "lower": -4, "upper": 4} for name in names],
        **({"context": {"names": list(OBJECT), "failure": "touched opponent"}} if beside else {}),
        **({"objects": objects} if objects else {}),
    }
    write_manifest(folder, {**about, **entries})
    return root


@pytest.mark.parametrize(
    ("kind", "written_as", "count"),
    [
        ("duration", {}, 12),
        ("duration", {"count": 0}, 0),
        ("duration", {"beside": True}, 6),
        ("duration", {"beside": True, "objects": 4}, 0),
        ("clearance", {}, 0),
        ("clearance", {"beside": True}, 12),
        ("clearance", {"beside": True, "objects": 4}, 12),
    ],
)
def test_a_model_is_compared_with_episodes_of_its_own_arguments(tmp_path: Path, kind, written_as, count) -> None:
    card = load_model(f"agilo/goToPose/{kind}").card
    episodes = known_episodes(card, written(tmp_path, **written_as))
    assert len(episodes) == count
    assert all(episode.ticks.shape[1] == len(card["arguments"]) for episode in episodes)


@pytest.mark.parametrize("verb", ["rules", "plot"])
@pytest.mark.parametrize(
    ("entries", "message"),
    [
        ({"robot": "b21"}, "goToPose: episodes of robot 'b21', expected 'agilo'"),
        ({"action": "approachBall"}, "goToPose: episodes of action 'approachBall', expected 'goToPose'"),
        (
            {"arguments": [{"name": n, "unit": "", "lower": -4, "upper": 4} for n in NAMES[:7]]},
            "goToPose: arguments are x y phi v xg yg phig, expected x y phi v xg yg phig vg by the model",
        ),
    ],
)
def test_episodes_of_something_else_are_refused_in_one_line(tmp_path: Path, verb, entries, message, capsys) -> None:
    data, out = str(written(tmp_path / "data", **entries)), ["--out", str(tmp_path)] if verb == "plot" else []
    assert main(["models", verb, "agilo/goToPose", "--data", data, *out]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line.endswith(message)


@pytest.mark.parametrize(
    ("model", "written_as", "pictures"),
    [
        ("agilo/goToPose/clearance", {}, []),
        ("agilo/goToPose/clearance", {"beside": True}, ["reliability"]),
        ("b21/goToPose/clearance", None, []),
        (
            "agilo/approachBall/success",
            {"action": "approachBall", "folder": "approachBall"},
            ["figure8", "reliability"],
        ),
        (
            "agilo/approachBall/success",
            {"action": "approachBall", "folder": "approachBall", "failure": UNOBSERVED},
            ["figure8"],
        ),
    ],
)
def test_only_pictures_that_a_model_and_its_episodes_allow_are_drawn(
    tmp_path: Path, monkeypatch, model: str, written_as, pictures, capsys
) -> None:
    monkeypatch.chdir(tmp_path)
    data = [] if written_as is None else ["--data", str(written(tmp_path / "mine", **written_as))]
    assert main(["models", "plot", model, *data, "--out", "out"]) == 0
    lines = capsys.readouterr().out.splitlines()
    expected = [f"out/{model.replace('/', '-')}-{name}.png" for name in pictures]
    assert lines == (expected or [f"{model}: no picture without its episodes"])
