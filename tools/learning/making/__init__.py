"""Makes models by a recipe: gathers, trains, gathers what the models choose, trains again, installs."""
