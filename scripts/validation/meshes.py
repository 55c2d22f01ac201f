"""The meshes of the studies: those of meshes/, and others, generated when they are needed."""

import subprocess
from collections import namedtuple

from .fingerprint import fingerprint
from .paths import MESHES, REPOSITORY

GENERATOR = REPOSITORY / 'scripts' / 'generate_cup_mesh'
PROFILES = REPOSITORY / 'config' / 'cups' / 'profiles'

# order: 1 for 4-node, 2 for 10-node tetrahedra. seconds: of a step, roughly; they only weigh the
# runs, so that the long ones begin first and the time that is left can be told.
Mesh = namedtuple('Mesh', 'profile order seconds')
CATALOGUE = {
    'linear_700': Mesh('bell_700', 1, 0.0013),
    'linear_3000': Mesh('bell_3000', 1, 0.010),
    'linear_10000': Mesh('bell_10000', 1, 0.071),
    'linear_30000': Mesh('bell_30000', 1, 0.5),
    'quadratic_700': Mesh('bell_700', 2, 0.024),
    'quadratic_1500': Mesh('bell_1500', 2, 0.12),
    'quadratic_3000': Mesh('bell_3000', 2, 0.4),
    'quadratic_6000': Mesh('bell_6000', 2, 0.7),
    'quadratic_12000': Mesh('bell_12000', 2, 2.5),
    'quadratic_700_fine_rim': Mesh('bell_700_fine_rim', 2, 0.12),
}


def path(name):
    """The file of a mesh; that of meshes/ where there is one."""
    shipped = REPOSITORY / 'meshes' / f'bell_{name}.msh'
    return shipped if shipped.exists() else MESHES / f'bell_{name}.msh'


def generate(name):
    """Makes the mesh's file unless it is there and made of the same profile.

    Raises RuntimeError if gmsh cannot.
    """
    file, mesh = path(name), CATALOGUE[name]
    if file.parent != MESHES:
        return
    profile = PROFILES / f'{mesh.profile}.yaml'
    stamp = file.with_suffix('.fingerprint')
    made_of = fingerprint([mesh.order], [profile, GENERATOR])
    if file.exists() and stamp.exists() and stamp.read_text() == made_of:
        return
    MESHES.mkdir(parents=True, exist_ok=True)
    result = subprocess.run([GENERATOR, profile, '--order', str(mesh.order), '-o', file],
                            stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                            stderr=subprocess.STDOUT, universal_newlines=True)
    if result.returncode != 0:
        lines = result.stdout.strip().splitlines() or ['no reason given']
        raise RuntimeError(f'{file.name} cannot be made of {profile.name}: {lines[-1]}')
    stamp.write_text(made_of)
