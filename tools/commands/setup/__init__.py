"""Commands that prepare machines and packages: keys, unit files, a new robot."""
