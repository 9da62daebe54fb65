"""Make a whole recording of a damaged one: every chunk that can be read, index and footer, an account of the rest."""

from __future__ import annotations

import argparse
from pathlib import Path

from tailor.runtime.recordings.copying import copy
from tailor.runtime.recordings.mcap_scan import DamageReport, scan


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor recover`."""
    parser.add_argument("file", help="recording (MCAP) that was cut or damaged")
    parser.add_argument("-o", "--output", metavar="FILE", help="file to make (default: NAME-recovered.mcap)")


def run(arguments: argparse.Namespace) -> int:
    """0, also when there was nothing to recover; 1 when nothing could be."""
    source = Path(arguments.file)
    damage = DamageReport()
    for _ in scan(source, damage):
        pass
    if not damage.text():
        print(f"{source}: whole, nothing to recover")
        return 0
    target = Path(arguments.output) if arguments.output else source.with_name(f"{source.stem}-recovered.mcap")
    copied = copy(source, target, lambda *_: True, {})
    print(f"{source}: {copied.damage.text()}")
    print(f"{target}: {copied.kept} messages recovered, {copied.left_out} of unknown channels left out")
    return 0 if copied.kept else 1
