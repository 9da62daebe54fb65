"""`tailor view` and `tailor why` on recordings: their output and their errors."""

from __future__ import annotations

import argparse
import dataclasses
import errno
import json
import os
import re
import shutil
import tracemalloc
from pathlib import Path
from types import SimpleNamespace

import pytest

from tailor.runtime.bus.attachment import Origin, pack
from tailor.runtime.bus.encoding import encoding_of
from tailor.runtime.bus.inbox import Raw
from tailor.runtime.recordings.mcap.writer import McapWriter
from tailor.runtime.recordings.recording import open_recording
from tailor.schemas.codec import encode
from tailor.schemas.errors import UsageError
from tailor.schemas.installed import spec_of
from tailor.tools.commands.look import compare, cut, picture, scene, view, why
from tailor.tools.figures import alternatives
from tailor.tools.main import main
from tailor.tools.scenes import robot_scenes
from tailor.tools.viewer.timeline import Event
from tests.support import synthetic_run

SENDERS = {"exec/": "ab" * 16}
OTHER = "cd" * 16  # another executive
BEGIN_NS = 1_700_000_000_000_000_000


@pytest.fixture(scope="module")
def recording(tmp_path_factory) -> Path:
    """A recording of the soccer run; its provenance names models that do not exist."""
    return written(tmp_path_factory.mktemp("recordings") / "run.mcap", synthetic_run.soccer_run())


def written(path, run, others=()) -> Path:
    """A recording of messages, and of those of another executive."""
    writer = McapWriter(path, {})
    every = [(t, synthetic_run.SENDER) for t in run] + [(t, OTHER) for t in others]
    for number, (t, sender) in enumerate(every):
        origin = pack(Origin(number, BEGIN_NS, sender))
        raw = Raw(t.key, encode(t.message), origin, encoding_of(type(t.message)), True, None)
        writer.write(raw, BEGIN_NS + t.time_ns)
    writer.close()
    return path


def run(command, *words) -> int:
    parser = argparse.ArgumentParser()
    command.configure(parser)
    return command.run(parser.parse_args([str(word) for word in words]))


def data_in(html: Path) -> dict:
    return json.loads(re.search(r'id="data">(.*?)</script>', html.read_text(), re.DOTALL)[1])


def test_view_writes_the_whole_run_into_one_page(recording, tmp_path, capsys) -> None:
    output = tmp_path / "folder" / "page.html"
    assert run(view, recording, "--output", output, "--no-models") == 0
    assert capsys.readouterr().out.strip() == str(output)
    samples = data_in(output)["samples"]
    published = list(synthetic_run.soccer_run())
    assert max(sum(block["at"]) for block in samples) / 1e3 == pytest.approx(published[-1].time_ns / 1e9)
    ticks = [block["length"] for block in samples if block["kind"] == "tick"]
    assert sum(ticks) == sum("tick" in t.key for t in published)


def torn(recording: Path, folder: Path) -> Path:
    """Its first two thirds."""
    path = folder / "torn.mcap"
    path.write_bytes(recording.read_bytes()[: 2 * recording.stat().st_size // 3])
    return path


def test_the_readable_part_of_a_damaged_recording_never_passes_for_the_whole(recording, tmp_path, capsys) -> None:
    part, output = torn(recording, tmp_path), tmp_path / "torn.html"
    assert run(view, part, "-o", output, "--no-models") == 0
    told = capsys.readouterr().err.replace("\n", "")
    assert "torn.mcap is damaged: no footer" in told
    assert "only its readable messages are shown" in told
    (damage,) = [fields["text"] for _, kind, fields in data_in(output)["rows"] if kind == "damage"]
    assert damage in told
    assert run(view, recording, "-o", output, "--no-models") == 0
    assert "damaged" not in capsys.readouterr().err + output.read_text().partition('id="data"')[2].partition("<")[0]


def test_a_page_of_several_executives_says_so(recording, tmp_path, capsys) -> None:
    """As of one that was started anew: the page passed for that of a single run."""
    later = [dataclasses.replace(t, time_ns=t.time_ns + 20 * 10**9) for t in synthetic_run.soccer_run()]
    both, output = written(tmp_path / "both.mcap", synthetic_run.soccer_run(), later), tmp_path / "both.html"
    assert run(view, both, "-o", output, "--no-models") == 0
    told = " ".join(capsys.readouterr().err.split())
    assert re.search(r"both.mcap holds runs of 2 executives: abababab from 0\.\d s on, cdcdcdcd from 20\.\d s on", told)
    (text,) = [fields["text"] for _, kind, fields in data_in(output)["rows"] if kind == "damage"]
    assert text in told
    for words in (both, "--sender", "cd"), (recording,):
        assert run(view, *words, "-o", output, "--no-models") == 0
        assert "executives" not in capsys.readouterr().err


def test_pictures_and_scenes_of_a_damaged_recording_say_so(recording, tmp_path, capsys) -> None:
    part = torn(recording, tmp_path)
    assert run(picture, part, "-o", tmp_path / "torn.png") == 0
    assert "torn.mcap is damaged" in capsys.readouterr().err
    assert run(scene, part, "-o", tmp_path / "scene.mcap") == 0
    assert "torn.mcap is damaged" in capsys.readouterr().err
    copies = dict(open_recording(tmp_path / "scene.mcap").metadata())
    assert copies["copy"]["damage"].startswith("no footer"), "the copy itself is whole"


def test_runs_side_by_side_are_named_without_their_folder(recording, tmp_path) -> None:
    other = tmp_path / "other.mcap"
    other.write_bytes(recording.read_bytes())
    output = tmp_path / "runs.html"
    assert run(view, recording, other, "-o", output, "--no-models") == 0
    assert [each["title"] for each in data_in(output)["pages"]] == ["run.mcap", "other.mcap"]
    assert str(tmp_path) not in output.read_text()
    twin = tmp_path / "twin" / "run.mcap"
    twin.parent.mkdir()
    twin.write_bytes(recording.read_bytes())
    assert run(view, recording, twin, "-o", output, "--no-models") == 0
    assert [each["title"] for each in data_in(output)["pages"]] == [str(recording), str(twin)]


def test_a_scene_that_cannot_be_drawn_is_reported(recording, tmp_path, capsys, monkeypatch) -> None:
    def missing(spec, field):
        raise UsageError(f"domain {spec.name}: {field} = 'x.missing': No module named 'x'")

    monkeypatch.setattr(robot_scenes, "part", missing)
    spec = dataclasses.replace(spec_of("soccer"), scene="x.missing")
    monkeypatch.setattr(robot_scenes, "spec_of", lambda _: spec)
    assert run(view, recording, "-o", tmp_path / "run.html", "--no-models") == 0
    expected = "the scene of agilo: domain soccer: scene = 'x.missing': No module named 'x'\n"
    assert capsys.readouterr().err == expected


def test_view_puts_the_page_beside_the_recording_by_default(recording, capsys) -> None:
    assert run(view, recording, "--no-models") == 0
    assert recording.with_suffix(".html").exists()
    capsys.readouterr()


def test_view_shows_only_the_requested_executive(tmp_path, capsys) -> None:
    messages = list(synthetic_run.soccer_run())
    [first, *_] = [t for t in messages if t.key == "exec/status"]
    recording, output = written(tmp_path / "two.mcap", messages, [first]), tmp_path / "page.html"
    run(view, recording, "-o", output, "--no-models", "--sender", "cd")
    kinds = {block["kind"] for block in data_in(output)["samples"]}
    assert "tick" not in kinds
    assert "truth" in kinds
    capsys.readouterr()


@pytest.mark.parametrize("command", [view, why])
def test_an_executive_that_is_not_in_the_recording_is_refused(command, recording) -> None:
    """The page of nobody was written over that of the run."""
    known = synthetic_run.SENDER[:8]
    with pytest.raises(UsageError, match=f"no executive whose id begins with 'ef', expected one of: {known}"):
        run(command, recording, "--sender", "ef")


def test_a_robot_that_is_not_in_the_recording_is_refused(recording, tmp_path) -> None:
    with pytest.raises(UsageError, match=r"no message of robot 'b21', expected one of: agilo$"):
        run(view, recording, "-o", tmp_path / "page.html", "--robot", "b21", "--no-models")
    assert not (tmp_path / "page.html").exists()


def test_a_robot_of_which_only_its_odometry_was_recorded_is_in_the_recording(tmp_path, capsys) -> None:
    """Where the executive's belief is drawn, odometry is not read at all."""
    run_of = [t for t in synthetic_run.soccer_run() if t.key.startswith("exec/") or t.key == "agilo/odom"]
    assert any(t.key == "agilo/odom" for t in run_of)
    recording = written(tmp_path / "some.mcap", run_of)
    assert run(view, recording, "--robot", "agilo", "--no-models") == 0
    capsys.readouterr()


def test_a_recording_beside_itself_is_refused(recording) -> None:
    with pytest.raises(UsageError, match=r"run.mcap is there twice, expected each recording once"):
        run(view, recording, recording)


def test_view_is_the_same_page_every_time(recording, tmp_path, capsys) -> None:
    pages = [tmp_path / "a.html", tmp_path / "b.html"]
    for output in pages:
        run(view, recording, "-o", output)
    assert pages[0].read_bytes() == pages[1].read_bytes()
    capsys.readouterr()


@pytest.mark.parametrize("words", [[], ["x.mcap", "--live"], ["--live", "--port", "70000"]])
def test_view_refuses_contradictory_arguments(words) -> None:
    with pytest.raises(UsageError, match="expected"):
        run(view, *words)


@pytest.mark.parametrize(
    ("command", "words", "fault"),
    [
        (view, ["--live", "-o", "a.html"], "--live takes no --output"),
        (scene, ["--live", "-o", "a.mcap"], "--live takes no --output"),
        (scene, ["a.mcap", "--sender", "ab" * 16], "expected it with --live"),
        (scene, ["--layout", "arm", "--profile", "both"], "--profile: expected with --live"),
        (scene, ["a.mcap", "--connect", "tcp/127.0.0.1:1"], "--connect: expected with --live"),
        (view, ["a.mcap", "--key", "k", "--ros-domain", "3"], "--key, --ros-domain: expected with --live"),
        (view, ["a.mcap", "--port", "80"], "--port is that of the live page, expected it with --live"),
    ],
)
def test_what_a_live_page_or_scene_would_ignore_is_refused(command, words, fault) -> None:
    with pytest.raises(UsageError, match=fault):
        run(command, *words)


@pytest.mark.parametrize("command", [view, why])
def test_a_file_that_is_no_recording_is_refused_by_name(command, tmp_path) -> None:
    nothing = tmp_path / "nothing.mcap"
    with pytest.raises(UsageError, match=r"nothing\.mcap"):
        run(command, nothing)
    nothing.write_bytes(b"not a recording")
    with pytest.raises(UsageError, match=r"nothing\.mcap"):
        run(command, nothing)


@pytest.mark.parametrize("command", [view, scene, why])
@pytest.mark.parametrize("folder", [".", "/", ""])
def test_a_folder_is_no_recording(command, folder) -> None:
    """Some have no name, beside which the output would be."""
    with pytest.raises(UsageError, match=r"[./]: Is a directory, expected a recording"):
        run(command, folder)


def test_why_refuses_a_time_before_any_decision(recording) -> None:
    with pytest.raises(UsageError, match=r"no decision before 0\.1 s"):
        run(why, recording, "--at", 0.1)


def test_why_names_the_part_that_cannot_be_loaded(recording) -> None:
    with pytest.raises(UsageError, match="cannot load its domain and models"):
        run(why, recording)


def test_why_refuses_a_picture_of_another_kind_before_it_reads(recording, tmp_path) -> None:
    with pytest.raises(UsageError, match=r"\.png or \.html"):
        run(why, tmp_path / "missing.mcap", "-o", "why.gif")


def test_a_picture_has_the_first_decisions_that_fit_and_a_line_names_the_others(tmp_path, monkeypatch, capsys) -> None:
    """One of an hour of soccer took minutes and gigabytes, and no browser shows it."""
    drawn = []
    monkeypatch.setattr(
        alternatives, "draw_alternatives", lambda explained, path: (drawn.append(explained), path.touch())
    )
    decision = ("3.8 s: approachBall", SimpleNamespace(parameters=(1, 2)))
    why._draw([decision] * (why.MAX_ROWS // 2 + 5), tmp_path / "why.png")
    why._draw([decision] * 3, tmp_path / "why.png")
    assert [len(each) for each in drawn] == [why.MAX_ROWS // 2, 3]
    named = "the first 30 of 35 decisions are drawn; --at T draws one"
    assert capsys.readouterr().err.splitlines() == [f"{tmp_path}/why.png", named, f"{tmp_path}/why.png"]


def test_a_recording_of_any_name_is_shown_drawn_compared_and_copied(recording, tmp_path, capsys) -> None:
    odd = tmp_path / os.fsdecode(b"b\xff$\\frac$.mcap")  # no UTF-8, and no formula either
    shutil.copy(recording, odd)
    page, drawn, copied = tmp_path / "odd.html", tmp_path / "odd.png", tmp_path / "cut.mcap"
    assert run(view, str(odd), "--no-models", "-o", str(page)) == 0
    assert "<title>b\\udcff$\\frac$.mcap" in page.read_text(encoding="utf-8")
    assert run(picture, str(odd), "-o", str(drawn)) == 0
    assert run(cut, str(odd), "-o", str(copied)) == 0
    assert dict(open_recording(copied).metadata())["copy"]["of"] == "b?$\\frac$.mcap"
    named = tmp_path / "\x1b[31m.mcap"
    shutil.copy(recording, named)
    capsys.readouterr()
    assert run(compare, str(odd), str(named), "--plot", str(tmp_path / "compared.png")) == 0
    assert "\x1b" not in capsys.readouterr().out


def test_a_path_that_looks_like_markup_is_shown_and_copied(recording, tmp_path, capsys) -> None:
    """rich reads [/red] as the end of a colour that was never begun; a line of progress ended both in a traceback."""
    odd = tmp_path / "a[" / "red].mcap"
    odd.parent.mkdir()
    shutil.copy(recording, odd)
    assert run(view, odd, "-o", tmp_path / "odd.html") == 0
    assert capsys.readouterr().err.startswith("alternatives are not shown: ")
    assert run(scene, odd, "-o", tmp_path / "odd.mcap") == 0


@pytest.mark.parametrize("others", [[], ["other.mcap"]])
def test_a_page_is_written_while_its_recording_is_read(recording, tmp_path, monkeypatch, capsys, others) -> None:
    """Several copies of a page were in memory at once: 1.4 GB for 100 000 subgoals of 3.5 MB."""
    paths = [recording, *(shutil.copy(recording, tmp_path / name) for name in others)]
    text = "<" * 10_000
    monkeypatch.setattr(view, "recorded_events", lambda *_: (Event(float(i), "goal", {"a": text}) for i in range(1000)))
    tracemalloc.start()
    try:
        assert run(view, "--no-models", "-o", tmp_path / "page.html", *paths) == 0
        assert tracemalloc.get_traced_memory()[1] < 8_000_000
    finally:
        tracemalloc.stop()
    assert (tmp_path / "page.html").stat().st_size > 60_000_000 * len(paths)


def test_a_recording_that_cannot_be_read_on_is_named_and_the_page_that_is_there_stays(
    recording, tmp_path, monkeypatch, capsys
) -> None:
    def broken(*_):
        yield Event(0.0, "goal", {})
        raise OSError(errno.EIO, "Input/output error")

    monkeypatch.setattr(view, "recorded_events", broken)
    page = tmp_path / "page.html"
    page.write_text("before")
    assert main(["view", "--no-models", "-o", str(page), str(recording)]) == 2
    expected = f"tailor view: {recording}: Input/output error, expected a recording that can be read\n"
    assert capsys.readouterr().err == expected
    assert (page.read_text(), list(tmp_path.iterdir())) == ("before", [page])


def test_no_folder_is_made_for_the_page_of_what_is_no_recording(tmp_path, capsys) -> None:
    (tmp_path / "no.mcap").write_text("no recording")
    assert main(["view", "-o", str(tmp_path / "new" / "page.html"), str(tmp_path / "no.mcap")]) == 2
    assert not (tmp_path / "new").exists()
