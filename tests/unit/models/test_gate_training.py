"""Refinement gates are learned reproducibly, checked before use, named in provenance, and can be switched off."""

import dataclasses
import json
import shutil
from pathlib import Path

import numpy as np
import pytest

from tailor.executive.composition import ExecutiveConfig, build_context, load_models, provenance, rebuild_context
from tailor.executive.core.context import Settings
from tailor.executive.refinement.gate import SITUATION
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.models import runtime
from tailor.models.cards.card import card_path, read_card, write_card
from tailor.models.export.gate_publishing import GateProvenance, publish_gate, remove_gate
from tailor.models.training.gate_training import Pairs, TrainedGate, train_gate
from tailor.models.training.gate_trees import LEARNERS
from tailor.schemas.errors import UsageError
from tailor.schemas.messages import RefinementReport
from tailor.tools.commands.learn import train
from tailor.tools.evaluations.outcome import Outcome
from tailor.tools.goldens import renew
from tailor.tools.main import main
from tailor.tools.recordings.recorded_run import RecordedRuns
from tailor.tools.recordings.verification import verify
from tailor.tools.viewer.recorded_messages import timed

KIND = ("approachBall", "dribbleBall")
TURNED = SITUATION.index("turned_rad")


def pairs(seed: int = 0, count: int = 300) -> Pairs:
    """Refining costs time nine times in ten where it hardly turns the choice."""
    rng = np.random.default_rng(seed)
    situations = rng.uniform(0, 1, (count, len(SITUATION)))
    lost = (situations[:, TURNED] < 0.2) == (rng.uniform(size=count) < 0.9)
    return Pairs(situations, np.full(count, 10.0), np.where(lost, 10.5, 9.0))


def about(models, **changes) -> GateProvenance:
    loaded = {**models.durations, **models.successes}
    made_with = {name: model.card["sha256"] for name, model in loaded.items()}
    told = GateProvenance(
        "agilo", SITUATION, (KIND,), made_with, {"horizon": 2}, {"seed": 1}, "forest", 1, "made by hand"
    )
    return dataclasses.replace(told, **changes)


@pytest.fixture(scope="module")
def trained() -> TrainedGate:
    return train_gate(pairs(), SITUATION, "tree", 1)


@pytest.fixture
def zoo(tmp_path: Path, trained: TrainedGate) -> Path:
    """The shipped models with a tree learned from made-up pairs."""
    folder = tmp_path / "zoo"
    shutil.copytree(runtime.ZOO / "agilo", folder / "agilo")
    publish_gate(folder, pairs(), trained, about(load_models("agilo", str(folder))))
    return folder


def tree_of(zoo: Path) -> Path:
    return zoo / "agilo" / "refinement" / "benefit.onnx"


@pytest.mark.parametrize("learner", LEARNERS)
def test_what_can_be_learned_is_learned(learner: str) -> None:
    trained = train_gate(pairs(), SITUATION, learner, 1)
    assert trained.test["right_pct"] > 85
    assert trained.test["slower_pct"] < trained.test["ungated"]["slower_pct"] / 2
    assert trained.test["improvement_pct"] >= trained.test["ungated"]["improvement_pct"]
    assert np.sum(trained.test["confusion"]) == 300
    assert any("turned_rad" in rule for rule in trained.rules)


def test_what_cannot_be_learned_costs_nothing() -> None:
    rng = np.random.default_rng(0)
    noise = Pairs(rng.uniform(0, 1, (400, len(SITUATION))), np.full(400, 10.0), rng.normal(9.5, 0.5, 400))
    test = train_gate(noise, SITUATION, "forest", 1).test
    assert test["improvement_pct"] >= test["ungated"]["improvement_pct"] - 0.3


def test_training_is_reproducible(tmp_path: Path) -> None:
    told = about(load_models("agilo"))
    paths = [
        publish_gate(tmp_path / name, pairs(), train_gate(pairs(), SITUATION, "forest", 1), told)
        for name in ("one", "other")
    ]
    assert len({path.read_bytes() for path in paths}) == 1
    assert len({card_path(path).read_bytes() for path in paths}) == 1


def test_too_few_pairs_or_an_unknown_learner_are_refused() -> None:
    with pytest.raises(UsageError, match="50 pairs of episodes, expected at least 100"):
        train_gate(pairs(count=50), SITUATION, "forest", 1)
    with pytest.raises(UsageError, match="learner 'oracle' is unknown for the refinement gate"):
        train_gate(pairs(), SITUATION, "oracle", 1)


def test_seeds_of_evaluations_are_never_trained_on(capsys) -> None:
    assert main(["train-gate", "agilo", "--seed", "999900", "--episodes", "101"]) == 2
    assert "reserved for evaluation; expected 0..999999" in capsys.readouterr().err


def made_up(seed: int, variant: str, greedy_s: float, refined_s: float, situation: np.ndarray) -> Outcome:
    duration_s = greedy_s if variant == "h1" else refined_s
    predicted = (("goToPose", True, 2.0), (KIND[0], False, 3.0), (KIND[1], False, 5.0))
    seen = tuple(situation) if variant == "h2" else ()
    return Outcome(seed, variant, True, duration_s, "achieved", (), (), (), (), False, 0.0, (), (),
                   predicted_actions=predicted, situation=seen)  # fmt: skip


def test_the_command_learns_from_pairs_and_ships_a_tree_that_the_executive_takes(tmp_path, monkeypatch, capsys) -> None:
    known, ran = pairs(), []

    def run_all(task, variants, seeds, jobs, store, title):
        ran.extend(variants)
        rows = list(zip(seeds, known.greedy_s, known.refined_s, known.situations, strict=True))
        return {v.name: {row[0]: made_up(row[0], v.name, *row[1:]) for row in rows} for v in variants}

    monkeypatch.setattr("tailor.tools.evaluations.task_runs.run_all", run_all)
    shutil.copytree(runtime.ZOO / "agilo", tmp_path / "agilo")
    words = ["agilo", "--episodes", "300", "--zoo", str(tmp_path), "--learner", "tree"]
    assert main(["train-gate", *words]) == 0
    assert "slower episodes" in capsys.readouterr().out
    assert [(v.refinement.horizon, v.refinement.gate) for v in ran] == [(1, False), (2, False)]
    tree = load_models("agilo", str(tmp_path), gated=True).gate
    assert tree.sequences == {KIND}  # the asserted subgoal is left out
    assert tree.card["episodes"]["seed"] < tree.card["episodes"]["seed"] + 300 <= 1_000_000
    assert "refinement/benefit" not in tree.card["models"]
    again = tree.card["command"].split()[1:]
    assert main([*again, "--zoo", str(tmp_path)]) == 0  # the card's command makes the same bytes
    assert load_models("agilo", str(tmp_path), gated=True).gate.card["sha256"] == tree.card["sha256"]


def test_a_published_tree_says_what_its_learner_said(zoo: Path, trained: TrainedGate) -> None:
    tree = load_models("agilo", str(zoo), gated=True).gate
    fresh = pairs(1).situations
    assert tree.p_slowdown(fresh) == pytest.approx(trained.trees.risk(fresh), abs=1e-6)
    assert tree.sequences == {KIND}
    assert np.isnan(tree.p_slowdown(np.full((1, len(SITUATION)), np.nan)))[0]


def test_a_zoo_without_a_tree_has_none_and_a_gate_that_is_off_loads_none(zoo: Path) -> None:
    assert load_models("powercube", gated=True).gate is None
    assert load_models("agilo", str(zoo), gated=False).gate is None


def test_a_tree_that_was_learned_with_other_models_is_refused(zoo: Path) -> None:
    card = read_card(card_path(tree_of(zoo)))
    write_card(card_path(tree_of(zoo)), {**card, "models": {**card["models"], "dribbleBall/duration": "0" * 64}})
    with pytest.raises(UsageError, match=r"trained with dribbleBall/duration 0{12}.*train-gate.*gate"):
        load_models("agilo", str(zoo), gated=True)
    assert load_models("agilo", str(zoo), gated=False).gate is None
    assert main(["models", "check", "agilo/refinement", "--zoo", str(zoo)]) == 1


@pytest.mark.parametrize("gone", ["benefit.onnx", "benefit.card.json"])
def test_a_tree_without_its_card_or_a_card_without_its_tree_is_refused(zoo: Path, gone: str) -> None:
    tree_of(zoo).with_name(gone).unlink()
    with pytest.raises(UsageError, match="no such file"):
        load_models("agilo", str(zoo), gated=True)


def test_a_flipped_bit_of_the_tree_is_refused(zoo: Path) -> None:
    content = bytearray(tree_of(zoo).read_bytes())
    content[len(content) // 2] ^= 1
    tree_of(zoo).write_bytes(content)
    with pytest.raises(UsageError, match="sha256"):
        load_models("agilo", str(zoo), gated=True)


def test_a_tree_that_asks_for_something_else_is_refused(zoo: Path, trained: TrainedGate) -> None:
    publish_gate(zoo, pairs(), trained, about(load_models("agilo", str(zoo)), names=("luck", *SITUATION[1:])))
    with pytest.raises(UsageError, match=r"inputs luck.*expected gain_s"):
        load_models("agilo", str(zoo), gated=True)


def test_models_commands_know_the_tree(zoo: Path, capsys) -> None:
    assert main(["models", "list", "--zoo", str(zoo), "--json"]) == 0
    listed = {row["model"]: row for row in json.loads(capsys.readouterr().out)}
    assert "% correct" in listed["agilo/refinement/benefit"]["test"]
    assert main(["models", "check", "agilo/refinement", "--zoo", str(zoo)]) == 0
    assert main(["models", "rules", "agilo/refinement", "--zoo", str(zoo)]) == 0
    assert "then refining risks" in capsys.readouterr().out
    assert main(["models", "show", "agilo/refinement", "--zoo", str(zoo)]) == 0
    assert "outputs: [slower]" in capsys.readouterr().out


def test_a_tree_is_withdrawn_with_its_card(zoo: Path) -> None:
    assert remove_gate(zoo, "agilo")
    assert load_models("agilo", str(zoo), gated=True).gate is None
    assert not remove_gate(zoo, "agilo")


def test_training_action_models_removes_the_gate_of_the_previous_ones(zoo: Path, monkeypatch, capsys) -> None:
    monkeypatch.setattr(train, "train_models", lambda *_: [])
    assert main(["train", "agilo", "--zoo", str(zoo), "--json"]) == 0
    assert not tree_of(zoo).exists()
    assert "`tailor train-gate agilo` trains a new one" in " ".join(capsys.readouterr().err.split())


def gated_order(zoo: Path, gate: bool = True) -> ExecutiveConfig:
    settings = Settings(seed=4, refinement=RefinementSettings(gate=gate))
    return ExecutiveConfig("soccer", "approach-dribble", settings, str(zoo))


def test_a_run_s_provenance_names_its_tree_and_a_run_without_is_made_again_without(zoo: Path) -> None:
    with_tree = provenance(order := gated_order(zoo), build_context(order, "ab" * 16))
    without = provenance(order := gated_order(zoo, gate=False), build_context(order, "ab" * 16))
    assert with_tree["models"]["refinement/benefit"] == read_card(card_path(tree_of(zoo)))["sha256"]
    assert rebuild_context(with_tree).models.gate is not None
    assert rebuild_context(without).models.gate is None
    del without["config"]["settings"]["refinement"]["gate"]  # recorded before there were trees
    assert rebuild_context(without).models.gate is None
    remove_gate(zoo, "agilo")
    with pytest.raises(UsageError, match="refinement/benefit is missing"):
        rebuild_context(with_tree)


def test_a_run_that_was_advised_verifies_bit_for_bit(zoo: Path, tmp_path: Path, monkeypatch) -> None:
    fearful = read_card(card_path(tree_of(zoo)))
    write_card(card_path(tree_of(zoo)), {**fearful, "threshold": 0.0})  # always keeps greedy
    configured = ExecutiveConfig
    monkeypatch.setattr(renew, "ExecutiveConfig", lambda *words: dataclasses.replace(configured(*words), zoo=str(zoo)))
    renew.record(renew.Golden("soccer", "approach-dribble", 2), tmp_path / "run.mcap")
    runs = RecordedRuns(tmp_path / "run.mcap")
    said = [m.message for m in _reports(tmp_path / "run.mcap")]
    assert any(report.kept_greedy for report in said)
    verdict = verify(runs, runs.runs[0], rebuild_context(runs.runs[0].provenance))
    assert verdict.difference is None


def _reports(path: Path):
    return [t for t in timed(path, "") if isinstance(t.message, RefinementReport)]
