"""MIND: plans, instantiates, asserts, refines and acts. Pure but for shell.py."""
