"""Assembly, refinement ties, condensation and the ring of teeth."""

from dataclasses import replace
from math import radians

import numpy as np
import pytest
import scipy.sparse as sp
import scipy.sparse.linalg as spl
from contact_bodies import STEEL, block, half_disc, stiffness, stiffness_of
from references import against, agrees
from skfem import Basis, ElementHex1, ElementHex2, ElementTetP1, ElementVector, MeshHex1, MeshHex2
from skfem.models.elasticity import lame_parameters, linear_elasticity

from facegear.contact.bodies.compliance import flank_compliance
from facegear.contact.bodies.elements import mesh_of
from facegear.contact.bodies.layer import tied_system
from facegear.contact.bodies.ring import LEFT, RIGHT, apart, chain, join_chains, moved_faces, rest_stiffness
from facegear.contact.bodies.substructure import condense
from facegear.contact.gear_flank import GearFlank, from_arrays, to_arrays
from facegear.contact.options import Refinement
from facegear.contact.root_gauges import root_gauges
from facegear.contact.teeth import contact_side, elastic_tooth
from facegear.errors import FacegearError
from facegear.sparse import dissection
from facegear.sparse.elimination import schur_complement
from facegear.sparse.matrices import cell_unknowns, solve_sparse
from facegear.teeth.design import FaceGearGeometry, PairDesign, PinionGeometry, Shaper
from facegear.teeth.mesh_quality import hex_mesh
from facegear.teeth.mesh_sizes import MeshSizes
from facegear.teeth.tooth_mesh import gear_tooth, pinion_tooth, sector
from validation.contact.sector_model import sector_blocks
from validation.contact.twin import slab_tooth

DISC = half_disc(0.01, np.linspace(0, 1, 5), np.linspace(0, 1, 5))
CUTS = Refinement(3, 1, 2, 2.0)


def spur(teeth=17):
    m = 4e-3
    pinion = PinionGeometry(teeth, 0.004, m, 1.25 * m, 0.2 * m, 0.022)
    return PairDesign(
        m, radians(20), pinion, FaceGearGeometry(80, 0.16, 0.17, m, 0.01), Shaper(teeth, 1.25 * m)
    )


@pytest.fixture(scope="module")
def slab():
    """A plane-strain spur tooth, coarse, and its body."""
    tooth = slab_tooth(spur(), MeshSizes(1.5e-3, 2e-3, 2.5e-3))
    elastic, _ = elastic_tooth(spur(), tooth, STEEL, "right")
    held = elastic.is_held.copy()
    held[:, 1] = True
    return tooth, replace(elastic, is_held=held)


@pytest.fixture(scope="module")
def ring(slab):
    """All teeth meshed whole, and their stiffness."""
    tooth, _ = slab
    teeth = sector(tooth, tooth.teeth)
    return teeth, in_tooth_order(*hex_mesh(teeth.nodes, teeth.hexes))


def in_tooth_order(mesh, number):
    """Stiffness with its dof in the order of the nodes of which `number` are the mesh's."""
    order = (3 * number[:, None] + np.arange(3)).ravel()
    return stiffness_of(mesh)[order][:, order]


def bent(points):
    x, y, z = points
    return np.stack([x + 0.1 * y * z, y * (1 + 0.2 * x), z + 0.1 * x**2])


@against(
    "third-party program",
    "scikit-fem's own assembly of the elastic form",
    capability="compliance",
    module="facegear.contact.bodies.elements",
)
@pytest.mark.parametrize(
    ("element", "kind"), [("hex27", ElementHex2), ("hex8", ElementHex1), ("tet4", ElementTetP1)]
)
def test_batched_assembly_is_scikit_fem_s_own_form_to_rounding(element, kind):
    ends = np.linspace(0, 1, 3)
    straight = MeshHex2.from_mesh(MeshHex1.init_tensor(ends, ends**1.3, ends))
    mesh = replace(straight, doflocs=bent(straight.doflocs))
    degree = {"hex27": 5, "hex8": 3, "tet4": 1}[element]
    basis = Basis(mesh_of(mesh, element), ElementVector(kind()), intorder=degree)
    form = linear_elasticity(*lame_parameters(STEEL.young_modulus, STEEL.poisson_ratio))
    difference = stiffness_of(mesh, element) - form.assemble(basis)
    agrees(
        "difference of stiffness matrices, N/m",
        difference.data,
        0.0,
        absolute=1e-13 * np.abs(stiffness_of(mesh, element).data).max(),
    )


@pytest.mark.parametrize("element", ["hex8", "tet4"])
def test_linear_elements_of_a_tooth_fill_it_without_gaps_between_them(element):
    tooth = slab_tooth(spur(), MeshSizes(1.5e-3, 2e-3, 2.5e-3))
    mesh, _ = hex_mesh(tooth.nodes, tooth.hexes)
    parts = mesh_of(mesh, element)
    facets_on_a_face = {"hex8": 4, "tet4": 8}[element]
    assert len(parts.boundary_facets()) == facets_on_a_face * len(mesh.boundary_facets())
    np.testing.assert_array_equal(parts.doflocs, mesh.doflocs)


def test_an_element_turned_inside_out_is_refused():
    mesh = MeshHex2.from_mesh(MeshHex1())
    corner = mesh.doflocs.copy()
    corner[:, 0] = [0.9, 0.9, 0.9]
    with pytest.raises(ValueError, match="1 elements are inverted"):
        stiffness_of(replace(mesh, doflocs=corner))


@against(
    "analytic",
    "rigid motion loads nothing",
    capability="compliance",
    module="facegear.contact.bodies.layer",
)
@pytest.mark.parametrize("cuts", [Refinement(), CUTS, Refinement(2, 2, 3, 1.5)])
def test_rigid_motion_of_a_refined_body_needs_no_force(cuts):
    system = tied_system(DISC, cuts)
    points, matrix = system.points, stiffness(system.parts)
    rotation = np.cross([0.3, -0.2, 1.0], points)
    for motion in (np.ones_like(points), rotation):
        force = matrix @ motion.ravel()
        scale = np.abs(matrix).max() * np.abs(motion).max()
        agrees("force of a rigid motion, N", force, 0.0, absolute=1e-12 * scale)


@against(
    "manufactured",
    "patch test: uniform strain",
    capability="compliance",
    module="facegear.contact.bodies.layer",
)
def test_uniform_strain_passes_the_ties_of_the_refined_layer():
    box = block(
        np.linspace(0, 2, 4),
        np.linspace(0, 1, 3),
        np.linspace(0, 1, 3),
        held=lambda p: np.zeros(p.shape, bool),
    )
    rows = slice(2, 5)
    piece = replace(box, flank=box.flank[rows], normals=box.normals[rows])
    system = tied_system(piece, CUTS)
    strain = np.array([[1.0, 0.4, -0.2], [0.4, -0.5, 0.3], [-0.2, 0.3, 0.8]])
    force = (stiffness(system.parts) @ (system.points @ strain).ravel()).reshape(-1, 3)
    p = system.points
    inside = ((p > 1e-9) & (p < np.array([2, 1, 1]) - 1e-9)).all(axis=1)
    assert inside.sum() > 50
    agrees("force on nodes inside, N", force[inside], 0.0, absolute=1e-11 * np.abs(force).max())


def test_finer_layers_make_the_body_softer_and_never_stiffer():
    softness = []
    for cuts in (Refinement(), Refinement(2, 1, 1), Refinement(2, 1, 2), Refinement(4, 1, 4)):
        compliance = flank_compliance(DISC, cuts)
        middle = np.array(compliance.shape) // 2
        nodes = middle[0] * compliance.shape[1] + np.arange(compliance.shape[1])
        weights = np.array([1, 4, 1]) / 6
        softness.append(weights @ compliance.loaded_tooth[np.ix_(nodes, nodes)] @ weights)
    assert (np.diff(softness) > 0).all()


@against(
    "analytic",
    "Maxwell's reciprocity",
    capability="compliance",
    module="facegear.contact.bodies.compliance",
)
def test_influence_matrix_is_symmetric():
    own = flank_compliance(DISC, CUTS).loaded_tooth
    agrees("influence matrix less its transpose, m/N", own, own.T, absolute=1e-10 * np.abs(own).max())


@against(
    "third-party program",
    "SciPy's SuperLU",
    capability="compliance",
    module="facegear.sparse.elimination",
)
@pytest.mark.parametrize("leaf", [20, 300, 10**6])
def test_complement_of_a_body_is_the_same_however_finely_it_is_dissected(leaf, monkeypatch):
    monkeypatch.setattr(dissection, "LEAF", leaf)
    system = tied_system(DISC, CUTS)
    free = ~system.is_held.ravel()
    parts = [part.seen_by(sp.eye(free.size, format="csr")[:, free]) for part in system.parts]
    matrix = stiffness(parts)
    kept = np.arange(90, 0, -3)
    rest = np.setdiff1d(np.arange(matrix.shape[0]), kept)
    readings = sp.random_array((4, matrix.shape[0]), density=0.2, rng=np.random.default_rng(0), format="csr")
    readings *= 1e-4 * matrix.max()
    bordered = sp.block_array([[matrix, readings.T], [readings, None]], format="csr")
    seen = np.concatenate([kept, matrix.shape[0] + np.arange(4)])
    across = bordered[rest][:, seen].toarray()
    expected = bordered[seen][:, seen] - across.T @ spl.splu(matrix[rest][:, rest].tocsc()).solve(across)
    computed = schur_complement(parts, kept, system.centres, readings)
    agrees(
        "Schur complement, N/m",
        np.tril(computed),
        np.tril(expected),
        relative=1e-7,
        absolute=1e-11 * np.abs(expected).max(),
    )
    cells = cell_unknowns(parts, len(system.centres))
    assert (len(dissection.dissection(cells, system.centres, kept)) > 1) == (leaf < 10**6)


@against(
    "third-party program",
    "PARDISO of MKL beside SciPy's SuperLU",
    capability="compliance",
    module="facegear.sparse.matrices",
)
def test_both_sparse_solvers_give_the_same_displacements():
    pypardiso = pytest.importorskip("pypardiso", reason="extra `benchmark`, where MKL has a wheel")
    system = tied_system(DISC, CUTS)
    free = ~system.is_held.ravel()
    matrix = stiffness(system.parts)[free][:, free].tocsr()
    unit = np.zeros((matrix.shape[0], 1))
    unit[0] = 1.0
    computed = solve_sparse(matrix, unit)
    expected = pypardiso.spsolve(matrix, unit)
    agrees(
        "displacement of a unit force, m",
        computed.ravel(),
        expected.ravel(),
        relative=1e-7,
        absolute=1e-10 * np.abs(expected).max(),
    )


def test_a_singular_system_is_refused_in_one_line():
    with pytest.raises(FacegearError, match="factorisation of 2 dof failed: Factor is exactly singular"):
        solve_sparse(sp.csr_matrix([[1.0, 1.0], [1.0, 1.0]]), np.ones((2, 1)))


def test_body_that_nothing_holds_is_refused_in_one_line():
    loose = replace(DISC, is_held=np.zeros_like(DISC.is_held))
    with pytest.raises(FacegearError) as error:
        flank_compliance(loose, Refinement())
    assert "\n" not in str(error.value)


@against(
    "third-party program",
    "all teeth meshed whole, scipy.sparse.linalg.spsolve",
    capability="compliance",
    module="facegear.contact.bodies.compliance",
)
@pytest.mark.parametrize("places", [0, 1, -2])
def test_ring_of_one_condensed_tooth_is_the_ring_meshed_whole(slab, ring, places):
    (tooth, elastic), (ring, stiffness) = slab, ring
    _, gauges = root_gauges(tooth, STEEL)
    compliance = flank_compliance(elastic, Refinement(), tooth.teeth, 2, "ring", gauges=gauges)
    assert ring.is_closed
    flank = contact_side(spur(), tooth, "right").nodes.ravel()
    normals = elastic.normals.reshape(-1, 3)
    free = np.ones((len(ring.nodes), 3), dtype=bool)
    free[:, 1] = False
    free[ring.tooth_nodes[:, tooth.faces["bore"]].ravel()] = False
    load_at, seen_at = 5 * 3 + 1, 9 * 3 + 2
    rhs = np.zeros((len(ring.nodes), 3))
    rhs[ring.tooth_nodes[0][flank[load_at]]] = normals[load_at]
    moved = np.zeros(free.size)
    moved[free.ravel()] = spl.spsolve(stiffness[free.ravel()][:, free.ravel()].tocsc(), rhs[free])
    node = ring.tooth_nodes[places % tooth.teeth][flank[seen_at]]
    normal = tooth.rotated(normals[seen_at], places * tooth.pitch)
    expected = moved.reshape(-1, 3)[node] @ normal
    own = compliance.loaded_tooth if places == 0 else compliance.block(places)
    agrees("displacement of a unit force, m", own[seen_at, load_at], expected, relative=1e-8)
    _, number = hex_mesh(tooth.nodes, tooth.hexes)
    here = np.empty_like(tooth.nodes)
    here[number] = tooth.rotated(
        moved.reshape(-1, 3)[ring.tooth_nodes[places % tooth.teeth]], -places * tooth.pitch
    )
    stress, read = gauges @ here.ravel(), compliance.readings[2 + places][:, load_at]
    agrees("stress at the gauges, Pa", read, stress, absolute=1e-8 * np.abs(stress).max())


def test_gauges_on_a_tooth_change_nothing_of_how_the_teeth_of_a_ring_move_each_other(slab):
    """Without them one side's neighbours stand for both."""
    tooth, elastic = slab
    _, gauges = root_gauges(tooth, STEEL)
    with_gauges, without = (
        flank_compliance(elastic, CUTS, tooth.teeth, 2, gauges=rows) for rows in (gauges, None)
    )
    assert len(without.readings) == len(with_gauges.readings) == len(without.neighbour_blocks)
    known = with_gauges.neighbour_blocks
    np.testing.assert_allclose(without.neighbour_blocks, known, rtol=0.0, atol=1e-11 * np.abs(known).max())
    np.testing.assert_allclose(
        without.loaded_tooth, with_gauges.loaded_tooth, rtol=0.0, atol=1e-11 * with_gauges.loaded_tooth.max()
    )


def test_sector_of_one_condensed_tooth_is_the_sector_meshed_whole():
    design = spur()
    tooth = pinion_tooth(design, MeshSizes(1.5e-3, 2e-3, 2.5e-3))
    elastic, side = elastic_tooth(design, tooth, STEEL)
    row = sector(tooth, 4, -2)
    blocks = sector_blocks(design, tooth, STEEL, 4, (-1, 1), Refinement())
    stiffness = in_tooth_order(*hex_mesh(row.nodes, row.hexes))
    free = np.ones((len(row.nodes), 3), dtype=bool)
    free[row.tooth_nodes[:, tooth.faces["bore"]].ravel()] = False
    nodes = row.tooth_nodes[:, side.nodes.ravel()[[8, 13]]]
    normals = [
        tooth.rotated(elastic.normals.reshape(-1, 3)[[8, 13]], (j - 2) * tooth.pitch) for j in range(4)
    ]
    push = np.zeros((len(row.nodes), 3))
    push[nodes[3, 0]] = normals[3][0]
    moved = np.zeros(free.size)
    moved[free.ravel()] = spl.spsolve(stiffness[free.ravel()][:, free.ravel()].tocsc(), push[free])
    for seen in (-1, 1):
        expected = moved.reshape(-1, 3)[nodes[seen + 2, 1]] @ normals[seen + 2][1]
        assert blocks[seen, 1][13, 8] == pytest.approx(expected, rel=1e-8)


@pytest.mark.parametrize("teeth", [3, 50, 51])
def test_a_chain_of_teeth_is_the_one_joined_tooth_by_tooth(slab, teeth):
    faces = condense(tied_system(slab[1], Refinement())).faces
    joined_in_turn = faces
    for _ in range(teeth - 1):
        joined_in_turn = join_chains(joined_in_turn, faces)
    long = chain(faces, teeth)
    np.testing.assert_allclose(long, joined_in_turn, rtol=0.0, atol=1e-12 * np.abs(faces).max())
    assert apart(long) == (teeth > 3)


@against(
    "analytic",
    "Maxwell's reciprocity between teeth",
    capability="compliance",
    module="facegear.contact.bodies.ring",
)
def test_neighbouring_refined_teeth_move_each_other_alike(slab):
    """Maxwell's reciprocity between teeth, by which a tooth's neighbours on one side stand for both."""
    tooth, elastic = slab
    condensed = condense(tied_system(elastic, CUTS))
    rests = rest_stiffness(condensed.faces, 2, tooth.teeth, "ring")
    held = np.linalg.solve(condensed.faces + rests[0][0], condensed.influence.T)
    left, right = (moved_faces(condensed.faces, rests, held, side) for side in (LEFT, RIGHT))
    for back, there in zip(left, right, strict=True):
        there, back = condensed.influence @ there, condensed.influence @ back
        agrees(
            "influence of one tooth on another, m/N",
            there,
            back.T,
            relative=1e-7,
            absolute=1e-10 * np.abs(there).max(),
        )


@pytest.mark.parametrize(("layers", "element"), [(2, "hex27"), (3, "hex27"), (1, "tet4"), (2, "hex8")])
def test_two_halves_of_a_symmetric_tooth_give_way_as_the_whole_one(layers, element):
    design = spur()
    tooth = pinion_tooth(design, MeshSizes(2.5e-3, design.pinion.width / layers, 4e-3))
    elastic, _ = elastic_tooth(design, tooth, STEEL)
    _, gauges = root_gauges(tooth, STEEL)
    cuts = Refinement(2, 2, 1)
    assert elastic.mirror.size
    uncut = replace(elastic, mirror=elastic.mirror[:0])
    halved, expected = (
        flank_compliance(body, cuts, tooth.teeth, 1, element=element, gauges=gauges)
        for body in (elastic, uncut)
    )
    for name in ("loaded_tooth", "neighbour_blocks", "readings"):
        known = getattr(expected, name)
        np.testing.assert_allclose(
            getattr(halved, name), known, rtol=0.0, atol=1e-11 * np.abs(known).max(), err_msg=name
        )


def test_only_a_tooth_that_is_its_own_mirror_image_is_halved():
    tooth = pinion_tooth(spur(), MeshSizes(2.5e-3, 11e-3, 4e-3))
    askew = replace(tooth, nodes=tooth.nodes + np.array([1e-9, 0.0, 0.0]) * tooth.nodes[:, 1:2])
    wide = gear_tooth(spur(), MeshSizes(2.5e-3, 5e-3, 4e-3))
    assert elastic_tooth(spur(), tooth, STEEL)[0].mirror.size == len(tooth.nodes)
    for other in (askew, wide):
        assert elastic_tooth(spur(), other, STEEL)[0].mirror.size == 0
    body, _ = elastic_tooth(spur(), tooth, STEEL)
    held = body.is_held.copy()
    held[body.flank[0, 0]] = True
    with pytest.raises(ValueError, match="mirror image"):
        replace(body, is_held=held)


def test_sectors_bracket_the_ring_and_close_in_on_it(slab):
    tooth, elastic = slab
    rigid = [flank_compliance(elastic, Refinement(), n, 1, "clamped").loaded_tooth.trace() for n in (5, 9)]
    loose = [flank_compliance(elastic, Refinement(), n, 1, "free").loaded_tooth.trace() for n in (5, 9)]
    ring = flank_compliance(elastic, Refinement(), tooth.teeth, 1, "ring").loaded_tooth.trace()
    assert rigid[0] < rigid[1] < ring < loose[1] < loose[0]


def test_sector_with_too_few_teeth_is_refused(slab):
    with pytest.raises(ValueError, match="do not fit"):
        flank_compliance(slab[1], Refinement(), 5, 2, "free")


def test_stored_flank_of_a_gear_comes_back_unchanged(slab):
    tooth, elastic = slab
    side = contact_side(spur(), tooth, "right")
    flank = GearFlank(side, flank_compliance(elastic, CUTS, tooth.teeth, 1))
    again = from_arrays(to_arrays(flank))
    for one, other in ((again.side, side), (again.compliance, flank.compliance)):
        for name in one.__dataclass_fields__:
            np.testing.assert_equal(getattr(one, name), getattr(other, name))
