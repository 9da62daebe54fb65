"""Data sets of episodes: what is damaged, of something else, or there twice is refused in one line that names it."""

import errno
import json
import os
import re
import shutil
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from tailor.models.episodes import part_reader
from tailor.models.episodes.episodes import DataSet, Episode, merge, read_data_set, write_part
from tailor.models.episodes.manifest import MANIFEST, write_manifest
from tailor.schemas.errors import UsageError
from tests.support import standin

NAMES = ["x", "y", "phi", "v", "xg", "yg", "phig", "vg"]
PART = "part-000000-000006.parquet"


def make(folder: Path, action: str = "goToPose", robot: str = "toy", seed: int = 1) -> Path:
    """A data set of six episodes of the stand-in."""
    folder.mkdir(parents=True)
    made = [Episode(k, t[0], t, d, ok, "") for k, (t, d, ok) in enumerate(standin.episodes(6, seed))]
    write_part(folder / PART, made, NAMES)
    arguments = [{"name": name, "unit": "m", "lower": -4.0, "upper": 4.0} for name in NAMES]
    about = {"robot": robot, "action": action, "arguments": arguments, "seed": seed, "source": "stand-in"}
    write_manifest(folder, about)
    return folder


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return make(tmp_path / "goToPose")


def flip(path: Path) -> None:
    """One bit within the data of the first page."""
    content = bytearray(path.read_bytes())
    content[300] ^= 4
    path.write_bytes(content)


def truncate(path: Path) -> None:
    path.write_bytes(path.read_bytes()[:-100])


def change(column: str, value: object) -> Callable[[Path], None]:
    """One cell, or the column away when the value is None."""

    def apply(path: Path) -> None:
        table = pq.read_table(path)
        place = table.column_names.index(column)
        if value is None:
            table = table.remove_column(place)
        else:
            cells = table[column].to_pylist()
            cells[3] = value
            table = table.set_column(place, column, pa.array(cells))
        pq.write_table(table, path)

    return apply


def twice(path: Path) -> None:
    table = pq.read_table(path)
    pq.write_table(table.append_column("xg", table["xg"]), path)


def change_all(column: str, value: list[object]) -> Callable[[Path], None]:
    """Other cells of all episodes; each of them may have several ticks."""

    def apply(path: Path) -> None:
        table = pq.read_table(path)
        cells = [value[number] for number in table["episode"].to_pylist()]
        pq.write_table(table.set_column(table.column_names.index(column), column, pa.array(cells)), path)

    return apply


def no_utf_8(path: Path) -> None:
    table = pq.read_table(path)
    damaged = pa.array([b"\xff"] * table.num_rows).view(pa.string())
    pq.write_table(table.set_column(table.column_names.index("failure"), "failure", damaged), path)


@pytest.mark.parametrize(
    ("damage", "message"),
    [
        (flip, "cannot be read"),
        (truncate, "cannot be read"),
        (lambda path: path.write_bytes(b""), "cannot be read"),
        (lambda path: pq.write_table(pa.table({"a": [1]}), path), "lacks episode, success"),
        (lambda path: pq.write_table(pq.read_table(path).slice(0, 0), path), "lacks rows"),
        (change("xg", None), "lacks xg"),
        (change("xg", float("nan")), "column xg holds values that are not finite numbers"),
        (change_all("duration_s", [1.0] * 5 + [-1.0]), "column duration_s holds negative numbers, expected seconds"),
        (change_all("episode", ["x"] * 6), "column episode holds string, expected integers in every row"),
        (change_all("episode", [float("nan")] * 6), "column episode holds double, expected integers in every row"),
        (change_all("episode", [0, None, 2, 3, 4, 5]), "column episode holds int64, expected integers in every row"),
        (change("tick", None), "lacks tick, expected a part of a data set"),
        (change("tick", 2), "column tick holds 2 in row 3, of episode 0, expected 3"),
        (change("tick", 5), "column tick holds 5 in row 3, of episode 0, expected 3"),
        (change("tick", -1), "column tick holds -1 in row 3, of episode 0, expected 3"),
        (change("tick", 0.5), "column tick holds double, expected integers in every row"),
        (change_all("tick", [1] * 6), "column tick holds 1 in row 0, of episode 0, expected 0"),
        (change_all("success", ["no"] * 6), "column success holds string, expected true or false in every row"),
        (change_all("failure", [1] * 6), "column failure holds int64, expected text in every row"),
        (twice, "cannot be read .(Multiple matches for|Can't unify schema with duplicate field names)"),
        (change_all("work_j", ["x"] * 6), "column work_j holds string, expected numbers"),
        (change("xg", 1e10), "column xg holds numbers beyond 1e.09, expected smaller ones"),
        (change_all("duration_s", [1.0] * 5 + [1e39]), "column duration_s holds numbers beyond 1e.09"),
        (change_all("work_j", [float("nan")] * 5 + [-1e300]), "column work_j holds numbers beyond 1e.09"),
        (no_utf_8, "cannot be read .*Invalid UTF8 sequence"),
        (
            change("duration_s", 2.5),
            r"column duration_s holds 2.5 in row 3, of episode 0, expected .*",
        ),
        (
            change("success", False),
            "column success holds False in row 3, of episode 0, expected True",
        ),
        (change("finished", False), "column finished holds False in row 3, of episode 0, expected True"),
        (
            change("failure", "fell"),
            "column failure holds 'fell' in row 3, of episode 0, expected ''",
        ),
        (
            change("asked_xg", 2.5),
            r"column asked_xg holds 2.5 in row 3, of episode 0, expected .*",
        ),
        (change_all("in_context", [1] * 6), "column in_context holds int64, expected true or false in every row"),
    ],
)
def test_a_damaged_part_is_named(folder: Path, damage: Callable[[Path], object], message: str) -> None:
    damage(folder / PART)
    with pytest.raises(UsageError, match=message) as caught:
        read_data_set(folder)
    assert str(folder / PART) in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    "make_one",
    [os.mkfifo, Path.mkdir, lambda path: path.symlink_to("/dev/zero"), lambda path: path.symlink_to(path.name)],
    ids=["pipe", "folder", "device", "loop"],
)
def test_a_part_that_is_no_file_is_refused_unread(
    folder: Path, monkeypatch, make_one: Callable[[Path], object]
) -> None:
    """Training waited for ever for a pipe, and took all memory for a device without an end."""
    monkeypatch.setattr("tailor.models.episodes.episodes.read_part", lambda *_: pytest.fail("it is read"))
    make_one(folder / "part-000006-000012.parquet")
    with pytest.raises(UsageError, match=r"part-000006-000012\.parquet: is no file, expected a part of a data set"):
        read_data_set(folder)


def test_a_manifest_that_is_a_pipe_is_none(folder: Path, monkeypatch) -> None:
    """It was waited for without end."""
    monkeypatch.setattr("tailor.models.episodes.manifest.read_json", lambda *_: pytest.fail("it is read"))
    (folder / MANIFEST).unlink()
    os.mkfifo(folder / MANIFEST)
    with pytest.raises(UsageError, match=r"no manifest.json, expected a data set"):
        read_data_set(folder)


def test_a_part_that_no_memory_holds_is_refused_unread(folder: Path, monkeypatch) -> None:
    """Two megabytes of equal numbers may be twenty million rows, which take gigabytes."""
    monkeypatch.setattr(part_reader, "MAX_ROWS", 5)
    monkeypatch.setattr(pq, "read_table", None)
    with pytest.raises(UsageError, match=r"part-000000-000006.parquet: has \d+ rows, expected at most 5 in a part"):
        read_data_set(folder)


def test_a_part_whose_compressed_rows_no_memory_holds_is_refused_unread(folder: Path, monkeypatch) -> None:
    monkeypatch.setattr(part_reader, "MAX_BYTES", 500)
    monkeypatch.setattr(pq, "read_table", None)
    with pytest.raises(
        UsageError, match=r"part-000000-000006.parquet: holds \d+ bytes, expected at most 500 in a part"
    ):
        read_data_set(folder)


def test_a_long_text_that_a_part_holds_once_is_not_put_into_every_row(folder: Path, monkeypatch) -> None:
    """A file of 270 kB made training ask for 12 GB."""
    change_all("failure", ["x" * 2001] * 6)(folder / PART)
    assert read_data_set(folder).episodes[0].failure == "x" * 2001, "what an action states as it fails has up to 2000"
    change_all("failure", ["x" * 100_000] * 6)(folder / PART)
    monkeypatch.setattr(part_reader, "MAX_BYTES", 400_000)
    with pytest.raises(UsageError, match=r"column failure holds 100000 characters, too many for each of 402 rows"):
        read_data_set(folder)


def test_of_columns_that_are_not_learned_from_nothing_is_read(folder: Path, monkeypatch) -> None:
    read, columns = pq.read_table, []
    table = read(folder / PART)
    pq.write_table(table.append_column("photo", pa.array(["x"] * table.num_rows)), folder / PART)

    def noted(*arguments: object, **options: object) -> pa.Table:
        columns.extend((found := read(*arguments, **options)).column_names)
        return found

    monkeypatch.setattr(pq, "read_table", noted)
    assert len(read_data_set(folder).episodes) == 6
    assert "failure" in columns
    assert "photo" not in columns


@pytest.mark.filterwarnings("error")
def test_numbers_of_episodes_may_be_unsigned(folder: Path) -> None:
    table = pq.read_table(folder / PART)
    unsigned = table["episode"].cast(pa.uint8())
    pq.write_table(table.set_column(table.column_names.index("episode"), "episode", unsigned), folder / PART)
    assert [episode.number for episode in read_data_set(folder).episodes] == list(range(6))


def test_a_part_knows_which_episodes_were_decided_beside_objects_and_an_older_one_does_not(folder: Path) -> None:
    change_all("in_context", [True, False] * 3)(folder / PART)
    assert [episode.in_context for episode in read_data_set(folder).episodes] == [True, False] * 3
    change("in_context", None)(folder / PART)
    assert not any(episode.in_context for episode in read_data_set(folder).episodes)


@pytest.mark.parametrize(
    ("key", "value", "message"),
    [
        ("robot", 1, "robot is 1, expected a letter"),
        ("robot", "../agilo", "robot is '../agilo', expected a letter, then letters, digits, - and _"),
        ("action", "../../reach", "action is '../../reach', expected a letter, then letters"),
        ("action", "", "action is '', expected a letter"),
        ("seed", "x", "seed is 'x', expected a whole number"),
        ("stream", 1.5, "stream is 1.5, expected a whole number"),
        ("action", "1st", "action is '1st', expected a letter, then letters"),
        ("on_policy", "no", "on_policy is 'no', expected true or false, or 0 for false"),
        ("on_policy", 3, "on_policy is 3, expected true or false"),
        ("arguments", 5, "arguments is 5, expected a list of name, unit, lower, upper"),
        ("arguments", [], "arguments is"),
        (
            "arguments",
            2 * [{"name": "x", "unit": "m", "lower": 0, "upper": 1}],
            "argument x is there twice, expected once",
        ),
        ("arguments", [{"name": "x"}], "argument {'name': 'x'}, expected name, unit, and numbers lower <= upper"),
        ("arguments", [{"name": "x", "unit": "m", "lower": 1, "upper": 0}], "expected name, unit, and numbers lower"),
        ("arguments", [{"name": "x", "unit": "m", "lower": 0, "upper": float("inf")}], "and numbers lower <= upper"),
        ("arguments", [{"name": "x", "unit": "m", "lower": 0, "upper": 10**400}], "and numbers lower <= upper"),
        (
            "arguments",
            [{"name": "x", "unit": "m", "lower": -1e300, "upper": 0}],
            "expected numbers from -1e+09 to 1e+09",
        ),
        ("episodes", "x", "episodes is 'x', expected a whole number"),
        ("objects", 2, "objects is 2, expected none without names in `context`"),
        ("context", {"names": ["x"], "failure": "bump"}, "expected the names of the last arguments, and a failure"),
        ("context", {"names": ["vg"], "failure": ""}, "expected the names of the last arguments, and a failure"),
        ("context", {"names": NAMES, "failure": "bump"}, "expected the names of the last arguments, and a failure"),
        ("objects", 0, "objects is 0, expected a whole number, at least 1"),
        ("scenarios", [5], "scenarios is [5], expected a list of names"),
        ("situations", "x", "situations is 'x', expected a whole number"),
        ("profile", 3, "profile is 3, expected text"),
        ("context", {"names": "x"}, "expected names of columns, and a failure"),
        ("source_sha256", [], "source_sha256 is [], expected text"),
        ("source_files", [1], "source_files is [1], expected an object"),
        ("source_files", {"body.py": 1}, "source_files is {'body.py': 1}, expected an object of hashes by file"),
    ],
)
def test_a_manifest_that_is_not_one_says_what_is_wrong(folder: Path, key: str, value: object, message: str) -> None:
    path = folder / "manifest.json"
    path.write_text(json.dumps({**json.loads(path.read_text()), key: value}))
    with pytest.raises(UsageError, match="not a manifest") as caught:
        read_data_set(folder)
    assert message in str(caught.value)


def test_a_manifest_that_cannot_be_read_is_named(folder: Path) -> None:
    (folder / "manifest.json").write_text("[" * 100_000)
    with pytest.raises(UsageError, match=r"manifest\.json: not JSON that can be read: nested too deeply"):
        read_data_set(folder)


def test_an_episode_that_is_there_twice_would_be_in_training_and_test(folder: Path) -> None:
    shutil.copy(folder / PART, folder / "part-000006-000012.parquet")
    with pytest.raises(UsageError, match="holds episode 0 twice"):
        read_data_set(folder)


def test_two_data_sets_of_one_seed_hold_the_same_episodes(folder: Path, tmp_path: Path) -> None:
    same = read_data_set(folder)
    longer = read_data_set(make(tmp_path / "longer"))
    other = read_data_set(make(tmp_path / "other", seed=2))
    assert len(merge([same, other]).episodes) == 12
    assert len(np.unique([e.number for e in merge([same, other]).episodes])) == 12
    for twice in ([same, same], [same, other, longer]):
        with pytest.raises(UsageError, match=r"hold the same episodes of goToPose \(seed 1\)"):
            merge(twice)


def test_an_episode_of_two_data_sets_would_be_in_training_and_test(folder: Path, tmp_path: Path) -> None:
    """Recordings that are in both, say, or scenarios that one of them ran among others."""
    one, other = read_data_set(folder), read_data_set(make(tmp_path / "other", seed=2))
    shared = DataSet(other.manifest, (*other.episodes[:4], *one.episodes[4:]), "both")
    with pytest.raises(UsageError, match="two data sets hold 2 same episodes of goToPose, expected each once"):
        merge([one, shared])


def test_runs_of_one_seed_begin_alike_whatever_chose_in_them(folder: Path, tmp_path: Path) -> None:
    """Greedy and refined runs, say, or the rounds of two models: nearly the same episodes would judge a model."""

    def runs(data: DataSet, first: int, **entries: object) -> DataSet:
        numbered = (replace(each, number=100 * (first + k)) for k, each in enumerate(data.episodes))
        about = {"on_policy": True, "domain": "toy", "seed": 7, "scenarios": ["a"], **entries}
        return DataSet({**data.manifest, **about}, tuple(numbered), str(first))

    one, other = read_data_set(folder), read_data_set(make(tmp_path / "other", seed=2))
    refined = runs(one, 0, source="refined choices")
    greedy = {"source": "greedy choices", "horizon": 1}
    with pytest.raises(UsageError, match=r"goToPose of 2 runs from the same starts \(seed 7\).*another --seed"):
        merge([refined, runs(other, 4, **greedy)])
    apart = (runs(other, 6, **greedy), runs(other, 4, **greedy, seed=8), runs(other, 4, **greedy, on_policy=False))
    for distinct in (*apart, runs(other, 4, seed=None, source="recordings")):
        assert len(merge([refined, distinct]).episodes) == 12


def test_random_tasks_beside_an_object_are_those_without_it(folder: Path, tmp_path: Path) -> None:
    alone, beside = read_data_set(folder), read_data_set(make(tmp_path / "beside", seed=2))
    alone = replace(alone, manifest={**alone.manifest, "source": "lock-step, random arguments"})
    source = "lock-step, random arguments beside one object"
    same, others = (replace(beside, manifest={**beside.manifest, "source": source, "seed": seed}) for seed in (1, 2))
    assert len(merge([alone, others]).episodes) == 12
    with pytest.raises(UsageError, match=r"hold the same episodes of goToPose \(seed 1\)"):
        merge([alone, same])


def test_rounds_in_which_an_action_never_ran_are_no_copies_of_one_another(folder: Path, tmp_path: Path) -> None:
    def without_episodes(seed: int) -> DataSet:
        made = make(tmp_path / str(seed), seed=seed)
        (made / PART).unlink()
        return read_data_set(made)

    merged = merge([read_data_set(folder), without_episodes(2), without_episodes(3)])
    assert (len(merged.episodes), len(merged.manifest["sources"])) == (6, 3)
    with pytest.raises(UsageError, match=r"hold the same episodes of goToPose \(seed 2\)"):
        merge([read_data_set(folder), *[read_data_set(tmp_path / "2")] * 2])


@pytest.mark.parametrize(("owner", "at"), [(os, "fsync"), (Path, "replace")])
def test_a_full_disk_is_named_with_the_file_and_leaves_nothing_half_written(
    folder: Path, monkeypatch, owner: object, at: str
) -> None:
    before = {path.name: path.read_bytes() for path in folder.iterdir()}

    def full(*_: object) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))  # as a write says it: of no file

    monkeypatch.setattr(owner, at, full)
    episode = Episode(9, np.zeros(8), np.zeros((3, 8)), 1.0, True, "")
    for path, write in (
        (folder / "part-000009.parquet", lambda: write_part(folder / "part-000009.parquet", [episode], NAMES)),
        (folder / "manifest.json", lambda: write_manifest(folder, {"robot": "other"})),
    ):
        with pytest.raises(
            UsageError, match=re.escape(f"{path}: No space left on device, expected a file that can be")
        ):
            write()
    monkeypatch.undo()
    assert {path.name: path.read_bytes() for path in folder.iterdir()} == before
