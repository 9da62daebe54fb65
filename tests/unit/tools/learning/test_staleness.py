"""Stale models: the check names what changed, and a change that leaves all episodes as they were is none."""

import copy
import json
from pathlib import Path

import pytest

from tailor.models.episodes.episodes import merge, read_data_set
from tailor.models.runtime import ZOO
from tailor.schemas.errors import UsageError
from tailor.schemas.installed.changed_source import changed_files
from tailor.tools.launch import stale_models
from tailor.tools.launch.stale_models import stale_models_warning
from tailor.tools.learning import staleness, zoo_checks
from tailor.tools.learning.gathering import random_episodes
from tailor.tools.learning.gathering.data_set_spec import DataSetSpec
from tailor.tools.learning.staleness import differing_episodes
from tailor.tools.learning.staleness import staleness as staleness_of
from tailor.tools.main import main

REACH = "executive/actions/reach.py"


def gather(folder: Path, seed: int) -> Path:
    spec = DataSetSpec("arm", "reach", 8, seed, folder)
    random_episodes.prepare(spec, resume=False)
    list(random_episodes.gather(spec, [0], jobs=1))
    return folder


@pytest.fixture(scope="module")
def data(tmp_path_factory: pytest.TempPathFactory):
    folder = tmp_path_factory.mktemp("data")
    return merge([read_data_set(gather(folder / str(seed), seed)) for seed in (1, 2)])


@pytest.fixture
def card(data):
    episodes = {key: copy.deepcopy(data.manifest[key]) for key in ("sources", "source_files", "probe")}
    return {"robot": "powercube", "action": "reach", "kind": "duration", "episodes": {"count": 16, **episodes}}


@pytest.fixture
def altered(monkeypatch):
    """A source of which one file differs from today's."""
    files = {**staleness.todays_files("arm"), REACH: "0" * 64}
    monkeypatch.setattr(staleness, "todays_files", lambda _: files)
    monkeypatch.setattr(stale_models, "episode_files", lambda _: files)
    return files


def test_a_merged_data_set_names_all_its_sources(data) -> None:
    sources = data.manifest["sources"]
    assert [(s["seed"], s["episodes"], s["on_policy"]) for s in sources] == [(1, 8, 0), (2, 8, 0)]
    assert len({s["sha256"] for s in sources}) == 2
    assert {s["source_sha256"] for s in sources} == data.manifest["source_files"].keys()


def test_a_source_without_a_hash_is_unknown(card, altered) -> None:
    """The check and `tailor up` ended in a KeyError."""
    del card["episodes"]["sources"][1]["source_sha256"]
    assert changed_files(card["episodes"], altered) == [REACH]
    del card["episodes"]["sources"][0]["source_sha256"]
    assert changed_files(card["episodes"], altered) == []


def test_a_model_of_todays_source_is_not_stale(card) -> None:
    assert staleness_of(card) == ""
    assert differing_episodes(card) == ""


def test_a_change_without_effect_on_episodes_makes_no_model_stale(card, altered) -> None:
    assert changed_files(card["episodes"], altered) == [REACH]
    assert staleness_of(card) == ""


@pytest.mark.parametrize("place", [0, -1])
def test_episodes_that_end_otherwise_make_a_model_stale(card, altered, place) -> None:
    card["episodes"]["probe"]["ends"][3][place] += 0.1
    assert staleness_of(card).startswith(f"{REACH} changed since its episodes were simulated, and random episode 3 now")


def test_a_changed_source_without_episodes_to_compare_makes_a_model_stale(card, altered) -> None:
    del card["episodes"]["probe"]
    assert "it holds no random episodes to compare" in staleness_of(card)


def test_episodes_of_many_objects_a_run_are_compared_as_such(tmp_path: Path) -> None:
    spec = DataSetSpec("soccer", "goToPose", 1, 3, tmp_path, beside=True, objects=8)
    random_episodes.prepare(spec, resume=False)
    list(random_episodes.gather(spec, [0], jobs=1))
    episodes = merge([read_data_set(tmp_path)]).manifest
    card = {"robot": "agilo", "action": "goToPose", "episodes": {"probe": episodes["probe"]}}
    assert card["episodes"]["probe"]["objects"] == 8
    assert differing_episodes(card) == ""
    card["episodes"]["probe"]["ends"][5][0] += 0.1
    assert differing_episodes(card).startswith("random episode 5 now")


def test_every_source_of_a_merged_data_set_counts(card) -> None:
    """An audit found cards that stated the first one's alone."""
    files = next(iter(card["episodes"]["source_files"].values()))
    card["episodes"]["sources"][1]["source_sha256"] = "old"
    card["episodes"]["source_files"]["old"] = {**files, REACH: "0" * 12, "gone.py": "1" * 12}
    assert changed_files(card["episodes"], staleness.todays_files("arm")) == [REACH, "gone.py"]


def test_models_of_other_tools_and_of_recordings_are_not_judged(card, altered) -> None:
    assert staleness_of({**card, "episodes": {"count": 16}}) == ""
    for source in card["episodes"]["sources"]:
        source["source"] = "recordings"
    assert staleness_of(card) == ""


def test_a_launch_warns_in_one_line(card, altered, tmp_path: Path, monkeypatch) -> None:
    folder = tmp_path / "powercube" / "reach"
    folder.mkdir(parents=True)
    shipped = json.loads((ZOO / "powercube" / "reach" / "duration.card.json").read_text())
    (folder / "duration.card.json").write_text(json.dumps({**shipped, "episodes": card["episodes"]}))
    (folder / "energy.card.json").write_text("{}")
    assert stale_models_warning("arm", str(tmp_path)) == (
        f"models of reach were learned with another {REACH}: "
        "`tailor models check powercube` states whether they are stale"
    )
    (folder / "duration.card.json").write_text(json.dumps({**shipped, "episodes": {"count": 16}}))
    assert stale_models_warning("arm", str(tmp_path)) == ""


def test_the_command_reports_stale_models(tmp_path: Path, monkeypatch, capsys) -> None:
    monkeypatch.setattr(zoo_checks, "staleness", lambda card: f"{card['action']} is")
    assert main(["models", "check", "powercube/reach", "--json"]) == 1
    message = json.loads(capsys.readouterr().out)
    assert (message["failed"], message["stale"]) == ({}, {"powercube/reach/duration": "reach is"})
    assert main(["models", "check", "powercube/reach"]) == 1
    assert "powercube/reach/duration: stale: reach is" in capsys.readouterr().out


def test_no_model_that_ships_is_stale() -> None:
    cards = [json.loads(path.read_text()) for path in sorted(ZOO.glob("*/*/*.card.json"))]
    stale = {f"{card['robot']}/{card['action']}/{card['kind']}": staleness_of(card) for card in cards}
    assert {name: text for name, text in stale.items() if text} == {}
    runs = [card["episodes"]["count"] for card in cards if card["kind"] != "clearance"]  # that has 20 rows a run
    assert max(runs) <= 3000


def test_a_robot_that_is_not_installed_is_told(card) -> None:
    with pytest.raises(UsageError, match="no robot 'r2d2'"):
        staleness_of({**card, "robot": "r2d2"})


def test_a_model_of_another_profile_is_judged_by_that_body(tmp_path: Path, altered) -> None:
    spec = DataSetSpec("soccer", "goToPose", 6, 1, tmp_path, profile="degraded")
    random_episodes.prepare(spec, resume=False)
    list(random_episodes.gather(spec, [0], jobs=1))
    probe = merge([read_data_set(tmp_path)]).manifest["probe"]
    card = {"robot": "agilo", "action": "goToPose", "episodes": {"probe": probe}}
    assert differing_episodes(card) == ""
    del probe["profile"]
    assert "random episode 0 now takes" in differing_episodes(card)
