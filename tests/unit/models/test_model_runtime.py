"""A model is used only if bytes, card and answers agree; what is refused is told with both sides named."""

import dataclasses
import json
import shutil
from pathlib import Path

import numpy as np
import pytest

from tailor.executive import domains
from tailor.executive.robot_models import check_ranges, load_models
from tailor.models import inference, runtime
from tailor.models.cards.card import card_path, read_card, sha256_of, write_card
from tailor.models.features.planar import projective
from tailor.schemas.errors import UsageError
from tailor.tools.main import main

SHIPPED = runtime.ZOO / "agilo"


@pytest.fixture
def zoo(tmp_path: Path) -> Path:
    shutil.copytree(runtime.ZOO, tmp_path / "zoo")
    return tmp_path / "zoo"


def duration(zoo: Path) -> Path:
    return zoo / "agilo" / "goToPose" / "duration.onnx"


PROBE = {"seed": 7, "stream": 10, "ends": [[1.0]]}


def changed_card(path: Path, **changes: object) -> None:
    write_card(card_path(path), {**read_card(card_path(path)), **changes})


def test_all_shipped_models_load_and_name_their_makers() -> None:
    durations, successes = runtime.load_robot("agilo")
    assert set(durations) >= {"goToPose/duration", "approachBall/duration", "dribbleBall/duration"}
    assert {name.split("/")[1] for name in durations} == {"duration", "duration_beside", "energy"}
    assert set(successes) == {"approachBall/success", "goToPose/clearance"}
    for model in (*durations.values(), *successes.values()):
        assert model.card["episodes"]["count"] >= 1000
        assert model.card["command"].startswith(("tailor gather agilo", "tailor make-models agilo"))
        assert len(model.card["golden"]["arguments"]) == 32


@pytest.mark.parametrize("absent", [False, True])
def test_durations_beside_objects_of_other_episodes_than_those_without_are_refused(zoo, absent) -> None:
    if absent:
        duration(zoo).unlink()
        card_path(duration(zoo)).unlink()
    else:
        changed_card(duration(zoo), episodes={**read_card(card_path(duration(zoo)))["episodes"], "sha256": "0" * 64})
    with pytest.raises(UsageError, match=r"duration_beside.onnx: learned from other episodes than goToPose/duration"):
        runtime.load_robot("agilo", zoo)


def test_a_model_loads_by_name_too() -> None:
    model = runtime.load_model("agilo/goToPose/duration")
    mean, std = model.predict(np.array([[0, 0, 0, 0, 2.0, 0, 0, 0], [0, 0, np.nan, 0, 2, 0, 0, 0]]))
    assert 2 < mean[0] < 8
    assert std[0] >= 0
    assert np.isnan([mean[1], std[1]]).all()


@pytest.mark.promise("P32")
def test_an_answer_out_of_range_is_invalid() -> None:
    model = runtime.load_model("agilo/goToPose/duration")
    narrow = inference.OnnxDuration(model.session, model.card, 0.0, 0.1)
    assert np.isnan(narrow.predict(np.array([[0, 0, 0, 0, 2.0, 0, 0, 0]]))[0]).all()


class Answering:
    """A session whose answer is fixed."""

    def __init__(self, *shares: float) -> None:
        self.shares = np.array(shares, np.float32)

    def run(self, *_: object) -> list[np.ndarray]:
        return [self.shares]


def test_a_sure_success_stays_sure_though_its_shares_add_up_to_just_above_one() -> None:
    model = inference.OnnxSuccess(Answering(np.nextafter(np.float32(1), np.float32(2)), -1e-8, 1.1, -0.1), {}, 0.5)
    assert np.array_equal(model.probability(np.zeros((4, 1))), [1.0, 0.0, np.nan, np.nan], equal_nan=True)


def test_probability_of_what_is_not_a_number_is_invalid() -> None:
    model = runtime.load_model("agilo/approachBall/success")
    assert np.isnan(model.probability(np.array([[0, 0, np.nan, 0, 2.0, 0, 0, 0]]))).all()


@pytest.mark.promise("P32")
@pytest.mark.parametrize("seed", range(20))
def test_a_flipped_bit_is_refused(zoo: Path, seed: int) -> None:
    content = bytearray(duration(zoo).read_bytes())
    rng = np.random.default_rng(seed)
    content[rng.integers(len(content))] ^= 1 << rng.integers(8)
    duration(zoo).write_bytes(content)
    with pytest.raises(UsageError, match=r"sha256 is \w{12}…, expected \w{12}… by its card"):
        runtime.load_robot("agilo", zoo)


def test_a_model_whose_metadata_are_no_text_is_refused(zoo: Path) -> None:
    content = duration(zoo).read_bytes()
    altered = content[::-1].replace(b"agilo"[::-1], b"agil\xff"[::-1], 1)[::-1]  # metadata are at the end
    duration(zoo).write_bytes(altered)
    changed_card(duration(zoo), sha256=sha256_of(altered))
    with pytest.raises(UsageError, match="no UTF-8"):
        runtime.load_model(duration(zoo))


@pytest.mark.promise("P32")
def test_a_truncated_file_is_refused_even_with_its_hash_in_the_card(zoo: Path) -> None:
    content = duration(zoo).read_bytes()[:-2000]
    duration(zoo).write_bytes(content)
    changed_card(duration(zoo), sha256=sha256_of(content))
    with pytest.raises(UsageError, match="not a model that onnxruntime can run"):
        runtime.load_model(duration(zoo))


@pytest.mark.promise("P32")
def test_a_model_of_another_robot_is_refused(zoo: Path) -> None:
    shutil.copytree(zoo / "agilo", zoo / "rover")
    with pytest.raises(UsageError, match=r"model of agilo/\w+/duration, expected rover/\w+/duration"):
        runtime.load_robot("rover", zoo)


def test_a_model_of_another_action_is_refused(zoo: Path) -> None:
    shutil.copytree(zoo / "agilo" / "dribbleBall", zoo / "agilo" / "reach")
    with pytest.raises(UsageError, match="agilo/dribbleBall/duration, expected agilo/reach/duration"):
        runtime.load_robot("agilo", zoo)


@pytest.mark.parametrize(("key", "value"), [("robot", "b21"), ("features", "relative"), ("action", "reach")])
def test_a_card_of_another_model_is_refused(zoo: Path, key: str, value: str) -> None:
    changed_card(duration(zoo), **{key: value})
    with pytest.raises(UsageError, match=f"the model's {key} is '.*', expected '{value}' by its card"):
        runtime.load_model(duration(zoo))


def test_ranges_that_the_model_has_not_seen_are_refused(zoo: Path) -> None:
    card = read_card(card_path(duration(zoo)))
    check_ranges(card, {"vg": (0.0, 0.6)}, zoo)
    with pytest.raises(UsageError, match=r"vg was trained in \[0, 0.6\] m/s, expected to cover \[0, 0.9\]"):
        check_ranges(card, {"vg": (0.0, 0.9)}, zoo)
    with pytest.raises(UsageError, match="has no argument 'z'"):
        check_ranges(card, {"z": (0.0, 0.9)}, zoo)


@pytest.mark.promise("P32")
def test_a_model_that_answers_otherwise_than_its_card_says_is_refused(zoo: Path) -> None:
    golden = dict(read_card(card_path(duration(zoo)))["golden"])
    golden["mean_s"] = [value + (0.001 if k == 5 else 0) for k, value in enumerate(golden["mean_s"])]
    changed_card(duration(zoo), golden=golden)
    with pytest.raises(UsageError, match="golden example 5 gives mean_s"):
        runtime.load_model(duration(zoo))


@pytest.mark.parametrize("gone", ["duration.onnx", "duration.card.json"])
def test_a_model_without_its_card_or_a_card_without_its_model_is_refused(zoo: Path, gone: str) -> None:
    (zoo / "agilo" / "goToPose" / gone).unlink()
    with pytest.raises(UsageError, match="no such file"):
        runtime.load_robot("agilo", zoo)


BROKEN = ["", "[]", '{"format": 99}', json.dumps({"format": 1, "robot": "agilo"}), "\x00", "[" * 100_000]


@pytest.mark.parametrize("content", BROKEN, ids=range(len(BROKEN)))
def test_a_broken_card_is_refused(zoo: Path, content: str) -> None:
    card_path(duration(zoo)).write_text(content)
    with pytest.raises(UsageError, match="card"):
        runtime.load_robot("agilo", zoo)


NUMBERS = [0.5] * 32


@pytest.mark.parametrize(
    ("key", "value", "message"),
    [
        ("arguments", "x", "arguments is 'x', expected a list"),
        ("arguments", [{"name": "x", "unit": "m", "lower": "a", "upper": 1}], "expected name, unit, and numbers"),
        ("golden", "x", "golden is 'x', expected an object"),
        ("golden", {"arguments": [], "mean_s": [], "std_s": []}, "golden arguments are"),
        ("golden", {"arguments": [[1]] * 32, "mean_s": NUMBERS, "std_s": NUMBERS}, "expected rows of 8 numbers"),
        ("golden", {"arguments": [[0] * 8] * 32, "mean_s": NUMBERS[:2], "std_s": NUMBERS}, "golden mean_s is"),
        ("golden", {"arguments": [[0] * 8] * 32, "std_s": NUMBERS}, "golden mean_s is None, expected 32 numbers"),
        ("outputs", ["mean_s"], "outputs is ['mean_s'], expected ['mean_s', 'lower_s', 'upper_s']"),
        ("output_range", [60, 0], "output_range is [60, 0], expected two numbers"),
        ("output_range", [float("nan"), 1], "output_range is [nan, 1]"),
        ("kind", "magic", "kind is 'magic', expected one of: duration, duration_beside, energy, success"),
        ("sha256", None, "sha256 is None, expected text"),
        ("test", {}, "test's mae_s is None, expected a number"),
        ("test", {"mae_s": 1, "mean_duration_s": 1, "learning_curve": 5}, "learning_curve is 5, expected rows of 2"),
        ("test", {"mae_s": 1, "mean_duration_s": 1, "learning_curve": [[1, 2]]}, "mae_ci95 is None, expected two"),
        ("learner", None, "learner is None, expected an object"),
        ("episodes", {"count": "x"}, "episodes' count is 'x', expected a number"),
        ("episodes", {"count": 9, "sources": [5]}, "episodes' sources are [5], expected objects"),
        ("episodes", {"count": 9, "source_files": {"a": 5}}, "source_files are {'a': 5}, expected hashes by file"),
        ("episodes", {"count": 9, "probe": {"seed": -1}}, "probe is {'seed': -1}, expected seed, stream and"),
        (
            "episodes",
            {"count": 9, "probe": PROBE | {"objects": 10**9}},
            "expected seed, stream and the numbers of some",
        ),
        (
            "episodes",
            {"count": 9, "probe": PROBE | {"profile": ["x"]}},
            "expected seed, stream and the numbers of some",
        ),
        (
            "test",
            {"mae_s": 1, "mean_duration_s": 1, "interval90_factor": "x"},
            "interval90_factor is 'x', expected a nu",
        ),
        ("feature_units", None, "feature_units is None, expected an object"),
        ("feature_units", {"d": "m"}, "feature_units has 1 entries, expected 7 by its features 'projective-periodic'"),
    ],
)
def test_a_card_whose_parts_are_of_another_shape_is_refused(zoo: Path, key: str, value: object, message: str) -> None:
    changed_card(duration(zoo), **{key: value})
    with pytest.raises(UsageError, match="card's") as caught:
        runtime.load_model(duration(zoo))
    assert message in str(caught.value)


def test_a_success_model_without_its_threshold_is_refused(zoo: Path) -> None:
    path = zoo / "agilo" / "approachBall" / "success.onnx"
    changed_card(path, threshold="high")
    with pytest.raises(UsageError, match="threshold is 'high', expected a number"):
        runtime.load_model(path)


def test_a_model_that_has_not_seen_what_its_action_asks_for_moves_no_robot(zoo: Path) -> None:
    """The executive, and whatever else composes models, asks the domain for the ranges."""
    arguments = read_card(card_path(duration(zoo)))["arguments"]
    changed_card(duration(zoo), arguments=[{**a, **({"upper": 0.2} if a["name"] == "vg" else {})} for a in arguments])
    with pytest.raises(UsageError, match=r"vg was trained in \[0, 0.2\] m/s, expected to cover \[0, 0.6\]"):
        load_models("agilo", str(zoo))
    assert main(["models", "check", "agilo/goToPose", "--zoo", str(zoo)]) == 1


def test_a_model_with_an_argument_that_its_action_has_no_more_is_refused_before_a_tick(
    zoo: Path, monkeypatch, capsys
) -> None:
    soccer = domains.load("soccer")
    action = soccer.actions["goToPose"]
    fewer = dataclasses.replace(action, parameters=action.parameters[:-1])
    changed = dataclasses.replace(soccer, actions={**soccer.actions, action.name: fewer})
    monkeypatch.setattr(domains, "load", lambda _: changed)
    taken = r"takes x y phi v xg yg phig vg, expected x y phi v xg yg phig by the action goToPose"
    with pytest.raises(UsageError, match=f"goToPose/duration: {taken}"):
        load_models("agilo", str(zoo))
    assert main(["models", "check", "agilo/goToPose", "--zoo", str(zoo)]) == 1
    assert "takes x y phi v xg yg phig vg, expected" in capsys.readouterr().out


@pytest.mark.promise("P40")
def test_an_oversized_card_is_refused_before_it_is_read(zoo: Path) -> None:
    with card_path(duration(zoo)).open("wb") as file:
        file.truncate(1 << 30)
    with pytest.raises(UsageError, match="expected at most"):
        runtime.load_robot("agilo", zoo)


@pytest.mark.promise("P40")
@pytest.mark.parametrize("name", ["../../etc/passwd", "agilo/goToPose", "agilo/../duration", "agilo/goToPose/x"])
def test_a_name_cannot_leave_the_zoo(name: str) -> None:
    with pytest.raises(UsageError, match="names no model"):
        runtime.load_model(name)


def test_an_unknown_robot_is_told_with_those_that_there_are() -> None:
    with pytest.raises(UsageError, match=r"no action models for robot 'r2d2'.*agilo"):
        runtime.load_robot("r2d2")


def test_golden_examples_hold_the_degenerate_case() -> None:
    golden = np.array(read_card(SHIPPED / "goToPose" / "duration.card.json")["golden"]["arguments"])
    assert projective(golden)[-1, 2] == 0


def test_a_card_keeps_the_name_of_a_recording_that_is_no_utf_8(zoo: Path) -> None:
    """Training ended in a traceback, after the model was written."""
    sources = [{"source": "recordings", "recordings": ["monday-\udcff.mcap"]}]
    changed_card(duration(zoo), episodes={"count": 9, "sources": sources})
    assert read_card(card_path(duration(zoo)))["episodes"]["sources"] == sources
