"""Loads scene.xml, the PowerCube arm as a MuJoCo model."""

from __future__ import annotations

from importlib import resources

import mujoco


def load_scene() -> mujoco.MjModel:
    """The compiled model of scene.xml; joints and motors have the names of `physical_parameters.NAMES`."""
    return mujoco.MjModel.from_xml_string(resources.files(__package__).joinpath("scene.xml").read_text("utf-8"))
