"""The commands of `tailor`, one module each, with `configure(parser)` and `run(arguments)`."""
