"""Packages of robots: what one declares, and those that are found."""
