"""Tailor: a real-time robot executive that tailors abstract plans with learned action models."""

__version__ = "0.1.0"
