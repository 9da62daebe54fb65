"""Evaluations of live runs: do they agree with lock-step?"""
