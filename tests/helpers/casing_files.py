"""A beam between two nodes, written in each format that a casing is read from, and configs on its files."""

import numpy as np

NODES = (101, 205)
LENGTH = 200.0


def beam_matrices(length=LENGTH, area=3700.0, young=70e3, shear=26.3e3, density=2.7e-9):
    """K and M (12, 12) of a beam of 200 mm along x, mm, t and s: consistent, without shear."""
    second, polar = 0.37 * 1e4, 0.76 * 1e6
    axial, torsion, bending = young * area / length, shear * polar / length, young * second / length**3
    stiffness, mass = np.zeros((2, 12, 12))
    weight = density * area * length
    for first, value, inertia in ((0, axial, weight), (3, torsion, weight * polar / area)):
        at = np.ix_([first, first + 6], [first, first + 6])
        stiffness[at] = value * np.array([[1, -1], [-1, 1]])
        mass[at] = inertia / 6 * np.array([[2, 1], [1, 2]])
    for across, turn, sign in ((1, 5, 1), (2, 4, -1)):
        at = [across, turn, across + 6, turn + 6]
        arm = sign * length
        bent = np.array(
            [
                [12, 6 * arm, -12, 6 * arm],
                [6 * arm, 4 * length**2, -6 * arm, 2 * length**2],
                [-12, -6 * arm, 12, -6 * arm],
                [6 * arm, 2 * length**2, -6 * arm, 4 * length**2],
            ]
        )
        carried = np.array(
            [
                [156, 22 * arm, 54, -13 * arm],
                [22 * arm, 4 * length**2, 13 * arm, -3 * length**2],
                [54, 13 * arm, 156, -22 * arm],
                [-13 * arm, -3 * length**2, -22 * arm, 4 * length**2],
            ]
        )
        stiffness[np.ix_(at, at)] += bending * bent
        mass[np.ix_(at, at)] += weight / 420 * carried
    return stiffness, mass


def rows():
    return [(node, direction) for node in NODES for direction in range(1, 7)]


def write_nodes(folder, scale=1.0):
    path = folder / "nodes.csv"
    path.write_text(f"node,x_mm,y_mm,z_mm\n101,0,0,0\n205,{scale * LENGTH},0,0\n")
    return str(path)


def write_dofs(folder, order=None):
    path = folder / "dofs.csv"
    lines = [f"{node},{direction}" for node, direction in (order or rows())]
    path.write_text("\n".join(["node,dof", *lines]) + "\n")
    return str(path)


def write_csv(path, matrix):
    np.savetxt(path, matrix, delimiter=",", fmt="%.17g")
    return str(path)


def write_coordinates(path, matrix):
    """Lower triangle by `node, dof, node, dof, value`, as Abaqus writes it."""
    labels = rows()
    lines = [
        f"{labels[i][0]},{labels[i][1]}, {labels[j][0]},{labels[j][1]}, {matrix[i, j]: .15e}"
        for i in range(12)
        for j in range(i + 1)
        if matrix[i, j]
    ]
    path.write_text("\n".join(lines) + "\n")
    return str(path)


def write_matrix_market(path, matrix):
    entries = [(i, j, matrix[i, j]) for i in range(12) for j in range(i + 1) if matrix[i, j]]
    lines = [f"{i + 1} {j + 1} {value:.17g}" for i, j, value in entries]
    header = ["%%MatrixMarket matrix coordinate real symmetric", f"12 12 {len(entries)}"]
    path.write_text("\n".join([*header, *lines]) + "\n")
    return str(path)
