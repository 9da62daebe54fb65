"""Interfaces that domains, models and the executive share: actions, domains, models, budgets."""
