"""Hashes of the source that determines the behaviour of a robot, independent of comments, docstrings and layout."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Iterator
from functools import lru_cache
from importlib.util import find_spec
from pathlib import Path

from tailor.schemas.installed import file, spec_of
from tailor.schemas.installed.episode_files import episode_files, episode_paths
from tailor.schemas.installed.source_text import content_sha256, content_text
from tailor.schemas.packages.spec import DomainSpec

ROOT = Path(__file__).resolve().parents[2]
OURS = "tailor"  # whose scenarios do not count: seeds of all evaluations are derived from these hashes
DATA = (".pddl", ".toml", ".xml")  # beside code: problems, scenarios, drivers, scenes
REASONING = tuple(f"executive/{room}/**/*" for room in ("core", "deliberation", "interfaces", "planning", "refinement"))
WHOLE = (  # beside what determines the episodes
    *REASONING,
    "simnodes/*",
    "models/features/**/*",
    "models/runtime.py",
    "models/inference.py",
    "tools/lockstep/*",
)

LEARNING = ("models/**/*.py", "tools/learning/**/*.py", "tools/lockstep/episode_extraction.py")


@lru_cache(maxsize=8)
def episodes_sha256(domain: str) -> str:
    """Hash of what determines the episodes of a domain's actions: controllers, belief, body, sampler, domain.

    Raises:
      UsageError: There is no such domain.
    """
    lines = (f"{name} {sha256}" for name, sha256 in episode_files(domain).items())
    return hashlib.sha256("\n".join(lines).encode()).hexdigest()


@lru_cache(maxsize=8)
def runs_sha256(domain: str) -> str:
    """Hash of what determines whole runs of a domain, models left out: the executive, the body, the domain.

    Raises:
      UsageError: There is no such domain.
    """
    return _sha256(WHOLE, spec_of(domain))


@lru_cache(maxsize=1)
def learning_sha256() -> str:
    """Hash of what makes models out of episodes: learners, calibration, export."""
    files = sorted(path for pattern in LEARNING for path in ROOT.glob(pattern))
    lines = (f"{_name(path)} {content_sha256(path)}" for path in files)
    return hashlib.sha256("\n".join(lines).encode()).hexdigest()


def _sha256(ours: Iterable[str], spec: DomainSpec) -> str:
    digest = hashlib.sha256()
    generic = filter(_counts, (path for pattern in ours for path in ROOT.glob(pattern)))
    of_episodes = (path.resolve() for path in episode_paths(spec).values())
    files = {*generic, *_of_package(spec), *of_episodes}
    for name, path in sorted((_name(path), path) for path in files):
        digest.update(f"{name}\0{content_text(path)}\0".encode())
    return digest.hexdigest()


def _of_package(spec: DomainSpec) -> Iterator[Path]:
    """The driver, and the files in the folders of domain, body and sampler; of packages of others all files.

    Scenarios lie in a folder of their own, below that of the domain: a run of before they were changed is another one.
    """
    yield Path(str(file(spec, "driver"))).resolve()
    objects = (spec.domain, spec.body, spec.sampler)
    for module in (written.partition(":")[0] for written in objects if written):
        found = find_spec(module)
        if found is not None and found.origin:
            yield from filter(_counts, Path(found.origin).resolve().parent.glob("*"))
    modules = (written.partition(":")[0] for written in (*objects, spec.draw, spec.generator, spec.package))
    for package in {module.partition(".")[0] for module in modules} - {"", OURS}:
        found = find_spec(package)
        for place in (found and found.submodule_search_locations) or ():
            yield from filter(_counts, Path(place).resolve().rglob("*"))


def _counts(path: Path) -> bool:
    return path.suffix in (".py", *DATA) and path.is_file()


def _name(path: Path) -> str:
    """Path within Tailor, or within the folder that holds the package."""
    return path.relative_to(ROOT if path.is_relative_to(ROOT) else path.parents[1]).as_posix()
