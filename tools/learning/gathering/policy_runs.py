"""Gathers episodes from whole runs in lock-step with the current models (on-policy).

Refinement prefers arguments where models err. On-policy episodes come from there. It leaves the greedy choice where
models predict that to be worse: with horizon 1 episodes come from what they have to judge besides.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

from tailor.executive import domains
from tailor.executive.deliberation.context import Settings, make_context
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.models.episodes.episodes import Episode
from tailor.models.episodes.sources import CALIBRATES, RUN_NUMBERS
from tailor.simnodes.world import World
from tailor.tools.learning.gathering.choosing_models import UNPROVEN, cached_models, prepare_chosen
from tailor.tools.learning.gathering.manifests import marker_name
from tailor.tools.learning.gathering.run_data_sets import write
from tailor.tools.learning.gathering.situations import situations
from tailor.tools.lockstep.bodies import body_of
from tailor.tools.lockstep.episode_extraction import EpisodeExtractor
from tailor.tools.parallel.pool import completed

FIRST_SEED = 2_000_000_000  # of scenarios and noise; disjoint from the seeds of evaluations
CHUNK = 10  # runs whose episodes are written together


@dataclass(frozen=True, slots=True)
class Policy:
    """Scenarios to run with the current models, and the folder of their data sets, one per action.

    With `calibrates` no duration is learned from the episodes: they correct the intervals of these very models.
    The horizon is the number of actions that are optimised together; with 1 all choices are greedy.
    """

    domain: str
    scenarios: tuple[str, ...]
    runs: int  # per scenario
    seed: int
    zoo: str
    folder: Path
    profile: str = ""  # of the body; empty: the one that ships
    calibrates: bool = False
    horizon: int = UNPROVEN.horizon

    @property
    def jobs(self) -> list[tuple[str, int]]:
        """Every run: scenario and a seed of its own, since scenarios of one seed share noise and the body's draws."""
        return situations(self.scenarios, FIRST_SEED, self.seed, self.runs * len(self.scenarios))

    @property
    def refinement(self) -> RefinementSettings:
        """Settings of the runs. Raises UsageError if the horizon is too long."""
        return replace(UNPROVEN, horizon=self.horizon)


def run_policy(policy: Policy, jobs: int, resume: bool = True) -> Iterator[int]:
    """Check and prepare the folders, then run the missing runs in parallel; yields numbers of finished runs.

    Raises:
      UsageError: The folder holds other episodes, or the same ones without `resume`; models fail their checks; or the
        horizon is too long.
    """
    kind = "refined" if policy.refinement.horizon > 1 else "greedy"
    about: dict[str, object] = {"source": f"lock-step, {kind} choices", "episodes": policy.runs}
    about |= {"horizon": policy.horizon} if policy.horizon != UNPROVEN.horizon else {}
    about |= {CALIBRATES: True} if policy.calibrates else {}
    prepare_chosen(policy, about, policy.jobs, resume)
    return _run_missing(policy, jobs)


def finished_runs(policy: Policy) -> int:
    """Number of runs that are in the folder."""
    return len(policy.jobs) - sum(len(policy.jobs[first : first + CHUNK]) for first in _missing(policy))


def _missing(policy: Policy) -> list[int]:
    return [first for first in range(0, len(policy.jobs), CHUNK) if not _marker(policy, first).exists()]


def _run_missing(policy: Policy, jobs: int) -> Iterator[int]:
    missing = _missing(policy)
    for number, cut in completed(_chunk, [(policy, first) for first in missing], jobs):
        first = missing[number]
        write(policy.domain, policy.folder, f"{first:06d}", cut)
        _marker(policy, first).touch()
        yield len(policy.jobs[first : first + CHUNK])


def _marker(policy: Policy, first: int) -> Path:
    """Marker of the finished runs that start with number `first`."""
    return policy.folder / marker_name(first, min(first + CHUNK, len(policy.jobs)))


def _chunk(policy: Policy, first: int) -> list[tuple[str, Episode]]:
    """Episodes of some runs, from number `first`, with the names of their actions."""
    cut = []
    for k, (scenario, seed) in enumerate(policy.jobs[first : first + CHUNK]):
        base = RUN_NUMBERS * (first + k)
        cut += [(a, replace(e, number=base + i)) for i, (a, e) in enumerate(_run(policy, scenario, seed))]
    return cut


def _run(policy: Policy, scenario: str, seed: int) -> list[tuple[str, Episode]]:
    from tailor.tools.lockstep.run import SENDER, run_lockstep

    domain = domains.load(policy.domain)
    drawn, start = domains.seeded_scenario(policy.domain, scenario, seed)
    settings = Settings(seed=seed, refinement=policy.refinement)
    models, doubts = cached_models(domain.robot, policy.zoo), domains.doubts(policy.domain)
    context = make_context(domain, drawn, models, settings, SENDER, doubts=doubts)
    world = World(body_of(policy.domain, policy.profile), start, seed)
    return EpisodeExtractor(domain).read(run_lockstep(context, world).messages)
