"""Frequencies of a rotating beam that bends in two planes, with twist, shear and rotary inertia: a second method.

The differential equations in first-order form, solved by Gauss collocation; nothing is shared with `beamdyn`.
All quantities are nondimensional: length 1, mass per length 1 and bending stiffness 1 at the root (or any that fit
together), ``gamma`` the speed, ``lambda`` the frequency, ``hub`` the hub radius, positive outward (for any setting
angle: -cos(phi) r/L).

Kinematics.  A centre line moves by u = (u2, u3) along b2 (in the plane of rotation) and b3 (the axis of
rotation) and does not stretch, so that its points move inward by 1/2 int |u'|^2.  Sections turn by p = (p2, p3),
the slopes of their normals; u' - p is shear.  The beam does not twist about its own line: frames of the sections
are carried along without torsion.  To second order this turns a section about the beam axis by

    tau(x) = 1/2 int_0^x (p2 p3' - p3 p2') dx        (tau(0) = 0: the root turns by the shortest rotation).

Energy of steady rotation.  A section has the second moments of mass E22, E23, E33 (E23 = int y z dm); a direction n
of the section is needed to second order, and -1/2 gamma^2 int (X1^2 + X2^2) dm over it gives

    1/2 gamma^2 (-E33 p3^2 - E23 p2 p3 + 2 E23 tau).

The last, integrated by parts, is 1/2 gamma^2 int G (p2 p3' - p3 p2') dx with G(x) the integral of E23 over what lies
outboard.  A tip body with moments of inertia J11, J22, J33 about b1, b2, b3 and E23 gives, about its centre of gravity,

    1/2 gamma^2 ((J33 - J11) p3^2 - E23 p2 p3 + 2 E23 tau(1)),

for sections J33 - J11 = -E33, so that this is one formula.  The motion has no gyroscopic term: with J12 = J13 = 0
those of the angular velocity's first and second order both vanish.

Equations.  With K, S, E the matrices of bending, shear and rotary inertia in b2, b3 (turned by psi), W the symmetric
matrix of -E33 p3^2 - E23 p2 p3, J p = (-p3, p2), P u = (u2, 0), z = lambda^2, V the shear force of the section,
N = gamma^2 (int_x^1 m (hub + s) ds + m_t (hub + 1 + eps)) the tension, which acts on u' (Engesser):

    u' = p + V / S,      V + N u' = Q,       K p' = M - 1/2 gamma^2 G J p,
    M' = -V + gamma^2 (W p + 1/2 G J^T p') - z E p,       Q' = -gamma^2 m P u - z m u;
    root   u = 0, and along e1 and e2 at the root  M = k p,  or p = 0 where k is infinite;
    tip    with t = u + eps p:   Q = m_t (z + gamma^2 P) t,
           M + gamma^2 (W_t + m_t (hub + 1 + eps) eps) p = z J_t p + eps m_t (z + gamma^2 P) t.

u, p, M and Q are continuous where properties jump.  With one plane, u = e1 q everywhere, and the same equations are
taken along e1.

Check (tests/invariants/test_second_method.py).  The kinematics against frames integrated at finite amplitude; the
frequencies against the quotient of the energies.  All rows of the shared tables of models for these effects agree to
every digit printed, and Carnegie's blade (62.0776, 305.481, 949.945, 1221.87 Hz) too.

Run as ``python -m benchmarks.cases.reference.twisted_beam``, this writes the file of cases, see `second_method.py`.
"""

from benchmarks.cases.reference.twisted_beam.blade import Blade, Body, constant
from benchmarks.cases.reference.twisted_beam.collocation import Solution, converged, solve

__all__ = ["Blade", "Body", "Solution", "constant", "converged", "solve"]
