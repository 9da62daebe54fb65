"""Print a script that completes commands and flags in a shell.

bash: tailor completion bash > ~/.local/share/bash-completion/completions/tailor
zsh:  tailor completion zsh > a folder of $fpath, as _tailor
"""

from __future__ import annotations

import argparse
import importlib

import shtab

from tailor.tools.main import COMMANDS


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor completion`."""
    parser.add_argument(
        "shell", choices=shtab.SUPPORTED_SHELLS, metavar="SHELL", help=" or ".join(shtab.SUPPORTED_SHELLS)
    )


def run(arguments: argparse.Namespace) -> int:
    """Print the script; always 0."""
    print(shtab.complete(whole_parser(), arguments.shell))
    return 0


def whole_parser() -> argparse.ArgumentParser:
    """One parser of all commands with their flags. Slow: it imports every command."""
    parser = argparse.ArgumentParser(prog="tailor")
    commands = parser.add_subparsers()
    for name, (module, text) in COMMANDS.items():
        importlib.import_module(module).configure(commands.add_parser(name, help=text))
    return parser
