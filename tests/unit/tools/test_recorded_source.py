"""A difference from a recording names what lies between its source and today's."""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import pytest

from tailor.schemas.installed import core_source as module
from tailor.schemas.installed.core_source import core_source
from tailor.schemas.installed.source import ROOT
from tailor.tools.recordings.differences import Difference
from tailor.tools.recordings.recorded_source import UNSTATED, source_contrast, source_entry
from tailor.tools.recordings.verification import Verdict, verdict_text

TODAY = {"executive/core": "aa", "executive/domains/soccer": "bb"}


@pytest.mark.parametrize("recorded", [None, "0.1.0", {}, {"folders": "aa"}, {"folders": ["aa"]}, [1], 7])
def test_a_recording_that_states_no_source_is_not_guessed_at(recorded):
    assert source_contrast(recorded, TODAY, same_kind=True) == UNSTATED


def test_a_difference_under_the_same_source_is_a_fault():
    assert source_contrast(source_entry(TODAY), TODAY, same_kind=True).endswith("which is a fault")


def test_a_difference_on_a_platform_that_rounds_otherwise_need_not_be_one():
    text = source_contrast(source_entry(TODAY), TODAY, same_kind=False)
    assert "by this very source" in text
    assert "fault" not in text
    other = source_entry({**TODAY, "executive/core": "cc"})
    assert "another executive/core" in source_contrast(other, TODAY, same_kind=False)


@pytest.mark.parametrize(
    ("folders", "named"),
    [
        ({**TODAY, "executive/core": "cc"}, "another executive/core"),
        ({"executive/core": "aa"}, "another executive/domains/soccer"),
        ({**TODAY, "executive/lost": "cc"}, "another executive/lost"),
        (dict.fromkeys(TODAY, "cc"), "another executive/core, executive/domains/soccer"),
    ],
)
def test_the_folders_that_differ_are_named(folders, named):
    text = source_contrast({"version": "0.0.9", "folders": folders}, TODAY, same_kind=True)
    assert text == f"recorded by tailor 0.0.9 with {named}"


def test_a_hostile_source_gives_one_short_line():
    text = source_contrast({"version": "1" * 10**6, "folders": {"x" * 10**6: 1, 5: None}}, TODAY, same_kind=True)
    assert len(text) < 300


def test_a_hostile_source_controls_no_terminal():
    hostile = "x\nequal: 1 messages\x1b[2J"
    text = source_contrast({"version": hostile, "folders": {**TODAY, hostile: "aa"}}, TODAY, same_kind=True)
    assert text.isprintable()


def test_a_hostile_recording_writes_no_verdict_of_its_own():
    """Recorded values were printed as they are: a line end in one of them could add a line "equal: …"."""
    forged = "x\nequal: 1 messages\x1b[2J"
    difference = Difference(1, "exec/status", "goal", forged, forged)
    verdict = Verdict("ab" * 16, 1, 1, 0, difference, forged, forged, 1.0, forged)
    for each in (verdict, replace(verdict, difference=None), replace(verdict, difference=None, rounded=1)):
        first, *others = verdict_text(each).splitlines()
        assert not any(line.startswith("equal") for line in others)
        assert all(line.isprintable() for line in (first, *others))


@pytest.fixture
def copy(tmp_path, monkeypatch):
    """A copy of what is hashed, in which files may be changed."""
    for start in ("executive/core", "executive/planning", "schemas/messages"):
        shutil.copytree(ROOT / start, tmp_path / start, ignore=shutil.ignore_patterns("__pycache__"))
    monkeypatch.setattr(module, "ROOT", tmp_path)
    return tmp_path


@pytest.mark.parametrize("file", ["executive/core/modes.py", "executive/planning/pddl/language.py"])
def test_a_changed_file_changes_its_folder_and_no_other(copy, file):
    before = core_source("soccer")
    (copy / file).open("a").write("x = 1")
    after = core_source("soccer")
    assert [name for name in before if before[name] != after[name]] == ["/".join(file.split("/")[:2])]


def test_a_renamed_file_changes_its_folder(copy):
    before = core_source("soccer")
    (copy / "executive" / "core" / "modes.py").rename(copy / "executive" / "core" / "modes_.py")
    assert core_source("soccer")["executive/core"] != before["executive/core"]


def test_what_an_editor_leaves_beside_a_file_hinders_no_start(copy):
    before = core_source("soccer")
    (copy / "executive" / "core" / ".#modes.py").symlink_to("somebody@elsewhere")
    assert core_source("soccer") == before


def test_a_file_that_may_not_be_read_hinders_no_start(copy, monkeypatch):
    before, read = core_source("soccer"), Path.read_bytes

    def refusing(path):
        if path.name == "modes.py":
            raise PermissionError
        return read(path)

    monkeypatch.setattr(Path, "read_bytes", refusing)
    after = core_source("soccer")
    assert [name for name in before if before[name] != after[name]] == ["executive/core"]


def test_of_a_domain_in_a_module_alone_only_that_module_counts(tmp_path, monkeypatch):
    (tmp_path / "lonely.py").write_text("DOMAIN = 1")
    (tmp_path / "neighbour.py").write_text("x = 1")
    monkeypatch.syspath_prepend(str(tmp_path))
    monkeypatch.setattr(module, "spec_of", lambda name: SimpleNamespace(domain="lonely:DOMAIN"))
    first = core_source("lonely")
    (tmp_path / "neighbour.py").write_text("x = 2")
    assert core_source("lonely") == first
    (tmp_path / "lonely.py").write_text("DOMAIN = 2")
    assert {name for name, hash in core_source("lonely").items() if hash != first[name]} == {"lonely.py"}


def test_a_robot_has_the_source_of_its_own_domain_and_of_no_other():
    soccer, kitchen = core_source("soccer"), core_source("kitchen")
    assert {name: hash for name, hash in soccer.items() if "domains" not in name} == {
        name: hash for name, hash in kitchen.items() if "domains" not in name
    }
    assert [name for name in soccer if "domains" in name] == ["executive/domains/soccer"]
    assert {"executive", "executive/core", "executive/refinement", "robots", "schemas/messages"} < soccer.keys()
