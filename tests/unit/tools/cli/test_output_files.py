"""Files that commands write are whole, or as they were: on a full disk, after Ctrl-C, in place of read-only ones."""

from __future__ import annotations

import argparse
import os
import signal
import subprocess
import sys
from pathlib import Path
from unittest.mock import MagicMock

import numpy as np
import pytest

from tailor.schemas.errors import UsageError
from tailor.tools.cli import output_files
from tailor.tools.cli.output_files import whole_output
from tailor.tools.commands.drivers import check_driver
from tailor.tools.commands.run import demo
from tailor.tools.conformance.report import Report as DriverReport
from tailor.tools.evaluations.pages import overview, plots
from tailor.tools.evaluations.pages.report import Report, publish_report
from tailor.tools.figures import letters
from tailor.tools.figures.learned_models import reports
from tailor.tools.figures.recorded_track import recorded_track
from tailor.tools.main import main
from tailor.tools.writing.writing_track import WritingTrack
from tests.support.injection.signals import heeded_signals
from tests.support.injection.small_disk import small_disk

GOLDEN = str(Path(__file__).parents[3] / "data" / "golden" / "soccer-approach.mcap")
CHOICES = GOLDEN.replace("approach", "approach-dribble")


@pytest.mark.parametrize(
    ("words", "name"),
    [
        (("picture", GOLDEN, "-o"), "x.png"),
        (("compare", GOLDEN, GOLDEN, "--json", "--plot"), "x.png"),
        (("why", CHOICES, "--at", "2", "-o"), "x.png"),
        (("why", CHOICES, "--at", "2", "-o"), "x.html"),
        (("view", GOLDEN, "-o"), "x.html"),
        (("scene", "--layout", "soccer", "-o"), "x.json"),
        (("models", "plot", "agilo/goToPose", "--out"), "agilo-goToPose-duration-figure7.png"),
    ],
    ids=" ".join,
)
def test_a_full_disk_is_named_in_one_line_and_takes_no_file_of_the_user(words, name, tmp_path, capsys):
    """The former picture was gone, or half of a page stood in its place; the line named no file."""
    output = tmp_path / name
    output.write_bytes(b"the former one")
    with small_disk(1000):
        assert main([*words, str(tmp_path if words[-1] == "--out" else output)]) == 2
    lines = capsys.readouterr().err.splitlines()
    assert [line for line in lines if f"{output}: File too large, expected a file that can be written" in line]
    assert output.read_bytes() == b"the former one"
    assert list(tmp_path.iterdir()) == [output]


@pytest.mark.parametrize(
    "words",
    [("compare", GOLDEN, GOLDEN, "--json", "--plot"), ("why", CHOICES, "--at", "2", "--json", "-o")],
    ids=" ".join,
)
def test_a_command_whose_picture_cannot_be_written_prints_no_result(words, tmp_path, capsys):
    """It printed the JSON of a success, and then failed."""
    (tmp_path / "file").touch()
    assert main([*words, str(tmp_path / "file" / "x.png")]) == 2
    assert capsys.readouterr().out == ""


def letter():
    ways = np.zeros((3, 2))
    times = np.arange(3.0)
    return WritingTrack("hand", "T", "achieved", times, ways, ways, ways, times, times, 0.0)


def checked(report, monkeypatch):
    """Check a driver that is not there, with all it does on the bus left out."""
    for name in ("open_bus", "LiveLink", "Bench", "_check_free"):
        monkeypatch.setattr(check_driver, name, lambda *_: MagicMock())
    monkeypatch.setattr(check_driver, "_is_simulator", lambda *_: True)
    monkeypatch.setattr(check_driver, "_checked", lambda *_: DriverReport("agilo" * 300, "simulator", ()))
    parser = argparse.ArgumentParser()
    check_driver.configure(parser)
    check_driver.run(parser.parse_args(["agilo", "--report", str(report)]))


def _publish(folder):
    publish_report(Report("t", "T", (), ["long"], {}, {}), argparse.Namespace(json=True, report=folder))


WRITERS = {
    "letters": ("x.png", lambda path, _: letters.draw_letters([[letter()]], path)),
    "bars": ("x.png", lambda path, _: reports.bars(path, ["a"], [1.0], [[0.5, 1.5]])),
    "pairs": ("x.png", lambda path, _: plots.draw_pairs([2.0, 3.0], [1.0, 2.0], path)),
    "report": ("t.html", lambda path, _: _publish(path.parent)),
    "overview": ("index.html", lambda path, _: overview.write_overview(path.parent, ["table1"] * 200)),
    "demo": ("paths.png", lambda path, _: demo._write([recorded_track("greedy", Path(GOLDEN))] * 2, path.parent)),
    "check-driver": ("x.md", checked),
}


@pytest.mark.parametrize("writer", WRITERS)
def test_pages_and_figures_of_evaluations_demo_and_drivers_are_whole_or_as_they_were(writer, tmp_path, monkeypatch):
    name, write = WRITERS[writer]
    output = tmp_path / name
    output.write_bytes(b"the former one")
    with small_disk(500), pytest.raises(UsageError, match=rf"{name}: File too large"):
        write(output, monkeypatch)
    assert output.read_bytes() == b"the former one"
    assert list(tmp_path.iterdir()) == [output]


def test_an_interrupted_output_leaves_what_was_there(tmp_path):
    output = tmp_path / "x.png"
    output.write_bytes(b"the former one")
    interrupted = whole_output(output)
    interrupted.__enter__().write_bytes(b"half")
    assert not interrupted.__exit__(KeyboardInterrupt, KeyboardInterrupt(), None)
    assert output.read_bytes() == b"the former one"
    assert list(tmp_path.iterdir()) == [output]


ENDED = """
import signal, sys
from pathlib import Path
from tailor.runtime.recordings.new_file import new_file
from tailor.tools.cli.output_files import whole_output

number, folder = int(sys.argv[1]), Path(sys.argv[2])
with new_file(folder / "new.mcap"), whole_output(folder / "x.png") as whole:
    (folder / "new.mcap").write_bytes(b"half")
    whole.write_bytes(b"half")
    signal.raise_signal(number)
"""


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP])
def test_files_of_a_process_that_a_signal_ends_are_gone_and_the_signal_is_its_end(number, tmp_path):
    with heeded_signals():
        ended = subprocess.run([sys.executable, "-P", "-c", ENDED, str(int(number)), str(tmp_path)], check=False)
    assert ended.returncode == -number
    assert list(tmp_path.iterdir()) == []


def test_a_link_is_written_through(tmp_path):
    (tmp_path / "link.png").symlink_to("real.png")
    with whole_output(tmp_path / "link.png") as whole:
        whole.write_bytes(b"new")
    assert (tmp_path / "real.png").read_bytes() == b"new"
    assert sorted(os.listdir(tmp_path)) == ["link.png", "real.png"]


def test_a_file_that_others_may_not_read_stays_so(tmp_path):
    """A page that was for its user alone could be read by all once it was written anew."""
    output = tmp_path / "x.html"
    output.write_text("old")
    output.chmod(0o600)
    with whole_output(output) as whole:
        whole.write_text("new")
    assert output.read_text() == "new"
    assert output.stat().st_mode & 0o777 == 0o600


def test_a_read_only_file_is_kept(tmp_path, monkeypatch):
    output = tmp_path / "x.png"
    output.write_bytes(b"mine")
    monkeypatch.setattr(output_files.os, "access", lambda *_: False)  # root may write everything
    with pytest.raises(UsageError, match="is read-only"), whole_output(output):
        pytest.fail("it was to be written")
    assert output.read_bytes() == b"mine"


def test_a_device_is_written_to_and_not_replaced_by_a_file(tmp_path):
    """Root may rename over /dev/null, as through a link that ends in .html."""
    link = tmp_path / "page.html"
    link.symlink_to(os.devnull)
    with whole_output(link) as whole:
        whole.write_text("page")
    assert whole == Path(os.devnull)
    assert whole.is_char_device()
    assert list(tmp_path.iterdir()) == [link]
