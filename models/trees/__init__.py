"""Model trees that predict durations: induction, fitting, distillation."""
