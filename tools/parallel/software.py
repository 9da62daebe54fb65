"""What determines the bits of a result on another machine: Tailor's source, the robots' packages, models, libraries."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

import tailor
from tailor.executive.robot_models import load_models
from tailor.schemas.errors import UsageError
from tailor.schemas.installed import spec_of
from tailor.schemas.installed.source import ROOT, runs_sha256

LIBRARIES = ("mujoco", "pybullet", "numpy", "onnxruntime", "scikit-learn", "pyarrow")
SOURCE = (".py", ".pddl", ".toml", ".xml", ".urdf")
DIGITS = 12  # of a hash, as in reports


@dataclass(frozen=True, slots=True)
class Work:
    """What a command works on: names of domains, and the folder of their models; None: it needs no models."""

    domains: tuple[str, ...]
    zoo: str | None = None


@cache
def software_for(work: Work) -> Mapping[str, str]:
    """Software of this process by name; what is missing is described by the error."""
    found = {"Tailor": f"{tailor.__version__} (source {_source_sha256()})"}
    found |= {name: _or_error(version, name) for name in LIBRARIES}
    for name in work.domains:
        found[f"package of {name}"] = _or_error(_package, name)
        if work.zoo is not None:
            found[f"models of {name}"] = _or_error(_models, name, work.zoo)
    return found


def models_sha256(loaded: Any) -> str:
    """Hash over the ONNX files of `Models`."""
    models = {**loaded.durations, **loaded.successes}
    entries = [f"{name} {model.card['sha256']}" for name, model in sorted(models.items())]
    return hashlib.sha256("\n".join(entries).encode()).hexdigest()


def differences(found: Mapping[str, str], expected: Mapping[str, str]) -> list[str]:
    """What differs from the expected software; nothing more if it is Tailor itself, with which much differs."""
    wrong = [
        f"{name} is {found.get(name, 'missing')}, expected {value}"
        for name, value in expected.items()
        if found.get(name) != value
    ]
    return wrong[:1] if wrong and wrong[0].startswith("Tailor ") else wrong


def _source_sha256() -> str:
    """Hash of Tailor's files as they are, comments included."""
    folders = [path for path in Path(tailor.__file__).parent.iterdir() if path.is_dir()]
    digest = hashlib.sha256()
    for path in sorted(path for folder in folders for path in (ROOT / folder.name).rglob("*")):
        if path.suffix in SOURCE:
            digest.update(f"{path.relative_to(ROOT).as_posix()}\0".encode() + path.read_bytes())
    return digest.hexdigest()[:DIGITS]


def _package(name: str) -> str:
    return f"source {runs_sha256(name)[:DIGITS]}"


def _models(name: str, zoo: str) -> str:
    return models_sha256(load_models(spec_of(name).robot, zoo))[:DIGITS]


def _or_error(describe: Callable[..., str], *arguments: str) -> str:
    try:
        return describe(*arguments)
    except PackageNotFoundError:
        return "missing"
    except UsageError as error:
        return f"missing ({error})"
