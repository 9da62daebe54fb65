"""Making models from recipes: from seeds, resumable, and the same bits again."""

import json
from dataclasses import replace
from pathlib import Path

import pytest

from tailor.models.cards.card import card_path, read_card
from tailor.models.episodes.manifest import read_manifest
from tailor.models.episodes.sources import source_of
from tailor.models.export.zoo_writer import replace_model
from tailor.models.runtime import ZOO
from tailor.schemas.errors import UsageError
from tailor.schemas.installed import robot_names
from tailor.tools.learning.gathering import choosing_models, manifests, policy_runs, random_episodes
from tailor.tools.learning.making import episodes, installing, steps, training
from tailor.tools.learning.making import making as making_module
from tailor.tools.learning.making.installing import install
from tailor.tools.learning.making.making import Making
from tailor.tools.learning.making.steps import check, make
from tailor.tools.learning.recipe import (
    Calibration,
    OwnLearner,
    RandomEpisodes,
    Recipe,
    Round,
    Training,
    UncertainEpisodes,
)
from tailor.tools.learning.recipe_file import read_recipe, recipe_path
from tailor.tools.learning.training_request import TrainingRequest
from tailor.tools.main import main

TINY = Recipe(40, beside=20, rounds=(Round("on-policy", ("approach",), 1),))


@pytest.fixture
def trained(monkeypatch) -> list:
    """Requests of training, which writes a card and no model."""
    requests = []

    def train(making, request) -> list:
        requests.append(request)
        folder = request.zoo / request.robot / "goToPose"
        folder.mkdir(parents=True)
        (folder / "duration.card.json").write_text(f"of {len(request.data)}")
        return []

    monkeypatch.setattr(training, "_train", train)
    monkeypatch.setattr(steps, "check_complete", lambda _: None)
    monkeypatch.setattr(choosing_models, "complete_hash", lambda *_: "models")
    monkeypatch.setattr(manifests, "RANGE_DRAWS", 64)
    monkeypatch.setattr(policy_runs, "_run", lambda *_: [])
    monkeypatch.setattr(random_episodes, "gather", lambda spec, parts, _: ((20, 1.0, 1.0) for _ in parts))
    return requests


def test_each_round_follows_the_models_of_all_episodes_before(tmp_path: Path, trained: list) -> None:
    making = Making("agilo", TINY, tmp_path, 1, "make")
    steps = list(make(making))
    assert [(r.zoo.name, [d.name.split("-")[0] for d in r.data]) for r in trained] == [
        ("zoo-0", ["random", "random"]), ("zoo", ["random", "round", "random"])
    ]  # fmt: skip
    assert all(request.command == "make" for request in trained)
    assert {step.title: (step.done, step.total) for step in steps}["round 1: runs of approach"] == (1, 1)


def test_models_of_random_episodes_choose_those_of_uncertain_success(
    tmp_path: Path, trained: list, monkeypatch
) -> None:
    chosen = []
    monkeypatch.setattr(episodes, "run_uncertain", lambda sets, jobs: iter(chosen.extend(sets) or ()))
    recipe = replace(TINY, beside=20, uncertain=(UncertainEpisodes("approachBall", 4, 5),))
    list(make(Making("agilo", recipe, tmp_path, 1, "make")))
    (each,) = chosen
    assert (each.action, each.episodes, each.candidates, each.seed) == ("approachBall", 4, 20, 7)
    assert (each.folder.parent.name, Path(each.zoo).name) == ("uncertain", "zoo-uncertain")
    assert [(r.zoo.name, r.kinds == ("success",)) for r in trained] == [
        ("zoo-uncertain", True), ("zoo-0", False), ("zoo", False)
    ]  # fmt: skip
    assert Making("agilo", recipe, tmp_path, 1, "make").drawn[1:] == [each.folder.parent]


def test_a_round_may_be_of_greedy_choices(tmp_path: Path, trained: list, monkeypatch) -> None:
    horizons: list[int] = []
    monkeypatch.setattr(policy_runs, "_run", lambda policy, *_: horizons.append(policy.refinement.horizon) or [])
    greedy = replace(TINY.rounds[0], horizon=1)
    list(make(Making("agilo", replace(TINY, rounds=(greedy, *TINY.rounds)), tmp_path, 1, "make")))
    assert horizons == [1, 2]
    manifests = [read_manifest(folder / "goToPose") for folder in trained[-1].data[1:3]]
    assert [(each["source"], each.get("horizon")) for each in manifests] == [
        ("lock-step, greedy choices", 1), ("lock-step, refined choices", None)
    ]  # fmt: skip
    assert [source_of(each, 0, "").get("horizon") for each in manifests] == [1, None]


def test_finished_models_choose_what_corrects_their_intervals(tmp_path: Path, trained: list) -> None:
    recipe = replace(TINY, calibration=(Calibration(("approach",), 2), Calibration(("waypoints", "opponents"), 3)))
    steps = {step.title: step.total for step in make(Making("agilo", recipe, tmp_path, 1, "make"))}
    assert [(r.zoo.name, [d.name.split("-")[0] for d in r.data]) for r in trained[1:]] == [
        ("zoo-1", ["random", "round", "random"]),
        ("zoo", ["random", "round", "calibration", "calibration", "random"]),
    ]
    assert [steps[f"calibration {k}: runs of {of}"] for k, of in ((1, "approach"), (2, "waypoints, opponents"))] == [
        2,
        6,
    ]
    manifests = [read_manifest(folder / "goToPose") for folder in trained[-1].data[:4]]
    assert [(each["seed"], each.get("calibrates", False)) for each in manifests] == [
        (7, False), (7, False), (8, True), (9, True)
    ]  # fmt: skip


def test_each_model_is_trained_by_a_request_of_its_own(tmp_path: Path, monkeypatch) -> None:
    """So several processes can train, and no model depends on the others."""
    for action in ("goToPose", "reach"):
        (tmp_path / action).mkdir()
        (tmp_path / action / "manifest.json").touch()
    requests: list[TrainingRequest] = []
    monkeypatch.setattr(training, "train_models", requests.append)
    whole = TrainingRequest("agilo", tmp_path, data=(tmp_path,), kinds=("duration", "success"))
    own = Training(learners=(OwnLearner("reach", "bag"), OwnLearner("goToPose", features="projective")))
    progress = list(training._train(Making("agilo", replace(TINY, training=own), tmp_path, 1, "make"), whole))
    assert progress == [(done, 4) for done in range(5)], "a long training is no silence"
    each = [(request.actions, request.kinds, request.learner, request.features) for request in requests]
    named = ("goToPose", whole.learner, "projective"), ("reach", "bag", whole.features)
    assert each == [((action,), (kind,), learner, space) for kind in whole.kinds for action, learner, space in named]
    usual = {
        replace(request, actions=(), kinds=whole.kinds, learner=whole.learner, features=whole.features)
        for request in requests
    }
    assert usual == {whole}


def test_models_that_an_action_names_and_lacks_are_told_before_they_replace_others(tmp_path: Path) -> None:
    making = Making("powercube", Recipe(40), tmp_path, 1, "make")
    with pytest.raises(UsageError, match="reach needs reach/duration, which 40 random episodes do not suffice"):
        installing.check_complete(making)
    (making.zoo / "powercube" / "reach").mkdir(parents=True)
    (making.zoo / "powercube" / "reach" / "duration.onnx").touch()
    installing.check_complete(making)


def test_a_recipe_may_name_a_profile_of_the_body(tmp_path: Path, trained: list, monkeypatch) -> None:
    drawn = []
    prepare = random_episodes.prepare
    monkeypatch.setattr(
        random_episodes,
        "prepare",
        lambda spec, resume: (drawn.append(spec.profile), prepare(spec, resume)),
    )
    monkeypatch.setattr(policy_runs, "run_policy", lambda policy, _: drawn.append(policy.profile) or iter((1,)))
    usual, degraded = (Making("agilo", replace(TINY, profile=name), tmp_path, 1, "make") for name in ("", "degraded"))
    list(make(degraded))
    assert set(drawn) == {"degraded"}
    assert len(drawn) > 1
    assert usual.random != degraded.random
    with pytest.raises(UsageError, match="no profile 'x' of soccer's body"):
        list(make(replace(usual, recipe=replace(TINY, profile="x"))))


def test_an_action_may_have_another_number_of_episodes_and_a_robot_fewer_kinds(tmp_path: Path, trained: list) -> None:
    few = Recipe(20, random=(RandomEpisodes("goToPose", 60),), training=Training(kinds=("duration",)))
    steps = {step.title: step.total for step in make(Making("agilo", few, tmp_path, 1, "make"))}
    assert (steps["goToPose: random episodes"], steps["dribbleBall: random episodes"]) == (60, 20)
    assert trained[-1].kinds == ("duration",)
    unknown = Recipe(20, random=(RandomEpisodes("fly", 60),))
    with pytest.raises(UsageError, match="random episodes of 'fly', expected one of: "):
        list(make(Making("agilo", unknown, tmp_path, 1, "make")))


def test_what_was_made_is_not_made_again(tmp_path: Path, trained: list) -> None:
    making = Making("agilo", TINY, tmp_path, 1, "make")
    list(make(making))
    assert len(list(make(making))) >= 4
    assert len(trained) == 2


def test_another_source_or_recipe_starts_anew_but_keeps_random_episodes(tmp_path: Path, monkeypatch) -> None:
    making = Making("agilo", TINY, tmp_path, 1, "make")
    random, rounds = making.random, making.rounds
    monkeypatch.setattr(making_module, "learning_sha256", lambda: "another learner")
    assert (making.random, making.rounds != rounds) == (random, True)
    monkeypatch.setattr(making_module, "episodes_sha256", lambda _: "another controller")
    assert making.random != random


def test_installing_replaces_all_models_of_the_robot_and_nothing_else(tmp_path: Path) -> None:
    made, zoo, shipped = tmp_path / "made", tmp_path / "zoo", ZOO / "powercube" / "reach" / "duration.onnx"
    new = made / "a/go/duration.onnx"
    replace_model(new, shipped.read_bytes(), read_card(card_path(shipped)))
    files = {
        "a/go/duration.onnx": "old",
        "a/go/success.onnx": "old",
        "a/stop/energy.card.json": "old",
        "a/recipe.toml": "kept",
        "b/go/duration.onnx": "kept",
    }
    for name, text in files.items():
        (zoo / name).parent.mkdir(parents=True, exist_ok=True)
        (zoo / name).write_text(text)
    install(made, zoo, "a")
    left = {path.relative_to(zoo).as_posix(): path.read_bytes() for path in zoo.rglob("*") if path.is_file()}
    pair = {"a/go/duration.onnx": new.read_bytes(), "a/go/duration.card.json": card_path(new).read_bytes()}
    assert left == {**pair, "a/recipe.toml": b"kept", "b/go/duration.onnx": b"kept"}


REACH = "[[random]]\naction = 'reach'\nepisodes = 9\n"
ROUND = "[[rounds]]\nsource = 'active'\nepisodes = 1\nscenarios = [{}]"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "lacks `episodes`"),
        ("episodes = 0", "recipe.toml: episodes is 0, expected at least 1"),
        ("episodes = 'many'", "'episodes' is 'many', expected int"),
        ("episodes = [", "not TOML"),
        ("episodes = " + "[" * 5000, "nested too deeply, expected a recipe"),
        ("episodes = 9\nseed = -1", "seed is -1, expected 0 to 1000000000"),
        ("episodes = 9\n[training]\nseed = -1", "training.seed is -1, expected 0 to 1000000000"),
        ("episodes = 9\n[training]\nseed = 4294967295", "training.seed is 4294967295, expected 0 to 1000000000"),
        ("episodes = 9\nbeside = -5\nobjects = -1", "beside is -5, expected at least 0; objects is -1, expected at"),
        ("episodes = 9\n[[random]]\naction = 'reach'", "'random.episodes' is missing, expected int"),
        (
            "episodes = 9\n[[rounds]]\nscenarios = ['a']\nepisodes = 1",
            "'rounds.source' is missing, expected one of: on-",
        ),
        ("episodes = 9\nrounds = [3]", "'rounds' is 3, expected a table"),
        (f"episodes = 9\n{2 * REACH}", "random: 'reach' is there twice, expected once"),
        ("episodes = 9\n" + ROUND.format(""), "rounds.scenarios is empty, expected at least one"),
        ("episodes = 9\n" + ROUND.format("'a', 'b', 'a'"), "rounds.scenarios: 'a' is there twice, expected once"),
        ("episodes = 9\n[[rounds]]\nsource = 'guess'\nscenarios = []\nepisodes = 1", "'rounds.source' is 'guess'"),
        ("episodes = 9\n" + ROUND.format("'a'") + "\npool = 0", "rounds.pool is 0, expected at least 1"),
        ("episodes = 9\n[[calibration]]\nscenarios = []\nepisodes = 0", "calibration.episodes is 0, expected at least"),
        ("episodes = 9\n[[calibration]]\nscenarios = []\nepisodes = 1", "calibration.scenarios is empty, expected"),
        ("episodes = 9\nepochs = 3", "unknown key 'epochs'"),
        ("episodes = 9\n[[random]]\naction = 'reach'\nepisodes = 0", "random.episodes is 0, expected at least 1"),
        ("episodes = 9\n[training]\nkinds = ['durations']", "'training.kinds' is 'durations', expected one of"),
    ],
)
def test_a_recipe_with_errors_is_refused_in_one_line(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "recipe.toml"
    path.write_text(text)
    with pytest.raises(UsageError) as error:
        read_recipe(path)
    assert message in str(error.value)
    assert "\n" not in str(error.value)


def test_a_recipe_that_is_not_utf_8_is_refused(tmp_path: Path) -> None:
    (tmp_path / "recipe.toml").write_bytes(b"# \xe9\nepisodes = 9")
    with pytest.raises(UsageError, match=r"not UTF-8 \(byte 0xe9 at position 2\), expected a recipe"):
        read_recipe(tmp_path / "recipe.toml")


@pytest.mark.parametrize(
    ("robot", "text", "message"),
    [
        ("agilo", ROUND.format("'approach', 'nope'"), "no scenario 'nope' in soccer, expected one of: "),
        ("agilo", REACH, "random episodes of 'reach', expected one of: "),
        ("agilo", "profile = 'x'", "no profile 'x' of soccer's body, expected one of: "),
        ("agilo", "[training]\nlearner = 'nope'", "nope"),
        ("agilo", "[training]\nfeatures = 'nope'", "no feature space 'nope'"),
        ("agilo", "[training]\nfeatures = 'joints'", "approachBall: arguments are x y phi v xg"),
        ("powercube", ROUND.format("'nope'"), "no scenario"),
        ("agilo", ROUND.format("'approach'"), "beside is 0, expected runs of goToPose beside objects"),
        ("agilo", "[[calibration]]\nscenarios = ['nope']\nepisodes = 1", "no scenario 'nope' in soccer, expected one"),
        ("powercube", "beside = 4", "beside is 4, expected 0: no action has a model of success beside an object"),
    ],
)
def test_names_in_a_recipe_are_checked_before_anything_is_gathered(
    tmp_path: Path, robot: str, text: str, message: str, capsys
) -> None:
    (tmp_path / "recipe.toml").write_text(f"episodes = 9\n{text}")
    recipe, zoo, work = (str(tmp_path / name) for name in ("recipe.toml", "zoo", "work"))
    flags = ["--recipe", recipe, "--zoo", zoo, "--work", work]
    assert main(["make-models", robot, *flags]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert message in line
    assert not (tmp_path / "work").exists()


def test_a_file_in_the_place_of_a_zoo_is_refused_before_anything_is_gathered(tmp_path: Path, capsys) -> None:
    zoo = tmp_path / "zoo"
    zoo.touch()
    assert main(["make-models", "powercube", "--zoo", str(zoo), "--work", str(tmp_path / "work")]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line.endswith(f"--zoo {zoo} is a file, expected a folder")
    assert not (tmp_path / "work").exists()


def test_recipes_that_ship_pass_all_checks(tmp_path: Path) -> None:
    for robot in robot_names():
        check(Making(robot, read_recipe(recipe_path(robot)), tmp_path, 1, "make"))


def test_no_action_of_a_robot_that_ships_was_learned_from_over_3000_episodes() -> None:
    """But for success beside objects, noted after runs that had none: an episode for every object."""
    cards = [card for robot in robot_names() for card in recipe_path(robot).parent.glob("*/*.card.json")]
    counts = {(card.parent.name, card.name): json.loads(card.read_text())["episodes"]["count"] for card in cards}
    assert len(counts) > len(robot_names())
    assert {name: count for name, count in counts.items() if count > 3000 and name[1] != "clearance.card.json"} == {}


@pytest.mark.slow
def test_the_same_recipe_gives_the_same_bits(tmp_path: Path) -> None:
    (tmp_path / "recipe.toml").write_text("episodes = 40")
    for name in ("one", "two"):
        flags = ["--recipe", str(tmp_path / "recipe.toml"), "--zoo", str(tmp_path / name)]
        assert main(["make-models", "powercube", *flags, "--work", str(tmp_path / f"work-{name}"), "--json"]) == 0
    one, two = (
        {
            path.relative_to(tmp_path / name): path.read_bytes()
            for path in (tmp_path / name).rglob("*")
            if path.is_file()
        }
        for name in ("one", "two")
    )
    assert one == two
    assert len(one) >= 4
