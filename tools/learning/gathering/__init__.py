"""Gathers episodes of single actions: at random, beside objects, by choice of the models, from recorded runs."""
