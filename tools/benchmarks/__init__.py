"""Benchmarks of `tailor bench`, one module each, with `run(console, quick)`."""
