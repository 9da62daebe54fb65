"""Print a script that completes commands and flags in a shell."""

from __future__ import annotations

import argparse
import importlib

import shtab

from tailor.tools.main import COMMANDS

EPILOG = """\
examples:
  tailor completion bash > ~/.local/share/bash-completion/completions/tailor
  tailor completion zsh > ~/.zfunc/_tailor          (a folder of $fpath)
  tailor completion fish > ~/.config/fish/completions/tailor.fish"""


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor completion`."""
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    parser.epilog = EPILOG
    *most, last = shtab.SUPPORTED_SHELLS
    shells = f"{', '.join(most)} or {last}"
    parser.add_argument("shell", choices=shtab.SUPPORTED_SHELLS, metavar="SHELL", help=shells)


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
