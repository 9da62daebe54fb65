"""Gather training episodes: run actions with random arguments in simulation, faster than real time."""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from tailor.executive import domains
from tailor.models.episodes.manifest import MANIFEST
from tailor.models.episodes.whole_files import only_writer
from tailor.schemas.errors import UsageError
from tailor.tools.cli.output_folders import temporary_beside
from tailor.tools.contract.trial import try_actions
from tailor.tools.launch.checks.package_check import check_package
from tailor.tools.learning import gather_options as options
from tailor.tools.learning.gathering import random_episodes
from tailor.tools.learning.gathering.data_set_spec import DataSetSpec
from tailor.tools.learning.gathering.manifests import check_resumable
from tailor.tools.learning.gathering.progress import gathered, note, shown
from tailor.tools.lockstep.blame import blamed_on_run
from tailor.tools.lockstep.bodies import check_profile
from tailor.tools.lockstep.episode_extraction import data_set_of
from tailor.tools.parallel.cluster import working_on
from tailor.tools.parallel.software import Work
from tailor.tools.parallel.steps import counted

if TYPE_CHECKING:
    from tailor.tools.learning.gathering.recorded_runs import Extracted

configure = options.configure


def run(arguments: argparse.Namespace) -> int:
    """Gather; exit code 0, or 130 if interrupted."""
    options.refuse_ignored(arguments)
    name = random_episodes.domain_of(arguments.robot)
    check_package(name)
    check_profile(name, arguments.profile)
    out = arguments.out or Path("data") / arguments.robot
    chosen = arguments.on_policy or arguments.active or arguments.uncertain
    if arguments.on and arguments.zoo:
        arguments.zoo = str(Path(arguments.zoo).resolve())  # workers have another working directory
    work = Work((name,), arguments.zoo if chosen else None)
    with working_on(arguments.on, work), blamed_on_run(name, True), only_writer(out):
        if arguments.uncertain:
            return _uncertain(arguments, name, out)
        if chosen or arguments.recordings:
            return _from_runs(arguments, name, out)
        return _random(arguments, name, out)


def _random(arguments: argparse.Namespace, name: str, out: Path) -> int:
    """Gather episodes with random arguments."""
    beside = arguments.beside_object or arguments.beside_objects > 0
    actions = actions_of(name, arguments.actions, beside)
    if not beside:  # such episodes have checks of their own
        try_actions(name, actions)
    specs = [
        DataSetSpec(
            name,
            action,
            arguments.episodes,
            arguments.seed,
            out / action,
            beside=beside,
            objects=arguments.beside_objects,
            profile=arguments.profile,
        )
        for action in actions
    ]
    random_episodes.prepare_all(specs, arguments.resume)
    figures = []
    for spec in specs:
        try:
            figures.append(gathered(spec, arguments.jobs, quiet=arguments.json))
        except KeyboardInterrupt:
            kept = spec.episodes - random_episodes.missing_episodes(spec)
            note(f"{spec.folder}: kept {kept} of {spec.episodes}; --resume continues")
            return 130
    if arguments.json:
        print(json.dumps(figures))
    return 0


def _uncertain(arguments: argparse.Namespace, name: str, out: Path) -> int:
    """Gather random episodes whose success is uncertain."""
    from tailor.tools.learning.gathering.uncertain_episodes import Uncertain, judged_actions, run_uncertain

    actions = judged_actions(name, arguments.actions)
    try_actions(name, actions)
    number = (arguments.episodes, arguments.pool or options.UNCERTAIN_POOL, arguments.seed, arguments.zoo)
    sets = [Uncertain(name, action, *number, out / action, arguments.profile) for action in actions]
    return shown(run_uncertain(sets, arguments.jobs, arguments.resume), out, arguments.json)


def _from_runs(arguments: argparse.Namespace, domain: str, out: Path) -> int:
    """Gather from recordings, or from whole runs with the current models."""
    from tailor.tools.learning.gathering import policy_runs

    if arguments.actions:
        raise UsageError("whole runs take no ACTION, expected none with --from, --on-policy and --active")
    if arguments.recordings:
        extracted = _extracted(domain, out, arguments.recordings)
        for line in extracted.left_out:
            note(line)
        found = ", ".join(f"{action} {count}" for action, count in extracted.counts.items())
        print(json.dumps(extracted.counts) if arguments.json else f"{out}: episodes: {found}")
        return 0
    scenarios = tuple(dict.fromkeys(arguments.on_policy or arguments.active))
    for scenario in scenarios:
        domains.load_scenario(domain, scenario, np.random.default_rng(0))  # raises UsageError if there is none
    where = (arguments.seed, arguments.zoo, out, arguments.profile)
    if arguments.active:
        from tailor.tools.learning.gathering.active_episodes import Active, run_active

        active = Active(domain, scenarios, arguments.episodes, arguments.pool or options.POOL, *where)
        return shown(run_active(active, arguments.jobs, arguments.resume), out, arguments.json)
    options_of_runs = (arguments.calibrates, arguments.horizon or options.HORIZON)
    policy = policy_runs.Policy(domain, scenarios, arguments.episodes, *where, *options_of_runs)
    running = policy_runs.run_policy(policy, arguments.jobs, arguments.resume)
    steps = counted("runs", running, len(policy.jobs), policy_runs.finished_runs(policy))
    return shown(steps, out, arguments.json)


def _extracted(domain: str, out: Path, recordings: list[Path]) -> Extracted:
    """Extract recordings into a folder, all of them or none: --resume continues simulated runs only.

    Manifests come last: without one, what a kill leaves passes for no data set.
    """
    from tailor.tools.learning.gathering.recorded_runs import extract_from_recordings

    with temporary_beside(out / "recordings") as temporary:
        try:
            extracted = extract_from_recordings(domain, temporary, recordings)
        except UsageError as error:
            raise UsageError(str(error).replace(str(temporary), str(out))) from None
        folders = sorted(temporary.iterdir())
        for folder in folders:
            check_resumable(out / folder.name, {}, resume=False)
        for folder in folders:
            (out / folder.name).mkdir(exist_ok=True)
            for path in sorted(folder.iterdir(), key=lambda path: path.name == MANIFEST):
                path.replace(out / folder.name / path.name)
    return extracted


def actions_of(domain: str, requested: list[str], beside: bool = False) -> list[str]:
    """Actions to gather: the requested ones, or all that have a duration model, or `beside` objects a context.

    Raises:
      UsageError: The domain lacks a requested action, or it has no context; or none has one.
    """
    declared = domains.load(domain).actions
    for action in requested:
        random_episodes.check_action(domain, action, beside)
    modelled = {data_set_of(each) for each in declared.values() if each.context or not beside}
    if not modelled:
        raise UsageError(f"no action of {domain} has a context of objects, expected one to gather beside them")
    return list(dict.fromkeys(requested)) or sorted(modelled)
