"""The whole config and the checks that reach across its sections."""

from dataclasses import replace
from math import isclose
from pathlib import Path
from typing import Any

from pydantic import Field, model_validator

from facegear.build.casing import check_casing, content
from facegear.build.checks import (
    CONTACT_ASKED,
    check_load,
    check_machine_strain,
    check_pitch,
    check_pitch_once,
    check_posed_variants,
    check_poses,
    check_positions,
    check_strain,
    check_torques,
    geometric_backlash,
    memory_here,
    pair_teeth,
    with_backlash,
)
from facegear.build.elastic_bodies import check_bodies, elastic_gears
from facegear.build.lower_gear import check_gear_alone, check_lower_gear
from facegear.build.notes import require_buildable
from facegear.build.plans import contact_plan, mesh_sizes
from facegear.build.rolling import check_preloads
from facegear.build.study_checks import check_search, check_studies, check_tolerances
from facegear.build.tooth_pair import ToothPair, materials, pair_design
from facegear.contact.resolution import (
    along_the_ellipse,
    check_fillet,
    check_memory,
    check_resolution,
    node_spacing,
    resolves,
)
from facegear.errors import ConfigError
from facegear.schema.base import Section, require_all
from facegear.schema.changes import moves_pair
from facegear.schema.contact import Contact, Mesh, Modal
from facegear.schema.lubrication import LubricationSection
from facegear.schema.motion import Branches, Dynamics, LoadSharing, SharingMap
from facegear.schema.stiffness import MeshStiffness
from facegear.schema.strength import Strength
from facegear.schema.studies import NAME, Search, Study
from facegear.schema.tolerances import Tolerances
from facegear.schema.transmission import Transmission
from facegear.schema.transmission_error import FROM_CONTACT

SAME_ELASTICITY = 1e-6
"""Relative difference up to which elastic constants of tooth pair and material card count as equal."""


class Config(Section):
    """One machine and what is to be computed for it."""

    case: str = Field(pattern=NAME, description="names the folder under results/")
    tooth_pair: ToothPair
    mesh: Mesh = Mesh()
    contact: Contact = Contact()
    mesh_stiffness: MeshStiffness = MeshStiffness()
    strength: Strength | None = Field(None, description="safety and life of the pair; null: not rated")
    lubrication: LubricationSection | None = Field(
        None, description="friction, loss, heat and film of the meshes; null: without friction"
    )
    transmission: Transmission | None = Field(
        None, description="null: geometry, contact and stiffness only; modes, dynamics, load sharing need it"
    )
    modal: Modal = Modal()
    dynamics: Dynamics = Dynamics()
    branches: Branches | None = Field(None, description="continuation of periodic motions; null: not done")
    load_sharing: LoadSharing = LoadSharing()
    sharing_map: SharingMap | None = Field(
        None, description="load sharing over the numbers that decide it, and advice; null: not done"
    )
    tolerances: Tolerances | None = Field(
        None, description="thousands of machines with their tolerances: percentiles, indices; null: not done"
    )
    search: Search | None = Field(
        None, description="designs that no other beats in every objective; null: not done"
    )
    studies: tuple[Study, ...] = Field((), description="the same machine with some keys changed")
    reproduction: str | None = Field(
        None,
        min_length=1,
        description="yaml file, from this file's folder: claims of a publication and what it leaves out",
    )

    @model_validator(mode="after")
    def _buildable(self) -> "Config":
        """Run all checks that concern several sections; all mistakes are reported together."""
        require_all(
            self._check_branches,
            self._check_law,
            self._check_poses,
            self._check_friction,
            self._check_reproduction,
            lambda: check_load(self.mesh_stiffness, self.contact),
            lambda: check_pitch(self.mesh_stiffness, self.tooth_pair.pinion_teeth),
            self._check_pair,
            self._check_strength,
            self._check_machine,
            lambda: check_studies(self.studies),
        )
        return self

    def _check_friction(self) -> None:
        """Refuse friction that acts on the motion where the machine or its kinematics do not allow it."""
        if self.lubrication is None or self.lubrication.friction.effect == "loss_only":
            return
        if self.transmission is None or self.transmission.mesh_kinematics == "printed":
            requirement = "loss_only without a transmission whose mesh_kinematics are geometric"
            raise ConfigError("lubrication.friction.effect", self.lubrication.friction.effect, requirement)
        if self.transmission.mesh_place == "moving":
            requirement = "even, where lubrication.friction.effect is excitation"
            raise ConfigError("transmission.mesh_place", "moving", requirement)

    def _check_law(self) -> None:
        """Refuse a load-dependent mesh law where something else takes a constant stiffness.

        That is printed kinematics, modes with the average stiffness, a search, and samples with other
        teeth or with contact of their own. Printed kinematics know no coast flanks either.
        """
        is_printed = self.transmission is not None and self.transmission.mesh_kinematics == "printed"
        if is_printed and self.mesh_stiffness.coast:
            raise ConfigError("mesh_stiffness.coast", "given", "none where mesh_kinematics is printed")
        if self.mesh_stiffness.mesh_law == "constant_load":
            return
        if is_printed:
            requirement = "geometric, where mesh_stiffness.mesh_law is load_dependent"
            raise ConfigError("transmission.mesh_kinematics", "printed", requirement)
        if self.modal.stiffness == "average":
            requirement = "local, where mesh_stiffness.mesh_law is load_dependent"
            raise ConfigError("modal.stiffness", "average", requirement)
        if (
            self.search is not None
            or moves_pair(self._moved_keys)
            or (self.tolerances and self.tolerances.tooth_contact)
        ):
            requirement = f"constant_load, {CONTACT_ASKED}"
            raise ConfigError("mesh_stiffness.mesh_law", "load_dependent", requirement)

    @property
    def _moved_keys(self) -> list[str]:
        """Keys that samples or designs change."""
        causes = self.tolerances.causes if self.tolerances is not None else ()
        variables = self.search.variables if self.search is not None else ()
        keys = [key for cause in causes for key in cause.moves]
        return [*keys, *(key for variable in variables for key in variable.sets)]

    def _check_poses(self) -> None:
        """Refuse contact in the loaded position where the stiffness, the flanks, samples or designs do
        not allow it.
        """
        if self.transmission is not None:
            check_poses(self.transmission, self.tooth_pair, self.mesh_stiffness)
            check_posed_variants(self.transmission, self.tolerances, self.search)

    def _check_branches(self) -> None:
        """Refuse branches whose speeds leave out the operating speed, and bearing stiffness as a
        parameter of loci where turning masses or elastic gears have springs that it would scale, too.
        """
        speed, section = self.dynamics.speed_rpm, self.branches
        if section and self.transmission and "bearing_stiffness" in section.loci.parameters:
            springs = {
                "transmission.torsion": bool(self.transmission.torsion),
                "transmission.casing": self.transmission.casing is not None,
                "a body of a face gear": bool(elastic_gears(self.transmission)),
            }
            for spring_owner in (name for name, is_present in springs.items() if is_present):
                requirement = f"without bearing_stiffness beside {spring_owner}, whose springs it would scale"
                raise ConfigError("branches.loci.parameters", list(section.loci.parameters), requirement)
        rolls = self.transmission is not None and any(
            shaft.is_rolling for shaft in self.transmission.shafts.values()
        )
        parameters = section.loci.parameters if section and rolls else ()
        for name in ("torque", "bearing_stiffness"):
            if name in parameters:
                requirement = f"without {name} beside rolling bearings, whose tangent holds at the mean load"
                raise ConfigError("branches.loci.parameters", list(parameters), requirement)
        if section and not section.from_rpm <= speed <= section.to_rpm:
            requirement = f"from branches.from_rpm = {section.from_rpm:g} to {section.to_rpm:g}"
            raise ConfigError("dynamics.speed_rpm", speed, requirement)

    def _check_reproduction(self) -> None:
        """Refuse a reproduction file that does not exist."""
        if self.reproduction is not None and not Path(self.reproduction).is_file():
            raise ConfigError("reproduction", self.reproduction, "the name of a file that exists")

    def _check_pair(self) -> None:
        """Refuse a pair that jams, that lacks bodies some section needs, or whose contact cannot be
        computed.

        The last asks for torques within linear elasticity, elements that resolve contact and fillets, and
        memory.
        """
        pair = self.tooth_pair
        if pair.pinion is not None:
            geometric_backlash(pair)
        elif self._root_stress:
            raise ConfigError(
                "tooth_pair.pinion", None, "given, as required by contact.root_stress and strength"
            )
        elif self.lubrication is not None:
            raise ConfigError("tooth_pair.pinion", None, "given, as required by lubrication")
        elif self.mesh_stiffness.source != "harmonics":
            requirement = "given, as mesh_stiffness.source is not harmonics"
            raise ConfigError("tooth_pair.pinion", None, requirement)
        has_contact = self.mesh_stiffness.source != "harmonics" or self._root_stress or self.lubrication
        if has_contact:
            design = pair_design(pair)
            sizes = mesh_sizes(self.mesh_used, design.module)
            contact = self.contact_used
            plan = along_the_ellipse(design, materials(pair), sizes, contact_plan(contact))
            check_strain(pair, contact)
            check_resolution(design, materials(pair), sizes, plan)
            check_fillet(design, sizes, replace(plan, root_stress=self._root_stress))
            check_memory(design, sizes, plan, memory_here())

    @property
    def mesh_used(self) -> Mesh:
        """Section `mesh` with `thin_fillet` filled in: as given, else true where root stress is asked
        for.
        """
        thin_fillet = self.mesh.thin_fillet
        return self.mesh.model_copy(
            update={"thin_fillet": self._root_stress if thin_fillet is None else thin_fillet}
        )

    @property
    def contact_used(self) -> Contact:
        """Section `contact` with the duty cycle's torques outside the range of its own torques added, N
        m.

        Torques so small that the mesh cannot resolve their contact are not added.
        """
        torques = self.contact.torques_n_m
        if self.strength is None or not self._rates_teeth or self.tooth_pair.pinion is None:
            return self.contact
        design, plan = pair_design(self.tooth_pair), contact_plan(self.contact)
        spacing = node_spacing(mesh_sizes(self.mesh_used, design.module), plan)
        duty_torques = [
            torque
            for torque in self.strength.torques
            if not torques[0] <= torque <= torques[-1]
            and resolves(spacing, design, materials(self.tooth_pair), torque)
        ]
        return self.contact.model_copy(update={"torques_n_m": tuple(sorted({*torques, *duty_torques}))})

    @property
    def _root_stress(self) -> bool:
        """Whether root stress is asked for, by section contact or by a rating."""
        return self.contact.root_stress or self._rates_teeth

    @property
    def _rates_teeth(self) -> bool:
        """Whether a rating of the teeth is asked for."""
        return self.strength is not None and self.strength.rates_teeth

    def _check_strength(self) -> None:
        """Refuse material cards with other elasticity than the bodies, elements that root stress cannot
        use, and a duty cycle of nothing.
        """
        if self.strength is None:
            return
        if not self.strength.rates_teeth:
            shafts = self.transmission.shafts.values() if self.transmission else ()
            if not any(shaft.is_rolling for shaft in shafts):
                requirement = "given, or else transmission.shafts with rolling bearings"
                raise ConfigError("strength.pinion", None, requirement)
            return
        for body in ("pinion", "face_gear"):
            card = getattr(self.strength, body).card
            body_section = getattr(self.tooth_pair, body)
            material = (body_section.material if body_section else None) or self.tooth_pair.material
            for key in ("young_modulus_gpa", "poisson_ratio"):
                pair_value, card_value = getattr(material, key), getattr(card, key)
                if not isclose(pair_value, card_value, rel_tol=SAME_ELASTICITY):
                    requirement = f"{pair_value:g}, as contact and stress take it from tooth_pair"
                    raise ConfigError(f"strength.{body}.card.{key}", card_value, requirement)
        if self.contact.element != "hex27":
            raise ConfigError("contact.element", self.contact.element, "hex27, where strength is asked for")

    def _check_duty_speeds(self) -> None:
        """Refuse duty speeds outside the speed sweep, where the sweep gives the load factors."""
        sweep = self.dynamics.sweep
        if self.strength is None or self.strength.load_factors != "machine":
            return
        for number, load in enumerate(self.strength.duty):
            if not sweep.from_rpm <= load.speed_rpm <= sweep.to_rpm:
                requirement = f"within dynamics.sweep, {sweep.from_rpm:g} to {sweep.to_rpm:g}"
                raise ConfigError(f"strength.duty[{number}].speed_rpm", load.speed_rpm, requirement)

    def _check_sharing_map(self, machine: Transmission) -> None:
        """Refuse a load-sharing map with printed kinematics or a single face gear, which splits no load."""
        if self.sharing_map is None:
            return
        if machine.mesh_kinematics == "printed":
            raise ConfigError(
                "transmission.mesh_kinematics", "printed", "geometric, as required by sharing_map"
            )
        if len(machine.face_gears) < 2:
            both_gears = "lower and upper, as required by sharing_map: one gear alone splits no load"
            raise ConfigError("transmission.face_gears", list(machine.face_gears), both_gears)

    def _check_machine(self) -> None:
        """Check section `transmission` against the other sections.

        Without a machine, refuse the sections that need one. With one, check its positions, torques,
        bodies, backlash and transmission errors, and the tolerances and search that vary it.
        """
        pair, machine = self.tooth_pair, self.transmission
        if machine is None:
            for key in ("sharing_map", "studies", "tolerances", "search", "reproduction"):
                if getattr(self, key):
                    raise ConfigError("transmission", None, f"given, as required by {key}")
            if self.strength is not None and self.strength.load_factors == "machine":
                raise ConfigError(
                    "transmission", None, "given, as required by strength.load_factors = machine"
                )
            return
        check_preloads(machine)
        check_gear_alone(pair, machine.face_gears, self._moved_keys)
        check_lower_gear(pair, machine.face_gears)
        self._check_duty_speeds()
        self._check_sharing_map(machine)
        check_positions(pair, machine)
        check_machine_strain(pair, machine)
        check_torques(pair, machine)
        check_bodies(pair, machine)
        check_casing(machine)
        check_pitch_once(pair, machine)
        if machine.backlash_um is None and pair.pinion is None:
            requirement = "given, as tooth_pair has no bodies that it could be taken from"
            raise ConfigError("transmission.backlash_um", None, requirement)
        errors = {"transmission_error": machine.transmission_error}
        errors |= {
            f"single_meshes.{name}.transmission_error": mesh.transmission_error
            for name, mesh in machine.single_meshes.items()
            if mesh.transmission_error is not None
        }
        for key, error in errors.items():
            if error.source == "from_contact" and self.mesh_stiffness.source == "harmonics":
                raise ConfigError(f"transmission.{key}", "from_contact", FROM_CONTACT)
        complete = with_backlash(pair, machine)
        require_buildable(complete, pair_teeth(pair))
        has_contact = self.mesh_stiffness.source != "harmonics"
        if self.tolerances is not None:
            check_tolerances(self.tolerances, pair, complete, self.lubrication, has_contact)
        if self.search is not None:
            stress = "root stress" if self._root_stress else "pressure"
            check_search(self.search, self.tolerances, pair, complete, stress if has_contact else "none")


def resolved_values(config: Config) -> dict[str, Any]:
    """Return the plain values of a config with what follows from other keys filled in.

    That is the mean stiffness where order 0 of the harmonics gives it, the torque at which k is taken,
    the backlash of the dynamics, the speed at which rolling elements are thrown outwards, the gauges and
    torques that a rating needs, the fillets that gauges need, and how often a turn loads a tooth: an
    input pinion's once by every face gear, a face gear's once by every pinion.

    Parameters
    ----------
    config : Config
        The config.

    Returns
    -------
    dict[str, Any]
        Plain nested values under the keys of the config, for stages; the config itself is unchanged.
    """
    values = config.model_dump(mode="json")
    strength = config.strength
    rates_teeth = strength is not None and strength.rates_teeth
    has_given_factors = strength is not None and rates_teeth and strength.load_factors == "given"
    if has_given_factors and (machine := config.transmission) is not None:
        for body, meshes in (("pinion", machine.face_gears), ("face_gear", machine.pinions)):
            section = values["strength"][body]
            section["cycles_per_turn"] = section["cycles_per_turn"] or len(meshes)
    values["contact"]["root_stress"] = config.contact.root_stress or rates_teeth
    values["contact"]["torques_n_m"] = list(config.contact_used.torques_n_m)
    values["mesh"] = config.mesh_used.model_dump(mode="json")
    stiffness = values["mesh_stiffness"]
    stiffness["mean_n_per_m"] = config.mesh_stiffness.mean
    if stiffness["source"] != "harmonics" and stiffness["torque_n_m"] is None:
        stiffness["torque_n_m"] = config.contact.torques_n_m[-1]
    if config.transmission is not None:
        complete = with_backlash(config.tooth_pair, config.transmission.at_speed(config.dynamics.speed_rpm))
        values["transmission"] = complete.model_dump(mode="json")
        if complete.casing is not None:
            values["transmission"]["casing"]["content"] = content(complete.casing)
    return values
