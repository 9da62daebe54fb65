"""Drivers of real robots: the base class `Hardware`, and what runs it behind the guard."""
