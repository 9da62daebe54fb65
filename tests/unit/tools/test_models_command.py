"""tailor models, train and evaluate: what they say, and that they refuse in one line."""

import json
import shutil
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from tailor.models import runtime
from tailor.models.features.planar import projective
from tailor.models.fitted_trees.linear_tree import LinearTree
from tailor.models.rules.rule_text import duration_rules
from tailor.models.training.learners import DURATION_LEARNERS, SUCCESS_LEARNERS, learner_name
from tailor.tools.commands.learn import train
from tailor.tools.learning.model_folders import target_zoo
from tailor.tools.learning.recipe_file import read_recipe, recipe_path
from tailor.tools.learning.training_request import DEFAULT_FAILURE_LEARNER, DEFAULT_LEARNER
from tailor.tools.main import main
from tests.support.robots.known_robot import known_robot


def tree() -> LinearTree:
    """Two leaves: near, and far with a slope in distance and angle."""
    nodes = [(2, 1.5, 1, 2, -1), (-1, 0.0, 0, 0, 0), (-1, 0.0, 0, 0, 1)]
    near = (np.zeros(5), 2.0, 1.0, 3.0, 0.1, 10)
    far = (np.array([0, -0.5, 1.6, 0.573, 0]), 0.4, 2.0, 12.0, 0.25, 90)
    return LinearTree.of(nodes, [near, far])


def test_rules_read_like_the_paper_s_with_units_and_degrees() -> None:
    assert duration_rules(tree(), projective.features) == [
        "if dist <= 1.50 m\nthen time = 2 s   [1.0 .. 3.0 s, ± 0.10 s]",
        "if dist > 1.50 m\nthen time = 0.4 s - 0.5 s/(m/s) · v_g + 1.6 s/m · dist + 0.01 s/° · angle_to"
        "   [2.0 .. 12.0 s, ± 0.25 s]",
    ]


def test_every_model_that_ships_is_sound(capsys: pytest.CaptureFixture[str]) -> None:
    code = main(["models", "check", "--json"])
    message = json.loads(capsys.readouterr().out)
    assert code == bool(message["stale"])  # test_staleness.py judges whether they are
    assert "agilo/goToPose/duration" in message["checked"]
    assert message["failed"] == {}


def test_a_model_that_is_not_sound_is_told_and_fails_the_check(tmp_path: Path, capsys) -> None:
    folder = tmp_path / "agilo" / "goToPose"
    folder.mkdir(parents=True)
    for name in ("duration.onnx", "duration.card.json"):
        (folder / name).write_bytes((runtime.ZOO / "agilo" / "goToPose" / name).read_bytes() + b" ")
    assert main(["models", "check", "--zoo", str(tmp_path)]) == 1
    assert "sha256" in capsys.readouterr().out


@pytest.mark.parametrize("named", [[], ["agilo"]])
def test_a_model_without_which_no_executive_starts_is_told_as_missing(named, tmp_path: Path, capsys) -> None:
    zoo = tmp_path / "zoo"
    shutil.copytree(runtime.ZOO / "agilo", zoo / "agilo")
    shutil.rmtree(zoo / "agilo" / "approachBall")
    assert main(["models", "check", *named, "--zoo", str(zoo)]) == 1
    out = capsys.readouterr().out
    assert "agilo/approachBall/duration: " in out
    assert "agilo/approachBall/success: " in out
    assert main(["models", "check", "agilo/goToPose", "--zoo", str(zoo), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["checked"] == ["agilo/goToPose/duration"]


def test_list_and_show_are_readable_by_scripts(capsys) -> None:
    assert main(["models", "list", "--json"]) == 0
    assert {"model", "learner", "episodes", "test"} <= json.loads(capsys.readouterr().out)[0].keys()
    assert main(["models", "show", "agilo/goToPose", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["kind"] == "duration"
    assert main(["models", "show", "agilo", "--json"]) == 0
    kinds = {card["kind"] for card in json.loads(capsys.readouterr().out)}
    assert {"duration", "clearance"} <= kinds


def test_models_of_other_packages_are_listed_and_checked_with_those_that_ship(tmp_path: Path, capsys) -> None:
    """Who had trained a robot of his own did not find it in the list, and could not name it beside one of ours."""
    with known_robot("cart", "wheeled", tmp_path) as folder, known_robot("tram", "wheeled", tmp_path):
        place = folder / "cart" / "models" / "cart" / "drive"
        shutil.copytree(runtime.ZOO / "agilo" / "goToPose", place)
        for card in place.glob("*.json"):
            changed(card, robot="cart", action="drive")
        assert main(["models", "list", "--json"]) == 1  # a card of another model: it is found, and read
        printed = capsys.readouterr()
        assert "agilo/goToPose/duration" in {row["model"] for row in json.loads(printed.out)}  # hindered by none of it
        assert f"cart/drive/duration: {place}/duration" in printed.err
        assert main(["models", "list", "cart"]) == 2
        assert f"{place}" in capsys.readouterr().err
        assert main(["models", "check", "--json"]) == 1
        found = json.loads(capsys.readouterr().out)
        assert {"agilo/goToPose/duration", "cart/drive/duration"} <= set(found["checked"])
        assert {name.partition("/")[0] for name in found["failed"]} == {"cart"}  # and not the tram, which has none yet
        assert main(["models", "check", "agilo/goToPose", "cart", "--json"]) == 1
        assert {"agilo/goToPose/duration", "cart/drive/duration"} <= set(json.loads(capsys.readouterr().out)["checked"])
        assert main(["models", "check", "tram"]) == 2
        assert "tram" in capsys.readouterr().err


def test_the_models_of_a_package_that_cannot_be_loaded_are_not_said_to_be_missing(tmp_path: Path, capsys) -> None:
    with known_robot("cart", "wheeled", tmp_path) as folder:
        (folder / "cart" / "__init__.py").write_text("import nosuchmodule\n")
        assert main(["models", "list", "cart"]) == 2
        assert "cart:SPEC: cannot be loaded: ModuleNotFoundError" in capsys.readouterr().err
        assert main(["models", "list", "soccer"]) == 2
        assert "(agilo is the robot of soccer)" in capsys.readouterr().err


def copied(tmp_path: Path, action: str = "goToPose", place: str = "agilo/goToPose") -> Path:
    """A zoo with the shipped models of one action of AGILO, perhaps in another one's place; their folder."""
    return Path(shutil.copytree(runtime.ZOO / "agilo" / action, tmp_path / place))


def changed(card: Path, **entries: object) -> None:
    card.write_text(json.dumps({**json.loads(card.read_text()), **entries}))


@pytest.mark.parametrize("verb", ["check", "list", "show", "rules", "plot"])
def test_a_model_in_the_place_of_another_one_is_no_sound_model(tmp_path: Path, verb: str, capsys) -> None:
    copied(tmp_path, "dribbleBall", "agilo/approachBall")
    assert main(["models", verb, "agilo/approachBall", "--zoo", str(tmp_path)]) == (1 if verb == "check" else 2)
    output = "".join(capsys.readouterr())
    assert "holds a model of agilo/dribbleBall/duration, expected agilo/approachBall/duration by its place" in output


def test_a_check_finds_durations_beside_objects_that_are_of_other_episodes(tmp_path: Path, capsys) -> None:
    """The executive refuses to start with them."""
    folder = copied(tmp_path)
    assert main(["models", "check", "agilo/goToPose/duration_beside", "--zoo", str(tmp_path)]) in (0, 1)
    assert "learned from other episodes" not in capsys.readouterr().out
    card = folder / "duration_beside.card.json"
    changed(card, episodes={**json.loads(card.read_text())["episodes"], "sha256": "0" * 64})
    assert main(["models", "check", "agilo/goToPose/duration_beside", "--zoo", str(tmp_path)]) == 1
    assert "learned from other episodes than agilo/goToPose/duration, expected the same" in capsys.readouterr().out


def test_what_a_card_holds_reaches_no_terminal_unescaped(tmp_path: Path, capsys) -> None:
    changed(copied(tmp_path) / "duration.card.json", command="\ud800 \x1b[31m", **{"\x1b[32m": 5})
    assert main(["models", "show", "agilo/goToPose", "--zoo", str(tmp_path)]) == 0
    output = capsys.readouterr().out
    assert "command: \\ud800 \\x1b[31m" in output
    assert "\x1b" not in output


def test_what_is_no_number_of_json_is_null(tmp_path: Path, capsys) -> None:
    """Python writes and reads NaN, and no other parser does."""
    changed(copied(tmp_path) / "duration.card.json", note=[float("nan"), float("inf"), 1.5])
    assert main(["models", "show", "agilo/goToPose", "--zoo", str(tmp_path), "--json"]) == 0
    card = json.loads(capsys.readouterr().out, parse_constant=pytest.fail)
    assert card["note"] == [None, None, 1.5]


def test_hidden_files_beside_models_are_none(tmp_path: Path, capsys) -> None:
    (copied(tmp_path) / "._duration.onnx").touch()
    assert main(["models", "list", "--zoo", str(tmp_path), "--json"]) == 0
    assert all(row["model"].startswith("agilo/goToPose/") for row in json.loads(capsys.readouterr().out))


def test_the_figures_of_a_card_come_first_and_its_provenance_last(capsys) -> None:
    assert main(["models", "show", "agilo/goToPose"]) == 0
    lines = capsys.readouterr().out.splitlines()
    starts = [line.split(":")[0] for line in lines if line.split(":")[0] in ("test", "episodes", "features", "sha256")]
    assert starts == ["test", "episodes", "features", "sha256"]
    assert "mae_s" in "".join(lines[:4])
    last = next(number for number, line in enumerate(lines) if line.startswith("provenance: "))
    assert not any("executive/actions" in line for line in lines[:last])
    assert any("executive/actions" in line for line in lines[last:])


def test_a_card_with_a_deep_entry_is_shown_in_part(tmp_path: Path, capsys) -> None:
    folder = shutil.copytree(runtime.ZOO / "agilo" / "goToPose", tmp_path / "agilo" / "goToPose")
    card = folder / "duration.card.json"
    card.write_text(card.read_text().replace("{", '{"deep": ' + "[" * 600 + "]" * 600 + ",", 1))
    assert main(["models", "show", "agilo/goToPose", "--zoo", str(tmp_path)]) == 0
    assert "deep: [[[[[[[[[[...]]]]]]]]]]" in capsys.readouterr().out


def test_a_robot_s_name_stands_for_all_its_models(capsys) -> None:
    assert main(["models", "list", "powercube", "--json"]) == 0
    message = [row["model"] for row in json.loads(capsys.readouterr().out)]
    assert "powercube/reach/duration" in message
    assert all(name.startswith("powercube/") for name in message)
    assert main(["models", "list", "r2d2"]) == 2
    assert "'r2d2' has no models" in capsys.readouterr().err


def test_tables_in_a_pipe_tell_names_whole(capsys) -> None:
    assert main(["models", "list"]) == 0
    assert "agilo/approachBall/duration" in capsys.readouterr().out


def test_rules_of_a_shipped_model_say_how_far_they_are_off(capsys) -> None:
    assert main(["models", "rules", "agilo/goToPose"]) == 0
    first, _, rule, *_ = capsys.readouterr().out.splitlines()
    assert "rules of a tree distilled from it, which differ from the model by" in first
    assert "R² 0.9" in first
    assert rule.startswith("if ")


@pytest.mark.parametrize("name", ["b21/reach", "agilo/approachBall/success"])
def test_rules_of_any_single_tree_can_be_asked_for(name: str, capsys) -> None:
    assert main(["models", "rules", name, "--of", "bag:3"]) == 0
    first, _, rule, then, *_ = capsys.readouterr().out.splitlines()
    assert "rules of its tree 3, which differ from the model by" in first
    assert rule.startswith("if ")
    assert then.startswith(("then time =", "then success in"))
    assert main(["models", "rules", name, "--of", "bag:99"]) == 2
    assert "there is no tree 99" in capsys.readouterr().err


@pytest.mark.parametrize("tree", ["3x", "0", "tree:3", "bag:1:2", "bag:٣", "9" * 5000])
def test_what_names_no_tree_is_refused_in_one_line(tree: str, capsys) -> None:
    assert main(["models", "rules", "b21/reach", "--of", tree]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line.endswith("expected the number of a tree, from 1, as in bag:3 or forest:3")


def test_a_seed_that_no_learner_takes_is_refused_before_training(tmp_path: Path, capsys) -> None:
    """Scikit-learn takes 32 bits: it refused the seed of boosted trees in the midst of the training."""
    assert main(["train", "agilo", "--data", str(tmp_path), "--zoo", str(tmp_path), "--seed", str(2**32)]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line == "tailor train: --seed is 4294967296, expected 0 to 1000000000"


def test_gather_and_train_make_a_model_whose_card_says_how(tmp_path: Path, monkeypatch, capsys) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["gather", "agilo", "goToPose", "--episodes", "48", "--jobs", "1", "--json"]) == 0
    settings = ["--learner", "linear", "--failure-learner", "tree", "--zoo", "zoo"]
    assert main(["train", "agilo", "--data", "data/agilo", *settings, "--json"]) == 0
    model = runtime.load_model("agilo/goToPose/duration", Path("zoo"))
    assert model.card["command"].startswith("tailor gather agilo goToPose --episodes 48 --seed 7 --out data/agilo && ")
    assert " tailor train agilo goToPose --data data/agilo --features projective " in model.card["command"]


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["models", "show", "agilo/fly"], "no such file"),
        (["models", "list", "--zoo", "nowhere"], "no action models"),
        (["models", "rules", "agilo/goToPose", "--json"], "rules takes no --json"),
        (["models", "list", "--data", "x", "--of", "bag:1"], "list takes no --data, --of"),
        (["models", "check", "--distilled", "--out", "x"], "check takes no --distilled, --out"),
        (
            ["models", "plot", "agilo/goToPose", "--data", "nowhere"],
            "nowhere: no data sets of these models, expected go",
        ),
        (
            ["models", "rules", "agilo/goToPose", "--data", "nowhere"],
            "expected goToPose/manifest.json (`tailor gather`",
        ),
        (["train", "agilo", "--data", "nowhere"], "no data sets"),
        (["train", "agilo", "--failure-learner", "magic"], "learner 'magic' is unknown for success"),
        (["train", "agilo", "--energy-features", "magic"], "no feature space 'magic'"),
        (["train", "agilo", "--seed", "-1"], "--seed is -1, expected at least 0"),
        (
            ["gather", "agilo", "goToPose", "--episodes", "1", "--out", "/dev/null"],
            "/dev/null/goToPose: Not a directory",
        ),
        (["evaluate", "table1", "--episodes", "0"], "--episodes is 0, expected at least 6"),
        (["evaluate", "table3", "--jobs", "0"], "--jobs is 0, expected at least 1, or -1 for every core"),
        (["evaluate", "energy", "--weights", "nan", "1"], "--weights is 'nan', expected a number, at least 0"),
        (["evaluate", "feature-spaces", "--action", "fly"], "no action 'fly' in soccer"),
        (
            ["evaluate", "feature-spaces", "--robot", "powercube"],
            "no action 'goToPose' in arm (expected one",
        ),
        (["evaluate", "table9"], "evaluation 'table9' is unknown"),
        (["evaluate"], "no evaluation named"),
        (["evaluate", "models", "--domain", "r2d2"], "no domain 'r2d2'"),
        (["evaluate", "models", "--domain", "soccer", "--runs", "5"], "--runs counts those of --on-policy, expected"),
        (["evaluate", "refinement"], "no domain named, expected --domain NAME"),
        (["evaluate", "refinement", "--domain", "soccer", "--seed", "x"], "--seed is 'x', expected a whole number"),
        (["gather", "agilo", "--from", "nowhere.mcap"], "nowhere.mcap"),
        (["gather", "agilo", "--on-policy", "chess"], "no scenario 'chess'"),
    ],
)
def test_bad_input_is_one_line_and_exit_code_2(words: list[str], message: str, capsys, tmp_path, monkeypatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(words) == 2
    error = capsys.readouterr().err
    assert message in error
    assert error.count("\n") == 1


def test_training_never_writes_into_an_installation(monkeypatch, tmp_path: Path, capsys) -> None:
    installed = tmp_path / "site-packages" / "tailor" / "models" / "zoo"
    (installed / "agilo").mkdir(parents=True)
    monkeypatch.setattr(train, "target_zoo", partial(target_zoo, own=installed))
    assert main(["train", "agilo"]) == 2
    error = capsys.readouterr().err
    assert "expected --zoo DIR" in error
    assert error.count("\n") == 1
    assert list(installed.rglob("*")) == [installed / "agilo"]


def test_training_writes_to_the_zoo_of_a_checkout_or_to_the_one_named(tmp_path: Path) -> None:
    own = tmp_path / "models" / "zoo"
    own.mkdir(parents=True)
    (tmp_path / "pyproject.toml").touch()
    assert target_zoo(None, "agilo", own) == own
    assert target_zoo(None, "agilo") == runtime.ZOO
    assert target_zoo(Path("other"), "agilo", own) == Path("other")


def test_training_ends_with_the_folder_of_its_models(tmp_path: Path, monkeypatch, capsys) -> None:
    monkeypatch.setattr(train, "train_models", lambda request, on_action: [])
    assert main(["train", "agilo", "--zoo", str(tmp_path)]) == 0
    assert capsys.readouterr().out.splitlines()[-1] == f"models in {tmp_path / 'agilo'}"


@pytest.mark.parametrize(("flags", "progress"), [([], ["training goToPose: 0 of 1"]), (["--json"], [])])
def test_training_that_prints_json_shows_no_progress(flags, progress, tmp_path: Path, monkeypatch, capsys) -> None:
    """As `gather --json`: a script that reads an error from standard error found another line before it."""
    monkeypatch.setattr(train, "train_models", lambda request, on_action: [on_action("goToPose", 0, 1)][:0])
    assert main(["train", "agilo", "--zoo", str(tmp_path), *flags]) == 0
    assert capsys.readouterr().err.splitlines() == progress


@pytest.mark.parametrize("layout", ["courier_robot", "src/courier_robot"])
def test_training_makes_the_folder_of_models_in_the_checkout_of_a_robots_package(
    tmp_path: Path, layout: str, monkeypatch
) -> None:
    own = tmp_path / layout / "models"
    own.parent.mkdir(parents=True)
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path / "share"))
    assert target_zoo(None, "pedelec", own) == tmp_path / "share" / "tailor" / "models"
    (tmp_path / "pyproject.toml").touch()
    assert target_zoo(None, "pedelec", own) == own


def test_help_names_all_learners_and_no_others() -> None:
    assert sorted(train.DURATION_LEARNERS.split(", ")) == sorted(DURATION_LEARNERS)
    assert sorted(train.SUCCESS_LEARNERS.split(", ")) == sorted(SUCCESS_LEARNERS)


CARDS = sorted(path for path in runtime.ZOO.glob("*/*/*.card.json") if path.parent.name != "refinement")


@pytest.mark.parametrize("card", CARDS, ids=lambda card: "/".join(card.parts[-3:]))
def test_the_command_in_a_card_names_a_recipe_with_learners_that_exist(card: Path) -> None:
    made = json.loads(card.read_text())
    training = read_recipe(recipe_path(made["robot"])).training
    assert made["command"].startswith(("tailor make-models", "tailor gather"))
    assert learner_name("duration", training.learner or DEFAULT_LEARNER) in DURATION_LEARNERS
    assert learner_name("success", training.failure_learner or DEFAULT_FAILURE_LEARNER) in SUCCESS_LEARNERS


def test_table_1_is_of_durations_not_of_energies(monkeypatch, tmp_path, capsys) -> None:
    """Both predict an amount, and both are loaded together."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(
        "tailor.tools.evaluations.models.floors.noise_floor",
        lambda robot, action, tasks, seed, jobs: (np.full(len(tasks), 0.05), np.ones(len(tasks))),
    )  # takes half a minute
    main(["evaluate", "table1", "--episodes", "12", "--jobs", "1", "--json"])
    rows = json.loads(capsys.readouterr().out)["rows"]
    assert sorted(row["action"] for row in rows) == ["approachBall", "dribbleBall", "goToPose"]
    assert all(row["relative_pct"] < 25 for row in rows)
    promised = {"domain", "action", "episodes", "mean_duration_s", "mae_s", "mae_ci95", "noise_floor_s", "coverage_pct"}
    assert all(promised <= row.keys() for row in rows)
    assert all(row["over_floor"] == pytest.approx(row["mae_s"] / 0.05) for row in rows)
    assert [row["paper_mae_s"] for row in rows if row["action"] == "goToPose"] == [0.22]
    assert [row["action"] for row in rows if "missed_failures_pct" in row] == ["approachBall"]
