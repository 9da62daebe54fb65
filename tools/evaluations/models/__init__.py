"""Evaluations of action models: how good are predictions?"""
