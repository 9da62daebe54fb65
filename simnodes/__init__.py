"""Drivers, their guard, and simulated robots behind them. Never imports the executive."""
