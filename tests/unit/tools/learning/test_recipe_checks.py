"""Recipes that their robot cannot follow are refused before anything is gathered."""

from pathlib import Path

import pytest

from tailor.schemas.errors import UsageError
from tailor.tools.learning.gathering import beside_objects
from tailor.tools.learning.making.recipe_checks import check_recipe
from tailor.tools.learning.recipe import Recipe, Round
from tailor.tools.learning.recipe_file import read_recipe
from tailor.tools.main import main


@pytest.mark.parametrize(("objects", "lacks"), [(0, "`context` and `context_start`"), (3, "`sample_among_objects` or")])
def test_a_sampler_that_draws_no_objects_is_found_out_before_hours_of_other_episodes(monkeypatch, objects, lacks):
    monkeypatch.setattr(beside_objects, "sampler_of", lambda domain: object())
    with pytest.raises(UsageError, match=f"the sampler object of soccer lacks {lacks}"):
        check_recipe("agilo", Recipe(9, beside=1, objects=objects))
    check_recipe("agilo", Recipe(9))


def test_a_number_of_objects_without_runs_beside_them_is_refused(tmp_path):
    path = tmp_path / "recipe.toml"
    path.write_text("episodes = 9\nobjects = 20")
    with pytest.raises(UsageError, match=r"recipe.toml: objects is 20, expected none without `beside`"):
        read_recipe(path)
    path.write_text("episodes = 9\nobjects = 20\nbeside = 1")
    assert read_recipe(path).objects == 20


OWN = "\n[[training.learners]]\naction = '{}'\nlearner = '{}'"
UNCERTAIN = "\n[[uncertain]]\naction = '{}'\nepisodes = {}"
ROUND = "episodes = 9\n[[rounds]]\nsource = '{}'\nscenarios = ['a', 'b']\nepisodes = {}"


@pytest.mark.parametrize(("source", "most"), [("active", 25_000), ("on-policy", 50_000)])
def test_rounds_never_reach_the_seeds_of_the_next_one(tmp_path, source, most):
    path = tmp_path / "recipe.toml"
    path.write_text(ROUND.format(source, most))
    assert read_recipe(path).rounds[0].situations == 100_000
    path.write_text(ROUND.format(source, most + 1))
    with pytest.raises(UsageError, match=r"recipe.toml: rounds: 10000[24] situations .*expected at most 100000"):
        read_recipe(path)


def test_a_horizon_is_for_on_policy_rounds_only(tmp_path):
    path = tmp_path / "recipe.toml"
    path.write_text(ROUND.format("on-policy", 1) + "\nhorizon = 1")
    assert read_recipe(path).rounds[0].horizon == 1
    for source, horizon, message in [
        ("active", 1, r"rounds.horizon: only on-policy rounds execute"),
        ("on-policy", 0, r"rounds.horizon is 0, expected at least 1"),
    ]:
        path.write_text(ROUND.format(source, 1) + f"\nhorizon = {horizon}")
        with pytest.raises(UsageError, match=rf"recipe.toml: {message}"):
            read_recipe(path)
    with pytest.raises(UsageError, match=r"horizon is 51, expected at most 50"):
        check_recipe("powercube", Recipe(9, rounds=(Round("on-policy", ("letter-I",), 1, horizon=51),)))


def test_the_recipe_of_the_degraded_robot_can_be_followed():
    recipe = read_recipe(Path(__file__).parents[4] / "examples" / "degraded_recipe.toml")
    check_recipe("agilo", recipe)
    assert (recipe.profile, recipe.rounds[0].horizon) == ("degraded", 1)


def test_a_pool_is_for_active_rounds_only(tmp_path):
    path = tmp_path / "recipe.toml"
    path.write_text(ROUND.format("active", 1) + "\npool = 3")
    assert read_recipe(path).rounds[0].pool == 3
    path.write_text(ROUND.format("on-policy", 1) + "\npool = 3")
    with pytest.raises(UsageError, match=r"recipe.toml: rounds.pool: only active rounds draw"):
        read_recipe(path)


@pytest.mark.parametrize(
    ("robot", "text", "message"),
    [
        ("agilo", "[[random]]\naction = 'fly'\nepisodes = 3", "{path}: random episodes of 'fly', expected one of: "),
        ("agilo", UNCERTAIN.format("fly", 3), "{path}: uncertain episodes of 'fly', expected one of: "),
        ("agilo", UNCERTAIN.format("goToPose", 3), "{path}: action 'goToPose' of soccer has no model of success"),
        ("agilo", UNCERTAIN.format("approachBall", 0), "{path}: uncertain.episodes is 0, expected at least 1"),
        ("agilo", UNCERTAIN.format("approachBall", 33334), "{path}: 1000020 random tasks (episodes × pool)"),
        ("agilo", UNCERTAIN.format("approachBall", 9) * 2, "{path}: uncertain: 'approachBall' is there twice"),
        ("agilo", "beside = 1000001", "{path}: 1000001 random episodes, expected at most 1000000"),
        ("agilo", "profile = 'x'", "{path}: no profile 'x' of soccer's body, expected one of: "),
        ("agilo", "[training]\nlearner = 'x'", "{path}: learner 'x' is unknown"),
        ("agilo", OWN.format("dribbleBall", "x"), "{path}: learner 'x' is unknown"),
        ("agilo", OWN.format("fly", "bag"), "{path}: a learner of 'fly', expected one of: "),
        ("agilo", OWN.format("goToPose", "bag") * 2, "{path}: training.learners: 'goToPose' is there twice"),
        ("r2d2", "", "no robot 'r2d2'"),
    ],
)
def test_the_file_of_a_recipe_with_faults_is_named_first(tmp_path, capsys, robot, text, message):
    path = tmp_path / "recipe.toml"
    path.write_text(f"episodes = 9\n{text}")
    assert main(["make-models", robot, "--recipe", str(path), "--work", str(tmp_path / "work")]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith(f"tailor make-models: {message.format(path=path)}")
    assert not (tmp_path / "work").exists()
