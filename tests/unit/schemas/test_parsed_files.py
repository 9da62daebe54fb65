"""Files of users: whatever is wrong with one is stated in one line that names it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from tailor.schemas.errors import Rejected, UsageError
from tailor.schemas.parsed_files import read_json, read_toml, table_of


@pytest.mark.parametrize(
    ("read", "content", "fault"),
    [
        (read_toml, b"a = [", "not TOML: Invalid value"),
        (read_toml, b"# \xe9", "not UTF-8 (byte 0xe9 at position 2)"),
        (read_toml, b"a = " + b"[" * 5000, "not TOML that can be read: nested too deeply"),
        (read_toml, b"a = " + b"1" * 5000, "not TOML: Exceeds the limit (4300 digits)"),
        (read_json, b"{", "not JSON: Expecting property name"),
        (read_json, b"\xff", "not UTF-8 (byte 0xff at position 0)"),
        (read_json, b"[" * 100_000, "not JSON that can be read: nested too deeply"),
    ],
)
def test_an_unusable_file_is_refused_in_one_line(
    tmp_path: Path, read: Callable[..., Any], content: bytes, fault: str
) -> None:
    (tmp_path / "file").write_bytes(content)
    with pytest.raises(UsageError) as caught:
        read(tmp_path / "file", "a recipe")
    assert str(caught.value).startswith(f"{tmp_path / 'file'}: {fault}")
    assert str(caught.value).endswith(", expected a recipe")
    assert "\n" not in str(caught.value)


def test_a_file_that_cannot_be_read_is_refused(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="nowhere: No such file or directory, expected a card"):
        read_json(tmp_path / "nowhere", "a card")
    with pytest.raises(UsageError, match="Is a directory, expected a card"):
        read_toml(tmp_path, "a card")


def test_a_file_without_end_is_refused() -> None:
    """It was read until no memory was left."""
    with pytest.raises(UsageError, match="/dev/zero: has more than 64 MB, expected a deployment file"):
        read_toml("/dev/zero", "a deployment file")


@pytest.mark.parametrize(("read", "text"), [(read_toml, 'name = "Bürste"'), (read_json, '{"name": "Bürste"}')])
def test_files_are_utf_8_in_every_locale(tmp_path: Path, read: Callable[..., Any], text: str) -> None:
    (tmp_path / "file").write_text(text, encoding="utf-8")
    assert read(tmp_path / "file", "a file") == {"name": "Bürste"}


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("{", "not JSON: Expecting"),
        ("[" * 100_000, "nested too deeply"),
        ("[1]", "not a JSON object"),
        ("1" * 9000, "not JSON"),
    ],
)
def test_a_received_text_that_is_no_table_is_rejected_in_few_words(text: str, reason: str) -> None:
    rejected = table_of(text)
    assert isinstance(rejected, Rejected)
    assert reason in rejected.reason
    assert len(rejected.reason) <= 90


def test_a_received_table_is_read() -> None:
    assert table_of('{"domain": "soccer"}') == {"domain": "soccer"}
