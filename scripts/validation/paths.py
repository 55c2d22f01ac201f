"""Where things are."""

import pathlib

REPOSITORY = pathlib.Path(__file__).resolve().parent.parent.parent
BINARIES = REPOSITORY / 'build' / 'devel' / 'lib' / 'vacuum_gripper_sim'
EXPERIMENT = BINARIES / 'vacuum_gripper_experiment'
REFERENCE_TESTS = BINARIES / 'validation_test'
REFERENCE_DATA = REPOSITORY / 'test' / 'data' / 'reference'
RESULTS = REPOSITORY / 'results' / 'validation'
RUNS = RESULTS / 'runs'
MESHES = RESULTS / 'meshes'
