"""Symmetries of a system: linear maps and shifts in time that turn every motion into another motion.

A machine with equal pinions left and right has one that exchanges them; without mean load the half period
shift with exchanged flanks is another. A motion that a symmetry does not map to itself has mirror images,
which are all motions of the same machine (Golubitsky, Stewart, Schaeffer 1988).
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from facegear.arrays import AnyArray, Array, Integers
from facegear.harmonics import stacked_values
from facegear.motion.integrator.system import System

SYMMETRIC = 1e-8
"""Relative difference up to which two contacts, loads or couplings count as equal. Perturbations of 1e-12,
as of rounded phases, stay far below it and real imperfections far above it."""
PHASES = 96
"""Phases in a mesh period at which force laws, errors and loads are compared; no harmonic has this order."""
MAX_SYMMETRIES = 720
"""Largest number of symmetries that are listed: six equal pinions that only a gear's rotation couples
have as many.
"""


@dataclass(frozen=True, eq=False)
class Symmetry:
    """The map y(s) -> matrix y(s + shift) of motions y (n,), with the phase s in mesh periods.

    The image's deflection of contact i is signs[i] times that of contact contacts[i], a shift later.

    Attributes
    ----------
    matrix : (n, n) array
        Orthogonal matrix.
    contacts : (contacts,) array
        Contact whose deflection each contact takes over.
    signs : (contacts,) array
        1, or -1 where a contact takes the deflection over with the opposite sign.
    meshes : (meshes,) array
        Mesh whose deflection each mesh takes over.
    mesh_signs : (meshes,) array
        Signs of the deflections of meshes.
    shift : float
        Shift in mesh periods, in [0, 1).
    """

    matrix: Array
    contacts: Integers
    signs: Array
    meshes: Integers
    mesh_signs: Array
    shift: float


@lru_cache(maxsize=16)
def symmetries(system: System) -> tuple[Symmetry, ...]:
    """Find all symmetries of a system but the identity, by backtracking over permutations of its
    contacts.

    Parameters
    ----------
    system : System
        Equations of motion.

    Returns
    -------
    tuple of Symmetry
        At most MAX_SYMMETRIES; none are sought where contacts move in the mesh cycle.
    """
    if system.phase_shifts is not None:
        return ()
    return _Search(system).list_symmetries()


@lru_cache(maxsize=16)
def mesh_images(system: System) -> Integers:
    """Return how the symmetries of a system exchange its meshes.

    A quantity (meshes,) without sign, such as the RMS, of an image of a motion is `quantity[image]`.

    Parameters
    ----------
    system : System
        Equations of motion.

    Returns
    -------
    (images, meshes) array
        Permutations of the meshes, each once; the first row is the identity.
    """
    count = system.pairs or system.contacts
    rows = [np.arange(count), *(symmetry.meshes for symmetry in symmetries(system))]
    return np.array(list(dict.fromkeys(map(tuple, rows))), dtype=np.int64).reshape(-1, count)


class _Search:
    """Search by backtracking for signed permutations of the contacts that leave the system unchanged.

    Coordinates of equal bearing frequency and damping make one group; `gram` (contacts, contacts, groups)
    has the products of the Jacobian's rows in each. A signed permutation of the rows of the Jacobian
    comes from an orthogonal map among the coordinates if it leaves the Gram matrix of each group
    unchanged.
    """

    def __init__(self, system: System) -> None:
        self.system, self.count = system, system.contacts
        self.jacobian = system.mesh_jacobian[: self.count]
        groups = _groups(np.column_stack([system.omega_squared, system.damping]))
        self.groups = groups
        parts = [self.jacobian[:, group] for group in groups]
        gram = np.stack([part @ part.T for part in parts], axis=-1)
        self.gram = gram / np.abs(gram).max(initial=1e-300)
        self.cycles = np.arange(PHASES) / PHASES
        levels = np.unique(system.law.levels.max(axis=1, initial=0.0))
        steps = np.append(levels[1:], levels[-1] + max(levels[-1], system.scale))
        self.amounts = 0.5 * (levels + steps)

    def list_symmetries(self) -> tuple[Symmetry, ...]:
        """Return all symmetries but the identity."""
        symmetries_so_far: list[Symmetry] = []
        for shift in self._shifts():
            for contacts, signs in self._permutations(shift):
                symmetry = self._symmetry(contacts, signs, shift)
                if symmetry is not None:
                    symmetries_so_far.append(symmetry)
                if len(symmetries_so_far) == MAX_SYMMETRIES:
                    return tuple(symmetries_so_far)
        return tuple(symmetries_so_far)

    def _shifts(self) -> list[float]:
        """Return the shifts in time, in mesh periods, at which a symmetry may exist; 0 is always among
        them.

        They make the first contact that varies over the period equal to another one: in its force law, or
        in its error or load, both up to their sign. Where nothing varies, only the shift 0 is examined.
        """
        forces = self._forces(0.0)[0]
        signed_signals = np.stack([self._errors(0.0), self._load(0.0)[0] @ self.jacobian.T])
        signals = [(force,) for force in forces] + [(signal, -signal) for signal in signed_signals]
        for versions in signals:
            waves = np.fft.rfft(versions, axis=1)[:, 1:-1]
            sizes = np.abs(waves[0])
            strong_lines = np.argwhere(sizes > SYMMETRIC * PHASES * np.abs(versions[0]).max())
            if len(strong_lines):
                harmonic, first = (int(number) for number in strong_lines[0])
                order, reference = harmonic + 1, waves[0, harmonic, first]
                is_similar = np.abs(np.abs(waves[:, harmonic]) - abs(reference)) <= 0.1 * abs(reference)
                turns = np.angle(reference / waves[:, harmonic][is_similar]) / (2.0 * np.pi)
                shifts = (turns[:, None] + np.arange(order)) / order
                return sorted({0.0, *(round(float(shift) % 1.0, 12) % 1.0 for shift in shifts.ravel())})
        return [0.0]

    def _forces(self, shift: float) -> tuple[Array, Array]:
        """Return the contact forces at PHASES phases a shift later, pressed in by `amounts`, each
        (amounts, phases, contacts), N.

        First those above the upper edge, then those below the lower edge. There is one amount within each
        piece of the law.
        """
        amounts = np.broadcast_to(self.amounts[:, None, None], (self.amounts.size, PHASES, self.count))
        force = self.system.law.force
        return force(self.cycles + shift, amounts), force(self.cycles + shift, -amounts)

    def _errors(self, shift: float) -> Array:
        """Return the transmission errors e (phases, contacts), m, at PHASES phases of a mesh period, a
        shift (mesh periods) later.
        """
        values = stacked_values(self.system.error, self.cycles + shift)
        return values[:, self.system.error_kind[: self.count]]

    def _compatible(self, shift: float) -> AnyArray:
        """Return whether contact i may take over the deflection of contact j with a sign, a mask
        (contacts, contacts, 2).

        The last axis is the sign: +, then -. Damping, edges, errors, and force laws a shift later must
        agree.
        """
        system, count = self.system, self.count
        lower, upper = system.lower[:count], system.upper[:count]
        fits = np.ones((count, count, 2), dtype=bool)
        fits &= _near(system.mesh_damping[:count, None], system.mesh_damping[:count])[..., None]
        (above, below), (later, later_below) = self._forces(0.0), self._forces(shift)
        error, later_error = self._errors(0.0), self._errors(shift)
        for number, sign in enumerate((1.0, -1.0)):
            edges = (lower, upper) if sign > 0.0 else (-upper, -lower)
            for edge, image_edge in zip((lower, upper), edges, strict=True):
                fits[..., number] &= _near(edge[:, None], image_edge, system.scale)
            fits[..., number] &= _curves_agree(error, sign * later_error, system.scale)
            one_sided = np.isinf(lower) | np.isinf(upper)
            if sign > 0.0:
                fits[..., number] &= _curves_agree(above, later)
                fits[..., number] &= one_sided[:, None] | _curves_agree(below, later_below)
            else:
                fits[..., number] &= ~one_sided[:, None]
                fits[..., number] &= _curves_agree(above, -later_below) & _curves_agree(below, -later)
        return fits

    def _permutations(self, shift: float) -> Iterator[tuple[Integers, Array]]:
        """Yield permutations of the contacts, as indices, with signs, (contacts,) each, that may be
        symmetries with a shift.

        They keep force laws, errors, pairs of flanks and Gram matrices; loads and bearings are still to
        be checked.
        """
        fits = self._compatible(shift)
        yield from self._extend([], [], fits)

    def _extend(
        self, contacts: list[int], signs: list[float], fits: AnyArray
    ) -> Iterator[tuple[Integers, Array]]:
        """Yield all permutations with signs that begin with given contacts and signs and keep the Gram
        matrices.

        `fits` is the mask of _compatible(): it says which contact may take over which.
        """
        index, pairs = len(contacts), self.system.pairs
        if index == self.count:
            yield np.array(contacts, dtype=np.int64), np.array(signs)
            return
        for contact in range(self.count):
            if contact in contacts:
                continue
            if pairs and index >= pairs and contact % pairs != contacts[index - pairs] % pairs:
                continue
            for number, sign in enumerate((1.0, -1.0)):
                if not fits[index, contact, number]:
                    continue
                candidate, all_signs = [*contacts, contact], np.array([*signs, sign])
                gram_row = self.gram[contact, candidate] * (sign * all_signs)[:, None]
                if np.abs(gram_row - self.gram[index, : index + 1]).max() <= SYMMETRIC:
                    yield from self._extend(candidate, all_signs.tolist(), fits)

    def _symmetry(self, contacts: Integers, signs: Array, shift: float) -> Symmetry | None:
        """Return the symmetry that permutes contacts with signs and shifts time, or None for the identity
        or where there is none.

        Its matrix solves vectors @ matrix = images by least squares, and must be orthogonal.
        """
        if shift == 0.0 and (contacts == np.arange(self.count)).all() and (signs > 0.0).all():
            return None
        vectors, mapped = self._known_images(contacts, signs, shift)
        if _rank(vectors) < self.system.size:
            return None
        matrix = np.asarray(np.linalg.lstsq(vectors, mapped, rcond=None)[0], dtype=np.float64)
        if not _near(matrix @ matrix.T, np.eye(self.system.size), 1.0).all():
            return None
        if not _near(vectors @ matrix, mapped, 1.0).all() or not self._keeps_the_rest(matrix):
            return None
        pairs = self.system.pairs
        changes_flank = (contacts[:pairs] >= pairs) if pairs else signs < 0.0
        return Symmetry(
            matrix=matrix,
            contacts=contacts,
            signs=signs,
            meshes=contacts[:pairs] % pairs if pairs else contacts,
            mesh_signs=np.where(changes_flank, -1.0, 1.0),
            shift=shift,
        )

    def _known_images(self, contacts: Integers, signs: Array, shift: float) -> tuple[Array, Array]:
        """Return rows (k, n) whose images under a signed permutation of contacts and a shift are known,
        and these images (k, n).

        The rows are those of the Jacobian, friction and load, their products with the couplings, and the
        directions that bearings with clearance feel beside them.
        """
        sign_column = signs[:, None, None]
        known_pairs = [
            (self.jacobian[:, None], sign_column * self.jacobian[contacts][:, None]),
            (self._friction(0.0), sign_column * self._friction(shift)[contacts]),
            (self._load(0.0), self._load(shift)),
        ]
        vectors, mapped = (self._by_group(rows) for rows in zip(*map(_scale_rows, known_pairs), strict=True))
        for matrix in self._couplings:
            if _rank(vectors) < self.system.size:
                vectors, mapped = (self._by_group([rows, rows @ matrix]) for rows in (vectors, mapped))
        if _rank(vectors) < self.system.size and len(self._rings):
            vectors, mapped = self._with_rings(vectors, mapped, self._ring_images(contacts, signs))
        return vectors, mapped

    def _by_group(self, rows: Sequence[Array]) -> Array:
        """Return rows (k, n), each cut to the coordinates of one group, group by group: (groups * k, n).

        The image of a row holds for its part in each group, since a symmetry does not mix groups.
        """
        whole, size = np.concatenate(rows), self.system.size
        return np.concatenate([whole * np.isin(np.arange(size), group) for group in self.groups])

    def _friction(self, shift: float) -> Array:
        """Return the generalised force (contacts, phases, n) of friction for a unit force of each
        contact, a shift later.
        """
        rubbing = self.system.rubbing
        vectors = np.zeros((self.count, PHASES, self.system.size))
        if rubbing is not None:
            ratios = stacked_values(rubbing.ratios, self.cycles + shift)
            for flank, ratio, direction in zip(rubbing.flank, ratios.T, rubbing.directions, strict=True):
                vectors[flank] += np.outer(ratio, direction)
        return vectors

    def _load(self, shift: float) -> Array:
        """Return the generalised load (1, phases, n) at PHASES phases of a mesh period, a shift (mesh
        periods) later.
        """
        return stacked_values(self.system.load, self.cycles + shift)[None]

    @property
    def _couplings(self) -> list[Array]:
        """Matrices (n, n) of the dampers, gyroscopic, circulatory and centrifugal coupling, each divided
        by its largest entry.
        """
        coupling = self.system.coupling
        if coupling is None:
            return []
        matrices = (coupling.dampers, coupling.gyroscopic, coupling.circulatory, coupling.centrifugal)
        return [matrix / np.abs(matrix).max() for matrix in matrices if matrix.any()]

    @property
    def _rings(self) -> Array:
        """Jacobian rows (rings, 2, n) of the bearings with clearance: their displacements along x and y
        by the coordinates.
        """
        rows = self.system.mesh_jacobian[self.count :].reshape(-1, 3, self.system.size)
        return np.asarray(rows[:, :2])

    def _ring_images(self, contacts: Integers, signs: Array) -> list[tuple[Array, Array]]:
        """Return, for each bearing with clearance, its rows (2, n) and those of the bearing that it
        becomes in the image.

        They are found by the products of the contacts' rows with them; a bearing without an equal is left
        out.
        """
        image_jacobian = signs[:, None] * self.jacobian[contacts]
        size = np.abs(self.jacobian).max() ** 2
        pairs = []
        for ring in self._rings:
            gram = self.jacobian @ ring.T @ ring @ self.jacobian.T / size
            for other_ring in self._rings:
                image = image_jacobian @ other_ring.T @ other_ring @ image_jacobian.T / size
                if _near(gram, image, 1.0).all():
                    pairs.append((ring, other_ring))
                    break
        return pairs

    def _with_rings(
        self, vectors: Array, mapped: Array, images: Sequence[tuple[Array, Array]]
    ) -> tuple[Array, Array]:
        """Return rows (rows, n) and their images, extended by those of bearings with clearance.

        Added are the part of each row that a bearing feels, and the direction that only this bearing
        feels. `images` come from _ring_images().
        """
        for ring, image_ring in images:
            vectors = np.concatenate([vectors, vectors @ ring.T @ ring])
            mapped = np.concatenate([mapped, mapped @ image_ring.T @ image_ring])
        outside = [
            np.eye(self.system.size) - np.linalg.pinv(rows, rcond=SYMMETRIC) @ rows
            for rows in (vectors, mapped)
        ]
        alone = [
            [_only_direction(rows @ beyond) for rows, beyond in zip(pair, outside, strict=True)]
            for pair in images
        ]
        beside = np.array(alone).reshape(-1, 2, self.system.size)
        return np.concatenate([vectors, beside[:, 0]]), np.concatenate([mapped, beside[:, 1]])

    def _keeps_the_rest(self, matrix: Array) -> bool:
        """Whether an orthogonal map (n, n) leaves bearing frequencies, damping, couplings and bearings
        with clearance unchanged.
        """
        system = self.system
        diagonal = [np.diag(values) for values in (system.omega_squared, system.damping)]
        diagonals = [values / max(np.abs(values).max(), 1e-300) for values in diagonal]
        if not all(_near(rest @ matrix, matrix @ rest, 1.0).all() for rest in (*diagonals, *self._couplings)):
            return False
        values = np.column_stack([system.ring_stiffness, system.ring_clearance])
        rings = [ring.T @ ring for ring in self._rings]
        return all(
            any(
                _near(ring_values, image_values).all() and _near(matrix.T @ ring @ matrix, image, 1.0).all()
                for image_values, image in zip(values, rings, strict=True)
            )
            for ring_values, ring in zip(values, rings, strict=True)
        )


def _groups(keys: Array) -> list[Integers]:
    """Return the indices of the coordinates with equal keys (n, 2), group by group; SYMMETRIC says what
    is equal.
    """
    scale = np.maximum(np.abs(keys).max(axis=0), 1e-300)
    groups: list[list[int]] = []
    for number, key in enumerate(keys):
        matching_groups = (group for group in groups if _near(keys[group[0]] / scale, key / scale).all())
        group = next(matching_groups, None)
        if group is None:
            groups.append([number])
        else:
            group.append(number)
    return [np.array(group) for group in groups]


def _near(first: Array, second: Array, scale: float = 0.0) -> AnyArray:
    """Return where two arrays are equal to within SYMMETRIC of the larger of them and of `scale`;
    infinities equal themselves.
    """
    size = np.maximum(np.maximum(np.abs(first), np.abs(second)), scale)
    with np.errstate(invalid="ignore"):
        return np.asarray((first == second) | (np.abs(first - second) <= SYMMETRIC * size))


def _curves_agree(curves: Array, other_curves: Array, scale: float = 0.0) -> AnyArray:
    """Return which curves (..., contacts) agree with which other curves, as a mask (contacts, contacts).

    Row i, column j compares contact i of `curves` with contact j of `other_curves`, to within SYMMETRIC
    of the largest value of `curves` or of `scale`.
    """
    first, second = (values.reshape(-1, values.shape[-1]) for values in (curves, other_curves))
    size = max(np.abs(first).max(initial=0.0), scale, 1e-300)
    return np.asarray(np.abs(first[:, :, None] - second[:, None]).max(axis=0) <= SYMMETRIC * size)


def _only_direction(rows: Array) -> Array:
    """Return the dominant right singular vector (n,) of two rows (2, n), times its singular value."""
    _, sizes, axes = np.linalg.svd(rows)
    return np.asarray(sizes[0] * axes[0])


def _rank(rows: Array) -> int:
    """Return the numerical rank of rows (k, n), to SYMMETRIC of their largest singular value."""
    return int(np.linalg.matrix_rank(rows, tol=SYMMETRIC * np.linalg.norm(rows, 2)))


def _scale_rows(rows: tuple[Array, Array]) -> tuple[Array, Array]:
    """Return rows (..., n) and their images as matrices (k, n), both divided by the largest entry of the
    rows.

    Rows of zeros are left out.
    """
    first, second = (values.reshape(-1, values.shape[-1]) for values in rows)
    size = max(np.abs(first).max(initial=0.0), 1e-300)
    is_nonzero = np.abs(first).max(axis=1, initial=0.0) > 0.0
    return first[is_nonzero] / size, second[is_nonzero] / size
