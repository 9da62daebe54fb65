"""The verbs `push` and `pull` of `tailor models`."""

from __future__ import annotations

import argparse
import json
from functools import partial
from pathlib import Path

from tailor.schemas.errors import UsageError
from tailor.schemas.installed import models_folder
from tailor.tools.hub.place import Place, place_of

VERBS = ("push", "pull")


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the flags of both verbs."""
    places = "USER/NAME, a repository of the hub, or a folder as ./NAME"
    parser.add_argument("--to", metavar="PLACE", help=f"push: {places}")
    parser.add_argument("--from", dest="source", metavar="PLACE", help=f"pull: {places}")
    parser.add_argument("--public", action="store_true", help="push: everyone may read a new repository")
    parser.add_argument("--license", metavar="ID", help="push: licence by its SPDX id (default: that of the package)")
    parser.add_argument("--revision", metavar="NAME", help="pull: branch, tag or commit (default: the newest)")
    parser.add_argument("--replace", action="store_true", help="pull: replace what is there")


def run(arguments: argparse.Namespace) -> int:
    """Run a verb; exit code 0.

    Raises:
      UsageError: A flag is missing, or nothing was pushed or pulled.
    """
    _check_models(arguments)
    row = _push(arguments) if arguments.verb == "push" else _pull(arguments)
    if arguments.json:
        print(json.dumps(row))
        return 0
    for line in row.values():
        print(*(line if isinstance(line, list) else [line]), sep="\n")
    return 0


def check_flags(arguments: argparse.Namespace) -> None:
    """Refuse flags that the verb does not take.

    Raises:
      UsageError: There is one; the message names it.
    """
    flags = {
        "push": {"--to": arguments.to, "--public": arguments.public, "--license": arguments.license},
        "pull": {"--from": arguments.source, "--revision": arguments.revision, "--replace": arguments.replace},
    }
    others = (flags[verb] for verb in VERBS if verb != arguments.verb)
    wrong = [name for each in others for name, value in each.items() if value]
    if wrong:
        raise UsageError(f"{arguments.verb} takes no {', '.join(wrong)} (see tailor models --help)")


def _check_models(arguments: argparse.Namespace) -> None:
    pushing = arguments.verb == "push"
    own, place = ("--to", arguments.to) if pushing else ("--from", arguments.source)
    if arguments.data is not None and arguments.zoo is not None:
        raise UsageError(f"{arguments.verb} --data takes no --zoo: data sets are no models")
    if place is None:
        raise UsageError(f"{arguments.verb} needs {own} USER/NAME, a repository of the hub, or {own} ./FOLDER")
    wanted = 1 if pushing and arguments.data is None else 0
    if len(arguments.models) != wanted or any("/" in name for name in arguments.models):
        expected = "one ROBOT" if wanted else "no MODEL"
        raise UsageError(f"{arguments.verb}: expected {expected} (see tailor models --help)")


def _push(arguments: argparse.Namespace) -> dict[str, str]:
    from tailor.tools.hub.folders import write_data, write_models
    from tailor.tools.hub.transfer import push

    if arguments.data is not None:
        write, kind = partial(write_data, arguments.data, arguments.license), "dataset"
    else:
        (robot,) = arguments.models
        zoo = arguments.zoo or models_folder(robot)
        write, kind = partial(write_models, zoo, robot, arguments.license), "model"
    place = _place(arguments.to, {"--public": arguments.public})
    return {"pushed": push(write, place, kind, arguments.public)}


def _pull(arguments: argparse.Namespace) -> dict[str, list[str]]:
    from tailor.tools.hub.transfer import pull_data, pull_models

    place = _place(arguments.source, {"--revision": arguments.revision})
    if arguments.data is not None:
        paths: list[Path] = pull_data(place, arguments.revision, arguments.data, arguments.replace)
    else:
        paths = pull_models(place, arguments.revision, arguments.zoo, arguments.replace)
    return {"pulled": [str(path) for path in paths]}


def _place(written: str, for_hub: dict[str, object]) -> Place:
    """The place that a user wrote; raises UsageError if it is a folder and a flag is for repositories only."""
    place = place_of(written)
    for flag, value in for_hub.items():
        if value and place.folder is not None:
            raise UsageError(f"{flag} is for a repository of the hub, found the folder {written}")
    return place
