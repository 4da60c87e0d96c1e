"""Equilibrium and vibration of a rotating beam with large deflection, by an independent method.

The balance of forces and moments of the inextensible elastica, collocated at Gauss points; nothing is shared
with `beamdyn`. All quantities are nondimensional: length 1, and for example mass per length m and bending
stiffness B 1 at the root; ``gamma`` is the speed, s the exponent of exp(s t), |s| = lambda a frequency.

Kinematics.  The slope theta(x) of the beam is against its direction at the clamp; the place p = (X, Y), X
along b1, Y along the direction of bending e, has X' = cos theta, Y' = sin theta. The axis of rotation passes
through C, seen from the root: C = r (cos phi, cos psi sin phi). With P = 1 where e lies in the plane of
rotation (psi 0 or 180 deg) and P = 0 where it is normal to it (psi = +-90 deg), a point's acceleration is

    a = p.. - gamma^2 (X - C_X, P (Y - C_Y)) + 2 gamma P (Y., -X.)

up to the sign of the last term, which half a turn about b1 changes, and no frequency sees. (The part of a
that is normal to the plane of bending is taken by the beam's rigidity there.)

Sections and body.  The particles of a section lie on its normal n = (-sin theta, cos theta), and have the
second moment R = rho I per length. In the plane of rotation their centrifugal forces, gamma^2 times the
place, have no moment about the centre. Out of it only b1 counts: -y cos theta (moment arm along e) times
-gamma^2 y sin theta add up to gamma^2 R sin theta cos theta. Coriolis forces are along n, and have no moment.
The tip body, with its centre at p(1) + eps (cos theta, sin theta) and moments of inertia J_n about the axis
of bending, J_e about n, J_1 about the tangent, has E_tt - E_nn = J_e - J_1, hence the moment
-gamma^2 (J_e - J_1) sin theta cos theta: it is a section with R = J_n against angular acceleration, and
-(J_e - J_1) in the place of R in the moment of spin.

Balance.  F = (H, V) and M are what the outer part exerts on a section:

    H' = m a_X,   V' = m a_Y,   theta' = M / B,
    M' = H sin theta - V cos theta + R theta.. - (1 - P) gamma^2 R sin theta cos theta;
    root  X = Y = 0,  M = k theta, or theta = 0 where k is infinite;
    tip   F = -m_t a,
          M = eps (V cos theta - H sin theta) - J_n theta.. - (1 - P) gamma^2 (J_e - J_1) sin theta cos theta,

a at the tip being that of the body. F, M and theta are continuous where properties jump. Out of the plane
nothing depends on C_Y.

Solution.  Unknown is the curvature at the Gauss points of all pieces (and the turn at the root, where there
is a spring): theta, p, F and M follow by integrals of the polynomials through them, from the root or from the
tip; the body is one more place behind the tip, of the length eps. That is collocation at Gauss points of the
equations above, without a derivative taken, so that rounding stays small. Residual B kappa - M(kappa) = 0 by
Newton; about an equilibrium (K + s G + s^2 A) kappa = 0 by the eigenvalues 1/s of its companion matrix. All
of M at rest in the rotating frame is proportional to gamma^2.

Equilibria are traced from rest in the speed (`from_rest`), or by the angle of the tip with the speed unknown
(`branch_at`), through folds and from the pitchfork of the straight beam. An equilibrium is stable if no s has
a positive real part.
"""

from benchmarks.cases.reference.elastica.beam import Body, Elastica, constant
from benchmarks.cases.reference.elastica.branches import (
    bent,
    branch_at,
    critical_speed,
    equilibria_bent_to,
    fold,
    fold_beside,
    slowest,
)
from benchmarks.cases.reference.elastica.converge import Answer, converged
from benchmarks.cases.reference.elastica.equilibrium import State, from_rest, polished
from benchmarks.cases.reference.elastica.vibration import exponents, frequencies, growth

__all__ = [
    "Answer",
    "Body",
    "Elastica",
    "State",
    "bent",
    "branch_at",
    "constant",
    "converged",
    "critical_speed",
    "equilibria_bent_to",
    "exponents",
    "fold",
    "fold_beside",
    "frequencies",
    "from_rest",
    "growth",
    "polished",
    "slowest",
]
