"""What a package declares of a robot: one value that names its parts without loading them."""

from __future__ import annotations

import re
from dataclasses import dataclass, fields

NAME = re.compile(r"[a-z][a-z0-9_-]*")  # part of keys on the bus, of file names and of commands
OBJECT = re.compile(r"[A-Za-z_][\w.]*(:[A-Za-z_]\w*)?")
RESERVED = ("clock", "estop", "exec", "launch", "recorder", "rosout", "tf")  # first words of keys that are no robot's
REQUIRED = ("domain", "driver")
OBJECTS = ("domain", "doubts", "body", "topics", "sampler", "features", "draw", "generator", "scene")  # else files


@dataclass(frozen=True, slots=True)
class DomainSpec:
    """A robot with its tasks, as its package declares it under the entry-point group `tailor.domains`.

    An object is written `module:attribute`, or `module`. The process that needs it imports it: an executive never loads
    a simulated body. A file or folder is a path inside the package of the module that declares the spec, or
    `other.package:path`.

    Attributes:
      name: Name of the domain; that of the entry point.
      robot: Name of the robot; prefix of its topics' keys.
      domain: Callable without arguments that returns a tailor.executive.interfaces.domain.Domain.
      doubts: Functions by topic of a sensor, each of the belief before and after a reading: whether a detector may have
        taken something else for what it looks for. Such a reading is believed once it has come three times in a row.
      driver: File that declares command, axes with limits, and sensors with rates.
      body: Callable without arguments that returns a tailor.simnodes.body.Body; empty for a robot without simulator.
      topics: Topics of the robot beside those that Tailor ships, by name; loaded with the table of topics.
      messages: Folder of a ROS 2 interface package, `FOLDER/msg/*.msg`; a topic may name its type by the file's name.
      sampler: Callable without arguments that returns a TaskSampler, see tailor.tools.lockstep.task_sampler.
      features: Tuple of FeatureSpaces beside those that Tailor ships.
      scenarios: Folder of scenario files, from which `draw` draws.
      draw: Function `(declared, rng) -> (start, places, events)` of a scenario file's contents.
      generator: Object with `scenarios()` and `load_scenario(name, rng)`, instead of `scenarios` and `draw`.
      scene: What robot and surroundings look like, a tailor.schemas.packages.scene.SceneView; empty: by convention.
      models: Folder of trained models, `models/<robot>/<action>/`.
      package: Package that holds the files; discovery sets it.
    """

    name: str
    robot: str
    domain: str
    driver: str = "driver.toml"
    body: str = ""
    topics: str = ""
    messages: str = ""
    sampler: str = ""
    features: str = ""
    scenarios: str = "scenarios"
    draw: str = ""
    generator: str = ""
    scene: str = ""
    models: str = "models"
    package: str = ""
    doubts: str = ""


def faults_of(spec: DomainSpec) -> tuple[str, ...]:
    """All faults of a spec that show without loading its parts, each with the field's name."""
    wrong = [
        f"{each.name} is {getattr(spec, each.name)!r}, expected text"
        for each in fields(spec)
        if not isinstance(getattr(spec, each.name), str)
    ]
    if wrong:
        return tuple(wrong)
    faults = [
        f"{name} is '{value}', expected lower-case letters, digits, - and _"
        for name in ("name", "robot")
        if not NAME.fullmatch(value := getattr(spec, name))
    ]
    if spec.robot in RESERVED:
        faults.append(f"robot is '{spec.robot}', expected another name: Tailor's own keys begin with it")
    faults += [f"{name} is empty" for name in REQUIRED if not getattr(spec, name)]
    faults += [
        f"{name} is '{value}', expected module:attribute"
        for name in OBJECTS
        if (value := getattr(spec, name)) and not OBJECT.fullmatch(value)
    ]
    if bool(spec.draw) == bool(spec.generator):
        faults.append("expected either draw, for the scenario files, or generator")
    return tuple(faults)
