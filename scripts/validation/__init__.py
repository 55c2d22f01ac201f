"""Runs the experiments of scripts/validate, judges them and writes the report."""
