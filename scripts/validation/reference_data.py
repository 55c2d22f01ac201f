"""The converged solutions of CalculiX in test/data/reference."""

import csv
import math

import numpy as np

from .paths import REFERENCE_DATA


def read_table(name):
    """Rows of {column: number}; NaN where a field is empty."""
    with open(REFERENCE_DATA / name, newline='', encoding='utf-8') as stream:
        return [{key: float(value) if value else math.nan for key, value in row.items()}
                for row in csv.DictReader(stream)]


def airtight(rows, pressure):
    """Rows at a pressure [Pa] whose cavity is airtight and whose seal was found consistently."""
    return [row for row in rows
            if row['p'] == pressure and row['sealed'] == 1.0 and row['seal_ok'] == 1.0]


def uplift(name, pressure):
    """(lifts [m], forces on the mount [N]) while the suction is held."""
    rows = airtight(read_table(name), pressure)
    return (np.array([row['clamp_uz'] for row in rows]), np.array([row['F_clamp'] for row in rows]))


def force_at(name, lift, pressure):
    """Force on the mount at rest. [N]"""
    for row in airtight(read_table(name), pressure):
        if abs(row['clamp_uz'] - lift) < 1e-7:
            return row['F_clamp']
    raise ValueError(f'{name} has no airtight row at clamp_uz = {lift}, p = {pressure}')


def profile(name):
    """Meridian section under suction, (r, z) of its points in order, and at rest. [m]"""
    rows = read_table(name)
    return (np.array([[row['r'], row['z']] for row in rows]),
            np.array([[row['r0'], row['z0']] for row in rows]))
