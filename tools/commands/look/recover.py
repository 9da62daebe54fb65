"""Recover a damaged recording: copy every readable chunk and attachment, write index and footer, report the rest."""

from __future__ import annotations

import argparse
import json
from collections.abc import Mapping
from pathlib import Path

from tailor.runtime.recordings.copying import copy
from tailor.runtime.recordings.mcap.scan import DamageReport, scan
from tailor.tools.cli.output_files import beside
from tailor.tools.cli.plain_text import plain


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor recover`."""
    parser.add_argument("file", help="truncated or damaged recording (MCAP)")
    parser.add_argument("-o", "--output", type=Path, metavar="FILE", help="new file (default: NAME-recovered.mcap)")
    parser.add_argument("--json", action="store_true", help="print damage and numbers of messages as JSON")


def run(arguments: argparse.Namespace) -> int:
    """0, also if the file is not damaged; 1 if no message could be recovered: a new file then for attachments alone."""
    source = Path(arguments.file)
    damage = DamageReport()
    for _ in scan(source, damage, with_attachments=True):
        pass
    if not damage.text():
        _print(arguments.json, {"file": str(source), "damage": ""}, f"{source}: not damaged, nothing to recover")
        return 0
    target: Path = arguments.output or beside(source, "-recovered.mcap")
    copied = copy(source, target, lambda *_: True, {}, attachments_alone=True)
    written = str(target) if copied.kept or copied.attachments else None
    found = {
        "file": str(source),
        "damage": copied.damage.text(),
        "output": written,
        "recovered": copied.kept,
        "of_unknown_channels": copied.left_out,
    }
    rest = f"{copied.kept} messages recovered, {copied.left_out} of unknown channels skipped"
    if written is None:
        rest += "; no file is written"
    _print(arguments.json, found, f"{source}: {copied.damage.text()}", f"{written or source}: {rest}")
    return 0 if copied.kept else 1


def _print(as_json: bool, found: Mapping[str, object], *lines: str) -> None:
    print(json.dumps(found) if as_json else "\n".join(map(plain, lines)))
