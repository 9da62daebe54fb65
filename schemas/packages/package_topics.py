"""The topics that packages of robots add to the table, and what is wrong with them.

A package adds sensors, commands and ground truth of its robot; never arming, e-stops or reports of the executive.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, is_dataclass, replace
from importlib import import_module, resources
from typing import Any

from tailor.schemas.messages import ArmRequest, EStop, Message
from tailor.schemas.packages.discovery import Package
from tailor.schemas.packages.msg_reader import read_messages
from tailor.schemas.packages.ros_names import PACKAGE, ros_type
from tailor.schemas.packages.spec import DomainSpec
from tailor.schemas.packages.topic import Topic
from tailor.schemas.packages.type_faults import faults_of_fields

SOURCES = ("driver", "executive", "simulator")
PRIORITIES = ("real_time", "interactive_high", "data")
KEY_START = "{robot}/"
KEY = re.compile(r"\{robot\}(/[\w.~-]+)+", re.ASCII)  # zenoh opens no bus whose access rules name another key
MAX_BYTES = 1 << 30


@dataclass(frozen=True, slots=True)
class PackageTopics:
    """Topics that may enter the table, and the faults of packages whose topics may not, by the package's name."""

    topics: Mapping[str, Topic]
    faults: Mapping[str, tuple[str, ...]]


def add_topics(known: Mapping[str, Topic], packages: Sequence[Package]) -> PackageTopics:
    """Add the topics of packages, those of one package all or none."""
    topics, faults = dict(known), dict[str, tuple[str, ...]]()
    for package in packages:
        if package.spec is None or package.faults or not package.spec.topics:
            continue
        try:
            types = messages_of(package.spec)
        except Exception as error:
            faults[package.name] = (f"messages = '{package.spec.messages}': {error}",)
            continue
        try:
            added = _typed(_load(package.spec.topics), types)
        except (Exception, SystemExit) as error:
            wrong: tuple[str, ...] = (f"topics = '{package.spec.topics}': {type(error).__name__}: {error}",)
        else:
            wrong = tuple(
                f"topics = '{package.spec.topics}': {fault}" for fault in _faults(added, topics, package.spec.robot)
            )
        if wrong:
            faults[package.name] = wrong
        else:
            topics.update(added)
    return PackageTopics(topics, faults)


def messages_of(spec: DomainSpec) -> dict[str, Any]:
    """Message types of the files in the folder that a spec names, by name; none if it names none.

    Raises:
      ValueError: A file cannot be read; the message names file and line.
    """
    package, _, path = spec.messages.rpartition(":")
    if not spec.messages:
        return {}
    folder: Any = resources.files(package or spec.package) / path
    return dict(read_messages(folder))


def _typed(added: Any, types: Mapping[str, type]) -> Any:
    """The table with types for their names; what is no table, or has no such type, is left for the check."""
    if not isinstance(added, Mapping):
        return added
    return {
        name: replace(topic, type=types.get(topic.type, topic.type))
        if isinstance(topic, Topic) and isinstance(topic.type, str)
        else topic
        for name, topic in added.items()
    }


def _load(written: str) -> Any:
    module, _, attribute = written.partition(":")
    return getattr(import_module(module), attribute)


def _faults(added: Any, known: Mapping[str, Topic], robot: str) -> Iterator[str]:
    if not isinstance(added, Mapping):
        yield f"is a {type(added).__name__}, expected a table of Topics by name"
        return
    keys = {topic.key: name for name, topic in known.items()}
    types = {ros_type(topic.type): topic.type for topic in known.values()}
    for name, topic in added.items():
        if not isinstance(name, str) or not name:
            yield f"{name!r}: expected text as the name of a topic"
        if not isinstance(topic, Topic):
            yield f"'{name}' is a {type(topic).__name__}, expected a Topic"
            continue
        if not isinstance(topic.key, str):
            yield f"'{name}': key is {topic.key!r}, expected text"
            continue
        if name in known:
            yield f"'{name}' is a topic already, expected a name of its own, such as '{robot}_{name}'"
        if topic.key in keys:
            yield f"'{name}' has the key {topic.key} of '{keys[topic.key]}'"
        yield from (f"'{name}': {fault}" for fault in (*_faults_of_row(topic), *_faults_of_type(topic.type, types)))
        keys[topic.key] = name


def _faults_of_row(topic: Topic) -> Iterator[str]:
    if not KEY.fullmatch(topic.key):
        yield f"key is '{topic.key}', expected one that starts with {KEY_START}, and names without a pattern between /"
    if topic.source not in SOURCES:
        yield f"source is '{topic.source}', expected one of: {', '.join(SOURCES)}"
    if topic.priority not in PRIORITIES:
        yield f"priority is '{topic.priority}', expected one of: {', '.join(PRIORITIES)}"
    if topic.priority == "real_time" and topic.source != "executive":
        yield f"priority is real_time, which is for commands of the executive, but source is '{topic.source}'"
    yield from _faults_of_numbers(topic)


def _faults_of_numbers(topic: Topic) -> Iterator[str]:
    rate_hz, fresh_s, max_bytes = topic.rate_hz, topic.fresh_s, topic.max_bytes
    if not (_is_finite(rate_hz) and rate_hz >= 0.0):
        yield f"rate_hz is {rate_hz!r}, expected a finite number, not negative"
    if fresh_s is not None and not (_is_finite(fresh_s) and fresh_s > 0.0):
        yield f"fresh_s is {fresh_s!r}, expected a finite number above 0, or None"
    if type(max_bytes) is not int or not 0 < max_bytes <= MAX_BYTES:
        yield f"max_bytes is {max_bytes!r}, expected 1 to {MAX_BYTES}"
    if not isinstance(topic.recorded, bool):
        yield f"recorded is {topic.recorded!r}, expected True or False"


def _is_finite(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)


def _faults_of_type(kind: Any, types: Mapping[str, type]) -> Iterator[str]:
    if not (isinstance(kind, type) and issubclass(kind, Message) and is_dataclass(kind)):
        yield f"type is {kind!r}, expected a frozen dataclass derived from Message"
        return
    name: Any = ros_type(kind)
    if not isinstance(name, str):
        yield f"type {kind.__name__} has the ROS_TYPE {name!r}, expected text"
        return
    if kind in (ArmRequest, EStop):
        yield f"type is {kind.__name__}, which no package publishes"
    if types.get(name, kind) is not kind:
        yield f"type has the name {name} of another message"
    elif name.startswith(f"{PACKAGE}/") and not kind.__module__.startswith("tailor."):
        yield f"type {kind.__name__} has the ROS_PACKAGE {PACKAGE}, expected one of its own"
    elif name not in types:
        yield from faults_of_fields(kind, types)
