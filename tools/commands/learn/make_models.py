"""Make the models of robots anew from seeds: gather, train, gather what the models choose, train again."""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

from tailor.models.episodes.whole_files import only_writer
from tailor.schemas.errors import UsageError
from tailor.schemas.installed import robot_names, spec_of_robot
from tailor.tools.cli.number_checks import processes
from tailor.tools.learning.making.installing import install
from tailor.tools.learning.making.making import Making
from tailor.tools.learning.making.steps import check, make
from tailor.tools.learning.model_folders import target_zoo
from tailor.tools.learning.recipe_file import read_recipe, recipe_path
from tailor.tools.lockstep.blame import blamed_on_run
from tailor.tools.parallel.steps import Step, show

EPILOG = """\
examples:
  tailor make-models                            (all robots whose package has a recipe)
  tailor make-models agilo --jobs 2
  tailor make-models agilo --recipe my.toml --zoo out/zoo

A recipe is a file recipe.toml beside the models: seed, random episodes of each action, rounds that the models choose.
Equal source and libraries give equal models on CPUs of one kind, bit for bit. An interrupted command resumes when it is
run again."""


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the command's arguments."""
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    parser.epilog = EPILOG
    add = parser.add_argument
    add("robots", nargs="*", default=[], metavar="ROBOT", help="robots (default: all that have a recipe)")
    add("--recipe", type=Path, metavar="FILE", help="recipe (default: that of the robot's package)")
    add("--zoo", type=Path, metavar="DIR", help="folder to write models to (default: that of the robot's package)")
    add("--work", type=Path, default=Path("out/make-models"), help="folder of episodes (default: %(default)s)")
    add("--jobs", type=processes, default=2, help="number of processes (default: %(default)s)")
    add("--json", action="store_true", help="print seconds of each step as JSON, without progress bar")


def run(arguments: argparse.Namespace) -> int:
    """Make the models; exit code 0, or 130 if interrupted."""
    robots = arguments.robots or [robot for robot in robot_names() if recipe_path(robot).is_file()]
    makings = [(_making(robot, arguments), target_zoo(arguments.zoo, robot)) for robot in robots]
    rows = [{"robot": making.robot, **_made(making, zoo, arguments.json)} for making, zoo in makings]
    if arguments.json:
        print(json.dumps(rows))
    for row in rows if not arguments.json else ():
        print(f"{row['robot']}: models in {row['zoo']}, made in {sum(row['steps_s'].values()) / 60:.1f} minutes")
    return 0


def _making(robot: str, arguments: argparse.Namespace) -> Making:
    spec_of_robot(robot)  # raises UsageError if there is none
    path = arguments.recipe or recipe_path(robot)
    command = f"tailor make-models {robot}" + (f" --recipe {arguments.recipe}" if arguments.recipe else "")
    making = Making(robot, read_recipe(path), arguments.work, arguments.jobs, command)
    try:
        check(making)  # of every robot, before the models of the first one are made
    except UsageError as error:
        raise UsageError(f"{path}: {error}") from None
    return making


def _made(making: Making, zoo: Path, quiet: bool) -> dict[str, Any]:
    """Make and install the models of one robot; seconds of each step that was not done before."""
    seconds: dict[str, float] = {}
    with blamed_on_run(spec_of_robot(making.robot).name, parts_alone=True), only_writer(making.work / making.robot):
        show(_timed(make(making), seconds), quiet, {}, f"{making.robot}: ")
    install(making.zoo, zoo, making.robot)
    return {"zoo": str(zoo), "steps_s": {title: round(value, 1) for title, value in seconds.items()}}


def _timed(steps: Iterable[Step], seconds: dict[str, float]) -> Iterator[Step]:
    """The same steps; `seconds` is filled with the time of each by title."""
    since = time.perf_counter()
    for step in steps:
        now = time.perf_counter()
        seconds[step.title], since = seconds.get(step.title, 0.0) + now - since, now
        yield step
