"""Files that commands write are whole, or as they were: on a full disk, after Ctrl-C, in place of read-only ones."""

from __future__ import annotations

import os
import resource
from contextlib import contextmanager
from pathlib import Path

import pytest

from tailor.schemas.errors import UsageError
from tailor.tools.cli import output_files
from tailor.tools.cli.output_files import whole_output
from tailor.tools.main import main

GOLDEN = str(Path(__file__).parents[3] / "data" / "golden" / "soccer-approach.mcap")
CHOICES = GOLDEN.replace("approach", "approach-dribble")


@contextmanager
def small_disk(limit):
    """No file grows beyond the limit: writing fails as on a full disk, in whatever library."""
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (limit, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))


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


def test_an_interrupted_output_leaves_what_was_there(tmp_path):
    output = tmp_path / "x.png"
    output.write_bytes(b"the former one")
    interrupted = whole_output(output)
    interrupted.__enter__().write_bytes(b"half")
    assert not interrupted.__exit__(KeyboardInterrupt, KeyboardInterrupt(), None)
    assert output.read_bytes() == b"the former one"
    assert list(tmp_path.iterdir()) == [output]


def test_a_link_is_written_through(tmp_path):
    (tmp_path / "link.png").symlink_to("real.png")
    with whole_output(tmp_path / "link.png") as whole:
        whole.write_bytes(b"new")
    assert (tmp_path / "real.png").read_bytes() == b"new"
    assert sorted(os.listdir(tmp_path)) == ["link.png", "real.png"]


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
