"""Assembly of a scene's equations of motion from the displacement fields, with damping."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import scipy.linalg

from beamdyn.common.numerics import solve_lower, solve_lower_transposed
from beamdyn.equations.circuit import Circuit, coupling_of, open_terms
from beamdyn.equations.discretization import Discretization, Spaces
from beamdyn.equations.equations_of_motion import BACKWARD, Equations, Shape, SteadyPencil, place_blocks
from beamdyn.equations.fields import FIELDS
from beamdyn.equations.fields.field import Term
from beamdyn.scene.beam import Beam
from beamdyn.scene.scene import Scene


def assemble_equations(scene: Scene, discretization: Discretization) -> Equations:
    """Assemble the equations of motion of a scene in a discretization, as `assemble_over` does."""
    return assemble_over(scene, discretization.spaces(scene.modelled_beam))


def assemble_over(scene: Scene, spaces: Spaces) -> Equations:
    """Assemble the equations of motion of a scene from its displacement fields, over function spaces.

    Parameters
    ----------
    scene : Scene
        Beam, mount, damping and gravity.
    spaces : Spaces
        Function spaces on the beam.

    Returns
    -------
    Equations
        Equations of motion, without the terms whose factor or matrix is zero in the scene.
    """
    fields = {f.name: f.assemble(scene, spaces) for f in FIELDS if f.is_modelled(scene)}
    blocks = place_blocks({name: field.space.size for name, field in fields.items()})
    coarse = [field.space.coarse for field in fields.values()]
    starts = (place.start for place in blocks.values())
    within = [start + places for start, places in zip(starts, coarse, strict=True) if places is not None]
    equations = Equations(
        blocks=blocks,
        terms=tuple(t for f in fields.values() for t in f.terms if t.factor and np.count_nonzero(t.matrix)),
        loads=tuple(f for field in fields.values() for f in field.loads if f.factor),
        mount=scene.mount,
        gravity=scene.gravity,
        shapes={name: Shape(name, np.eye(field.space.size)) for name, field in fields.items()},
        deflections={name: f.deflection for name, f in fields.items() if f.deflection is not None},
        sections=tuple((name, f.sections) for name, f in fields.items() if f.sections is not None),
        coarse=np.concatenate(within) if len(within) == len(coarse) else None,
    )
    if turning := [blocks[name].start for name, field in fields.items() if field.turns_at_root]:
        pencil, clamped = equations.steady(), np.delete(np.arange(equations.size), turning)
        K, M = (A[np.ix_(clamped, clamped)] for A in (pencil.K0, pencil.M))
        equations = replace(equations, shift=float(1 / scipy.linalg.eigh(M, K, eigvals_only=True)[-1]))
    if scene.is_damped:
        equations = replace(equations, terms=(*equations.terms, *damping_terms(equations, scene)))
    return equations if scene.beam.electrodes is None else _with_electrodes(equations, scene.beam)


def _with_electrodes(equations: Equations, beam: Beam) -> Equations:
    """Add the stiffness of open electrodes, or attach the circuit of electrodes with a load resistance."""
    electrodes, theta = beam.electrodes, np.zeros(equations.size)
    assert electrodes is not None
    if not electrodes.resistance:
        return equations
    coupled = coupling_of(beam, equations.deflections, equations.sections)
    for name, of_field in coupled.items():
        theta[equations.blocks[name]] = of_field
    circuit = Circuit(theta, electrodes.capacitance(beam.length), electrodes.resistance)
    if electrodes.is_loaded:
        return replace(equations, circuit=circuit)
    stiffness = open_terms(circuit, coupled)
    return replace(equations, terms=(*equations.terms, *stiffness))


def damping_terms(equations: Equations, scene: Scene) -> Iterator[Term]:
    """Yield the damping terms of a scene: modal damping, Rayleigh damping, and a damper at the tip."""
    names, damping = {field.name: field.damping_name for field in FIELDS}, scene.damping
    if scene.damping_ratio or any(damping.ratios):
        for part, C in _damping_of_modes(equations, scene):
            ends = np.cumsum([equations.blocks[name].stop - equations.blocks[name].start for name in part])
            for row, blocks in zip(part, np.split(C, ends[:-1]), strict=True):
                for column, block in zip(part, np.split(blocks, ends[:-1], axis=1), strict=True):
                    yield Term(names[row], row, column, 1, block, factor=scene.damping_ratio or 1.0)
    factors = {2: damping.mass_factor, 0: damping.stiffness_factor}
    for term in equations.terms:
        if term.quantity == "unity" and factors.get(term.order):
            name, factor = names[term.rows], factors[term.order] * term.factor
            yield replace(term, name=name, order=1, factor=factor)
    if damping.tip_damper:  # the damper's force depends on the total tip velocity in each direction
        tips = {name: (d.direction, d.space.end(0)) for name, d in equations.deflections.items()}
        for row, (direction, tip) in tips.items():
            for column, (other, tip_of_other) in tips.items():
                if direction == other:
                    matrix = np.outer(tip, tip_of_other)
                    yield Term(names[row], row, column, 1, matrix, factor=damping.tip_damper)


def _damping_of_modes(equations: Equations, scene: Scene) -> Iterator[tuple[tuple[str, ...], np.ndarray]]:
    """Yield each set of coupled coordinate blocks, with the damping matrix of its modes at rest.

    If all modes have the same damping ratio, the matrix is that of the ratio 1, and the caller scales it.
    Ratios given mode by mode are assigned in the order of the frequencies of all sets together.
    """
    pencil, sets = equations.steady(), equations.coupled
    parts = [pencil.part(equations.places(names)) for names in sets]
    if not scene.damping.ratios:
        yield from ((names, _modal_damping(part)) for names, part in zip(sets, parts, strict=True))
        return
    compliance = [
        scipy.linalg.eigh(part.M, part.K0 + part.shift * part.M, eigvals_only=True)[::-1] for part in parts
    ]
    rank = np.argsort(np.argsort(-np.concatenate(compliance), kind="stable"))
    ratios = np.array(scene.damping.ratios_of(equations.size))[rank]
    of_parts = np.split(ratios, np.cumsum([len(each) for each in compliance])[:-1])
    for names, part, own in zip(sets, parts, of_parts, strict=True):
        yield names, _modal_damping(part, own)


def _modal_damping(part: SteadyPencil, ratios: np.ndarray | None = None) -> np.ndarray:
    """Compute the damping matrix [kg/s] that gives modes at rest the damping ratio 1, or given ratios.

    C = 2 L (B - shift B^2)^(1/2) L^T with K + shift M = L L^T and B = L^-1 M L^-T; the shift [1/s2] makes
    a singular stiffness positive definite.
    """
    M, K, shift = part.M, part.K0, part.shift
    L = np.linalg.cholesky(K + shift * M if shift else K)
    compliance = solve_lower(L, solve_lower(L, M).T)
    mu, U = np.linalg.eigh((compliance + compliance.T) / 2)
    unshifted: np.ndarray | float = 1.0
    # With a shift, each eigenvalue mu of B has the factor 1 - shift mu.  It is computed as v^T K v, with
    # v = L^-T u for the eigenvector u, since the difference would lose digits if a spring is soft.  A factor
    # within its rounding error is set to 0.
    if shift:
        v = solve_lower_transposed(L, U)
        quotient = np.einsum("nk,nk->k", v, K @ v)
        lost = BACKWARD * np.einsum("nk,nk->k", np.abs(v), np.abs(K) @ np.abs(v))
        unshifted = np.where(quotient > lost, quotient, 0.0)
    # Ratios are in the order of ascending omega, but mu = 1/(omega^2 + shift) ascends as omega descends.
    of_modes = 1.0 if ratios is None else ratios[::-1]
    root = (U * (of_modes * np.sqrt(np.maximum(mu * unshifted, 0)))) @ U.T
    return 2 * L @ root @ L.T
